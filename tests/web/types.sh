#!/bin/sh
# types.sh: tsc accepts a program that uses all of krs.d.ts, refuses a wrong one, and knows what the package has.
. "$(dirname "$0")/../support/pages.sh"
tsc=$PWD/$build/npm/node_modules/typescript/bin/tsc
if [ ! -e "$tsc" ]; then
    echo "ok 1 - types # SKIP packages of npm are not here: make playground"
    exit 0
fi
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0
report() { # status, number, name
    if [ "$1" -eq 0 ]; then echo "ok $2 - $3"; else echo "not ok $2 - $3"; sed 's/^/# /' "$work/said"; failed=1; fi
}
mkdir -p "$work/node_modules" && cp -r "$build/web" "$work/node_modules/krs" && cp tests/web/types/*.ts "$work"
check() { (cd "$work" && node "$tsc" --noEmit --strict --target es2023 --lib es2023,dom,dom.iterable --module esnext --moduleResolution bundler "$1" >"$work/said"); }

check all.ts
report $? 1 "a program is accepted"
! check wrong.ts && grep -q '^wrong.ts(5,.*TS2345' "$work/said"
report $? 2 "a wrong use is refused, where it is"

# What is declared, exported and used has the same names.
declared=$(sed -n 's/^export \(function\|class\|const\) \([A-Za-z]*\).*/\2/p' web/package/krs.d.ts | sort)
exported=$(sed -n 's/^export {\(.*\)}.*/\1/p' web/package/index.mjs | tr ', ' '\n' | sed '/^$/d' | sort)
members=$(sed -n '/^export \(interface Scene \|class\)/,/^}/ s/^    \(readonly \|get \|set \)*\([a-z][A-Za-z]*\)[?:(].*/\2/p' web/package/krs.d.ts | sort -u)
for name in $declared $members; do
    grep -qw "$name" tests/web/types/all.ts || echo "$name is not used"
done >"$work/said"
[ "$declared" = "$exported" ] || echo "declared: $declared; exported: $exported" >>"$work/said"
[ ! -s "$work/said" ] && [ "$(echo "$members" | wc -l)" -gt 25 ]
report $? 3 "what is declared is there, and used"
echo 1..3
exit $failed
