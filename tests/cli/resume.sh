#!/bin/sh
# resume.sh: a render that is killed goes on with `--resume`, and its files are those of one that was
# not, byte by byte.
# shellcheck source-path=SCRIPTDIR disable=SC2016,SC2086
. "$(dirname "$0")/common.sh"
plan 18

cat >scene.krs <<'END'
param radius = 1 in [0.1, 2];
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }
material glass { color: white, roughness: 0.02, transmission: 1 }
show sphere(radius).move([0, 1, 0]).paint(glass); show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);
show plane([0, 1, 0], 0).paint(mix(#888888, #dddddd, x * 0.1));
END
# Long enough to have checkpoints, which are written every 0.1 seconds.
KRS_TEST_CHECKPOINT=0.1
export KRS_TEST_CHECKPOINT
scene="scene.krs --integrator path --size 160x120 --aov all --cryptomatte"
how="$scene --samples 240"
run render $how -o whole.exr -o whole.png --quiet
ended 0 "a picture at once"

# Starts the command, waits for a checkpoint that is not the last one, and ends it by a signal.
before=none
cut_short() { # signal; `-`, to end all its processes, or nothing
    setsid "$krs" render $how --resume -o part.exr -o part.png >out 2>err </dev/null &
    leader=$! tries=0
    until [ -e part.exr.part ] && [ "$(stat -c %y part.exr.part)" != "$before" ]; do
        tries=$((tries + 1))
        [ $tries -gt 6000 ] && break
        sleep 0.02
    done
    kill "-$1" "$2$leader"
    wait $leader 2>/dev/null
    status=$?
    before=$(stat -c %y part.exr.part)
}
cut_short TERM ""
[ "$status" -eq 75 ] && grep -q "the same command goes on" err && [ -s part.exr.part ] && [ ! -e part.exr ]
result $? "an interrupted render ends with status 75, and has a checkpoint and no picture"
cp part.exr.part first.part
cut_short KILL -
[ "$status" -eq 137 ] && [ -s part.exr.part ] && ! cmp -s part.exr.part first.part && [ ! -e part.exr ]
result $? "a killed one has a later checkpoint, and no picture"
cp part.exr.part second.part
run render $how --resume -o part.exr -o part.png
ended 0 "the same command ends"
grep -q "going on after [0-9]* samples of" err
result $? "it says from where"
cmp -s part.exr whole.exr && cmp -s part.png whole.png
result $? "the pictures are those of a render without an interruption"
[ ! -e part.exr.part ] && no_temporaries
result $? "the checkpoint is gone, and so is what the killed one left"

# What changes no picture changes no checkpoint, and the order of options tells nothing.
other="scene.krs --integrator path --size 160x120 --aov all"
cp second.part part.exr.part
run render --samples=240 --cryptomatte -o part.exr -o part.png $other --stats --color never --resume
[ "$status" -eq 0 ] && grep -q "going on after" err && cmp -s part.exr whole.exr
result $? "options that change no picture, in another order, go on"

# What is no checkpoint of this command is not used.
run render $scene --samples 1 -o one.exr --quiet
anew() { # words, what was tested
    run render $scene --samples 1 --resume -o part.exr
    [ "$status" -eq 0 ] && grep -q "$1; rendering begins anew" err && cmp -s part.exr one.exr
    result $? "$2"
}
cp second.part part.exr.part
anew "is of another scene, command line or device" "another command line"
head -c 5000 second.part >part.exr.part
anew "is damaged, or no checkpoint" "a checkpoint that is cut off"
cp second.part part.exr.part
printf 'x' | dd of=part.exr.part bs=1 seek=30000 conv=notrunc 2>/dev/null
anew "is damaged, or no checkpoint" "one with another byte"
echo hello >part.exr.part
anew "is damaged, or no checkpoint" "a file that is something else"

# Frames of an animation that are done stay.
cat >moving.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
show sphere(1).move([0, 1 + 0.5 * sin(time), 0]); show plane([0, 1, 0], 0);
END
# Who marches rays is chosen by time otherwise, and pictures of lanes differ by rounding.
moving="moving.krs --rays kernels --size 64x48 --samples 4 --frames 0..3"
run render $moving -o 'w%d.exr' --quiet
ended 0 "frames at once"
run render $moving --resume -o 'f%d.exr' --quiet
same=0
for frame in 0 1 2 3; do cmp -s w$frame.exr f$frame.exr && same=$((same + 1)); done
[ "$status" -eq 0 ] && [ $same -eq 4 ] && [ ! -e f0.exr.part ]
result $? "frames with checkpoints are the same"
# The third cannot be written.
rm -f f?.exr
mkdir f2.exr
run render $moving --resume -o 'f%d.exr'
[ "$status" -ne 0 ] && [ -e f1.exr ] && [ -e f0.exr.part ]
result $? "an animation that fails has a checkpoint"
rmdir f2.exr
touch -d 2001-01-01 f0.exr
run render $moving --resume -o 'f%d.exr'
same=0
for frame in 1 2 3; do cmp -s w$frame.exr f$frame.exr && same=$((same + 1)); done
[ "$status" -eq 0 ] && [ $same -eq 3 ] && [ "$(stat -c %Y f0.exr)" = "$(date -d 2001-01-01 +%s)" ]
result $? "the same command makes the frames that are left"

run render scene.krs --resume --stereo side-by-side -o a.exr
said 2 "two eyes" "two eyes have no checkpoint"
run render scene.krs --resume -o -
said 2 "beside the first output" "nor has standard output"
