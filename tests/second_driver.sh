#!/bin/sh
# second_driver.sh: whether `make test` has a second driver to hold lavapipe against; not all systems offer it.
cd "$(dirname "$0")/.." || exit 1
. tests/support/drivers.sh
echo "1..1"
if [ -e "$swiftshader_driver" ]; then
    echo "ok 1 - there is a second driver"
else
    echo "ok 1 - there is a second driver # SKIP no $swiftshader_driver"
fi
