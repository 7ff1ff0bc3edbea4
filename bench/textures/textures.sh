#!/bin/sh
# textures.sh KRS: what textures and patterns cost.  A scene is rendered with plain materials and with
# others, one after the other, again and again; the least time of each counts.  `make bench-textures`.
set -u
cd "$(dirname "$0")/../.." || exit 1
krs=${1:-build/krs}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
times=${TIMES:-7} size=${SIZE:-1280x720}

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

# Milliseconds of a frame's shading, and of all of it, on the device.
measure() { # number
    "$krs" render "$work/$1.krs" --size "$size" --samples 1 --stats json --quiet \
        -o "$work/picture.exr" 2>/dev/null | tr ',{}' '\n\n\n' |
        sed -n 's/^ *"\(shading\|total\)": *//p' | tr '\n' ' '
}

count=0
echo "$materials" >"$work/materials"
while IFS='|' read -r _ colour; do
    count=$((count + 1))
    write_scene "$count" "$colour"
    measure "$count" >/dev/null # compiles its kernels
done <"$work/materials"
round=0
while [ "$round" -lt "$times" ]; do
    round=$((round + 1)) number=0
    while [ "$number" -lt "$count" ]; do
        number=$((number + 1))
        echo "$number $(measure "$number")" >>"$work/times"
    done
done
# The least of each.  Only shading knows materials: what it takes longer is what a frame takes longer.
sort -k1,1n -k2,2n "$work/times" | awk -v names="$work/materials" '
    BEGIN { while ((getline line <names) > 0) { split(line, part, "|"); name[++n] = part[1] } }
    !($1 in shade) { shade[$1] = $2 }
    !($1 in frame) || $3 < frame[$1] { frame[$1] = $3 }
    END {
        print "| material | shading, ms | frame, of the plain one |"
        print "| --- | --- | --- |"
        for (i = 1; i <= n; i++)
            printf "| %s | %.0f | %.2f |\n", name[i], shade[i],
                   1 + (shade[i] - shade[1]) / frame[1]
        printf "\nA frame of the plain one takes %.0f ms.\n", frame[1]
    }'
