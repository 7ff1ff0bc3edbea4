#!/bin/sh
# pages.sh: what tests of pages need; sourced.  Skips where emscripten, node or Chromium are absent.
cd "$(dirname "$0")/../.." || exit 1
build=${B:-build}
absent=$(for command in emcc node; do command -v "$command" >/dev/null || echo "$command"; done)
node -e "import('./tests/web/browser.mjs').then(b => process.exit(b.findChromium() ? 0 : 1))" 2>/dev/null || absent="$absent chromium"
if [ -n "$absent" ]; then
    echo "ok 1 - $(basename "$0" .sh) # SKIP not here: $absent"
    exit 0
fi
if [ ! -e "$build/web/index.mjs" ]; then
    echo "not ok 1 - the package for pages is built: make web"
    exit 1
fi
