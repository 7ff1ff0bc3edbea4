#!/bin/sh
# view.sh BUILD [SCENE...]: measures the viewer on copies of the examples, or of the scenes of these
# names; first, in a window of its own on Xvfb, what it costs when nothing happens, then how soon there are pictures, with
# empty caches.
build=$1
shift
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
cp -r examples/. "$work"
export KRS_VIEW_CACHE="$work/cache" XDG_CACHE_HOME="$work/cache" MESA_SHADER_CACHE_DIR="$work/cache"

if command -v Xvfb >/dev/null; then
    mkfifo "$work/number"
    Xvfb -displayfd 3 -screen 0 640x360x24 >/dev/null 2>&1 3>"$work/number" &
    server=$!
    read -r screen <"$work/number"
    DISPLAY=":$screen" "$build/krs" view "$work/01-hello.krs" --size 640x360 --samples 1 &
    viewer=$!
    sleep 20
    ticks() { awk '{ print $14 + $15 }' "/proc/$viewer/stat"; }
    before=$(ticks)
    sleep 10
    IDLE=$(awk -v ticks="$(($(ticks) - before))" -v hertz="$(getconf CLK_TCK)" \
        'BEGIN { printf "%.2f %%", 100 * ticks / hertz / 10 }')
    export IDLE
    kill "$viewer" "$server"
    wait
fi
for name in "${@:-}"; do
    [ -n "$name" ] && scenes="${scenes:-} $work/$name"
done
# How soon, by shaders alone and with lanes.
for scene in ${scenes:-"$work"/*.krs}; do
    row="| ${scene##*/} |"
    for executor in kernels auto; do
        rm -rf "$work/cache"
        cp "$scene" "$scene.kept"
        row="$row$("$build/bench/view/first" "$scene" "$executor")" || exit 1
        mv "$scene.kept" "$scene"
    done
    echo "$row"
done | tee "$work/first"
rm -rf "$work/cache"
export FIRST="$work/first"
# shellcheck disable=SC2086 # a list of names without blanks
"$build/bench/view/view" ${scenes:-"$work"/*.krs}
