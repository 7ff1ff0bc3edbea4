#!/bin/sh
# extend.sh [NAME...]: what should be easy to add is easy to add.
#
# Each NAME.patch here adds one thing and its test to a copy of the tree.  Its first line says how
# many files of the product it may touch, others before the first diff what to run besides:
#     # product files: 2
#     # test: tests/property/ops
# It must apply without fuzz and touch a test.  The copy is built from the objects that are there
# already; then the tests that the patch touches and those of its head are run in it.  Patches that
# do not conflict share a copy, so that what many files include is compiled once; if they do not
# build together, each is built alone.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD build=${B:-build}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
unset MAKEFLAGS MFLAGS MAKELEVEL
cache=""
command -v ccache >/dev/null && cache="ccache "
export CCACHE_NOHASHDIR=1

if [ $# -eq 0 ]; then
    for patch in tests/extend/*.patch; do
        patch=${patch##*/}
        set -- "$@" "${patch%.patch}"
    done
fi

number=0 failed=0
result() { # status, what was tested, a file that says more
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
        return
    fi
    echo "not ok $number - $2"
    [ ! -f "${3:-}" ] || tail -n 20 "$3" | sed 's/^/# /'
    failed=1
}

patch_of() { echo "$root/tests/extend/$1.patch"; }
touched_by() { # name
    sed -n 's,^\(+++ b\|--- a\)/\([^[:space:]]*\).*,\2,p' "$(patch_of "$1")" | sort -u
}
# Commands, a line each.
tests_of() { # name
    {
        for file in $(touched_by "$1"); do
            case $file in
            tests/*.sh) echo "$file" ;;
            tests/*.c) # a program, not what several share
                if [ ! -f "$file" ] || grep -q '^int main' "$file"; then echo "${file%.c}"; fi
                ;;
            esac
        done
        sed -n '/^diff /q; s/^# test: *//p' "$(patch_of "$1")"
    } | sed "s,^tests/[a-z]*/[a-z_]*$,$build/&,"
}
apply() { # name, folder, options
    patch -p1 -F0 -s -f --no-backup-if-mismatch ${3:+"$3"} -d "$2" <"$(patch_of "$1")" >"$work/log" 2>&1
}

# The tree, and of what was built all that is not a program of the tests.
copy_tree() { # folder
    mkdir -p "$1"
    tar -cf - --exclude=./.git --exclude="./$build" . | tar -xf - -C "$1"
    [ -d "$build" ] || return 0
    find "$build" -type d \( -name asan -o -name fuzz -o -name clang \) -prune -o -type f \
        \( -name '*.[oacd]' -o -name '*.spv' -o -name embed -o -name krs \) -print |
        tar -cf - -T - | tar -xf - -C "$1"
}

build_copy() { # folder, names
    folder=$1
    shift
    targets=$(for each in "$@"; do tests_of "$each"; done | grep "^$build/" | sort -u)
    # shellcheck disable=SC2086 # the list is words
    CCACHE_BASEDIR=$folder make --no-print-directory -C "$folder" -j"$(nproc)" B="$build" \
        CC="$cache${CC:-cc}" CXX="$cache${CXX:-g++}" "$build/krs" $targets >"$work/log" 2>&1
}

run_tests() { # folder, name
    tests_of "$2" >"$work/tests"
    if [ ! -s "$work/tests" ]; then
        echo "no test to run" >"$work/log"
        return 1
    fi
    while read -r line; do
        (cd "$1" && B=$build KRS=$build/krs CMOCKA_MESSAGE_OUTPUT=TAP sh -c "$line") \
            </dev/null >"$work/log" 2>&1 || return 1
    done <"$work/tests"
}

# Builds and tests some in one copy.
try() { # names
    copy=$work/copy
    rm -rf "$copy"
    copy_tree "$copy"
    for name in "$@"; do
        apply "$name" "$copy"
    done
    if build_copy "$copy" "$@"; then
        for name in "$@"; do
            result 0 "$name builds"
            run_tests "$copy" "$name"
            result $? "$name passes its test" "$work/log"
        done
    elif [ $# -eq 1 ]; then
        result 1 "$1 builds" "$work/log"
    else
        for name in "$@"; do
            try "$name"
        done
    fi
}

# ---- what the patches say ----
left=""
for name in "$@"; do
    stated=$(sed -n '1s/^# product files: \([0-9][0-9]*\)$/\1/p' "$(patch_of "$name")")
    files=$(touched_by "$name" | grep -cE '^(include/|compiler/|mesh/|slice/|grid/|measure/|runtime/|api/|import/|live/|cli/|Makefile$)')
    [ "$files" -le "${stated:--1}" ]
    result $? "$name touches $files files of the product, ${stated:-none} at most"
    touched_by "$name" | grep -q '^tests/'
    result $? "$name has a test"
    apply "$name" "$root" --dry-run
    status=$?
    result $status "$name applies" "$work/log"
    [ $status -ne 0 ] || left="$left $name"
done

# ---- as many at once as there is no conflict between ----
while [ -n "$left" ]; do
    together="" later=""
    trial=$work/trial
    rm -rf "$trial"
    mkdir "$trial"
    for name in $left; do
        for file in $(touched_by "$name"); do # patch needs to see no others
            if [ -f "$file" ] && [ ! -f "$trial/$file" ]; then
                mkdir -p "$trial/$(dirname "$file")"
                cp -p "$file" "$trial/$file"
            fi
        done
        if apply "$name" "$trial" --dry-run; then
            apply "$name" "$trial"
            together="$together $name"
        else
            later="$later $name"
        fi
    done
    if [ -z "$together" ]; then
        result 1 "these apply to what they touch:$later"
        break
    fi
    # shellcheck disable=SC2086 # the list is words
    try $together
    left=$later
done

# ---- what makes it easy ----
# What is known of operations stands in columns of ops.def, and all are evaluated by those.  Only lengths of vectors have a
# loop of their own.
grep -rnE 'case OP_[A-Za-z0-9_]+:' compiler mesh slice grid measure runtime api import live cli --include='*.[ch]' |
    grep -vE '^compiler/graph/lanes/lane_loop.h:.*case OP_length:' >"$work/log"
[ ! -s "$work/log" ]
result $? "no switch lists operations" "$work/log"
echo "1..$number"
exit $failed
