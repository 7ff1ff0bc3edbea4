/*
 * compile.c: the whole compiler: each step of run() turns one form of the scene into the next.
 */
#include "compiler/compile.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "compiler/compilation.h"
#include "compiler/framing.h"

static const size_t DEFAULT_MEMORY = (size_t)2 << 30;

const char *const dump_stage_names[DUMP_STAGE_COUNT] = {"tokens", "syntax",   "scene",
                                                        "graph",  "simplify", "glsl"};

static const Request scene_alone = {.stage = DUMP_STAGE_COUNT};

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static bool dumps(const Compilation *c, DumpStage stage) { return c->request->stage == stage; }

/* ---- steps ---- */

static void dump_front(Compilation *c, uint32_t source)
{
    if (!dumps(c, DUMP_TOKENS) && !dumps(c, DUMP_SYNTAX))
        return;
    Diags  silent = {.arena = &c->scratch, .sources = &c->sources};
    Tokens tokens = lex(source, &c->sources, &c->names, &silent, &c->scratch);
    if (dumps(c, DUMP_TOKENS))
        tokens_print(&tokens, &c->sources, &c->dump);
    else
        syntax_print(parse(&tokens, &silent, &c->scratch), &c->sources, &c->dump);
}

static Graph *elaborate_scene(Compilation *c)
{
    uint32_t source = source_add(&c->sources, c->name, c->text, c->length, false);
    dump_front(c, source);
    Graph *graph  = graph_new(&c->work);
    c->elaborated = (Scene){.graph = graph, .zenith = NODE_NONE, .zone = NODE_NONE};
    Elaboration e = {.arena      = &c->work,
                     .syntax     = &c->syntax,
                     .scratch    = &c->scratch,
                     .diags      = &c->diags,
                     .names      = &c->names,
                     .sources    = &c->sources,
                     .graph      = graph,
                     .scene      = &c->elaborated,
                     .loader     = c->loader,
                     .text_total = c->length};
    elaborate(&e, source, c->name);
    arena_free(&c->scratch);
    if (dumps(c, DUMP_SCENE) && c->diags.errors == 0)
        scene_print(&c->elaborated, &c->sources, &c->dump);
    return graph;
}

static Graph *simplify_scene(Compilation *c, const Graph *lowered)
{
    Roots *roots  = &c->scene->roots;
    Graph *simple = graph_simplify(lowered, roots->components, roots->count, &c->scene->arena);
    graph_validate(simple, "simplify");
    return simple;
}

static void dump_graph(Compilation *c, DumpStage stage, const Graph *graph)
{
    const Roots *roots = &c->scene->roots;
    if (dumps(c, stage))
        graph_print(graph, &c->sources, roots->components,
                    (size_t)(roots->guarded - roots->components), &c->dump);
}

static KrsStatus inspect(Compilation *c)
{
    c->diags.count = c->diags.warnings = 0;
    arena_free(&c->scratch);
    return c->request->inspect(c->request->user,
                               &(Inspected){&c->elaborated, &c->diags, &c->work, &c->scratch});
}

/* A mistake of the whole scene, of which nothing is shown. */
static KrsStatus refuse_scene(Compilation *c, DiagCode code, const char *message)
{
    uint32_t source = source_add(&c->sources, c->name, "", 0, false);
    diag_add(&c->diags, code, (Span){source, 0, 0}, "%s", message);
    return KRS_BAD_SCENE;
}

/* Text to program; ends at the first step that found mistakes. */
static KrsStatus run(Compilation *c)
{
    if (c->outside)
        return refuse_scene(c, DIAG_OUTSIDE_ROOT,
                            "the scene is outside of the folder that scenes may read from");
    if (c->length > MOST_SOURCE_BYTES)
        return refuse_scene(c, DIAG_LIMIT, "the file is longer than 16 MiB");
    Graph *graph = elaborate_scene(c);
    if (c->diags.errors || !lower_scene(c, graph))
        return KRS_BAD_SCENE;
    graph_validate(graph, "lower");
    dump_graph(c, DUMP_GRAPH, graph);
    c->scene->graph = simplify_scene(c, graph);
    dump_graph(c, DUMP_SIMPLIFY, c->scene->graph);
    if (!check_operations(c) || !check_numbers(c))
        return KRS_BAD_SCENE;
    sources_hash(&c->sources, c->scene->hash);
    retain_scene(c);
    retain_tapes(c);
    c->scene->program.front_ms = now_ms() - c->started;
    make_module(c);
    c->scene->program.glsl_ms = now_ms() - c->started - c->scene->program.front_ms;
    if (!check_length(c))
        return KRS_BAD_SCENE;
    KrsStatus status = check_defaults(c);
    if (status == KRS_OK && c->scene->cameras[0].standing_in)
        status = frame_scene(c->scene);
    return status == KRS_OK && c->request->inspect ? inspect(c) : status;
}

/* ---- the API ---- */

