#!/bin/sh
# untrusted.sh: what the command writes of a stranger's scene goes where the command line says, through no link,
# and what an import reads lies in the folder of its file.
# shellcheck source-path=SCRIPTDIR disable=SC2016,SC2086
. "$(dirname "$0")/common.sh"
plan 70
find_untrusted
small="--size 16x12 --quiet $untrusted"

# Makes a folder with links of all kinds, and one beside it that nothing may change.
prepare() {
    chmod -R u+w in out 2>/dev/null
    rm -rf in out
    mkdir -p in/deep out/sub
    echo victim >out/victim
    echo victim >out/sub/victim
    echo 'show sphere(1);' >in/ball.krs
}
# Nothing outside has changed, and nothing is new there.
untouched() {
    [ "$(cat out/victim)" = victim ] && [ "$(cat out/sub/victim)" = victim ] && [ "$(find out | wc -l)" -eq 4 ] &&
        [ -z "$(find in -name '.krs-*')" ]
}
# A link in the place of an output, or of a folder on the way to it, by all ways to write one.
plant() { # kind, name of the output
    case $1 in
    relative) ln -s ../out/victim "in/$2" ;;
    absolute) ln -s "$work/out/victim" "in/$2" ;;
    dangling) ln -s ../out/new "in/$2" ;;
    chain) ln -s ../out/victim in/step && ln -s step "in/$2" ;;
    inside) ln -s deep/there "in/$2" ;;
    magic) ln -s "/proc/self/cwd/../out/victim" "in/$2" ;;
    pipe) mkfifo "in/$2" ;;
    esac
}

# ---- links in the place of files ----

