#!/bin/sh
# sandbox.sh: code that has taken over the process of a stranger's scene tries to get out, by all ways of
# tests/sandbox/escapes.def; where the sandbox has a hole, they are seen; and what commands do inside is what they do outside.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
rows=$root/tests/sandbox/escapes.def
deadly=$(sed -n 's/^DEADLY(\([a-z_]*\),.*/\1/p' "$rows")
beyond=$(sed -n 's/^BEYOND(\([a-z_]*\),.*/\1/p' "$rows")
refused=$(grep -c '^ESCAPE(' "$rows")
# shellcheck disable=SC2086 # words are meant
plan $(($(echo $deadly $beyond | wc -w) + 18))
"${CC:-cc}" -std=gnu17 -Wall -Wextra -shared -fPIC -o escape.so "$root/tests/sandbox/escape.c" -pthread || exit 1
: >out

# A folder with a scene, one beside it with a secret, and what attempts want to change.
prepare() {
    rm -rf in beyond
    mkdir -p in/deep in/empty in/scene-folder.png beyond
    echo 'let secret = 42;' >beyond/secret.krs
    echo fetched >beyond/fetched
    ln -s ../beyond/secret.krs in/link.krs
    ln -s ../beyond in/folder
    ln -s ../beyond/written.png in/scene-link.png
    for i in 1 2 3 4 5 6; do echo victim >in/victim-$i; done
    echo 'show sphere(1);' >in/scene.krs
    find in beyond -printf '%p %y %m %s\n' -type f -exec cat {} \; | sort >before
}
unchanged() { find in beyond -printf '%p %y %m %s\n' -type f -exec cat {} \; | sort | cmp -s before -; }
tries() { # attempt, limits, settings
    attempt=$1 limits=$2
    shift 2
    (cd in && env LD_PRELOAD="$work/escape.so" ESCAPE="$attempt" "$@" timeout 60 "$krs" render --untrusted --limit "$limits" \
        scene.krs >../out 2>../err </dev/null)
    status=$?
}
few=memory=256M,file=1M,time=30

# ---- attempts that are refused ----

prepare
tries refused $few
[ "$status" -eq 0 ] && [ "$(grep -c ' refused [A-Z]*$' err)" -eq "$refused" ] && [ "$(wc -l <err)" -eq "$refused" ]
result $? "$refused attempts are refused, each by its error"
unchanged
result $? "and nothing has changed"
for version in 1 2 3 4 5 6; do
    tries refused $few VERSION=$version
    [ "$(grep -c ' refused [A-Z]*$' err)" -eq "$refused" ] && [ "$(wc -l <err)" -eq "$refused" ] && unchanged
    good=$?
    [ $good -eq 0 ] || break
done
result "$good" "likewise where Landlock is as old as its first version, or any up to now"

# ---- attempts that end the process ----

for attempt in $deadly; do
    tries "$attempt" $few
    said 70 "a system call was tried that the sandbox forbids" "an attempt that is deadly: $attempt"
done
for attempt in $beyond; do
    limits=memory=256M,file=64M,time=30
    [ "$attempt" = time ] && limits=memory=256M,time=1
    tries "$attempt" $limits
    words=$(sed -n "s/^BEYOND($attempt, \"\([^\"]*\)\".*/\1/p" "$rows")
    said 1 "$words" "an attempt beyond limits: $attempt"
done
unchanged
result $? "nothing has changed by them"

# ---- holes ----

through() { grep -c ' through$' err; }
tries refused $few PLANT=all
[ "$(through)" -gt 60 ] && grep -qx 'read_above through' err && grep -qx 'internet through' err
result $? "without the sandbox attempts are through"
! unchanged
result $? "and files have changed"
prepare
tries refused $few PLANT=landlock
[ "$(through)" -gt 15 ] && grep -qx 'read_above through' err && ! grep -qx 'internet through' err
result $? "without Landlock those are through that read"
prepare
tries refused $few PLANT=seccomp
[ "$(through)" -gt 15 ] && grep -qx 'internet through' err && ! grep -qx 'read_above through' err
result $? "without seccomp those are through that call"
prepare
for attempt in program trace_self read_of_other_memory change_root user clock_of_day; do
    tries $attempt $few PLANT=all
    grep -qx "$attempt through" out err || break
