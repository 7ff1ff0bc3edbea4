#!/bin/sh
# watch_mesh.sh: `krs watch` writes the mesh that `krs mesh` would, whenever the scene is saved.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 21
: >out

# A block with a bore, in a colour.
scene() { # radius of the bore, colour
    printf 'use "far.krs";\nshow difference(box([2, 1, 1]).round(0.1), cylinder(%s, 4)).paint(%s);\n' "$1" "$2"
    printf 'camera { eye: [0, 0, far], target: [0, 0, 0] }\n'
}
# Waits until the watcher has said something so many times.
heard() { # words, times
    for _ in $(seq 1200); do
        [ "$(grep -cF -- "$1" err)" -ge "$2" ] && return 0
        kill -0 "$watcher" 2>/dev/null || return 1
        sleep 0.05
    done
    return 1
}
watch() { # options
    written=0 kept=0
    : >err
    "$krs" watch scene.krs "$@" >out 2>err &
    watcher=$!
}
# Waits for the next mesh, which must be that of `krs mesh`, bit for bit.
writes() { # what was tested, file, options
    what=$1 file=$2
    shift 2
    written=$((written + 1))
    heard "wrote \`$file\`" "$written" && "$krs" mesh scene.krs -q "$@" -o "expected.${file##*.}" &&
        cmp -s "$file" "expected.${file##*.}"
    result $? "$what"
}
# Waits until the watcher has found that a file is as it was, which must be the very file.
keeps() { # what was tested, file
    kept=$((kept + 1))
    heard "nothing of \`$2\` has changed" "$kept" && [ "$(stat -c %i "$2")" = "$node" ]
    result $? "$1"
}
ends() { # what was tested
    kill -TERM "$watcher"
    wait "$watcher"
    status=$?
    [ "$status" -eq 0 ] && no_temporaries
    result $? "$1"
}

run watch ball.krs -o ball.png --draft
said 2 "--draft is of meshes, and none is written" "an option of meshes for a picture"
run watch ball.krs -o ball.stl --samples 4
said 2 "--samples is of pictures, and none is written" "an option of pictures for a mesh"
run watch ball.krs -o ball.stl --size 8x8
said 2 "--size wants a length" "a size of pictures for a mesh"
run watch ball.krs -o ball.stl --component bal
said 2 "the scene has no component \`bal\`" "a component that no edit will make"

echo 'let far = 5;' >far.krs
scene 0.3 tomato >scene.krs
watch -o a.stl --error 0.05 --size 10
writes "the first mesh" a.stl --error 0.05 --size 10
scene 0.35 tomato >new.krs && mv new.krs scene.krs
writes "an edit of the solid" a.stl --error 0.05 --size 10
node=$(stat -c %i a.stl)
scene 0.35 '#808080' >scene.krs
keeps "a colour, in a file without colours" a.stl
echo 'let far = 6;' >far.krs
keeps "a camera, in a file that is used" a.stl
echo 'show spere(1);' >scene.krs
heard "a name that is similar exists: \`sphere\`" 1 && [ "$(stat -c %i a.stl)" = "$node" ]
result $? "a mistake"
echo 'show plane([0, 1, 0], 0);' >scene.krs
heard "has no end; say which box is wanted" 1 && [ "$(stat -c %i a.stl)" = "$node" ]
result $? "what has no mesh"
scene 0.35 '#808080' >scene.krs
writes "the same solid after it" a.stl --error 0.05 --size 10
rm a.stl
echo '// more' >>scene.krs
writes "a file that is gone is written, also where nothing else has changed" a.stl --error 0.05 --size 10
ends "to be asked to end is how it ends"

scene 0.3 tomato >scene.krs
watch -o a.ply --error 0.1 --draft
writes "a draft with colours" a.ply --error 0.1 --draft
scene 0.3 '#808080' >scene.krs
writes "a colour, in a file with colours" a.ply --error 0.1 --draft
node=$(stat -c %i a.ply)
echo '// a comment' >>scene.krs
keeps "a comment" a.ply
ends "to be asked to end"

echo 'show sphere(1).displace(sin(9 * x + y) * cos(7 * y) * sin(8 * z), amplitude: 0.1);' >scene.krs
echo before >slow.stl
watch -o slow.stl --error 0.0003
heard "Progress" 1
sleep 1
kill -0 "$watcher" && grep -qx before slow.stl
result $? "a mesh that is being made leaves the file"
echo 'show box([1, 2, 3]);' >scene.krs
writes "an edit ends a mesh that takes very long" slow.stl --error 0.0003
[ "$(grep -c triangles err)" -eq 1 ]
result $? "it was not made to its end"
ends "to be asked to end, once more"
