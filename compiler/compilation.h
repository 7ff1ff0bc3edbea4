/*
 * compilation.h: one run of the compiler, and its steps from the elaborated scene to the program.
 *
 * compile.c calls them in this order.  A step that returns false has found mistakes and reported
 * them; nothing may follow it.
 */
#ifndef KRS_COMPILATION_H
#define KRS_COMPILATION_H

#include "compiler/front/parse.h"
#include "compiler/geometry/elaborate.h"
#include "compiler/inspect.h"
#include "compiler/program.h"

/* What is wanted beside the scene. */
typedef struct Request {
    DumpStage stage; /* DUMP_STAGE_COUNT: nothing is dumped */
    char    **dump;
    Inspect  *inspect; /* or NULL */
    void     *user;
} Request;

/* Three arenas for three lifetimes: scene->arena stays with the scene, `work` holds sources,
   diagnostics and the elaborated scene until the end of the run, `scratch` what one step needs.
   The syntax tree, which elaboration leaves, has one of its own. */
typedef struct Compilation {
    KrsScene         *scene;
    Arena             work, syntax, scratch;
    Sources           sources;
    Names             names;
    Diags             diags;
    Scene             elaborated;
    const char       *text, *name;
    size_t            length;
    const Request    *request;
    const KrsOptions *options;
    const Loader     *loader;
    bool              outside; /* the scene itself is no file that may be read */
    Text              dump;
    double            started;
} Compilation;

static inline bool component_is_plane(const Component *component)
{
    return component->plane_normal != NODE_NONE;
}

/* roots.c: from shapes to what is asked of the graph, scene->roots. */
bool lower_scene(Compilation *c, Graph *graph);

/* precision.c: whether a camera may see something so closely, so far from the origin, that points
   must be relative to it; `distances` are those of the components, ROOT_COUNT apart. */
bool may_need_rebase(const Scene *scene, Graph *graph, const Node *distances, Arena *scratch);

/* limits.c: what no compiler of shaders, or no shader, can have. */
bool check_operations(Compilation *c);
bool check_numbers(Compilation *c);
/* The frame at time 0 with all defaults, which is every caller's first; after emit. */
KrsStatus check_defaults(Compilation *c);
bool      check_length(Compilation *c);
/* Reports that the scene is too large; `operations`: of that component, its largest; 0 when they
   were too many to be counted. */
void refuse_component(Compilation *c, size_t component, size_t operations);

/* retain.c: copies what the program needs out of the elaborated scene, whose memory goes. */
void retain_scene(Compilation *c);
void retain_tapes(Compilation *c);

/* make_module.c: what texts are printed from. */
void make_module(Compilation *c);

/* march_groups.c: which components are marched by themselves.  march_groups[i] gets the number of
   the group of each, from 1; 0 for those that need no march. */
void form_march_groups(Compilation *c, uint32_t *march_groups);

#endif
