#!/bin/sh
# mesh_beams.sh: `krs mesh --beams` writes unions of capsules as beam lattices into 3MF.
. "$(dirname "$0")/common.sh"
plan 9

cat >truss.krs <<'SCENE'
param thick = 0.1 in [0.05, 0.3];
let bars = [capsule([0, 0, 0], [2, 0, 0], 0.1), capsule([2, 0, 0], [2, 2, 0], 0.1), capsule([2, 2, 0], [0, 0, 0], 0.1)];
let comb = union([round_cone([i, 0, 0], [i, 1, 0.5], thick, 0.5 * thick) for i in 0..12]);
show union(bars).paint(tomato);
show comb.paint(green).rotate([0, 0, 1], 30deg).scale(2).move([0, 3, 0]);
show box([1, 1, 1]).move([0, 0, 5]);
show union(capsule([0, 0, 8], [1, 0, 8], 0.2), capsule([0, 0, 8], [0, 1, 8], 0.2), blend: 0.1);
show union(capsule([0, 0, 9], [1, 0, 9], 0.2), sphere(0.4).move([0, 0, 9]));
SCENE
model() { # file
    /usr/bin/python3 -c 'import sys, zipfile; print(zipfile.ZipFile(sys.argv[1]).read("3D/3dmodel.model").decode())' "$1"
}
beams() { # thickness, options
    thick=$1
    shift
    run mesh truss.krs --error 0.05 --beams "$@" -o truss.3mf
    [ "$status" -eq 0 ] && grep -q '^krs: 15 beams$' err &&
        /usr/bin/python3 "$root/tests/cli/mesh_beams.py" truss.3mf "$thick" >out 2>>err
    result $? "unions of capsules are beams, and the rest is meshes: $*"
}
beams 0.1
beams 0.25 --set thick=0.25
echo 'show union(capsule([0, 0, 0], [3, 0, 0], 0.5), capsule([3, 0, 0], [3, 1, 0], 0.5));' >corner.krs
run mesh corner.krs --beams --size 8 -o corner.3mf
[ "$status" -eq 0 ] && ! grep -q 'warning\|triangles' err && model corner.3mf | grep -q '<b:beam v1="0" v2="1" r1="1" r2="1"/>'
result $? "a scene of beams alone is as long as --size says"
! model corner.3mf | grep -q '<basematerials id="1">'
result $? "and has no materials without one"
run mesh corner.krs -o plain.3mf
[ "$status" -eq 0 ] && ! model plain.3mf | grep -q beam
result $? "without --beams all is triangles"
run mesh corner.krs --beams -o corner.stl
said 2 "--beams is for .3mf" "STL has no beams"
run mesh corner.krs --beams --within=-1,-1,-1,1,1,1 -o corner.3mf
said 2 "--within cuts beams" "a box cuts none"
echo 'zone { center: [0, 0, 0], radius: 0.3 } show capsule([0, 0, 0], [3, 0, 0], 0.5);' >zone.krs
run mesh zone.krs --beams -o zone.3mf
[ "$status" -eq 0 ] && grep -q 'there are no beams' err && model zone.3mf | grep -q '<triangle '
result $? "what a zone cuts is a mesh"
run mesh truss.krs --error 0.05 --beams --component comb -o comb.3mf
[ "$status" -eq 0 ] && grep -q '^krs: 12 beams$' err
result $? "one component may be asked for"
