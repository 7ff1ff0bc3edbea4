#!/bin/sh
# fuzz.sh: the front end alone and the whole compiler under libFuzzer, seeded from the examples,
# the library and the tests; a finding is a failure.  First it is shown that the fuzzer finds
# what is planted.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
corpus=$(mktemp -d) && trap 'rm -rf "$corpus"' EXIT
mkdir "$corpus/seeds" "$corpus/found"
# A seed of thousands of parts takes the whole time under the sanitizers: nothing would be fuzzed.
for scene in examples/*.krs compiler/library/*.krs tests/errors/*.krs; do
    case $scene in *-town.krs | *-bath.krs) continue ;; esac
    grep -qE '\.\.[0-9]{4}' "$scene" && continue
    cp "$scene" "$corpus/seeds/$(echo "$scene" | tr / _)"
done
failed=0
[ -x "$build/fuzz/tests/fuzz/scene_fuzz" ] || { echo "not ok - the fuzzers are built"; exit 1; }

printf 'krs-planted-fault' >"$corpus/planted"
if KRS_FUZZ_PLANTED=1 "$build/fuzz/tests/fuzz/scene_fuzz" \
    -artifact_prefix="$corpus/found/" "$corpus/planted" >/dev/null 2>&1; then
    echo "not ok - a planted fault is found"
    failed=1
else
    echo "ok - a planted fault is found"
fi
rm -f "$corpus"/found/*

fuzz() { # harness, seconds; what it says goes to a file
    cp -r "$corpus/seeds" "$corpus/$1"
    mkdir "$corpus/found/$1"
    if "$build/fuzz/tests/fuzz/$1" -max_total_time="$2" -timeout=120 -rss_limit_mb=4096 \
        -max_len=4096 -artifact_prefix="$corpus/found/$1/" "$corpus/$1" >"$corpus/$1.log" 2>&1; then
        runs=$(sed -n 's/^Done \([0-9]*\) runs.*/\1/p' "$corpus/$1.log")
        echo "ok - $1: $runs runs without a finding"
        return
    fi
    tail -40 "$corpus/$1.log"
    for found in "$corpus/found/$1"/*; do
        [ -e "$found" ] && { echo "# $found:"; od -c "$found" | head -60; }
    done
    echo "not ok - $1 has no finding"
}
# Side by side: each uses one core.
half=$((${FUZZ_SECONDS:-30} / 2))
for harness in front_fuzz scene_fuzz; do
    fuzz $harness $half >"$corpus/$harness.said" &
done
wait
for harness in front_fuzz scene_fuzz; do
    cat "$corpus/$harness.said"
    grep -q '^ok' "$corpus/$harness.said" || failed=1
done
exit $failed
