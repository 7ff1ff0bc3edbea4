#!/bin/sh
# sandbox.sh: code that has taken over the process of a stranger's scene tries to get out, by all ways of
# tests/sandbox/escapes.def; where the sandbox has a hole, they are seen.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
rows=$root/tests/sandbox/escapes.def
deadly=$(sed -n 's/^DEADLY(\([a-z_]*\),.*/\1/p' "$rows")
beyond=$(sed -n 's/^BEYOND(\([a-z_]*\),.*/\1/p' "$rows")
refused=$(grep -c '^ESCAPE(' "$rows")
# shellcheck disable=SC2086 # words are meant
tests=$(($(echo $deadly $beyond | wc -w) + 11))
plan "$tests"
need_sandbox "$tests"
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
