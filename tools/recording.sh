#!/bin/sh
# recording.sh BUILD: records docs/pictures/view.webp: `krs view` in a window on Xvfb, with its camera
# turned, a slider pulled, and two edits saved.  It needs Xvfb, xdotool and ffmpeg.
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/.." || exit 1
width=960 height=500 rate=10
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
cp examples/01-hello.krs "$work/hello.krs"
export XDG_CACHE_HOME="$work/caches"
unset WAYLAND_DISPLAY

mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 ${width}x${height}x24 >/dev/null 2>&1 3>"$work/number" &
server=$!
read -r screen <"$work/number"
export DISPLAY=":$screen"
(cd "$work" && # names of files are shown
    exec "$build/krs" view hello.krs --size ${width}x${height} --samples 4 --specialize structure) &
viewer=$!
timeout 60 xdotool search --sync --onlyvisible --name hello.krs >/dev/null
xdotool mousemove 200 300
sleep "${WARM_UP:-25}" # shaders

ffmpeg -loglevel error -y -f x11grab -framerate $rate -video_size ${width}x${height} -i "$DISPLAY" \
    -c:v ffv1 "$work/recording.mkv" &
recorder=$!
# In steps, as a hand does it.
pull() { # from x, y, by dx, dy, steps
    xdotool mousemove "$1" "$2" mousedown 1
    for step in $(seq "$5"); do
        xdotool mousemove $(($1 + $3 * step / $5)) $(($2 + $4 * step / $5))
        sleep 0.04
    done
    xdotool mouseup 1
}
sleep 3
pull 200 300 170 -20 30
sleep 3
pull $((width - 120)) 51 90 0 25
sleep 3
pull $((width - 30)) 51 -130 0 25
sleep 3
sed -i 's/clay  { color: #c8553d/clay  { color: #4a6fa5/' "$work/hello.krs"
sleep 3.5
sed -i 's/let hole  = sphere(0.86)/let hole  = sphere(0.7)/' "$work/hello.krs"
sleep 4
kill -INT "$recorder"
wait "$recorder"
kill "$viewer" "$server"
wait
ffmpeg -loglevel error -y -i "$work/recording.mkv" -c:v libwebp_anim -loop 0 -quality 82 \
    docs/pictures/view.webp
ls -l docs/pictures/view.webp
