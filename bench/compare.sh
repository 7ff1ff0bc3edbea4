#!/bin/sh
# compare.sh: two builds of krs beside each other, on every example and scene of the bench.
#
# usage: bench/compare.sh BEFORE AFTER [TURNS] [SIZE]
#
# BEFORE and AFTER are commands (build/krs).  They render by turns, so that a machine that becomes
# slower for a while is slower for both.  Each has a cache of its own: runs that find it empty compile
# all shaders (cold, three of each), the others find them (warm).  Printed in Markdown: medians of
#   sum    the time on the device without shadows and occlusion, and with them (total),
#   wall   of the picture,
#   front  the front end, with the text of the program,
#   JIT    SPIR-V and the driver, cold,
#   start  the whole process, warm,
# and their ratios, after by before.
set -u
[ $# -ge 2 ] || { sed -n '4p' "$0" | sed 's/^# //' >&2; exit 2; }
before=$1 after=$2 turns=${3:-5} size=${4:-1280x720}
cd "$(dirname "$0")/.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# The number behind a name in a JSON text.
number() { # name, file
    sed -n "s/.*\"$1\": \([0-9.e+-]*\).*/\1/p" "$2"
}

# One run of a build: "KIND BUILD VALUE" lines for a scene.
run() { # "before" or "after", scene, "cold" or "warm"
    [ "$1" = before ] && command=$before || command=$after
    mkdir -p "$work/$1"
    start=$(date +%s%N)
    XDG_CACHE_HOME="$work/$1" MESA_SHADER_CACHE_DIR="$work/$1" "$command" render "$2" --size "$size" \
        --samples 1 --quiet --stats json -o "$work/picture.exr" >"$work/stats" || exit 1
    end=$(date +%s%N)
    sed -i 's/"passes": {[^}]*}/"passes": 0/' "$work/stats"
    front=$(number front "$work/stats") glsl=$(number glsl "$work/stats")
    if [ "$3" = cold ]; then
        echo "JIT $1 $(number spirv "$work/stats") $(number pipeline "$work/stats")"
        return
    fi
    total=$(number total "$work/stats")
    echo "sum $1 $total -$(number shadows "$work/stats") -$(number occlusion "$work/stats")"
    echo "total $1 $total"
    echo "wall $1 $(number wall "$work/stats")"
    echo "front $1 $front $glsl"
    echo "start $1 $(((end - start) / 1000000))"
}

echo "# Two builds beside each other"
echo
echo "$turns turns at $size; milliseconds before, after, and their ratio. \`bench/compare.sh\`"
echo
echo "| scene | sum | total | wall | front | JIT | start |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
for scene in ${SCENES:-examples/*.krs bench/scenes/*.krs}; do
    : >"$work/runs"
    for turn in 1 2 3; do
        for build in before after; do
            rm -rf "${work:?}/$build"
            run "$build" "$scene" cold >>"$work/runs"
        done
    done
    turn=0
    while [ "$turn" -lt "$turns" ]; do
        for build in before after; do
            run "$build" "$scene" warm >>"$work/runs"
        done
        turn=$((turn + 1))
    done
    awk -v scene="$scene" -f bench/compare.awk "$work/runs"
done | tee "$work/rows"
awk -F'|' '
    NF > 6 { # sums over the scenes
        for (i = 3; i <= 8; i++) { split($i, part, " "); a[i] += part[1]; b[i] += part[2] }
    }
    END {
        printf "| **all** |"
        for (i = 3; i <= 8; i++) printf " %.0f %.0f **%.3f** |", a[i], b[i], b[i] / a[i]
        print ""
    }' "$work/rows"
