#!/bin/sh
# mesh_csg.sh: random solids have the shape that CGAL finds.  Without CGAL that is skipped.
. "$(dirname "$0")/common.sh"
judge=$(dirname "$krs")/tests/oracle/csg_solids
plan 3
if [ -x "$judge" ]; then
    "$judge" "$krs" 24 >out 2>err
    status=$?
    sed 's/^#*/#/' out
    result $status "24 random solids have the parts, holes and volume of CGAL's set operations"
    # Three or four curved faces meet in short edges there, and no way crosses all of them.
    for number in 30 50 112 190 244 262 592; do
        "$judge" "$krs" 1 $number | head -n 1
    done >out
    sed 's/^#*/#/' out
    [ "$(grep -c ': agree: .* errors away' out)" = 7 ]
    result $? "and nothing is reported where they are as thick as three errors"
    # Knife edges and the ends of a thread, where tetrahedra make holes and crumbs.
    for number in 17 45 109 341 433 581; do
        "$judge" "$krs" 1 $number | head -n 1
    done >out
    sed 's/^#*/#/' out
    [ "$(grep -c ': agree: .* errors away' out)" = 6 ]
    result $? "and knife edges have neither holes nor crumbs"
else
    skip "and knife edges have neither holes nor crumbs" "no CGAL"
    skip "and nothing is reported where they are as thick as three errors" "no CGAL"
    skip "24 random solids have the parts, holes and volume of CGAL's set operations" "no CGAL"
fi
