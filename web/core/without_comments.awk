# without_comments.awk: a file of the library without its comments, but for `///`, which editors show.  Lines stay where they
# are.  No string of the library has // or /*.
{
    kept = ""
    for (rest = $0; rest != "";) {
        if (inside) {
            end = index(rest, "*/")
            inside = end == 0
            rest = inside ? "" : substr(rest, end + 2)
            continue
        }
        open = index(rest, "/*")
        slashes = index(rest, "//")
        if (slashes && (!open || slashes < open)) {
            kept = kept (substr(rest, slashes, 3) == "///" ? rest : substr(rest, 1, slashes - 1))
            break
        }
        inside = open > 0
        kept = kept (open ? substr(rest, 1, open - 1) : rest)
        rest = open ? substr(rest, open + 2) : ""
    }
    sub(/[ \t]+$/, "", kept)
    print kept
}
