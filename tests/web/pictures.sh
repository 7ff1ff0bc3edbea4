#!/bin/sh
# pictures.sh: all examples are drawn in Chromium, and some beside krs render.
. "$(dirname "$0")/../support/pages.sh"
exec node tests/web/pictures.mjs "$build/web" "${KRS:-$build/krs}"
