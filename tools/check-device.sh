#!/bin/sh
# check-device.sh [TEST PROGRAM...]: what one wants to know of a Vulkan device first; `make
# check-device DEVICE=...` runs it.  Prints it, and writes bench/results/DATE-device-NAME.md.
#
# KRS_DEVICE is the device, in the words of `krs --device`.  SIZE (640x360) is that of the examples,
# METHODS_SIZE (1920x1080) that of the tree; EXAMPLES are those to look at (all).  What takes longer
# than SECONDS_EACH (120), or dies, is told and left out.
set -u
cd "$(dirname "$0")/.." || exit 1
. tests/support/drivers.sh
build=${B:-build} size=${SIZE:-640x360} methods_size=${METHODS_SIZE:-1920x1080}
device=$build/bench/device/device
examples=${EXAMPLES:-$(echo examples/*.krs)}
add_driver_of "${KRS_DEVICE:-}" || exit 1
export KRS_DEVICE="${KRS_DEVICE:-}"
names=$("$device" name) || exit 1
slug=$(echo "$names" | head -n 1)
mkdir -p bench/results
sheet=bench/results/$(date +%F)-device-$slug.md
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

say() { printf '%s\n' "$*" | tee -a "$sheet.new"; }

# A section, or the row of a table: what failed is told in its place.
tell() { # name, words of the program
    what=$1
    shift
    timeout -k 5 "${SECONDS_EACH:-120}" "$device" "$@" >"$work/out" 2>"$work/err" </dev/null
    status=$?
    tee -a "$sheet.new" <"$work/out"
    [ "$status" -eq 0 ] && return
    [ -z "$(tail -c 1 "$work/out")" ] || say ""
    case $status in
    124 | 137) say "| $what | took longer than ${SECONDS_EACH:-120} seconds |" ;;
    *) say "| $what | ended with status $status: $(tail -n 1 "$work/err") |" ;;
    esac
}

: >"$sheet.new"
say "# What to know of $(echo "$names" | tail -n 1)"
say ""
say "- date: $(date +%F)"
say "- revision: ${REVISION:-unknown}"
say "- processor: $(nproc) cores, $(uname -m)"
say "- load before: $(cut -d ' ' -f 1 /proc/loadavg)"
say "- command: make check-device DEVICE=${KRS_DEVICE:-} SIZE=$size METHODS_SIZE=$methods_size"
say ""
say "## Limits and features"
say ""
tell limits limits
say ""
say "## Accuracy"
say ""
say "Against double precision of the same floats. \`krs_\` functions are the program's own."
say ""
tell accuracy accuracy
say ""
say "## Examples, $size"
say ""
say "Milliseconds: until the first picture, all compiled; then of the second, on the device and until"
say "it is there. Differences from lavapipe: pixels that show another thing, or depths that differ by"
say "more than half the width of a pixel; those at outlines are told, and not counted below."
say ""
say "| example | first | device | wall | unresolved | lavapipe | differ, at outlines | what |"
say "| --- | --- | --- | --- | --- | --- | --- | --- |"
for scene in $examples; do
    tell "${scene##*/}" example "$size" "$scene"
done
say ""
say "## Methods"
say ""
say "The least of three pictures by phase, in milliseconds of the device; the last column counts"
say "pixels that differ from the first row of the table, as above."
for scene in bench/scenes/tree28.krs bench/scenes/forest.krs; do
    say ""
    say "${scene##*/}, $methods_size:"
    say ""
    say "| method | beams | primary | normals | shadows | occlusion | sum | wall | evals/ray | differ |"
    say "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for early_outs in off on; do
        tell "${scene##*/}, early outs $early_outs" methods "$methods_size" "$scene" "$early_outs"
    done
done
say ""
say "## Kernels"
say ""
say "Milliseconds of glslang (with the optimizer and the validator), and of the driver, one kernel"
say "after the other, nothing from a cache."
say ""
say "| scene | kernel | glslang | driver |"
say "| --- | --- | --- | --- |"
export MESA_SHADER_CACHE_DISABLE=true __GL_SHADER_DISK_CACHE=0
for scene in bench/scenes/tree28.krs $examples; do
    tell "${scene##*/}" kernels "$scene"
done
unset MESA_SHADER_CACHE_DISABLE __GL_SHADER_DISK_CACHE
if [ $# -gt 0 ]; then
    say ""
    say "## Tests"
    say ""
    say '```'
    KRS_TEST_SECONDS=${KRS_TEST_SECONDS:-300} tests/run.sh ${KRS_DEVICE:+KRS_DEVICE="$KRS_DEVICE"} "$@" 2>&1 |
        grep -E '^(====|     |not ok|[0-9]+ passed)' | tee -a "$sheet.new"
    say '```'
fi
mv "$sheet.new" "$sheet"
echo "written to $sheet"
