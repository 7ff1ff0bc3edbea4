#!/bin/sh
# wgsl_many.sh: wgsl.sh with all examples and 500 random scenes.
cd "$(dirname "$0")/../.." || exit 1
KRS_WEB_SCENES=500 exec tests/web/wgsl.sh examples/*.krs
