/*
 * compile.c: `krs compile`: the shaders of a scene and their description, as files.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/modules.h"
#include "cli/supervise.h"

/* The folder is made if it is missing, but not the folders above it. */
static KrsStatus make_folder(const char *folder)
{
    struct stat info;
    if (mkdir(folder, 0777) == 0)
        return KRS_OK;
    int reason = errno;
    if (reason == EEXIST) {
        if (stat(folder, &info) == 0 && S_ISDIR(info.st_mode))
            return KRS_OK;
        reason = ENOTDIR;
    }
    say("cannot create `%s`: %s", folder, strerror(reason));
    return KRS_CANNOT_CREATE;
}

static KrsStatus write_output_file(const Options *options, const char *base, const char *ending,
                                   const void *bytes, size_t length)
{
    Text path = {.arena = options->arena};
    text_format(&path, "%s%s", base, ending);
    return write_output_text(path.bytes, bytes, length);
}

static KrsStatus write_description(const Options *options, const KrsScene *scene,
                                   const Modules *modules, const char *base, const char *name)
{
    Text json = {.arena = options->arena};
    text_add(&json, "{\"name\": ");
    text_json(&json, name);
    text_add(&json, ", ");
    info_add_json(&json, scene);
    text_format(&json, ", \"parameter_slots\": %zu, \"value_slots\": %zu, \"entries\": [",
                krs_parameter_slots(scene), krs_value_slots(scene));
    for (size_t i = 0; i < modules->count; i++) {
        text_add(&json, i == 0 ? "" : ", ");
        module_add_json(&json, &modules->items[i]);
    }
    text_add(&json, "]}\n");
    return write_output_file(options, base, ".json", json.bytes, json.length);
}

/* The functions that are promised, and what they call. */
static KrsStatus write_glsl(const Options *options, const KrsScene *scene, const char *base)
{
    KrsVariant  variant = compiled_variant(options);
    KrsFunction promised[KRS_MOST_PROMISED];
    variant.shares = true;
    size_t count   = krs_promised_functions(scene, variant.many_threads, promised);
    char  *glsl    = krs_scene_text(scene, &variant, promised, count, NULL);
    if (!glsl) {
        say("out of memory while printing `%s.glsl`", base);
        return KRS_OUT_OF_MEMORY;
    }
    KrsStatus status = write_output_file(options, base, ".glsl", glsl, strlen(glsl));
    free(glsl);
    return status;
}

/* Everything is compiled before anything is written. */
static KrsStatus write_all(const Options *options, const KrsScene *scene, const Modules *modules)
{
    const char *name = scene_name(options->arena, options->files.items[0]);
    Text        base = {.arena = options->arena};
    text_format(&base, "%s/%s", options->outputs.items[0], name);
    KrsStatus status = make_folder(options->outputs.items[0]);
    if (status == KRS_OK)
        status = write_glsl(options, scene, base.bytes);
    for (size_t i = 0; i < modules->count && status == KRS_OK; i++) {
        const SpirvModule *module = &modules->items[i];
        Text               ending = {.arena = options->arena};
        text_format(&ending, ".%s.spv", module->entry);
        status = write_output_file(options, base.bytes, ending.bytes, module->words,
                                   module->word_count * sizeof *module->words);
    }
    if (status == KRS_OK)
        status = write_description(options, scene, modules, base.bytes, name);
    return status;
}

KrsStatus command_compile(Options *options)
{
    KrsScene *scene;
    Modules   modules;
    KrsStatus status = scene_open(options, options->files.items[0], &scene);
    if (status != KRS_OK)
        return status;
    status = modules_compile(options, scene, &modules);
    if (status == KRS_OK)
        status = write_all(options, scene, &modules);
    modules_free(&modules);
    krs_scene_free(scene);
    return status;
}
