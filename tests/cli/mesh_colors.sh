#!/bin/sh
# mesh_colors.sh: parts of one colour each have as few triangles as their shape needs, and each the colour of its part.
. "$(dirname "$0")/common.sh"
plan 8

if ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    for _ in 1 2 3 4 5 6 7 8; do skip "colours of triangles" "no numpy"; done
    exit
fi
count() { # triangles of a binary STL
    od -An -j80 -N4 -tu4 "$1" | tr -d ' '
}
checks() { /usr/bin/python3 "$root/tests/cli/mesh_colors.py" check "$@"; }

scenes=$(/usr/bin/python3 "$root/tests/cli/mesh_colors.py" make .)
failed=
for scene in $scenes; do
    run mesh --quiet "$scene.krs" --error 0.01 -o "$scene.3mf" -o "$scene.ply" -o "$scene.obj" -o "$scene.glb"
    counts=$(checks "$scene.json" 0.01 "$scene.3mf" "$scene.ply" "$scene.obj" "$scene.glb" 2>>errors) || failed="$failed $scene"
    run mesh --quiet "$scene.krs" --error 0.01 -o "$scene.stl"
    echo "$scene $(count "$scene.stl") $counts" >>counts
done
tail -n 1 errors >err
cp counts out
[ -z "$failed" ]
result $? "each point of random parts has the colour of its part in all formats:$failed"
awk '$1 ~ /^(boxes|mixed)/ && $3 > 1.1 * $2 + 8 { exit 1 }' counts
result $? "parts that cross have about as few triangles as without colours"
awk '$1 == "tiles" && $3 > 150 { exit 1 }' counts
result $? "level faces are split along straight borders"
awk '$3 != $4 || $4 != $5 || $5 != $6 { exit 1 }' counts
result $? "all formats have the same triangles"

cat >plate.krs <<'SCENE'
let letters = text("KRS 3", 0.6).extrude(0.3).rotate([1, 0, 0], -90deg).move([0, 0.3, 0]);
show box([4, 0.4, 1.4]).paint(#203060) | letters.paint(#e0c040);
SCENE
run mesh --quiet plate.krs -o plate.3mf
run mesh --quiet plate.krs -o plate.stl
found=$(/usr/bin/python3 -c '
import sys
sys.path.insert(0, sys.argv[1])
sys.argv = ["", "make", "."]
import mesh_colors
corners, colors = mesh_colors.read_3mf("plate.3mf")
above = corners[:, :, 1].max(1) > 0.2 + 1e-3
assert (abs(colors[above] - [224, 192, 64]) < 1).all() and (abs(colors[~above] - [32, 48, 96]) < 1).all()
print(len(corners))' "$root/tests/cli" 2>err | tail -n 1)
echo "$found $(count plate.stl)" >out
[ "$found" -gt 100 ] && [ "$found" -eq "$(count plate.stl)" ]
result $? "raised letters on a plate have no triangle more than without colours"

cat >stripe.krs <<'SCENE'
show box([2, 1, 1]).paint(if x + 0.3 * y < 0.1 then white else black);
SCENE
run mesh --quiet stripe.krs -o stripe.3mf
[ "$(unzip -p stripe.3mf 3D/3dmodel.model | grep -c '<triangle ')" -eq 28 ]
result $? "a straight border across four faces of a box cuts what it crosses, and nothing else"

cat >shaded.krs <<'SCENE'
show box([2, 1, 1]).paint(mix(white, black, clamp(x, 0, 1)));
SCENE
run mesh shaded.krs -o shaded.ply
said 0 "triangles are kept for the colours" "a colour that changes evenly keeps its triangles"
run mesh plate.krs --even -o plate.ply
[ "$status" -eq 0 ] && [ "$(sed -n 's/^krs: \([0-9]*\) triangles.*/\1/p' err)" -gt 10000 ]
result $? "--even keeps them, too"
