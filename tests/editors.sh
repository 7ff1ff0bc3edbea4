#!/bin/sh
# editors.sh: the syntax colouring for editors knows exactly the words of token.def, each in the
# group of its class; and the extension for VS Code starts the language server.
set -u
cd "$(dirname "$0")/.." || exit 1
failed=0

check() { # name wanted found
    if [ -n "$2" ] && [ "$2" = "$3" ]; then
        echo "ok - $1"
    else
        echo "not ok - $1"
        echo "# token.def: $2"
        echo "# editor:    $3"
        failed=1
    fi
}

sorted() { tr '|' ' ' | tr -s ' ' '\n' | sed '/^$/d' | sort | tr '\n' ' '; }

for class in STATEMENT CONTROL OPERATOR_WORD CONSTANT; do
    words=$(sed -n "s/^TOKEN([A-Z_]*, *\"\([a-z]*\)\", *$class)\$/\1/p" compiler/front/token.def |
        sorted)
    lower=$(echo "$class" | tr '[:upper:]' '[:lower:]')
    group=$(echo "$lower" | awk -F_ '{ for (i = 1; i <= NF; i++)
        printf "%s%s", toupper(substr($i, 1, 1)), substr($i, 2) }')
    check "krs.vim: $class" "$words" \
        "$(sed -n "s/^syntax keyword krs$group //p" grammar/editors/krs.vim | sorted)"
    check "krs.tmLanguage.json: $class" "$words" \
        "$(sed -n "s/.*\"keyword\.$lower\.krs\", \"match\": \"[^(]*(\([^)]*\)).*/\1/p" \
            grammar/editors/krs.tmLanguage.json | sorted)"
done
if command -v node >/dev/null; then
    node tests/lsp/extension.cjs "${KRS:-build/krs}" || failed=1
else
    echo "ok - the extension for VS Code # SKIP no node"
fi
exit $failed
