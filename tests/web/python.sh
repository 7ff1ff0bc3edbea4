#!/bin/sh
# python.sh: what krs.view shows, in Chromium.
. "$(dirname "$0")/../support/pages.sh"
. tests/support/python.sh
make_python python >&2 || exit 1
PYTHONPATH="$build/python:tests/python" exec "$python" tests/python/tap.py browser
