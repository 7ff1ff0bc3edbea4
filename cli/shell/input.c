/*
 * input.c: a scene on standard input, which is called `-`.
 */
#include "cli/shell/input.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/shell/console.h"
#include "compiler/base/text.h"

/* The name that standard input has in diagnostics. */
static const char input_name[] = "<stdin>";

/* A little more than a scene may have: then the compiler refuses it. */
enum { MAX_INPUT = 17 << 20 };

static KrsStatus read_input(Options *options)
{
    static char piece[1 << 14];
    Text        text = {.arena = options->arena};
    size_t      got  = 1;
    text_add(&text, "");
    while (got > 0 && text.length <= MAX_INPUT) {
        got = fread(piece, 1, sizeof piece, stdin);
        text_add_bytes(&text, piece, got);
    }
    if (ferror(stdin)) {
        say("cannot read standard input: %s", strerror(errno));
        return KRS_IO_ERROR;
    }
    options->input        = text.bytes;
    options->input_length = text.length;
    return KRS_OK;
}

KrsStatus input_open(Options *options)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < options->files.count && status == KRS_OK; i++) {
        if (strcmp(options->files.items[i], "-") != 0 || options->command == COMMAND_IMPORT ||
            command_table[options->command].files == MAYBE_A_WORD)
            continue;
        if (options->command == COMMAND_QUERY)
            return say_usage(options, "standard input has the questions, so the scene is a file");
        if (options->input)
            return say_usage(options, "`-` is one scene, and can be given once");
        options->files.items[i] = input_name;
        status                  = read_input(options);
    }
    return status;
}

bool is_input(const Options *options, const char *path)
{
    return options->input && strcmp(path, input_name) == 0;
}
