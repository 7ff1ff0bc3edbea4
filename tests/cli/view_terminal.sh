#!/bin/sh
# view_terminal.sh: `krs view --terminal` on a pseudo-terminal: pictures, keys, edits and mistakes.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
export XDG_CACHE_HOME="$work/caches"
plan 13
run view ball.krs --terminal
said 69 "no terminal" "no terminal, no viewer"
"${PYTHON:-/usr/bin/python3}" "$root/tests/cli/view_terminal.py" "$krs" | awk '
    { if ($1 == "ok") $2++; else $3++; print }'
