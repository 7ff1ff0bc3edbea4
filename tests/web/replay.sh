#!/bin/sh
# replay.sh: previews and paths by Chromium's WebGPU are those of the device that krs renders on.
#
# record.c writes down what the tracer asks of a device, with the shaders' texts; glslang and naga make WGSL of these, as `make kernels` does, and a page
# asks WebGPU for the same.  `make kernels build/tests/web/record` builds what is needed, as `make test` does where npm is.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
if ! command -v node >/dev/null || ! node -e "import('./tests/web/browser.mjs').then(b => process.exit(b.findChromium() ? 0 : 1))" 2>/dev/null; then
    echo "ok 1 - pictures by WebGPU # SKIP not here: node and chromium"
    exit 0
fi
if [ ! -e "$build/kernels/.done" ]; then
    echo "ok 1 - pictures by WebGPU # SKIP packages of npm are not here: make kernels"
    exit 0
fi
if [ ! -x "$build/tests/web/record" ]; then
    echo "not ok 1 - pictures are written down: make $build/tests/web/record"
    exit 1
fi
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0

# Writes a picture down; makes WGSL of its shaders; has a page do the same.
record() { # integrator, samples, width, height
    rm -rf "$work/record" && mkdir "$work/record" && "$build/tests/web/record" "$work/record" examples/01-hello.krs "$@"
}
translate() {
    for text in "$work"/record/*.comp; do
        module=${text%.comp}.spv
        glslangValidator -V --target-env vulkan1.1 -o "$module" "$text" >/dev/null &&
            spirv-opt --target-env=vulkan1.1 --eliminate-dead-functions --eliminate-dead-variables "$module" -o "$module" || return 1
    done
    node web/tracer/kernels.mjs "$build/npm/node_modules" "$work"/record/*.spv
}
replay() { # what
    node tests/web/replay.mjs "$work/record" "$1"
}

record path 1 64 48 && translate && replay "paths" || failed=1
record preview 1 64 48 && translate && replay "a preview" || failed=1

# The ground has another colour.
sed -i 's/0\.67244315[0-9]*/0.6/' "$work"/record/*.comp
translate && replay "another colour" >"$work/told"
if grep '^not ok.*another colour: [0-9]' "$work/told" >/dev/null; then
    echo "ok - a wrong number in a shader is found"
else
    echo "not ok - a wrong number in a shader is found: $(cat "$work/told")"
    failed=1
fi
exit $failed
