#!/bin/sh
# farm_nodes.sh: machines that differ from the others, and disks that are full: nothing wrong gets into a picture, and nothing is lost.
# shellcheck source-path=SCRIPTDIR disable=SC2016,SC2086
. "$(dirname "$0")/common.sh"
plan 12

cat >ball.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }
show sphere(0.6).move([0, 0.6 + 0.3 * sin(9 * time), 0]).paint(#ffcc66);
show plane([0, 1, 0], 0).paint(#888888);
END
how="--frames 0..5 --size 96x64 --samples 2 --rays kernels --integrator path"
export XDG_CACHE_HOME="$work/caches"
run render ball.krs $how --quiet -o 'one-%d.exr'

# ---- a processor without AVX, or what the driver takes for one ----

run farm submit ball.krs $how -o 'f-%d.exr'
run farm run ball.farm --piece 0 --quiet
ended 0 "the first machine renders a piece"
without="env GALLIUM_NOSSE=1 MESA_SHADER_CACHE_DISABLE=true XDG_CACHE_HOME=$work/caches.other"
small="--size 48x27 --samples 2 --rays kernels --integrator path --quiet"
run render ball.krs $small -o small.exr
$without "$krs" render ball.krs $small -o other.exr >out 2>err
if [ -e other.exr ] && ! cmp -s small.exr other.exr; then
    $without "$krs" farm run ball.farm --piece 1 --quiet >out 2>err
    status=$?
    [ "$status" -eq 69 ] && grep -q "pictures differ" err && [ ! -e f-1.exr ] && [ -z "$(ls ball.farm/parts)" ]
    result $? "one of the same name whose driver makes other pixels is noticed before it renders"
    $without "$krs" farm work ball.farm --quiet >out 2>err
    status=$?
    [ "$status" -eq 69 ] && [ ! -e f-1.exr ]
    result $? "each time"
else
    skip "another driver" "this driver makes the same pixels without AVX"
    skip "each time" "this driver makes the same pixels without AVX"
fi
run farm work ball.farm --quiet
[ "$status" -eq 0 ] && cmp -s one-1.exr f-1.exr && cmp -s one-5.exr f-5.exr
result $? "the first machine goes on"

# ---- no folder for temporary files, a home that cannot be written, a folder that is not seen ----

if ! unshare -m true 2>/dev/null; then
    for what in 1 2 3 4 5 6 7 8; do skip "a machine of another kind, $what" "this user cannot make one"; done
    exit 0
fi
mkdir bare disk
rm f-2.exr
unshare -m sh -c 'mount -t tmpfs -o ro none bare && ! touch bare/file 2>/dev/null &&
    exec env -u XDG_CACHE_HOME HOME="$PWD/bare" TMPDIR="$PWD/bare/none" "$1" farm work ball.farm --quiet' sh "$krs" >out 2>err
status=$?
[ "$status" -eq 0 ] && cmp -s one-2.exr f-2.exr
result $? "a machine without a folder for temporary files, and with a home of no use, renders"
rm f-3.exr
cp -r ball.farm elsewhere.farm
sed -i 's:"output".*",$:"output"\: "'"$PWD"'/bare/none/f-%d.exr",:' elsewhere.farm/job.json
run farm work elsewhere.farm --quiet
[ "$status" -eq 73 ] && [ -z "$(ls elsewhere.farm/pieces/*.failed 2>/dev/null)" ]
result $? "one that does not see where pictures go says so, and takes no piece"

# ---- a disk that is full, and larger later ----

cat >full.sh <<'END'
mount -t tmpfs -o size=300k none disk && cd disk || exit 9
"$krs" farm submit ../ball.krs $how --tiles 2x1 -o 'f-%d.exr' --quiet
"$krs" farm work ball.farm --quiet 2>../full.err
echo $? >../full.status
"$krs" farm status ball.farm >../full.report
ls f-*.exr >../full.pictures
cp f-*.exr ..
mount -o remount,size=8m . || exit 9
"$krs" farm retry ball.farm
"$krs" farm work ball.farm --quiet 2>../larger.err
echo $? >../larger.status
"$krs" farm status ball.farm >../larger.report
for picture in $(cat ../full.pictures); do cmp "$picture" ../"$picture" || rm "$picture"; done
cp f-*.exr ..
END
export krs how
rm f-?.exr
unshare -m sh full.sh >out 2>err
! grep -q '^0$' full.status
result $? "a worker whose disk is full fails"
grep -q "less than 1 MiB is free" full.report && grep -q "No space left on device" full.err && ! grep -q "is free" larger.report
result $? "it and the report say why"
same=0
while read -r picture; do cmp -s "$picture" "one-${picture#f-}" || same=1; done <full.pictures
[ $same -eq 0 ] && [ "$(wc -l <full.pictures)" -lt 6 ]
result $? "pictures that are there are whole"
grep -q '^0$' larger.status
result $? "with more room the job is done after retry"
same=0
for frame in 0 1 2 3 4 5; do cmp -s one-$frame.exr f-$frame.exr && same=$((same + 1)); done
[ $same -eq 6 ]
result $? "and all frames are those of one render"
grep -q '6 of 6 frames; of 12 pieces 12 done' larger.report
result $? "of which none is missing in the report"
