/*
 * input.c: scenes that are no files of their own: standard input, which is called `-`, and packs.
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
        if (strcmp(options->files.items[i], "-") != 0 || !takes_scenes(options->command))
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

Pack *pack_of(const Options *options, const char *path)
{
    Pack *pack = options->packs;
    while (pack && strcmp(pack->path, path) != 0)
        pack = pack->next;
    return pack;
}

/* Reports a command that needs a file which can be saved; KRS_OK: packs will do. */
static KrsStatus check_use(const Options *options, const char *path)
{
    switch (options->command) {
    case COMMAND_WATCH: return say_usage(options, "a pack does not change; render `%s`", path);
    case COMMAND_FORMAT: return say_usage(options, "`%s` is a pack, not a text", path);
    case COMMAND_FARM:
        return options->untrusted == UNTRUSTED
                   ? say_usage(options,
                               "a stranger's pack is opened in a sandbox alone, and farm has "
                               "none itself; submit its scene, or give --untrusted=limits")
                   : KRS_OK;
    case COMMAND_PACK: return say_usage(options, "`%s` is a pack already", path);
    default: return KRS_OK;
    }
}

KrsStatus packs_open(Options *options)
{
    const uint64_t limit  = options->limits.memory ? options->limits.memory : KRS_USUAL_MEMORY;
    KrsStatus      status = KRS_OK;
    if (!takes_scenes(options->command))
        return KRS_OK;
    for (size_t i = 0; i < options->files.count && status == KRS_OK; i++) {
        const char *path = options->files.items[i];
        if (!pack_is_named(path))
            continue;
        status = check_use(options, path);
        if (status != KRS_OK)
            break;
        Text  why  = {.arena = options->arena};
        Pack *pack = pack_read(options->arena, path, (size_t)limit, &why);
        if (!pack) {
            say("cannot read `%s`: %s", path, why.bytes);
            return KRS_IO_ERROR;
        }
        pack->next     = options->packs;
        options->packs = pack;
    }
    return status;
}
