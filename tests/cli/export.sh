#!/bin/sh
# export.sh: `krs export`: files are complete shaders, numbers of the scene are in them, and what cannot be is refused.
. "$(dirname "$0")/common.sh"
plan 52

cat >ball.krs <<'END'
param radius = 0.5 in [0.1, 1];
param tint = #ff8000;
material m { color: tint }
show sphere(radius).move([0.3, 0, 0]).paint(m);
light lamp { position: [1, 2, 3], intensity: 5, target: [0, 0, 0], angle: 40deg }
camera { eye: [0, 0, 4] }
camera side { eye: [4, 0, 0] }
END

run export ball.krs --to shadertoy
[ "$status" -eq 0 ] && [ -s ball.shadertoy.glsl ]
result $? "a file for Shadertoy has the scene's name"
if command -v glslangValidator >/dev/null; then
    { printf '#version 310 es\nprecision highp float; precision highp int;\nlayout(location = 0) uniform vec3 iResolution; layout(location = 1) uniform float iTime; layout(location = 2) uniform vec4 iMouse; layout(location = 0) out vec4 o;\n'
      cat ball.shadertoy.glsl; echo 'void main() { mainImage(o, gl_FragCoord.xy); }'; } >toy.frag
    glslangValidator toy.frag >out 2>err
    result $? "glslang compiles it"
    sed 's/krs_distance(p/krs_distances(p/' toy.frag >wrong.frag
    ! glslangValidator wrong.frag >/dev/null 2>&1
    result $? "glslang refuses it with a name that is wrong"
else
    skip "glslang compiles it" "no glslangValidator"
    skip "glslang refuses it with a name that is wrong" "no glslangValidator"
fi
grep -q 'const float PARAM_radius = 0.5; // 0.1 to 1' ball.shadertoy.glsl && grep -q 'const vec3  PARAM_tint = vec3(1.0, 0.21' ball.shadertoy.glsl
result $? "parameters are constants with their ranges"
run export ball.krs --to shadertoy --set radius=0.25 --camera side -o own.glsl
grep -q 'PARAM_radius = 0.25;' own.glsl && grep -q 'KRS_EYE = vec3(4.0, 0.0, 0.0)' own.glsl
result $? "values and cameras are chosen"
run export ball.krs --to three
grep -q 'export function makeScene' ball.three.mjs
result $? "a module for three.js is written"
if command -v node >/dev/null; then
    node -e "import('$PWD/ball.three.mjs').then(m => process.exit(m.camera.eye[2] === 4 && m.parameters[0].name === 'radius' && m.low[0] < -0.19 ? 0 : 1))" >out 2>err
    result $? "node reads it"
else
    skip "node reads it" "no node"
fi

echo 'show text("krs").extrude(0.2);' >letters.krs
run export letters.krs --to shadertoy
[ "$status" -eq 1 ] && grep -q 'cannot export .letters.krs. to shadertoy: parts that are alike, at letters.krs:1,' err && [ ! -e letters.shadertoy.glsl ]
result $? "what Shadertoy cannot have is told, and nothing is written"
run export letters.krs --to three
grep -q "cells = '[A-Za-z0-9+/]" letters.three.mjs
result $? "three.js has its tables"
cat >odd.krs <<'END'
param _r = 0.5 in [0.1, 1];
param a__b = 0.5;
show sphere(_r).move([a__b, 0, 0]);
camera { eye: [0, 8, 0] }
camera flat { eye: [0, 0, 4], projection: "orthographic", height: 3 }
END
run export odd.krs --to shadertoy
[ "$status" -eq 0 ] && ! grep -q '__' odd.shadertoy.glsl && grep -q 'PARAM_1_r = 0.5' odd.shadertoy.glsl && grep -q 'PARAM_2a_b' odd.shadertoy.glsl
result $? "no name has two underscores side by side, which WebGL reserves"
grep -q 'KRS_UP = vec3(0.0, 0.0, -1.0)' odd.shadertoy.glsl
result $? "a camera that looks down has something that is up"
run export odd.krs --to shadertoy --camera flat
said 1 "its camera is no perspective one" "a projection that it has not is told"
cp ball.krs "a$(printf '\nb').krs"
run export "a$(printf '\nb').krs" --to three -o lines.mjs
[ "$status" -eq 0 ] && head -n 1 lines.mjs | grep -q 'for three.js'
result $? "a name with a line's end stays in its comment"