for kind in relative absolute dangling chain inside magic pipe; do
    prepare && plant $kind ball.exr
    (cd in && timeout 60 "$krs" render ball.krs $small >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched && [ ! -e in/ball.png ]
    result $? "a default output: $kind"
    prepare && plant $kind a.png
    (cd in && timeout 60 "$krs" render ball.krs $small -o a.png >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "an output: $kind"
    prepare && plant $kind a.png.part
    (cd in && KRS_TEST_CHECKPOINT=0.01 timeout 60 "$krs" render ball.krs $small --samples 64 --resume -o a.png \
        >../stdout 2>../err)
    status=$?
    untouched && { [ "$status" -eq 73 ] || [ "$status" -eq 0 ]; }
    result $? "a checkpoint: $kind"
    prepare && plant $kind ball.stl
    (cd in && timeout 60 "$krs" mesh ball.krs "$untrusted" --error 0.1 --quiet >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "a mesh: $kind"
    prepare && mkdir in/shaders && plant $kind shaders/ball.json
    (cd in && timeout 60 "$krs" compile ball.krs "$untrusted" -o shaders >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "shaders: $kind"
    prepare && plant $kind a.krs && printf 'surface_equation=x^2+y^2+z^2-1\n' >in/ball.jsurf
    (cd in && timeout 60 "$krs" import ball.jsurf "$untrusted" -o a.krs >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "an import: $kind"
done

# ---- links in the place of folders ----

for kind in relative absolute chain; do
    prepare
    case $kind in
    relative) ln -s ../out in/folder ;;
    absolute) ln -s "$work/out" in/folder ;;
    chain) ln -s ../out in/step && ln -s step in/folder ;;
    esac
    for path in folder/a.png folder/victim/a.png folder/sub/a.png deep/../folder/a.png "$work/in/folder/a.png"; do
        (cd in && timeout 60 "$krs" render ball.krs $small -o "$path" >../stdout 2>../err)
        status=$?
        [ "$status" -eq 73 ] && untouched
        good=$?
        [ $good -eq 0 ] || break
    done
    result $good "a folder of an output: $kind"
    (cd in && timeout 60 "$krs" compile ball.krs "$untrusted" -o folder/shaders >../stdout 2>../err) ||
        (cd in && timeout 60 "$krs" compile ball.krs "$untrusted" -o folder >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "a folder of shaders: $kind"
done
grep -q "symbolic link" err
result $? "the link is said"

# ---- what the command line says ----

prepare
for path in a.png deep/a.png ./deep/../b.png "$work/in/c.png" "../in/d.png" "$work/own.png" ../own.exr; do
    (cd in && "$krs" render ball.krs $small -o "$path" >../stdout 2>../err) || break
    (cd in && [ -s "$path" ]) || break
done
[ -s own.exr ] && [ -s own.png ] && [ -s in/deep/a.png ] && [ "$(stat -c %a in/a.png)" = "$(stat -c %a in/c.png)" ]
result $? "outputs where there are no links"
echo old >in/a.png && chmod 640 in/a.png
(cd in && "$krs" render ball.krs $small -o a.png >../stdout 2>../err)
[ "$(stat -c %a in/a.png)" = 640 ] && [ "$(wc -c <in/a.png)" -gt 100 ]
result $? "a file that is there is replaced, and keeps its permissions"
(cd in && "$krs" render ball.krs $small -o - >../piped.png 2>../err) && cmp -s piped.png own.png
result $? "standard output"
(cd in && "$krs" compile ball.krs "$untrusted" -o made >../stdout 2>../err) && [ -s in/made/ball.json ]
result $? "a folder that is made"
chmod a-w in/deep
if [ "$(id -u)" -ne 0 ]; then
    (cd in && "$krs" render ball.krs $small -o deep/x.png >../stdout 2>../err)
    status=$?
    ended 73 "a folder that cannot be written"
else
    skip "a folder that cannot be written" "root may write anywhere"
fi
chmod u+w in/deep

# ---- what an import reads ----

# `sphere { 0, R }`, where R is in the file that is included.
include() { # name
    printf '#declare R = 1;\n#include "%s"\nsphere { 0, R }\n' "$1" >in/a.pov
    (cd in && timeout 60 "$krs" import a.pov "$untrusted" >../stdout 2>../err)
    status=$?
}
for kind in relative absolute chain magic; do
    prepare && echo '#declare R = 0.25;' >out/victim && plant $kind r.inc
    include r.inc
    [ "$status" -eq 1 ] && grep -q 'a.pov:2: `r.inc` is not read: it is outside' err && [ ! -s stdout ]
    result $? "an included link: $kind"
done
for path in ../out/victim deep/../../out/victim "$work/out/victim" /etc/passwd folder/victim; do
    prepare && echo '#declare R = 0.25;' >out/victim && ln -s ../out in/folder
    include "$path"
    [ "$status" -eq 1 ] && grep -q 'is not read: it is outside' err && [ ! -s stdout ]
    good=$?
    [ $good -eq 0 ] || break
done
result $good "an included file that lies outside"
prepare && echo '#include "../out/victim"' >in/deep/r.inc
include deep/r.inc
[ "$status" -eq 1 ] && grep -q '../out/victim` is not read' err
result $? "one that an included file names"
prepare && mkdir -p in/deep && plant inside r.inc && echo '#declare R = 0.25;' >in/deep/there
include r.inc
[ "$status" -eq 0 ] && grep -q 'sphere(0.25)' stdout
result $? "an included link that stays in the folder"
for path in ./deep/there deep/../deep/there; do
    include $path
    [ "$status" -eq 0 ] && grep -q 'sphere(0.25)' stdout
    good=$?
    [ $good -eq 0 ] || break
done
result $good "and the file itself"
prepare && mkfifo in/r.inc
include r.inc
[ "$status" -eq 0 ] && grep -q '`r.inc` is not read: it is not a regular file' stdout
result $? "a pipe"
include ''
[ "$status" -eq 0 ] && grep -q 'is not read' stdout
result $? "a file without a name"
include textures.inc
[ "$status" -eq 0 ] && grep -q "an untrusted import reads nothing of POV-Ray's folders" stdout
result $? "a file of POV-Ray's own"
prepare && echo '#declare R = 0.25;' >out/victim
include ../out/victim && (cd in && "$krs" import a.pov >../stdout 2>../err)
[ -s stdout ] && grep -q 'sphere(0.25)' stdout && (cd in && "$krs" import a.pov --root .. >../stdout 2>../err) &&
    grep -q 'sphere(0.25)' stdout
result $? "what is outside, for a scene of one's own, and where the root is further up"
# A pipe would wait for ever, were it opened.
prepare && mkfifo in/font.ttf
printf 'linear_extrude(height = 1) { text(text = "a", size = 10, font = "font.ttf"); }\n' >in/a.csg
(cd in && timeout 60 "$krs" import a.csg "$untrusted" >../stdout 2>../err)
status=$?
[ "$status" -eq 0 ] && grep -q 'text("a"' stdout && ! grep -q 'font: ' stdout
result $? "a font from a file in OpenSCAD"
printf 'text { ttf "timrom.ttf" "a" 1, 0 }\n' >in/a.pov
(cd in && timeout 60 "$krs" import a.pov "$untrusted" >../stdout 2>../err)
status=$?
[ "$status" -eq 0 ] && grep -q 'the font `timrom.ttf` is not read' stdout
result $? "a font of POV-Ray's"

# ---- links that come and go ----

prepare
mkdir in/real
(
    cd in || exit
    while [ ! -e ../stop ]; do
        ln -sfn ../out swap 2>/dev/null
        mv -T swap turn 2>/dev/null
        rm -rf turn
        mkdir turn 2>/dev/null
        ln -sf ../../out/victim turn/a.png 2>/dev/null
        rm -rf turn
    done
) &
swapper=$!
for _ in 1 2 3 4 5 6; do
    (cd in && timeout 60 "$krs" render ball.krs $small -o turn/a.png >../stdout 2>../err)
done
touch stop
wait $swapper
[ "$(cat out/victim)" = victim ] && [ ! -e out/a.png ]
result $? "a folder that turns into a link and back"
rm -f stop

# Links of other folders are followed, as before.
prepare && plant relative a.png
(cd in && "$krs" render ball.krs --size 16x12 --quiet -o a.png >../stdout 2>../err)
[ -L in/a.png ] && [ "$(wc -c <out/victim)" -gt 100 ]
result $? "a scene of one's own writes through links"
