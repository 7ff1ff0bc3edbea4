#!/bin/sh
# samples.sh: ranges of the samples of a picture, rendered by themselves, make the file of a render of all samples, byte for byte,
# or `krs merge` says why they do not.
# shellcheck source-path=SCRIPTDIR disable=SC2016,SC2086
. "$(dirname "$0")/common.sh"
plan 27
export XDG_CACHE_HOME="$work/caches"

cat >scene.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg, aperture: 0.1, focus: 5, shutter: [0, 0.5] }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }
sky { zenith: #9fb8d0, horizon: #e9dccb, ground: #b09478 }
material gold { color: #ffcc66, metallic: 1, roughness: 0.2 }
show sphere(0.6).move([0, 0.6 + 0.3 * sin(9 * time), 0]).paint(gold);
show box([0.9, 0.9, 0.9]).move([-1.4, 0.5, -0.6]).paint(#337755);
show plane([0, 1, 0], 0).paint(#888888);
END
how="scene.krs --size 34x26 --rays kernels --quiet"

# ---- all AOVs, and estimates of noise ----

noisy="--aov Z,P,N,albedo,id,steps,noise"
run render $how $noisy --samples 300 -o all.exr
ended 0 "all samples are rendered at once"
for range in 0..63 64..127 128..191 192..255 256..299; do
    run render $how $noisy --samples $range/300 -o "$range.exr"
done
run merge 256..299.exr 64..127.exr 0..63.exr 192..255.exr 128..191.exr -o merged.exr
ended 0 "ranges are merged"
cmp -s all.exr merged.exr
result $? "they are the picture of all samples, with the estimate of its noise"
run merge 0..63.exr 64..127.exr -o begin.exr
run merge 128..191.exr 192..255.exr -o middle.exr
run merge middle.exr 256..299.exr begin.exr -o merged.exr
cmp -s all.exr merged.exr
result $? "so they are when some are merged before"
run merge 0..63.exr 128..191.exr 192..255.exr 256..299.exr -o part.exr
said 74 'of the part that `128..191.exr` has, samples 64 to 127 are missing' "samples that are missing are told of"
run merge begin.exr 64..127.exr -o part.exr
said 74 "both have pixels at 0, 0" "and samples that are there twice"
run merge 0..63.exr all.exr -o part.exr
said 74 "one of them has some of the samples, one all" "all samples have no place beside some"

# ---- paths, tiles, motion, a checkpoint ----

paths="--integrator path --aov all --time 0.1"
run render $how $paths --samples 200 -o all.exr
KRS_TEST_CHECKPOINT=0.001
export KRS_TEST_CHECKPOINT
for range in 0..127 128..199; do
    for tile in 0,0,17,26 17,0,17,9 17,9,17,17; do
        run render $how $paths --resume --samples $range/200 --crop $tile -o "$range-$tile.exr"
    done
done
unset KRS_TEST_CHECKPOINT
run merge 0..127-*.exr 128..199-*.exr -o merged.exr
[ "$status" -eq 0 ] && cmp -s all.exr merged.exr
result $? "ranges of tiles are the picture, too"
run merge 0..127-*.exr 128..199-17*.exr -o part.exr
said 74 'of the part that `0..127-0,0,17,26.exr` has, samples 128 to 199 are missing' "each tile needs each range"
how2="$how $paths --samples 64..191/192 --resume"
KRS_TEST_CHECKPOINT=0.01 "$krs" render $how2 -o cut.exr 2>err &
pid=$!
until [ -e cut.exr.part ] || ! kill -0 $pid; do sleep 0.01; done
kill $pid
wait $pid
status=$?
[ "$status" -eq 75 ] || [ "$status" -eq 0 ]
result $? "a range that is interrupted has a checkpoint"
run render $how2 -o cut.exr
run render $how $paths --samples 64..191/192 -o uncut.exr
cmp -s cut.exr uncut.exr
result $? "from which it goes on to the same sums"

# ---- photons, which are those of the sample in every tile ----

sed 's/roughness: 0.2/roughness: 0.05/' scene.krs >smooth.krs
photons="smooth.krs --size 34x26 --rays kernels --quiet --integrator path --caustics photons"
run render $photons --samples 4 -o all.exr
export KRS_TEST_CHECKPOINT=0.001
for tile in 0,0,17,26 17,0,17,9 17,9,17,17; do
    run render $photons --resume --samples 4 --crop $tile -o "photons-$tile.exr"
done
unset KRS_TEST_CHECKPOINT
run merge photons-*.exr -o merged.exr
[ "$status" -eq 0 ] && cmp -s all.exr merged.exr
result $? "tiles have the caustics of the picture"

# ---- what must agree ----

refuse() { # words, options
    words=$1
    shift
    run render $how --samples 128..199/200 "$@" -o other.exr
    run merge 0..127-0,0,17,26.exr other.exr -o part.exr
    [ "$status" -eq 74 ] && grep -qF -- "$words" err && [ ! -e part.exr ]
    result $? "it is refused: $*"
}
tile="--crop 0,0,17,26"
refuse "krs:time" $tile --integrator path --aov all
refuse "krs:settings" $tile $paths --seed 4
refuse "krs:settings" $tile --time 0.1 --aov all --integrator direct
run render $how $tile $paths --samples 128..200/201 -o other.exr
run merge 0..127-0,0,17,26.exr other.exr -o part.exr
said 74 "their samples are of other numbers" "and those of other numbers"
sed 's/sum\.A0/xum.A0/' other.exr >spoilt.exr
run merge spoilt.exr -o part.exr
said 74 "not their sums" "sums are needed"

# ---- what cannot be asked for ----

for wrong in 10..63/256 0..62/256 64..63/256 0..256/256 0..63 0..63/ ..63/256 0../256; do
    run render $how --samples $wrong -o wrong.exr
    [ "$status" -eq 2 ] && [ ! -e wrong.exr ]
    result $? "no range is $wrong"
done
for wrong in "--noise 0.1" "--cryptomatte"; do
    run render $how --samples 0..63/256 $wrong -o wrong.exr
    said 2 "a range of --samples" "ranges have no ${wrong%% *}"
done
