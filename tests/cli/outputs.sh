#!/bin/sh
# outputs.sh: an output appears whole or not at all, and says why not.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 49
small="--size 16x12 --quiet"

# shellcheck disable=SC2086 # the options are separate words
picture() { run render ball.krs $small "$@"; }

picture
[ "$status" -eq 0 ] && [ -s ball.exr ] && [ -s ball.png ] && no_temporaries
result $? "the default outputs are SCENE.exr and SCENE.png in the current folder"
run render ball.krs --size 16x12
said 0 "krs: wrote \`ball.exr\` and \`ball.png\`" "what was written is said"
run render ball.krs --size 16x12 --frames 1..2 -o 'f%d.png'
said 0 "krs: wrote frames 1 to 2 to \`f%d.png\`" "what was written of an animation is said"
picture -o same.png
"$krs" render - --size 16x12 --quiet -o - <ball.krs 2>err | cmp -s - same.png
result $? "- is standard input and output"
"$krs" render ball.krs --size 16x12 --quiet -o - >redirected.png 2>err
cmp -s redirected.png same.png
result $? "- in a file"
"$krs" render - --size 16x12 --quiet <ball.krs >out 2>err && cmp -s stdin.png same.png
result $? "the default outputs of standard input"
# Raw frames are the pixels of the PNGs, one after the other.
"$krs" render ball.krs --size 16x12 --quiet --frames 1..3 --raw >raw 2>err &&
    [ "$(wc -c <raw)" = $((3 * 16 * 12 * 3)) ]
result $? "raw frames have three bytes a pixel"
if command -v pngtopnm >/dev/null; then
    pngtopnm same.png | tail -c $((16 * 12 * 3)) | cmp -s - raw -n $((16 * 12 * 3))
    result $? "raw frames are what a PNG shows"
else
    result 0 "raw frames are what a PNG shows # SKIP there is no pngtopnm"
fi
"$krs" render ball.krs --size 640x480 --quiet --frames 1..9 --raw 2>err | head -c 10 >/dev/null
grep -q "cannot write to standard output: Broken pipe" err
result $? "an encoder that ends early is told of"
picture --raw --stats json
said 2 "--raw would go to where --stats goes" "raw frames and statistics on standard output"
picture --raw -o -
said 2 "both go to standard output" "raw frames and a picture on standard output"
if command -v ffmpeg >/dev/null; then
    ffmpeg -loglevel error -f rawvideo -pixel_format rgb24 -video_size 16x12 -framerate 24 -i - \
        -c:v ffv1 -pix_fmt bgr0 film.mkv <raw >out 2>err &&
        ffmpeg -loglevel error -i film.mkv -f rawvideo -pix_fmt rgb24 - </dev/null 2>>err | cmp -s - raw
    result $? "an encoder takes raw frames"
else
    skip "an encoder takes raw frames" "ffmpeg is not installed"
fi
# Noise that changes from frame to frame boils.  What moves here is out of sight.
cat >still.krs <<'END'
camera { eye: [0, 1, 5], target: [0, 0.5, 0], fov: 40deg }
light lamp { position: [2, 3, 1], radius: 1, intensity: 8 }
show sphere(0.7).move([0, 0.7, 0]); show plane([0, 1, 0], 0);
show sphere(0.01).move([0, 50 + time, 0]);
END
run render still.krs --size 32x24 --quiet --integrator path --samples 2 --frames 1..2 --raw
head -c $((32 * 24 * 3)) out >first && tail -c $((32 * 24 * 3)) out | cmp -s - first &&
    run render still.krs --size 32x24 --quiet --integrator path --samples 2 --raw --seed 1 &&
    ! cmp -s out first
result $? "noise stays where it is from frame to frame"
cp ball.png skip-2.png
touch -d 2001-01-01 skip-2.png
run render ball.krs --size 16x12 --frames 1..3 --skip-existing -o 'skip-%d.png'
[ "$status" -eq 0 ] && [ "$(stat -c %Y skip-2.png)" = "$(date -d 2001-01-01 +%s)" ] && [ -s skip-1.png ] && [ -s skip-3.png ]
result $? "a frame that is there is left out"
grep -qF "left out 1 frame whose files are there" err
result $? "what is left out is said"
picture -o - --stats json
said 2 "the picture would go to where --stats goes" "a picture and statistics on standard output"
picture -o a.exr -o a.png
[ "$status" -eq 0 ] && [ -s a.exr ] && [ -s a.png ] && [ ! -s out ]
result $? "several outputs"

picture -o a.png -o a.exr -o a.png
said 2 "the output \`a.png\` is asked for twice" "an output that is asked for twice"
picture -o q.png -o ./q.png
said 2 "the output \`./q.png\` is asked for twice" "an output that is asked for by two paths"
picture --frames 9..10 -o 'q%d.png' -o 'q%02d.png'
said 2 "the output \`q%02d.png\` is asked for twice" "names that are equal in one frame"
picture --frames 1..2 -o 'a%d%d.png'
said 2 "\`a%d%d.png\` has more than one place for the number" "two places for the frame's number"
cp ball.krs named.png && ln -s "$work/named.png" link.png
for output in ./named.png link.png; do
    run render named.png --size 16x12 --quiet -o $output
    [ "$status" -eq 2 ] && grep -qF "would take the place of \`named.png\`" err &&
        cmp -s ball.krs named.png
    result $? "a picture does not take the place of its scene: $output"
