#!/bin/sh
# mesh.sh KRS [PEER]: how long meshes of examples take, and how far they are from the surface.
#
# Prints tables; what takes longer than LIMIT (60) seconds is said to.  PEER (peer.cpp) meshes three surfaces as well,
# twice for each mesh of krs: as fine as the error demands, and until it is as near to the surface as krs' mesh is.
# The farthest points are those that PEER finds on triangles of either.
krs=${1:-build/krs}
peer=${2:-}
limit=${LIMIT:-60}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
echo 'show torus(1, 0.4).rotate([1, 2, 3], 20deg);' >"$work/torus.krs"
echo 'show torus(0.7, 0.2).move([-0.35, 0, 0]) | torus(0.7, 0.2).rotate([1, 0, 0], 90deg).move([0.35, 0, 0]);' \
    >"$work/links.krs"
echo 'let k = tau; let g = field(sin(k * x) * cos(k * y) + sin(k * y) * cos(k * z) + sin(k * z) * cos(k * x));
show g & box([1, 1, 1]);' >"$work/gyroid.krs"
timed() { # command; leaves its processor seconds and seconds in $work/time
    /usr/bin/time -f '%U %e' -o "$work/time" timeout "$limit" "$@" 2>/dev/null
}
row() { # name, one part in so many, triangles, farthest or nothing
    awk -v name="$1" -v part="$2" -v n="$3" -v farthest="$4" \
        'END { printf "| %s | 1/%d | %d | %s | %s | %s |\n", name, part, n, $1, $2, farthest }' "$work/time"
}
mesh() { # scene, error, options; leaves $triangles
    scene=$1 error=$2
    shift 2
    timed "$krs" mesh --quiet "$scene" "$@" --error "$error" -o "$work/mesh.stl" || return 1
    triangles=$((($(wc -c <"$work/mesh.stl") - 84) / 50))
}
# CGAL's meshes are farther from the surface than what it is asked for, so ever less is asked for until they are near
# enough, but each time only as much less as seems to be needed: it is not to do more than it must.
mesh_peer() { # name, shape, part, how near
    asked=$4
    while timed "$peer" mesh "$2" "$asked" >"$work/peer"; do
        read -r triangles farthest <"$work/peer"
        if awk -v f="$farthest" -v near="$4" 'BEGIN { exit !(f <= near) }'; then
            row "$1" "$3" "$triangles" "$farthest"
            return
        fi
        asked=$(awk -v a="$asked" -v f="$farthest" -v near="$4" \
            'BEGIN { s = near / f; print a * (s < 0.5 ? 0.5 : s > 0.9 ? 0.9 : s) }')
    done
    echo "| $1 | 1/$3 | | | more than $limit | |"
}
beside() { # shape, longest side
    for part in 200 1000; do
        error=$(echo "$2 $part" | awk '{ print $1 / $2 }')
        if mesh "$work/$1.krs" "$error"; then
            if [ -n "$peer" ]; then
                "$peer" judge "$1" "$work/mesh.stl" >"$work/judged" || exit 1
                read -r triangles farthest <"$work/judged"
            fi
            row "$1" "$part" "$triangles" "${farthest-}"
        else
            echo "| $1 | 1/$part | | | more than $limit | |"
        fi
        [ -n "$peer" ] || continue
        as_near=${farthest-}
        mesh_peer "$1, CGAL, within the error" "$1" "$part" "$error"
        [ -z "$as_near" ] || mesh_peer "$1, CGAL, as near" "$1" "$part" "$as_near"
    done
}
measure() { # name, scene, longest side, options
    name=$1 scene=$2 side=$3
    shift 3
    for part in 200 1000; do
        if mesh "$scene" "$(echo "$side $part" | awk '{ print $1 / $2 }')" "$@"; then
            row "$name" "$part" "$triangles" ""
        else
            echo "| $name | 1/$part | | | more than $limit | |"
        fi
    done
}

echo "| scene | error | triangles | processor seconds | seconds | the farthest from the surface |"
echo "| --- | --- | --- | --- | --- | --- |"
beside torus 2.8
beside links 2.5
beside gyroid 1
measure hello examples/01-hello.krs 3 --within=-1.5,-0.1,-1.5,1.5,2.1,1.5
measure jewel examples/35-jewel.krs 9.5 --component star
measure bolt examples/30-bolt.krs 48 --component bolt
measure "bearing block" examples/03-machined-part.krs 6 --within=-3,0.05,-3,3,3,3
measure lattice examples/22-lattice.krs 4.3 --component "component 1"
