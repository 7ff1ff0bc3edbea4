#!/bin/sh
# mesh.sh: `krs mesh`: files that other programs accept, and what is refused.
. "$(dirname "$0")/common.sh"
plan 39

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
said 2 "floor.krs\` has no end" "what has no end is refused"
said 2 "one that has: \`ball\`" "and what has one is named"
echo 'show plane(); for i in 0..20 { show sphere(0.4).move([i, 0, 0]); }' >row.krs
run mesh row.krs
said 2 "\`component 9\` and others" "not all of many"
echo 'show plane(); let nut = sphere(0.4); show nut; show nut.move([1, 0, 0]);' >nuts.krs
run mesh nuts.krs
grep -qF "one that has: \`nut\`" err && ! grep -qF "\`nut\`, \`nut\`" err
result $? "a name that several have is told once"
run mesh nuts.krs --component bolt
grep -qF "it has \`component 1\`, \`nut\`" err && ! grep -qF "\`nut\`, \`nut\`" err
result $? "and once among those that there are"
run mesh --quiet floor.krs --component ball --error 0.2 -o ball.stl
ended 0 "but not its component"
run mesh floor.krs --component bowl
said 2 "it has \`floor\`, \`ball\`" "components are named"
run mesh empty.krs
said 1 "nothing to write" "nothing is no mesh"
run mesh ball.krs -o ball.xyz
said 2 ".stl, .ply, .obj, .glb or .3mf" "formats are named"
run mesh ball.krs --error 1e-9
[ "$status" -eq 2 ] && no_temporaries
result $? "errors below what numbers tell are refused"

