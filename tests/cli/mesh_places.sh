#!/bin/sh
# mesh_places.sh: where triangles are in textures, in each format that tells.
. "$(dirname "$0")/common.sh"
plan 9

cp "$root/examples/frieze.png" .
cat >ball.krs <<'END'
let t = texture("frieze.png");
show sphere(1).paint(t(2 * u / tau, v / pi + 0.5));
END
cat >can.krs <<'END'
let t = texture("frieze.png");
show cylinder(1, 1).paint(t(u / tau, y));
END
cat >block.krs <<'END'
let t = texture("frieze.png");
material tiles { color: red, roughness: t(3 * x + y, 5 * z).r }
show box([1, 1, 1]).paint(tiles);
END
# A program of others reads what is written: assimp, which writes it as OBJ.
for scene in ball can block; do
    run mesh --quiet $scene.krs --error 0.02 -o $scene.obj -o $scene.ply -o $scene.glb -o $scene.stl
    if command -v python3 >/dev/null; then
        [ "$status" -eq 0 ] && python3 "$root/tests/cli/mesh_places.py" $scene $scene.obj $scene.ply $scene.glb >out 2>err
        result $? "$scene: OBJ, PLY and GLB have the places of a closed form"
    else
        skip "$scene: OBJ, PLY and GLB have the places of a closed form" "no python3"
    fi
done
if command -v assimp >/dev/null && command -v python3 >/dev/null; then
    bad=0
    for kind in obj ply glb; do
        assimp export ball.$kind read.obj >out 2>&1 &&
            python3 "$root/tests/cli/mesh_places.py" ball read.obj >>out 2>err || bad=1
    done
    result $bad "assimp reads them, with v upwards"
else
    skip "assimp reads them, with v upwards" "no assimp or python3"
fi
# The vertices of OBJ are not doubled, so it is closed: 3 edges for 2 triangles.
awk '$1 == "v" { v++ } $1 == "f" { f++; for (i = 2; i <= 4; i++) { split($i, a, "/"); split($(i < 4 ? i + 1 : 2), b, "/");
     e[a[1] " " b[1]]++; back[b[1] " " a[1]]++ } }
     END { for (k in e) if (e[k] != 1 || back[k] != 1) bad = 1; exit bad || v - f / 2 != 2 }' ball.obj
result $? "OBJ stays closed at seams"
cat >none.krs <<'END'
let t = texture("frieze.png");
show sphere(1).paint(t(u, v)).paint(red);
show box([1, 1, 1]).move([3, 0, 0]);
END
run mesh --quiet none.krs --error 0.1 -o none.obj -o none.ply -o none.glb
[ "$status" -eq 0 ] && ! grep -q '^vt' none.obj && ! grep -a -q 'property float s' none.ply &&
    ! grep -a -q TEXCOORD_0 none.glb
result $? "without a texture that is seen there are none"
# Each copy has the texture as the kernel has it, in mirror images too.
cat >copies.krs <<'END'
let t = texture("frieze.png");
show krs {
    kernel box([0.4, 0.4, 0.4]).move([1, 0, 0]).paint(t(x, y));
    reflect plane([-1, 0, 0], 0);
    reflect plane([0, -1, 0], 3);
};
END
run mesh --quiet copies.krs --error 0.05 -o copies.glb
ended 0 "copies are meshed"
grep -a -q '"TEXCOORD_0"' copies.glb
result $? "and have places as well"
run mesh --quiet copies.krs --error 0.05 --copies flat -o copies.obj -o copies.ply
awk '$1 == "vt" { n++; if ($2 < 0.79 || $2 > 1.21 || $3 < -0.21 || $3 > 0.21) bad = 1 } END { exit bad || n < 8 }' copies.obj
result $? "and so when each is written"
