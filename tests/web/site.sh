#!/bin/sh
# site.sh: the static site is built, with pictures of few pixels, and is what its visitors expect (site.mjs).
. "$(dirname "$0")/../support/pages.sh"
if [ ! -e "$build/npm/.package-lock" ]; then
    echo "ok - the site # SKIP packages of npm are not here: make playground"
    exit 0
fi
for needed in playground/service.js npm/site.mjs site-words; do
    if [ ! -e "$build/$needed" ]; then
        echo "not ok - what makes the site is built: make site"
        exit 1
    fi
done
# These are rendered; all others are pages without their pictures.
rendered="^(first|tutorial|coming-from|word-(sphere|helix|union|move|checker|barth_sextic|fern_leaf))\$"
site=$(mktemp -d) && trap 'rm -rf "$site"' EXIT
if node "$build/npm/site.mjs" . "$build" "$site/built" --small "$rendered" >"$site/said" 2>&1; then
    echo "ok - the site is built"
else
    echo "not ok - the site is built"
    sed 's/^/# /' "$site/said"
    exit 1
fi
node tests/web/site.mjs "$site/built" "${KRS:-build/krs}" "$build" "$rendered"