done
result $? "without the sandbox deadly attempts are through"

# ---- systems without ----

unset ESCAPE
no_sandbox() { # arguments of krs
    env LD_PRELOAD="$work/escape.so" VERSION=0 "$krs" "$@" >out 2>err </dev/null
    status=$?
}
no_sandbox check --untrusted in/scene.krs
said 69 "no sandbox for untrusted scenes: this system has no Landlock" "a system without Landlock is told of"
no_sandbox check --untrusted=limits in/scene.krs
ended 0 "and does what it can where limits alone are asked for"
run check --untrusted=all in/scene.krs
said 2 "--untrusted wants limits" "there is no other kind"

# ---- what commands do inside ----

prepare
cp "$root/examples/01-hello.krs" in/example.krs
printf 'camera { eye: [0, 1, 5], target: [0, 0, 0] }\nuse "deep/size.krs";\nshow sphere(size);\n' >in/uses.krs
echo 'let size = 0.5;' >in/deep/size.krs
for scene in example uses; do
    run render in/$scene.krs --size 48x32 --samples 2 --cache off --quiet -o $scene.exr -o $scene.png
    run render in/$scene.krs --size 48x32 --samples 2 --untrusted --quiet -o $scene-in.exr -o $scene-in.png
    [ "$status" -eq 0 ] && cmp -s $scene.exr $scene-in.exr && cmp -s $scene.png $scene-in.png
    result $? "pictures are the same, byte for byte: $scene"
done
"$krs" pack in/uses.krs --untrusted --quiet -o uses.krsz 2>err && "$krs" pack in/uses.krs --quiet -o outside.krsz && cmp uses.krsz outside.krsz &&
    "$krs" render uses.krsz --untrusted --size 48x32 --samples 2 --quiet -o uses-pack.exr 2>err && cmp uses.exr uses-pack.exr
result $? "packs are made and rendered"
good=0
for words in 'mesh --error 0.2 -o uses%s.stl' 'slice --layer 0.5 -o uses%s.svg' 'grid --cell 0.2 -o uses%s.npy' 'export --to three -o uses%s.three.mjs' \
    'compile -o folder%s'; do
    for where in '' --untrusted; do
        # shellcheck disable=SC2046,SC2086 # words are meant
        run ${words%% *} in/uses.krs --quiet $where $(echo "${words#* }" | sed "s/%s/$where/")
        [ "$status" -eq 0 ] || good=1
    done
done
cmp -s uses.stl uses--untrusted.stl && cmp -s uses.svg uses--untrusted.svg && cmp -s uses.npy uses--untrusted.npy &&
    cmp -s uses.three.mjs uses--untrusted.three.mjs && diff -r folder folder--untrusted >out 2>err && [ $good -eq 0 ]
result $? "so are meshes, sections, grids, exports and shaders"
good=0
for command in check info 'dump --after=graph' 'validate --points 200' 'format --check' query; do
    for where in '' --untrusted; do
        # shellcheck disable=SC2086 # words are meant
        echo '0 0 3 0 0 -1' | "$krs" $command $where in/uses.krs >"said$where" 2>>err || good=1
    done
    [ "$command" = 'validate --points 200' ] || cmp -s said said--untrusted || good=1
done
result $good "other commands say the same"
printf 'surface_equation=x^2+y^2+z^2-1\n' >in/ball.jsurf
"$krs" import in/ball.jsurf >said 2>err && "$krs" import in/ball.jsurf --untrusted >said--untrusted 2>err && cmp -s said said--untrusted &&
    "$krs" import in/ball.jsurf --untrusted -o in/ball.krs 2>err && cmp -s said in/ball.krs
result $? "and so does an import"
