/*
 * format.c: `krs format`: scenes in canonical layout.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/input.h"
#include "cli/shell/supervise.h"

/* Hands a text on: to its file, to standard output, or only its name where that would change. */
static KrsStatus deliver(const Options *options, const char *path, const char *text, bool same)
{
    KrsStatus status = KRS_OK;
    stage_enter(STAGE_ANSWER);
    if (options->check && !same) {
        puts(isatty(STDOUT_FILENO) ? console_name(options, path) : path);
        status = KRS_BAD_SCENE;
    } else if (!options->check && is_input(options, path)) {
        fputs(text, stdout);
    } else if (!options->check && !same) {
        status = write_output_text(path, text, strlen(text));
    }
    return status;
}

static KrsStatus format_file(const Options *options, const char *path)
{
    KrsStatus status = scene_readable(options, path);
    if (status != KRS_OK)
        return status;
    char          *text;
    bool           same;
    DiagnosticSink sink = {.options = options};
    KrsOptions     with = scene_options(&sink, path);
    scene_enter_compile(path);
    const char *input = scene_input(options, path);
    status = input ? krs_format_text(input, options->input_length, path, &with, &text, &same)
                   : krs_format_file(path, &with, &text, &same);
    scene_print_counts(&sink);
    if (status == KRS_OK)
        status = deliver(options, path, text, same);
    else
        say_status(status, path);
    free(text);
    return status;
}

/* Goes through all files and returns the status of the first that failed. */
KrsStatus command_format(Options *options)
{
    KrsStatus worst = KRS_OK;
    for (size_t i = 0; i < options->files.count; i++) {
        KrsStatus status = format_file(options, options->files.items[i]);
        worst            = worst == KRS_OK ? status : worst;
    }
    return worst;
}
