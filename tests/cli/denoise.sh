#!/bin/sh
# denoise.sh: `krs denoise` takes noise out of files of any program, and `krs render --denoise` out of its own, and leaves
# what was there.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 38
tool() { python3 "$root/tests/cli/denoise.py" "$@"; }

# The error is at most this part of that before, and all else is as it was.
fell() { # input, output, the part, what was tested
    tool judge "$1" "$2" >judged
    read -r kept part <judged
    [ "$kept" = kept ] && awk "BEGIN { exit !($part < $3) }"
    result $? "$4: $(cat judged)"
}

# ---- files of others ----
for name in blender pbrt mitsuba tiles crop broken bare; do
    tool make $name $name.exr
    run denoise $name.exr
    ended 0 "$name is denoised"
    fell $name.exr $name-denoised.exr "$([ $name = bare ] && echo 0.3 || echo 0.1)" "its error falls"
    grep -v Progress err >$name.err
done
[ ! -s pbrt.err ]
result $? "nothing is said where nothing is missing"
grep -q "noise of its pixels" blender.err && ! grep -q "normals" blender.err
result $? "noise that is unknown is told of"
grep -q "no normals, no albedo, neither position nor depth" bare.err
result $? "and all else that is missing"
tool judge pbrt.exr pbrt-denoised.exr >judged
cp pbrt-denoised.exr again.exr
run denoise again.exr -o twice.exr
cmp -s twice.exr pbrt-denoised.exr
result $? "what was denoised is denoised anew from its own colours: the same bytes"
run denoise pbrt.exr -o quiet.png -o few.exr
[ -s quiet.png ] && cmp -s few.exr pbrt-denoised.exr
result $? "several files, and a PNG"
taskset -c 0 "$krs" denoise pbrt.exr -o one.exr 2>err
cmp -s one.exr pbrt-denoised.exr
result $? "one processor makes the same bytes"
run denoise blender.exr --layer ViewLayer -o layer.exr
cmp -s layer.exr blender-denoised.exr
result $? "a layer is named"

# ---- what is refused ----
run denoise blender.exr --layer Other -o no.exr
said 74 "no colours of the layer Other" "a layer that is not there"
tool make gray gray.exr
run denoise gray.exr -o no.exr
said 74 "no colours" "no colours"
tool make part part.exr
run denoise part.exr -o no.exr
said 74 "it has samples 0..63/128 alone" "some of the samples"
head -c 3000 pbrt.exr >short.exr
run denoise short.exr -o no.exr
ended 74 "a file that ends too early"
echo "no picture" >text.exr
run denoise text.exr -o no.exr
ended 74 "what is no EXR"
run denoise none.exr -o no.exr
ended 74 "a file that is not there"
[ ! -e no.exr ]
result $? "and nothing is written"
run denoise pbrt.exr -o pbrt.exr
ended 2 "the output is not the input"
run denoise pbrt.exr -o no.jpg
ended 2 "nor of another form"

# ---- renders ----
cat >scene.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
sky { zenith: #9fb8d0, horizon: #e9dccb, ground: #b09478 }
show sphere(0.6).move([0, 0.6, 0]).paint(#cc6633);
show plane([0, 1, 0], 0).paint(#888888);
END
how="scene.krs --size 70x50 --samples 16 --integrator path --quiet"
# shellcheck disable=SC2086 # words are meant
{
    run render $how --aov Z,P,N,albedo,noise -o raw.exr -o raw.png
    ended 0 "a render"
    run render $how --aov Z,P,N,albedo,noise --denoise -o own.exr -o own.png
    ended 0 "--denoise"
    run denoise raw.exr -o file.exr --quiet
    cat >same.py <<'END'
import sys
sys.path.insert(0, sys.argv[1])
from denoise import read, numbers
raw, own, file = (read(name)[0] for name in ("raw.exr", "own.exr", "file.exr"))
alike = max(abs(a - b) for c in "RGB" for a, b in zip(numbers(own["denoised." + c]), numbers(file["denoised." + c])))
sys.exit(not (all(own[name] == raw[name] for name in raw) and alike < 0.01))
END
    python3 same.py "$root/tests/cli"
    result $? "raw channels are those of a render without it, and a file gives nearly the same result"
    ! cmp -s raw.png own.png
    result $? "a PNG shows the result"
    run render $how --denoise --crop 0,0,30,30 -o no.exr
    said 2 "what \`krs merge\` makes" "parts are denoised after they are merged"
    run render $how --denoise --light-groups -o no.exr
    ended 2 "groups of lights have no noise"
    run render $how --denoise --stereo side-by-side -o no.exr
    ended 2 "nor two pictures neighbours"
}
run farm submit scene.krs --denoise -o no.exr --size 70x50
said 2 "--denoise" "nor a farm"
