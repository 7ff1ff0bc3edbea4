#!/bin/sh
# grammar.sh: the rules quoted above the functions of the parser are those of grammar/krs.ebnf,
# and every rule is used and defined.
set -u
cd "$(dirname "$0")/.." || exit 1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failed=0
parser="compiler/front/parse.c compiler/front/parse_declaration.c
        compiler/front/parse_expression.c"

result() { # status name
    if [ "$1" -eq 0 ]; then
        echo "ok - $2"
    else
        echo "not ok - $2"
        sed 's/^/# /' "$folder/said"
        failed=1
    fi
}

rules() { sed -n 's|^\(/\* \)\{0,1\}\([a-z_]* = .* ;\)\( \*/\)\{0,1\}$|\2|p' "$@" | sort; }

# The parser's rules are comments; a rule of the grammar is a line of its own.
rules grammar/krs.ebnf >"$folder/grammar"
# shellcheck disable=SC2086 # the list is words
rules $parser >"$folder/parser"
diff "$folder/grammar" "$folder/parser" >"$folder/said" && [ -s "$folder/grammar" ]
result $? "the parser quotes the rules of the grammar"

# What is no comment, blank, or rule would be compared with nothing.
grep -vn '^#\|^$\|^[a-z_]* = .* ;$' grammar/krs.ebnf >"$folder/said"
[ $? -eq 1 ]
result $? "every line of the grammar is a rule"

sed 's/ = .*//' "$folder/grammar" >"$folder/defined"
uniq -d "$folder/defined" >"$folder/said"
[ ! -s "$folder/said" ]
result $? "every rule is defined once"

{
    echo file
    sed 's/^[a-z_]* = //; s/"[^"]*"//g; s/[A-Z][A-Z_]*//g' "$folder/grammar" |
        grep -o '[a-z_][a-z_]*'
} | sort -u >"$folder/used"
comm -3 "$folder/defined" "$folder/used" >"$folder/said"
[ ! -s "$folder/said" ]
result $? "every rule is used, and every rule used is defined"

# A function above which no rule stands has escaped the comparison.
for file in $parser; do
    awk '/^(static )?(Syntax|void|const Token) \*?parse_[a-z_]*\(.*[^;]$/ {
             name = $0; sub(/\(.*/, "", name); sub(/.*parse_/, "", name)
             rule = previous; sub(/^\/\* /, "", rule); sub(/ = .*/, "", rule)
             if (rule != name) print FILENAME ": parse_" name
         }
         { previous = $0 }' "$file"
done >"$folder/said"
sort "$folder/said" >"$folder/without"
# These are shared by several rules, or mend what no rule permits.
for name in left simple braces loop choice statements block_of_properties token positional \
    forgotten_let; do
    echo "parse_$name"
done | sort >"$folder/helpers"
sed 's/.*: //' "$folder/without" | grep -vxF -f "$folder/helpers" >"$folder/said"
[ $? -eq 1 ]
result $? "every parse function quotes its rule"

exit $failed
