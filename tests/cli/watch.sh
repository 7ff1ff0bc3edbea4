#!/bin/sh
# watch.sh: `krs watch` renders what `krs render` would, whenever the scene is saved.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 22
export XDG_CACHE_HOME="$work/caches"
: >out

scene() { # radius
    printf 'use "far.krs";\ncamera { eye: [0, 0, far], target: [0, 0, 0] }\n'
    printf 'light { direction: [-0.5, 1, 0.6], intensity: 2.5 }\nshow sphere(%s);\n' "$1"
}
# Waits until the watcher has said something so many times.
heard() { # words, times
    for _ in $(seq 600); do
        [ "$(grep -cF -- "$1" err)" -ge "$2" ] && return 0
        kill -0 "$watcher" 2>/dev/null || return 1
        sleep 0.05
    done
    return 1
}
# Waits for the next picture, which must be that of a render, bit for bit.
shows() { # what was tested
    pictures=$((pictures + 1))
    heard "wrote \`a.png\`" "$pictures" &&
        "$krs" render scene.krs --size 24x16 --specialize "${how:-structure}" -q -o b.png 2>/dev/null &&
        cmp -s a.png b.png
    result $? "$1"
}

run watch -
said 2 "standard input has one text" "a text that cannot change"
run watch ball.krs -o -
said 2 "standard output has room for one picture" "pictures one after the other on standard output"
run watch nowhere.krs
said 74 "cannot read \`nowhere.krs\`" "no scene"
run watch ball.krs --camera sied -o a.png
said 2 "did you mean \`side\`?" "an option that no edit will mend"

pictures=0
echo 'let far = 5;' >far.krs
scene 1 >scene.krs
: >err
"$krs" watch scene.krs --size 24x16 -o a.png >out 2>err &
watcher=$!
how=numbers shows "the first picture"
scene 1.25 >scene.krs
shows "a number is edited"
scene 1.5 >new.krs && mv new.krs scene.krs
shows "an editor replaces the file"
echo 'let far = 6;' >far.krs
shows "a file that it uses is edited"
# A mistake, in every second of a hundred edits.
same=0
for i in $(seq 50); do
    echo 'show spere(1);' >scene.krs
    heard "a name that is similar exists: \`sphere\`" "$i" || break
    scene "1.$i" >scene.krs
    pictures=$((pictures + 1))
    heard "wrote \`a.png\`" "$pictures" || break
    "$krs" render scene.krs --size 24x16 --specialize structure -q -o b.png && cmp -s a.png b.png &&
        same=$((same + 1))
done
[ "$same" -eq 50 ]
result $? "a hundred edits, each second one with a mistake"
cp a.png before.png
rm scene.krs
heard "cannot be read: No such file" 1 && cmp -s a.png before.png
result $? "the scene is removed, and its last picture stays"
scene 0.9 >scene.krs
shows "it is there again"
mkdir parts
printf 'use "parts/more.krs";\n' >more.krs && scene 0.9 >>more.krs && mv more.krs scene.krs
heard "cannot read \`parts/more.krs\`" 1
result $? "a file that is used and missing"
echo 'show box(1);' >parts/more.krs
shows "that file is made"
scene '0.5).move([0.1, 0, 0]' >scene.krs
shows "an edit that changes the structure"
# What is saved while a picture is made counts at once.
scene 1.1 >scene.krs
heard "wrote \`a.png\`" $((pictures + 1))
scene 1.2 >scene.krs
pictures=$((pictures + 1))
shows "two edits, one after the other"
no_temporaries
result $? "nothing is left over"
kill -TERM "$watcher"
wait "$watcher"
status=$?
ended 0 "to be asked to end is how it ends"
# More pictures follow a small one, so it has the kernels of large ones: beams before roots have their own.
echo 'show algebraic(x^4 + y^4 + z^4 == 1);' >scene.krs
: >out
"$krs" watch scene.krs --size 24x16 --stats json -o a.png >out 2>err &
watcher=$!
for _ in $(seq 600); do
    grep -q '"kernels"' out && break
    sleep 0.05
done
[ "$(grep -o '"trace.comp"' out | wc -l)" -eq 2 ]
result $? "small pictures have the kernels of large ones"
kill -TERM "$watcher"
wait "$watcher"
# Both together: options go where they belong.
scene 0.7 >scene.krs
: >err
"$krs" watch scene.krs --size 24x16 --error 0.02 -o a.png -o a.obj >out 2>err &
watcher=$!
pictures=0
how=numbers shows "a picture beside a mesh"
heard "wrote \`a.obj\`" 1 && "$krs" mesh scene.krs -q --error 0.02 -o b.obj && cmp -s a.obj b.obj
result $? "the mesh beside it"
scene 0.8 >scene.krs
shows "the next picture"
heard "wrote \`a.obj\`" 2 && "$krs" mesh scene.krs -q --error 0.02 -o b.obj && cmp -s a.obj b.obj
result $? "the next mesh"
kill -TERM "$watcher"
wait "$watcher"
