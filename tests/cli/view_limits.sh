#!/bin/sh
# view_limits.sh: deadlines and limits of `krs view` count work, not waiting; a text that takes too long, or a
# pipe in the place of the scene, is said, and the window stays.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
export XDG_CACHE_HOME="$work/caches"
unset WAYLAND_DISPLAY
"${CC:-cc}" -std=c17 -o screen_check "$root/tests/cli/screen_check.c" -lpng || exit 1
plan 12
find_untrusted
: >out

scene() { printf 'camera { eye: [0, 1, 5], target: [0, 0, 0] }\nshow sphere(%s);\n' "$1"; }
# Seconds of work to compile, more than the deadline and the limit below allow; it looks like scene 1.25.
scene_of_many() {
    scene 1.25
    echo 'show union([sphere(0.1).move([i, j, k] / 200) for k in 0..60 for j in 0..100 for i in 0..100]);'
}
screen_is() { # picture
    for _ in $(seq 200); do
        ./screen_check Xvfb_screen0 "$1" >out && return 0
        kill -0 "$viewer" 2>/dev/null || return 1
        sleep 0.1
    done
    return 1
}
screen_differs() { # picture
    for _ in $(seq 200); do
        ./screen_check Xvfb_screen0 "$1" >out || return 0
        sleep 0.1
    done
    return 1
}
shows() { # what was tested
    "$krs" render scene.krs --rays kernels --size 96x64 --samples 2 --specialize structure -q -o b.png 2>err && screen_is b.png
    result $? "$1"
}
heard() { # words, times
    for _ in $(seq 200); do
        [ "$(grep -cF -- "$1" err.view)" -ge "$2" ] && return 0
        kill -0 "$viewer" 2>/dev/null || return 1
        sleep 0.05
    done
    return 1
}
opens() { # options
    "$krs" view scene.krs --rays kernels --size 96x64 --samples 2 "$@" >out.view 2>err.view &
    viewer=$!
    timeout 20 xdotool search --sync --onlyvisible --name scene.krs >/dev/null
    xdotool mousemove 48 32 key Tab
}

mkfifo number
Xvfb -displayfd 3 -screen 0 640x240x24 -fbdir . -nocursor >/dev/null 2>&1 3>number &
server=$!
read -r screen <number
export DISPLAY=":$screen"
# shellcheck disable=SC2064 # as it is now
trap "kill $server 2>/dev/null; rm -rf '$work'" EXIT

scene_of_many >many.krs
run view many.krs --deadline 1
said 1 "gave up compiling the scene after 1 seconds" "a scene that is not compiled by the deadline"
run view many.krs "$untrusted" --limit time=1
said 1 "stopped while compiling the scene: --limit time=1 allows no longer" "or within its limit"

scene 1 >scene.krs
opens --deadline 1 "$untrusted" --limit time=3
sleep 5
shows "a limit of time does not count waiting"
rm scene.krs
mkfifo scene.krs
heard "no file, but a pipe or a device" 1 && screen_differs b.png
result $? "a pipe in the place of the scene is said, in the window too"
rm scene.krs
ln -s /dev/zero scene.krs
heard "no file, but a pipe or a device" 2 || heard "outside" 1
result $? "and a device"
rm scene.krs
scene 1.25 >scene.krs
shows "and a file there is shown"
scene_of_many >new.krs && mv new.krs scene.krs
screen_differs b.png
result $? "the window says that a text takes long"
sleep 3
kill -s 0 "$viewer" && ! grep -q "gave up" err.view
result $? "and stays, whatever the deadline and the limit"
scene 1.5 >new.krs && mv new.krs scene.krs
shows "the next text is shown"
scene_of_many >new.krs && mv new.krs scene.krs
sleep 1
xdotool key Escape
wait "$viewer"
status=$?
cp err.view err
said 1 "gave up compiling the scene after 1 seconds" "who closes the window waits no longer than the deadline"
scene 1 >scene.krs
opens --limit time=3
xdotool key Escape
wait "$viewer"
status=$?
ended 0 "a key closes the window"
no_temporaries
result $? "nothing is left over"