# ---- functions, and engines ----

# A compute shader with a file in its midst; glslang's options come first.
compiles() { # file, ending of the stage, main
    { printf '#version 450\n'; [ "$2" = comp ] && echo 'layout(local_size_x = 1) in;'; cat "$1"; echo "$3"; } >"made.$2"
}
run export ball.krs --to glsl
if command -v glslangValidator >/dev/null; then
    compiles ball.glsl comp 'layout(std430, binding = 5) buffer Found { float found; };
        void main() { krs_prepare(); vec3 p = vec3(found) + KRS_LOW + KRS_DEFAULTS[1].xyz; found = krs_distance_lod(p, 0.1) + krs_surface(p, p, 0.0).roughness; }'
    glslangValidator -V made.comp -o made.spv >out 2>err && glslangValidator made.comp >out 2>err
    result $? "functions in GLSL are compiled for Vulkan and for OpenGL"
    sed 's/krs_distance_lod(p, 0.1)/krs_distance_lod(p)/' made.comp >wrong.comp
    ! glslangValidator wrong.comp >/dev/null 2>&1
    result $? "a wrong call is refused"
else
    skip "functions in GLSL are compiled for Vulkan and for OpenGL" "no glslangValidator"
    skip "a wrong call is refused" "no glslangValidator"
fi
grep -q '^//   krs_parameter\[1\].x: radius, 0.1 to 1$' ball.glsl && grep -q 'KRS_LOW = vec3(-0.7, -1.0, -1.0), KRS_HIGH = vec3(1.3, ' ball.glsl
result $? "parameters have their ranges, and there is the box"
run export ball.krs --to wgsl --set radius=0.25
grep -q 'KRS_DEFAULTS = array<vec4f, 3>(vec4f(0.0, 0.0, 0.0, 0.0), vec4f(0.25, ' ball.wgsl && grep -q 'fn krs_distance_lod' ball.wgsl
result $? "WGSL has the values that were chosen"
run export letters.krs --to essl
[ "$status" -eq 0 ] && [ -s letters.rows.bin ] && [ -s letters.cells.bin ]
result $? "tables are in files beside the text"
run compile letters.krs --language essl -o compiled
cmp -s letters.cells.bin compiled/letters.cells.bin
result $? "which have the bytes that \`krs compile\` writes"
PATH=/nowhere "$krs" export ball.krs --to hlsl >out 2>err
status=$?
said 1 "there is no \`spirv-cross\`" "what is missing for HLSL is told"
if command -v spirv-cross >/dev/null && command -v glslangValidator >/dev/null; then
    run export letters.krs --to hlsl
    glslangValidator -D -V -S comp -e main -DKRS_KERNEL -o hlsl.spv letters.hlsl >out 2>err
    result $? "glslang compiles HLSL with its kernel"
    sed 's/float3 KRS_LOW/flat3 KRS_LOW/' letters.hlsl >wrong.hlsl
    ! glslangValidator -D -V -S comp -e main -o hlsl.spv wrong.hlsl >/dev/null 2>&1
    result $? "and refuses it with a wrong type"
    run export ball.krs --to msl
    head -n 1 ball.metal | grep -q untested && grep -q 'kernel void main0' ball.metal
    result $? "MSL says that no compiler has seen it"
else
    skip "glslang compiles HLSL with its kernel" "no spirv-cross or glslangValidator"
    skip "and refuses it with a wrong type" "no spirv-cross or glslangValidator"
    skip "MSL says that no compiler has seen it" "no spirv-cross"
