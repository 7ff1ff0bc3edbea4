#!/bin/sh
# textures.sh KRS: what textures and patterns cost on the processor (lavapipe).  A scene is rendered with
# plain materials and with others, one after the other, again and again; the least time of each counts.
# `make bench-textures`.
set -u
cd "$(dirname "$0")/../.." || exit 1
krs=${1:-build/krs}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
rounds=${ROUNDS:-3} size=${SIZE:-1280x720}

# A scene whose surfaces have this material.
write_scene() { # name, colour by the point q
    cat >"$work/$1.krs" <<SCENE
use "std/patterns.krs";
let t = texture("$PWD/examples/frieze.png");
let g = texture("$PWD/examples/relief.png", space: "linear");
camera { eye: [0, 2.5, 7], target: [0, 0.6, 0], fov: 45deg }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 2deg }
def painted(q) = $2;
show sphere(1).move([-1.2, 1, 0]).paint(painted(p));
show (box([1.6, 1.6, 1.6]) - sphere(1)).rotate([0, 1, 0], 30deg).move([1.3, 0.8, 0]).paint(painted(p));
show plane([0, 1, 0], 0).paint(painted(p));
SCENE
}
# The name of a material, and its colour; the first is what the others are compared with.
materials='plain|[0.5, 0.6, 0.7] + 0.001 * q
texture|t(q.x, q.z)
gray texture|g(q.x, q.z)
texture from three sides|triplanar(t, q, normal)
checker|checker(q.xz) * white
brick|brick(q.xz) * white
fbm, 5 octaves|(0.5 + 0.5 * fbm(q)) * white
filtered fbm, 5 octaves|(0.5 + 0.5 * soft_fbm(q)) * white
marble|marble(q) * white
wood|wood(q) * white
cells|voronoi(q)'

# Milliseconds of processor time that a sample takes: what many take beyond few, so that all else, such as
# compiling, does not count.
used() { # number, samples
    { times && "$krs" render "$work/$1.krs" --size "$size" --samples "$2" --quiet --device cpu \
        -o "$work/picture.exr" 2>/dev/null && times; } | awk '
        { split($1, user, "[ms]"); split($2, kernel, "[ms]") }
        NR % 2 == 0 { now = 60000 * (user[1] + kernel[1]) + 1000 * (user[2] + kernel[2])
                      if (NR == 2) before = now; else printf "%d", now - before }'
}
measure() { # number
    few=$(used "$1" "$FEW") many=$(used "$1" "$MANY")
    echo "$1 $(((many - few) * 10 / (MANY - FEW)))"
}
FEW=2 MANY=18

count=0
echo "$materials" >"$work/materials"
while IFS='|' read -r _ colour; do
    count=$((count + 1))
    write_scene "$count" "$colour"
    used "$count" 1 >/dev/null # compiles its kernels
done <"$work/materials"
round=0
while [ "$round" -lt "$rounds" ]; do
    round=$((round + 1)) number=0
    while [ "$number" -lt "$count" ]; do
        number=$((number + 1))
        measure "$number" >>"$work/times"
    done
done
sort -k1,1n -k2,2n "$work/times" | awk -v names="$work/materials" '
    BEGIN { while ((getline line <names) > 0) { split(line, part, "|"); name[++n] = part[1] } }
    !($1 in least) { least[$1] = $2 / 10 }
    END {
        print "| material | CPU time of a sample, ms | of the plain one |"
        print "| --- | --- | --- |"
        for (i = 1; i <= n; i++)
            printf "| %s | %.0f | %.2f |\n", name[i], least[i], least[i] / least[1]
    }'
