#!/bin/sh
# soak.sh: a few executions of `make soak` (tests/soak/soak.py), which tries for hours; what is planted is found.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 3
python=${PYTHON:-/usr/bin/python3}
soak() {
    "$python" "$root/tests/soak/soak.py" --build "$work/build" "$@" >out 2>err
    status=$?
}
mkdir build
ln -s "$krs" build/krs
soak --seed 1 --count 6 --only pairs --only vulkan_calls --only system_calls --row row.md
[ "$status" -eq 0 ] && [ "$(wc -l <row.md)" -eq 1 ] && grep -q '^[0-9]* executions in .*, 0 findings' out
result $? "a few executions of several kinds have no finding"
soak --seed 1 --count 4 --only readers --planted
[ "$status" -eq 1 ] && [ "$(grep -c '^finding: --only readers --seed' out)" -ge 1 ] && [ -n "$(ls build/soak-findings)" ]
result $? "a krs that crashes is found"
seed=$(sed -n 's/^finding: --only readers --seed \([0-9]*\).*/\1/p' out | head -n 1)
soak --only readers --seed "$seed" --count 1 --planted
grep -q "^finding: --only readers --seed $seed" out
result $? "and found again by its seed"
