#!/bin/sh
# docs.sh: the pages agree with the program.  Every scene in them checks; every statement,
# function, method, property, kind and solid that the tables know is on docs/language.md, with
# its parameters; every option, code and file that a page names exists.  No page has long
# sentences.
set -u
cd "$(dirname "$0")/.." || exit 1
krs=${KRS:-build/krs}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
pages="README.md CONTRIBUTING.md SECURITY.md docs/features.md docs/figures.md docs/code.md docs/building.md
docs/tutorial.md docs/coming-from.md docs/language.md docs/library.md docs/python.md docs/architecture.md
docs/viewer.md docs/editors.md docs/playground.md docs/meshes.md docs/slices.md docs/grids.md docs/exports.md docs/cost.md docs/farm.md docs/denoising.md docs/reliability.md docs/how-it-works.md docs/glossary.md bench/tables.md bench/measurements.md"
rooms=$(find api bench compiler mesh slice grid measure denoise export include import platform profile runtime live cli tools web python site -name README.md | sort)
pages="$pages $rooms"
failed=0
report() { # status, name
    if [ "$1" -eq 0 ]; then echo "ok - $2"; else echo "not ok - $2"; failed=1; fi
}
# Prints nothing: $work/said is what is wrong.
none() { # name
    [ ! -s "$work/said" ]
    report $? "$1"
    sed 's/^/# /' "$work/said"
}

# ---- scenes ----
for page in $pages; do
    name=$(basename "$page" .md)
    awk -v stem="$work/$name" '
        /^```/ { inside = !inside; file = stem "-" FNR ".krs"; chosen = $0 == "```krs"; next }
        inside && chosen { print > file }' "$page"
done
for scene in "$work"/*.krs; do
    "$krs" check --color never "$scene" >"$work/said" 2>&1
    none "the scene of $(basename "$scene" .krs | sed 's/-/.md, line /') has no mistake, no warning"
done
ls "$work"/README-*.krs "$work"/language-*.krs >/dev/null
report $? "there are such scenes"

# ---- the language ----
# What is between backquotes, a line each; signatures without colons and dots.
spans() {
    # shellcheck disable=SC2016 # backquotes that are meant
    awk '/^```/ { inside = !inside; next } !inside' "$1" | sed 's/\\|/|/g' | grep -o '`[^`]*`' |
        tr -d '`'
}
spans docs/language.md >"$work/spans"
sed 's/: [0-9.]*\([,)]\)/\1/g; s/:\([,)]\)/\1/g; s/\.\.\.//g' "$work/spans" >"$work/signatures"
grep -v '^\.' "$work/signatures" | grep -o '[A-Za-z_][A-Za-z_0-9]*' | sort -u >"$work/words"

# Prints what is not there of `name(parameter, parameter)` on standard input.  Where the page has the
# name with parentheses, it must have these parameters.
undocumented() {
    while read -r wanted; do
        name=${wanted%%(*}
        if grep -q -- "^$name(" "$work/signatures"; then
            grep -qF -- "$wanted" "$work/signatures" || echo "$wanted"
        else
            grep -qxF -- "$name" "$work/words" || echo "$name"
        fi
    done >"$work/said"
}
# The tables have "a b= c...".
signature() { sed 's/=//g; s/\.\.\.//g; s/  *)/)/; s/ /, /g'; }

words='STATEMENT\|CONTROL\|OPERATOR_WORD\|CONSTANT'
sed -n "s/^TOKEN([A-Z_]*, *\"\([a-z]*\)\", *\($words\))/\1/p" compiler/front/token.def |
    undocumented
none "every word of the language is on its page"
sed -n '/not_supported/d; s/^FUNCTION(\([a-z_0-9]*\), *"\([^"]*\)".*/\1(\2)/p
    s/^MAP(\([a-z_0-9]*\), *[1-4], *"\([a-z ]*\)".*/\1(\2)/p' \
    compiler/eval/builtins/functions.def compiler/graph/ops.def | signature | undocumented
none "every function is on the page, with its parameters"
sed -n '/not_supported/d; s/^METHOD(\([a-z_]*\), *"\([^"]*\)".*/.\1(\2)/p
    s/^DEFORMATION([A-Z]*, *\([a-z_]*\), *"\([^"]*\)".*/.\1(\2)/p' \
    compiler/eval/builtins/methods.def compiler/shape/shapes.def | signature | while read -r wanted; do
        grep -qF -- "$wanted" "$work/signatures" || echo "$wanted"
    done >"$work/said"