fi
run export ball.krs --to godot -o game/../moon.gdshader
[ "$status" -ne 0 ]
result $? "a folder that is not there is told of several files"
run export ball.krs --to godot -o moon.shader
said 2 "-o must end with .gdshader" "files that name each other have their endings"
run export ball.krs --to godot -o moon.gdshader
head -n 1 moon.gdshader | grep -q untested && grep -q 'path="res://moon.gdshader"' moon.tscn && grep -q 'size = Vector3(2, 2, 2)' moon.tscn
result $? "a scene for Godot names its shader and has its box"
grep -q 'type="SpotLight3D"' moon.tscn && grep -q '^spot_angle = 20$' moon.tscn && ! grep -q Omni moon.tscn && grep -q '^sky_top_color = Color(' moon.tscn
result $? "a light with a cone has it in Godot, and there is the sky"
grep -q 'uniform float param_radius : hint_range(0.1, 1.0) = 0.5;' moon.gdshader && grep -q 'uniform vec3 param_tint : source_color = vec3(1.0, 0.50' moon.gdshader
result $? "parameters are sliders and colours there"

# ---- Unity and Unreal: HLSL with stand-ins for what the engines have ----

unity_compiles() { # name
    { cat "$root/tests/cli/export_unity.hlsl"
      sed -n '/---- functions/,/---- passes/p' "$1.shader" | grep -v '#include'
      sed -n '/^struct KrsSurface/,$p' "$1.hlsl" | sed '$d'; } >parts
    # The functions come where they are included.
    { sed '/CBUFFER_END/q' parts; sed -n '/^struct KrsSurface/,$p' parts; sed '1,/CBUFFER_END/d; /^struct KrsSurface/,$d' parts; } >unity.hlsl
    for entry in KrsLit KrsDepthOnly KrsNormals KrsShadow; do
        glslangValidator -D -V -S frag -e $entry -o unity.spv unity.hlsl >out 2>&1 || return 1
    done
    glslangValidator -D -V -S vert -e KrsBox -o unity.spv unity.hlsl >out 2>err
}
unreal_compiles() { # name
    { sed '/---- the node/q' "$1.unreal.hlsl"
      echo 'float3 Place, Eye, Ahead, param_tint; float Pixel, Seconds, param_radius; Texture3D Baked; SamplerState BakedSampler;'
      echo 'float3 node(out float3 Normal3, out float3 Emission, out float Rough, out float Metal, out float Opacity, out float Away) {'
      sed '1,/---- the node/d' "$1.unreal.hlsl"
      echo '} float4 main(float4 at : SV_Position) : SV_Target { float3 n, e; float r, m, o, a; float3 c = node(n, e, r, m, o, a); return float4(c + n + e, r + m + o + a); }'; } >unreal.hlsl
    glslangValidator -D -V -S frag -e main -o unreal.spv unreal.hlsl >out 2>err
}
if command -v spirv-cross >/dev/null && command -v glslangValidator >/dev/null; then
    run export ball.krs --to unity
    [ "$status" -eq 0 ] && head -n 1 ball.shader | grep -q untested && head -n 1 ball.hlsl | grep -q untested && head -n 1 ball.cs | grep -q untested
    result $? "Unity has three files, which say that it has not seen them"
    unity_compiles ball
    result $? "glslang compiles its passes"
    run export ball.krs --to unreal
    unreal_compiles ball
    result $? "glslang compiles a node for Unreal"
    sed 's/krs_seen(krs_eye/krs_seem(krs_eye/' unreal.hlsl >wrong.hlsl
    ! glslangValidator -D -V -S frag -e main -o unreal.spv wrong.hlsl >/dev/null 2>&1
    result $? "and refuses it with a wrong name"
    grep -q 'param_radius: a number, 0.1 to 1, here 0.5' ball.unreal.hlsl && head -n 1 ball.unreal.hlsl | grep -q untested
    result $? "its inputs have their ranges"
    run export letters.krs --to unity --bake 16 --studio off
    [ "$(head -c 4 letters.bytes)" = "DDS " ] && unity_compiles letters && grep -q 'Texture3D(24, ' letters.cs
    result $? "samples of letters, which are read from tables, are compiled for Unity"
    run export letters.krs --to unreal --bake 16 --studio off
    unreal_compiles letters && cmp -s letters.dds letters.bytes
    result $? "and for Unreal"
