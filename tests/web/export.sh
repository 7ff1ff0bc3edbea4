#!/bin/sh
# export.sh: what `krs export` writes draws in Chromium, and hits where `krs query` does.
#
# KRS_EXPORT_SCENES are the scenes: a few, and all examples by exports.sh.
. "$(dirname "$0")/../support/pages.sh"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
: "${KRS_EXPORT_SCENES:=examples/01-hello.krs examples/30-bolt.krs examples/15-town.krs}"
: "${KRS_EXPORT_ENGINES:=examples/01-hello.krs examples/30-bolt.krs}"
export KRS_EXPORT_SCENES KRS_EXPORT_ENGINES
node tests/web/export.mjs "${KRS:-$build/krs}" "$work"
