#!/bin/sh
# pictures.sh BUILD [NAME...]: renders examples to docs/pictures/, small enough for a page: with
# 64 steps a channel, or 256 colours where that takes more than 500,000 bytes, dithered by
# ImageMagick, which nothing else here needs.  Without a name all.
build=$1
shift
cd "$(dirname "$0")/.." || exit 1
[ $# -gt 0 ] || set -- gear machined-part school rock temple grove reef palm olive fern fractals \
    lamps inversion cabinet sextic lattice town bath lighthouse \
    chess snow-globe gasket city sign logo bolt rope mug vase spring jewel dodecahedron
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
for name in "$@"; do
    samples=16
    case $name in jewel | chess | dodecahedron) samples=256 ;; esac
    scene=$(ls examples/??-"$name".krs) || exit 1
    picture=docs/pictures/$name.png
    "$build/krs" render "$scene" --quiet --size 960x540 --samples $samples -o "$work/$name.png" &&
        convert "$work/$name.png" -strip -ordered-dither o8x8,64 "$picture" || exit 1
    if [ "$(wc -c <"$picture")" -gt 500000 ]; then
        convert "$work/$name.png" -strip -dither Riemersma -colors 256 "$picture" || exit 1
    fi
    echo "$picture"
done
