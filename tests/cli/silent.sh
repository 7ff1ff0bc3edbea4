#!/bin/sh
# silent.sh: what is lost, wrong or waited for is said: closed standard output, files that are no whole pictures,
# pipes in the place of files, names that a terminal would obey, rays that ended nowhere.
# shellcheck source-path=SCRIPTDIR disable=SC2086
. "$(dirname "$0")/common.sh"
plan 77
find_untrusted
small="--size 16x12 --quiet"
echo 'show sphere(1);' >ball.krs
echo '0 0 0' >points

# ---- standard output that takes nothing ----

printf 'surface_equation=x^2+y^2+z^2-1\n' >ball.jsurf
for words in "render ball.krs $small -o -" "render ball.krs $small --raw" "render ball.krs $small -o a.png --stats" \
    "query ball.krs" "info ball.krs" "info --json ball.krs" "devices" "devices --json" "dump --after=graph ball.krs" \
    "explain E0203" "help" "help render" "render --help" "--version" "--manual" "--completion bash" \
    "format -" "import ball.jsurf" "validate --no-device --seconds 0 --points 10 ball.krs"; do
    input=points
    [ "$words" = "format -" ] && input=ball.krs
    "$krs" $words >&- 2>err <$input
    status=$?
    : >out
    [ "$status" -eq 74 ] && grep -q "standard output\|/dev/stdout" err
    result $? "closed: krs $words"
    "$krs" $words >/dev/full 2>err <$input
    status=$?
    [ "$status" -eq 74 ] && grep -q "No space left" err
    result $? "full: krs $words"
done
printf 'head ' >both
"$krs" render ball.krs $small -o - >>both 2>err
run render ball.krs $small -o whole.png
{ printf 'head '; cat whole.png; } | cmp -s - both
result $? "a picture is added to what standard output has"

# ---- pictures that are not whole ----

run render ball.krs $small --frames 1..4 -o 'w%d.exr' -o 'w%d.png'
for damage in empty half hole text zeros; do
    rm -rf f*
    for i in 1 2 3 4; do cp w$i.exr f$i.exr; cp w$i.png f$i.png; done
    for file in f2.exr f3.png; do
        rm $file
        case $damage in
        empty) : >$file ;;
        half) head -c 300 "w${file#f}" >$file ;;
        hole) head -c -1 "w${file#f}" >$file ;;
        text) echo "this is no picture, and longer than thirty bytes" >$file ;;
        zeros) head -c "$(wc -c <"w${file#f}")" /dev/zero >$file ;;
        esac
    done
    run render ball.krs --size 16x12 --frames 1..4 --skip-existing -o 'f%d.exr' -o 'f%d.png'
    same=0
    for i in 1 2 3 4; do cmp -s w$i.exr f$i.exr && cmp -s w$i.png f$i.png && same=$((same + 1)); done
    [ "$status" -eq 0 ] && [ $same -eq 4 ] && grep -q "left out 2 frames" err
    result $? "--skip-existing makes what is there in part: $damage"
done

# ---- pipes ----

mkfifo piped.png.part
timeout 20 "$krs" render ball.krs $small --resume -o piped.png >out 2>err
status=$?
said 73 "piped.png.part" "a pipe in the place of a checkpoint is not waited for"

# ---- names ----

# A terminal would obey ESC and U+009B, and a line break begins a line that nobody wrote.
name=$(printf 'a\033[31mb\302\233c\nkrs: done')
cp ball.krs "$name.krs"
tame() { # what was tested
    ! LC_ALL=C grep -q "$(printf '[\001-\010\013-\037\177]')" err out && ! grep -q "$(printf '\302\233')" err out &&
        ! grep -q '^krs: done' err out && [ -s err ]
    result $? "no message obeys a name: $1"
}
run check "$name"
tame "a scene that is missing"
run render "$name.krs" --size 16x12 -o "$name.png"
tame "what was written"
run render ball.krs -o "$name.xyz"
tame "an output that is no picture"
run render ball.krs -o "$name/a.png"
tame "an output that cannot be"
run mesh ball.krs -o "$name/a.stl"
tame "a mesh that cannot be"
run import "$name.jsurf"
tame "an import that is missing"
run compile "$name.krs" -o "$name.krs"
tame "a folder that cannot be"
run render ball.krs --set "$name=1" -o a.png
tame "a param that is not there"
run render ball.krs "--$name"
tame "an option that is not there"
run "$name"
tame "a command that is not there"
printf 'use "a\033[31mb.krs"; show sphere(1);' >uses.krs
run check uses.krs
tame "a file that a scene uses"
run validate --no-device --seconds 0 --points 10 "$name.krs"
! LC_ALL=C grep -q "$(printf '\033')" err out && ! grep -q '^krs: done' out
result $? "no message obeys a name: an answer of validate"
KRS_TEST_CRASH=compile:hang run check --deadline 1 "$name.krs"
tame "a scene that takes too long"

# ---- what pictures lack ----

cat >unresolved.krs <<'END'
shape s() { distance: 0.0005*(length(p)-1), slope: 1, within: box([2,2,2]) }
show s();
camera { eye: [0,0,5], target: [0,0,0], fov: 40deg }
END
run render unresolved.krs --size 72x72 --error 0.01 -o a.png
said 0 "rays" "rays that ran out of steps are said"
grep -q "^krs: warning: [0-9]* of [0-9]* rays .* ran out of steps" err
result $? "as a warning"
run render unresolved.krs --size 72x72 --error 0.01 -o a.png --quiet
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "unless the command is quiet"
run render ball.krs --size 16x12 -o a.png
[ "$status" -eq 0 ] && ! grep -q warning err
result $? "and nothing of a picture without"
cat >room.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light lamp { position: [2, 3, 1], radius: 1, intensity: 8 }
show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);
END
run render room.krs --integrator path --size 32x24 --noise 0.0005 --samples 32 -o a.png
said 0 "pixels" "noise that was not reached is said"
grep -q "^krs: warning: [0-9]* of 768 pixels .* have more noise than 0.0005 after all 32 samples" err
result $? "as a warning, with how much was asked for"
run render room.krs --integrator path --size 32x24 --noise 0.9 --samples 64 -o a.png
[ "$status" -eq 0 ] && ! grep -q warning err
result $? "and nothing where it was reached"

