#!/bin/sh
# answers.sh: what query, info, devices, dump, explain and validate answer.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 43

ask() { # question, options...
    question=$1
    shift
    printf '%s' "$question" | "$krs" query ball.krs "$@" >out 2>err
    status=$?
}
# The answer, rounded to 6 digits so that the last bits do not matter.
answer() {
    awk '{ for (i = 1; i <= NF; i++) printf "%s%s", ($i ~ /^[-0-9]/ ? sprintf("%.6g", $i + 0) : $i),
           (i < NF ? " " : "\n") }' out
}
answered() { # text, what
    [ "$status" -eq 0 ] && [ "$(answer)" = "$1" ]
    result $? "$2"
}

ask '0 2 0
'
answered '1 0 1 0 1 0 1' "a point"
ask '0 0 0.25'
answered '-0.75 0 0 1 1 0 1' "a point inside, without a newline"
ask '0 0 9 0 0 -2
'
answered '8 0 0 1 0 0 1 1 0 1' "a ray; t is in world units"
ask '0 0 9 0 0 1
'
answered 'miss' "a ray that misses"
ask '0 0 9 0 0 -1e300
0 0 9 0 0 -1e-300
'
answered '8 0 0 1 0 0 1 1 0 1
8 0 0 1 0 0 1 1 0 1' "directions whose squares are not numbers"
ask '0 2 0

 0	0 9  0 0 -1
0 3 0
'
answered '1 0 1 0 1 0 1
8 0 0 1 0 0 1 1 0 1
2 0 1 0 1 0 1' "points and rays mixed, in their order"
ask '0 2 0
' --set radius=0.5
answered '1.5 0 1 0 1 0 1' "a param is set"
ask ''
[ "$status" -eq 0 ] && [ ! -s out ]
result $? "no question"
ask '0 2 0
0 1
0 3 0
'
[ "$status" -eq 2 ] && grep -q 'line 2 of standard input' err && [ "$(answer)" = '1 0 1 0 1 0 1' ]
result $? "a line that cannot be read, after the answers before it"
for line in '1 2 3 4' '1 2 three' '1 2 3x' '1 2 nan' '1 2 3 0 0 0' '1 2 3 4 5 6 7'; do
    ask "$line"
    said 2 "line 1 of standard input" "the line $line"
done
awk 'BEGIN { for (i = 0; i < 20000; i++) print 0, 2 + i, 0 }' >many
"$krs" query ball.krs <many >out 2>err
status=$?
[ "$status" -eq 0 ] && awk '{ if (sprintf("%.6g", $1) != sprintf("%.6g", NR)) wrong = 1 }
                            END { exit wrong || NR != 20000 }' out
result $? "twenty thousand points"
echo '0 2 0' | "$krs" query ball.krs >/dev/full 2>err
status=$?
[ "$status" -eq 74 ] && [ "$(grep -c 'error while writing standard output' err)" -eq 1 ]
result $? "answers that cannot be written are complained of once"

# The double 2 is the bytes 0 0 0 0 0 0 0 40 (hexadecimal), -1 is ... f0 bf, 9 is ... 22 40.
zero='\000\000\000\000\000\000\000\000'
two='\000\000\000\000\000\000\000\100'
nine='\000\000\000\000\000\000\042\100'
minus='\000\000\000\000\000\000\360\277'
# shellcheck disable=SC2059 # the escapes are meant for printf
printf "$zero$two$zero$zero$zero$zero$zero$zero$nine$zero$zero$minus" >records
"$krs" query --binary ball.krs <records >out 2>err
status=$?
[ "$status" -eq 0 ] && [ "$(wc -c <out)" -eq 160 ] &&
    [ "$(od -An -tfD -w80 out | awk '{ printf "%.6g %.6g %.6g;", $1, $4, $8 }')" = '1 0 1;8 1 1;' ]
result $? "binary questions and answers"
head -c 50 records | "$krs" query --binary ball.krs >out 2>err
status=$?
said 2 "record 2 of standard input" "a record that is cut off"

