/*
 * dump.c: `krs dump`: what any pass of the compiler has made of the scene, as text.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/modules.h"
#include "cli/shell/supervise.h"

/* SPIR-V comes behind the passes that the library knows, one module for each shader. */
static KrsStatus dump_spirv(const Options *options, const char *path)
{
    KrsScene *scene;
    Modules   modules;
    KrsStatus status = scene_open(options, path, &scene);
    if (status != KRS_OK)
        return status;
    status = modules_compile(options, scene, &modules);
    for (size_t i = 0; i < modules.count && status == KRS_OK; i++) {
        char *text = spirv_disassemble(modules.items[i].words, modules.items[i].word_count);
        if (!text)
            status = say_status(KRS_OUT_OF_MEMORY, path);
        else
            printf("; %s\n%s", modules.items[i].file, text);
        free(text);
    }
    modules_free(&modules);
    krs_scene_free(scene);
    return status;
}

KrsStatus command_dump(Options *options)
{
    const char *path = options->files.items[0];
    if (strcmp(options->after, "spirv") == 0)
        return dump_spirv(options, path);
    KrsStatus status = scene_readable(options, path);
    if (status != KRS_OK)
        return status;
    char          *text = NULL;
    DiagnosticSink sink = {.options = options};
    KrsOptions     with = scene_options(&sink, path);
    scene_enter_compile(path);
    status = krs_dump(scene_input(options, path), options->input_length, path, options->after,
                      &with, &text);
    scene_print_counts(&sink);
    stage_enter(STAGE_ANSWER);
    if (text)
        fputs(text, stdout);
    free(text);
    return say_status(status, path);
}
