/*
 * compile.h: text in, finished program out.  The compiler's API: all that the runtime sees.
 */
#ifndef KRS_COMPILE_H
#define KRS_COMPILE_H

#include "compiler/base/arena.h"
#include "compiler/base/diag.h"
#include "compiler/compiled.h"
#include "compiler/target/spirv.h"

/*
 * The attempt to refute the distances of a scene, and of every shape in it by itself: a directed
 * search (search.h) for points where one is too long, rises too fast, is not a number, or where a
 * solid is outside of its box; at the parameters' defaults and at random values in their ranges.
 */
typedef struct KrsRefuteOptions {
    double   seconds; /* of counted work, so that every machine does and finds the same */
    uint64_t seed;
    double   time; /* of the first attempt */
    /* Parameters that keep these values; the others vary. */
    struct KrsFixed {
        const char *name;
        double      values[4];
        size_t      count;
    } const *fixed;
    size_t   fixed_count;
    /* Called now and then with the fraction that is done; false: stop.  May be NULL. */
    bool (*go_on)(void *user, double fraction);
    void *user;
} KrsRefuteOptions;

typedef struct KrsRefutation {
    bool     refuted;     /* a diagnostic says what, where, and the shape to blame */
    size_t   shapes;      /* that were looked at */
    size_t   settings;    /* values of the parameters that were tried, at most for one shape */
    size_t   refused;     /* that could not be had: frames refuse them, and all in their stead */
    size_t   skipped;     /* shapes too large to be searched by themselves */
    uint64_t evaluations; /* of distances */
    double   steepest;    /* largest slope of a distance, of 1 that is permitted */
    double   longest;     /* largest ratio of an estimate to the true distance */
    size_t   estimates;   /* shapes of which nothing more is claimed */
} KrsRefutation;

/* KRS_BAD_SCENE: refuted, or the scene is wrong; KRS_INTERRUPTED: it was stopped. */
KrsStatus krs_refute(const char *path, const KrsOptions *options, const KrsRefuteOptions *how,
                     KrsRefutation *result);

/* A pass of the compiler: a row of passes.def. */
typedef struct KrsPass {
    const char *name;    /* "lower" */
    const char *form;    /* what the scene is then: "graph"; else its name again */
    const char *meaning; /* what it does */
} KrsPass;

/* Pass `index` from 0, in the order in which they run; NULL behind the last. */
const KrsPass *krs_pass(size_t index);
/* By its name or its form; NULL: there is none. */
const KrsPass *krs_find_pass(const char *word);

/* As krs_compile_file, and also what a pass has made or found, as text the caller frees with
   free(); when the scene is wrong, it is there if the pass came before the mistake, else "".
   KRS_BAD_ARGUMENT, and NULL: no pass is called `after`. */
KrsStatus krs_dump(const char *path, const char *after, const KrsOptions *options, char **text);

#endif
