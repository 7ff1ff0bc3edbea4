/*
 * modules.c: compiles the shaders of the runtime for a scene, and reads in the result where
 * its buffers are bound.
 */
#include "cli/modules.h"

#include <stdlib.h>
#include <string.h>

#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "compiler/base/embedded.h"
#include "runtime/tracer/variants.h"

/* The parts of a module that are looked at, with their numbers in the SPIR-V specification. */
enum {
    HEADER_WORDS       = 5,
    BOUND_WORD         = 3, /* ids are below the bound */
    OP_NAME            = 5,
    OP_EXECUTION_MODE  = 16,
    OP_TYPE_POINTER    = 32,
    OP_VARIABLE        = 59,
    OP_DECORATE        = 71,
    MODE_LOCAL_SIZE    = 17,
    DECORATION_BINDING = 33,
    DECORATION_SET     = 34
};

static bool is_shader(const char *file)
{
    size_t length = strlen(file);
    return length > 5 && strcmp(file + length - 5, ".comp") == 0;
}

KrsVariant compiled_variant(const Options *options)
{
    return (KrsVariant){.many_threads = options->early_outs != KRS_EARLY_OUTS_OFF,
                        .values       = !options->no_frame_values};
}

static KrsStatus compile_shader(const Options *options, const KrsScene *scene, const char *file,
                                Modules *modules)
{
    Gpu           gpu     = {0}; /* stays closed: it only carries the reason of a failure */
    KrsVariant    chosen  = compiled_variant(options);
    ShaderVariant variant = variant_for_any(scene, file, &chosen);
    ShaderSource  source  = variant_source(file, &variant);
    char         *text    = shader_text(&gpu, &source);
    char         *log     = NULL;
    if (!text) {
        say("%s", gpu.message);
        return gpu.status;
    }
    const char *slash  = strrchr(file, '/'); /* of a room of shaders */
    const char *name   = slash ? slash + 1 : file;
    SpirvModule module = {.file  = file,
                          .entry = arena_copy_text(options->arena, name, strlen(name) - 5)};
    KrsStatus   status = spirv_compile(text, file, &module.words, &module.word_count, &log);
    if (status == KRS_OK)
        array_push(options->arena, modules, module);
    else if (status == KRS_OUT_OF_MEMORY)
        say("out of memory while compiling `%s`", file);
    else {
        say("a bug of krs: the shader `%s` does not compile for this scene", file);
        fprintf(stderr, "%s\n", log ? log : "");
    }
    free(log);
    gpu_release(&gpu, text);
    return status;
}

KrsStatus modules_compile(const Options *options, const KrsScene *scene, Modules *modules)
{
    KrsStatus status = scene_check_shaders(options, scene);
    *modules         = (Modules){0};
    stage_enter(STAGE_SHADERS);
    spirv_start();
    for (const EmbeddedFile *file = shader_files; file->name && status == KRS_OK; file++)
        if (is_shader(file->name))
            status = compile_shader(options, scene, file->name, modules);
    spirv_stop();
    stage_enter(STAGE_START);
    return status;
}

void modules_free(Modules *modules)
{
    for (size_t i = 0; i < modules->count; i++)
        free(modules->items[i].words);
    *modules = (Modules){0};
}

/* The properties of an id of a module. */
typedef struct IdInfo {
    const char *name;
    uint32_t    set, binding, type;
    bool        bound; /* has a binding */
} IdInfo;

static void read_instruction(const uint32_t *word, uint32_t op, IdInfo *ids, uint32_t size[3])
{
    if (op == OP_NAME)
        ids[word[1]].name = (const char *)&word[2]; /* NUL-terminated, little-endian */
    if (op == OP_TYPE_POINTER)
        ids[word[1]].type = word[3];
    if (op == OP_VARIABLE)
        ids[word[2]].type = word[1];
    if (op == OP_EXECUTION_MODE && word[2] == MODE_LOCAL_SIZE)
        memcpy(size, word + 3, 3 * sizeof *size);
    if (op == OP_DECORATE && word[2] == DECORATION_SET)
        ids[word[1]].set = word[3];
    if (op == OP_DECORATE && word[2] == DECORATION_BINDING) {
        ids[word[1]].binding = word[3];
        ids[word[1]].bound   = true;
    }
}

/* A block without an instance name is known by the name of its type. */
static const char *binding_name(const IdInfo *ids, const IdInfo *variable)
{
    if (variable->name && variable->name[0])
        return variable->name;
    const char *name = ids[ids[variable->type].type].name;
    return name ? name : "";
}

void module_add_json(Json *json, const SpirvModule *module)
{
    uint32_t bound = module->words[BOUND_WORD], size[3] = {1, 1, 1};
    IdInfo  *ids = arena_new_array(json->text.arena, IdInfo, bound);
    for (size_t at = HEADER_WORDS; at < module->word_count;) {
        const uint32_t *word = &module->words[at];
        read_instruction(word, *word & 0xffff, ids, size);
        at += *word >> 16;
    }

    json_open(json, NULL, "{");
    json_text(json, "entry", module->entry);
    json_open(json, "workgroup", "[");
    for (int i = 0; i < 3; i++)
        json_whole(json, NULL, size[i]);
    json_close(json, "]");
    json_open(json, "bindings", "[");
    for (uint32_t id = 0; id < bound; id++) {
        if (!ids[id].bound)
            continue;
        json_open(json, NULL, "{");
        json_whole(json, "set", ids[id].set);
        json_whole(json, "binding", ids[id].binding);
        json_text(json, "name", binding_name(ids, &ids[id]));
        json_close(json, "}");
    }
    json_close(json, "]");
    json_close(json, "}");
}
