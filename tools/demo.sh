#!/bin/sh
# demo.sh BUILD: renders the examples to BUILD/demo/, EXR and PNG.
build=$1
mkdir -p "$build/demo" || exit 1
for scene in examples/*.krs; do
    name=$(basename "$scene" .krs)
    echo "render $scene -> $build/demo/$name.exr, $build/demo/$name.png"
    "$build/krs" render "$scene" --quiet -o "$build/demo/$name.exr" -o "$build/demo/$name.png" ||
        exit 1
done
echo "the pictures are in $build/demo/"
