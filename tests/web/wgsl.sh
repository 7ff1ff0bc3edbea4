#!/bin/sh
# wgsl.sh [FILE...]: scenes as WGSL, in Chromium's WebGPU: files, the scenes of tests/golden, functions of the language, and
# random scenes.  `make build/tests/web/points` builds what writes them, as `make test` does where node is installed.
#
# KRS_WEB_SCENES is how many scenes are random: 24, and 500 by wgsl_many.sh.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
if ! command -v node >/dev/null || ! node -e "import('./tests/web/browser.mjs').then(b => process.exit(b.findChromium() ? 0 : 1))" 2>/dev/null; then
    echo "ok 1 - scenes as WGSL # SKIP not here: node and chromium"
    exit 0
fi
if [ ! -x "$build/tests/web/points" ]; then
    echo "not ok 1 - scenes are written: make $build/tests/web/points"
    exit 1
fi
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
"$build/tests/web/points" "$work" "${KRS_WEB_SCENES:-24}" "$@" tests/golden/*.krs || exit 1
node tests/web/wgsl.mjs "$work"
