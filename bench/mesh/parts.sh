#!/bin/sh
# parts.sh KRS [JUDGE]: twenty parts as things to be made: seconds, triangles and shape of their meshes.
#
# Each is a line: its name, its longest side, and what is shown.  The error is a 200th of the side.  What takes longer than LIMIT
# (30) seconds is said to.  JUDGE (tests/oracle/mesh_judge) says whether meshes are closed, and their genus and parts.
krs=${1:-build/krs}
judge=${2:-}
limit=${LIMIT:-30}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# The vertices and faces of an OBJ file as OFF.
to_off() {
    awk '$1 == "v" { v[++n] = $2 " " $3 " " $4 } $1 == "f" { f[++m] = $2 - 1 " " $3 - 1 " " $4 - 1 }
         END { print "OFF\n" n, m, 0; for (i = 1; i <= n; i++) print v[i]; for (i = 1; i <= m; i++) print 3, f[i] }' "$1"
}
part() { # name, longest side, what is shown
    echo "show $3;" >"$work/part.krs"
    error=$(echo "$2" | awk '{ print $1 / 200 }')
    if timeout "$limit" /usr/bin/time -f '%U %e' -o "$work/time" "$krs" mesh "$work/part.krs" --error "$error" -o "$work/part.obj" \
        2>"$work/said"; then
        shape=
        if [ -n "$judge" ]; then
            to_off "$work/part.obj" >"$work/part.off"
            shape=$("$judge" "$work/part.off" | sed -n 's/.*: good, .* \(genus .*\), volume.*/\1/p; s/.*part.off: \([a-z ]*\)$/\1/p')
        fi
        said=$(sed -n 's/.*warning: \([0-9]*\) cells may.*/\1/p' "$work/said")
        read -r user real <"$work/time"
        echo "| $1 | $(grep -c '^f' "$work/part.obj") | $user | $real | $shape | ${said:-0} |"
    else
        echo "| $1 | | more than $limit | | | |"
    fi
}

echo "| part | triangles | processor seconds | seconds | shape | reported places |"
echo "| --- | --- | --- | --- | --- | --- |"
part wedge 10 'polygon([[0, 0], [10, 0], [10, 6]]).extrude(10)'
part "thin plate" 4 'box([4, 0.004, 4])'
part frustum 2 'loft([rectangle([2, 2]), rectangle([1, 1])], height: 1)'
part flange 4 'difference(cylinder(1.9, 0.5) | (cone(1.5, 2).move([0, 0.9, 0]) & cylinder(2, 1.1).move([0, 0.75, 0])), cylinder(0.42, 5), [cylinder(0.22, 2).move([1.45 * cos(i * 60deg), 0, 1.45 * sin(i * 60deg)]) for i in 0..6])'
part "flange with fillet" 4 'difference(union(box([4, 0.7, 2.4]).round(0.15), cylinder(0.85, 2).move([0, 0.9, 0]), blend: 0.5), cylinder(0.5, 5), [cylinder(0.3, 2).move([s * 1.45, 0, 0]) for s in [-1, 1]])'
part gear 3 'union([cylinder(1.2, 0.5), [prism(4, 0.22, 0.5).move([1.25 * cos(i * 18deg), 0, 1.25 * sin(i * 18deg)]) for i in 0..20]]) - cylinder(0.4, height: 1)'
part bolt 6 'prism(6, 1.6, 1.2).move([0, 2.6, 0]) & sphere(2.2).move([0, 1.6, 0]) | cylinder(0.8, 5)'
part mug 2 '(cylinder(0.8, 2) | torus(0.5, 0.12).rotate([1, 0, 0], 90deg).move([0.9, 0, 0])) - cylinder(0.7, 2).move([0, 0.1, 0])'
part "plate of studs" 128 'union([box([128, 9.6, 128]) - box([125, 9.6, 125]).move([0, -1.5, 0]), [cylinder(2.4, 1.8).move([8 * i - 60, 5.7, 8 * j - 60]) for i in 0..16 for j in 0..16]])'
part "plate of holes" 200 'difference(box([200, 3, 200]), [prism(6, 2.6, 10).move([10 * i - 95, 0, 10 * j - 95]) for i in 0..20 for j in 0..20])'
part "100 balls" 20 'union([sphere(0.8).move([2 * i, 0, 2 * j]) for i in 0..10 for j in 0..10])'
part "ball joint" 3 'box([2, 1, 2]).move([0, -0.8, 0]) - sphere(0.9) | sphere(0.8) | cylinder(0.3, 1.5).move([0, 1.2, 0])'
part dice 2 'difference(box([2, 2, 2]).round(0.2), [sphere(0.25).move([x0, 1.1, z0]) for x0 in [-0.5, 0.5] for z0 in [-0.5, 0, 0.5]])'
part "twisted vase" 3 'star(6, 1, 0.8).extrude(3).rotate([1, 0, 0], 90deg).twist([0, 1, 0], 0.5)'
part letters 4 'text("krs 8", size: 1).extrude(0.2)'
part "engraved sign" 6 'box([6, 1, 0.4]) - text("engraved", size: 0.8, align: "center", vertical: "middle").extrude(0.2).move([0, 0, 0.2])'
part "pipe elbow" 4 'tube([[0, 0, 0], [0, 2, 0], [2, 2, 0]], 0.4)'
part spool 2 'polygon([[0, -1], [0.9, -1], [0.9, -0.8], [0.4, -0.7], [0.4, 0.7], [0.9, 0.8], [0.9, 1], [0, 1]]).revolve() - cylinder(0.2, 3)'
part "cross of pipes" 4 'union([cylinder(0.5, 4).rotate([1, 0, 0], 90deg), cylinder(0.5, 4).rotate([0, 0, 1], 90deg)]) - cylinder(0.4, 5).rotate([1, 0, 0], 90deg) - cylinder(0.4, 5).rotate([0, 0, 1], 90deg)' 
part "chain of rings" 5 'union([torus(0.6, 0.15).rotate([1, 0, 0], 90deg * (i % 2)).move([0.8 * i, 0, 0]) for i in 0..5])'
