# sentences.awk: prints each sentence of a page that has more than `most` words.  Code blocks, tables
# and pictures are no sentences; a blank line, a heading, or an item of a list ends one.
#     awk -v most=30 -f tests/sentences.awk docs/architecture.md
function end_paragraph(   i, count, words, sentences) {
    gsub(/!\[[^]]*\]\([^)]*\)/, "", text)   # pictures
    gsub(/\]\([^)]*\)/, "", text)           # where links lead
    gsub(/[*`\[]/, "", text)
    gsub(/[.!?][)"]? /, "&\n", text)
    count = split(text, sentences, "\n")
    for (i = 1; i <= count; i++) {
        gsub(/ [^A-Za-z0-9]+ /, " ", sentences[i])   # signs are no words
        if (split(sentences[i], words, " ") > most)
            printf "%s:%d: %d words: %s\n", file, first, split(sentences[i], words, " "), sentences[i]
    }
    text = ""
}
FNR == 1 { end_paragraph(); code = 0; file = FILENAME }
/^```/ { end_paragraph(); code = !code; next }
code || /^\|/ || /^    / || /^#/ || /^ *$/ { end_paragraph(); next }
/^ *([*-]|[0-9]+\.) / { end_paragraph(); sub(/^ *([*-]|[0-9]+\.) /, "") }
text == "" { first = FNR }
{ text = text " " $0 }
END { end_paragraph() }
