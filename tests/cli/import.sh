#!/bin/sh
# import.sh: files of other programs become scenes that show what they showed, or are refused
# with the line that is wrong; no file, whatever is in it, ends in a crash.
# shellcheck source-path=SCRIPTDIR disable=SC2016
. "$(dirname "$0")/common.sh"
plan 66

cat >ball.vm <<'END'
# a ball of radius 0.75 with its upper half cut away, and a line that does not count

_0 const 1e-1
_x var-x
_1 square _x
_y var-y
0x6000 square _y
_z var-z
_3 mul _z _z
_4 add _1 0x6000
_5 add _4 _3
_6 sqrt _5
_7 const -.75
_8 add _6 _7
unused sin _x
_9 max _8 _y
END
cat >torus.jsurf <<'END'
#jSurfer surface description
#with a comment
surface_equation=(x^2+y^2+z^2+.5^2-b^2)^2 - 4*.5^2*(x^2+\
    y^2)
surface_parameter_b=0.2
surface_parameter_a = 7
camera_type: ORTHOGRAPHIC_CAMERA
camera_height=2.0
camera_transform=1.0 0.0 0.0 -0.0  0.0 1.0 0.0 -0.0  0.0 0.0 1.0 -1.0  0.0 0.0 0.0 1.0
rotation_matrix=1.0 0.0 0.0 0.0 0.0 0.0 -1.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 0.0 1.0
scale_factor=0.30102999566
front_material_color=1.0 0.0 0.0
back_material_color=0.0 1.0 0.0
light_status_0=ON
light_position_0=0.0 0.0 100.0
light_status_1=OFF
light_position_1=0.0 100.0 0.0
background_color=1 1 1
END

run import ball.vm -o ball_of_tape.krs
[ "$status" -eq 0 ] && [ ! -s out ] && [ ! -s err ]
result $? "a tape is written to a file, silently"
run check ball_of_tape.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "and is a scene without a mistake"
! grep -q sin ball_of_tape.krs
result $? "without what does not count for it"
run import ball.vm
[ "$status" -eq 0 ] && cmp -s out ball_of_tape.krs
result $? "or to standard output"

# t of rays, to four digits.
ask() { # scene, ray, t
    printf '%s\n' "$2" | "$krs" query "$1" >out 2>err
    status=$?
    [ "$status" -eq 0 ] && [ "$(awk '{ printf "%.4f", $1 }' out)" = "$3" ]
    result $? "a ray from $2 goes $3 to $1"
}
ask ball_of_tape.krs '0 -3 0 0 1 0' 2.2500
ask ball_of_tape.krs '0.1 3 0 0 -1 0' 3.0000
ask ball_of_tape.krs '3 -0.2 0 -1 0 0' 2.2772

run import torus.jsurf -o torus.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "a surface of SURFER"
run check torus.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "is a scene without a mistake"
grep -q '^param b = 0.2 in \[0, 1\];$' torus.krs && ! grep -q '^param a' torus.krs
result $? "with the parameters of its equation"
grep -q 'within(sphere(2), open: true)' torus.krs
result $? "in the ball of its zoom"
grep -q '#ff0000 else #00ff00' torus.krs
result $? "in the colours of its sides"
[ "$(grep -c '^light' torus.krs)" -eq 1 ] && grep -q '^light { position: \[0, -202, 0\]' torus.krs
result $? "with the lights that are on, where they are"
grep -q 'eye: \[0, -8, 0\]' torus.krs && grep -q 'up: \[0, 0, 1\]' torus.krs &&
    grep -q 'height: 4$' torus.krs
result $? "and its camera"
# The outer radius is 0.7; a sheet has a thickness of about 0.007.
printf '5 0 0 -1 0 0\n' | "$krs" query torus.krs >out 2>err
status=$?
awk '{ exit !($1 > 4.29 && $1 < 4.301) }' out
result $? "a ray meets the torus where it is"
run render torus.krs --size 32x32 -o torus.png
[ "$status" -eq 0 ] && [ -s torus.png ]
result $? "it can be rendered"

refused() { # file, text, words, what
    printf '%b' "$2" >"$1"
    run import "$1"
    said 1 "$1:$3" "$4"
}
refused a.vm '_0 var-x\n_1 squre _0\n' '2: no operation is called `squre`; is it `square`?' \
    "a misspelt operation"
refused a.vm '_0 var-x\n\n_1 add _0\n' '3: `add` needs 2 arguments' "an argument that is missing"
refused a.vm '_0 var-x\n_1 neg _0 _0\n' '2: `neg` has too many arguments' "an argument too much"
refused a.vm '_0 neg _1\n_1 var-x\n' '1: no line before this one is called `_1`' \
    "a name used before its line"
