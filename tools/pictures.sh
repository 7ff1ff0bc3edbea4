#!/bin/sh
# pictures.sh BUILD [NAME...]: renders examples to docs/pictures/, small enough for a page: with
# 64 steps a channel, or 256 colours where that takes more than 500,000 bytes, dithered by
# ImageMagick, which nothing else here needs.  Without a name all.
build=$1
shift
cd "$(dirname "$0")/.." || exit 1
[ $# -gt 0 ] || set -- gear machined-part school rock temple grove reef palm olive fern fractals \
    lamps inversion cabinet sextic lattice town bath lighthouse \
    chess snow-globe gasket city sign logo bolt rope mug vase spring jewel dodecahedron \
    bonsai jewels night dusk direct-mug direct-vase
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
for name in "$@"; do
    scene=$(ls examples/??-"$name".krs 2>/dev/null)
    size=960x540 samples=16 more=
    case $name in # paths take many samples
    chess | dodecahedron) size=640x360 samples=128 more="--clamp-radiance 4" ;;
    jewel) samples=256 ;;
    jewels) size=640x360 samples=400 more="--clamp-radiance 4" ;;
    night) size=640x360 samples=96 ;;
    direct-*)
        scene=$(ls examples/??-"${name#direct-}".krs)
        size=640x360 samples=128 more="--integrator direct" ;;
    dusk) scene=examples/07-grove.krs size=640x360 samples=8 more="--set dusk=1" ;;
    esac
    picture=docs/pictures/$name.png
    # shellcheck disable=SC2086 # several words
    "$build/krs" render "${scene:?no example $name}" --quiet --size $size --samples $samples $more \
        -o "$work/$name.png" &&
        convert "$work/$name.png" -strip -ordered-dither o8x8,64 "$picture" || exit 1
    if [ "$(wc -c <"$picture")" -gt 500000 ]; then
        convert "$work/$name.png" -strip -dither Riemersma -colors 256 "$picture" || exit 1
    fi
    echo "$picture"
done
