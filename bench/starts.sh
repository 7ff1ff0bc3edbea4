#!/bin/sh
# starts.sh: how long each example takes to its first picture, with empty and with full caches.
#
# usage: bench/starts.sh [KRS] [TURNS] [SIZE]
#
# One sample of 640x360 pixels, by a process of its own.  Printed in Markdown, medians of all iterations:
#   kernels  those that are compiled for the scene,
#   cold     seconds to the end with empty caches: on the wall, and of processors,
#   warm     the same once more with the caches that the cold run has filled,
#   frame    milliseconds of the picture itself, warm.
# With a busy machine only the seconds of processors tell something.
set -u
krs=${1:-build/krs} turns=${2:-3} size=${3:-640x360}
cd "$(dirname "$0")/.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# One run: "KIND KERNELS WALL CPU FRAME".
run() { # "cold" or "warm", scene
    start=$(date +%s%N)
    # The shell of its own has no other children, whose time it would count as well.
    XDG_CACHE_HOME="$work/cache" MESA_SHADER_CACHE_DIR="$work/cache" \
        sh -c '"$@" >"$0"; status=$?; times; exit $status' "$work/stats" "$krs" render "$2" \
        --size "$size" --samples 1 --quiet --stats json -o "$work/picture.exr" >"$work/times" ||
        exit 1
    end=$(date +%s%N)
    cpu=$(tail -n 1 "$work/times" | awk '{ for (i = 1; i <= 2; i++) { split($i, t, /[ms]/)
                                                                     sum += 60 * t[1] + t[2] }
                                           print sum }')
    frame=$(sed 's/"passes": {[^}]*}//; s/.*"wall": \([0-9.]*\).*/\1/' "$work/stats")
    kernels=$(grep -o '"cached": false' "$work/stats" | wc -l)
    echo "$1 $kernels $(((end - start) / 1000000)) $cpu $frame"
}

echo "| scene | kernels | cold | CPU | warm | CPU | frame |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
for scene in ${SCENES:-examples/*.krs}; do
    turn=0
    : >"$work/runs"
    while [ "$turn" -lt "$turns" ]; do
        rm -rf "$work/cache" && mkdir "$work/cache"
        run cold "$scene" >>"$work/runs" || exit 1
        run warm "$scene" >>"$work/runs" || exit 1
        turn=$((turn + 1))
    done
    awk -v scene="$(basename "$scene" .krs)" '
        # The median of column `column` of the runs of a kind.
        function median(kind, column,    i, k, least, sorted, count) {
            count = counts[kind]
            for (i = 1; i <= count; i++) {
                for (k = i; k > 1 && sorted[k - 1] > values[kind, i, column]; k--)
                    sorted[k] = sorted[k - 1]
                sorted[k] = values[kind, i, column]
            }
            return (sorted[int((count + 1) / 2)] + sorted[int((count + 2) / 2)]) / 2
        }
        { counts[$1]++; for (i = 2; i <= NF; i++) values[$1, counts[$1], i] = $i + 0 }
        END {
            printf "| %s | %d | %.2f | %.2f | %.2f | %.2f | %d |\n", scene, median("cold", 2),
                median("cold", 3) / 1000, median("cold", 4), median("warm", 3) / 1000,
                median("warm", 4), median("warm", 5)
        }' "$work/runs"
done | awk '{ print; n = split($0, cell, "|"); cold += cell[4]; cpu += cell[5]; warm += cell[6]; warm_cpu += cell[7] }
            END { printf "| all | | %.1f | %.1f | %.1f | %.1f | |\n", cold, cpu, warm, warm_cpu }'
