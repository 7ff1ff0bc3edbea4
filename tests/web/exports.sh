#!/bin/sh
# exports.sh: export.sh with all examples.
cd "$(dirname "$0")/../.." || exit 1
KRS_EXPORT_SCENES=$(echo examples/*.krs) exec tests/web/export.sh
