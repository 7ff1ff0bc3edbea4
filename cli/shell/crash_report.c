/*
 * crash_report.c: what is kept of a crash.
 */
#include "cli/shell/crash_report.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/shell/console.h"

/* Copies regular files only: a pipe may never have a writer, a device never end. */
static void copy_file(const char *from, const char *to)
{
    char        buffer[65536];
    struct stat about;
    ssize_t     length = 0;
    int         source = open(from, O_RDONLY | O_CLOEXEC | O_NONBLOCK), target = -1;
    if (source >= 0 && fstat(source, &about) == 0 && S_ISREG(about.st_mode))
        target = open(to, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    while (target >= 0 && (length = read(source, buffer, sizeof buffer)) > 0)
        if (write(target, buffer, (size_t)length) != length)
            break;
    if (source >= 0)
        close(source);
    if (target >= 0)
        close(target);
}

/* Prints a word in single quotes, which keep every byte in a shell except themselves. */
static void print_quoted(FILE *out, const char *word)
{
    fputc('\'', out);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", out);
        else
            fputc(*word, out);
    fputc('\'', out);
}

static void copy_scenes(const Options *options, const char *folder)
{
    for (size_t i = 0; i < options->files.count; i++) {
        const char *from = options->files.items[i], *slash = strrchr(from, '/');
        char       *to;
        if (asprintf(&to, "%s/%zu-%s", folder, i + 1, slash ? slash + 1 : from) < 0)
            return;
        copy_file(from, to);
        free(to);
    }
}

static void write_command(const Options *options, const char *folder, const char *story)
{
    char *path;
    if (asprintf(&path, "%s/command.txt", folder) < 0)
        return;
    FILE *out = fopen(path, "w");
    free(path);
    if (!out)
        return;
    fprintf(out, "krs %s: %s\n\ncommand:", KRS_VERSION, story);
    for (int i = 0; i < options->argc; i++) {
        fputc(' ', out);
        print_quoted(out, options->argv[i]);
    }
    fputs("\nscenes:", out);
    for (size_t i = 0; i < options->files.count; i++)
        fprintf(out, " %s", options->files.items[i]);
    fputc('\n', out);
    fclose(out);
}

int report_bug(const Options *options, const char *story)
{
    char       *folder;
    const char *parent = getenv("TMPDIR");
    if (asprintf(&folder, "%s/krs-crash-XXXXXX", parent && *parent ? parent : "/tmp") < 0)
        folder = NULL;
    if (folder && mkdtemp(folder)) {
        copy_scenes(options, folder);
        write_command(options, folder, story);
        say("%s; this is a bug of krs or of the driver; what is needed to see it again is in %s",
            story, folder);
    } else {
        say("%s; this is a bug of krs or of the driver", story);
    }
    free(folder);
    return KRS_INTERNAL;
}
