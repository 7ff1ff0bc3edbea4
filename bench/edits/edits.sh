#!/bin/sh
# edits.sh BUILD [SCENE...]: measures edits of numbers on copies of the examples, or of the scenes of
# these names.  CACHE is a folder of caches to go on with; otherwise they begin empty.
build=$(realpath "$1")
shift
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
mkdir "$work/scenes" "$work/pictures" && cp -r examples/. "$work/scenes"
export XDG_CACHE_HOME="${CACHE:-$work/cache}" MESA_SHADER_CACHE_DIR="${CACHE:-$work/cache}"
[ $# -gt 0 ] || set -- examples/*.krs
for path; do
    shift
    set -- "$@" "$work/scenes/${path##*/}"
done
"$build/bench/edits/edits" "$build/krs" "$work/pictures" "$@"