else
    for what in "Unity has three files" "glslang compiles its passes" "glslang compiles a node for Unreal" "and refuses it" "its inputs have their ranges" \
        "samples are compiled for Unity" "and for Unreal"; do
        skip "$what" "no spirv-cross or glslangValidator"
    done
fi
if command -v mcs >/dev/null && [ -e ball.cs ]; then
    mcs -target:library -out:unity.dll ball.cs "$root/tests/cli/export_unity.cs" >out 2>err
    result $? "a compiler of C# takes the script for Unity, with a stand-in for that"
else
    skip "a compiler of C# takes the script for Unity" "no mcs, or no file"
fi

# ---- samples ----

run export letters.krs --to godot
said 1 "--bake N samples the scene instead" "where parts cannot be read from tables, samples are told"
run export letters.krs --to shadertoy --bake 16
said 1 "shadertoy has no room for samples" "they are refused where there are no such textures"
echo 'show plane([0, 1, 0], 0); show sphere(1);' >floor.krs
run export floor.krs --to godot --bake 16 -o floor.gdshader
said 1 "it has no end, so it cannot be sampled; --component NAME" "what has no end is refused"
run export floor.krs --to godot --bake 16 --component 2 -o floor.gdshader
# A ball's samples: the distance in the middle of the texture is less than a cell from the radius, by its half-precision number.
grep -q 'KRS_HALF = vec3(1.375, 1.375, 1.375)' floor.gdshader && [ "$(wc -c <floor.dds)" -eq $((148 + 23 * 23 * 23 * 8)) ] &&
    [ "$(od -An -t x2 -j $((148 + (11 * 23 * 23 + 11 * 23 + 11) * 8 + 6)) -N 2 floor.dds)" = " bc00" ]
result $? "a part is sampled alone, with the radius in the middle of a ball"

run export floor.krs --to godot --component 2
said 2 "--component and --within are for samples" "parts of texts are not to be chosen"

# ---- Blender: OSL by a compiler of C++, with a stand-in for what that language has ----

# Makes a program of NAME.osl that says of each point distance, normal, colour and roughness, and where its steps end: what the shader
# is given is a variable then.
osl_program() { # name
    awk '/^shader / { head = 1; next }
         head && /^\{/ { print "void shade()"; head = 0 }
         head { sub(/ *\[\[.*\]\]/, ""); sub(/ *\/\/.*/, ""); sub(/^ *(output )?/, ""); sub(/[,)]$/, ";") }
         { print }' "$1.osl" | sed -E 's/output ([A-Za-z0-9]+) ([a-z0-9]+)/\1 \&\2/g' >"$1.cc"
    cat >>"$1.cc" <<'END'
int main()
{
    vector way;
    while (scanf("%f %f %f %d", &P.x, &P.z, &P.y, &Steps) == 4) {
        P.y = -P.y;
        shade();
        way = P + Displacement;
        printf("%.7g %.3f %.3f %.3f  %.3f %.3f %.3f %.3f  %.3f %.3f %.3f\n", Distance, Normal.x, Normal.z, Normal.y, Color.x, Color.y, Color.z, Roughness,
               way.x, way.z, way.y);
    }
}
END
    "${CXX:-g++}" -std=c++20 -w -O0 -fwrapv -ffp-contract=off -fsingle-precision-constant -include "$root/tests/cli/export_osl.h" -o "$1" "$1.cc"
}
# Counts the lines of out whose distance is that of the command.
equal_distances() {
    paste -d' ' out truth | awk '{ away = $1 - $12; size = 1 + ($12 < 0 ? -$12 : $12); equal += away * away <= 1e-8 * size * size } END { print equal + 0 }'
}
run export ball.krs --to blender-osl
[ "$status" -eq 0 ] && head -n 1 ball.osl | grep -q untested && head -n 1 ball.blender.py | grep -q untested &&
    grep -q 'float param_radius = 0.5 \[\[ float min = 0.1, float max = 1.0 \]\]' ball.osl && grep -q 'color param_tint = color(1.0, 0.21' ball.osl
