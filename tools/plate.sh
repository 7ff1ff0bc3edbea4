#!/bin/sh
# plate.sh BUILD [SAMPLES [FOLDER]]: renders a plate, puts a scene into it, and leaves both pictures in
# docs/pictures/, or in that folder.  ImageMagick makes them small, as in pictures.sh.
build=$1 samples=${2:-512} folder=${3:-docs/pictures}
cd "$(dirname "$0")/.." || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
render() { # scene, name, options
    scene=examples/plate/$1.krs name=$2
    shift 2
    "$build/krs" render "$scene" --quiet --size 640x360 --samples "$samples" --clamp-radiance 4 "$@" \
        -o "$work/$name.exr" -o "$work/$name.png" &&
        convert "$work/$name.png" -strip -ordered-dither o8x8,64 "$folder/$name.png" &&
        echo "$folder/$name.png"
}
render room plate &&
    render things composed --depth-in "$work/plate.exr" --plate "$work/plate.exr" \
        --catcher glossy --catcher-roughness 0.15
