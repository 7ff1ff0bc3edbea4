#!/bin/sh
# mesh.sh KRS: how long meshes of examples take, and how many triangles a second that is.  Prints a
# table; what takes longer than LIMIT (60) seconds is said to.
krs=${1:-build/krs}
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
measure torus "$work/torus.krs" 2.8
measure gyroid "$work/gyroid.krs" 1
measure hello examples/01-hello.krs 3 --within=-1.5,-0.1,-1.5,1.5,2.1,1.5
measure jewel examples/35-jewel.krs 9.5 --component star
measure bolt examples/30-bolt.krs 48 --component bolt
measure "bearing block" examples/03-machined-part.krs 6 --within=-3,0.05,-3,3,3,3
measure lattice examples/22-lattice.krs 4.3 --component "component 1"
