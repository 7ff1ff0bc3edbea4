#!/bin/sh
# view_random.sh: 1,000 random actions of mouse, keys and editor, on the viewer under the address and
# undefined-behaviour sanitizers: it ends by a key, as if nothing had been.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 3
unset WAYLAND_DISPLAY
build=${B:-build}
case $build in /*) ;; *) build=$root/$build ;; esac
watched=$build/asan/krs
if [ ! -x "$watched" ]; then
    skip "random actions" "there is no $watched (make sanitize)"
    skip "the sanitizers" "there is none"
    skip "what is left over" "there is nothing"
    exit
fi
export XDG_CACHE_HOME="$work/caches"
export ASAN_OPTIONS=detect_leaks=0 # drivers leak

# Lines for xdotool: the same on every machine.
awk 'function chance(n) { seed = (seed * 16807) % 2147483647; return seed % n }
     BEGIN {
         seed = 20261123
         count = split("f h c x 1 3 5 7 k k z z bracketleft bracketright v n Tab F1 comma period " \
             "space BackSpace Left Right Up Down shift+Left plus minus ctrl+1 ctrl+3 ctrl+7 " \
             "ctrl+z ctrl+y ctrl+c ctrl+e ctrl+s", keys, " ")
         for (i = 0; i < 1000; i++) {
             what = chance(20)
             place = chance(160) " " chance(120)
             if (what < 9) print "key --delay 0 " keys[1 + chance(count)]
             else if (what < 12) print "mousemove " place
             else if (what < 14) print "mousemove " place " mousedown 1 mouseup 1"
             else if (what < 16) print "mousemove " place " mousedown " 1 + chance(3) \
                 " mousemove " chance(160) " " chance(120) " mouseup 1 mouseup 2 mouseup 3"
             else if (what < 17) { button = 4 + chance(2); print "mousedown " button " mouseup " button }
             else if (what < 18) print "keydown alt mousemove " place " mousedown 1 mousemove " \
                 chance(160) " " chance(120) " mouseup 1 keyup alt"
             else if (what < 19) print "windowsize WINDOW " 20 + chance(150) " " 20 + chance(110)
             else print "windowunmap WINDOW windowmap WINDOW"
             if (i % 20 == 19) print "sleep 0.04"
         }
     }' >actions

scene() { # radius
    printf 'param r = %s in [0.5, 2];\nparam lit = 1 in 0..2;\nparam tint = #ff8000;\n' "$1"
    printf 'show sphere(r).move([lit, 0, 0]).paint(tint);\nshow box([3, 0.5, 1]);\n'
}
mkfifo number
Xvfb -displayfd 3 -screen 0 160x120x24 -nocursor >/dev/null 2>&1 3>number &
server=$!
read -r screen <number
export DISPLAY=":$screen"
# shellcheck disable=SC2064 # as it is now
trap "kill $server 2>/dev/null; rm -rf '$work'" EXIT
scene 1 >scene.krs
"$watched" view scene.krs --size 64x48 --samples 1 >out 2>err &
viewer=$!
window=$(timeout 60 xdotool search --sync --onlyvisible --name scene.krs | head -n 1)
sed "s/WINDOW/$window/g" actions | split -l 260 - part.
i=0
for part in part.*; do
    xdotool - <"$part" >said 2>&1
    i=$((i + 1))
    case $((i % 4)) in
    0) echo 'show spere(1);' >scene.krs ;;
    1) scene "1.$i" >scene.krs ;;
    2) scene 0.75 | sed 's/show box/show cylinder(0.4, 3); show box/' >new.krs && mv new.krs scene.krs ;;
    3) scene 1 >scene.krs ;;
    esac
done
kill -0 "$viewer" 2>/dev/null
result $? "1,000 actions leave the window open"
for _ in $(seq 100); do
    xdotool key --window "$window" ctrl+q 2>/dev/null
    kill -0 "$viewer" 2>/dev/null || break
    sleep 0.1
done
wait "$viewer"
status=$?
[ "$status" -eq 0 ] && ! grep -q 'Sanitizer\|runtime error' err
result $? "the sanitizers have nothing to say"
no_temporaries
result $? "nothing is left over"
