#!/bin/sh
# parts.sh KRS [JUDGE]: twenty parts as things to be made: seconds, triangles and shape of their meshes.
#
# Each is a line: its name, its longest side, and what is shown.  The error is a 200th of the side.  What takes longer than LIMIT
# (30) seconds is said to.  JUDGE (tests/oracle/mesh_judge) says whether meshes are closed, and their genus and parts.
#
# Where OpenSCAD is installed it makes those that it can say, too.  Its circles have as many sides as keep these within the error: sides(r).
krs=${1:-build/krs}
judge=${2:-}
limit=${LIMIT:-30}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# The vertices and faces of an OBJ file as OFF.
to_off() {
    awk '$1 == "v" { v[++n] = $2 " " $3 " " $4 } $1 == "f" { f[++m] = $2 - 1 " " $3 - 1 " " $4 - 1 }
         END { print "OFF\n" n, m, 0; for (i = 1; i <= n; i++) print v[i]; for (i = 1; i <= m; i++) print 3, f[i] }' "$1"
}
# The triangles and seconds of OpenSCAD, as two columns.
by_openscad() { # error, what is made
    if [ -z "$2" ] || ! command -v openscad >/dev/null; then
        echo "| |"
        return
    fi
    cat >"$work/part.scad" <<END
e = $1;
function sides(r) = max(3, ceil(180 / acos(1 - min(e / r, 1))));
module tube(h, r) { cylinder(h = h, r = r, center = true, \$fn = sides(r)); }
module ball(r) { sphere(r = r, \$fn = sides(r)); }
module ring(R, r) { rotate_extrude(\$fn = sides(R + r)) translate([R, 0]) circle(r = r, \$fn = sides(r)); }
module block(s) { cube(s, center = true); }
$2
END
    if timeout "$limit" /usr/bin/time -f '%U' -o "$work/time" openscad -o "$work/part.stl" "$work/part.scad" >"$work/said" 2>&1; then
        echo "| $(grep -c 'facet normal' "$work/part.stl") | $(tail -n 1 "$work/time") "
    else
        echo "| | more than $limit "
    fi
}
part() { # name, longest side, what is shown, and in OpenSCAD
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
        echo "| $1 | $(grep -c '^f' "$work/part.obj") | $user | $real | $shape | ${said:-0} $(by_openscad "$error" "$4")|"
    else
        echo "| $1 | | more than $limit | | | $(by_openscad "$error" "$4")|"
    fi
}

echo "| part | triangles | processor seconds | seconds | shape | reported places | OpenSCAD's triangles | its processor seconds |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
part wedge 10 'polygon([[0, 0], [10, 0], [10, 6]]).extrude(10)' \
    'linear_extrude(10, center = true) polygon([[0, 0], [10, 0], [10, 6]]);'
part "thin plate" 4 'box([4, 0.004, 4])' \
    'block([4, 0.004, 4]);'
part frustum 2 'loft([rectangle([2, 2]), rectangle([1, 1])], height: 1)' \
    'linear_extrude(1, center = true, scale = 0.5) square(2, center = true);'
part flange 4 'difference(cylinder(1.9, 0.5) | (cone(1.5, 2).move([0, 0.9, 0]) & cylinder(2, 1.1).move([0, 0.75, 0])), cylinder(0.42, 5), [cylinder(0.22, 2).move([1.45 * cos(i * 60deg), 0, 1.45 * sin(i * 60deg)]) for i in 0..6])' \
    'difference() { union() { tube(0.5, 1.9); intersection() { translate([0, 0, 0.9]) cylinder(h = 2, r1 = 1.5, r2 = 0, center = true, $fn = sides(1.5)); translate([0, 0, 0.75]) tube(1.1, 2); } } tube(5, 0.42); for (i = [0:5]) rotate(60 * i) translate([1.45, 0, 0]) tube(2, 0.22); }'
part "flange with fillet" 4 'difference(union(box([4, 0.7, 2.4]).round(0.15), cylinder(0.85, 2).move([0, 0.9, 0]), blend: 0.5), cylinder(0.5, 5), [cylinder(0.3, 2).move([s * 1.45, 0, 0]) for s in [-1, 1]])'
part gear 3 'union([cylinder(1.2, 0.5), [box([0.44, 0.5, 0.44]).move([1.25, 0, 0]).rotate([0, 1, 0], i * 18deg) for i in 0..20]]) - cylinder(0.4, height: 1)' \
    'difference() { union() { tube(0.5, 1.2); for (i = [0:19]) rotate(18 * i) translate([1.25, 0, 0]) block([0.44, 0.44, 0.5]); } tube(1, 0.4); }'
