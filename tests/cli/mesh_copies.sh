#!/bin/sh
# mesh_copies.sh: `krs mesh` of sequences: instances and the triangles of each copy are the same solid.
. "$(dirname "$0")/common.sh"
triangles=$root/tests/cli/mesh_triangles.py
plan 13

cat >bush.krs <<'END'
show krs {
    kernel torus(major: 0.3, minor: 0.1).move([0.45, 0.1, 0.45]).paint(#ff8800);
    reflect plane([-1, 0, 0], 0);
    reflect plane([0, 1, 0], 0.6);
    mobius translate([1, 2, 3]) * rotate([0, 1, 0], 30deg) * scale(0.5);
    reflect plane([1, 0, 0], 3);
};
END
cat >million.krs <<'END'
show krs {
    kernel sphere(0.4).move([0.5, 0.5, 0.5]);
    for i in 0..7 { reflect plane([1, 0, 0], pow(2, i)); }
    for i in 0..7 { reflect plane([0, 1, 0], pow(2, i)); }
    for i in 0..6 { reflect plane([0, 0, 1], pow(2, i)); }
};
END
echo 'show krs { kernel sphere(0.5).move([0.4, 0, 0]); reflect plane([-1, 0, 0], 0); };' >cut.krs

run mesh bush.krs --error 0.02 --units m -o a.glb -o a.3mf
ended 0 "files with instances are written"
grep -q '8 copies' err
result $? "and the number of copies is told"
run mesh --quiet bush.krs --error 0.02 --units m --copies flat -o f.glb -o f.3mf -o f.stl -o f.obj -o f.ply
ended 0 "and files with the triangles of each"
/usr/bin/python3 "$triangles" a.glb a.3mf f.glb f.3mf f.stl >out 2>err
result $? "which have the same triangles"
# 8 tori of radii 0.15 and 0.05 have 8 * 2 pi^2 * 0.15 * 0.05^2 = 0.0592.
awk '{ exit !($2 > 0.050 && $2 < 0.0592) }' out
result $? "and the volume of what is shown"
[ "$(wc -c <a.3mf)" -lt "$(($(wc -c <f.3mf) / 3))" ] && [ "$(wc -c <a.glb)" -lt "$(($(wc -c <f.glb) / 3))" ]
result $? "but instances take less space"
# The largest x: 6 - (1 + 0.5 (0.45 sin 30deg - 0.45 cos 30deg - 0.4)) = 5.28236, at most 0.02 of which may be missing.
if command -v assimp >/dev/null; then
    bad=0
    for file in a.glb f.obj f.ply; do
        assimp info $file | awk -F'[( ]+' '/^Maximum point/ { x = $3 } END { exit !(x > 5.2624 && x < 5.3024) }' || bad=1
    done
    result $bad "assimp finds them where they are"
else
    skip "assimp finds them where they are" "no assimp"
fi
if command -v admesh >/dev/null; then
    admesh f.stl >out 2>&1
    grep -q 'Number of parts *: *8 ' out && grep -q 'Total disconnected facets *: *0 ' out
    result $? "admesh finds 8 parts, which are closed"
else
    skip "admesh finds 8 parts, which are closed" "no admesh"
fi
run mesh --quiet million.krs --error 0.1 -o million.glb -o million.3mf
[ "$status" -eq 0 ] && [ "$(wc -c <million.3mf)" -lt 100000 ] &&
    [ "$(head -c 20000 million.glb | grep -a -o '"count":524288' | wc -l)" -eq 6 ]
result $? "2^20 copies are instances of a mesh and its image"
run mesh million.krs --error 0.1 -o million.stl
said 2 "triangles; .glb and .3mf have instances" \
    "but no mesh of all as one"
run mesh bush.krs --copies instances -o a.stl
said 2 "has no instances" "STL has none"
run mesh --quiet bush.krs --error 0.05 --lods 2 -o lods.glb
said 2 "have no --lods" "nor have copies levels of detail"
run mesh --quiet cut.krs --error 0.05 -o a.glb -o a.stl --units m
/usr/bin/python3 "$triangles" a.glb a.stl >out 2>err
result $? "what mirrors cut is one mesh in all formats"