refused a.vm '_0 const 1x\n' '1: `1x` is not a finite number' "a number that is none"
refused a.vm '_0 const inf\n' '1: `inf` is not a finite number' "infinity"
refused a.vm '_0\n' '1: a line is a name' "a line without an operation"
refused a.vm '_0 const 1\n_1 sin _0' '2: what comes last does not depend' \
    "a tape without coordinates"
refused a.vm '# nothing\n' '1: there is no operation' "an empty tape"
refused a.jsurf 'camera_height=2\n' '1: there is no surface_equation' "no equation"
refused a.jsurf '\nsurface_equation=x^2+c\n' \
    '2: the equation uses `c`, but there is no surface_parameter_c' "an unknown parameter"
refused a.jsurf 'surface_equation=x^2+(y\n' '1: the equation ends where there should be' \
    "an open parenthesis"
refused a.jsurf 'surface_equation=x^2+2y\n' '1: the equation has `y` at place 6' \
    "a product without its sign"
refused a.jsurf 'surface_equation=x\\=0\n' '1: the equation has `=0` at place 2' \
    "an equation with two sides"
refused a.jsurf 'surface_equation=foo(x)\n' '1: no function is called `foo`' "an unknown function"
refused a.jsurf 'surface_equation=x\nscale_factor=\n' '2: `scale_factor` needs 1 number' \
    "a number that is missing"
refused a.jsurf 'surface_equation=x\nscale_factor=9\n' '2: `scale_factor` leads out of' \
    "too much zoom"
refused a.jsurf 'surface_equation=x\nrotation_matrix=1 0 0 0 0 2 0 0 0 0 1 0 0 0 0 1\n' \
    '2: `rotation_matrix` does more than turn' "a space that is stretched"
refused a.jsurf 'surface_equation=x\ncamera_type=FISHEYE\n' '2: no camera is a `FISHEYE`' \
    "an unknown camera"
nested=$(awk 'BEGIN { for (i = 0; i < 5000; i++) printf "(" }')
refused a.jsurf "surface_equation=$nested" '1: the equation is more than 60 deep' \
    "parentheses without end"

run import ball.krs
said 2 "ends in none of .jsurf .vm .csg .pov .svg" "a file of another kind"
run import bolt.scad
said 2 "of .jsurf .vm .csg .pov .svg; \`openscad -o part.csg part.scad\` makes one" "a text of OpenSCAD"
run import bolt.STL
said 2 "krs makes meshes, but reads none" "a mesh"
run import missing.vm
said 74 "cannot read \`missing.vm\`" "a missing file"
run import ball.vm -o nowhere/ball.krs
said 73 "nowhere/ball.krs" "an output that cannot be created"
printf '_0 var-x\0\n' >nul.vm
run import nul.vm
said 1 "not a text" "a NUL byte"

# A disc of radius 1, since the longer side of the view becomes 4.
mkdir -p drawings scenes
cat >drawings/disc.svg <<'END'
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">
  <circle cx="100" cy="50" r="50" fill="red"/>
</svg>
END
run import drawings/disc.svg -o drawings/disc.krs
[ "$status" -eq 0 ] && grep -q 'svg("disc.svg", size: 4)' drawings/disc.krs
result $? "a drawing is named as seen from the scene beside it"
printf '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">\n<rect width="5" height="5"/>\n<text y="5">Hi</text>\n</svg>\n' >drawings/text.svg
run import drawings/text.svg -o drawings/text.krs
[ "$status" -eq 0 ] && grep -q '^krs: drawings/text.svg:3: note: left out: elements `text`$' err
result $? "what a drawing has and shapes do not is noted with its line"
run import drawings/disc.svg -o scenes/disc.krs
[ "$status" -eq 0 ] && run check scenes/disc.krs && [ "$status" -eq 0 ]
result $? "a drawing in another folder"
run import drawings/disc.svg -o disc.krs
run info disc.krs
grep -q 'bounds \[-1, -1, -0.1\] to \[1, 1, 0.1\]' out
result $? "a drawing has its place and size"
printf 'show svg("disc.svg")[0].extrude(1);' >confined.krs
cp drawings/disc.svg .
run check --root scenes confined.krs
[ "$status" -ne 0 ]
result $? "a drawing outside of the root is not read"

