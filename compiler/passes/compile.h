/*
 * compile.h: the compiler's interface besides krs.h: programs, passes and their dumps, refutation.
 */
#ifndef KRS_COMPILE_H
#define KRS_COMPILE_H

#include "compiler/base/arena.h"
#include "compiler/base/diag.h"
#include "compiler/scene/compiled.h"
#include "compiler/target/spirv.h"

/*
 * Options of the search for points that refute the distances of a scene, and of every shape in it
 * by itself (search.h).  A point refutes a distance that is too long, changes too fast or is not a
 * number, or a solid that is outside of its box.  The search uses the default values of parameters
 * and random ones in their ranges.
 */
typedef struct KrsRefuteOptions {
    double   seconds; /* a budget of counted work, so that all machines find the same */
    uint64_t seed;
    double   time; /* of the scene, for the default values */
    /* Parameters that have these values; the others vary. */
    struct KrsFixed {
        const char *name;
        double      values[4];
        size_t      count;
    } const *fixed;
    size_t   fixed_count;
    /* Called repeatedly with the fraction of the work done; false ends the search.  May be NULL. */
    KrsProgressCallback *progress;
    void                *user;
} KrsRefuteOptions;

typedef struct KrsRefutation {
    bool     refuted;     /* a diagnostic has the witness and the shape at fault */
    size_t   shapes;      /* number of shapes that were searched */
    size_t   settings;    /* sets of parameter values tried: the largest number for one shape */
    size_t   refused;     /* sets that states refuse, as well as their substitutes */
    size_t   skipped;     /* shapes too large to be searched by themselves */
    uint64_t evaluations; /* number of distances evaluated */
    double   steepest;    /* largest slope of a distance; 1 is permitted */
    double   longest;     /* largest ratio of an estimate to the true distance */
    size_t   estimates;   /* shapes whose distance is an estimate */
} KrsRefutation;

/* Runs the search in a text or, where that is NULL, in the file `name`.  KRS_BAD_SCENE: refuted, or the scene does not compile; KRS_INTERRUPTED: `progress`
   ended the search. */
KrsStatus krs_refute(const char *text, size_t length, const char *name, const KrsOptions *options,
                     const KrsRefuteOptions *how, KrsRefutation *result);

/* Finds what krs_distance does, but as shaders find it: where the clearance of a grid's cell is
   less than the distance to the parts that its list has, it is that clearance (graph/grid.h). */
KrsStatus krs_distance_bound(KrsState *state, const double (*points)[3], size_t count,
                             double *distances);

/* A pass of the compiler: a row of passes.def. */
typedef struct KrsPass {
    const char *name;    /* "lower" */
    const char *form;    /* what the scene is after it: "graph"; or the same as `name` */
    const char *meaning; /* what it does */
} KrsPass;

/* Pass `index`, from 0 in the order in which they run; NULL behind the last. */
const KrsPass *krs_pass(size_t index);
/* Returns the pass with this name or form, or NULL. */
const KrsPass *krs_find_pass(const char *word);

/* Tells whether a text is a scene: errors are those of krs_compile_text.  No camera is placed in a scene
   without one, which casts rays and may take longer than all the rest, and nothing is said of what
   cameras see. */
KrsStatus krs_check_text(const char *text, size_t length, const char *name,
                         const KrsOptions *options);

/* Compiles a text or, where that is NULL, the file `name`, and writes the result of the pass `after` as text, which the caller frees with
   free().  If a pass refuses the scene, the text is that of `after` if it ran before, else "".
   KRS_BAD_ARGUMENT, and NULL: there is no such pass. */
KrsStatus krs_dump(const char *text, size_t length, const char *name, const char *after,
                   const KrsOptions *options, char **dump);

#endif
