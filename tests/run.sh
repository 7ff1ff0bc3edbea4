#!/bin/sh
# run.sh [KRS_DEVICE=DEVICE] PROGRAM...: runs test programs and scripts, and counts what they say
# in TAP.
#
# A line that begins with `ok` is a test that passed, `not ok` one that failed; one with `# SKIP`
# was skipped.  A program that dies, takes longer than KRS_TEST_SECONDS (120), says nothing, says
# less than its plan (1..N) promised, or fails without saying which test, is one failure more.  What
# a failing program printed is shown.  The last line is `N passed, N failed`, and `, N skipped`
# where some were; the status is 0 if none failed.
#
# KRS_DEVICE is the Vulkan device of the tests, in the words of `krs --device`; none: the one that
# krs takes by itself.  As a word of its own between the programs it holds for those that follow.
set -u
. "$(dirname "$0")/support/drivers.sh"

seconds=${KRS_TEST_SECONDS:-120}
folder=$(mktemp -d) || exit 1
output=$folder/output
trap 'rm -rf "$folder"' EXIT
trap 'exit 130' INT TERM
export CMOCKA_MESSAGE_OUTPUT=TAP

# The command keeps shaders in a folder of the tests; the driver goes on using the user's.
export MESA_SHADER_CACHE_DIR="${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-${HOME:-$folder}/.cache}}"
export XDG_CACHE_HOME="$folder/caches"

# Why a finished program counts as a failure beyond its `not ok` lines; nothing if it does not.
complaint() { # status, tests that did not fail, tests that failed, tests that were planned
    if [ "$1" -eq 124 ] || { [ "$1" -eq 137 ] && [ "$3" -ne 137 ]; }; then
        echo "took longer than $seconds seconds, or was killed"
    elif [ "$1" -ge 125 ] && [ "$1" -ne "$3" ]; then
        echo "died with status $1"
    elif [ $(($2 + $3)) -eq 0 ]; then
        echo "ran no test"
    elif [ $(($2 + $3)) -lt "$4" ]; then
        echo "stopped after $(($2 + $3)) of $4 tests"
    elif [ "$1" -ne 0 ] && [ "$3" -eq 0 ]; then
        echo "ended with status $1 though no test failed"
    fi
}

skips() { # how many
    [ "$1" -eq 0 ] || echo ", $1 skipped"
}

total_passed=0 total_failed=0 total_skipped=0
for program in "$@"; do
    case $program in
    KRS_DEVICE=*)
        export KRS_DEVICE="${program#*=}"
        add_driver_of "$KRS_DEVICE" || exit 1
        echo "     on $KRS_DEVICE:"
        continue
        ;;
    */*) command=$program ;;
    *) command=./$program ;;
    esac
    begun=$(date +%s)
    timeout -k 5 "$seconds" "$command" >"$output" 2>&1 </dev/null
    status=$?
    took=$(($(date +%s) - begun))
    skipped=$(grep -cE '^(not )?ok.*# SKIP' "$output") # cmocka says `not ok` of those
    passed=$(grep '^ok' "$output" | grep -cv '# SKIP')
    failed=$(grep '^not ok' "$output" | grep -cv '# SKIP')
    planned=$(sed -n 's/^1\.\.\([0-9][0-9]*\).*/\1/p' "$output" |
        awk '{ sum += $1 } END { print sum + 0 }')
    why=$(complaint "$status" $((passed + skipped)) "$failed" "$planned")
    [ -n "$why" ] && failed=$((failed + 1))

    if [ "$failed" -gt 0 ]; then
        echo "==== $program: $failed failed${why:+ ($why)}"
        cat "$output"
    else
        echo "     $program: $passed passed$(skips "$skipped") in $took s"
    fi
    total_passed=$((total_passed + passed))
    total_failed=$((total_failed + failed))
    total_skipped=$((total_skipped + skipped))
done

echo "$total_passed passed, $total_failed failed$(skips "$total_skipped")"
[ "$total_failed" -eq 0 ]