# Trees of OpenSCAD and scenes of POV-Ray; tests/oracle/imports_*.c look at what is in them.
printf 'difference() {\n cube(size = 2);\n sphere(r = 1);\n}\n' >cut.csg
run import cut.csg -o cut.krs
[ "$status" -eq 0 ] && grep -q '^let cube_1 = box(\[2, 2, 2\]).move(\[1, 1, 1\]); // line 2$' cut.krs
result $? "a tree of OpenSCAD, a line for each part"
run check cut.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "is a scene without a mistake"
printf '#declare Ball = sphere { 2*z, 1 }\nobject { Ball pigment { rgb x } }\n' >ball.pov
run import ball.pov -o ball_of_pov.krs
[ "$status" -eq 0 ] && grep -q '^let Ball = sphere(1).move(\[0, 0, -2\]); // line 1$' ball_of_pov.krs
result $? "a scene of POV-Ray, with its names"
run check ball_of_pov.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "is a scene without a mistake, too"
# What the head of a scene says is left out is said at once, too; --keep-going names what it leaves out.
printf 'sphere { 0, 1 finish { brilliance 2 } }\nmesh { }\nbox { 2, 3 }\n' >rest.pov
run import rest.pov -o rest.krs
said 1 'rest.pov:2: `mesh` is not translated' "a part that scenes do not have"
run import --keep-going rest.pov -o rest.krs
[ "$status" -eq 0 ] && grep -q 'left out: rest.pov:2: `mesh` is not translated' err &&
    grep -q 'rest.pov:1: note: `brilliance` of a finish is left out' err &&
    grep -q 'Line 2: a part is left out' rest.krs && grep -q '^show box' rest.krs
result $? "is left out with --keep-going, by name and line"
run check rest.krs
[ "$status" -eq 0 ]
result $? "and the rest is a scene"
run import --keep-going --quiet rest.pov -o rest.krs
[ "$status" -eq 0 ] && ! grep -q 'note:' err
result $? "--quiet says no notes"
refused a.csg 'cube();\nimport();\n' '2: `import` is not translated' "a mesh of OpenSCAD"
# What an included file declares counts where it is used.
printf '#declare Odd = union { bicubic_patch { x, y, z } }\n#declare Bare = mesh { }\n#declare Good = sphere { 0, 1 }\n' >odd.inc
refused a.pov '#include "odd.inc"\nobject { Good }\nobject { Odd }\n' '3: of `Odd`: `bicubic_patch` is not translated' \
    "an object of an included file that cannot be said"
refused a.pov '#include "odd.inc"\n#declare Two = union { object { Good } object { Odd } }\nobject { Two }\n' \
    '2: of `Odd`: `bicubic_patch`' "a union with it"
printf '#include "odd.inc"\nobject { Good }\n#ifdef (Odd) sphere { 5*x, 1 } #end\n' >used.pov
run import used.pov -o used.krs
[ "$status" -eq 0 ] && [ "$(grep -c '^show' used.krs)" -eq 2 ] && ! grep -q 'bicubic_patch\|mesh' used.krs err
result $? "a file that includes it and does not show it"
printf '#include "odd.inc"\nobject { Good }\nobject { Bare }\n' >used.pov
run import --keep-going used.pov -o used.krs
[ "$status" -eq 0 ] && [ "$(grep -c '^show' used.krs)" -eq 1 ] && grep -q 'left out: used.pov:3: of `Bare`: `mesh`' err
result $? "one that shows it, with --keep-going"
refused a.pov 'sphere { 0, 1 }\nmesh { }\n' '2: `mesh` is not translated' "a mesh of POV-Ray"

# Damaged files: the exit status is 0 or 1, and what is written is understood or refused in turn.
damaged() { # file, ending
    size=$(wc -c <"$1") crashed=""
    for turn in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24; do
        at=$((turn * 7919 % size))
        octal=$((turn * 37 % 256 / 64))$((turn * 37 % 64 / 8))$((turn % 8))
        { head -c "$at" "$1"; printf "%b" "\\0$octal"
          [ $((turn % 3)) -eq 0 ] || tail -c +$((at + 1 + turn % 5)) "$1"; } >"damaged.$2"
        run import "damaged.$2"
        [ "$status" -le 1 ] || crashed="$crashed $turn:$status"
        [ "$status" -eq 0 ] || continue
        cp out damaged.krs
        run check damaged.krs
        [ "$status" -le 1 ] || crashed="$crashed $turn:check:$status"
    done
    [ -z "$crashed" ]
    result $? "damaged files of .$2 do no harm$crashed"
}
damaged ball.vm vm
damaged torus.jsurf jsurf
damaged disc.svg svg
head -c 65536 /dev/urandom | tr -d '\0' >noise.vm
cp noise.vm noise.jsurf
run import noise.vm
[ "$status" -eq 1 ]
result $? "noise for a tape"
run import noise.jsurf
[ "$status" -eq 1 ]
result $? "noise for a surface"
