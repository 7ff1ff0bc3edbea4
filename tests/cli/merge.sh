#!/bin/sh
# merge.sh: parts of a picture make the file of a render at once, byte for byte, or `krs merge` says why they do not.
# shellcheck source-path=SCRIPTDIR disable=SC2086
. "$(dirname "$0")/common.sh"
plan 14

cat >scene.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }
sky { zenith: #9fb8d0, horizon: #e9dccb, ground: #b09478 }
material gold { color: #ffcc66, metallic: 1, roughness: 0.2 }
let ball = sphere(0.6).move([0, 0.6, 0]).paint(gold);
let block = box([0.9, 0.9, 0.9]).move([-1.4, 0.5, -0.6]).paint(#337755);
show ball; show block; show plane([0, 1, 0], 0).paint(#888888);
END
how="scene.krs --size 70x50 --samples 3 --rays kernels --quiet"
cut() { # options, names of four parts that begin with it
    run render $how $1 --crop 0,0,33,21 -o "$2a.exr"
    run render $how $1 --crop 33,0,37,40 -o "$2b.exr"
    run render $how $1 --crop 0,21,33,29 -o "$2c.exr"
    run render $how $1 --crop 33,40,37,10 -o "$2d.exr"
}
for options in "--aov all --cryptomatte" "--integrator path --light-groups" "--aov none"; do
    name=${options##*[ -]}
    cut "$options" "$name"
    run render $how $options -o "$name.exr"
    run merge "${name}d.exr" "${name}a.exr" "${name}c.exr" "${name}b.exr" -o whole.exr
    ended 0 "parts are merged: $options"
    cmp -s "$name.exr" whole.exr
    result $? "they are the picture that is rendered at once"
done
run render $how --aov none --crop 0,0,70,40 -o top.exr
run merge nonea.exr noneb.exr nonec.exr -o part.exr
said 74 "370 pixels between the files are missing" "a hole is told of"
run merge nonea.exr noneb.exr -o part.exr
[ "$status" -eq 74 ] && [ ! -e part.exr ]
result $? "and nothing is written"
run merge nonea.exr top.exr -o part.exr
said 74 "both have pixels at 0, 0" "what is there twice, too"
run render $how --aov none --time 2 --crop 0,21,33,29 -o other.exr
run merge nonea.exr other.exr -o part.exr
said 74 "they are not of one render" "parts have equal times"
run merge nonea.exr cryptomattec.exr -o part.exr
said 74 "they have other channels" "and equal channels"
run merge nonea.exr nonec.exr -o nonea.exr
ended 2 "an output that is a part is refused"
run merge nonea.exr scene.krs -o part.exr
ended 74 "what is no EXR is refused"

# Where bytes of a part are spoilt, merging ends with a status that says so, or is done.
cat >spoil.py <<'END'
import random, subprocess, sys
krs, whole = sys.argv[1], open('nonec.exr', 'rb').read()
random.seed(5)
wrong = refused = 0
for turn in range(60):
    spoilt = bytearray(whole)
    at = random.randrange(len(whole) if turn % 2 else 600)
    if turn % 3:
        spoilt[at] = random.randrange(256)
    else:
        del spoilt[at:]
    open('spoilt.exr', 'wb').write(spoilt)
    run = subprocess.run([krs, 'merge', 'nonea.exr', 'spoilt.exr', '-o', 'part.exr'], capture_output=True)
    refused += run.returncode == 74
    wrong += run.returncode not in (0, 74)
print(wrong, 'wrong', 'some refused' if refused > 15 else 'none refused')
END
python3 spoil.py "$krs" >out
grep -q '^0 wrong some refused' out
result $? "parts that are spoilt are refused, or merged"
