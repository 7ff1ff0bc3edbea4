#!/bin/sh
# untrusted.sh: what the command writes of a stranger's scene goes where the command line says, through no link.
# shellcheck source-path=SCRIPTDIR disable=SC2086
. "$(dirname "$0")/common.sh"
plan 56
small="--size 16x12 --quiet --untrusted"

# Of a folder with links of all kinds, and one beside it that nothing may change.
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
    (cd in && timeout 60 "$krs" mesh ball.krs --untrusted --error 0.1 --quiet >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "a mesh: $kind"
    prepare && mkdir in/shaders && plant $kind shaders/ball.json
    (cd in && timeout 60 "$krs" compile ball.krs --untrusted -o shaders >../stdout 2>../err)
    status=$?
    [ "$status" -eq 73 ] && untouched
    result $? "shaders: $kind"
    prepare && plant $kind a.krs && printf 'surface_equation=x^2+y^2+z^2-1\n' >in/ball.jsurf
    (cd in && timeout 60 "$krs" import ball.jsurf --untrusted -o a.krs >../stdout 2>../err)
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
        { [ "$status" -eq 73 ] && untouched; } || break
    done
    result $? "a folder of an output: $kind"
    (cd in && timeout 60 "$krs" compile ball.krs --untrusted -o folder/shaders >../stdout 2>../err) ||
        (cd in && timeout 60 "$krs" compile ball.krs --untrusted -o folder >../stdout 2>../err)
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
(cd in && "$krs" compile ball.krs --untrusted -o made >../stdout 2>../err) && [ -s in/made/ball.json ]
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

# Of others links are followed, as before.
prepare && plant relative a.png
(cd in && "$krs" render ball.krs --size 16x12 --quiet -o a.png >../stdout 2>../err)
[ -L in/a.png ] && [ "$(wc -c <out/victim)" -gt 100 ]
result $? "a scene of one's own writes through links"
