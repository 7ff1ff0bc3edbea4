#!/bin/sh
# pictures.sh: what is in the files that `krs render` writes.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 26
compile_exr exr_text

picture() { run render ball.krs --quiet --size 41x33 "$@"; }
pixel() { # file, channel, x, y
    ./exr_text "$1" "$2" | awk -v x="$3" -v y="$4" '$2 == x && $3 == y { print $4 }'
}
# Whether a number is within 1e-3 of another.
near() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a - b < 1e-3 && b - a < 1e-3) }'; }

picture -o a.exr -o a.png
ended 0 "a picture in two forms"
picture -o b.exr -o b.png
cmp -s a.exr b.exr && cmp -s a.png b.png
result $? "equal renders are equal files"
# glibc fills memory that is taken with this byte's opposite, lavapipe's included: what is read before
# it is written shows.
for byte in 0 1 85 170; do
    MALLOC_PERTURB_=$byte run render "$root/bench/scenes/bulb.krs" --quiet --rays kernels --size 192x108 -o "m$byte.exr"
done
cmp m0.exr m1.exr && cmp m0.exr m85.exr && cmp m0.exr m170.exr
result $? "pictures do not depend on what was in memory"
picture -o stamped.exr --stamp
! cmp -s a.exr stamped.exr
result $? "a stamp makes a difference"

# The camera stands 5 units in front of the ball, whose radius is 1.
near "$(pixel a.exr Z 20 16)" 4 && near "$(pixel a.exr N.Z 20 16)" 1 &&
    near "$(pixel a.exr P.Z 20 16)" 1 && [ "$(pixel a.exr A 20 16)" = 1 ] &&
    [ "$(pixel a.exr id.component 20 16)" = 1 ] && [ "$(pixel a.exr steps 20 16)" -ge 1 ]
result $? "the middle of the picture sees the ball"
[ "$(pixel a.exr Z 0 0)" = inf ] && [ "$(pixel a.exr A 0 0)" = 0 ] &&
    [ "$(pixel a.exr N.X 0 0)" = 0 ] && [ "$(pixel a.exr P.Y 0 0)" = 0 ] &&
    [ "$(pixel a.exr id.component 0 0)" = 0 ]
result $? "a corner sees nothing"
[ "$(pixel a.exr N.Y 20 9 | cut -c1)" != - ] && [ "$(pixel a.exr N.Y 20 23 | cut -c1)" = - ]
result $? "row 0 is the top"

channels() { ./exr_text "$1" | cut -d' ' -f1 | sort -u | tr '\n' ' '; }
picture --crop 11,7,17,19 -o crop.exr
./exr_text a.exr | awk '$2 >= 11 && $2 < 28 && $3 >= 7 && $3 < 26' | sort >part
./exr_text crop.exr | sort >cropped
[ "$(wc -l <cropped)" -eq $((17 * 19 * $(channels a.exr | wc -w))) ] && cmp -s part cropped
result $? "a crop is the same part of the whole picture, in every channel"
picture --samples 4 -o four.exr
./exr_text four.exr Z >four_z && ./exr_text a.exr Z >one_z && cmp -s four_z one_z
result $? "AOVs come from the ray through the centre, however many samples"
picture --set radius=0.5 -o small.exr
near "$(pixel small.exr Z 20 16)" 4.5
result $? "a param changes the picture"
picture --camera side -o side.exr
near "$(pixel side.exr P.X 20 16)" 1
result $? "another camera"

picture --stereo side-by-side -o pair.exr
[ "$(./exr_text pair.exr A | sort -n -k2 | tail -n 1 | cut -d' ' -f2)" = 81 ] &&
    [ "$(./exr_text pair.exr A | cut -d' ' -f3 | sort -n | tail -n 1)" = 32 ]
result $? "two eyes are twice as wide"
picture --stereo over-under -o pair.exr -o pair.png
[ "$(./exr_text pair.exr A | cut -d' ' -f3 | sort -n | tail -n 1)" = 65 ]
result $? "or twice as high"
picture --white-balance 3200 --tone-map none -o warm.png && picture --tone-map none -o plain.png &&
    picture --white-balance 6504,9.6 --pixel-filter gaussian --tone-map none -o day.png
! cmp -s warm.png plain.png
result $? "white balance changes a PNG"

