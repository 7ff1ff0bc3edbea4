#!/bin/sh
# vulkan_faults.sh: calls of Vulkan that fail, by a layer that lets the n-th one fail (tests/support/vulkan_faults.c).
#
# A run ends with the picture of an undisturbed one, or with one line, a status and no file.  Who marches rays is said, as
# roundings of shaders and lanes differ.  Every STRIDE-th call of a
# small render fails, by one of the results in turn; all do with STRIDE=1.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
export XDG_CACHE_HOME="$work/caches"
lost=-4 out_of_device_memory=-2 out_of_host_memory=-1 timeout=2

mkdir layer
if ! "${CC:-cc}" -std=c17 -D_GNU_SOURCE -shared -fPIC -o layer/vulkan_faults.so \
    "$root/tests/support/vulkan_faults.c" 2>err; then
    echo "1..0 # SKIP no compiler, or no headers of Vulkan's layers"
    exit 0
fi
cp "$root/tests/support/vulkan_faults.json" layer
plan 27

cat >moving.krs <<'END'
camera { eye: [0, 1, 5], target: [0, 0, 0], fov: 40deg, shutter: [0, 0.5], aperture: 0.05 }
light lamp { direction: [-0.5, 1, 0.6], intensity: 2.5 }
light sun { direction: [0.5, 1, 0.6], intensity: 1.5 }
material red { color: [0.8, 0.2, 0.1] }
show sphere(1).move([0.4 * sin(time), 0, 0]).paint(red);
show box([6, 0.1, 6]).move([0, -1.1, 0]);
END

# Renders to a.exr while a call fails, or none: "".
faulty() { # the fault, arguments
    fault=$1
    shift
    rm -f log a.exr
    VK_LAYER_PATH=$work/layer VK_INSTANCE_LAYERS=VK_LAYER_KRS_faults KRS_VULKAN_FAULT_LOG=$work/log \
        KRS_VULKAN_FAULT=$fault timeout 60 "$krs" render "$@" --rays "${rays:-kernels}" --quiet -o a.exr >out 2>err </dev/null
    status=$?
}
count() { sed -n "s/^$1 \([0-9]*\).*/\1/p" log; }
failed() { [ "$(sed -n 's/^any .* failed //p' log)" -ge "$1" ]; }

