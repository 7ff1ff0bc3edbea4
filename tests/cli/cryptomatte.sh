#!/bin/sh
# cryptomatte.sh: an independent reader finds components and instances in the mattes of an EXR.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 8
compile_exr matte_check
compile_exr exr_text
cat >parts.krs <<'END'
camera { eye: [0, 1.2, 6], target: [0, 0.5, 0], fov: 40deg, aperture: 0.05 }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }
material rubber(tint) { color: tint, roughness: 0.9 }
let ground = plane([0, 1, 0], 0).paint(gray);
let ball = sphere(0.5).move([0, 0.5, 0]).paint(rubber(tomato)) -
    box([2, 2, 1]).move([0, 0.5, 0.8]).paint(rubber(navy));
let row = krs { kernel sphere(0.3); reflect plane([1, 0, 0], 0.5); reflect plane([1, 0, 0], 1); };
show ground;
show ball;
show row.move([0, 1.4, 0]);
END
render() { run render parts.krs --quiet --size 64x36 "$@"; }

render --samples 16 --cryptomatte -o a.exr -o a.png
ended 0 "a picture with mattes"
./matte_check a.exr >found 2>err
result $? "they keep the promises of the specification"
[ "$(cut -d' ' -f1,2 found | sort | tr '\n' ';')" = "CryptoComponent ball;CryptoComponent ground;\
CryptoComponent row;CryptoInstance ball/1;CryptoInstance ground/1;CryptoInstance row/4;\
CryptoInstance row/5;CryptoInstance row/6;CryptoInstance row/7;CryptoMaterial colour;\
CryptoMaterial rubber;CryptoMaterial unpainted;" ]
result $? "the manifests name what is seen"
# The sum of the instances is the component; that of all components is alpha.
./exr_text a.exr A | awk '{ a += $4 } END { print "alpha", a }' | cat - found | awk '
    $1 == "alpha" { alpha = $2 }
    $1 == "CryptoComponent" { part[$2] = $3; all += $3 }
    $1 == "CryptoInstance" { sub("/.*", "", $2); part[$2] -= $3 }
    $1 == "CryptoMaterial" { of[$2] = $3 }
    END {
        for (name in part) wrong += part[name] > 0.01 || part[name] < -0.01
        materials = of["colour"] + of["rubber"] + of["unpainted"]
        wrong += materials - all > 0.1 || all - materials > 0.1
        exit wrong || all - alpha > 0.1 || alpha - all > 0.1 || alpha < 100
    }'
result $? "instances add up to components, these and materials to alpha"
render --samples 16 -o plain.exr -o plain.png
./exr_text a.exr | grep -v "^Crypto" >with && ./exr_text plain.exr >without && cmp -s with without &&
    cmp -s a.png plain.png
result $? "all else is as without mattes"
render --samples 16 --cryptomatte --crop 9,7,33,21 -o crop.exr && ./matte_check crop.exr >/dev/null
result $? "so has a crop"
./exr_text a.exr | awk '$2 >= 9 && $2 < 42 && $3 >= 7 && $3 < 28' | grep "^Crypto" | sort >part
./exr_text crop.exr | grep "^Crypto" | sort | cmp -s - part
result $? "a crop is a part of the whole"
render --cryptomatte --aov none -o one.exr
[ "$(./matte_check one.exr | awk '/Component/ { n += $3 == int($3) } END { print n }')" = 3 ]
result $? "a single ray covers its pixel, without other planes too"
