#!/bin/sh
# light_groups.sh: the channels of lights add up to the picture, and each is what its light makes.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 11
compile_exr exr_text
cat >lights.krs <<'END'
param power = 2 in [0, 9];
camera { eye: [0, 1.2, 6], target: [0, 0.5, 0], fov: 40deg }
image { size: [64, 36], samples: 2 }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }
light lamp { position: [1.5, 1.5, 1], intensity: power, color: #ff8800, radius: 0.1 }
light { direction: [0, 0, 1], intensity: 0.2 }
fog { density: 0.05 }
material glow { color: black, emission: [0, 1, 0.5] }
show plane([0, 1, 0], 0);
show sphere(0.6).move([0.5, 0.6, 0]).paint(tomato);
show sphere(0.2).move([-1, 0.2, 1]).paint(glow);
END
# The largest difference of the picture's red and the sum of these channels, by the first file's R.
apart() { # file with R, file with groups, channels...
    of=$1 groups=$2
    shift 2
    { ./exr_text "$of" R && for channel; do ./exr_text "$groups" "$channel.R"; done; } | awk '
        { sum[$2, $3] += $1 == "R" ? $4 : -$4 }
        END { for (at in sum) { off = sum[at] < 0 ? -sum[at] : sum[at]; if (off > most) most = off }
              print most }'
}
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

run render lights.krs --quiet --light-groups --aov none -o a.exr
ended 0 "a picture with groups of lights"
[ "$(./exr_text a.exr | cut -d' ' -f1 | sort -u | tr '\n' ' ')" = "A B G R light.3.B light.3.G \
light.3.R light.lamp.B light.lamp.G light.lamp.R light.sun.B light.sun.G light.sun.R rest.B rest.G \
rest.R " ]
result $? "each light has its channels"
# Five halves are rounded.
below "$(apart a.exr a.exr light.sun light.lamp light.3 rest)" 0.004
result $? "they add up to the picture"
run render lights.krs --quiet --set power=0 -o dark.exr
below "$(apart dark.exr a.exr light.sun light.3 rest)" 0.004 &&
    ! below "$(apart dark.exr a.exr light.sun light.3 rest light.lamp)" 0.1
result $? "without the lamp the picture is what the others make"
[ "$(./exr_text a.exr light.lamp.R | awk '$4 < -0.001' | wc -l)" = 0 ] &&
    [ "$(./exr_text a.exr light.sun.G | awk '$4 > 0.3' | wc -l)" -gt 100 ]
result $? "no light is negative"
# Lights of a loop have one name.
cat >row.krs <<'EOF'
show sphere(1);
show plane([0, 1, 0], -1);
camera { eye: [0, 2, 6] }
for i in 0..3 { light row { position: [2 * i - 2, 3, 2], intensity: 4 + i } }
light { direction: [1, 2, 1], intensity: 0.5 }
image { size: [48, 32] }
EOF
run render row.krs --quiet --light-groups --aov none -o row.exr
ended 0 "lights of one name"
[ "$(./exr_text row.exr | cut -d' ' -f1 | sort -u | tr '\n' ' ')" = "A B G R light.4.B light.4.G \
light.4.R light.row.B light.row.G light.row.R rest.B rest.G rest.R " ] &&
    below "$(apart row.exr row.exr light.row light.4 rest)" 0.004
result $? "are one group"
run render lights.krs --light-groups --clamp-radiance 1 -o b.exr
said 2 "with --clamp-radiance they do not" "what is clamped does not add up"
run render lights.krs --light-groups --stereo over-under -o b.exr
said 2 "--stereo has two" "groups for two eyes"
run render lights.krs --light-groups --aov noise -o b.exr
said 2 "no estimate of their noise" "noise is estimated without groups"
run render lights.krs --light-groups --noise 0.1 -o b.exr
said 2 "where samples end by noise they do not" "samples that end at different times do not add up"
