/*
 * compilation.h: the state of one run of the compiler, and its passes.
 *
 * A pass that returns another status than KRS_OK has reported why, and ends the run.
 */
#ifndef KRS_COMPILATION_H
#define KRS_COMPILATION_H

#include "compiler/eval/elaborate.h"
#include "compiler/front/files.h"
#include "compiler/passes/inspect.h"
#include "compiler/scene/program.h"

typedef struct Compilation Compilation;

typedef enum PassId {
#define PASS(name, validate, meaning) PASS_##name,
#include "compiler/passes/passes.def"
    PASS_COUNT
} PassId;

/* The function of each pass, and the function that prints its result for a dump.  Both may use
   `scratch`. */
#define PASS(name, validate, meaning)      \
    KrsStatus pass_##name(Compilation *c); \
    void      print_##name(Compilation *c, Text *out);
#include "compiler/passes/passes.def"

/* Results of a run other than the compiled scene. */
typedef struct Request {
    PassId   after;   /* the pass to dump; PASS_COUNT: none */
    PassId   end;     /* the pass before which the run ends; PASS_COUNT: none */
    char   **dump;    /* where the dump goes, unless NULL */
    bool    *format;  /* unless NULL: the dump is the text in canonical layout, and *format is
                             whether it was so before */
    bool     words;   /* the dump is what the scene may use, in JSON (words.c) */
    Inspect *inspect; /* called with the elaborated scene, unless NULL */
    void    *user;    /* passed to `inspect` */
    uint32_t
        min_instances; /* instances of an instance group (lower/instance_groups.h); 0: MIN_INSTANCES */
    bool
        single_iterations; /* each iteration of a loop is evaluated by itself (eval/iterations.c) */
} Request;

/* The optional roots that are lowered, besides the surface and the march of each component.
   `lower` decides it, since it needs the shapes and the graph before it is simplified. */
typedef struct Additions {
    bool planes;          /* there are half-spaces, which rays meet without a march */
    bool camera_relative; /* points may be relative to the camera */
    bool open_surfaces;   /* there are surfaces without thickness */
    bool algebraic;       /* gradients by derivatives cost less than by differences */
    bool gradients; /* for `open surfaces`, for `algebraic`, or because the options ask for them */
} Additions;

/* There are three lifetimes of memory.  scene->arena lives as long as the scene.  `work` has the
   sources, diagnostics and the elaborated scene until the end of the run.  `syntax` is separate,
   for trees and tokens, and `values` for what these are evaluated to: both are needed until there
   is a scene, and by whoever inspects that.  `scratch` is freed after each pass. */
struct Compilation {
    KrsScene         *scene;
    Arena             work, syntax, values, scratch;
    const Request    *request;
    const KrsOptions *options;
    const Loader     *loader;
    const char       *name;
    Loaded            loaded; /* the scene's text; if NULL, the pass `load` reads the file `name` */
    Sources           sources;
    Names             names;
    Diags             diags;
    Diags             of_shaders; /* why no shader is made of the scene, if that is so */
    BoxNodes          box_nodes;  /* where numbers are kept out of the shaders */
    MirrorNodes      *mirror_nodes;
    Files             files;
    Scene             elaborated; /* its graph is extended by the pass `lower` */
    Graph            *simplified; /* that of the scene, which the pass `prune` extends */
    Additions         additions;
    bool             *is_medium;     /* of each component: it may let light through */
    bool             *is_subsurface; /* likewise: light may go on below its surface */
    size_t           *operations;    /* of each component and, behind them, of the zones */
    uint32_t         *march_groups;  /* number from 1 for each component; 0: needs no march */
    Text              dump;
};

static inline bool component_is_plane(const Component *component)
{
    return component->plane_normal != NODE_NONE;
}

/* Functions that assert what holds after a pass: a column of passes.def. */
void validate_lowered(const Compilation *c);
void validate_simplified(const Compilation *c);
void validate_pruned(const Compilation *c);
void validate_parameterised(const Compilation *c);
void validate_info(const Compilation *c);

/* passes.c: instances of an instance group, and iterations of a loop that is evaluated once. */
uint32_t min_instances(const Compilation *c);

/* precision.c: whether a camera may be so far from the origin, and so near to a surface, that
   points must be camera-relative. */
bool may_need_rebase(const Scene *scene, Graph *graph, const Roots *roots, bool pictures,
                     Arena *scratch);

/* words.c: a scene that uses all files of the library; words that are built in, and those of these files, as JSON. */
void words_use_library(Text *scene);
void words_print(Compilation *c, Text *out);

/* limits.c: refuses the scene, of which a component needs too much to be lowered. */
void refuse_component(Compilation *c, size_t component);

/* find_assembly.c: finds the assembly of the scene, if the options ask for it, and returns its roots. */
RootRange find_assembly(Compilation *c, struct LoweredGroups *instances);
/* find_motion.c: finds what the time does to components that are lowered, if the options ask for it. */
void find_motions(Compilation *c);

/* march_groups.c: decides which components have a march group of their own.  Sets c->march_groups
   and the march groups of the program. */
void form_march_groups(Compilation *c);

#endif
