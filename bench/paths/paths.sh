#!/bin/sh
# paths.sh KRS: how many paths of light the integrator `path` follows in a second, for a diffuse scene, plastic,
# metal, glass, many lights, foliage and a city at night.  A path goes from the camera through all of its bounces, with a ray
# to a light at each.  The median of ROUNDS (3) runs counts, each in a process of its own with warm caches, by
# the time on the device.  `make bench-paths`.
set -u
cd "$(dirname "$0")/../.." || exit 1
krs=${1:-build/krs}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
rounds=${ROUNDS:-3} size=${SIZE:-640x360} samples=${SAMPLES:-16}

room='camera { eye: [0, 2.4, 7], target: [0, 1, 0], fov: 40deg }
light window { position: [-3, 5, 3], target: [0, 0.5, 0], size: [2, 2], intensity: 60 }
sky { zenith: [0.4, 0.5, 0.7], horizon: [0.8, 0.8, 0.8], ground: [0.2, 0.2, 0.2] }
show plane().paint([0.7, 0.7, 0.7]);
def three(part) = union([part.move([2.2 * i - 2.2, 1, 0]) for i in range(3)]);
show three((sphere(1) - box([0.6, 3, 0.6])).rotate([1, 0, 0], 40deg)).paint(body);'
scene() { # name, material
    echo "material body { $2 }
$room" >"$work/$1.krs"
}
scene diffuse "color: [0.7, 0.4, 0.3], roughness: 1, specular: 0"
scene plastic "color: [0.7, 0.4, 0.3], roughness: 0.2, coat: 1"
scene metal "color: [0.9, 0.7, 0.4], roughness: 0.2, metallic: 1"
scene glass "color: white, roughness: 0, transmission: 1, absorption: [0.5, 0.1, 0.1]"
sed 's/^light window.*/for i in range(30) { light { position: [0.3 * i - 4.5, 4, 3], radius: 0.1, intensity: 2 } }/' \
    "$work/diffuse.krs" >"$work/lights.krs"

measure() { # scene: millions of paths a second, distances of a path, seconds
    scene=$work/$1.krs
    [ "$1" != foliage ] || scene=$(ls examples/??-fern.krs)
    [ "$1" != night ] || scene=$(ls examples/??-night.krs)
    "$krs" render "$scene" --quiet --device cpu --integrator path --size "$size" --samples "$samples" \
        --stats json -o "$work/picture.png" 2>/dev/null | tr ',{}' '\n\n\n' | awk -F: '
        /"total"/ && !total { total = $2 }
        /"rays"/ && !rays { rays = $2 }
        /"evaluations"/ && !distances { distances = $2 }
        END { printf "%.3f %.2f %.2f\n", rays / total / 1000, distances / rays, total / 1000 }'
}

echo "| scene, $size, $samples samples | million paths a second | distances of a path | seconds |"
echo "| --- | --- | --- | --- |"
for name in diffuse plastic metal glass lights foliage night; do
    measure "$name" >/dev/null # compiles its kernels
    for _ in $(seq "$rounds"); do measure "$name"; done | sort -n | sed -n "$(((rounds + 1) / 2))p" |
        while read -r speed distances seconds; do
            echo "| $name | $speed | $distances | $seconds |"
        done
done
