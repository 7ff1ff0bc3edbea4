#!/bin/sh
# mesh.sh: `krs mesh`: files that other programs accept, and what is refused.
. "$(dirname "$0")/common.sh"
plan 11

echo 'show sphere(0.5).paint(#ff8800);' >ball.krs
echo 'let floor = half_space([0, 1, 0], 0); show floor; let ball = sphere(1); show ball;' >floor.krs
echo 'camera { eye: [0, 0, 5] }' >empty.krs

run mesh --quiet ball.krs --size 50 --error 2 -o ball.stl -o ball.ply -o ball.obj
[ "$status" -eq 0 ] && [ -s ball.stl ] && [ -s ball.ply ] && [ -s ball.obj ] && [ ! -s err ]
result $? "three files are written at once, silently"
triangles=$(grep -c '^f' ball.obj)
[ "$(wc -c <ball.stl)" -eq $((84 + 50 * triangles)) ]
result $? "STL has 50 bytes for each triangle of the OBJ"
awk '$1 == "v" { for (i = 2; i < 5; i++) { if ($i < low) low = $i; if ($i > high) high = $i }
                 r = sqrt($2^2 + $3^2 + $4^2); if (r < 23 || r > 27) bad = 1; if ($5 != 1 || $7 != 0) bad = 1 }
     END { exit !(!bad && high - low > 49 && high - low < 52) }' ball.obj
result $? "vertices are where the surface is, in the size and the colour that were asked for"
head -c 400 ball.ply | grep -a -q "^element face $triangles\$"
result $? "PLY has as many faces"
if command -v admesh >/dev/null; then
    admesh ball.stl >out 2>&1
    grep -q 'All facets connected' out && grep -q 'Number of parts *: *1 ' out &&
        ! grep -E 'Degenerate facets|Edges fixed|Facets (removed|added|reversed)|Backwards edges|Normals fixed' out |
        grep -q -v -E ': *0( |$)'
    result $? "admesh finds nothing to repair"
else
    skip "admesh finds nothing to repair" "no admesh"
fi
run mesh floor.krs
said 2 "has no end" "what has no end is refused"
run mesh --quiet floor.krs --component ball --error 0.2 -o ball.stl
ended 0 "but not its component"
run mesh floor.krs --component bowl
said 2 "it has \`floor\`, \`ball\`" "components are named"
run mesh empty.krs
said 1 "nothing to write" "nothing is no mesh"
run mesh ball.krs -o ball.xyz
said 2 ".stl, .ply or .obj" "formats are named"
run mesh ball.krs --error 1e-9
[ "$status" -eq 2 ] && no_temporaries
result $? "errors below what numbers tell are refused"