none "every method is on the page, with its parameters"
sed -n 's/^\(FALLOFF\|PALETTE\)([A-Z_, ]*"\([a-z]*\)".*/\2/p; s/^BLEND(\([a-z]*\),.*/\1/p; s/^    "\([a-z]*\)",$/\1/p' \
    compiler/graph/blends.def compiler/eval/builtins/csg.c compiler/shape/falloffs.def compiler/eval/view/palettes.def |
    while read -r kind; do
        grep -qF -- "\"$kind\"" "$work/spans" || echo "$kind"
    done >"$work/said"
none "every kind of blend and falloff and every palette is on the page"

# The row of a block names its properties.
tr '{' '\n' <compiler/eval/properties.c |
    sed -n 's/^SYNTAX_\([A-Z]*\), "\([a-z_]*\)", false}.*/\1 \2/p' |
    while read -r block property; do
        row=$(echo "$block" | tr '[:upper:]' '[:lower:]')
        grep "^| \`${row}[ \`]" docs/language.md |
            grep -q "[\` ]${property}[\`:]" || echo "$property of $block"
    done >"$work/said"
none "every property of a block is in its row"
sed -n '/property_names\[\]/,/};/p' compiler/eval/declared/declare.c | grep -o '"[a-z]*"' |
    tr -d '"' >"$work/properties"
[ -s "$work/properties" ]
report $? "the properties of shapes are found"
while read -r property; do
    grep -q "^| \`${property}[\`:]" docs/language.md || echo "$property"
done <"$work/properties" >"$work/said"
none "every property of a shape has a row"

# What the library declares over several lines is joined; kinds and defaults do not matter.
for file in compiler/library/*.krs compiler/library/std/*.krs; do
    awk '/^(shape|def) [a-z]/ { open = 1; text = "" }
         open { text = text " " $0 }
         open && /\)( =| \{)/ { print text; open = 0 }' "$file"
done >"$work/declared"
awk '{
    sub(/^ *(shape|def) /, ""); depth = 0; out = ""; skip = 0
    for (i = 1; i <= length($0); i++) {
        c = substr($0, i, 1)
        if (c ~ /[(\[]/) depth++
        if (c ~ /[)\]]/) depth--
        if (depth == 1 && (c == "=" || c == ":")) skip = 1
        if (depth == 1 && c == ",") skip = 0
        if (depth == 0 && c == ")") { out = out ")"; break }
        if (!skip && c != " ") out = out (c == "," ? ", " : c)
    }
    print out
}' "$work/declared" >"$work/library"
# What recursion passes on is no parameter; what all surfaces take is said once.
sed 's/, k)/)/; s/, done)/)/; s/\(, \)\{0,1\}within, open)/)/' "$work/library" | undocumented
none "what the library declares is on the page, with its parameters"
[ "$(wc -l <"$work/library")" -gt 60 ]
report $? "the library's declarations are found"

# All names of CSS, but for `tan`, which is the tangent in the language.
sed -n 's/^let \([a-z]*\) *= #\([0-9a-f]*\);.*/\1 \2/p' compiler/library/colours.krs | sort >"$work/colours"
[ "$(wc -l <"$work/colours")" -eq 147 ]
report $? "the library has the colours of CSS"

# ---- options, codes, files ----
sed -n 's/^OPTION([A-Z_]*, *[^,]*, *"\([a-z-]*\)".*/--\1/p' cli/options/options.def >"$work/options"
sed -n 's/.*"usage: bench \(.*\)/\1/p' bench/bench.c | grep -o -e '--[a-z-]*' >>"$work/options"
printf "%s\n" --version --bless >>"$work/options"
# shellcheck disable=SC2086 # several pages
grep -ho -e '[` ]--[a-z][a-z-]*' $pages | tr -d '` ' | sort -u |
    grep -vxF -f "$work/options" >"$work/said"
