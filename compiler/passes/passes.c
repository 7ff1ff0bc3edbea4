/*
 * passes.c: passes that consist of a few calls, each with the function that prints its result.
 */
#include <stdlib.h>

#include "compiler/passes/compilation.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/rewrite/parameterise.h"
#include "compiler/graph/rewrite/csg_nodes.h"
#include "compiler/graph/rewrite/simplify.h"
#include "compiler/lower/instance_groups.h"

/* ---- the front end ---- */

/* Reports a mistake of the scene as a whole, without lines of its text. */
static KrsStatus refuse_scene(Compilation *c, DiagCode code, const char *message)
{
    uint32_t source = source_add(&c->sources, c->name, "", 0, false);
    diag_add(&c->diags, code, (Span){source, 0, 0}, "%s", message);
    return KRS_BAD_SCENE;
}

KrsStatus pass_load(Compilation *c)
{
    source_add(&c->sources, "", "", 0, true); /* source 0: no place */
    if (!c->loaded.text)
        c->loaded = loader_read_scene(c->loader, c->name);
    if (c->loaded.outside)
        return refuse_scene(c, DIAG_OUTSIDE_ROOT,
                            "the scene is outside of the folder that scenes may read from");
    if (!c->loaded.text && c->loaded.reason == source_no_memory)
        return KRS_OUT_OF_MEMORY;
    if (!c->loaded.text) {
        const char *reason = c->loaded.reason ? c->loaded.reason : "unknown";
        refuse_scene(c, DIAG_CANNOT_READ, diag_text(&c->diags, "cannot be read: %s", reason));
        return KRS_IO_ERROR;
    }
    if (c->loaded.length > MAX_SOURCE_BYTES)
        return refuse_scene(c, DIAG_LIMIT, "the file is longer than 16 MiB");
    files_load(&c->files, c->name, c->loaded.text, c->loaded.length);
    free(c->loaded.owned); /* `files` has a copy */
    c->loaded = (Loaded){0};
    return KRS_OK;
}

void print_load(Compilation *c, Text *out) { files_print_texts(&c->files, out); }

/* Lexes the files.  Mistakes end the run only after the pass `names`, which may find more. */
KrsStatus pass_lex(Compilation *c)
{
    files_lex(&c->files);
    return KRS_OK;
}

void print_lex(Compilation *c, Text *out)
{
    tokens_print(&c->files.items[0]->tokens, &c->sources, out);
}

KrsStatus pass_parse(Compilation *c)
{
    files_parse(&c->files);
    return KRS_OK;
}

void print_parse(Compilation *c, Text *out)
{
    syntax_print(c->files.items[0]->syntax, &c->sources, out);
}

KrsStatus pass_use(Compilation *c)
{
    files_load_used(&c->files);
    return KRS_OK;
}

void print_use(Compilation *c, Text *out) { files_print_uses(&c->files, out); }

KrsStatus pass_names(Compilation *c)
{
    const char *builtin[MAX_BUILTIN_NAMES];
    files_check_names(&c->files, builtin, builtin_names(builtin, MAX_BUILTIN_NAMES));
    return c->diags.errors ? KRS_BAD_SCENE : KRS_OK;
}

void print_names(Compilation *c, Text *out) { files_print_names(&c->files, out); }

static bool parameterises(const Compilation *c)
{
    return c->options->specialize == KRS_SPECIALIZE_STRUCTURE;
}

uint32_t min_instances(const Compilation *c)
{
    return c->request->min_instances ? c->request->min_instances : MIN_INSTANCES;
}

KrsStatus pass_elaborate(Compilation *c)
{
    IterationTrials iterations = {.least = min_instances(c)};
    Graph          *graph      = graph_new(&c->work);
    c->elaborated              = (Scene){.graph = graph,
                                         .sky   = {.zenith = NODE_NONE},
                                         .zone  = NODE_NONE,
                                         .fog   = {.color = NODE_NONE}};
    ShapeBuilder builder       = {.arena      = &c->work,
                                  .scratch    = &c->scratch,
                                  .diags      = &c->diags,
                                  .graph      = graph,
                                  .parameters = &c->elaborated.parameters,
                                  .slopes     = &c->elaborated.slopes,
                                  .for_meshes = c->options->outlines};
    Elaboration  e             = {.builder       = &builder,
                                  .arena         = &c->work,
                                  .values        = &c->values,
                                  .scratch       = &c->scratch,
                                  .diags         = &c->diags,
                                  .sources       = &c->sources,
                                  .files         = &c->files,
                                  .graph         = graph,
                                  .scene         = &c->elaborated,
                                  .loader        = c->loader,
                                  .iterations    = c->request->single_iterations ? NULL : &iterations,
                                  .studio        = c->options->studio,
                                  .figures       = c->options->figures,
                                  .beams         = c->options->beams,
                                  .outlines      = c->options->outlines,
                                  .parameterises = parameterises(c),
                                  .textures      = {.arena = &c->scene->arena}};
    if (c->options->without)
        e.without = location_span(&c->sources, c->options->without);
    elaborate(&e);
    graph_drop_older(graph);
    if (!c->request->inspect) {
        arena_free(&c->syntax);
        arena_free(&c->values);
    }
    return c->diags.errors ? KRS_BAD_SCENE : KRS_OK;
}

