#!/bin/sh
# kernels.sh: the runtime's shaders are WGSL that Chromium's WebGPU takes, and point_query.comp says of scenes what the evaluator says.
# `make kernels` builds them, as `make test` does where npm is.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
if ! command -v node >/dev/null || ! node -e "import('./tests/web/browser.mjs').then(b => process.exit(b.findChromium() ? 0 : 1))" 2>/dev/null; then
    echo "ok 1 - shaders as WGSL # SKIP not here: node and chromium"
    exit 0
fi
if [ ! -e "$build/kernels/.done" ]; then
    echo "ok 1 - shaders as WGSL # SKIP packages of npm are not here: make kernels"
    exit 0
fi
if [ ! -x "$build/tests/web/points" ]; then
    echo "not ok 1 - scenes are written: make $build/tests/web/points"
    exit 1
fi
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
"$build/tests/web/points" "$work" 0 examples/01-hello.krs tests/golden/csg.krs tests/golden/shapes.krs tests/golden/looks.krs >/dev/null || exit 1
node tests/web/kernels.mjs "$build/kernels" "$work"
