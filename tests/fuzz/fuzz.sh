#!/bin/sh
# fuzz.sh: the front end under libFuzzer, seeded from the examples, the library and the tests; a
# finding is a failure.  First it is shown that the fuzzer finds what is planted.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
corpus=$(mktemp -d) && trap 'rm -rf "$corpus"' EXIT
mkdir "$corpus/seeds" "$corpus/found"
for scene in examples/*.krs compiler/library/*.krs tests/errors/*.krs; do
    cp "$scene" "$corpus/seeds/$(echo "$scene" | tr / _)"
done

printf 'krs-planted-fault' >"$corpus/planted"
if KRS_FUZZ_PLANTED=1 "$build/fuzz/front_fuzz" -artifact_prefix="$corpus/found/" "$corpus/planted" >/dev/null 2>&1; then
    echo "not ok - a planted fault is found"
    exit 1
fi
echo "ok - a planted fault is found"
rm -f "$corpus"/found/*

if "$build/fuzz/front_fuzz" -max_total_time="${FUZZ_SECONDS:-30}" -timeout=10 -rss_limit_mb=4096 -max_len=4096 \
    -artifact_prefix="$corpus/found/" "$corpus/seeds" >"$corpus/log" 2>&1; then
    echo "ok - $(sed -n 's/^Done \([0-9]*\) runs.*/\1/p' "$corpus/log") runs without a finding"
else
    tail -40 "$corpus/log"
    for found in "$corpus"/found/*; do
        [ -e "$found" ] && { echo "# $found:"; od -c "$found" | head -60; }
    done
    echo "not ok - the front end survives the fuzzer"
    exit 1
fi
