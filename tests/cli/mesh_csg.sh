#!/bin/sh
# mesh_csg.sh: random solids have the shape that CGAL finds.  Without CGAL that is skipped.
. "$(dirname "$0")/common.sh"
judge=$(dirname "$krs")/tests/oracle/csg_solids
plan 1
if [ -x "$judge" ]; then
    "$judge" "$krs" 24 >out 2>err
    status=$?
    sed 's/^#*/#/' out
    result $status "24 random solids have the parts, holes and volume of CGAL's set operations"
else
    skip "24 random solids have the parts, holes and volume of CGAL's set operations" "no CGAL"
fi
