#!/bin/sh
# mesh_bake.sh: `krs mesh --bake` writes materials that vary as pictures into GLB.
. "$(dirname "$0")/common.sh"
plan 9

cat >bake.krs <<'SCENE'
def cell(q) = floor(3 * q + 0.1);
material board {
    color: if (cell(x) + cell(y) + cell(z)) % 2 < 0.5 then [0.9, 0.1, 0.1] else [0.9, 0.9, 0.8],
    roughness: 0.2 + 0.6 * clamp(y + 0.5, 0, 1), metallic: clamp(z + 0.5, 0, 1)
}
material glow { color: black, emission: [3 + 2 * x, 1, 0.5] }
show (box([2, 1, 1]) - cylinder(0.3, 3)).paint(board);
show sphere(0.7).move([2, 0, 0]).paint([0.5 + x / 6, 0.5 + 0.5 * y, 0.5]);
show torus(0.5, 0.2).move([0, 2, 0]).paint(glow);
show cylinder(0.5, 1).move([-2, 0, 0]).paint(green);
SCENE
shows() { # pixels, options
    side=$1
    shift
    run mesh --quiet bake.krs --bake "$side" "$@" -o bake.glb
    if ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
        skip "pictures show what closed forms say: $*" "no numpy"
        return
    fi
    [ "$status" -eq 0 ] && [ ! -s err ] && /usr/bin/python3 "$root/tests/cli/mesh_bake.py" bake.glb "$side" >out 2>>err
    result $? "pictures show what closed forms say: $*"
}
shows 256 --error 0.03
shows 512 --error 0.02 --lods 1
shows 256 --error 0.03 --copies flat
run mesh bake.krs --error 0.03 --bake 64 -o bake.glb -o bake.stl
[ "$status" -eq 0 ] && grep -q '64 by 64 pixels, each 0.[0-9]* long' err
result $? "it is told how long pixels are"
# The GLB has as many indices as the STL has corners.
corners=$(($(od -An -tu4 -j80 -N4 bake.stl) * 3))
indices=$(tr -d '\0' <bake.glb | grep -ao '"componentType":5125,"count":[0-9]*' | awk -F: '{ sum += $3 } END { print sum }')
[ "$corners" -gt 0 ] && [ "$indices" = "$corners" ]
result $? "there are as few triangles as the shape needs"
echo 'show sphere(1).paint(tomato); show box([1, 1, 1]).move([3, 0, 0]);' >plain.krs
run mesh plain.krs --bake 64 -o plain.glb
said 0 "no material varies, so nothing was baked" "what has nothing to bake is told"
run mesh bake.krs --bake 64 -o bake.ply
said 2 "--bake makes pictures for .glb, and none is written" "other formats have no pictures"
run mesh bake.krs --bake 8 -o bake.glb
said 2 "from 16 to 4096" "pictures have at least 16 pixels"
run mesh bake.krs --error 0.002 --bake 16 -o bake.glb
said 2 "16 pixels of --bake are too few" "and enough for all faces"
