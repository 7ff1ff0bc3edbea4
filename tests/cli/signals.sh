#!/bin/sh
# signals.sh: what stops the command, or warns it, and that times are those of work.
# shellcheck source-path=SCRIPTDIR disable=SC2086
. "$(dirname "$0")/common.sh"
plan 13

echo 'show sphere(1);' >ball.krs
echo 0 0 0 >points
child_of() { ps -o pid= --ppid "$1" | tr -d ' '; }
state_of() { ps -o stat= -p "$1" | cut -c 1; }

# Waits until a process has a child, and that has entered a stage which does not end.
wait_for_child() { # process
    tries=0
    until [ -n "$(child_of "$1")" ] || [ $tries -ge 500 ]; do
        tries=$((tries + 1))
        sleep 0.02
    done
    sleep 0.3
}

# ---- SIGUSR1 ----

# Commands that compile for ever, but for their deadline.
for words in "check ball.krs" "render ball.krs -o a.png" "mesh ball.krs -o a.stl" "info ball.krs" \
    "validate ball.krs" "compile ball.krs -o out" "query ball.krs"; do
    KRS_TEST_CRASH=compile:hang "$krs" $words --deadline 2 >out 2>err <points &
    process=$!
    wait_for_child $process
    kill -s USR1 $process "$(child_of $process)"
    wait $process
    status=$?
    said 1 "gave up compiling the scene" "SIGUSR1 changes nothing in \`krs ${words%% *}\`"
done
"$krs" watch ball.krs -o watched.png --size 8x8 >out 2>err </dev/null &
process=$! tries=0
until grep -q wrote err || [ $tries -ge 600 ]; do
    tries=$((tries + 1))
    sleep 0.1
done
kill -s USR1 $process "$(child_of $process)"
sleep 0.5
kill -s TERM $process
wait $process
status=$?
ended 0 "nor in \`krs watch\`, which SIGTERM ends"

cat >room.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0] }
show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);
END
how="room.krs --integrator path --size 160x120 --samples 4096 --resume -o part.png"
KRS_TEST_CHECKPOINT=0.1 "$krs" render $how >out 2>err </dev/null &
process=$!
wait_for_child $process # perhaps there is no checkpoint yet
kill -s USR1 $process
wait $process
status=$?
[ "$status" -eq 75 ] && grep -q "the same command goes on" err && [ -s part.png.part ] && [ ! -e part.png ]
result $? "SIGUSR1 ends a render with --resume as soon as there is a checkpoint"

# ---- processes that are stopped ----

KRS_TEST_CRASH=compile:hang "$krs" check --deadline 2 ball.krs >out 2>err &
process=$!
wait_for_child $process
child=$(child_of $process)
kill -s STOP "$child"
sleep 4
kill -s 0 "$child" 2>/dev/null
result $? "a process that is stopped is not late"
kill -s CONT "$child"
wait $process
status=$?
said 1 "gave up compiling the scene" "it is, once it goes on without progress"

KRS_TEST_CRASH=compile:hang env --default-signal=TSTP "$krs" check --deadline 2 ball.krs >out 2>err &
process=$!
wait_for_child $process
child=$(child_of $process)
kill -s TSTP $process
sleep 3
[ "$(state_of $process)" = T ] && [ "$(state_of "$child")" = T ]
result $? "SIGTSTP stops both processes"
kill -s CONT $process
sleep 0.3
running=$(state_of "$child")
wait $process
status=$?
[ "$running" = S ] && [ "$status" -eq 1 ] && grep -q "gave up" err
result $? "and SIGCONT continues both"
