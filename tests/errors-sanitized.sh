#!/bin/sh
# errors-sanitized.sh: the scenes of tests/errors/ once more, by the command that was built with
# the sanitizers.
cd "$(dirname "$0")/.." || exit 1
KRS=${B:-build}/asan/krs exec tests/errors.sh
