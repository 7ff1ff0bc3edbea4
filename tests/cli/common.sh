# shellcheck shell=sh
# common.sh: what the tests of the command share; sourced, not run.
#
# $KRS is the command (build/krs otherwise).  Each script works in a folder of its own, $work,
# which is also TMPDIR, and announces its number of tests with `plan`.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
krs=${KRS:-$root/build/krs}
case $krs in /*) ;; *) krs=$PWD/$krs ;; esac
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir tmp
export TMPDIR="$work/tmp"
unset KRS_TEST_CRASH NO_COLOR
number=0 status=0

plan() { echo "1..$1"; }

# Prints the result of the command before it: result $? "what was tested".
result() {
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
        return
    fi
    echo "not ok $number - $2"
    echo "# status $status"
    sed 's/^/# out: /' out | head -n 5
    sed 's/^/# err: /' err | head -n 5
}

skip() {
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}

# Runs the command; what it prints goes to the files out and err.
run() {
    "$krs" "$@" >out 2>err </dev/null
    status=$?
}

# Compiles a program of this folder that reads OpenEXR.
compile_exr() { # its name
    # shellcheck disable=SC2046 # words are meant
    "${CC:-cc}" -std=c17 -D_GNU_SOURCE -o "$1" "$root/tests/cli/$1.c" \
        $(pkg-config --silence-errors --cflags OpenEXR) -lOpenEXRCore -lm || exit 1
}

# The last run ended with this status and said these words: said 74 "words" "what was tested".
said() {
    [ "$status" -eq "$1" ] && grep -qF -- "$2" err
    result $? "$3"
}

# The last run ended with this status.
ended() {
    [ "$status" -eq "$1" ]
    result $? "$2"
}

# Whether standard input is JSON.
is_json() {
    if command -v python3 >/dev/null; then
        python3 -c 'import json, sys
for line in sys.stdin: json.loads(line)'
    elif command -v jq >/dev/null; then
        jq . >/dev/null
    else
        grep -q '^{.*}$'
    fi
}

# No temporary file is left in the current folder.
no_temporaries() {
    for file in .krs-*; do
        [ -e "$file" ] && return 1
    done
    return 0
}

cat >ball.krs <<'END'
param radius = 1 in [0.5, 1.5];
camera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }
camera side { eye: [5, 0, 0], target: [0, 0, 0], fov: 40deg }
let ball = sphere(radius);
show ball;
END

# Sets $untrusted to the option for scenes of strangers: where the system has no sandbox, that of limits alone.
find_untrusted() {
    untrusted=--untrusted
    run check --untrusted ball.krs
    [ "$status" -ne 69 ] || untrusted=--untrusted=limits
}

# Ends a script whose tests are of the sandbox where the system has none.
need_sandbox() { # number of tests
    find_untrusted
    [ "$untrusted" = --untrusted ] && return
    while [ "$number" -lt "$1" ]; do skip "the sandbox" "$(cat err)"; done
    exit 0
}
