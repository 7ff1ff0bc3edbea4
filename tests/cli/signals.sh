#!/bin/sh
# signals.sh: what stops the command, or warns it, and that times are those of work.
# shellcheck source-path=SCRIPTDIR disable=SC2086
. "$(dirname "$0")/common.sh"
plan 20

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
: >err
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

# Nobody could continue a group of processes that has no parent in its session: the system stops none of them.
env --default-signal=TSTP sleep 5 &
process=$!
sleep 0.2
kill -s TSTP $process
sleep 0.2
stops=$(state_of $process)
kill -s KILL $process
wait $process 2>/dev/null
if [ "$stops" = T ]; then
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
else
    skip "SIGTSTP stops both processes" "this group of processes cannot be stopped"
    skip "and SIGCONT continues both" "this group of processes cannot be stopped"
fi

# ---- watching goes on ----

said_times() { grep -c "$1" err; }
wait_for() { # words, how often
    tries=0
    until [ "$(said_times "$1")" -ge "$2" ] || [ $tries -ge 600 ] || ! kill -s 0 $process 2>/dev/null; do
        tries=$((tries + 1))
        sleep 0.1
    done
    [ "$(said_times "$1")" -ge "$2" ]
}
finish() {
    kill -s TERM $process
    wait $process
    status=$?
}
cp ball.krs watched.krs
: >err
"$krs" watch watched.krs -o watched.png --size 8x8 --limit time=20 >out 2>err </dev/null &
process=$!
wait_for wrote 1
sleep 22
echo 'show sphere(0.9);' >watched.krs
wait_for wrote 2
result $? "a limit of time does not count waiting"
rm watched.krs
mkfifo watched.krs
wait_for "no file, but a pipe or a device" 1
result $? "a pipe in the place of the scene is said"
rm watched.krs
ln -s /dev/zero watched.krs
wait_for "no file, but a pipe or a device" 2
result $? "and a device"
rm watched.krs
echo 'show sphere(0.8);' >watched.krs
wait_for wrote 3
result $? "and a file there is rendered"
finish
ended 0 "until it is ended"
: >err
KRS_TEST_CRASH=compile:hang "$krs" watch watched.krs -o watched.png --size 8x8 --deadline 1 >out 2>err </dev/null &
process=$!
wait_for "gave up compiling the scene after 1 seconds" 1
sleep 3
[ "$(said_times "gave up")" -eq 1 ] && kill -s 0 $process
result $? "a scene that takes too long is said once, and watching goes on"
echo 'show sphere(0.7);' >watched.krs
wait_for "gave up compiling the scene after 1 seconds" 2
result $? "the next text is tried"
finish