run info ball.krs
[ "$status" -eq 0 ] && grep -q 'ball' out && grep -q '^param radius = 1 in \[0.5, 1.5\]$' out
result $? "info as text"
grep -q 'distances, by shape' out &&
    grep -q '  sphere  ball.krs:[0-9]*:[0-9]*  exact, by claim; box ' out
result $? "info has the rule of every shape's distance"
run info --json ball.krs
[ "$status" -eq 0 ] && is_json <out && grep -q '"slope": ' out &&
    grep -q '"flops_per_evaluation": ' out && grep -q '"rule": "exact, by claim"' out
result $? "info as JSON"
# Parts that are alike but for numbers, and components of a loop.
cat >many.krs <<'EOS'
let ball = sphere(1);
show ball;
for i in 0..80 { show sphere(0.1).move([2 + 0.3 * i, 0, 0]); }
show union([box([0.1, 0.2, 0.3 + 0.01 * i]).move([2 + 0.3 * i, 2, 0]) for i in 0..90]);
EOS
run info many.krs
[ "$status" -eq 0 ] && grep -q '^tables: 2 kinds, 170 rows, [1-9][0-9]* kB$' out
result $? "info counts the kinds of parts that are alike, and their rows"
grep -q '^component 51$' out && ! grep -q '^component 52$' out &&
    grep -q '^components 52 to 81: 30 more that are alike$' out && grep -q '^component 82$' out
result $? "of a loop info shows the first 50 components"
run info --json many.krs
[ "$status" -eq 0 ] && is_json <out && grep -q '"tables": {"kinds": 2, "rows": 170, "bytes": ' out &&
    grep -q '"name": "component 81"' out
result $? "its JSON has the tables and all components"
# Slopes that are found for each frame: who has them, in which slot, and what is a frame without.
cat >wave.krs <<'EOS'
param k = 1;
let sea = field(y - 0.1 * sin(k * x / (2 - time)));
show sea;
EOS
run info wave.krs
[ "$status" -eq 0 ] && grep -q 'derived for each frame by norms over all space' out &&
    grep -q '^slope of each frame: slot 2, of wave.krs:2:11$' out
result $? "info says what is derived for each frame"
slopes='"frame_slopes": [{"slot": 2, "place": "wave.krs:2:11", "low": [null, null, null],'
run info --json wave.krs
[ "$status" -eq 0 ] && is_json <out && grep -qF "$slopes" out && grep -q '"per_frame": true' out
result $? "and so does its JSON"
run compile wave.krs -o compiled
[ "$status" -eq 0 ] && is_json <compiled/wave.json && grep -qF "$slopes" compiled/wave.json &&
    grep -q '"parameter_slots": 3, "value_slots": 1' compiled/wave.json &&
    grep -q 'krs_parameter\[2\].x' compiled/wave.glsl
result $? "compile says in which slot of the GLSL it is"
[ "$(grep -c '^[^/]*krs_distance_lod(vec3 p, float footprint)' compiled/wave.glsl)" -eq 2 ] &&
    ! grep -q '#\|krs_parameter\[3\]\.' compiled/wave.glsl
result $? "the GLSL has no directives, and asks for no more slots than that"
run compile --frame-values on --early-outs off wave.krs -o compiled
[ "$status" -eq 0 ] && grep -q 'krs_slot3 = krs_parameter\[3\];' compiled/wave.glsl &&
    grep -q 'vec4 krs_parameter\[4\]' compiled/wave.glsl &&
    ! grep -q 'krs_distance_lod' compiled/wave.glsl
result $? "values of the frame are read from further slots where that is asked for"
run compile --language essl wave.krs -o for-web
[ "$status" -eq 0 ] && [ "$(echo for-web/*)" = "for-web/wave.essl for-web/wave.json" ] &&
    grep -q '^layout(std140) uniform KrsParameters' for-web/wave.essl && ! grep -q 'set =\|precise\|\[\[' for-web/wave.essl