static void hand_over(const Diags *diags, const Diag *diag, const KrsOptions *options, Arena *arena)
{
    const Source *source   = &diags->sources->items[diag->span.source];
    Position      position = source_position(source, diag->span.start);
    Text          text = {.arena = arena}, json = {.arena = arena};
    diag_print_one(diags, diag, false, &text);
    diag_json_one(diags, diag, &json);
    KrsDiagnostic public = {.error   = diag_info[diag->code].severity == DIAG_ERROR,
                            .code    = diag_info[diag->code].code,
                            .message = diag->message,
                            .source  = source->name,
                            .line    = position.line,
                            .column  = position.column,
                            .text    = text.bytes,
                            .json    = json.bytes};
    options->diagnostic(options->user, &public);
}

static void report(Compilation *c)
{
    const KrsOptions *options = c->options;
    diags_sort(&c->diags);
    for (size_t i = 0; options->diagnostic && i < c->diags.count; i++)
        hand_over(&c->diags, c->diags.items[i], options, &c->scratch);
}

/* Running out of memory anywhere in there leads back to here. */
static KrsStatus run_guarded(Compilation *c)
{
    jmp_buf exhausted;
    c->scene->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    source_add(&c->sources, "", "", 0, true); /* source 0: no place */
    KrsStatus status = run(c);
    report(c);
    return status;
}

static KrsStatus compile(const Loaded *loaded, const char *name, const Loader *loader,
                         const KrsOptions *options, const Request *request, KrsScene **result)
{
    const KrsAllocator *allocator = &options->allocator;
    KrsScene *scene = allocator->allocate ? allocator->allocate(allocator->user, sizeof *scene)
                                          : malloc(sizeof *scene);
    if (!scene)
        return KRS_OUT_OF_MEMORY;
    memset(scene, 0, sizeof *scene);
    Compilation c = {.scene   = scene,
                     .text    = loaded->text,
                     .length  = loaded->length,
                     .outside = loaded->outside,
                     .loader  = loader,
                     .name    = name,
                     .request = request,
                     .options = options,
                     .started = now_ms()};
    scene->memory = (Memory){allocator->allocate,
                             allocator->release,
                             allocator->user,
                             0,
                             options->memory_limit ? options->memory_limit : DEFAULT_MEMORY,
                             NULL};
    scene->arena = c.work = c.syntax = c.scratch = (Arena){.memory = &scene->memory};
    c.sources                                    = (Sources){.arena = &c.work};
    c.names                                      = (Names){.arena = &c.work};
    c.diags                                      = (Diags){.arena = &c.work, .sources = &c.sources};
    c.dump                                       = (Text){.arena = &c.work};

    KrsStatus status = run_guarded(&c);
    if (request->dump && status != KRS_OUT_OF_MEMORY)
        *request->dump = strdup(c.dump.bytes ? c.dump.bytes : "");
    arena_free(&c.work);
    arena_free(&c.syntax);
    arena_free(&c.scratch);
    scene->memory.exhausted = NULL;
    if (status != KRS_OK) {
        krs_scene_free(scene);
        return status;
    }
    *result = scene;
    return KRS_OK;
}

/* Of a text, or, when that is NULL, of the file `name`. */
static KrsStatus load_and_compile(const char *text, size_t length, const char *name,
                                  const KrsOptions *options, const Request *request,
                                  KrsScene **scene)
{
    static const KrsOptions defaults = {0};
    options                          = options ? options : &defaults;
    *scene                           = NULL;
    Loader    loader                 = {.supplier = options->load, .user = options->load_user};
    KrsStatus status                 = KRS_OUT_OF_MEMORY;
    if (loader_open(&loader, options->root, name)) {
        Loaded loaded = {.text = text, .length = length};
        if (!text)
            loaded = loader_read_scene(&loader, name);
        status = loaded.text || loaded.outside
                     ? compile(&loaded, name, &loader, options, request, scene)
                     : KRS_IO_ERROR;
        free(loaded.owned);
    }
    loader_close(&loader);
    return status;
}

KrsStatus krs_compile_text(const char *text, size_t length, const char *name,
                           const KrsOptions *options, KrsScene **scene)
{
    return load_and_compile(text ? text : "", length, name, options, &scene_alone, scene);
}

static KrsStatus compile_path(const char *path, const KrsOptions *options, const Request *request,
                              KrsScene **scene)
{
    return load_and_compile(NULL, 0, path, options, request, scene);
}

KrsStatus krs_compile_file(const char *path, const KrsOptions *options, KrsScene **scene)
{
    return compile_path(path, options, &scene_alone, scene);
}

KrsStatus krs_dump(const char *path, DumpStage stage, const KrsOptions *options, char **dump)
{
    KrsScene *scene;
    Request   request = {.stage = stage, .dump = dump};
    *dump             = NULL;
    KrsStatus status  = compile_path(path, options, &request, &scene);
    krs_scene_free(scene);
    return status;
}

KrsStatus inspect_file(const char *path, const KrsOptions *options, Inspect *look, void *user)
{
    KrsScene *scene;
    Request   request = {.stage = DUMP_STAGE_COUNT, .inspect = look, .user = user};
    KrsStatus status  = compile_path(path, options, &request, &scene);
    krs_scene_free(scene);
    return status;
}
