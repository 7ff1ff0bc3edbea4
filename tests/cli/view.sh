#!/bin/sh
# view.sh: `krs view` in a real window, driven by events of a mouse and keys.  The picture in the window
# is that of `krs render`, pixel by pixel.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
export XDG_CACHE_HOME="$work/caches"
unset WAYLAND_DISPLAY
"${CC:-cc}" -std=c17 -o screen_check "$root/tests/cli/screen_check.c" -lpng || exit 1
plan 38
: >out

scene() { # radius
    printf 'camera { eye: [0, 1, %s], target: [0, 0, 0] }\n' "${far:-5}"
    printf 'light { direction: [-0.5, 1, 0.6], intensity: 2.5 }\n'
    printf 'param r = %s in [0.5, 2];\nshow sphere(r);\nshow box([4, 0.5, 1]);\n' "$1"
}
# Waits for the window to show this picture.
screen_is() { # picture
    for _ in $(seq 100); do
        ./screen_check Xvfb_screen0 "$1" >out && return 0
        kill -0 "$viewer" 2>/dev/null || return 1
        sleep 0.1
    done
    return 1
}
# The window shows what a render of the scene does.
shows() { # what was tested, options
    what=$1
    shift
    "$krs" render scene.krs --rays kernels --size 96x64 --samples 2 --specialize structure -q -o b.png "$@" \
        2>err && screen_is b.png
    result $? "$what"
}
heard() { # words, times
    for _ in $(seq 100); do
        [ "$(grep -cF -- "$1" err.view)" -ge "$2" ] && return 0
        sleep 0.05
    done
    return 1
}

run view -
said 2 "standard input has one text" "a text that cannot change"
DISPLAY='' run view ball.krs
said 69 "no window can be opened" "no display"

mkfifo number
Xvfb -displayfd 3 -screen 0 640x240x24 -fbdir . -nocursor >/dev/null 2>&1 3>number &
server=$!
read -r screen <number
export DISPLAY=":$screen"
# shellcheck disable=SC2064 # as it is now
trap "kill $server 2>/dev/null; rm -rf '$work'" EXIT

scene 1 >scene.krs
"$krs" view scene.krs --rays kernels --size 96x64 --samples 2 >out.view 2>err.view &
viewer=$!
window=$(timeout 20 xdotool search --sync --onlyvisible --name scene.krs | head -n 1)
xdotool mousemove 48 32 key Tab
shows "the first picture" --specialize numbers
# All but what a note of 152 x 65 pixels in the corner hides.
xdotool windowsize "$window" 640 160 key Tab
"$krs" render scene.krs --rays kernels --size 296x160 --samples 2 -q -o wide.png
for _ in $(seq 100); do
    ./screen_check Xvfb_screen0 wide.png >out || [ "$(cut -d ' ' -f 1 out)" -gt 9880 ] || break
    sleep 0.1
done
[ "$(cut -d ' ' -f 1 out)" -le 9880 ]
result $? "the picture stands beside the panel"
# What is under the mouse is told at the lower left where the controls need all of the height.
xdotool mousemove 230 20
sleep 1
cp Xvfb_screen0 nothing.xwd
xdotool mousemove 148 80
for _ in $(seq 50); do
    ./screen_check nothing.xwd Xvfb_screen0 0 296 >out || [ "$(cut -d ' ' -f 1 out)" -lt 3000 ] || break
    sleep 0.1
done
[ "$(cut -d ' ' -f 1 out)" -ge 3000 ] && ./screen_check nothing.xwd Xvfb_screen0 300 640 >out
result $? "what is under the mouse covers no controls"
# Each letter is a key that cuts, turns, plays or shows something else; the clicks open the section
# and go into its line.
xdotool mousemove 360 75 click 1
sleep 0.5
xdotool mousemove 560 98 click 1
sleep 0.5
xdotool type --delay 80 kzv1c
xdotool key Return
for _ in $(seq 50); do [ -e scene.krs.presets ] && break; sleep 0.1; done
grep -q kzv1c scene.krs.presets
result $? "a preset is kept by the name that is typed"
rm -f scene.krs.presets
xdotool windowsize "$window" 96 64 mousemove 48 32 click 1 key Tab
shows "and letters of a name do nothing else"
scene 1.25 >scene.krs
shows "a number is edited"
for i in 1 2 3 4 5; do
    echo 'show spere(1);' >scene.krs
    heard "a name that is similar exists: \`sphere\`" "$i" || break
    scene "1.$i" >new.krs && mv new.krs scene.krs
    sleep 0.3
