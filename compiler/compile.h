/*
 * compile.h: text in, finished program out.  The compiler's API: all that the runtime sees.
 */
#ifndef KRS_COMPILE_H
#define KRS_COMPILE_H

#include "compiler/base/arena.h"
#include "compiler/base/diag.h"
#include "compiler/compiled.h"
#include "compiler/shader/spirv.h"

/*
 * The GLSL of a program declares these promised functions, and the kernels of the runtime
 * include it (their own text says `#include "scene.glsl"`):
 *
 *     layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[N]; };
 *     void  krs_prepare();               once, first in main: all that is constant in a frame
 *     float krs_distance(vec3 p);        safe distance to the scene in world units, < 0 inside
 *     struct KrsSurface { float distance; vec3 color; float roughness; float metallic;
 *                         vec3 emission; uint component; uint level; uint instance;
 *                         vec3 normal; };
 *     KrsSurface krs_surface(vec3 p, vec3 normal, float footprint);
 *                                        what is at p: the component with the least distance
 *
 * krs_surface is given the unit gradient of krs_distance at p, and the radius of the pixel's cone
 * there in world units (0 for a point).  The normal that it returns is the one to light: unit,
 * outwards, and the given one unless mirrors are smooth.
 *
 * With EARLY_OUTS defined, what a graphics card should march by:
 *
 *     float krs_distance_lod(vec3 p, float footprint);
 *
 * It is never above the distance to the nearest surface and not above 0 in the same places, but
 * often less than krs_distance: what is far away for its size is not looked at.  What is smaller
 * than `footprint`, the radius of a pixel's cone at p, counts as the box around it (0: nothing
 * does).  Where a branch saves no work, as on lavapipe, krs_distance costs less.
 *
 * A scene of several expensive components has groups of them (KrsMarchGroup): with MARCH_GROUP
 * defined as the number of one there is krs_distance alone, and of that group alone.
 *
 * N is parameter_slots (at least 1), what is in them is told at krs_frame_parameters.  With
 * FRAME_VALUES defined, value_slots more follow (krs_frame_values), and lanes need not find what
 * depends on the frame alone.  Zones of the scene have been cut out of distances.  With ZONES
 * defined, as many slots follow for zones of the caller (krs_frame_zones).
 */

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
