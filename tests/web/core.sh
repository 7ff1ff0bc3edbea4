#!/bin/sh
# core.sh: the core of pages makes what the native compiler makes, of all examples, the scenes of tests/golden and random
# ones.  It is built here, where Debian's emscripten is installed (tools/deps.sh wasm).
#
# KRS_WEB_SCENES is how many scenes are random: 40, and 500 by many.sh.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
if ! command -v emcc >/dev/null || ! command -v node >/dev/null; then
    echo "ok 1 - the core of pages # SKIP no emscripten: tools/deps.sh wasm installs it"
    exit 0
fi
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
if ! make --no-print-directory B="$build" wasm "$build/tests/web/texts" >"$work/said" 2>&1; then
    echo "not ok 1 - the core of pages is built"
    tail -n 20 "$work/said" | sed 's/^/# /'
    exit 1
fi
"$build/tests/web/texts" "$work" "${KRS_WEB_SCENES:-40}" examples/*.krs tests/golden/*.krs || exit 1
node tests/web/core.mjs "$build/wasm" "$work"
