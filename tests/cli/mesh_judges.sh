#!/bin/sh
# mesh_judges.sh: CGAL, a slicer and Blender accept what `krs mesh` writes.  What is not installed is skipped.
. "$(dirname "$0")/common.sh"
judge=$(dirname "$krs")/tests/oracle/mesh_judge
plan 12

cat >vase.krs <<'END'
let wall = field(sin(3 * x) * cos(3 * y) + sin(3 * y) * cos(3 * z) + sin(3 * z) * cos(3 * x)).shell(0.9);
show (cylinder(1, 2) & wall) | cylinder(1, 0.4).move([0, -1, 0]);
END
cat >crossed.off <<'END'
OFF
8 8 0
0 0 0
1 0 0
0 1 0
0 0 1
0.1 0.1 0.1
1.1 0.1 0.1
0.1 1.1 0.1
0.1 0.1 1.1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
3 4 6 5
3 4 5 7
3 4 7 6
3 5 6 7
END
head -n 13 crossed.off | sed 's/^8 8 0/8 3 0/' >open.off
# The vertices and faces of an OBJ file as OFF.
to_off() {
    awk '$1 == "v" { v[++n] = $2 " " $3 " " $4 } $1 == "f" { f[++m] = $2 - 1 " " $3 - 1 " " $4 - 1 }
         END { print "OFF\n" n, m, 0; for (i = 1; i <= n; i++) print v[i]; for (i = 1; i <= m; i++) print 3, f[i] }' "$1"
}
run mesh --quiet vase.krs --error 0.1 -o vase.obj -o vase.stl
ended 0 "a vase is meshed"
to_off vase.obj >vase.off
if [ -x "$judge" ]; then
    "$judge" vase.off >out
    grep -q 'vase.off: good, .* 1 parts' out
    result $? "CGAL finds one part, closed, a manifold, without crossings"
    ! "$judge" crossed.off >out && grep -q 'crosses itself' out
    result $? "and finds a planted crossing"
    ! "$judge" open.off >out && grep -q 'open' out
    result $? "and a planted hole"
    # Edges that touch where they have no end: pipes, roofs and grooves that cross at one height.
    awk 'function member(name, text) { print "show (" text ").rotate([1, 2, 3], " 37 * i "deg);" >name i ".krs" }
        BEGIN {
            for (i = 0; i < 8; i++) {
                turn = i % 2 ? "90deg" : 50 + 5 * i "deg"
                wide = 0.4 + 0.07 * i
                pipe = "cylinder(" wide ", 4).rotate([1, 0, 0], 90deg)"
                bore = "cylinder(" 0.8 * wide ", 5).rotate([1, 0, 0], 90deg)"
                roof = "polygon([[-" wide ", 0], [" wide ", 0], [0, 0.6]]).extrude(4)"
                other = "polygon([[-0.7, 0], [0.7, 0], [0, 0.6]]).extrude(4)"
                cut = "polygon([[-0.7, 0], [0, -" wide "], [0.7, 0]]).extrude(6).move([0, 1, 0])"
                member("pipes", "(" pipe " | " pipe ".rotate([0, 1, 0], " turn ")) - " bore " - " bore ".rotate([0, 1, 0], " turn ")")
                member("roofs", roof " | " other ".rotate([0, 1, 0], " turn ")")
                member("grooves", "box([4, 2, 4]) - " cut " - " cut ".rotate([0, 1, 0], " turn ")")
            }
        }'
    for name in pipes roofs grooves; do
        for i in 0 1 2 3 4 5 6 7; do
            "$krs" mesh --quiet $name$i.krs --error 0.03 -o $name.obj && to_off $name.obj >$name$i.off
        done
    done
    "$judge" pipes?.off roofs?.off grooves?.off >out
    [ "$(grep -c 'pipes..off: good, .* genus 3, 1 parts' out) $(grep -c '[rg].*s..off: good, .* genus 0, 1 parts' out)" = "8 16" ]
    result $? "and nothing where edges touch that have no end there"
    # Mitred corners, whose parts overlap by little more than what becomes a point.
    awk 'BEGIN {
        for (i = 0; i < 24; i++) {
            bent = (49 + 1.5 * i) * atan2(0, -1) / 180
            x = 0.7 * cos(bent)
            z = 0.7 * sin(bent)
            printf "show sweep(rectangle([%g, %g]), [[-0.7, 0, 0], [0.1, 0, 0], [%.9f, 0, %.9f], [%.9f, 0, %.9f]])" \
                ".rotate([%d, -4, 1], %d);\n", 0.2 + (i + 2) % 7 * 0.02, 0.2 + (i + 1) % 5 * 0.05, \
                0.1 + x, z, 0.8 + x, z, i - 4, (i + 4) % 6 + 1 >"bent" i ".krs"
        }
    }'
    for i in 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23; do
        "$krs" mesh --quiet bent$i.krs --error 0.03 -o bent.obj && to_off bent.obj >bent$i.off
    done
    "$judge" bent*.off >out
    [ "$(grep -c 'good, .* genus 0, 1 parts' out)" = 24 ]
    result $? "and nothing at corners of sweeps"
    # Polygons that shrink and grow: their volumes by area, perimeter and corners.
    echo 'show polygon([[-3, 0], [3, 0], [5, 4], [-5, 4]]).rotate(10deg).move([1, 2]).offset(-0.1).extrude(20);' >shrunk.krs
    echo 'show polygon([[0, 0], [4, 0], [0, 3]]).round(0.3).extrude(2);' >rounded.krs
    echo 'show (polygon([[0, 0], [6, 0], [6, 4], [3, 1], [0, 4]]).offset(-0.2) | rectangle([1, 1]).move([9, 0])).extrude(1);' >notched.krs
    for name in shrunk rounded notched; do
        "$krs" mesh --quiet $name.krs --error 0.01 --limit time=20 -o $name.obj && to_off $name.obj >$name.off
    done
    "$judge" shrunk.off rounded.off notched.off | awk '{
            sub(/,/, "", $5); shape[$1] = $5; volume[$1] = $NF; good += $2 == "good," && / genus 0/
        }
        END {
            pi = atan2(0, -1)
            trapezoid = 32 - 0.1 * (16 + 2 * sqrt(20)) + 0.01 * 2 * sqrt(5) # the cotangents of half its angles
            exit !(good == 3 && shape["shrunk.off:"] == 12 && shape["rounded.off:"] < 700 &&
                near(volume["shrunk.off:"], 20 * trapezoid, 0.001) &&
                near(volume["rounded.off:"], 2 * (6 + 12 * 0.3 + pi * 0.09), 0.05))
        }
        function near(a, b, by) { return a - b < by && b - a < by }'
    result $? "and the volumes of polygons that shrink and grow"
