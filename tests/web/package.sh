#!/bin/sh
# package.sh: the package for pages compiles scenes and answers in Chromium.
. "$(dirname "$0")/../support/pages.sh"
exec node tests/web/package.mjs "$build/web"
