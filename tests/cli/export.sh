#!/bin/sh
# export.sh: `krs export`: files are complete shaders, numbers of the scene are in them, and what cannot be is refused.
. "$(dirname "$0")/common.sh"
plan 16

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
[ "$status" -eq 1 ] && grep -q 'cannot export .letters.krs. to shadertoy: parts that are alike' err && [ ! -e letters.shadertoy.glsl ]
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

run export ball.krs
said 2 "--to shadertoy" "what for must be said"
run export ball.krs --to blender
said 2 "shadertoy or three" "other programs are told"
run export ball.krs --to three -o missing/folder/x.mjs
ended 73 "a folder that is not there is told"