result $? "compile --language essl writes the text of WebGL2, and no SPIR-V"
run compile --language wgsl wave.krs -o for-webgpu
[ "$status" -eq 0 ] && [ "$(echo for-webgpu/*)" = "for-webgpu/wave.json for-webgpu/wave.wgsl" ] &&
    grep -q '^@group(0) @binding(0) var<uniform> krs_parameter: array<vec4f, 3>;' for-webgpu/wave.wgsl && ! grep -q 'float\|vec3(' for-webgpu/wave.wgsl
result $? "compile --language wgsl writes the text of WebGPU"
run query --time 2 wave.krs
said 2 "at time 2 the slope of the expression at wave.krs:2:11 has no bound" "a frame without one"
run query --set k=1e38 wave.krs
said 2 "param \`k\` the slope of the expression at wave.krs:2:11 has no bound" "a value without one"
run devices --json
[ "$status" -eq 0 ] && is_json <out && grep -q '"preferred": true' out
result $? "devices as JSON"

empty=""
passes=$(sed -n 's/^PASS( *\([a-z]*\),.*/\1/p; s/^PASS_TO("\([a-z]*\)", *\([a-z]*\),.*/\1 \2/p' \
    "$root/compiler/passes/passes.def")
for pass in tokens syntax scene graph simplify glsl spirv $passes; do
    run dump --after="$pass" ball.krs
    [ "$status" -eq 0 ] && [ -s out ] || empty="$empty $pass"
done
[ -n "$passes" ] && [ -z "$empty" ]
result $? "every pass can be dumped, by both of its names$empty"
run dump --after=graphs ball.krs
words=$(echo "$passes" | tr ' ' '\n' | awk '{ printf "%s%s", separator, $1; separator = ", " }')
said 2 "--after wants $words or spirv, not \`graphs\`" "an unknown pass is told which there are"
run dump --help
missing=$(echo "$passes" | while read -r form pass; do
    grep -q "^    ${pass:-$form}  *\($form \)*  *[a-z]" out || echo " $form"
done)
[ "$status" -eq 0 ] && [ -z "$missing" ]
result $? "the page of dump has all passes$missing"
run explain E0101
[ "$status" -eq 0 ] && grep -q '^error\[E0101\]: ' out
result $? "a diagnostic is explained"
cp out upper
run explain e0101
[ "$status" -eq 0 ] && cmp -s upper out
result $? "a code in small letters, too"
run explain
[ "$status" -eq 0 ] && [ "$(grep -c '^[EWN][0-9][0-9][0-9][0-9]  ' out)" -eq "$(wc -l <out)" ]
result $? "all diagnostics are listed"
run validate --points 4000 ball.krs
[ "$status" -eq 0 ] && grep -q 'balls are empty; .* agrees' out &&
    grep -q 'no slope above [01.9]* of 1$' out
result $? "a true scene is not refuted"
run validate --seconds 0.1 --seed 7 --no-device --points 1 ball.krs
first=$(cat out)
run validate --seconds 0.1 --seed 7 --no-device --points 1 ball.krs
[ "$status" -eq 0 ] && [ "$first" = "$(cat out)" ]
result $? "a search is the same each time"
cat >dented.krs <<'EOF'
param deep = 0 in [0, 1];
shape dented() {
    distance: if length(p - [0.6, 0.48, 0.7]) < 0.004 * deep then 1 else length(p) - 1,
    exact: true
}
show dented();
EOF
run validate --no-device --points 1 dented.krs
[ "$status" -eq 1 ] && grep -q '^dented.krs: refuted: ' out && grep -q 'error.E0411.*dented' err &&
    grep -q -- '--> dented.krs:6:6' err && grep -q 'deep = ' err
result $? "what is wrong for some values of a parameter is refuted, and the shape is blamed"
run validate --no-device --points 1 --set deep=0 dented.krs
[ "$status" -eq 0 ]
result $? "a parameter that is set stays as it is"
echo 'let a = 1;' >nothing.krs
run validate --no-device --points 1 nothing.krs
[ "$status" -eq 0 ]
result $? "a scene that shows nothing is not refuted"