none "every option that a page names exists"
# shellcheck disable=SC2086
grep -ho '\<[EWN][0-9]\{4\}\>' $pages | sort -u | while read -r code; do
    grep -q "^DIAG($code," compiler/base/diag.def || echo "$code"
done >"$work/said"
none "every diagnostic that a page names exists"
find . -name build -prune -o -type f -print >"$work/files"
kinds='c\|h\|def\|cpp\|comp\|glsl\|ebnf\|sh\|png'
for page in $pages; do
    spans "$page"
    sed 's/[](),;:]/ /g' "$page" | tr ' ' '\n' | grep /
done | grep -x "[a-z][A-Za-z0-9_/.-]*\.\($kinds\|krs\)" | sort -u | while read -r file; do
    grep -q "\(^\|/\)$(echo "$file" | sed 's/\./\\./g')\$" "$work/files" || echo "$file"
done >"$work/said"
none "every file that a page names exists"

# ---- versions ----
[ "$(sed -n 's/^## \[\([0-9.]*\)\].*/\1/p' CHANGELOG.md | head -n 1)" = "$(sed -n 's/^#define KRS_VERSION *"\(.*\)"/\1/p' include/krs/krs.h)" ]
report $? "the last version of the changelog is the program's"

# ---- links ----
for page in $pages; do
    grep -o ']([^)]*)' "$page" | tr -d '])(' | while read -r link; do
        file=$(dirname "$page")/${link%%#*}
        heading=${link#*#}
        if [ ! -e "$file" ]; then
            echo "$page: $link"
        elif [ "$heading" != "$link" ]; then
            grep '^#' "$file" | tr '[:upper:]' '[:lower:]' | sed 's/^#* //; s/[^a-z0-9 -]//g; s/ /-/g' |
                grep -qxF -- "$heading" || echo "$page: $link"
        fi
    done
done >"$work/said"
none "every link leads to a file, and to a heading in it"

# ---- sentences ----
for page in $pages; do
    awk -v most=30 -f tests/sentences.awk "$page"
done >"$work/said"
none "no sentence of these pages has more than 30 words"
printf '%s\n' 'This is short.  But' 'one two three four five six seven eight nine ten eleven twelve' \
    'thirteen fourteen fifteen sixteen seventeen eighteen nineteen twenty one two three four five' \
    'six seven eight nine ten eleven.' >"$work/long"
awk -v most=30 -f tests/sentences.awk "$work/long" | grep -q ': 32 words: '
report $? "a long sentence would be found"
# shellcheck disable=SC2086
wc -l $rooms | awk '$1 > 40 && $2 != "total" { print $2 " has " $1 " lines" }' >"$work/said"
none "pages of folders have at most 40 lines"
[ "$(wc -l <docs/architecture.md)" -le 200 ]
report $? "docs/architecture.md has at most 200 lines"
[ "$(grep -c '^| [a-z]' docs/glossary.md)" -le 16 ]
report $? "docs/glossary.md has at most 15 rows, below its heading"

# ---- the C library ----
find include/krs -name '*.h' ! -name 'deprecated*' -exec cat {} + |
    sed -n 's/^[A-Za-z].*\(krs_[a-z_0-9]*\)(.*/\1/p' |
    grep -v '_sized$' | sort -u >"$work/declared"
# shellcheck disable=SC2016 # backquotes that are meant
sed -n '/^## All functions/,$p' docs/library.md | grep -o '`krs_[a-z_0-9]*`' | tr -d '`' |
    sort >"$work/listed"
diff "$work/declared" "$work/listed" >"$work/said"
none "docs/library.md lists the functions of the headers, each once"
[ "$(wc -l <"$work/declared")" -gt 30 ]
report $? "the headers declare some"
exit $failed
