#!/bin/sh
# bench-registers.sh: registers, waves and spills of the shaders of scenes, as Mesa's compiler for a
# graphics card has them that need not be there; `make bench-registers` runs it.  Prints the table,
# and writes bench/results/DATE-registers-navi21.md; with scenes as arguments it only prints.
#
# KRS_DEVICE: another device, by a part of its name, whose driver tells as much.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${B:-build}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
sheet=bench/results/$(date +%F)-registers-${KRS_DEVICE:-navi21}.md
[ $# -eq 0 ] || sheet=""
[ $# -gt 0 ] || set -- bench/scenes/tree28.krs bench/scenes/forest.krs examples/*.krs

for scene in "$@"; do
    "$build/krs" compile --quiet "$scene" -o "$folder" || exit 1
done
set --
for kernel in trace normals secondary shade query point_query; do
    set -- "$@" "$folder"/*".$kernel.spv"
done
{
    echo "# Registers of each kernel"
    echo
    echo "- date: $(date +%F)"
    echo "- revision: ${REVISION:-unknown}"
    echo "- command: make bench-registers"
    echo "- kernels: as \`krs compile\` writes them, with early outs; groups of 64"
    echo
    "$build/bench/registers/registers" "$@"
} >"$folder/table" || { cat "$folder/table"; exit 1; }
cat "$folder/table"
[ -z "$sheet" ] || { mkdir -p bench/results && cp "$folder/table" "$sheet"; }
