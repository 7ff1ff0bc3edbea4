#!/bin/sh
# query.sh: questions to host and device, zones, and rays that are hard; answers.sh has the forms
# of lines and records.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 36

cat >plane.krs <<'END'
show plane([0, 1, 0], 0);
END
cat >zoned.krs <<'END'
param r = 0.5 in [0, 1];
camera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }
zone { center: [0, 0, 1], radius: r }
let ball = sphere(1);
show ball;
END

ask() { # scene, question, options...
    scene=$1 question=$2
    shift 2
    printf '%s\n' "$question" | "$krs" query "$scene" "$@" >out 2>err
    status=$?
}
# The answer, rounded to 4 digits: so many are left of single precision everywhere.
answer() {
    awk '{ for (i = 1; i <= NF; i++) {
               if ($i ~ /^[-0-9]/) { $i = sprintf("%.4f", $i + 0); sub(/\.?0+$/, "", $i) }
               if ($i == "-0") $i = "0"
               printf "%s%s", $i, (i < NF ? " " : "\n") } }' out
}
answered() { # text, what
    [ "$status" -eq 0 ] && [ "$(answer)" = "$1" ]
    result $? "$2"
}

for on in host device; do
    ask ball.krs '0 2 0' --on $on
    answered '1 0 1 0 1 0 1' "a point, by the $on"
    ask ball.krs '0 0 9 0 0 -2' --on $on
    answered '8 0 0 1 0 0 1 1 0 1' "a ray, by the $on"
    ask ball.krs '0 0 9 0 0 1' --on $on
    answered 'miss' "a miss, by the $on"
    ask ball.krs '0 0 9 0 0 -2
0 0 0.9
0.3 0 9 0 0 -1' --on $on --zone 0,0,1,0.5
    answered '8.5 0 0 0.5 0 0 1 1 0 1
0.4 0 0 1 1 0 1
8.4 0.3 0 0.6 -0.6 0 0.8 1 0 1' "a zone, by the $on"
    ask zoned.krs '0 0 9 0 0 -2' --on $on
    answered '8.5 0 0 0.5 0 0 1 1 0 1' "a zone of the scene, by the $on"
    ask zoned.krs '0 0 9 0 0 -2' --on $on --set r=0.25
    answered '8.25 0 0 0.75 0 0 1 1 0 1' "which a param changes, by the $on"
    ask zoned.krs '0 0 9 0 0 -2' --on $on --zone=-1,0,0,0.1 --zone 0,0,0.5,0.25
    answered '8.75 0 0 0.25 0 0 1 1 0 1' "several zones, by the $on"
    ask ball.krs '0 0 9 0 0 -2' --on $on --farthest 7.9
    answered 'miss' "no farther than asked, by the $on"
    ask plane.krs '0 0.000001 0 1 0 0' --on $on
    [ "$status" -eq 0 ] && grep -q '^unresolved [0-9.e-]*$' out
    result $? "a ray that is given up is told, by the $on"
done

# The double 1e-6 is the bytes 8d ed b5 a0 f7 c6 b0 3e (hexadecimal), 1 is ... f0 3f.
zero='\000\000\000\000\000\000\000\000'
# shellcheck disable=SC2059 # the escapes are meant for printf
printf "$zero"'\215\355\265\240\367\306\260\076'"$zero"'\000\000\000\000\000\000\360\077'"$zero$zero" \
    >record
"$krs" query --binary plane.krs <record >out 2>err
status=$?
[ "$status" -eq 0 ] && [ "$(wc -c <out)" -eq 80 ] &&
    [ "$(od -An -tfD -w80 out | awk '{ print tolower($1), $4, $8 }')" = 'nan 0 0' ]
result $? "a ray that is given up, as a record"

# Answers of the device in several batches, in their order, as of the host within 1e-5.
awk 'BEGIN { for (i = 0; i < 40000; i++) printf i % 2 ? "%g %g 9 0 0 -1\n" : "%g %g 2\n",
             (i % 200 - 100) / 80, (i % 317 - 158) / 120 }' >many
"$krs" query zoned.krs <many >host 2>err
"$krs" query --on device zoned.krs <many >out 2>err
status=$?
[ "$status" -eq 0 ] && paste -d'|' host out | awk -F'|' '
    { split($1, a, " "); split($2, b, " "); d = a[1] - b[1]
      if ((a[1] == "miss") != (b[1] == "miss") || d > 1e-5 || d < -1e-5) wrong++ }
    END { if (wrong > 20) print "# " wrong " differ"; exit wrong > 20 || NR != 40000 }'
result $? "forty thousand questions, alike on host and device"
ask ball.krs '0 0 9 0 0 -2
nonsense
0 0 9 0 0 -2' --on device
[ "$status" -eq 2 ] && grep -q 'line 2 of standard input' err && [ "$(wc -l <out)" -eq 1 ]
result $? "a line that cannot be read, after the device's answers before it"

for zone in 1,2,3 1,2,3,-1 1,2,3,x 1,2,3,4,5 nan,0,0,1 0,0,0,1e30; do
    run query --zone "$zone" ball.krs
    said 2 "--zone wants X,Y,Z,RADIUS" "the zone $zone"
done
# shellcheck disable=SC2046 # seventeen words
run query $(awk 'BEGIN { for (i = 0; i < 17; i++) print "--zone=0,0,0,1" }') ball.krs
said 2 "at most 16 zones" "seventeen zones"
run query --device cpu ball.krs
said 2 "--on device" "a device that is not asked"
run query --on moon ball.krs
said 2 "host or device" "somebody else"

compile_exr exr_text
sed '/^zone/d' zoned.krs >bare.krs
run render bare.krs --rays kernels --zone 0,0,1,0.5 --size 40x30 -o by_option.exr
run render zoned.krs --rays kernels --size 40x30 -o by_scene.exr
run render bare.krs --rays kernels --size 40x30 -o whole.exr
for picture in by_option by_scene whole; do
    ./exr_text $picture.exr >$picture.txt
done
cmp -s by_option.txt by_scene.txt && ! cmp -s by_option.txt whole.txt
result $? "a picture with a zone"
grep -qa 'krs:zones' by_option.exr && ! grep -qa 'krs:zones' whole.exr
result $? "says so"
run info zoned.krs
[ "$status" -eq 0 ] && grep -q '^zones 1$' out
result $? "info tells the zones"
run info --json zoned.krs
[ "$status" -eq 0 ] && is_json <out && grep -q '"zones": 1' out
result $? "also as JSON"
run validate --points 2000 --zone 0.5,0,0,0.6 zoned.krs
[ "$status" -eq 0 ] && grep -q 'balls are empty; .* agrees' out
result $? "distances with zones are not refuted"

if command -v script >/dev/null; then
    (echo 0 2 0 && sleep 1) | script -qec "'$krs' query plane.krs" out >/dev/null 2>err
    grep -q 'is a point, .* a ray' out && grep -q '^2 0 1 0' out
    result $? "at a terminal it says what it waits for"
else
    skip "at a terminal it says what it waits for" "no script"
fi