# The last run has ended by what it said, and left nothing behind.
ended_clearly() {
    [ "$status" -gt 0 ] && [ "$status" -lt 124 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q '^krs: ' err &&
        ! grep -q 'crashed' err && [ ! -e a.exr ] && no_temporaries
}

small="ball.krs --size 32x24 --samples 4"
# shellcheck disable=SC2086
"$krs" render $small --rays kernels --quiet -o ball.exr >out 2>err
# shellcheck disable=SC2086
faulty "" $small
[ "$status" -eq 0 ] && cmp -s a.exr ball.exr && ! failed 1 && [ "$(count any)" -gt 400 ]
result $? "the layer sees the calls of a render, and changes nothing"
calls=$(count any) submissions=$(count vkQueueSubmit)
for call in vkCreateInstance vkCreateDevice; do
    # shellcheck disable=SC2086
    faulty $call:1:-3 $small
    ended_clearly && failed 1
    result $? "a driver that does not start: $call fails, and that is told"
done

# In the middle of a frame.
for fault in vkQueueSubmit:$lost vkWaitForFences:$lost vkGetQueryPoolResults:$lost \
    vkQueueSubmit:$out_of_device_memory vkWaitForFences:$out_of_device_memory \
    vkQueueSubmit:$out_of_host_memory vkResetFences:$out_of_device_memory vkWaitForFences:$timeout; do
    # shellcheck disable=SC2086
    faulty "${fault%:*}:$((submissions / 2)):${fault#*:}" $small
    [ "$status" -eq 0 ] && failed 1 && cmp -s a.exr ball.exr
    result $? "the same picture although $fault in its middle"
done

# Films of all kinds.  The first render of each makes more calls, for shaders that are compiled.
while read -r what arguments; do
    # shellcheck disable=SC2086
    faulty "" moving.krs --size 32x24 $arguments
    mv a.exr whole.exr
    # shellcheck disable=SC2086
    faulty "any:$(($(count any) * 6 / 10)):$lost" moving.krs --size 32x24 $arguments
    [ "$status" -eq 0 ] && failed 1 && cmp -s a.exr whole.exr
    result $? "the same picture although a device is lost: $what"
done <<'END'
motion --samples 4
paths --samples 3 --integrator path
mattes --samples 4 --cryptomatte
noise --samples 24 --noise 0.1
noise-with-mattes --samples 17 --noise 0.1 --cryptomatte
lights --samples 3 --light-groups
blocks --samples 66 --size 16x12
END

# A film goes on from what the host has.
faulty "" ball.krs --size 32x24 --samples 24 --cryptomatte
all=$(count vkQueueSubmit)
mv a.exr whole.exr
faulty "vkQueueSubmit:$((all * 9 / 10)):$lost" ball.krs --size 32x24 --samples 24 --cryptomatte
[ "$status" -eq 0 ] && cmp -s a.exr whole.exr && [ "$(count vkQueueSubmit)" -lt $((all * 3 / 2)) ]
result $? "a film goes on from the samples that the host has"

# Lost so often that bands are smaller than the picture; lanes of the host as well.
for rays in kernels lanes; do
    faulty "" moving.krs --size 200x150 --samples 16 --cryptomatte
    mv a.exr whole.exr
    faulty "vkQueueSubmit:$(($(count vkQueueSubmit) / 3)):$lost:8:80" moving.krs --size 200x150 --samples 16 --cryptomatte
    [ "$status" -eq 0 ] && failed 7 && cmp -s a.exr whole.exr
    result $? "the same picture although a device is lost again in other samples: $rays"
done
rays=kernels

# Again and again.
printf old >kept.exr
# shellcheck disable=SC2086
VK_LAYER_PATH=$work/layer VK_INSTANCE_LAYERS=VK_LAYER_KRS_faults \
    KRS_VULKAN_FAULT=vkGetQueryPoolResults:$((submissions / 2)):$lost:1000000 \
    "$krs" render $small --quiet -o kept.exr >out 2>err
status=$?
[ "$status" -eq 70 ] && grep -q 'the device was lost .*, 4 times in a row' err && [ "$(wc -l <err)" -eq 1 ] &&
    [ "$(cat kept.exr)" = old ] && no_temporaries
result $? "a device that is lost again and again is given up, and the old file stays"
export KRS_TEST_CHECKPOINT=0.001
faulty "" ball.krs --size 32x24 --samples 24 --resume
mv a.exr whole.exr
faulty "vkQueueSubmit:$(($(count vkQueueSubmit) * 9 / 10)):$lost:1000000" ball.krs --size 32x24 --samples 24 --resume
[ "$status" -eq 75 ] && [ -e a.exr.part ] && [ ! -e a.exr ]
result $? "with --resume it can be tried again"
faulty "" ball.krs --size 32x24 --samples 24 --resume
[ "$status" -eq 0 ] && cmp -s a.exr whole.exr && [ ! -e a.exr.part ]
result $? "and goes on to the same picture"
unset KRS_TEST_CHECKPOINT

# Every STRIDE-th call.
ended=0 right=0 bad=""
n=1
while [ "$n" -le "$calls" ] && [ -z "$bad" ]; do
    case $((n / ${STRIDE:-29} % 3)) in
    0) error=$lost ;;
    1) error=$out_of_device_memory ;;
    2) error=$out_of_host_memory ;;
    esac
    # shellcheck disable=SC2086
    faulty any:$n:$error $small
    if [ "$status" -eq 0 ] && cmp -s a.exr ball.exr; then
        right=$((right + 1))
    elif ended_clearly; then
        ended=$((ended + 1))
    else
        bad=any:$n:$error
    fi
    n=$((n + ${STRIDE:-29}))
done
[ -z "$bad" ] && [ "$right" -gt $((calls / ${STRIDE:-29} / 2)) ]
result $? "calls 1 to $calls by ${STRIDE:-29}: $right pictures, $ended clear ends${bad:+; bad: $bad}"

# Viewers.
for fault in "vkQueueSubmit:20:$lost" "vkQueueSubmit:60:$lost:1000000"; do
    rm -f log
    VK_LAYER_PATH=$work/layer VK_INSTANCE_LAYERS=VK_LAYER_KRS_faults KRS_VULKAN_FAULT_LOG=$work/log \
        KRS_VULKAN_FAULT=$fault "${PYTHON:-/usr/bin/python3}" "$root/tests/cli/vulkan_faults_view.py" \
        "$krs" ball.krs >out 2>err
    status=$(sed -n 's/^status \(-*[0-9]*\).*/\1/p' out)
    [ "${status:--1}" -ge 0 ] && ! grep -q crashed out && failed 1
    result $? "krs view does not crash: $fault"
done
