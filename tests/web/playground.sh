#!/bin/sh
# playground.sh: links come back as they were, and the playground in Chromium does what a user asks of it.
#
# KRS_PARTS are parts of playground.mjs; playground_long.sh has those that take longer.
. "$(dirname "$0")/../support/pages.sh"
node tests/web/share.mjs || exit 1
if [ ! -e "$build/npm/.package-lock" ]; then
    echo "ok - the playground # SKIP packages of npm are not here: make playground"
    exit 0
fi
if [ ! -e "$build/playground/service.js" ]; then
    echo "not ok - the playground is built: make playground"
    exit 1
fi
# shellcheck disable=SC2086 # words are meant
exec node tests/web/playground.mjs "$build/playground" "${KRS:-build/krs}" ${KRS_PARTS:-first mistakes parameters share keys}
