#!/bin/sh
# compositors.sh: other programs find in an EXR what they expect, where they are installed: exrinfo,
# oiiotool and Blender's compositor.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 9
compile_exr exr_text
cat >parts.krs <<'END'
camera { eye: [0, 1.2, 6], target: [0, 0.5, 0], fov: 40deg }
image { size: [64, 36], samples: 16 }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }
let ground = plane([0, 1, 0], 0).paint(gray);
let ball = sphere(0.5).move([0, 0.5, 0]).paint(tomato);
show ground;
show ball;
END
has() { command -v "$1" >/dev/null; }
# Whether a channel of one file is that of another: file, channel, file, channel.
same() {
    ./exr_text "$1" "$2" | cut -d' ' -f2- | sort >one.txt
    ./exr_text "$3" "$4" | cut -d' ' -f2- | sort >other.txt
    [ -s one.txt ] && cmp -s one.txt other.txt
}

run render parts.krs --quiet --cryptomatte --aov Z,P,N,albedo,id,steps,noise -o all.exr
ended 0 "a picture with everything but lights"
run render parts.krs --quiet --light-groups --aov none -o lights.exr
ended 0 "a picture with lights"

if has exrinfo; then
    exrinfo -s all.exr >out 2>err # its status is no number of anything in Debian 12
    [ ! -s err ] && grep -q "64 x 36" out
    result $? "exrinfo finds no fault"
else
    skip "exrinfo finds no fault" "exrinfo is not installed"
fi
if has oiiotool; then
    oiiotool all.exr --ch P.X,P.Y,P.Z -o part.exr >out 2>err && same part.exr P.Y all.exr P.Y
    result $? "oiiotool takes a layer"
    oiiotool --info -v all.exr >out 2>err &&
        grep -q 'worldToCamera: ' out && grep -q 'cryptomatte/.*manifest: .*"ball"' out
    result $? "oiiotool reads the matrices and the manifests"
else
    skip "oiiotool takes a layer" "oiiotool is not installed"
    skip "oiiotool reads the matrices and the manifests" "oiiotool is not installed"
fi
blend() { # file, the matte's component
    blender -b --factory-startup --python "$root/tests/cli/compositor.py" -- \
        "$PWD/$1" "$2" "$PWD" >out 2>err
}
if has blender; then
    blend all.exr ball
    grep -q '^passes Alpha Combined CryptoComponent00 .* Depth N P albedo noise samples$' out
    result $? "Blender offers passes by their names"
    same colours.exr R all.exr R && same colours.exr A all.exr A
    result $? "its compositor has the colours"
    ./exr_text all.exr id.component | awk '$4 == 2 { print $2, $3 }' | sort >inside.txt
    ./exr_text matte.exr R | awk '{ sum += $4 } $4 > 0.99 { print $2, $3 }
        END { exit !(sum > 40 && sum < 70) }' >whole.txt
    covered=$?
    [ $covered = 0 ] && [ -s whole.txt ] && sort whole.txt | comm -23 - inside.txt >beyond.txt &&
        [ ! -s beyond.txt ]
    result $? "its Cryptomatte picks the component"
    blend lights.exr ball
    grep -q '^layer light: sun$' out
    result $? "lights are passes of the layer light"
else
    for what in "Blender offers passes by their names" "its compositor has the colours" \
        "its Cryptomatte picks the component" "lights are passes of the layer light"; do
        skip "$what" "blender is not installed"
    done
fi
