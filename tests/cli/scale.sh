#!/bin/sh
# scale.sh: large and deep scenes end, in time and in 2 GB: checked, or refused with one reason.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 39

# within COMMAND [OPTION]...: of scene.krs; a minute is far more than any of these needs.
within() {
    # shellcheck disable=SC3045
    (ulimit -v 2097152 && exec timeout 60 "$krs" "$@" scene.krs) >out 2>err </dev/null
    status=$?
}

# refused CODE "what was tested": with that diagnostic alone.
refused() {
    within check --color never
    [ "$status" -eq 1 ] && grep -q "^error\[$1\]" err && [ "$(grep -c '^error' err)" -eq 1 ]
    result $? "$2"
}

# passed "what was tested"
passed() {
    within check --color never
    [ "$status" -eq 0 ] && [ ! -s err ]
    result $? "$1"
}

# repeated COUNT TEXT: lines of that text, with the number of the line in the place of each #.
repeated() {
    yes -- "$2" | head -n "$1" |
        awk '{ n = split($0, part, "#"); s = part[1]
               for (k = 2; k <= n; k++) s = s NR part[k]
               print s }'
}

# ---- depth ----

{ echo "show sphere("; repeated 10000 "("; echo 1; repeated 10000 ")"; echo ");"; } >scene.krs
refused E0105 "10,000 parentheses"
{ echo "show"; repeated 10000 "("; echo "sphere(1)"; repeated 10000 "| sphere(2))"
    echo ";"; } >scene.krs
refused E0105 "10,000 unions within each other"
{ echo "show sphere(1)"; repeated 10000 ".move([0.1, 0, 0])"; echo ";"; } >scene.krs
refused E0105 "10,000 methods"
{ echo "show sphere(1)"; repeated 10000 " | sphere(#)"; echo ";"; } >scene.krs
refused E0105 "10,000 unions in a row"
{ echo "let a ="; repeated 10000 "["; repeated 10000 "]"; echo "; show sphere(1);"; } >scene.krs
refused E0105 "10,000 lists within each other"
{ echo "show sphere("; repeated 100000 "-"; echo "1);"; } >scene.krs
refused E0105 "100,000 signs"
{ repeated 10000 "if true { "; repeated 10000 "}"; } >scene.krs
refused E0105 "10,000 blocks"
echo "def f(n) = g(n); def g(n) = f(n); show sphere(f(1));" >scene.krs
refused E0503 "functions that call each other for ever"
echo "def f(n) = if n == 0 then 0 else f(n - 1) + f(n - 1); show sphere(f(40));" >scene.krs
refused E0503 "a function that calls itself 2^40 times"

# ---- what is used many times ----

# doubled FIRST NEXT: what each of forty lines has twice of the one before.
doubled() {
    echo "let s0 = $1;"
    repeated 40 "$2" | awk '{ gsub("@", NR - 1); print }'
}

{ doubled "[1, 2]" "let s# = [s@, s@];"; echo "show sphere(s40);"; } >scene.krs
refused E0301 "a list of 2^40 numbers as a radius"
{ doubled "[1, 2]" "let s# = [s@, s@];"; echo "def f(n) = 1; show sphere(f(s40));"; } >scene.krs
passed "a list of 2^40 numbers as an argument"
{ doubled "[sphere(1)]" "let s# = [s@, s@];"; echo "show union(s40);"; } >scene.krs
refused E0503 "a union of a list of 2^40 shapes"
{ doubled "[]" "let s# = [s@, s@];"; echo "show s40;"; } >scene.krs
refused E0503 "2^40 empty lists"
{ doubled "sphere(1)" "let s# = s@ - s@.move([#, 0, 0]);"; echo "show s40;"; } >scene.krs
refused E0503 "a difference of 2^40 shapes"
{ doubled "sphere(1)" "let s# = krs { kernel s@; kernel s@; reflect plane([1, 0, 0], #); };"
    echo "show s40;"; } >scene.krs
