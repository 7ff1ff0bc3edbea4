#!/bin/sh
# export.sh: what `krs export` writes draws in Chromium, and hits where `krs query` does.
#
# KRS_EXPORT_SCENES are the scenes: a few, and all examples by exports.sh.  Pictures are left in KRS_EXPORT_SHOTS, if that is given.
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
# Letters are read from tables, which engines have no room for.
cat >"$work/letters.krs" <<'END'
material m { color: #ff8000 }
show text("krs").extrude(0.3).paint(m);
camera { eye: [1.4, 1, 2], target: [0.8, 0.3, 0], fov: 35deg }
light { direction: [1, 2, 3], intensity: 3 }
END
KRS_EXPORT_BAKED=$work/letters.krs
export KRS_EXPORT_SCENES KRS_EXPORT_ENGINES KRS_EXPORT_BAKED
node tests/web/export.mjs "${KRS:-$build/krs}" "$work" ${KRS_EXPORT_SHOTS:+"$KRS_EXPORT_SHOTS"}
