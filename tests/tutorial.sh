#!/bin/sh
# tutorial.sh: every scene of docs/tutorial.md that has a picture renders with no ray left
# unresolved, and its picture was made from the text that stands there.
cd "$(dirname "$0")/.." || exit 1
krs=${KRS:-build/krs}
folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT
failed=0
report() { # name, status
    if [ "$2" -eq 0 ]; then echo "ok - $1"; else echo "not ok - $1"; failed=1; fi
}
tools/tutorial.sh --scenes "$folder"
set -- "$folder"/*.krs
[ $# -ge 7 ]
report "the page has scenes with pictures" $?
for scene; do
    name=$(basename "$scene" .krs)
    "$krs" render "$scene" --quiet --size 96x54 --samples 1 --stats json -o "$folder/$name.png" \
        >"$folder/stats" && grep -q '"unresolved": *0[,}]' "$folder/stats"
    report "$name renders" $?
    [ -s "docs/pictures/$name.png" ]
    report "$name has a picture" $?
done
tools/tutorial.sh --sums >"$folder/sums"
cmp -s "$folder/sums" docs/pictures/tutorial.sums
report "the pictures show the scenes of the page (tools/tutorial.sh BUILD makes them)" $?
sed 's/^1/2/' "$folder/sums" | cmp -s - docs/pictures/tutorial.sums
[ $? -eq 1 ]
report "a picture of another text would be noticed" $?
exit $failed
