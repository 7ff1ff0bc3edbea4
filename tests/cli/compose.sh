#!/bin/sh
# compose.sh: what is rendered in front of another renderer's picture.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 14
compile_exr exr_text
view='camera { eye: [0, 1.2, 6], target: [0, 0.5, 0], fov: 40deg }
image { size: [64, 36] }
light sun { direction: [-1, 2, 1], intensity: 3, shadow: false }'
back='show plane([0, 1, 0], 0); show sphere(0.6).move([0.5, 0.6, 0]).paint(tomato);'
front='show sphere(0.6).move([-0.2 + 0.1 * time, 0.6, -0.2]).paint(steelblue);'
echo "$view $back" >back.krs
echo "$view $front" >front.krs
echo "$view $back $front" >both.krs
render() { scene=$1; shift; run render "$scene.krs" --quiet --occlusion off "$@"; }
# Whether pixels of a channel are the same in two files, but for this many.
same() { # channel, a, b, pixels
    ./exr_text "$2" "$1" >a.txt
    ./exr_text "$3" "$1" | paste -d' ' a.txt - | awk -v most="$4" '
        { off = $4 - $8; off = off < 0 ? -off : off; n += $4 != $8 && off > 1e-3 + 1e-3 * $4 }
        END { exit NR != 64 * 36 || n > most }'
}

render back -o back.exr
render both -o both.exr
render front --depth-in back.exr --plate back.exr -o one.exr -o one.png
ended 0 "a picture in front of another"
same Z both.exr one.exr 0 && same A both.exr one.exr 0
result $? "what is nearer is seen, and depth goes out"
same R both.exr one.exr 8 && same B both.exr one.exr 8
result $? "without shadows the picture is as if all were one scene, but for outlines"
render front --depth-in back.exr -o alone.exr
[ "$(./exr_text alone.exr id.component | awk '$4 > 0' | wc -l)" = \
    "$(./exr_text one.exr id.component | awk '$4 > 0' | wc -l)" ]
result $? "without a plate the rays end as well"
# A light with shadows, on a floor alone, which mirrors nothing as no plate does.
dark=$(echo "$view" | sed 's/, shadow: false//; s/-1, 2, 1/-2, 2, -1/')
dull='material dull { color: #808080, roughness: 1, specular: 0 }'
floor='show plane([0, 1, 0], 0).paint(dull);'
ball='show sphere(0.6).move([-0.1, 0.6, -0.2]).paint(dull);'
echo "$dark $dull $floor" >floor.krs
echo "$dark $dull $ball" >front-dark.krs
echo "$dark $dull $floor $ball" >both-dark.krs
render floor -o floor.exr
render both-dark -o both-dark.exr
render front-dark --depth-in floor.exr --plate floor.exr -o dark.exr
same R both-dark.exr dark.exr 4 && ! same R floor.exr dark.exr 85
result $? "shadows fall on the plate where they would fall on the floor"
./exr_text dark.exr caught.R | awk '$4 < 0.5 { dark++ } $4 == 1 { lit++ } END { exit !(dark > 15 && lit > 1500) }' &&
    render front-dark --depth-in floor.exr --plate floor.exr --catcher none -o lit.exr &&
    [ -z "$(./exr_text lit.exr caught.R)" ] && same R floor.exr lit.exr 80
result $? "and the factors are channels, unless nothing is to fall on it"
render front-dark --depth-in floor.exr --plate floor.exr --catcher glossy -o a.exr
said 2 "a plate is glossy with the integrators direct and path" "what a preview does not find"
render front-dark --depth-in floor.exr --plate floor.exr --catcher glossy --catcher-reflectance 0.5 \
    --integrator path --samples 4 -o glossy.exr
./exr_text glossy.exr mirrored.R | awk '$4 < -0.01 || $4 > 0.01 { some++ } END { exit !(some > 15) }' &&
    [ -z "$(./exr_text dark.exr mirrored.R)" ]
result $? "what a glossy plate mirrors is in channels"
for frame in 1 2; do
    render back --time $frame -o back-$frame.exr
done
render front --frames 1..2 --fps 1 --depth-in back-%d.exr --plate back-%d.exr -o front-%d.exr
render both --time 2 -o both.exr
same Z both.exr front-2.exr 0
result $? "each frame has its own"
render front --size 65x36 --depth-in back.exr -o a.exr
said 2 "\`back.exr\` has 64x36 pixels, and the picture 65x36: give --size" "a picture of another size"
render front --depth-in nowhere.exr -o a.exr
said 74 "cannot read \`nowhere.exr\`" "a file that is not there"
render front --depth-in front.krs -o a.exr
said 74 "cannot read \`front.krs\`" "a file that is none"
render back --aov none -o flat.exr
render front --depth-in flat.exr -o a.exr
said 74 "cannot use \`flat.exr\`: it has no channel Z" "a picture without depths"
render front --stereo over-under --plate back.exr -o a.exr
said 2 "are of one picture; --stereo has two" "a plate for two eyes"