done
shows "edits, each second one with a mistake"
far=4.5
scene 0.9 >scene.krs
shows "a camera that nobody has moved follows its text"
xdotool mousedown 1 mousemove 60 40 mousemove 70 30 mouseup 1 click 5
for _ in $(seq 50); do ./screen_check Xvfb_screen0 b.png >out || break; sleep 0.1; done
[ "$(cat out)" != "0 pixels differ" ]
result $? "the mouse moves the camera"
xdotool key h
screen_is b.png
result $? "and a key takes it back"
scene 0.8 >scene.krs
scene '0.5' | sed 's/box(/sphere(0.7).move(/; s/\[4/[1/' >scene.krs
shows "the structure is edited"
xdotool windowunmap "$window"
scene 1.1 >scene.krs
sleep 0.3
xdotool windowmap "$window" windowsize "$window" 120 80
shows "hidden, edited, and shown in another size" --size 120x80
xdotool key F1
sleep 0.3
xdotool key Escape
screen_is b.png
result $? "the help comes and goes"
xdotool key F12
for _ in $(seq 50); do [ -s view-0000.png ] && break; sleep 0.1; done
sleep 0.2
./screen_check Xvfb_screen0 view-0000.png >out
result $? "the picture is saved"
xdotool key ctrl+F12
for _ in $(seq 100); do [ -s view-0001.png ] && break; sleep 0.1; done
sleep 0.2
./screen_check Xvfb_screen0 view-0001.png >out
result $? "the picture is rendered into a file"
xdotool key Escape
wait "$viewer"
status=$?
ended 0 "a key closes the window"

printf '#!/bin/sh\necho "$*" >opened\n' >editor && chmod +x editor
KRS_EDITOR="./editor -g" "$krs" view scene.krs --rays kernels --size 96x64 --samples 1 --set r=0.75 >out.view 2>err.view &
viewer=$!
timeout 20 xdotool search --sync --onlyvisible --name scene.krs >/dev/null
scene 0.75 >written.krs
sleep 0.5
xdotool key ctrl+s
for _ in $(seq 50); do cmp -s scene.krs written.krs && break; sleep 0.1; done
cmp scene.krs written.krs >out
result $? "a value is written into the text, and nothing else"
xdotool key Tab mousemove 48 32
for _ in $(seq 20); do
    xdotool keydown ctrl click 1 keyup ctrl
    sleep 0.2
    [ -s opened ] && break
done
[ "$(cat opened)" = "-g scene.krs:4" ]
result $? "a click opens the text where it has what is clicked"
xdotool key 3 ctrl+e
for _ in $(seq 50); do cmp -s scene.krs written.krs || break; sleep 0.1; done
sed 1d written.krs >rest
sed 1d scene.krs | cmp - rest >out 2>&1 && grep -q '^camera { eye: .*orthographic.* }$' scene.krs &&
    "$krs" render scene.krs --rays kernels --size 96x64 --samples 1 --specialize structure -q -o b.png 2>err && screen_is b.png
result $? "the camera is written into the text, and nothing else"
# By keys alone: the first item of the panel is the slider.
xdotool key --delay 150 F2 Down space Left Left Left F2
xdotool key ctrl+s
for _ in $(seq 50); do grep -q 'r = 0.7[0-4]' scene.krs && break; sleep 0.1; done
grep -q '^param r = 0.7[0-4][0-9]* in \[0.5, 2\];$' scene.krs
result $? "keys pull a slider"
rm -f opened
echo 'show spere(1);' >scene.krs
heard "a name that is similar exists: \`sphere\`" 1
for _ in $(seq 20); do
    xdotool key o
    sleep 0.2
    grep -qs ':1$' opened && break