picture --aov none -o none.exr
[ "$(channels none.exr)" = "A B G R " ]
result $? "no AOVs"
picture --aov Z,id -o some.exr
[ "$(channels some.exr)" = "A B G R Z id.component id.instance id.level " ]
result $? "some AOVs"

if command -v exrheader >/dev/null; then
    exrheader crop.exr >header
    grep -q 'dataWindow.*(11 7) - (27 25)' header &&
        grep -q 'displayWindow.*(0 0) - (40 32)' header &&
        grep -q 'R, 16-bit floating-point' header && grep -q ' Z, 32-bit floating-point' header &&
        grep -q 'id.component, 32-bit unsigned' header && grep -q 'compression.*zip' header &&
        grep -q 'krs:parameters.*"radius=1"' header && grep -q 'krs:time.*"0"' header &&
        grep -q 'worldToCamera' header && grep -q 'worldToNDC' header &&
        grep -q 'software.*"krs ' header && ! grep -q 'krs:date' header
    result $? "the header of an EXR"
    exrheader stamped.exr >header
    grep -q 'krs:date' header && grep -q 'krs:device' header && grep -q 'krs:seconds' header
    result $? "the header of a stamped EXR"
else
    skip "the header of an EXR" "no exrheader"
    skip "the header of a stamped EXR" "no exrheader"
fi
# Width, height, 8 bits, colour type 2 (RGB), in the bytes of IHDR.
[ "$(od -An -tx1 -j16 -N10 a.png | tr -d ' \n')" = 00000029000000210802 ] &&
    grep -aq 'krs:parameters' a.png && grep -aq 'Software' a.png && grep -aq sRGB a.png
result $? "the header of a PNG"

picture --frames 3..5 --set radius=0.75 -o 'f-%04d.exr' -o 'f%d.png' --stats json
[ "$status" -eq 0 ] && [ -s f-0003.exr ] && [ -s f-0005.exr ] && [ -s f4.png ] &&
    [ ! -e f-0002.exr ] && [ ! -e f-0006.exr ]
result $? "frames are inclusive"
is_json <out && [ "$(wc -l <out)" -eq 3 ] && grep -q '"frame": 5' out
result $? "statistics of every frame"
picture --stats json -o a.exr
is_json <out && [ "$(wc -l <out)" -eq 1 ]
result $? "statistics are one JSON object"
missing=""
passes=$(sed -n 's/^PASS.*[( ]\([a-z]*\), *\(NULL\|validate_[a-z]*\),.*/\1/p' "$root/compiler/passes/passes.def")
# shellcheck disable=SC2086 # names without blanks
for member in compile front glsl spirv pipeline passes $passes render beams primary normals shadows occlusion shading resolve total wall \
    executor rays evaluations evaluations_per_ray flops_per_evaluation gflops unresolved device \
    peak_memory_bytes kernels name glsl_bytes spirv_ms driver_ms cached; do
    grep -q "\"$member\":" out || missing="$missing $member"
done
[ -z "$missing" ]
result $? "statistics have every member$missing"
named=""
for who in lanes kernels; do
    run render ball.krs --size 41x33 --rays $who --stats json -o a.exr
    named="$named $(sed -n 's/.*"executor": "\([a-z]*\)".*/\1/p' out)"
done
run render ball.krs --size 41x33 --rays lanes --stats -o a.exr
[ "$named" = " lanes kernels" ] && grep -q '^executor  *lanes$' out
result $? "statistics tell who marched the rays"
run render ball.krs --size 41x33 --stats -o a.exr
[ "$status" -eq 0 ] && grep -q '^rays ' out && ! grep -q Progress out
result $? "statistics as text"

echo 'camera { eye: [1, 2, 5], target: [0, 0, 0] } show algebraic(x^4 + y^4 + z^4 == 1);' >quartic.krs
traces() { # size; beams before roots have a kernel of their own
    run render quartic.krs --quiet --stats json --crop 0,0,8,8 --size "$1" -o quartic.exr
    grep -o '"trace.comp"' out | wc -l
}
[ "$(traces 640x360)" -eq 1 ] && [ "$(traces 1280x720)" -eq 2 ]
result $? "few samples have few kernels, and a crop has those of its picture"
