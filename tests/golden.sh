#!/bin/sh
# golden.sh: what passes of the compiler make of the scenes in tests/golden/ is as blessed in the
# files beside them, by extension: NAME.scene (shapes and what surrounds them), NAME.graph (as it was
# built), NAME.simplify (as it is printed), NAME.info (what the renderer has to know) and NAME.glsl.
# `golden.sh --bless` writes them.  They say that nothing has changed, not that it is right: that is
# for the oracles.
cd "$(dirname "$0")/.." || exit 1
krs=${KRS:-build/krs}
got=$(mktemp) && trap 'rm -f "$got"' EXIT
failed=0

for scene in tests/golden/*.krs; do
    for pass in scene graph simplify info glsl; do
        wanted=${scene%.krs}.$pass
        status=0
        "$krs" dump --color never --after="$pass" "$scene" >"$got" 2>&1 || status=$?
        if [ "${1:-}" = --bless ]; then cp "$got" "$wanted"; fi
        if [ $status -eq 0 ] && diff "$wanted" "$got" | head -n 20 && cmp -s "$wanted" "$got"; then
            echo "ok - $wanted"
        else
            echo "not ok - $wanted: tests/golden.sh --bless takes what is new"
            failed=1
        fi
    done
done
exit $failed
