#!/bin/sh
# mesh.sh KRS [PEER]: how long meshes of examples take, and how many triangles a second that is.  Prints a
# table; what takes longer than LIMIT (60) seconds is said to.  PEER meshes some of them as well (peer.cpp).
krs=${1:-build/krs}
peer=${2:-}
limit=${LIMIT:-60}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
echo 'show torus(1, 0.4).rotate([1, 2, 3], 20deg);' >"$work/torus.krs"
echo 'let k = tau; let g = field(sin(k * x) * cos(k * y) + sin(k * y) * cos(k * z) + sin(k * z) * cos(k * x));
show g & box([1, 1, 1]);' >"$work/gyroid.krs"
echo "| scene | error | triangles | processor seconds | seconds | triangles a second |"
echo "| --- | --- | --- | --- | --- | --- |"
measure() { # name, scene, longest side, options
    name=$1 scene=$2 side=$3
    shift 3
    for part in 200 1000; do
        error=$(echo "$side $part" | awk '{ print $1 / $2 }')
        if /usr/bin/time -f '%U %e' -o "$work/time" timeout "$limit" "$krs" mesh --quiet "$scene" "$@" \
            --error "$error" -o "$work/mesh.stl" 2>/dev/null; then
            triangles=$((($(wc -c <"$work/mesh.stl") - 84) / 50))
            awk -v name="$name" -v part=$part -v n=$triangles \
                'END { printf "| %s | 1/%d | %d | %s | %s | %.0f |\n", name, part, n, $1, $2, n / $2 }' "$work/time"
        else
            echo "| $name | 1/$part | | | more than $limit | |"
        fi
    done
}
# Who asks for an error may get more, so ever less is asked for until the farthest is within the error.
measure_peer() { # shape, longest side
    for part in 200 1000; do
        for share in 1 2 4 8 16; do
            error=$(echo "$2 $part $share" | awk '{ print $1 / $2 / $3 }')
            /usr/bin/time -f '%U %e' -o "$work/time" timeout "$limit" "$peer" "$1" "$error" >"$work/peer" || break
            awk -v share=$share '{ exit !($2 <= share) }' "$work/peer" && break
        done
        cat "$work/time" "$work/peer" | tr '\n' ' ' |
            awk -v name="$1, CGAL" -v part=$part -v share=$share '{
                printf "| %s | 1/%d | %s | %s | %s | %.0f |%s\n", name, part, $3, $1, $2, $3 / $2,
                    ($4 > share ? sprintf(" (not within the error: %.1f times as far)", $4 / share) : "") }'
    done
}

measure torus "$work/torus.krs" 2.8
echo 'show torus(0.7, 0.2).move([-0.35, 0, 0]) | torus(0.7, 0.2).rotate([1, 0, 0], 90deg).move([0.35, 0, 0]);' \
    >"$work/links.krs"
measure links "$work/links.krs" 2.5
measure gyroid "$work/gyroid.krs" 1
[ -z "$peer" ] || for shape in "torus 2.8" "links 2.5" "gyroid 1"; do
    measure_peer ${shape% *} "${shape#* }"
done
measure hello examples/01-hello.krs 3 --within=-1.5,-0.1,-1.5,1.5,2.1,1.5
measure jewel examples/35-jewel.krs 9.5 --component star
measure bolt examples/30-bolt.krs 48 --component bolt
measure "bearing block" examples/03-machined-part.krs 6 --within=-3,0.05,-3,3,3,3
measure lattice examples/22-lattice.krs 4.3 --component "component 1"
