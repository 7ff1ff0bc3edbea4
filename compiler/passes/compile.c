/*
 * compile.c: the whole compiler: run_passes() takes a scene through the passes of passes.def.
 */
#include "compiler/passes/compile.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/passes/compilation.h"
#include "compiler/base/allocator.h"
#include "compiler/base/clock.h"
#include "compiler/front/format.h"

static const Request scene_alone = {.after = PASS_COUNT, .end = PASS_COUNT};

/* ---- the passes ---- */

typedef struct Pass {
    KrsPass about;
    KrsStatus (*run)(Compilation *c);
    void (*validate)(const Compilation *c); /* or NULL */
    void (*print)(Compilation *c, Text *out);
} Pass;

static const Pass passes[PASS_COUNT] = {
#define PASS(name, validate, meaning) PASS_TO(#name, name, validate, meaning)
#define PASS_TO(form, name, validate, meaning) \
    [PASS_##name] = {{#name, form, meaning}, pass_##name, validate, print_##name},
#include "compiler/passes/passes.def"
};

const KrsPass *krs_pass(size_t index) { return index < PASS_COUNT ? &passes[index].about : NULL; }

/* Returns the pass with this name or form, or PASS_COUNT. */
static PassId find_pass(const char *word)
{
    PassId id = 0;
    while (id < PASS_COUNT && strcmp(passes[id].about.name, word) != 0 &&
           strcmp(passes[id].about.form, word) != 0)
        id++;
    return id;
}

const KrsPass *krs_find_pass(const char *word) { return krs_pass(find_pass(word)); }

static double now_ms(void) { return 1e3 * clock_seconds(CLOCK_MONOTONIC); }

static KrsStatus run_pass(Compilation *c, const Pass *pass, double *ms)
{
    double    start  = now_ms();
    KrsStatus status = pass->run(c);
    arena_free(&c->scratch);
    if (status == KRS_OK && pass->validate)
        pass->validate(c);
    *ms = now_ms() - start;
    return status;
}

/* Runs all passes; ends at the first one that refuses the scene. */
static KrsStatus run_passes(Compilation *c)
{
    KrsProgram *program = &c->scene->program;
    double     *ms      = arena_new_array(&c->scene->arena, double, PASS_COUNT);
    KrsStatus   status  = KRS_OK;
    program->pass_ms    = ms;
    for (PassId id = 0; id < c->request->end && status == KRS_OK; id++) {
        status = run_pass(c, &passes[id], &ms[id]);
        if (status == KRS_OK && c->request->after == id) {
            passes[id].print(c, &c->dump);
            arena_free(&c->scratch);
        }
        program->front_ms += id < PASS_emit ? ms[id] : 0;
    }
    program->glsl_ms = ms[PASS_emit];
    return status;
}

static KrsStatus inspect(Compilation *c)
{
    c->diags.count = c->diags.warnings = 0;
    return c->request->inspect(
        c->request->user,
        &(Inspected){&c->elaborated, &c->diags, &c->work, &c->scratch, c->scene->program.pass_ms});
}

static KrsStatus format(Compilation *c)
{
    uint32_t source = c->files.items[0]->source;
    if (c->diags.errors > 0)
        return KRS_BAD_SCENE;
    if (!format_source(source, &c->sources, &c->scratch, &c->dump))
        return KRS_INTERNAL;
    const Source *text  = &c->sources.items[source];
    *c->request->format = text->length == c->dump.length &&
                          (text->length == 0 ||
                           memcmp(text->text, c->dump.bytes, text->length) == 0);
    return KRS_OK;
}

/* ---- the API ---- */

static KrsDiagnostic make_public(const Diags *diags, const Diag *diag, Arena *arena)
{
    const Source *source   = &diags->sources->items[diag->span.source];
    Position      position = source_position(source, diag->span.start);
    Text          text = {.arena = arena}, json = {.arena = arena};
    diag_print_one(diags, diag, false, &text);
    diag_json_one(diags, diag, &json);
    DiagSeverity severity = diag_info[diag->code].severity;
    return (KrsDiagnostic){.error   = severity == DIAG_ERROR,
                           .note    = severity == DIAG_NOTE,
                           .code    = diag_info[diag->code].code,
                           .message = diag->message,
                           .source  = source->name,
                           .line    = position.line,
                           .column  = position.column,
                           .text    = text.bytes,
                           .json    = json.bytes};
}

static void report(Compilation *c)
{
    const KrsOptions *options = c->options;
    diags_sort(&c->diags);
    for (size_t i = 0; options->diagnostic && i < c->diags.count; i++) {
        const KrsDiagnostic public = make_public(&c->diags, c->diags.items[i], &c->scratch);
        options->diagnostic(options->user, &public);
    }
}

/* Keeps for the scene why no shader is made of it. */
static void retain_too_large(Compilation *c)
{
    Arena *arena = &c->scene->arena;
    if (c->of_shaders.count == 0)
        return;
    KrsDiagnostic *kept = arena_new(arena, KrsDiagnostic);
    *kept               = make_public(&c->of_shaders, c->of_shaders.items[0], arena);
    kept->message       = arena_copy_text(arena, kept->message, strlen(kept->message));
    kept->source        = arena_copy_text(arena, kept->source, strlen(kept->source));
    c->scene->too_large = kept;
}

/* Runs the passes, and reports their diagnostics.  Where memory runs out, longjmp returns here. */
static KrsStatus run_guarded(Compilation *c)
{
    jmp_buf exhausted;
    c->scene->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    KrsStatus status = run_passes(c);
    if (status == KRS_OK && c->request->inspect)
        status = inspect(c);
    if (status == KRS_OK && c->request->format)
        status = format(c);
    if (status == KRS_OK && c->request->words)
        words_print(c, &c->dump);
    report(c);
    if (status == KRS_OK)
        retain_too_large(c);
    return status;
}

/* The number of scenes made so far, so that each has shaders of its own, until it is found to have
   those of another. */
static atomic_uint_fast64_t scenes_made;

/* Returns an empty scene in memory of the options' allocator; NULL if there is no memory. */
static KrsScene *scene_new(const KrsOptions *options)
{
    const KrsAllocator *allocator = &options->allocator;
    KrsScene *scene = allocator->allocate ? allocator->allocate(allocator->user, sizeof *scene)
                                          : malloc(sizeof *scene);
    if (!scene)
        return NULL;
    memset(scene, 0, sizeof *scene);
    scene->memory          = (Memory){allocator->allocate,
                                      allocator->release,
                                      allocator->user,
                                      0,
                             options->memory_limit ? options->memory_limit : KRS_USUAL_MEMORY,
                                      NULL};
    scene->arena           = (Arena){.memory = &scene->memory};
    scene->program.shaders = atomic_fetch_add(&scenes_made, 1);
    return scene;
}

/* Prepares the arenas of a run, and all that uses them. */
static void begin(Compilation *c)
{
    c->work = c->syntax = c->values = c->scratch = (Arena){.memory = &c->scene->memory};
    c->sources                                   = (Sources){.arena = &c->work};
    c->names                                     = (Names){.arena = &c->work};
    c->diags      = (Diags){.arena = &c->work, .sources = &c->sources};
    c->of_shaders = c->diags;
    c->dump       = (Text){.arena = &c->work};
    c->files      = (Files){.arena   = &c->work,
                            .trees   = &c->syntax,
                            .scratch = &c->scratch,
                            .diags   = &c->diags,
                            .names   = &c->names,
                            .sources = &c->sources,
                            .loader  = c->loader};
}

static void end(Compilation *c)
{
    free(c->loaded.owned);
    arena_free(&c->work);
    arena_free(&c->syntax);
    arena_free(&c->values);
    arena_free(&c->scratch);
    c->scene->memory.exhausted = NULL;
}

static KrsStatus compile(Compilation *c, KrsScene **result)
{
    c->scene = scene_new(c->options);
    if (!c->scene)
        return KRS_OUT_OF_MEMORY;
    begin(c);
    KrsStatus status = run_guarded(c);
    if (c->request->dump && status != KRS_OUT_OF_MEMORY)
        *c->request->dump = strdup(c->dump.bytes ? c->dump.bytes : "");
    end(c);
    if (status == KRS_OK)
        *result = c->scene;
    else
        scene_free(c->scene);
    return status;
}

/* Compiles a text or, when that is NULL, the file `name`. */
static KrsStatus load_and_compile(const char *text, size_t length, const char *name,
                                  const KrsOptions *options, const Request *request,
                                  KrsScene **scene)
{
    static const KrsOptions defaults = {0};
    options                          = options ? options : &defaults;
    *scene                           = NULL;
    if (!name)
        return KRS_BAD_ARGUMENT;
    Loader      loader = {.supplier      = options->load,
                          .user          = options->load_user,
                          .observer      = options->opened,
                          .observer_user = options->opened_user,
                          .fonts         = options->font,
                          .fonts_user    = options->font_user};
    KrsStatus   status = KRS_OUT_OF_MEMORY;
    Compilation c      = {.request = request,
                          .options = options,
                          .loader  = &loader,
                          .name    = name,
                          .loaded  = {.text = text, .length = text ? length : 0}};
    if (!text && options->text) /* as programs for 0.2 do */
        c.loaded = (Loaded){.text = options->text, .length = options->text_length};
    if (loader_open(&loader, options->root, name))
        status = compile(&c, scene);
    loader_close(&loader);
    return status;
}

const char *krs_version(void) { return KRS_VERSION; }

KrsStatus krs_compile_text(const char *text, size_t length, const char *name,
                           const KrsOptions *options, KrsScene **scene)
{
    if (!text && length > 0) {
        *scene = NULL;
        return KRS_BAD_ARGUMENT;
    }
    return load_and_compile(text ? text : "", length, name, options, &scene_alone, scene);
}

KrsStatus krs_check_text(const char *text, size_t length, const char *name,
                         const KrsOptions *options)
{
    KrsScene *scene;
    Request   request = {.after = PASS_COUNT, .end = PASS_frame};
    KrsStatus status  = load_and_compile(text, length, name, options, &request, &scene);
    scene_free(scene);
    return status;
}

KrsStatus krs_compile_file(const char *path, const KrsOptions *options, KrsScene **scene)
{
    return load_and_compile(NULL, 0, path, options, &scene_alone, scene);
}

KrsStatus krs_dump(const char *text, size_t length, const char *name, const char *after,
                   const KrsOptions *options, char **dump)
{
    KrsScene *scene;
    Request   request = {.after = find_pass(after), .end = PASS_COUNT, .dump = dump};
    *dump             = NULL;
    if (request.after == PASS_COUNT)
        return KRS_BAD_ARGUMENT;
    KrsStatus status = load_and_compile(text, length, name, options, &request, &scene);
    scene_free(scene);
    return status;
}

/* Copies a text to memory of the caller's allocator. */
static KrsStatus hand_out(const KrsOptions *options, const char *text, char **copy)
{
    const size_t length = strlen(text);
    *copy = allocator_new(options ? &options->allocator : &(KrsAllocator){0}, length, 1);
    return *copy ? (memcpy(*copy, text, length), KRS_OK) : KRS_OUT_OF_MEMORY;
}

/* Hands out the dump of a request. */
static KrsStatus print_text(const char *text, size_t length, const char *name,
                            const KrsOptions *options, Request request, char **result)
{
    KrsScene *scene;
    char     *found  = NULL;
    request.after    = PASS_COUNT;
    request.dump     = &found;
    *result          = NULL;
    KrsStatus status = load_and_compile(text, length, name, options, &request, &scene);
    scene_free(scene);
    if (status == KRS_OK && !found)
        status = KRS_OUT_OF_MEMORY;
    if (status == KRS_OK)
        status = hand_out(options, found, result);
    free(found);
    return status;
}

static KrsStatus format_text(const char *text, size_t length, const char *name,
                             const KrsOptions *options, char **formatted, bool *same)
{
    *same = false;
    return print_text(text, length, name, options, (Request){.end = PASS_parse + 1, .format = same},
                      formatted);
}

KrsStatus krs_format_text(const char *text, size_t length, const char *name,
                          const KrsOptions *options, char **formatted, bool *same)
{
    *formatted = NULL;
    *same      = false;
    if (!text && length > 0)
        return KRS_BAD_ARGUMENT;
    return format_text(text ? text : "", length, name, options, formatted, same);
}

KrsStatus krs_format_file(const char *path, const KrsOptions *options, char **formatted, bool *same)
{
    return format_text(NULL, 0, path, options, formatted, same);
}

KrsStatus krs_words(const KrsAllocator *allocator, char **json)
{
    const KrsOptions options = {.allocator = allocator ? *allocator : (KrsAllocator){0}};
    jmp_buf          exhausted;
    Memory           memory = {.allocate  = options.allocator.allocate,
                               .release   = options.allocator.release,
                               .user      = options.allocator.user,
                               .exhausted = &exhausted};
    Arena            arena  = {.memory = &memory};
    Text             scene  = {.arena = &arena};
    *json                   = NULL;
    if (setjmp(exhausted) != 0) {
        arena_free(&arena);
        return KRS_OUT_OF_MEMORY;
    }
    words_use_library(&scene);
    const KrsStatus status = print_text(scene.bytes, scene.length, "words.krs", &options,
                                        (Request){.end = PASS_names + 1, .words = true}, json);
    arena_free(&arena);
    return status;
}

KrsStatus inspect_text(const char *text, size_t length, const char *name, const KrsOptions *options,
                       Inspect *visit, void *user)
{
    KrsScene *scene;
    Request   request = {.after = PASS_COUNT, .end = PASS_COUNT, .inspect = visit, .user = user};
    KrsStatus status  = load_and_compile(text, length, name, options, &request, &scene);
    scene_free(scene);
    return status;
}

KrsStatus inspect_elaborated(const char *text, size_t length, const KrsOptions *options,
                             Inspect *visit, void *user)
{
    KrsScene *scene;
    Request   request = {
          .after = PASS_COUNT, .end = PASS_elaborate + 1, .inspect = visit, .user = user};
    KrsStatus status = load_and_compile(text, length, "scene.krs", options, &request, &scene);
    scene_free(scene);
    return status;
}

KrsStatus compile_with_instances(const char *text, size_t length, uint32_t least,
                                 const KrsOptions *options, KrsScene **scene)
{
    Request request = {.after = PASS_COUNT, .end = PASS_COUNT, .min_instances = least};
    return load_and_compile(text, length, "scene.krs", options, &request, scene);
}

KrsStatus compile_iteration_by_iteration(const char *text, size_t length, uint32_t least,
                                         const KrsOptions *options, KrsScene **scene)
{
    Request request = {
        .after = PASS_COUNT, .end = PASS_COUNT, .min_instances = least, .single_iterations = true};
    return load_and_compile(text, length, "scene.krs", options, &request, scene);
}