void print_elaborate(Compilation *c, Text *out) { scene_print(&c->elaborated, &c->sources, out); }

/* ---- graph and GLSL ---- */

/* Prints the roots of surfaces and the view only; those for the march would repeat much of them. */
static void print_graph(const Compilation *c, const Graph *graph, Text *out)
{
    RootRange shown = roots_from(&c->scene->roots, ROOTS_SURFACE, ROOTS_SKY);
    graph_print(graph, &c->sources, shown.items, shown.count, out);
}

void print_lower(Compilation *c, Text *out) { print_graph(c, c->elaborated.graph, out); }

KrsStatus pass_simplify(Compilation *c)
{
    Roots *roots    = &c->scene->roots;
    Graph *graph    = graph_simplify(c->elaborated.graph, roots->all, roots->first[ROOT_KINDS],
                                     &c->scene->arena);
    c->scene->graph = c->simplified = graph;
    if (graph->instances)
        instances_keep(graph->instances, &c->scene->arena);
    return KRS_OK;
}

/* Prunes a component; other roots may be the distance itself.  Returns whether it has changed. */
static bool prune_component(Compilation *c, size_t component)
{
    Roots     *roots  = &c->scene->roots;
    const Node old    = distance_root(roots, component);
    const Box  box    = c->elaborated.components.items[component].shape->box;
    const Node pruned = csg_nodes_prune(c->simplified, old, box, &c->scratch);
    arena_free(&c->scratch);
    for (size_t i = 0; pruned != old && i < roots->first[ROOT_KINDS]; i++)
        if (roots->all[i] == old)
            roots->all[i] = pruned;
    return pruned != old;
}

/* Prunes the graph.  What is needed depends on numbers, so it stays where these are kept out of the
   shaders. */
KrsStatus pass_prune(Compilation *c)
{
    Roots *roots  = &c->scene->roots;
    bool   pruned = false;
    for (size_t i = 0; !parameterises(c) && i < c->elaborated.components.count; i++)
        pruned |= prune_component(c, i);
    if (pruned)
        c->scene->graph = graph_simplify(c->scene->graph, roots->all, roots->first[ROOT_KINDS],
                                         &c->scene->arena);
    return KRS_OK;
}

void print_prune(Compilation *c, Text *out) { print_graph(c, c->scene->graph, out); }

void validate_pruned(const Compilation *c) { graph_validate(c->scene->graph, "prune"); }

/* Replaces numbers of the text by slots, only where they are kept out of the shaders. */
KrsStatus pass_parameterise(Compilation *c)
{
    Roots *roots = &c->scene->roots;
    Arena *arena = &c->scene->arena;
    if (!parameterises(c))
        return KRS_OK;
    /* Numbers of the graph and of boxes are counted from here on: beyond those of the text, and beyond
       each other. */
    const uint32_t of_graph = 1u << 30, of_boxes = 1u << 31;
    Graph         *graph = graph_parameterise(c->scene->graph, roots->all, roots->first[ROOT_KINDS],
                                              of_graph, arena);
    const size_t   count = c->elaborated.components.count;
    Box           *boxes = arena_new_array(&c->scratch, Box, count + 1);
    for (size_t i = 0; i < count; i++)
        boxes[i] = c->elaborated.components.items[i].shape->box;
    c->mirror_nodes = module_parameterise_mirrors(graph, arena);
    c->box_nodes    = module_parameterise_boxes(graph, boxes, count, of_boxes, arena);
    c->scene->graph = graph;
    return KRS_OK;
}

void print_parameterise(Compilation *c, Text *out) { print_graph(c, c->scene->graph, out); }

void validate_parameterised(const Compilation *c)
{
    graph_validate(c->scene->graph, "parameterise");
}

void print_simplify(Compilation *c, Text *out) { print_graph(c, c->scene->graph, out); }

void validate_simplified(const Compilation *c) { graph_validate(c->scene->graph, "simplify"); }
