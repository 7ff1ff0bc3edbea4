#!/bin/sh
# mesh_csg.sh: random solids have the shape that CGAL finds.  Without CGAL that is skipped.
. "$(dirname "$0")/common.sh"
judge=$(dirname "$krs")/tests/oracle/csg_solids
plan 2
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
else
    skip "and nothing is reported where they are as thick as three errors" "no CGAL"
    skip "24 random solids have the parts, holes and volume of CGAL's set operations" "no CGAL"
fi