part bolt 6 'prism(6, 1.6, 1.2).move([0, 2.6, 0]) & sphere(2.2).move([0, 1.6, 0]) | cylinder(0.8, 5)' \
    'union() { tube(5, 0.8); intersection() { translate([0, 0, 2.6]) cylinder(h = 1.2, r = 1.6 / cos(30), center = true, $fn = 6); translate([0, 0, 1.6]) ball(2.2); } }'
part mug 2 '(cylinder(0.8, 2) | torus(0.5, 0.12).rotate([1, 0, 0], 90deg).move([0.9, 0, 0])) - cylinder(0.7, 2).move([0, 0.1, 0])' \
    'difference() { union() { tube(2, 0.8); translate([0.9, 0, 0]) rotate([90, 0, 0]) ring(0.5, 0.12); } translate([0, 0, 0.1]) tube(2, 0.7); }'
part "plate of studs" 128 'union([box([128, 9.6, 128]) - box([125, 9.6, 125]).move([0, -1.5, 0]), [cylinder(2.4, 1.8).move([8 * i - 60, 5.7, 8 * j - 60]) for i in 0..16 for j in 0..16]])' \
    'difference() { block([128, 128, 9.6]); translate([0, 0, -1.5]) block([125, 125, 9.6]); } for (i = [0:15], j = [0:15]) translate([8 * i - 60, 8 * j - 60, 5.7]) tube(1.8, 2.4);'
part "plate of holes" 200 'difference(box([200, 3, 200]), [prism(6, 2.6, 10).move([10 * i - 95, 0, 10 * j - 95]) for i in 0..20 for j in 0..20])' \
    'difference() { block([200, 200, 3]); for (i = [0:19], j = [0:19]) translate([10 * i - 95, 10 * j - 95, 0]) cylinder(h = 10, r = 2.6 / cos(30), center = true, $fn = 6); }'
part "100 balls" 20 'union([sphere(0.8).move([2 * i, 0, 2 * j]) for i in 0..10 for j in 0..10])' \
    'for (i = [0:9], j = [0:9]) translate([2 * i, 2 * j, 0]) ball(0.8);'
part "ball joint" 3 'box([2, 1, 2]).move([0, -0.8, 0]) - sphere(0.9) | sphere(0.8) | cylinder(0.3, 1.5).move([0, 1.2, 0])' \
    'difference() { translate([0, 0, -0.8]) block([2, 2, 1]); ball(0.9); } ball(0.8); translate([0, 0, 1.2]) tube(1.5, 0.3);'
part dice 2 'difference(box([2, 2, 2]).round(0.2), [sphere(0.25).move([x0, 1.1, z0]) for x0 in [-0.5, 0.5] for z0 in [-0.5, 0, 0.5]])'
part "twisted vase" 3 'star(6, 1, 0.8).extrude(3).rotate([1, 0, 0], 90deg).twist([0, 1, 0], 0.5)' \
    'linear_extrude(3, twist = -180 / PI * 1.5, slices = 60, center = true) polygon([for (i = [0:11]) (i % 2 == 0 ? 1 : 0.8) * [sin(30 * i), cos(30 * i)]]);'
part letters 4 'text("krs 8", size: 1).extrude(0.2)'
part "engraved sign" 6 'box([6, 1, 0.4]) - text("engraved", size: 0.8, align: "center", vertical: "middle").extrude(0.2).move([0, 0, 0.2])'
part "pipe elbow" 4 'tube([[0, 0, 0], [0, 2, 0], [2, 2, 0]], 0.4)'
part spool 2 'polygon([[0, -1], [0.9, -1], [0.9, -0.8], [0.4, -0.7], [0.4, 0.7], [0.9, 0.8], [0.9, 1], [0, 1]]).revolve() - cylinder(0.2, 3)' \
    'difference() { rotate_extrude($fn = sides(0.9)) polygon([[0, -1], [0.9, -1], [0.9, -0.8], [0.4, -0.7], [0.4, 0.7], [0.9, 0.8], [0.9, 1], [0, 1]]); tube(3, 0.2); }'
part "cross of pipes" 4 'union([cylinder(0.5, 4).rotate([1, 0, 0], 90deg), cylinder(0.5, 4).rotate([0, 0, 1], 90deg)]) - cylinder(0.4, 5).rotate([1, 0, 0], 90deg) - cylinder(0.4, 5).rotate([0, 0, 1], 90deg)' \
    'difference() { union() { rotate([90, 0, 0]) tube(4, 0.5); rotate([0, 90, 0]) tube(4, 0.5); } rotate([90, 0, 0]) tube(5, 0.4); rotate([0, 90, 0]) tube(5, 0.4); }'
part "chain of rings" 5 'union([torus(0.6, 0.15).rotate([1, 0, 0], 90deg * (i % 2)).move([0.8 * i, 0, 0]) for i in 0..5])' \
    'for (i = [0:4]) translate([0.8 * i, 0, 0]) rotate([90 * (i % 2), 0, 0]) ring(0.6, 0.15);'
