#!/bin/sh
# run.sh [KRS_DEVICE=DEVICE] [JOBS=COUNT] PROGRAM...: runs test programs and scripts, and counts what
# they say in TAP.
#
# A line that begins with `ok` is a test that passed, `not ok` one that failed; one with `# SKIP`
# was skipped.  A program that dies, takes longer than KRS_TEST_SECONDS (120), says nothing, says
# less than its plan (1..N) promised, or fails without saying which test, is one failure more.  What
# a failing program printed is shown.  The last line is `N passed, N failed`, and `, N skipped`
# where some were; the status is 0 if none failed.
#
# KRS_DEVICE is the Vulkan device of the tests, in the words of `krs --device`; none: the one that
# krs takes by itself.  As a word of its own between the programs it holds for those that follow.
#
# As such a word, JOBS is how many of those that follow run at once; none: one after the other.
set -u
. "$(dirname "$0")/support/drivers.sh"

seconds=${KRS_TEST_SECONDS:-120}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
trap 'wait; exit 130' INT TERM
export CMOCKA_MESSAGE_OUTPUT=TAP

# The command keeps shaders in a folder of the tests; the driver goes on using the user's.
export MESA_SHADER_CACHE_DIR="${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-${HOME:-$folder}/.cache}}"
export XDG_CACHE_HOME="$folder/caches"

# Why a finished program counts as a failure beyond its `not ok` lines; nothing if it does not.
fault_of() { # status, tests that did not fail, tests that failed, tests that were planned
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

# Puts the processor seconds of all that this shell has run and waited for into `spent`.
measure() { # a file to write to; a shell within this one, as for a substitution, has run nothing
    times >"$1"
    spent=$(sed -n '2s/[ms]/ /gp' "$1" | awk '{ print 60 * $1 + $2 + 60 * $3 + $4 }')
}

# Runs a program, says how it ended, and notes the counts of its tests.
test_program() { # program, where its output goes
    case $1 in
    */*) command=$1 ;;
    *) command=./$1 ;;
    esac
    measure "$2.times"
    begun=$(date +%s) before=$spent
    timeout -k 5 "$seconds" "$command" >"$2" 2>&1 </dev/null
    status=$?
    took=$(($(date +%s) - begun))
    measure "$2.times"
    took="$took s, $(awk "BEGIN { printf \"%.1f\", $spent - $before }") s of processor"
    skipped=$(grep -cE '^(not )?ok.*# SKIP' "$2") # cmocka says `not ok` of those
    passed=$(grep '^ok' "$2" | grep -cv '# SKIP')
    failed=$(grep '^not ok' "$2" | grep -cv '# SKIP')
    planned=$(sed -n 's/^1\.\.\([0-9][0-9]*\).*/\1/p' "$2" |
        awk '{ sum += $1 } END { print sum + 0 }')
    why=$(fault_of "$status" $((passed + skipped)) "$failed" "$planned")
    [ -n "$why" ] && failed=$((failed + 1))

    if [ "$failed" -gt 0 ]; then
        { echo "==== $1: $failed failed${why:+ ($why)}"; cat "$2"; } >"$2.said"
    else
        echo "     $1: $passed passed$(skips "$skipped") in $took" >"$2.said"
    fi
    cat "$2.said"
    echo "$passed $failed $skipped" >>"$counts"
}

# From now on so many at once.  Who wants to run takes a line of descriptor 3, and puts it back.
set_jobs() { # how many
    wait
    jobs=$1
    rm -f "$folder/places"
    mkfifo "$folder/places"
    exec 3<>"$folder/places"
    yes "" | head -n "$jobs" >&3
}

jobs=1 started=0 counts=$folder/counts
: >"$counts"
for program in "$@"; do
    case $program in
    KRS_DEVICE=*)
        wait
        export KRS_DEVICE="${program#*=}"
        add_driver_of "$KRS_DEVICE" || exit 1
        echo "     on $KRS_DEVICE:"
        continue
        ;;
    JOBS=*)
        set_jobs "${program#*=}"
        continue
        ;;
    esac
    started=$((started + 1))
    if [ "$jobs" -eq 1 ]; then
        test_program "$program" "$folder/$started"
    else
        read -r _ <&3
        { test_program "$program" "$folder/$started"; echo >&3; } &
    fi
done
wait

total_passed=0 total_failed=0 total_skipped=0
while read -r passed failed skipped; do
    total_passed=$((total_passed + passed))
    total_failed=$((total_failed + failed))
    total_skipped=$((total_skipped + skipped))
    started=$((started - 1))
done <"$counts"
total_failed=$((total_failed + started)) # those of which nothing is known

echo "$total_passed passed, $total_failed failed$(skips "$total_skipped")"
[ "$total_failed" -eq 0 ]
