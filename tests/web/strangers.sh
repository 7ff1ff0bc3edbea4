#!/bin/sh
# strangers.sh: the limits of scenes in pages, and what is told when something fails.
. "$(dirname "$0")/../support/pages.sh"
exec node tests/web/strangers.mjs "$build/web"
