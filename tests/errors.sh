#!/bin/sh
# errors.sh: every diagnostic code has a scene in tests/errors/ whose output is as blessed in the
# .err file beside it, and a mark in the scene (//~ E0203) that no blessing can change: that code
# is reported on that line.  `errors.sh --bless` writes the .err files.  A scene that begins with
# "// krs check --root FOLDER" is checked with that option.  One that begins with "// krs compile" is
# refused by that only, and passes the check; so is one that begins with "// krs validate", and since what
# that finds depends on rounding, numbers in its notes are not compared.
cd "$(dirname "$0")/.." || exit 1
krs=${KRS:-build/krs}
got=$(mktemp) && folder=$(mktemp -d) && trap 'rm -rf "$got" "$folder"' EXIT
failed=0

report() { # name, passed
    if [ "$2" = yes ]; then echo "ok - $1"; else echo "not ok - $1"; failed=1; fi
}

for scene in tests/errors/*.krs; do
    if head -n 1 "$scene" | grep -q '^// krs validate'; then
        "$krs" validate --no-device --quiet --color never "$scene" >"$got" 2>&1
        status=$?
        sed -i '/^ *= note/s/[-+.0-9][-+.0-9e]*/#/g; /^error/s/ [-+.0-9e]* times/ # times/' "$got"
    elif head -n 1 "$scene" | grep -q '^// krs compile'; then
        "$krs" check --quiet "$scene" || echo "# $scene: is refused by krs check"
        "$krs" compile --color never -o "$folder" "$scene" >"$got" 2>&1
        status=$?
    else
        root=$(sed -n '1s,^// krs check --root \(.*\)$,\1,p' "$scene")
        "$krs" check --color never ${root:+--root "$root"} "$scene" >"$got" 2>&1
        status=$?
    fi
    case $scene in */[WN]*) wanted=0 ;; *) wanted=1 ;; esac
    if [ "${1:-}" = --bless ]; then cp "$got" "${scene%.krs}.err"; fi

    passed=yes
    [ $status -eq $wanted ] || { echo "# $scene: status $status, expected $wanted"; passed=no; }
    if ! diff "${scene%.krs}.err" "$got"; then passed=no; fi
    marks=$(grep -n '//~ ' "$scene" | sed 's/^\([0-9]*\):.*\/\/~ \([EWN][0-9]*\).*/\1 \2/')
    while read -r line code; do
        [ -z "$line" ] && continue
        if ! grep -A1 "\[$code\]" "$got" | grep -q -- "--> $scene:$line:"; then
            echo "# $scene: $code is not reported on line $line"
            passed=no
        fi
    done <<EOF
$marks
EOF
    report "$(basename "$scene" .krs)" $passed
done

# Every code of the table has a scene.
sed -n 's/^DIAG(\([EWN][0-9]*\),.*/\1/p' compiler/base/diag.def >"$got"
while read -r code; do
    found=no
    for scene in tests/errors/"$code"-*.krs; do
        [ -e "$scene" ] && found=yes
    done
    report "$code has a scene" $found
done <"$got"
exit $failed
