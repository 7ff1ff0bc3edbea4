/*
 * compilation.h: one run of the compiler, and its passes.
 *
 * A pass that returns anything but KRS_OK has reported why; nothing may follow it.
 */
#ifndef KRS_COMPILATION_H
#define KRS_COMPILATION_H

#include "compiler/eval/elaborate.h"
#include "compiler/front/files.h"
#include "compiler/inspect.h"
#include "compiler/program.h"

typedef struct Compilation Compilation;

typedef enum PassId {
#define PASS(name, validate, meaning) PASS_##name,
#include "compiler/passes.def"
    PASS_COUNT
} PassId;

/* What each pass does, and what it prints for a dump; `scratch` is free to use in both. */
#define PASS(name, validate, meaning)      \
    KrsStatus pass_##name(Compilation *c); \
    void      print_##name(Compilation *c, Text *out);
#include "compiler/passes.def"

/* What is wanted beside the scene. */
typedef struct Request {
    PassId   after; /* PASS_COUNT: nothing is dumped */
    char   **dump;
    Inspect *inspect; /* or NULL */
    void    *user;
} Request;

/* What is lowered beside the surfaces and the march of each component, and why: decided by `lower`,
   as it needs shapes and the graph before it is simplified. */
typedef struct Additions {
    bool planes;          /* components that are half-spaces, which rays meet without a march */
    bool camera_relative; /* points may be relative to the camera */
    bool sheets;          /* there are surfaces without thickness */
    bool algebraic;       /* derivatives cost less than differences */
    bool gradients;       /* sheets or `algebraic` need them, or somebody asked for them */
} Additions;

/* Three arenas for three lifetimes: scene->arena stays with the scene, `work` holds sources,
   diagnostics and the elaborated scene until the end of the run, `scratch` what one pass needs.
   The syntax tree, which elaboration leaves, has one of its own. */
struct Compilation {
    KrsScene         *scene;
    Arena             work, syntax, scratch;
    const Request    *request;
    const KrsOptions *options;
    const Loader     *loader;
    const char       *name;
    Loaded            loaded; /* the text of the scene; without one, `load` reads the file `name` */
    Sources           sources;
    Names             names;
    Diags             diags;
    uint32_t          number_count; /* of the text, that are apart from the shaders */
    Files             files;
    Scene             elaborated; /* its graph is the one that `lower` extends */
    Additions         additions;
    size_t           *operations; /* of each component and, behind the last, of its zones */
    uint32_t
        *march_groups; /* of each component, from 1; 0: it needs no march; in the scene's arena */
    Text dump;
};

static inline bool component_is_plane(const Component *component)
{
    return component->plane_normal != NODE_NONE;
}

/* Asserts what must hold after some passes: columns of passes.def. */
void validate_lowered(const Compilation *c);
void validate_simplified(const Compilation *c);
void validate_hoisted(const Compilation *c);
void validate_facts(const Compilation *c);

/* precision.c: whether a camera may see something so closely, so far from the origin, that points
   must be relative to it. */
bool may_need_rebase(const Scene *scene, Graph *graph, const Roots *roots, Arena *scratch);

/* limits.c: reports that the scene is too large; `operations`: of that component, its largest; 0
   when they were too many to be counted. */
void refuse_component(Compilation *c, size_t component, size_t operations);

/* march_groups.c: which components are marched by themselves: c->march_groups, and the program's. */
void form_march_groups(Compilation *c);

#endif
