#!/bin/sh
# pictures.sh: pictures of all examples and scenes of the bench, under every method, schedule,
# grouping of components and stencil of normals, are bit for bit those of pictures.txt beside this file.
#
#     make golden                                compare all: three minutes on 2 cores
#     tests/golden/pictures.sh SCENE.krs...      compare these
#     tests/golden/pictures.sh --bless           write pictures.txt anew
#
# Another driver, or another processor under lavapipe, rounds in another way: the first line of
# pictures.txt tells which one it is of, and others are refused.
cd "$(dirname "$0")/../.." || exit 1
B=${B:-build}
kept=tests/golden/pictures.txt
bless=no
if [ "${1:-}" = --bless ]; then bless=yes; shift; fi
[ $# -gt 0 ] || set -- examples/*.krs bench/scenes/*.krs

device="# $("$B/krs" devices | head -n 1);$(grep -m 1 -o -w -e fma /proc/cpuinfo | head -n 1)"
device="$device $(grep -m 1 '^flags' /proc/cpuinfo | tr ' ' '\n' | grep -x -e avx2 -e avx512f | tr '\n' ' ')"
if [ $bless = no ] && [ "$(head -n 1 "$kept")" != "$device" ]; then
    echo "pictures.sh: $kept is of another device"
    head -n 1 "$kept"
    echo "$device"
    exit 2
fi

got=$(mktemp -d) && trap 'rm -rf "$got"' EXIT
# A scene at a time on each core: most of the time is the driver's compiler.
# shellcheck disable=SC2016
printf '%s\n' "$@" | xargs -P "$(nproc)" -I '{}' sh -c \
    '"$1" "$3" >"$2/$(echo "$3" | tr / _)" 2>&1 || echo "$3 failed"' - \
    "$B/tests/golden/pictures" "$got" '{}'
failed=0
for scene in "$@"; do
    lines=$got/$(echo "$scene" | tr / _)
    if [ $bless = no ] && ! grep "^$scene " "$kept" | diff - "$lines" >"$got/differences"; then
        echo "$scene: $(grep -c '^>' "$got/differences") of $(wc -l <"$lines") pictures differ"
        sed -n 's/^> /    /p' "$got/differences" | head -n 12
        failed=1
    fi
done
if [ $bless = yes ]; then
    { echo "$device"; for scene in "$@"; do cat "$got/$(echo "$scene" | tr / _)"; done; } >"$kept"
fi
exit $failed
