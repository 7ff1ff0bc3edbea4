#!/bin/sh
# view.sh: <krs-view> shows scenes in Chromium, follows edits and comes back.
. "$(dirname "$0")/../support/pages.sh"
exec node tests/web/view.mjs "$build/web"