refused E0503 "2^40 kernels"
{ doubled "x" "let s# = s@ * s@;"; echo "show field(s40 + y).within(box([1, 1, 1]));"; } >scene.krs
passed "x^(2^40)"
{ echo "param q = 0 in [-0.001, 0.001];"
    doubled "invert([0, 0, 0], 1) * translate([q, 0, 0])" "let s# = s@ * s@;"
    echo "show sphere(0.2).move([0, 0, 0.5]).transform(s40);"; } >scene.krs
refused E0503 "2^40 inversions that stay apart"
{ doubled "x" "let s# = s@ * y - s@;"; echo "show sphere(1).displace(sin(s40), 0.1);"; } >scene.krs
passed "a displacement as steep as 2^40, framed by the compiler"

# ---- much text ----

repeated 60000 "let a# = [#, #, #];" | tr -d '\n' >scene.krs
echo "show sphere(1);" >>scene.krs
for stage in tokens syntax; do
    within dump --after=$stage
    [ "$status" -eq 0 ] && [ ! -s err ] && tail -n 3 out | grep -q '1:20555'
    result $? "$stage of a line of 2 MB"
done

shape="sphere(radius: 1.#).move([#.25, 3.125, 0.#]).rotate([0, 1, 0], #deg)"
{ repeated 10000 "let shape_number_# = $shape;"; echo "show shape_number_7;"; } >scene.krs
[ "$(wc -c <scene.krs)" -gt 1000000 ]
result $? "a scene has a megabyte"
passed "a megabyte of definitions"
{ echo "show union(["; repeated 10000 "$shape,"; echo "]);"; } >scene.krs
passed "10,000 shapes in one union"
{ repeated 1000 "param p# = 0.5 in [0, 1]; let s# = sphere(1 + p#);"
    echo "show union([s7, s900]);"; } >scene.krs
passed "1,000 parameters"
{ repeated 200 "material m# { color: [0.#, 0.5, 0.5] }"
    repeated 200 "show sphere(0.4).move([#, 0, 0]).paint(m#);"; } >scene.krs
passed "200 materials"
{ echo "show sphere(1);"; repeated 64 "light l# { position: [#, 5, 5], intensity: 500 }"; } >scene.krs
passed "64 lights"
name=$(head -c 10000 /dev/zero | tr '\0' n)
echo "let $name = sphere(1); show $name;" >scene.krs
passed "a name of 10,000 letters"
echo "let a$name = sphere(1); show b$name;" >scene.krs
refused E0201 "a name of 10,000 letters that nothing has"
repeated 20000 "show nothing_#();" >scene.krs
within check --color never
said 1 "error[E0201]" "20,000 mistakes"
[ "$(wc -c <err)" -lt 100000 ]
result $? "20,000 mistakes are not all told"
repeated 100000 "} ) ; ( " >scene.krs
within check --color never
ended 1 "100,000 brackets that fit nowhere"

# ---- much work, numbers ----

echo "def f(n) = max([sin(i) for i in 0..n]); show sphere(f(100000));" >scene.krs
passed "a list of 100,000 elements"
echo "show union([sphere(0.1).move([i, 0, 0]) for i in 0..5000000]);" >scene.krs
refused E0503 "a union of five million"
echo "show sphere(1e308);" >scene.krs
refused E0309 "a number too large for the device"
echo "show sphere(1e999);" >scene.krs
refused E0104 "a number too large for anything"
echo "let huge = 1e308 * 10; show sphere(huge - huge);" >scene.krs
refused E0310 "what is not a number"

# ---- the device's share ----

grid="sphere(0.1).move([i % 10, floor(i / 10), 0]) for i in 0..400"
echo "show union([$grid], blend: 0.1);" >scene.krs
within compile -o shaders
[ "$status" -eq 0 ] && [ -s shaders/scene.trace.spv ]
result $? "a blend of 400 is compiled"
within info
[ "$status" -eq 0 ] && [ "$(sed -n 's/^operations //p' out)" -lt 40 ]
result $? "and has the operations of one shape, and of the blend"
# Each call is a cut through all that stands before it, for drivers: one, and its definition.
[ "$(grep -c 'krs_smin' shaders/scene.glsl)" -le 2 ]
result $? "and no call for each of them"
