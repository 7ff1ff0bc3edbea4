/*
 * program.h: a compiled scene, as compile.c makes it and query.c asks it.
 */
#ifndef KRS_PROGRAM_H
#define KRS_PROGRAM_H

#include "compiler/bounds.h"
#include "compiler/compile.h"
#include "compiler/geometry/lower.h"
#include "compiler/graph/evaluate.h"

/* Roots of the graph, in this order: ROOT_COUNT for each component, the depth in zones if there
   are any, then what a view needs. */
enum { MARCH_ROOTS = 1 + ALONG_COUNT }; /* behind all others: lower_guarded, lower_along */
enum { FLAT_ROOTS = 2 }; /* behind those: where a ray meets a plane, and how steeply it falls */
/* Behind those, of each component and then of all zones: lower_gradient's two; the same node twice,
   a FLOAT, where there is none. */
enum { GRADIENT_ROOTS = 2 };
enum { CAMERA_ROOTS = 5, LIGHT_ROOTS = 3, SKY_ROOTS = 3 };

/* A slope that is found for each frame (geometry/slope.c). */
typedef struct KeptSlope {
    uint32_t    slot;
    SlopeTask   task;
    const char *place; /* "scene.krs:3:14" */
} KeptSlope;

struct KrsScene {
    Memory       memory;
    Arena        arena; /* all that stays: graph, names, program */
    KrsProgram   program;
    const Graph *graph;
    const Node  *roots;
    const Node  *guarded_roots; /* of each component: what to march by (lower_guarded) */
    const Node  *along_roots;   /* of each component, method by method: lower_along */
    size_t       component_count, camera_count, light_count;
    size_t       zone_count; /* declared; all have one root */
    KrsComponent *components;
    KrsBounds    *bounds;  /* of each component */
    KeptSlope   *slopes;   /* those that the program needs */
    size_t       slope_count;
    Parameter   *parameters;
    size_t       parameter_count;
    SceneCamera *cameras; /* their nodes are not used: the roots are */
    SceneLight  *lights;
    bool         framed; /* the first camera stands in, and framing.c has placed it here: */
    double       framed_eye[3], framed_target[3];
    SceneImage   image;
    char         hash[17];
    Tape         distance; /* of all components, and zones */
    Tape         guarded;  /* of all components: guarded_roots, with what may be left out */
    Tape         surface;  /* all roots of all components */
    Tape         precise;  /* OP_precise, of which there are precise_count: precise_nodes */
    const Node  *precise_nodes;
    size_t       precise_count;
    Tape         view;     /* cameras, lights and sky */
};

/* A frame: what varies, and room for the values of all nodes. */
struct KrsFrame {
    const KrsScene *scene;
    NodeValue      *parameters; /* the parameter block: slot 0 is the time; slopes are always those
                                   of the other values */
    void           *room;       /* to find them in */
    const char     *unbounded;  /* the place of one that had no bound in the frame refused last */
    NodeValue      *values;     /* of every node */
    KrsLight       *lights;
    bool            fresh;      /* frame values are of these parameters */
    double          zones[KRS_MOST_ZONES][4];
    size_t          zone_count; /* of the caller */
};

/* Computes what depends on parameters only, once after each change. */
void frame_refresh(KrsFrame *frame);
/* The value of a node that is a vector of 3. */
void frame_copy(const KrsFrame *frame, Node node, double to[3]);
/* Any length but 0: squares of what is very long or short would overflow, or vanish. */
void vector_normalize(double v[3]);

static inline Node zone_root(const KrsScene *scene)
{
    return scene->zone_count ? scene->roots[scene->component_count * ROOT_COUNT] : NODE_NONE;
}

static inline const Node *camera_roots(const KrsScene *scene, size_t camera)
{
    return scene->roots + scene->component_count * ROOT_COUNT + (scene->zone_count > 0) +
           camera * CAMERA_ROOTS;
}

static inline const Node *light_roots(const KrsScene *scene, size_t light)
{
    return camera_roots(scene, scene->camera_count) + light * LIGHT_ROOTS;
}

static inline const Node *sky_roots(const KrsScene *scene)
{
    return light_roots(scene, scene->light_count);
}

#endif
