#!/bin/sh
# pictures.sh BUILD [NAME...]: renders the pictures of docs/pictures/, as tools/pictures.txt has them, small enough for
# a page: with 64 steps a channel, or 256 colours where that takes more than 500,000 bytes, dithered by ImageMagick,
# which nothing else here needs.  Without a name all.
build=$1
shift
cd "$(dirname "$0")/.." || exit 1
# shellcheck disable=SC2046 # words are meant
[ $# -gt 0 ] || set -- $(awk -F ' *[|] *' '!/^#/ && $1 != "mesh" { print $2 }' tools/pictures.txt)
for name in "$@"; do
    tools/gallery.sh "$build" gallery "$name" || exit 1
    from=$build/gallery/$name.png picture=docs/pictures/$name.png
    convert "$from" -strip -ordered-dither o8x8,64 "$picture" || exit 1
    if [ "$(wc -c <"$picture")" -gt 500000 ]; then
        convert "$from" -strip -dither Riemersma -colors 256 "$picture" || exit 1
    fi
    echo "$picture"
done
