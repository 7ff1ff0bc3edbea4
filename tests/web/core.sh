#!/bin/sh
# core.sh: the core of pages makes what the native compiler makes, of all examples, the scenes of tests/golden and random
# ones.  `make wasm build/tests/web/texts` builds what it compares, as `make test` does where emscripten is installed.
#
# KRS_WEB_SCENES is how many scenes are random: 40, and 500 by many.sh.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
if ! command -v emcc >/dev/null || ! command -v node >/dev/null; then
    echo "ok 1 - the core of pages # SKIP no emscripten: tools/deps.sh wasm installs it"
    exit 0
fi
if [ ! -e "$build/wasm/core.mjs" ] || [ ! -x "$build/tests/web/texts" ]; then
    echo "not ok 1 - the core of pages is built: make wasm $build/tests/web/texts"
    exit 1
fi
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
"$build/tests/web/texts" "$work" "${KRS_WEB_SCENES:-40}" examples/*.krs tests/golden/*.krs || exit 1
node tests/web/core.mjs "$build/wasm" "$work"
