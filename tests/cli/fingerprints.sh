#!/bin/sh
# fingerprints.sh: what is kept for a later run depends on the sources that decide it: a change of one of
# them changes the fingerprint, a change of another source does not, and neither do compiler, options,
# folder or git.  What a program of other sources has kept is not used.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 19

# ---- sources ----
mkdir tree tree/tests tree/bench
(cd "$root" && cp -r Makefile tools api cli compiler editors export import python rays include mesh platform slice grid measure runtime live site web "$work/tree" && cp tests/*.mk "$work/tree/tests" &&
    cp bench/*.mk "$work/tree/bench")
fingerprints() { make --no-print-directory -s -C tree "$@" fingerprints 2>>err; }
fingerprints >before
(cd "$root" && make --no-print-directory -s fingerprints) >here
[ "$(wc -l <before)" -eq 3 ] && [ "$(sort -u -k 2 before | wc -l)" -eq 3 ] && cmp -s before here
result $? "there are three, the same in another folder without git"
for program in "$krs" "$(dirname "$krs")/libkrs.a"; do
    [ ! -e "$program" ] || while read -r kind digest; do
        grep -qF "$digest" "$program" || echo "$program: $kind $digest"
    done <here
done >missing
[ ! -s missing ]
result $? "they are in the program that was tested"
fingerprints B=elsewhere CC=clang CFLAGS='-g -O1 -fsanitize=address' | cmp -s - before
result $? "compilers and options change none"

# The kinds of fingerprints that a change of a file changes, in one line.
changed_by() { # file of the tree
    cp -p "tree/$1" saved
    echo >>"tree/$1"
    fingerprints | diff before - | sed -n 's/^> \([a-z]*\) .*/\1/p' | sort | paste -s -d ' '
    cp -p saved "tree/$1"
}
decides() { # file, kinds
    [ "$(changed_by "$1")" = "$2" ]
    result $? "$1 decides ${2:-none}"
}
decides compiler/target/inline.c "cache checkpoint film"
decides runtime/device/cache.c "cache checkpoint film"
decides compiler/graph/ops.def "checkpoint film"
decides compiler/library/std/trees.krs "checkpoint film"
decides runtime/shaders/bsdf.glsl "checkpoint film"
decides runtime/film/saved.c "checkpoint film"
decides platform/linux/fonts.c "checkpoint film"
decides cli/picture/checkpoint.c "checkpoint"
for file in cli/mesh.c mesh/contour/contour.c compiler/base/diag.def live/viewer.c runtime/writer/png.c; do
    [ ! -e "tree/$file" ] || [ -z "$(changed_by "$file")" ] || echo "$file"
done >deciding
[ ! -s deciding ]
result $? "what meshes, speaks or writes files decides none"
mv tree/compiler/graph/range.c tree/compiler/graph/renamed.c
[ "$(fingerprints | grep -xF -f before | cut -d ' ' -f 1)" = cache ]
result $? "a source of another name is another source"

# ---- programs ----
# The program as it would be if its sources were others.
while read -r kind digest; do
    echo "s/$digest/$(echo "$kind$digest" | sha256sum | cut -c 1-16)/"
done <here >edit
LC_ALL=C sed -f edit "$krs" >other && chmod +x other
export XDG_CACHE_HOME="$work/caches"
kept() { find "$XDG_CACHE_HOME/krs" -name "*.$1" | wc -l; }
picture() { # program, words
    program=$1
    shift
    "$program" render ball.krs --rays kernels --size 16x16 --quiet "$@" >out 2>err
    status=$?
}
picture "$krs" -o a.exr
first=$(kept spirv)
picture "$krs" -o b.exr
[ "$status" -eq 0 ] && [ "$first" -gt 0 ] && [ "$(kept spirv)" -eq "$first" ]
result $? "the same program finds its kernels"
picture ./other -o c.exr
[ "$status" -eq 0 ] && [ "$(kept spirv)" -eq $((2 * first)) ] && cmp -s a.exr c.exr
result $? "one of other sources compiles its own, and has the same picture"

KRS_TEST_CHECKPOINT=0.05
export KRS_TEST_CHECKPOINT
long="--integrator path --samples 65536 --resume"
# shellcheck disable=SC2086 # words are meant
setsid "$krs" render ball.krs --size 64x48 $long -o part.exr >out 2>err </dev/null &
leader=$! tries=0
until [ -s part.exr.part ] || [ $tries -gt 3000 ]; do
    tries=$((tries + 1))
    sleep 0.02
done
sleep 0.2
kill -TERM $leader
wait $leader
[ -s part.exr.part ]
result $? "a render is interrupted"
cp part.exr.part part
resumed() { # program: what it says within two seconds
    cp part part.exr.part
    # shellcheck disable=SC2086 # words are meant
    timeout -s TERM 5 "$1" render ball.krs --size 64x48 $long -o part.exr >out 2>err </dev/null
}
resumed "$krs"
grep -q "going on after" err
result $? "the same program goes on with it"
resumed ./other
grep -q "rendering begins anew" err && ! grep -q "going on after" err
result $? "one of other sources begins anew"

# ---- the commit ----
run --version
if [ -e "$root/.git" ] && command -v git >/dev/null; then
    grep -qE '^krs [0-9.]+ \([0-9a-f]{7,}(-dirty)?\)$' out
else
    grep -qE '^krs [0-9.]+$' out
fi
result $? "krs --version names the commit where there is one"
