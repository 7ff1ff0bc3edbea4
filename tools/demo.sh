#!/bin/sh
# demo.sh BUILD: renders the examples to BUILD/demo/, EXR and PNG, and makes meshes of a gear, a bearing block,
# a bracket filled with a gyroid lattice, and a bonsai.  Pictures by paths of light take minutes: who looks on
# sees how far they are.
build=$1
quiet=--quiet
[ -t 2 ] && quiet=
mkdir -p "$build/demo" || exit 1
for scene in examples/*.krs; do
    name=$(basename "$scene" .krs)
    echo "render $scene -> $build/demo/$name.exr, $build/demo/$name.png"
    "$build/krs" render "$scene" $quiet -o "$build/demo/$name.exr" -o "$build/demo/$name.png" ||
        exit 1
done
mesh() { # example, name, options
    scene=examples/$1.krs name=$2
    shift 2
    echo "mesh $scene -> $build/demo/$name.stl, $build/demo/$name.glb"
    "$build/krs" mesh "$scene" $quiet "$@" -o "$build/demo/$name.stl" -o "$build/demo/$name.glb" ||
        exit 1
}
mesh 02-gear gear --component "component 1"
mesh 03-machined-part bearing-block --within=-3,0.05,-3,3,3,3 --error 0.1
mesh 22-lattice lattice --component "component 1" --set wall=0.04 --set cell=0.9 --error 0.08
mesh 39-bonsai bonsai --component "component 1" --error 0.05
echo "the pictures and meshes are in $build/demo/"
