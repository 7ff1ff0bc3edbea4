/*
 * embed.c: a build tool that writes files as a C array, so that the program contains them.
 * `embed NAME PREFIX FILE...` prints `const EmbeddedFile NAME[]`.  PREFIX is cut from file names.
 */
#include <stdio.h>
#include <string.h>

static int embed(const char *path, const char *prefix)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return 1;
    }
    size_t skip = strncmp(path, prefix, strlen(prefix)) == 0 ? strlen(prefix) : 0;
    printf("    {\"%s\", (const char[]){", path + skip);
    size_t length = 0;
    for (int c; (c = getc(file)) != EOF; length++)
        printf(length % 20 == 0 ? "\n%d," : "%d,", c > 127 ? c - 256 : c);
    printf("0}, %zu},\n", length);
    return fclose(file) != 0;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: embed NAME PREFIX FILE...\n");
        return 2;
    }
    printf("#include \"compiler/base/embedded.h\"\nconst EmbeddedFile %s[] = {\n", argv[1]);
    for (int i = 3; i < argc; i++)
        if (embed(argv[i], argv[2]) != 0)
            return 1;
    printf("    {0, 0, 0}\n};\n");
    return fflush(stdout) != 0;
}
