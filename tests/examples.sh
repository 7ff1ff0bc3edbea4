#!/bin/sh
# examples.sh: every example checks without a warning, validates, and renders with no ray left
# unresolved, silently under the validation layers (core and synchronization); that these do
# report a planted fault is shown by tests/unit/devices.c.
cd "$(dirname "$0")/.." || exit 1
krs=${KRS:-build/krs}
folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT
failed=0
report() { # name, status
    if [ "$2" -eq 0 ]; then echo "ok - $1"; else echo "not ok - $1"; failed=1; fi
}
VK_LOADER_DEBUG=layer VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "$krs" devices \
    >"$folder/said" 2>&1
grep -q 'Loading layer library.*khronos_validation' "$folder/said"
report "the validation layer is loaded when it is asked for" $?

for scene in examples/*.krs; do
    "$krs" check "$scene" >"$folder/check" 2>&1 && [ ! -s "$folder/check" ]
    status=$?
    [ $status -eq 0 ] || cat "$folder/check"
    report "$scene has no mistake and no warning" $status

    VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation \
        VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT \
        "$krs" render "$scene" --quiet --size 320x180 --samples 1 --stats json \
        -o "$folder/picture.exr" -o "$folder/picture.png" >"$folder/stats" 2>"$folder/said"
    report "$scene renders" $?
    cat "$folder/said"
    ! grep -A5 -i "validation error\|validation warning\|VUID" "$folder/stats" "$folder/said"
    report "$scene is silent under the validation layers" $?
    grep -q '"unresolved": *0[,}]' "$folder/stats"
    report "$scene leaves no ray unresolved" $?

    "$krs" validate --points 128 "$scene" >"$folder/said" 2>&1
    status=$?
    [ $status -eq 0 ] || cat "$folder/said"
    report "$scene validates" $status
done
exit $failed
