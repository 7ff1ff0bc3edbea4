#!/bin/sh
# failures.sh: crashes, interrupts, missing devices and missing memory.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 40
small="--size 16x12 --quiet"

for stage in start compile shaders device render write; do
    printf old >kept.exr
    # shellcheck disable=SC2086
    KRS_TEST_CRASH=$stage "$krs" render ball.krs $small -o kept.exr >out 2>err
    status=$?
    [ "$status" -eq 70 ] && grep -q '^krs: crashed while .*SIGSEGV' err &&
        [ "$(wc -l <err)" -eq 1 ] && [ "$(cat kept.exr)" = old ] && no_temporaries
    result $? "a crash in stage $stage is reported and leaves the old file"
done

kept=$(sed -n 's/.*see it again is in //p' err)
[ -n "$kept" ] && cmp -s "$kept"/1-ball.krs ball.krs && grep -q "'kept.exr'" "$kept"/command.txt
result $? "scene and command line of a crash are kept"
for signal in ABRT:6 BUS:7 FPE:8 ILL:4; do
    KRS_TEST_CRASH=compile:${signal#*:} "$krs" check ball.krs >out 2>err
    status=$?
    said 70 "SIG${signal%:*}" "death by SIG${signal%:*}"
done
KRS_TEST_CRASH=render:9 "$krs" render ball.krs --quiet -o a.exr >out 2>err
status=$?
said 71 "probably for want of memory" "killed by the system"
KRS_TEST_CRASH=compile:hang "$krs" check --deadline 0.3 ball.krs >out 2>err
status=$?
said 1 "gave up compiling the scene after 0.3 seconds: \`ball.krs\` has 189 bytes" \
    "compiling that does not end"
grep -q -- '--deadline SECONDS allows it longer' err && ! grep -q bug err
result $? "how to give it more time is said, and that it is a bug is not"
KRS_TEST_CRASH=shaders:hang "$krs" render --quiet --deadline 2 ball.krs -o a.exr >out 2>err
status=$?
said 1 "bytes of distance code in 2 components; --deadline" "compiling shaders that does not end"
KRS_TEST_CRASH=device:hang "$krs" render --quiet --deadline 2 ball.krs -o a.exr >out 2>err
status=$?
said 70 "gave up starting the device after 2 seconds without progress" "a device that does not start"

without_driver() { # arguments of krs
    VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent VK_ADD_DRIVER_FILES="" \
        "$krs" "$@" >out 2>err
    status=$?
}
without_driver render ball.krs
[ "$status" -eq 69 ] && [ -s err ] && [ ! -e ball.exr ]
result $? "no Vulkan driver"
without_driver devices
said 69 "no Vulkan device" "no device to list"
# A driver that says of itself that it does not have all of Vulkan, as those of macOS do.
lavapipe=
for driver in /usr/share/vulkan/icd.d/lvp_icd*.json; do
    [ -e "$driver" ] && lavapipe=$driver
done
if [ -n "$lavapipe" ]; then
    sed 's/"ICD": *{/&"is_portability_driver": true, /' "$lavapipe" >portability.json
    VK_DRIVER_FILES=$work/portability.json VK_ADD_DRIVER_FILES="" KRS_DEVICE="" \
        "$krs" render ball.krs --quiet --size 8x8 -o portability.png >out 2>err
    status=$?
    ended 0 "a driver that does not have all of Vulkan"
else
    skip "a driver that does not have all of Vulkan" "there is no lavapipe"
fi
run render ball.krs --device 'No Such Card'
said 69 "No Such Card" "an unknown device"
KRS_DEVICE='No Such Card' "$krs" render ball.krs >out 2>err
status=$?
said 69 "No Such Card" "an unknown device from the environment"
KRS_DEVICE='No Such Card' "$krs" render ball.krs --quiet --size 8x8 --device 0 -o device.png \
    >out 2>err
result $? "--device is stronger than the environment"
run render ball.krs --device 'No Such Card' --exit-map 71=33,69=99
ended 99 "--exit-map translates"
run check missing.krs --exit-map 71=33
ended 74 "--exit-map leaves other statuses alone"

# Signals.  `env` undoes what a shell may have done to background processes.
long_render() {
    : >err # what an earlier one said
    env --default-signal=INT "$krs" render ball.krs --size 4000x4000 --samples 4096 -o kept.exr \
        >out 2>err &
    process=$!
    waited=0
    until grep -q Progress err || [ "$waited" -ge 600 ] || ! kill -0 "$process" 2>/dev/null; do
        sleep 0.1
        waited=$((waited + 1))
    done
}
for signal in INT TERM; do
    printf old >kept.exr
    long_render
    kill -s "$signal" "$process"
    wait "$process"
    status=$?
    [ "$status" -eq 130 ] && grep -q '^krs: interrupted' err && [ "$(cat kept.exr)" = old ] &&
        no_temporaries
    result $? "SIG$signal while rendering"
done
grep '^Progress: [0-9]*%$' err >lines && [ "$(wc -l <lines)" -ge 1 ]
result $? "progress on a pipe is plain lines"
# shellcheck disable=SC2086
KRS_TEST_CRASH=write:2 "$krs" render ball.krs $small -o kept.exr >out 2>err
status=$?
[ "$status" -eq 130 ] && [ "$(cat kept.exr)" = old ] && no_temporaries
result $? "SIGINT while writing"
# shellcheck disable=SC2086
if strace -o /dev/null true 2>/dev/null; then
    strace -f -o /dev/null -e trace=pwrite64 -e inject=pwrite64:signal=KILL:when=1 \
        "$krs" render ball.krs $small -o kept.exr >out 2>err
    status=$?
    [ "$status" -eq 71 ] && [ "$(cat kept.exr)" = old ] && no_temporaries
    result $? "SIGKILL while writing"
else
    skip "SIGKILL while writing" "no strace, or no right to use it"
fi

# A signal that is ignored from the start, as by nohup, changes nothing.
(
    trap '' HUP
    KRS_TEST_CRASH=compile:hang exec "$krs" check --deadline 3 ball.krs >out 2>err
) &
process=$!
sleep 1
kill -s HUP "$process"
wait "$process"
status=$?
said 1 "gave up compiling the scene after 3 seconds" "an ignored SIGHUP stays ignored"

# Threads that cannot be made: at once, or when the driver has begun.  Nothing waits for them.
if "${CC:-cc}" -std=c17 -D_GNU_SOURCE -shared -fPIC -o few.so "$root/tests/cli/few_threads.c" \
    2>/dev/null; then
    # shellcheck disable=SC2086
    FEW_THREADS=0 LD_PRELOAD=./few.so "$krs" render ball.krs $small --device cpu -o a.exr >out 2>err
    status=$?
    [ "$status" -eq 71 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q 'threads, of which the system' err
    result $? "no thread can be made"
    needed=$(sed -n 's/.*makes \([0-9]*\) threads.*/\1/p' err)
    # shellcheck disable=SC2086
    FEW_THREADS=$((needed + 1)) LD_PRELOAD=./few.so "$krs" render ball.krs $small --device cpu \
        --deadline 2 -o a.exr >out 2>err
    status=$?
    [ "$status" -ne 0 ] && [ "$status" -ne 130 ] && [ "$(wc -l <err)" -eq 1 ] &&
        grep -q 'not finished a step within 10 seconds\|gave up' err
    result $? "a device whose threads are missing is given up"
else
    skip "no thread can be made" "no compiler"
    skip "a device whose threads are missing is given up" "no compiler"
fi

# Some of the allocations of a run fail, one each time: it is done all the same, or ends with 71, a last line of
# ours, and no file.
scarce() { # what is tested; how many times; arguments of krs
    tested=$1 times=$2 bad=0 tried=0
    shift 2
    SCARCE_COUNT=7 LD_PRELOAD=./scarce.so "$krs" "$@" 7>count >out 2>err
    made=$(head -n 1 count)
    while [ $tried -lt "$times" ]; do
        tried=$((tried + 1))
        rm -f scarce.3mf scarce.glb
        at=$((made - made * (times - tried) * (times - tried) / (times * times))) # more at the end
        SCARCE_AT=$at LD_PRELOAD=./scarce.so "$krs" "$@" >out 2>err
        status=$?
        [ $status -eq 0 ] || { [ $status -eq 71 ] && tail -n 1 err | grep -q '^krs: .*memory' &&
            [ ! -e scarce.3mf ] && [ ! -e scarce.glb ]; } || bad=$at
        [ "$bad" -eq 0 ] || break
    done
    [ "$bad" -eq 0 ] && no_temporaries
    result $? "$tested"
}
echo 'show text("A").extrude(0.3);' >letter.krs
if "${CC:-cc}" -std=c17 -D_GNU_SOURCE -shared -fPIC -o scarce.so "$root/tests/cli/scarce_malloc.c" \
    2>/dev/null; then
    scarce "allocations that fail where a font is found" 60 check letter.krs --deadline 5
    scarce "allocations that fail where a 3MF file is written" 16 \
        mesh ball.krs --error 0.2 --quiet -o scarce.3mf
    scarce "allocations that fail where a GLB file is written" 16 \
        mesh ball.krs --error 0.2 --quiet -o scarce.glb
else
    skip "allocations that fail where a font is found" "no compiler"
    skip "allocations that fail where a 3MF file is written" "no compiler"
    skip "allocations that fail where a GLB file is written" "no compiler"
fi

if strace -o /dev/null true 2>/dev/null; then
    strace -o /dev/null -e trace=clone -e inject=clone:error=EAGAIN:when=1 "$krs" check ball.krs \
        >out 2>err
    status=$?
    said 71 "cannot start a process" "no process can be made"
else
    skip "no process can be made" "no strace, or no right to use it"
fi
(
    # shellcheck disable=SC3045
    ulimit -v 150000
    # shellcheck disable=SC2086
    "$krs" render ball.krs $small --device cpu -o a.exr >out 2>err
)
status=$?
[ "$status" -eq 71 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q 'memory' err
result $? "no memory for a driver to start"

# Nine megabytes of text; the command itself needs far less than the limit.
awk 'BEGIN { for (i = 0; i < 300000; i++) printf "let a%d = [%d, %d, %d];\n", i, i, i, i }' >big.krs
(
    # shellcheck disable=SC3045 # dash, bash and ksh have it
    ulimit -v 120000
    "$krs" check big.krs >out 2>err
)
status=$?
said 71 "out of memory" "a scene that does not fit into memory"
(
    # shellcheck disable=SC3045
    ulimit -v 3000000
    KRS_TEST_CRASH=shaders "$krs" render ball.krs --quiet -o a.exr >out 2>err
)
status=$?
said 71 "probably for want of memory: \`ulimit -v\` allows 2929 MiB" "a crash where memory is limited"
(
    # shellcheck disable=SC3045
    ulimit -t 1
    "$krs" render ball.krs --quiet --size 4000x4000 --samples 4096 -o a.exr >out 2>err
)
status=$?
said 130 "\`ulimit -t\` allows is used up" "processor time that is used up"