cat >two.krs <<'END'
material red { color: #d02010, roughness: 0.3 }
let ball  = sphere(0.5).paint(red);
let stand = box([1, 0.3, 1]).move([0, -1, 0]).paint(#20c040);
show ball;
show stand;
END
# What assimp counts in a file: counted FILE WORD.
counted() { assimp info "$1" 2>&1 | sed -n "s/^$2: *\([0-9]\)/\1/p"; }
run mesh --quiet two.krs --error 0.05 -o t.stl -o t.ply -o t.obj -o t.glb -o t.3mf
triangles=$(grep -c '^f' t.obj)
if command -v assimp >/dev/null; then
    bad=0
    for file in t.stl t.ply t.obj t.glb; do
        [ "$(counted $file Faces)" = "$triangles" ] || bad=1
        assimp info $file | grep -q '^Minimum point *(-0.500000 -1.1500' || bad=1
    done
    [ "$status" -eq 0 ] && [ $bad -eq 0 ]
    result $? "assimp reads the triangles of each format, where they are"
    run mesh --quiet two.krs --error 0.5 --units mm --size 20 --split components -o s.glb
    [ "$(counted s.glb Meshes)" = 2 ] && assimp info s.glb | grep -q '0 (ball)' &&
        assimp info s.glb | grep -q '^Maximum point *(0.006'
    result $? "GLB has a mesh for each component, in metres"
    run mesh --quiet two.krs --error 0.05 --split materials -o s.glb
    [ "$(counted s.glb Materials)" = 2 ] && assimp info s.glb | grep -q "'red'"
    result $? "and its triangles by material"
else
    skip "assimp reads the triangles of each format, where they are" "no assimp"
    skip "GLB has a mesh for each component, in metres" "no assimp"
    skip "and its triangles by material" "no assimp"
fi
run mesh --quiet two.krs --error 0.05 --units in --split materials -o s.3mf
if command -v python3 >/dev/null; then
    python3 - "$triangles" >out 2>err <<'END'
import sys, zipfile
import xml.etree.ElementTree as tree
model = tree.fromstring(zipfile.ZipFile("s.3mf").read("3D/3dmodel.model"))
name = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
edges = {}
triangles = list(model.iter(name + "triangle"))
for triangle in triangles:
    corners = [triangle.get(k) for k in ("v1", "v2", "v3")]
    for k in range(3):
        edge = (corners[k], corners[(k + 1) % 3])
        edges[edge] = edges.get(edge, 0) + 1
colors = {base.get("name"): base.get("displaycolor") for base in model.iter(name + "base")}
assert len(triangles) == int(sys.argv[1]) and model.get("unit") == "inch"
assert all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items())
assert colors == {"red": "#D02010FF", "#20c040": "#20C040FF"}
assert len({triangle.get("p1") for triangle in triangles}) == 2
END
    result $? "3MF has the closed mesh, its unit, and materials by triangle"
else
    skip "3MF has the closed mesh, its unit, and materials by triangle" "no python3"
fi
run mesh --quiet two.krs --error 0.05 --split components -o s.obj
[ "$(grep '^o' s.obj)" = "o ball
o stand" ] && [ "$(awk '$1 == "o" { part = $2 } $1 == "f" && part == "stand" { n++ } END { print n }' \
    n=0 s.obj)" = 12 ]
result $? "OBJ has a group for each component, in as few triangles as it needs"
run mesh two.krs --split components -o s.stl
said 2 "has no parts" "STL has none"
if command -v python3 >/dev/null; then
    for zone in UTC Asia/Tokyo; do
        TZ=$zone "$krs" mesh --quiet two.krs --error 0.05 --split components -o "${zone#*/}.3mf" >out 2>err
    done
    cmp -s UTC.3mf Tokyo.3mf && python3 -c '
import zipfile
for entry in zipfile.ZipFile("UTC.3mf").infolist(): assert entry.date_time == (1980, 1, 1, 0, 0, 0)'
    result $? "3MF is the same at any time, in any time zone"
    python3 - >out 2>err <<'END'
import zipfile
import xml.etree.ElementTree as tree
archive = zipfile.ZipFile("UTC.3mf")
assert archive.testzip() is None and archive.namelist()[0] == "[Content_Types].xml"
for name in archive.namelist():
    tree.fromstring(archive.read(name))
core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
model = tree.fromstring(archive.read("3D/3dmodel.model"))
objects = [item.get("id") for item in model.iter(core + "object")]
built = [item.get("objectid") for item in model.find(core + "build")]
assert built == objects and len(built) == 2
assert [item.get("name") for item in model.iter(core + "object")] == ["ball", "stand"]
END
    result $? "and has what the format wants, in its order"
else
    skip "3MF is the same at any time, in any time zone" "no python3"
    skip "and has what the format wants, in its order" "no python3"
fi
run mesh two.krs --units furlong -o s.3mf
ended 2 "units are known"
echo 'show polygon([[0, 0], [10, 0], [10, 6]]).extrude(10);' >wedge.krs
run mesh --quiet wedge.krs -o wedge.obj -o wedge.stl
[ "$status" -eq 0 ] && [ "$(grep -c '^f' wedge.obj)" -eq 8 ]
result $? "a wedge has 8 triangles"
run mesh --quiet wedge.krs --error 0.5 --even -o wedge.obj
[ "$status" -eq 0 ] && [ "$(grep -c '^f' wedge.obj)" -gt 500 ]
result $? "--even makes even triangles of flat faces"
# Blends have no polygons, so triangles are left out of the mesher's.
echo 'show union(sphere(0.5), sphere(0.4).move([0.6, 0, 0]), blend: 0.3);' >egg.krs
run mesh --quiet egg.krs --error 0.02 --even -o even.stl
run mesh --quiet egg.krs --error 0.02 -o egg.obj
[ "$status" -eq 0 ] && [ $((4 * $(grep -c '^f' egg.obj))) -lt $((($(wc -c <even.stl) - 84) / 50)) ]
result $? "one material has a quarter of the triangles or fewer"
run mesh --quiet egg.krs --error 0.004 --limit memory=76M -o kept.obj
[ "$status" -eq 0 ] && [ "$(grep -c '^f' kept.obj)" -gt $((10 * $(grep -c '^f' egg.obj))) ]
result $? "where memory does not suffice for half of the error, all triangles are left"
# Lathes of few corners, on the axis and beside it, convex or not.
bad=0
for corners in '[0, 0], [10, 0], [10, 3], [4, 8], [4, 20], [0, 20]' '[3, 0], [5, 0], [4.5, 2]' '[0, 0], [5, 0], [3, 2], [0, 3]' \
    '[2, 0], [4, 0], [5, 3], [1, 3], [0.5, 1]'; do
    echo "show polygon([$corners]).revolve();" >lathe.krs
    run mesh --quiet lathe.krs -o lathe.obj
    [ "$status" -eq 0 ] && awk -v axis="$corners" '$1 == "v" { v++ } $1 == "f" { f++ }
        END { exit !(f < 500 && v - f / 2 == (axis ~ /\[0,/ ? 2 : 0)) }' lathe.obj || bad=1
done
[ $bad -eq 0 ]
result $? "lathes of few corners have few triangles"
run mesh --quiet egg.krs --even --simplify -o egg.stl
said 2 "one of both" "--even and --simplify contradict each other"
cat >shaded.krs <<'END'
show sphere(0.5).paint(mix(red, blue, clamp(y, 0, 1)));
show box([1, 0.3, 1]).move([0, -1, 0]).paint(green);
END
run mesh shaded.krs --error 0.05 -o shaded.obj
said 0 "--simplify leaves out" "colours that keep triangles are told of"
triangles=$(grep -c '^f' shaded.obj)
run mesh --quiet shaded.krs --error 0.05 -o shape.stl
run mesh --quiet shaded.krs --error 0.05 --simplify -o fewer.stl -o fewer.obj
fewer=$(grep -c '^f' fewer.obj)
[ "$status" -eq 0 ] && [ "$fewer" -lt $((triangles / 2)) ] && [ $((($(wc -c <shape.stl) - 84) / 50)) -eq "$fewer" ]
result $? "--simplify leaves out triangles that colours need, and STL has no colours"
if command -v admesh >/dev/null; then
    admesh fewer.stl >out 2>&1
    grep -q 'Number of parts *: *2 ' out && grep -q 'Total disconnected facets *: *0 ' out &&
        grep -q 'Degenerate facets *: *0' out
    result $? "and they are closed"
else
    skip "and they are closed" "no admesh"
fi
# A ball of radius 0.5 at the origin: no vertex is farther than the error from it or from the stand.
awk '$1 == "v" && $3 > -0.7 { r = sqrt($2^2 + $3^2 + $4^2); if (r < 0.45 || r > 0.55) bad = 1 }
     $1 == "v" && $3 < -0.7 && ($3 < -1.2 || $3 > -0.8 || $2 < -0.55 || $2 > 0.55) { bad = 1 } END { exit bad }' fewer.obj
result $? "within the error"
run mesh --quiet two.krs --error 0.05 --lods 2 -o lods.glb
[ "$status" -eq 0 ] && grep -a -q '"MSFT_lod":{"ids":\[[0-9]*,[0-9]*\]}' lods.glb
result $? "GLB has levels of detail"
run mesh two.krs --error 0.05 --lods 2 -o lods.stl
said 2 "for .glb, and none is written" "other files have none"
# Half a place of 24 bits at 1e5 is 0.004.
echo 'show sphere(1).move([100000, 0, 0]);' >far.krs
run mesh far.krs --error 0.02 -o far.stl -o far.obj
[ "$status" -eq 0 ] && [ "$(grep -c 'are rounded' err)" -eq 1 ] && grep -q 'far.stl. are rounded.* 0.006 more' err
result $? "numbers that are too coarse are told"
# What is there stays, whatever ends the command.
echo old >kept.stl
run mesh --quiet ball.krs --error 1e-4 --limit memory=4M -o kept.stl
[ "$status" -eq 71 ] && grep -q 'out of memory' err && [ "$(cat kept.stl)" = old ] && no_temporaries
result $? "no more memory is taken than is permitted"
timeout -s INT 0.5 "$krs" mesh --quiet ball.krs --error 1e-5 -o kept.stl >out 2>err
grep -q 'interrupted' err && [ "$(cat kept.stl)" = old ] && no_temporaries
result $? "Ctrl C ends it and leaves the file as it was"
# A ball of radius 0.5 has the volume 0.5236; its mesh within 0.02 of it, at most 0.063 more or less.
# shellcheck disable=SC2046 # many words
(cd "$root" && "${CC:-cc}" -Wall -Wextra -Werror -Iinclude -o "$work/own" examples/c/mesh.c "${B:-build}/libkrs.a" \
    $(make --no-print-directory -s libs)) >out 2>&1
result $? "the mesher of examples/c compiles"
[ -x own ] && ./own ball.krs 0.02 >out 2>err && awk '/closed, within 0.02$/ && $4 + 0 > 0.4606 && $4 + 0 < 0.5866 { good = 1 }
    END { exit !good }' out
result $? "and its mesh is closed, with the volume of the ball"
