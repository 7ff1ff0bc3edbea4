#!/bin/sh
# view.sh: <krs-view> shows scenes in Chromium, follows edits and comes back, by tiles whose sizes follow what they cost.
. "$(dirname "$0")/../support/pages.sh"
node tests/web/tiles.mjs || exit 1
exec node tests/web/view.mjs "$build/web"
