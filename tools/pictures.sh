#!/bin/sh
# pictures.sh BUILD [NAME...]: renders examples to docs/pictures/, small enough for a page: with
# 32 steps a channel, dithered by ImageMagick, which nothing else here needs.  Without a name all.
build=$1
shift
cd "$(dirname "$0")/.." || exit 1
[ $# -gt 0 ] || set -- gear machined-part school rock temple grove reef palm olive fern
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
for name in "$@"; do
    scene=$(ls examples/??-"$name".krs) || exit 1
    "$build/krs" render "$scene" --quiet --size 960x540 --samples 16 -o "$work/$name.png" &&
        convert "$work/$name.png" -strip -ordered-dither o8x8,32 "docs/pictures/$name.png" || exit 1
    echo "docs/pictures/$name.png"
done
