#!/bin/sh
# mesh_motion.sh: `krs mesh --frames` writes how parts move into GLB.
. "$(dirname "$0")/common.sh"
plan 24

cat >spin.krs <<'SCENE'
show box([2, 0.2, 0.4]).rotate([1, 2, 0], 9 * time).move([3 * sin(time), 0, 0]);
SCENE
cat >orbit.krs <<'SCENE'
show box([0.5, 1, 0.25]).move([5, 0, 0]).rotate([0, 1, 0], 9 * time) | box([1, 1, 0.5]).move([0, 0.25, -0.25]) | box([1, 1, 0.5]).move([0, 0.25, 0.25]);
SCENE
echo 'show box([1, 1, 1]).move([2 * time, 0, 0]);' >ride.krs
echo 'for i in 0..40 { show box([0.2, 0.3, 0.4]).move([i, sin(time + i), 0]); }' >wave.krs
cat >pair.krs <<'SCENE'
show krs {
    kernel box([0.6, 0.3, 0.2]).rotate([0, 0, 1], time).move([2 + sin(time), 0.5, 0]);
    reflect plane([-1, 0, 0], 0);
};
SCENE
cat >twins.krs <<'SCENE'
let arm = box([1, 0.2, 0.2]);
show arm.rotate([0, 0, 1], time) | arm.rotate([0, 0, 1], 2 * time).move([3, 0, 0]);
SCENE
echo 'show box([1, 0.2, 0.2]).move([0.3 * sin(16 * tau * time), 0, 0]);' >shake.krs
# At four frames a second the spin turns by more than half a turn between two.
moves() { # scene, its error, options
    scene=$1 error=$2
    shift 2
    run mesh --quiet "$scene.krs" --error "$error" --fps 4 "$@" -o "$scene.glb"
    if ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
        skip "$scene" "no numpy"
        return
    fi
    [ "$status" -eq 0 ] && /usr/bin/python3 "$root/tests/cli/mesh_motion.py" "$scene" "$scene.glb" "$error" >out 2>>err
    result $? "at all times parts of \`$scene\` are where they belong"
}
moves spin 0.02 --frames 0..12
moves orbit 0.02 --frames 0..12
moves ride 0.02 --frames 0..12
moves wave 0.02 --frames 0..12
moves pair 0.02 --frames 0..12
moves wave 0.02 --frames 0..12 --split components
moves twins 0.02 --frames 0..12
moves shake 0.02 --frames 0..12
cat >paints.krs <<'SCENE'
let wheel = box([1, 0.2, 0.2]).rotate([0, 0, 1], time);
show wheel.paint([1, 0, 0]) | wheel.paint([0, 0, 1]).move([3, 0, 0]);
show union(wheel, wheel.move([0, 3, 0])).paint(if y < 1.5 then [0, 1, 0] else [1, 1, 1]).move([0, 0, 5]);
SCENE
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    run mesh --quiet paints.krs --error 0.02 --fps 4 --frames 0..12 -o paints.glb
    /usr/bin/python3 "$root/tests/cli/mesh_motion.py" paints paints.glb 0.02 >out 2>err
    result $? "a part that is used twice has the color that it is painted with"
else
    skip "a part that is used twice has the color that it is painted with" "no numpy"
fi
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    run mesh --quiet spin.krs --error 0.02 --fps 4 --frames 100..112 -o spin.glb
    /usr/bin/python3 "$root/tests/cli/mesh_motion.py" spin spin.glb 0.02 100 >out 2>err
    result $? "the first frame is the beginning"
else
    skip "the first frame is the beginning" "no numpy"
fi
run mesh ride.krs --fps 4 --frames 0..12 -o ride.glb
[ "$status" -eq 0 ] && grep -q '^krs: 1 part moves, by 13 keyframes$' err
result $? "it is told how many parts move"
# Halves of frames where a chord of 3 sin t is farther off than the error; the rest is told.
cat >swing.krs <<'SCENE'
show box([0.5, 0.3, 0.2]).move([3 * sin(time), 0, 0]);
SCENE
run mesh swing.krs --error 0.02 --fps 4 --frames 0..12 -o swing.glb
awk 'function off(a, b, most, i, s, d) {
         for (i = 1; i < 1000; i++) {
             s = i / 1000
             d = 3 * sin(a + s * (b - a)) - 3 * (1 - s) * sin(a) - 3 * s * sin(b)
             if (d < 0) d = -d
             if (d > most) most = d
         }
         return most
     }
     function visit(a, b, d) {
         keys++
         d = off(a, b)
         if (d > 0.02) { keys--; visit(a, (a + b) / 2); visit((a + b) / 2, b) } else if (d > largest) largest = d
     }
     BEGIN { for (n = 0; n < 12; n++) visit(n / 4, (n + 1) / 4); print keys + 1, largest }' >wanted
