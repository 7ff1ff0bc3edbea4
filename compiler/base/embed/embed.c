/*
 * embed.c: a build tool that writes files as a C array, so that the program contains them.
 * `embed NAME PREFIX... -- FILE...` prints `const EmbeddedFile NAME[]`.  The first PREFIX that a file's name begins with
 * is cut from it.
 */
#include <stdio.h>
#include <string.h>

/* Tells how much of a path the first prefix is that it begins with; prefixes end with "--". */
static size_t prefix_length(const char *path, char **prefixes)
{
    for (; strcmp(*prefixes, "--") != 0; prefixes++)
        if (strncmp(path, *prefixes, strlen(*prefixes)) == 0)
            return strlen(*prefixes);
    return 0;
}

static int embed(const char *path, char **prefixes)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return 1;
    }
    printf("    {\"%s\", (const char[]){", path + prefix_length(path, prefixes));
    size_t length = 0;
    for (int c; (c = getc(file)) != EOF; length++)
        printf(length % 20 == 0 ? "\n%d," : "%d,", c > 127 ? c - 256 : c);
    printf("0}, %zu},\n", length);
    return fclose(file) != 0;
}

int main(int argc, char **argv)
{
    int first = 2;
    while (first < argc && strcmp(argv[first], "--") != 0)
        first++;
    if (first >= argc) {
        fprintf(stderr, "usage: embed NAME PREFIX... -- FILE...\n");
        return 2;
    }
    printf("#include \"compiler/base/embedded.h\"\nconst EmbeddedFile %s[] = {\n", argv[1]);
    for (int i = first + 1; i < argc; i++)
        if (embed(argv[i], argv + 2) != 0)
            return 1;
    printf("    {0, 0, 0}\n};\n");
    return fflush(stdout) != 0;
}
