#!/bin/sh
# info_cost.sh: `krs info --cost`: the heavy part comes first, with its line; shares are the whole frame; what parts
# add is what a scene without them has less.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
export XDG_CACHE_HOME="$work/caches"
plan 12

# A knot of forty tori is far heavier than all else, and two thirds of the picture.
cat >scene.krs <<'END'
camera { eye: [0, 1, 7], target: [0, 0, 0], fov: 40deg }
light { direction: [1, 2, 3] }
let ball = sphere(0.3).move([-2, 0.8, 0]);
let knot = union([
    torus(0.9 + 0.01 * i, 0.02 + 0.001 * i^2).rotate([sin(9 * i), cos(5 * i), 1], 40deg * i).twist([0, 1, 0], 10deg)
    for i in 0..40]);
let thing = union([
    box([0.3, 0.3, 0.3]).move([2, -0.8, 0]),
    knot,
    ball,
]);
show thing;
show plane([0, 1, 0], -1.2);
END
# json EXPRESSION, of `cost` as c
json() {
    python3 -c "import json; c = json.load(open('out'))['cost']; p = c['parts']; assert $1" 2>err
}

run info --cost --json scene.krs --size 160x90 --seconds 60 --quiet
ended 0 'parts are timed'
json "'knot' == p[0]['name'] or p[0]['line'] == 5"
result $? 'the heavy part comes first'
json "p[0]['line'] in (4, 5) and p[0]['source'].endswith('scene.krs') and p[0]['share'] > 0.4"
result $? 'with its line'
json "sum(r['flops'] for r in p if r['line'] in (4, 5)) > 10 * sum(r['flops'] for r in p if r['line'] in (3, 8, 11))"
result $? 'and ten times the operations of the light ones'
json "abs(sum(r['share'] for r in p) + c['others']['share'] - 1) < 1e-9 and all(r['ms'] >= 0.02 * c['frame_ms'] for r in p)"
result $? 'shares are the whole frame; the least is 2 %'
json "c['width'] == 160 and c['height'] == 90 and c['frame_ms'] > 0 and c['untimed'] == 0 and c['device']"
result $? 'the frame is told'
cp out whole.json

# The same without the part, by hand.
sed '/^let knot/,/for i in 0..40/d; s/^    knot,$//' scene.krs >without.krs
run info --json without.krs
python3 -c "
import json
cost = json.load(open('whole.json'))['cost']
by_hand = json.load(open('out'))
added = sum(r['flops'] for r in cost['parts'] if r['line'] in (4, 5))
assert abs(cost['flops'] - added - by_hand['flops_per_evaluation']) < 0.01 * cost['flops'], (cost['flops'], added, by_hand['flops_per_evaluation'])
" 2>err
result $? 'what a part adds at a point is what a scene without it has less'

run info --cost scene.krs --size 160x90 --seconds 0
[ "$status" -eq 0 ] && grep -q '^frame .* ms.* at 160x90 on ' out && grep -q 'others: light, background' out
result $? 'text tells the same'
grep -q 'were not timed in 0 s' err
result $? 'and how many parts there was no time for'

run info --cost --print scene.krs
said 2 '--print and --cost are two questions' 'one question at a time'
run info scene.krs --seconds 3
said 2 '--seconds is for the times of --cost' 'without --cost its options have no meaning'
run info --cost scene.krs --camera sied
said 2 "has no camera \`sied\`" 'a camera that the scene has not'