sed -n 's/^krs: 1 part moves, by \([0-9]*\) keyframes; between them parts are within \([0-9.]*\) of where they belong$/\1 \2/p' err |
    cat wanted - | awk '{ keys[NR] = $1; most[NR] = $2 } END { exit !(NR == 2 && keys[1] == keys[2] && most[2] > 0.97 * most[1] && most[2] < 1.005 * most[1]) }'
result $? "and how far they are from where they belong between keyframes"
echo 'show box([1, 1, 1]).move([if time < 1.1 then 0 else 2, 0, 0]);' >leap.krs
run mesh leap.krs --error 0.02 --fps 4 --frames 0..12 -o leap.glb
said 0 "keyframes; 1 jump takes a 1024th of a frame" "and how often they jump"
cat >machine.krs <<'SCENE'
let wheel = torus(0.4, 0.12).rotate([0, 1, 0], 3 * time);
let frame = box([2, 0.5, 1]);
let lid = frame.scale(0.25).move([0, 0.5 + 0.1 * sin(time), 0]);
let machine = frame | wheel.move([0.7, -0.3, 0.6]) | wheel.move([-0.7, -0.3, 0.6]) | lid | sphere(0.2).move([sin(time), 2, 0]);
show machine;
show box([1, 1, 1]).move([5 + time, 0, 0]);
SCENE
# Names of a GLB's nodes that have a mesh, in their order.
node_names() {
    tr -d '\0' <"$1" | grep -ao '"nodes":.*"scene"' | grep -o '{[^{}]*"mesh":[^{}]*}' |
        sed 's/.*"name":"\([^"]*\)".*/\1/' | sort | tr '\n' ';'
}
run mesh --quiet machine.krs --frames 0..4 -o machine.glb
[ "$(node_names machine.glb)" = "component 2;frame;frame;machine;wheel;wheel;" ]
result $? "parts have the names of what they are made of, or of their component"
cat >forms.krs <<'SCENE'
let breath = sphere(1 + 0.1 * sin(time));
let grown = sphere(1).scale(1 + 0.1 * sin(time)).move([4, 0, 0]);
let cut = box([1, 1, 1]).move([8, 0, 0]) - sphere(0.5).move([8, sin(time), 0]);
let still = sphere(1).move([12, 0, 0]);
show breath; show grown; show cut; show still;
SCENE
run mesh forms.krs --frames 0..12 -o forms.glb
said 2 "the form or the size of \`breath\`, \`grown\`, \`cut\`;" "what deforms is refused by its name"
[ ! -e forms.glb ]
result $? "and nothing is written"
run mesh forms.krs --frames 0..12 --component still -o forms.glb
said 0 "nothing in \`forms.krs\` moves" "what stands still is told"
echo 'show box([1, 1, 1]).move([time, 0, 0]).paint(mix(red, blue, clamp(time, 0, 1)));' >paint.krs
run mesh paint.krs --frames 0..12 -o paint.glb
[ "$status" -eq 0 ] && grep -qF "the material of \`component 1\`, which stays that of frame 0" err
result $? "and whose material changes"
cat >cut.krs <<'SCENE'
show krs { kernel box([1, 1, 1]).move([3 - time, 0, 0]); reflect plane([-1, 0, 0], 0); };
SCENE
run mesh cut.krs --fps 1 --frames 0..4 -o cut.glb
[ "$status" -ne 0 ] && grep -q 'a mirror cuts what moves' err && [ ! -e cut.glb ]
result $? "what comes into a mirror is refused"
echo 'zone { center: [0, 0, 0], radius: 0.3 } show box([1, 1, 1]).move([time, 0, 0]);' >zone.krs
run mesh zone.krs --frames 0..4 -o zone.glb
[ "$status" -ne 0 ] && grep -q 'cannot be taken apart' err
result $? "and what a zone cuts"
run mesh ride.krs --frames 0..12 -o ride.stl
said 2 "--frames is for .glb" "STL has no motion"
run mesh ride.krs --frames 0..12 --copies flat -o ride.glb
said 2 "must be instances" "nor have flat copies"
run mesh ride.krs --frames 0..12 --lods 2 -o ride.glb
said 2 "parts that move are copies, which have no --lods" "nor levels of detail"
run mesh ride.krs --frames 5..5 -o ride.glb
said 2 "nothing moves in one frame" "one frame is no motion"