done
printf 'surface_equation=x^2 + y^2 + z^2 - 1\n' >ball.jsurf
cp ball.jsurf before
run import ball.jsurf -o ball.jsurf
[ "$status" -eq 2 ] && cmp -s before ball.jsurf
result $? "an import does not take the place of what it reads"

picture -o nowhere/a.exr
said 73 "cannot create \`nowhere/a.exr\`: No such file or directory" "a missing folder"
mkdir folder.exr
picture -o folder.exr
said 73 "Is a directory" "a folder in the place of the output"
printf old >file
picture -o file/a.exr
said 73 "Not a directory" "a file in the place of the folder"
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked && chmod 555 locked
    picture -o locked/a.exr
    said 73 "Permission denied" "a folder that may not be written"
else
    mkdir -p /proc/self/krs 2>/dev/null
    picture -o /proc/a.exr
    said 73 "cannot create \`/proc/a.exr\`" "a folder that cannot be written"
fi

ln -s /dev/full full.exr
picture -o full.exr
said 74 "error while writing \`full.exr\`: No space left on device" "a full device"
ln -s /dev/full full.png
picture -o full.png
said 74 "No space left on device" "a full device, PNG"

# A file may have 8 blocks of 512 or 1024 bytes; some SPIR-V is larger.  (Not tried with a
# picture: drivers that keep their memory in files do not survive the limit.)
run compile ball.krs -o limited
for file in limited/*; do printf old >"$file"; done
(
    ulimit -f 8
    "$krs" compile ball.krs -o limited >out 2>err
)
status=$?
said 74 "error while writing \`limited/ball." "a file that may not grow"
refused=$(sed -n 's/.*error while writing .\(limited[^ ]*\).: .*/\1/p' err)
[ "$(cat "$refused")" = old ] && (cd limited && no_temporaries)
result $? "what was there before stays"

mkdir disk
if [ "$(id -u)" -eq 0 ] && mount -t tmpfs -o size=64k none disk 2>/dev/null; then
    printf old >disk/a.exr
    picture --size 256x256 -o disk/a.exr
    said 74 "No space left on device" "a disk that fills"
    [ "$(cat disk/a.exr)" = old ] && [ "$(find disk -type f | wc -l)" -eq 1 ]
    result $? "a full disk keeps the old file, and nothing else"
    umount disk
else
    skip "a disk that fills" "no right to mount"
    skip "a full disk keeps the old file, and nothing else" "no right to mount"
fi

printf old >target.exr
ln -s target.exr link.exr
picture -o link.exr
[ "$status" -eq 0 ] && [ -L link.exr ] && [ "$(wc -c <target.exr)" -gt 100 ]
result $? "a symbolic link is followed"
ln -s elsewhere.exr dangling.exr
picture -o dangling.exr
[ "$status" -eq 0 ] && [ -L dangling.exr ] && [ "$(wc -c <elsewhere.exr)" -gt 100 ]
result $? "also one that leads to nothing"
chmod 640 target.exr
picture -o target.exr -o fresh.png
[ "$status" -eq 0 ] && [ "$(stat -c %a target.exr)" = 640 ] &&
    [ "$(stat -c %a fresh.png)" = "$(: >made && stat -c %a made)" ]
result $? "a picture that is written again keeps its permissions"
: >.krs-1-1.tmp
picture -o target.exr
[ "$status" -eq 0 ] && no_temporaries
result $? "what a killed run has left is removed"
if strace -o /dev/null true 2>/dev/null; then
    # shellcheck disable=SC2086
    strace -f -o /dev/null -e trace=fsync -e inject=fsync:error=EIO:when=2 \
        "$krs" render ball.krs $small -o target.exr >out 2>err
    status=$?
    said 0 "warning: \`target.exr\` is written, but its name may not survive" \
        "a folder that cannot be flushed is a warning"
else
    skip "a folder that cannot be flushed is a warning" "no strace, or no right to use it"
fi

"$krs" info ball.krs >&- 2>err
status=$?
: >out
said 74 "error while writing standard output" "closed standard output"
"$krs" info ball.krs >/dev/full 2>err
status=$?
said 74 "No space left on device" "full standard output"
# shellcheck disable=SC2086
"$krs" render ball.krs $small -o closed.exr >&- 2>err
status=$?
ended 0 "a render has nothing to say on standard output"
"$krs" check ball.krs <&- >out 2>err
status=$?
ended 0 "closed standard input where none is read"
"$krs" query ball.krs <&- >out 2>err
status=$?
said 74 "cannot read standard input" "closed standard input"
# shellcheck disable=SC2086
"$krs" render ball.krs $small -o mute.exr 2>&- >out
status=$?
: >err
[ "$status" -eq 0 ] && [ "$(head -c 4 mute.exr | od -An -tx1 | tr -d ' ')" = 762f3101 ]
result $? "closed standard error does not become part of the picture"
"$krs" info ball.krs 2>err | :
run explain E0101
ended 0 "a reader that leaves early is survived"

run compile ball.krs -o shaders
[ "$status" -eq 0 ] && [ -s shaders/ball.glsl ] && [ -s shaders/ball.trace.spv ] &&
    is_json <shaders/ball.json
result $? "compile writes GLSL, SPIR-V and JSON"
run compile ball.krs -o nowhere/deep
said 73 "cannot create \`nowhere/deep\`" "a folder that cannot be made"
run compile ball.krs -o file
said 73 "Not a directory" "a file in the place of the folder of shaders"
