#!/bin/sh
# info_print.sh: `krs info --print`: text and JSON, units, mass, warnings, and what is refused.
. "$(dirname "$0")/common.sh"
plan 24

echo 'param high = 2 in [1, 3]; let block = box([4, 3, high]); show block; let plate = half_space([0, 0, 1], -5); show plate;' >two.krs
echo 'show box([4, 3, 2]);' >block.krs
echo 'show box([40, 30, 20]) - box([39.4, 29, 19]);' >hollow.krs
echo 'show box([4, 0.5, 3]).rotate([1, 0, 0], 60deg);' >leaning.krs
echo 'show sphere(1);' >ball.krs
echo 'camera { eye: [0, 0, 5] }' >empty.krs

says() { # words of standard output, what was tested
    [ "$status" -eq 0 ] && grep -qF -- "$1" out
    result $? "$2"
}

# json EXPRESSION, of `print` as p
json() {
    python3 -c "import json; p = json.load(open('out'))['print']; assert $1" 2>err
}

run info --print --quiet block.krs --density 1.24
says 'volume       24 mm3, within' 'the volume is told'
says 'size         4 x 3 x 2 mm' 'the size is'
says 'mass         0.02976 g' 'the mass is: 24 mm3 of 1.24 g/cm3'
says 'wall         2 mm, from' 'the thinnest wall is'
says 'lies         up [0, 0, 1]: height 2 mm, base 12 mm2, overhang 0 mm2' 'how it lies is told'

run info --print --quiet block.krs --density 7.85 --units cm --axis y
says 'mass         188.4 g' 'a length of 1 may be a centimetre'
says 'up [0, 1, 0]: height 3 cm, base 8 cm2' 'y may go up'
run info --print --quiet block.krs --density 1 --units in --json
json "abs(p['mass_g'] - 24 * 2.54 ** 3) < 1e-6 and p['units'] == 'in' and abs(p['volume'] - 24) < 1e-9"
result $? 'or an inch'
json "p['wall']['thickness'] == 2 and p['lies']['stands'] and p['orientations'][0]['stands']"
result $? 'JSON has the wall, and the orientations'
json "p['volume_error'] < 1e-9 and p['center_error'] < 1e-9 and p['mass_error_g'] < 1e-6 and p['mesh_error'] > 0"
result $? 'and the errors'

run info --print --json leaning.krs --overhang 45
json "abs(p['lies']['overhang'] - 12) < 1e-9 and not p['lies']['stands']"
result $? 'a plate that leans by 60 degrees hangs over'
run info --print --json leaning.krs --overhang 61
json "p['lies']['overhang'] == 0"
result $? 'but not for who allows 61'
run info --print --quiet leaning.krs
says 'as it lies after .rotate([' 'how it is turned to lie best is told'
turn=$(sed -n 's/.*as it lies after \(.*\)$/\1/p' out)
echo "show box([4, 0.5, 3]).rotate([1, 0, 0], 60deg)$turn;" >turned.krs
run info --print --quiet turned.krs
grep -q 'lies .*overhang 0 mm2' out && ! grep -q 'does not stand' out
result $? 'and turned so it stands, and nothing hangs over'

run info --print hollow.krs --nozzle 0.4
said 0 'a wall of 0.3 mm at [' 'walls that are thinner than the nozzle are warned of'
run info --print hollow.krs --nozzle 0.2
! grep -q warning err
result $? 'walls that are not are no reason to'
run info --print --quiet ball.krs
says 'it stands on none of its flat faces' 'a ball stands nowhere'

run info --print two.krs
said 2 'or by --component one that has: ' 'what has no end is refused'
run info --print --quiet two.krs --component block --set high=1
says 'volume       12 mm3' 'a component is measured alone, at a value of a param'
run info --print --quiet two.krs --within=-2,-2,-9,2,2,9 --error 0.1
says 'size         4 x 4 x 1' 'what is in a box is measured'
run info --print empty.krs
said 1 'there is nothing to measure' 'nothing has no figures'
run info block.krs --density 2
said 2 '--density is for the figures of --print' 'without --print its options have no meaning'
run info --print block.krs --overhang 91
said 2 'an angle from 0.01 to 90 degrees' 'an angle must be one'
run info --print block.krs --nozzle 1e-9
said 2 '--nozzle is too small' 'a nozzle may be too small for the part'