result $? "a shader and a script for Blender are written, with parameters and their ranges"
osl_program ball >out 2>err && printf '%s\n' "0.3 0.6 0.8 0" "0.3 0.6 0.8 8" | ./ball >out 2>err
sed 's/-0.000/0.000/g' out >plain
cat >wanted <<'END'
0.5 0.000 0.600 -0.800  1.000 0.216 0.000 0.600  0.300 0.600 -0.800
0.5 0.000 0.600 -0.800  1.000 0.216 0.000 0.600  0.300 0.300 -0.400
END
cmp -s plain wanted
result $? "it has distance, normal and colour beside a ball, and the place on it, with z up"
awk 'BEGIN { srand(7); for (i = 0; i < 200; i++) printf "%.3f %.3f %.3f\n", 8 * rand() - 4, 6 * rand() - 3, 8 * rand() - 4 }' >places
for scene in 12-fractals 23-lighthouse; do
    run export "$root/examples/$scene.krs" --to blender-osl -o $scene.osl
    "$krs" query --quiet "$root/examples/$scene.krs" <places >truth 2>err
    osl_program $scene >out 2>err && sed 's/$/ 0/' places | ./$scene >out 2>err
    [ "$(equal_distances)" -eq 200 ]
    result $? "$scene has the distances of \`krs query\` there"
done
sed 's/away = krs_distance/away = 1.001 * krs_distance/' 23-lighthouse.osl >wrong.osl
osl_program wrong >out 2>err && sed 's/$/ 0/' places | ./wrong >out 2>err
[ "$(wc -l <out)" -eq 200 ] && [ "$(equal_distances)" -lt 150 ]
result $? "others would be seen"
if command -v oslc >/dev/null; then
    oslc -q -o ball.oso ball.osl >out 2>err && oslc -q -o 12-fractals.oso 12-fractals.osl >>out 2>>err
    result $? "oslc compiles shaders"
else
    skip "oslc compiles shaders" "no oslc"
fi
python3 -m py_compile ball.blender.py >out 2>err
result $? "Python reads the script"
if command -v blender >/dev/null; then
    "$krs" mesh ball.krs -o ball.glb --quiet --error 0.02
    cat >asked.py <<'END'
import bpy
print([thing.name for thing in sorted(bpy.context.scene.objects, key=lambda thing: thing.name)],
      [round(x, 1) for x in bpy.data.objects["ball"].dimensions], [round(x, 1) for x in bpy.context.scene.camera.location])
END
    blender -b --factory-startup --python-expr "import numpy; numpy.bool = bool" --python ball.blender.py --python asked.py >out 2>err
    grep -qF "['Camera.001', 'Light.001', 'ball'] [1.0, 1.0, 1.0] [0.0, -4.0, 0.0]" out
    result $? "Blender builds its scene"
else
    skip "Blender builds its scene" "no blender"
fi

run export ball.krs
said 2 "--to shadertoy" "what for must be said"
run export ball.krs --to blender
said 2 "shadertoy, three, glsl, essl, wgsl, hlsl, msl, godot, unity, unreal or blender-osl" "other programs are told"
run export ball.krs --to three -o missing/folder/x.mjs
ended 73 "a folder that is not there is told"
