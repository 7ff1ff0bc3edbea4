#!/bin/sh
# specialize.sh: --specialize auto has literals at first, and from the first edit on compiles
# nothing for further ones.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 11
export XDG_CACHE_HOME="$work/caches"

# The scene; the radius of its sphere is what is edited.
scene() { # radius, what is behind the sphere
    printf '// A scene.\ncamera { eye: [0, 0, %s], target: [0, 0, 0] }\n' "${eye:-5}"
    printf 'light { direction: [-0.5, 1, 0.6], intensity: 2.5, softness: 1deg }\n'
    printf 'show sphere(%s)%s;\n' "$1" "${2:-}"
}
picture() { # how, the output, options
    how=$1 file=$2
    shift 2
    run render scene.krs --rays kernels --size 24x16 --quiet --stats json --specialize "$how" -o "$file" "$@"
}
compiled() { [ "$status" -eq 0 ] && [ ! -s err ] && grep -q '"cached": false' out; }
compiled_nothing() { [ "$status" -eq 0 ] && [ ! -s err ] && ! grep -q '"cached": false' out; }
# Whether a.exr is by shaders of this kind: then that compiles nothing, and its picture is the same.
is_by() { # how, options
    how=$1
    shift
    picture "$how" same.exr "$@"
    compiled_nothing && cmp -s a.exr same.exr
}
remembered() { find "$XDG_CACHE_HOME/krs" -name '*.structure' -exec cat {} +; }

scene 1.25 >scene.krs
picture auto a.exr
compiled && is_by numbers
result $? "a scene that is new has literals"
picture auto a.exr
compiled_nothing && is_by numbers
result $? "rendered again it has the same, and compiles nothing"
remembered >before
eye=6 scene 1.25 | sed 's/A scene/The scene/' >scene.krs
picture auto a.exr
remembered >after
compiled_nothing && is_by numbers && [ -s before ] && cmp -s before after
result $? "another camera or comment is no edit"

scene 1.5 >scene.krs
picture auto a.exr
compiled && is_by structure
result $? "an edited scene has its numbers apart"
scene 1.75 >scene.krs
picture auto b.exr
compiled_nothing && ! cmp -s a.exr b.exr
result $? "the next edit compiles nothing, and is another picture"
scene 1.25 >scene.krs
picture auto a.exr
compiled_nothing && is_by structure
result $? "nor does the edit back"

# The size of kernels tells how they were made.
sizes() { grep -o '"name": "[^"]*", "glsl_bytes": [0-9]*' out; }
sizes >apart
picture numbers b.exr
sizes >literal
picture auto b.exr --cache off
compiled && ! cmp -s apart literal && sizes | cmp -s - literal
result $? "without a cache also an edited scene has literals"

# More samples than 16 of 640x360 repay literals.
eye=50 scene 1.25 >scene.krs
picture auto a.png --size 640x361 --samples 16
sizes | cmp -s - literal && compiled_nothing
result $? "many samples have literals, also of an edited scene"
picture auto a.png --size 640x361 --samples 16 --crop 0,0,8,8
sizes | cmp -s - apart && compiled_nothing
result $? "samples count where there are pixels"

printf 'let x = 1;\nshow sphere(x);\n' >scene.krs
run render scene.krs --rays kernels --size 8x8 --specialize auto -o a.exr
[ "$status" -eq 0 ] && [ "$(grep -c W0201 err)" -eq 1 ] && grep -qx '1 warning' err
result $? "what is odd in a scene is said once"
printf 'show sphere(2 *);\n' >scene.krs
run render scene.krs --rays kernels --size 8x8 --specialize auto -o a.exr
[ "$status" -eq 1 ] && [ "$(grep -c '^error' err)" -eq 1 ] && grep -qx '1 error' err
result $? "so is what is wrong"