# ---- imports ----

run import --help
grep -q -- --deadline out && grep -q -- --limit out && grep -q -- --root out && grep -q -- --untrusted out
result $? "imports have deadlines and limits"
mkfifo slow.jsurf
run import slow.jsurf --deadline 1
said 1 "\`slow.jsurf\` is a pipe, and who writes to it has not ended" "an import that does not end"
KRS_TEST_CRASH=compile:hang run import ball.jsurf --deadline 1
said 1 "gave up compiling the scene after 1 seconds: \`ball.jsurf\` has" "an import that takes too long"
mkdir in out-of
cp ball.jsurf out-of/ball.jsurf
ln -s ../out-of/ball.jsurf in/link.jsurf
run import --root in out-of/ball.jsurf
said 1 "outside of the root" "an import of what is outside"
run import "$untrusted" in/link.jsurf
said 1 "outside of the root" "an import through a link"
cp ball.jsurf in/ball.jsurf
run import "$untrusted" in/ball.jsurf
[ "$status" -eq 0 ] && [ -s out ]
result $? "an import of what is inside"
printf '<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10"><rect width="5" height="5"/></svg>' >in/a.svg
run import "$untrusted" in/a.svg
ended 0 "a drawing, which its scene reads"

# ---- the hash by which checkpoints know their scene ----

hash_of() { "$krs" info "$1" 2>>err | sed -n 's/^hash //p'; }
printf 'let a = read_csv("a.csv"); let b = read_csv("b.csv");
for r in a { show sphere(0.8).move([r.x, r.y, 0]); } for r in b { show box([1, 1, 1]).move([r.x, r.y, 0]); }' >two.krs
: >hashes
for at in 1 2 3 4 5 6; do
    seq 2 9 | head -n $at | sed 's/$/,0/' >a.csv
    seq 2 9 | tail -n +$((at + 1)) | sed 's/$/,0/' >b.csv
    hash_of two.krs >>hashes
done
[ "$(sort -u hashes | wc -l)" -eq 6 ]
result $? "rows that go from one file to the next change the hash"
mkdir -p deep/er
cp two.krs a.csv b.csv deep
[ "$(hash_of deep/two.krs)" = "$(hash_of ./deep/two.krs)" ] &&
    [ "$(hash_of deep/two.krs)" = "$(hash_of "$work/deep/er/../two.krs")" ] &&
    [ "$(hash_of deep/two.krs)" = "$(hash_of two.krs)" ] && [ "$(cd deep/er && hash_of ../two.krs)" = "$(hash_of two.krs)" ]
result $? "the folder of a scene does not"
fonts=$(fc-list -f '%{file}\n' 2>/dev/null | grep '\.[to]tf$' | sort | head -n 2)
if [ "$(echo "$fonts" | wc -l)" -eq 2 ]; then
    echo 'show text("a").extrude(0.1);' >letter.krs
    : >hashes
    for font in $fonts; do
        rm -rf fonts && mkdir fonts && cp "$font" fonts/one.ttf
        echo "<fontconfig><dir>$work/fonts</dir><cachedir>$work/cache</cachedir></fontconfig>" >fonts.conf
        FONTCONFIG_FILE=$work/fonts.conf hash_of letter.krs >>hashes
    done
    [ "$(sort -u hashes | wc -l)" -eq 2 ]
    result $? "another font of the system does"
else
    skip "another font of the system does" "there are not two fonts"
fi

# ---- processor time ----

for limit in -t -St; do
    (
        # shellcheck disable=SC3045
        ulimit $limit 1
        "$krs" mesh ball.krs --limit memory=4G --error 0.00001 -o a.stl >out 2>err
    )
    status=$?
    said 130 "processor time that \`ulimit -t\` allows is used up" "ulimit $limit is no want of memory"
done
