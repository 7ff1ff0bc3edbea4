#!/bin/sh
# too_large.sh: scenes that are too large for shaders are drawn by lanes of the processor, unless that cannot be.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 12

# Parts from which others are taken, no two the same ones.
different() { # how many
    awk -v count="$1" '
        function random(below) { seed = (seed * 16807) % 2147483647; return seed % below }
        function number(low, high) { return low + (high - low) * random(100000) / 100000 }
        BEGIN {
            seed = 12345
            split("sphere(%.4f) box([%.4f,0.04,0.03]) cylinder(%.4f,0.06) torus(%.4f,0.01)", kinds, " ")
            print "camera { eye: [1.6, 1.2, -3.2], target: [0, 0, 0] } show union(["
            for (i = 0; i < count; i++) {
                x = number(-1, 1); y = number(-1, 1); z = number(-1, 1)
                for (k = 0; k < 6; k++) {
                    off = k ? 0.05 : 0
                    printf (k ? " - " : "") kinds[1 + random(4)], number(0.03, 0.06)
                    printf ".move([%.4f, %.4f, %.4f])", x + number(-off, off), y + number(-off, off), z + number(-off, off)
                }
                print ","
            }
            print "]);"
        }'
}
different 3000 >most.krs
different 600 >many.krs
different 3 >few.krs

run check most.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "3,000 different parts are no mistake"
run info many.krs
[ "$status" -eq 0 ] && grep -q '^too large for shaders: ' out
result $? "krs info tells that they are too large for shaders"
run info few.krs
[ "$status" -eq 0 ] && ! grep -q 'too large' out
result $? "three are not"
echo 0 0 0 | "$krs" query many.krs >out 2>err
status=$?
ended 0 "a question is answered"

run render --size 96x54 -o many.png many.krs
said 0 "lanes of the host march its rays" "a preview is drawn, and by whom it says"
run render --size 96x54 -o lanes.png --rays lanes many.krs
[ "$status" -eq 0 ] && ! grep -q E0401 err && [ -s lanes.png ]
result $? "nothing is said of it with --rays lanes"
run render --quiet --size 96x54 -o many.png many.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "nor with --quiet"
run render --size 96x54 -o few.png few.krs
[ "$status" -eq 0 ] && ! grep -q lanes err
result $? "three parts have shaders"

# The reason has its place in the text.
shaders() { # "what was tested", krs ARGUMENT...
    what=$1
    shift
    run "$@" many.krs
    [ "$status" -eq 1 ] && grep -q '^error\[E0401\]: ' err && grep -q -- '--> many.krs:1:' err
    result $? "$what"
}
shaders "--rays kernels is E0401" render --color never --size 96x54 -o a.png --rays kernels
shaders "so are paths" render --color never --size 96x54 -o a.png --integrator path
shaders "and krs compile" compile --color never -o shaders
shaders "and questions to the device" query --color never --on device
