#!/bin/sh
# export.sh: what `krs export` writes draws in Chromium, and hits where `krs query` does.
#
# KRS_EXPORT_SCENES are the scenes: a few, and all examples by exports.sh.
. "$(dirname "$0")/../support/pages.sh"
# What shows modules for three.js: a package of npm, where that offers it.
THREE=$build/export-npm/node_modules/three
if [ ! -d "$THREE" ]; then
    mkdir -p "$build/export-npm" && cp tests/web/three/package*.json "$build/export-npm" &&
        (cd "$build/export-npm" && npm ci --ignore-scripts --no-audit --no-fund --silent >/dev/null 2>&1) || THREE=
fi
export THREE
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
: "${KRS_EXPORT_SCENES:=examples/01-hello.krs examples/30-bolt.krs examples/15-town.krs}"
: "${KRS_EXPORT_ENGINES:=examples/01-hello.krs examples/30-bolt.krs}"
export KRS_EXPORT_SCENES KRS_EXPORT_ENGINES
node tests/web/export.mjs "${KRS:-$build/krs}" "$work"