done
[ "$(cat opened)" = "-g scene.krs:1" ]
result $? "a key opens the text at its mistake"
printf 'camera { eye: [0, 1, 9], target: [0, 1, 0] }\nshow box([1, 1, 1]).move([0.5, 1, 0]);\nshow sphere(0.5).move([9, 0, 0]);\n' >scene.krs
xdotool key h
"$krs" render scene.krs --rays kernels --size 96x64 --samples 1 --specialize structure -q -o b.png 2>err && screen_is b.png
xdotool key shift+f ctrl+e
for _ in $(seq 50); do grep -q 'target: \[0.5, 1, 0\]' scene.krs && break; sleep 0.1; done
grep -q 'target: \[0.5, 1, 0\]' scene.krs
result $? "a key frames what is under the mouse"
printf 'camera { eye: [4, 3, 6] } show sphere(1);' >own.krs
# shellcheck disable=SC2046 # many words
(cd "$root" && "${CC:-cc}" -Wall -Wextra -Werror -Iinclude -o "$work/own" examples/c/view.c "${B:-build}/libkrs.a" \
    $(make --no-print-directory -s libs) -lglfw -lGL) >out 2>&1
result $? "the viewer of examples/c compiles"
[ "$(wc -l <"$root/examples/c/view.c")" -le 200 ]
result $? "it has 200 lines at most"
other=$viewer
./own own.krs >said 2>err.view &
viewer=$!
window=$(timeout 20 xdotool search --sync --onlyvisible --name own.krs | head -n 1)
xdotool windowsize "$window" 96 64 mousemove 48 32 windowraise "$window"
own_is() { # what was tested
    "$krs" render own.krs --rays kernels --size 96x64 --samples 8 --specialize structure -q -o b.png 2>err && screen_is b.png
    result $? "$1"
}
own_is "it shows the scene"
printf 'camera { eye: [4, 3, 6] }\nshow box([2, 1, 1]);' >own.krs
sleep 0.3
own_is "it follows the file"
xdotool click 1
sleep 0.3
grep -q '^component 1 at .*, .*, ' said
result $? "it says what is clicked"
xdotool key --window "$window" q
wait "$viewer"
status=$?
viewer=$other
ended 0 "and ends"

# A window manager that leaves windows without a frame in the corner of the screen.
cat >manager.xml <<'END'
<?xml version="1.0"?>
<openbox_config xmlns="http://openbox.org/3.4/rc"><theme><keepBorder>no</keepBorder></theme>
<applications><application class="*"><decor>no</decor>
<position force="yes"><x>0</x><y>0</y></position></application></applications></openbox_config>
END
other=$viewer
openbox --config-file "$work/manager.xml" >manager.log 2>&1 &
manager=$!
printf 'show sphere(1);' >small.krs
"$krs" view small.krs --rays kernels --size 96x64 --samples 2 >out.view 2>err.view &
viewer=$!
window=$(timeout 20 xdotool search --sync --onlyvisible --name small.krs | head -n 1)
xdotool windowactivate --sync "$window" mousemove 48 32 key Tab
"$krs" render small.krs --rays kernels --size 96x64 --samples 2 --specialize structure -q -o b.png && screen_is b.png
result $? "a window manager shows it"
xdotool windowminimize "$window"
for _ in $(seq 50); do ./screen_check Xvfb_screen0 b.png >out || break; sleep 0.1; done
[ "$(cat out)" != "0 pixels differ" ]
result $? "it is minimised"
printf 'show box([2, 1, 1]);' >small.krs
sleep 0.3
xdotool windowactivate "$window"
"$krs" render small.krs --rays kernels --size 96x64 --samples 2 --specialize structure -q -o b.png && screen_is b.png
result $? "and shows what was edited meanwhile"
xdotool key --window "$window" Escape
wait "$viewer"
status=$?
ended 0 "a key closes it"
printf 'param h = 1 in [0.5, 4];\nshow box([1, h, 1]);' >tall.krs
"$krs" view tall.krs --rays lanes --size 96x64 --samples 2 --set h=4 >out.view 2>err.view &
viewer=$!
window=$(timeout 20 xdotool search --sync --onlyvisible --name tall.krs | head -n 1)
xdotool windowactivate --sync "$window" mousemove 48 32 key Tab
"$krs" render tall.krs --rays lanes --size 96x64 --samples 2 --set h=4 --specialize structure -q -o b.png && screen_is b.png
result $? "by lanes: the camera of a scene without one, and its floor, are for what is set"
xdotool key --window "$window" Escape
wait "$viewer"
status=$?
ended 0 "and it closes"
kill "$manager"
viewer=$other
kill "$server"
wait "$viewer"
status=$?
cp err.view err
said 69 "the display is gone" "the display goes away"
no_temporaries
result $? "nothing is left over"
