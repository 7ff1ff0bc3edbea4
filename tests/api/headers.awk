# headers.awk: the public headers as they would be in another version.
#
# With change=older each struct of `structs` lacks its last member, and the callback before it where that is the callback's
# `user`; with change=later it has one more, `later`.
# A file at a time; comments are left out, since members are found by their semicolons.
{ text = text $0 "\n" }

function without_comments(text,    start, end, out) {
    while ((start = index(text, "/*")) > 0) {
        out = out substr(text, 1, start - 1)
        text = substr(text, start)
        end = index(text, "*/")
        text = substr(text, end + 2)
    }
    return out text
}

# Where the last semicolon of a text is.
function last_semicolon(text,    at) {
    for (at = length(text); at > 0 && substr(text, at, 1) != ";"; at--)
        ;
    return at
}

# Without the last member.
function without_last(text,    at) {
    at = last_semicolon(substr(text, 1, last_semicolon(text) - 1))
    return substr(text, at) ~ /user *;/ ? without_last(substr(text, 1, at)) : substr(text, 1, at) "\n"
}

END {
    text = without_comments(text)
    count = split(structs, names, " ")
    for (i = 1; i <= count; i++) {
        end = index(text, "} " names[i] ";")
        if (end == 0)
            continue
        before = substr(text, 1, end - 1)
        after = substr(text, end)
        if (change == "older")
            before = without_last(before)
        else
            before = before "    double later;\n"
        text = before after
    }
    printf "%s", text
}
