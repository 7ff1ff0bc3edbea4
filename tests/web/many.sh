#!/bin/sh
# many.sh: core.sh with 500 random scenes.
KRS_WEB_SCENES=500 exec "$(dirname "$0")/core.sh"
