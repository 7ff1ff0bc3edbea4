#!/bin/sh
# run_selftest.sh: the runner notices tests that fail, crash, hang, or are not run at all.
set -u
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
number=0

program() { # name; the script is read from standard input
    { echo '#!/bin/sh'; cat; } >"$work/$1"
    chmod +x "$work/$1"
}

# The runner's last line and whether it succeeds, for some of the programs.
expect() { # what, last line, status, programs...
    number=$((number + 1))
    what=$1 last=$2 wanted=$3
    shift 3
    (cd "$work" && env -u KRS_DEVICE -u VK_ADD_DRIVER_FILES KRS_TEST_SECONDS=2 "$here/run.sh" "$@") >"$work/output" 2>&1
    status=$?
    if [ "$(tail -n 1 "$work/output")" = "$last" ] && [ "$status" -eq "$wanted" ]; then
        echo "ok $number - $what"
    else
        echo "not ok $number - $what"
        sed 's/^/# /' "$work/output"
    fi
}

program good <<'END'
echo 1..2; echo 'ok 1 - a'; echo 'ok 2 - b'
END
program failing <<'END'
echo 1..2; echo 'not ok 1 - a'; echo 'ok 2 - b'; exit 1
END
program lenient <<'END'
echo 'not ok 1 - a'; exit 0
END
program crashing <<'END'
echo 'ok 1 - a'; kill -SEGV $$
END
program crashing_later <<'END'
echo 'not ok 1 - a'; kill -ABRT $$
END
program hanging <<'END'
echo 'ok 1 - a'; exec sleep 60
END
program silent <<'END'
exit 0
END
program stopping <<'END'
echo 1..3; echo 'ok 1 - a'; exit 0
END
program muttering <<'END'
echo 'ok 1 - a'; exit 3
END

program skipping <<'END'
echo 1..3; echo 'ok 1 - a'; echo 'not ok 2 # SKIP b'; echo 'ok 3 - c # SKIP no card'
END
program skipping_all <<'END'
echo 1..1; echo 'ok 1 - a # SKIP no card'
END
program skipping_and_failing <<'END'
echo 1..2; echo 'ok 1 - a # SKIP no card'; echo 'not ok 2 - b'; exit 1
END
program skipping_and_dying <<'END'
echo 1..2; echo 'ok 1 - a # SKIP no card'; exit 3
END
program on_a_card <<'END'
[ "${KRS_DEVICE:-}" = "Card of mine" ] && echo 'ok 1 - a'
END
program on_swiftshader <<'END'
case ${VK_ADD_DRIVER_FILES:-} in
*swiftshader*) echo 'ok 1 - a' ;;
*) echo 'not ok 1 - a' ;;
esac
END
# Each waits for the other.
program meeting <<'END'
if mkdir met 2>/dev/null; then until [ -e met/other ]; do sleep 0.1; done; else touch met/other; fi
echo 'ok 1 - a'
END
# Counts itself among those that run, three at most.
program one_of_three <<'END'
touch "running.$$"
sleep 0.3
set -- running.*
if [ $# -le 3 ]; then echo 'ok 1 - a'; else echo 'not ok 1 - a'; fi
rm "running.$$"
END
program alone <<'END'
sleep 0.1
set -- running.*
if [ -e "$1" ]; then echo 'not ok 1 - a'; else echo 'ok 1 - a'; fi
END

echo 1..25
expect 'tests that pass' '2 passed, 0 failed' 0 good
expect 'results are added up' '4 passed, 0 failed' 0 good ./good
expect 'a test that fails' '1 passed, 1 failed' 1 failing
expect 'a failure with status 0' '0 passed, 1 failed' 1 lenient
expect 'a crash' '1 passed, 1 failed' 1 crashing
expect 'a crash after a failure' '0 passed, 2 failed' 1 crashing_later
expect 'a program that hangs' '1 passed, 1 failed' 1 hanging
expect 'a program without a test' '0 passed, 1 failed' 1 silent
expect 'a program that stops early' '1 passed, 1 failed' 1 stopping
expect 'a status nobody explains' '1 passed, 1 failed' 1 muttering
expect 'a program that does not exist' '0 passed, 1 failed' 1 missing
expect 'one failure among many' '5 passed, 1 failed' 1 good failing good
expect 'tests that are skipped' '1 passed, 0 failed, 2 skipped' 0 skipping
expect 'nothing but skipped tests' '0 passed, 0 failed, 1 skipped' 0 skipping_all
expect 'a failure among skipped tests' '0 passed, 1 failed, 1 skipped' 1 skipping_and_failing
expect 'skipped tests do not excuse an end' '0 passed, 1 failed, 1 skipped' 1 skipping_and_dying
expect 'skipped tests are added up' '3 passed, 0 failed, 3 skipped' 0 skipping good skipping_all
expect 'a device for what follows' '1 passed, 1 failed' 1 on_a_card 'KRS_DEVICE=Card of mine' \
    on_a_card
expect 'a driver that only tests know' '1 passed, 1 failed' 1 on_swiftshader \
    KRS_DEVICE=SwiftShader on_swiftshader
expect 'a driver for an index' '0 passed, 1 failed' 1 KRS_DEVICE=0 on_swiftshader
expect 'programs side by side' '2 passed, 0 failed' 0 JOBS=2 meeting meeting
expect 'no more at once than wanted' '9 passed, 0 failed' 0 JOBS=3 one_of_three one_of_three \
    one_of_three one_of_three one_of_three one_of_three one_of_three one_of_three one_of_three
expect 'failures among programs side by side' '4 passed, 4 failed, 1 skipped' 1 JOBS=3 failing \
    crashing good crashing_later skipping_all
expect 'one after the other again' '3 passed, 0 failed' 0 JOBS=3 one_of_three one_of_three JOBS=1 \
    alone
expect 'no device before its programs' '3 passed, 0 failed' 0 JOBS=3 one_of_three one_of_three \
    'KRS_DEVICE=Card of mine' on_a_card
