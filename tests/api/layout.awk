# layout.awk: a program that prints where the members of the structs are, and the numbers of choices, in headers that
# the preprocessor has read.
{ text = text $0 " " }

# The name that a member is declared by: x, *x, x[3], (*x)[3], (*x)(int).
function name_of(declarator) {
    if (match(declarator, /\( *\*[^()]*\)/)) {
        declarator = substr(declarator, RSTART + 1, RLENGTH - 2)
        sub(/^ *\*/, "", declarator)
    }
    gsub(/\[[^]]*\]/, "", declarator)
    gsub(/ +$/, "", declarator)
    sub(/^.*[^A-Za-z0-9_]/, "", declarator)
    return declarator
}

function print_struct(name, body,    i, k, members, parts, count, many) {
    printf "    printf(\"%s %%zu\\n\", sizeof(%s));\n", name, name
    count = split(body, members, ";")
    for (i = 1; i < count; i++) {
        many = 1
        if (members[i] ~ /\( *\*/)
            parts[1] = members[i]
        else
            many = split(members[i], parts, ",")
        for (k = 1; k <= many; k++)
            printf "    printf(\"%s.%s %%zu %%zu\\n\", offsetof(%s, %s), sizeof(((%s *)0)->%s));\n",
                name, name_of(parts[k]), name, name_of(parts[k]), name, name_of(parts[k])
    }
}

function print_enum(body,    i, names, count) {
    count = split(body, names, ",")
    for (i = 1; i <= count; i++) {
        sub(/=.*/, "", names[i])
        gsub(/[^A-Za-z0-9_]/, "", names[i])
        if (names[i] != "" && names[i] !~ /_(COUNT|ALL)$/)
            printf "    printf(\"%s %%d\\n\", (int)%s);\n", names[i], names[i]
    }
}

END {
    print "#include <stdio.h>"
    print "#include <krs/camera.h>"
    print "#include <krs/vulkan.h>"
    print "int main(void)\n{"
    while (match(text, /typedef (struct|enum) Krs[A-Za-z0-9]+ *\{/)) {
        head = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        body = substr(text, 1, index(text, "}") - 1)
        split(head, words, /[ {]+/)
        if (words[2] == "struct")
            print_struct(words[3], body)
        else
            print_enum(body)
    }
    print "    return 0;\n}"
}
