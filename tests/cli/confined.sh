#!/bin/sh
# confined.sh: what scenes may read, and how much they may ask for.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 29
find_untrusted

# A folder with a scene, beside one with a secret; links of all kinds lead from one to the other.
mkdir -p in/deep in/other beyond
echo 'let secret = 42; sekrit' >beyond/secret.krs
echo 'let size = 0.5;' >in/size.krs
echo 'let size = 0.25;' >in/deep/size.krs
ln -s ../size.krs in/deep/inner.krs
ln -s ../beyond/secret.krs in/link.krs
ln -s "$work/beyond/secret.krs" in/absolute.krs
ln -s ../beyond in/folder
ln -s /proc/self/cwd in/magic
mkfifo in/pipe.krs

# uses PATH SCENE: a scene that uses a file.
uses() { printf 'use "%s";\nshow sphere(size);\n' "$1" >"$2"; }
# Nothing of the secret was shown, and the reason is that it is outside.
kept_out() {
    [ "$status" -eq 1 ] && grep -q '^error\[E0504\]' err && ! grep -q 'sekrit\|secret = ' err
    result $? "$1"
}

uses ../beyond/secret.krs in/scene.krs
run check in/scene.krs
[ "$status" -eq 1 ] && grep -q sekrit err
result $? "without --root any file is read"
for path in ../beyond/secret.krs ../in/../beyond/secret.krs "$work/beyond/secret.krs" /etc/passwd link.krs \
    absolute.krs folder/secret.krs magic/beyond/secret.krs deep/../../beyond/secret.krs ../missing.krs; do
    uses "$path" in/scene.krs
    run check "$untrusted" in/scene.krs
    kept_out "outside: $(printf %s "$path" | sed "s,$work,/elsewhere,")"
done
for path in size.krs ./size.krs deep/size.krs deep/inner.krs deep/../size.krs ../in/size.krs; do
    uses "$path" in/scene.krs
    run check "$untrusted" in/scene.krs
    [ "$status" -eq 0 ] && [ ! -s err ]
    result $? "inside: $path"
done
uses pipe.krs in/scene.krs
run check "$untrusted" in/scene.krs
said 1 "it is not a regular file" "a pipe is not waited for"
uses ../size.krs in/other/scene.krs
run check --root in in/other/scene.krs
ended 0 "--root may be above the scene"
(cd in/other && "$krs" check --root "$work/in" scene.krs) >out 2>err
status=$?
ended 0 "--root from elsewhere"
run check --root in beyond/secret.krs
kept_out "a scene that is outside itself"
(cd in && "$krs" check "$untrusted" link.krs) >err 2>&1
status=$?
kept_out "a scene that is a link to what is outside"

# Limits.
image() { printf 'image { size: [%s], samples: %s }\nshow sphere(1);\n' "$1" "$2" >image.krs; }
image "4000, 3000" 2
run render image.krs --quiet --limit pixels=1000000 -o a.png
said 1 "the scene asks for 12000000 pixels, of which --limit pixels=1000000 allows fewer" \
    "a scene that asks for too many pixels"
image "16, 12" 4000
run render image.krs --quiet --limit pixels=192,samples=16 -o a.png
said 1 "the scene asks for 4000 samples" "a scene that asks for too many samples"
run render image.krs --quiet --size 17x12 --limit pixels=192 -o a.png
said 2 "204 pixels are more than --limit pixels=192" "options that contradict each other"
image "16, 12" 1
run render image.krs --quiet --limit time=1000,memory=8G,pixels=192,samples=1 -o a.png
[ "$status" -eq 0 ] && [ -s a.png ]
result $? "what is within its limits is rendered"
run render ball.krs --quiet --size 4000x4000 --samples 4096 --limit time=2 -o b.png
[ "$status" -eq 1 ] && grep -q 'stopped while .*: --limit time=2 allows no longer' err &&
    [ ! -e b.png ]
result $? "a picture that takes too long"
awk 'BEGIN { for (i = 0; i < 300000; i++) printf "let a%d = [%d, %d, %d];\n", i, i, i, i }' >big.krs
run check --limit memory=64M big.krs
said 71 "takes more than 64 MiB; --limit memory=256M allows more" "a scene that takes too much memory"
for limit in pixels=0 memory=1X speed=3 time; do
    run check --limit $limit ball.krs
    [ "$status" -eq 2 ] || break
done
said 2 "--limit wants time=SECONDS" "limits that are none"
