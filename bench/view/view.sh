#!/bin/sh
# view.sh BUILD [SCENE...]: measures the viewer on copies of the examples, or of the scenes of these
# names; first, in a window of its own on Xvfb, what it costs when nothing happens.
build=$1
shift
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
cp -r examples/. "$work"
export KRS_VIEW_CACHE="$work/cache"

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
# shellcheck disable=SC2086 # a list of names without blanks
"$build/bench/view/view" ${scenes:-"$work"/*.krs}
