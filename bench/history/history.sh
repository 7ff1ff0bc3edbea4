#!/bin/sh
# history.sh: two builds of krs beside each other, on scenes drawn at random.
#
# usage: bench/history/history.sh BEFORE AFTER [TURNS] [SIZE]
#
# BEFORE and AFTER are commands (build/krs).  Scenes are SCENES (30) of the seed SEED (39) by scenes.awk,
# or the files that FILES names.  The builds render by turns, each with a cache of its own, which a picture
# fills before the others are timed.  Printed in Markdown: milliseconds on the device for each of SAMPLES (3)
# rays a pixel, before and after, and their ratio.  They are the least of all turns, since what disturbs a
# run only makes it longer.
set -u
[ $# -ge 2 ] || { sed -n '4p' "$0" | sed 's/^# //' >&2; exit 2; }
before=$1 after=$2 turns=${3:-5} size=${4:-1280x720}
samples=${SAMPLES:-3}
here=$(dirname "$0")
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# Writes "BUILD PHASE=MS..." of a picture.
render() { # "before" or "after", scene
    [ "$1" = before ] && command=$before || command=$after
    mkdir -p "$work/$1"
    XDG_CACHE_HOME="$work/$1" MESA_SHADER_CACHE_DIR="$work/$1" "$command" render "$2" --size "$size" \
        --samples "$samples" --quiet --stats json -o "$work/$1.exr" >"$work/stats" || exit 1
    sed 's/.*"render": {\([^}]*\)}.*/\1/; s/[" ]//g; s/:/=/g; s/,/ /g; s/^/'"$1"' /' "$work/stats"
}

compare() { # scene
    render before "$1" >/dev/null
    render after "$1" >/dev/null
    turn=0
    while [ "$turn" -lt "$turns" ]; do
        render before "$1"
        render after "$1"
        turn=$((turn + 1))
    done | awk -v scene="$(basename "$1" .krs)" -v samples="$samples" -f "$here/history.awk"
}

files=${FILES-}
if [ -z "$files" ]; then
    for number in $(seq "${SCENES:-30}"); do
        kind=$(awk -v seed="${SEED:-39}" -v number="$number" -v name=1 -f "$here/scenes.awk")
        awk -v seed="${SEED:-39}" -v number="$number" -f "$here/scenes.awk" >"$work/$number-$kind.krs"
        files="$files $work/$number-$kind.krs"
    done
fi
echo "# Scenes drawn at random, by two builds"
echo
echo "The least of $turns turns at $size; milliseconds before, after, and their ratio. \`bench/history/history.sh\`"
echo
echo "| scene | beams | rays | normals | all three | shadows, occlusion | shading, resolve | all |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for file in $files; do
    compare "$file"
done