else
    skip "and nothing at corners of sweeps" "no CGAL"
    skip "and the volumes of polygons that shrink and grow" "no CGAL"
    skip "and nothing where edges touch that have no end there" "no CGAL"
    skip "CGAL finds one part, closed, a manifold, without crossings" "no CGAL"
    skip "and finds a planted crossing" "no CGAL"
    skip "and a planted hole" "no CGAL"
fi
if command -v prusa-slicer >/dev/null; then
    prusa-slicer --export-gcode --scale 20 --center 100,100 --output vase.gcode vase.stl >out 2>err &&
        [ "$(grep -c '^;LAYER_CHANGE' vase.gcode)" -gt 100 ] &&
        ! grep -q -i 'repaired\|open edges\|manifold' out err vase.gcode
    result $? "a slicer makes layers of it, without repair"
else
    skip "a slicer makes layers of it, without repair" "no prusa-slicer"
fi

# A ball and a cube: two parts, whose volume is 4/3 pi + 1.
cat >two.krs <<'END'
material red { color: tomato }
show sphere(1).paint(red); show box([1, 1, 1]).move([3, 0, 0]);
END
run mesh --quiet two.krs --error 0.01 -o two.3mf -o two.obj
"$krs" mesh --quiet two.krs --error 0.01 --split materials -o two.glb
ended 0 "two parts are meshed"
if command -v prusa-slicer >/dev/null; then
    for file in two.3mf two.obj; do
        prusa-slicer --info "$file" 2>/dev/null
    done | awk -F '= *' '/^manifold/ { whole += $2 == "yes" } /^number_of_parts/ { parts += $2 }
        /^volume/ { near += $2 > 5.0 && $2 < 5.19 } END { print whole, parts, near }' >out
    [ "$(cat out)" = "2 4 2" ]
    result $? "the slicer reads 3MF and OBJ: their parts, closed, and their volume"
else
    skip "the slicer reads 3MF and OBJ: their parts, closed, and their volume" "no prusa-slicer"
fi
if command -v blender >/dev/null; then
    # Materials that vary bring their colours in the corners; plain ones need none.
    sed "s;color: tomato;color: mix(tomato, gold, 0.5 + x / 2);" two.krs >varying.krs
    "$krs" mesh --quiet varying.krs --error 0.01 --split materials -o varying.glb
    for name in two varying; do
        blender -b --factory-startup --python "$root/tests/cli/mesh_blender.py" -- "$work/$name.glb" 2>err
    done >out
    awk '$1 == "object" { n++; good += $3 == "closed" && $5 == (n == 2) && $4 > 5.13 && $4 < 5.19 &&
        $6 ~ /(^|,)red(,|$)/ && $6 ~ /,/ } END { exit !(n == 2 && good == 2) }' out
    result $? "Blender reads a GLB: its parts, closed, their volume, colours and materials"
else
    skip "Blender reads a GLB: its parts, closed, their volume, colours and materials" "no Blender"
fi

cat >baked.krs <<'END'
material band { color: [0.5 + x / 4, 0.5, 0.5], roughness: 0.5 + x / 4, emission: [1 + x, 0, 0] }
show box([1, 1, 1]).paint(band);
END
if command -v blender >/dev/null; then
    "$krs" mesh --quiet baked.krs --bake 64 -o baked.glb
    blender -b --factory-startup --python "$root/tests/cli/mesh_blender.py" -- "$work/baked.glb" >out 2>err
    [ "$(grep '^picture' out | sort | tr '\n' ';')" = "picture band Base_Color 64 sRGB;picture band Emission 64 sRGB;picture band Metallic+Roughness 64 Non-Color;" ]
    result $? "Blender has the pictures of a baked material, and what they are of"
else
    skip "Blender has the pictures of a baked material, and what they are of" "no Blender"
fi
