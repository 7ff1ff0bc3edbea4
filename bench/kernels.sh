#!/bin/sh
# kernels.sh: first pictures of two builds of krs, with empty caches, on every example.
#
# usage: bench/kernels.sh BEFORE AFTER [TURNS] [SIZE]
#
# BEFORE and AFTER are commands (build/krs).  They render by turns, each time with new caches, so
# that a machine that becomes slower for a while is slower for both.  Printed in Markdown:
#   kernels  the kernels that are compiled for the scene,
#   CPU      processor seconds of the whole process, the least of all iterations,
#   wall     its seconds, the least of all iterations,
# before and after, and the ratio of processor seconds.
set -u
[ $# -ge 2 ] || { sed -n '4p' "$0" | sed 's/^# //' >&2; exit 2; }
before=$1 after=$2 turns=${3:-3} size=${4:-640x360}
cd "$(dirname "$0")/.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# One run of a build: "BUILD KERNELS CPU WALL".
run() { # "before" or "after", scene
    [ "$1" = before ] && command=$before || command=$after
    rm -rf "${work:?}/cache" && mkdir "$work/cache"
    start=$(date +%s%N)
    # The shell of its own has no other children, whose time it would count as well.
    XDG_CACHE_HOME="$work/cache" MESA_SHADER_CACHE_DIR="$work/cache" sh -c '"$@" >/dev/null; times' \
        run "$command" render "$2" --size "$size" --samples 1 --quiet \
        -o "$work/picture.exr" >"$work/times" || exit 1
    end=$(date +%s%N)
    echo "$1 $(find "$work/cache/krs" -name '*.spirv' | wc -l) $(tail -n 1 "$work/times" |
        awk '{ for (i = 1; i <= 2; i++) { split($i, t, /[ms]/); sum += 60 * t[1] + t[2] }
               print sum }') $(((end - start) / 1000000))"
}

echo "| scene | kernels | CPU | ratio | wall |"
echo "| --- | --- | --- | --- | --- |"
for scene in ${SCENES:-examples/*.krs}; do
    turn=0
    : >"$work/runs"
    while [ "$turn" -lt "$turns" ]; do
        run before "$scene" >>"$work/runs"
        run after "$scene" >>"$work/runs"
        turn=$((turn + 1))
    done
    awk -v scene="$(basename "$scene" .krs)" '
        { kernels[$1] = $2
          if (!($1 in cpu) || $3 < cpu[$1]) cpu[$1] = $3
          if (!($1 in wall) || $4 < wall[$1]) wall[$1] = $4 }
        END {
            printf "| %s | %d, %d | %.2f, %.2f | %.2f | %.2f, %.2f |\n", scene, kernels["before"],
                kernels["after"], cpu["before"], cpu["after"], cpu["after"] / cpu["before"],
                wall["before"] / 1000, wall["after"] / 1000
        }' "$work/runs"
done
