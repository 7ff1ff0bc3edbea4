#!/bin/sh
# tutorial.sh BUILD: renders the pictures of docs/tutorial.md from its scenes, to docs/pictures/.
# docs/pictures/tutorial.sums says of which texts they were made.
# tutorial.sh --sums: prints what it should say.
# tutorial.sh --scenes FOLDER: writes the scenes there.
cd "$(dirname "$0")/.." || exit 1
if [ "${1:-}" = --scenes ]; then
    work=$2
else
    work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
fi

# Scenes of the page that are followed by a picture: tutorial-1.krs and so on.
awk -v folder="$work" '
    /^```/ { inside = !inside; if (inside) { text = ""; chosen = $0 == "```krs" }; next }
    inside && chosen { text = text $0 "\n" }
    match($0, /pictures\/tutorial-[0-9]+\.png/) {
        name = substr($0, RSTART + 9, RLENGTH - 13)
        printf "%s", text > (folder "/" name ".krs")
    }' docs/tutorial.md
sums() { (cd "$work" && cksum tutorial-*.krs); }
case ${1:-} in
--scenes) exit ;;
--sums) sums && exit ;;
esac
for scene in "$work"/tutorial-*.krs; do
    name=$(basename "$scene" .krs)
    "$1/krs" render "$scene" --quiet --size 640x360 --samples 16 -o "$work/$name.png" &&
        convert "$work/$name.png" -strip -ordered-dither o8x8,64 "docs/pictures/$name.png" || exit 1
    echo "docs/pictures/$name.png"
done
sums >docs/pictures/tutorial.sums
