/*
 * program.h: a compiled scene, as compile.c makes it, and program.c, frame.c and query.c ask it.
 */
#ifndef KRS_PROGRAM_H
#define KRS_PROGRAM_H

#include "compiler/bounds.h"
#include "compiler/compile.h"
#include "compiler/geometry/lower.h"
#include "compiler/graph/evaluate.h"
#include "compiler/print/module.h"

/* How many roots each has. */
enum { CAMERA_ROOTS = 5, LIGHT_ROOTS = 3, SKY_ROOTS = 3, PLANE_ROOTS = 2, GRADIENT_ROOTS = 2 };

/* What is asked of the graph: nodes in one array, in this order, so that they are simplified
   together.  What begins with `guarded` is for the march: nothing else depends on it. */
typedef struct Roots {
    Node  *components; /* ROOT_COUNT of each */
    Node  *zone;       /* the depth in zones, if there are any */
    Node  *cameras;    /* eye, target, up, field of view and height of each */
    Node  *lights;     /* vector, color and softness of each */
    Node  *sky;        /* zenith, horizon, ground */
    Node  *guarded;    /* of each component: lower_guarded */
    Node  *along;      /* of each component, method by method: lower_along */
    Node  *planes;     /* where a ray meets a plane, and how steeply it falls */
    Node  *gradients;  /* of each component and then of all zones: lower_gradient's two; the same
                          node twice, a FLOAT, where there is none */
    Node  *camera_relative; /* components and planes, of camera-relative points */
    Node  *slopes;          /* of each slope that is found for each frame */
    size_t count;
} Roots;

/* A slope that is found for each frame (geometry/slope.c). */
typedef struct RetainedSlope {
    uint32_t    slot;
    SlopeTask   task;
    const char *place; /* "scene.krs:3:14" */
} RetainedSlope;

struct KrsScene {
    Memory         memory;
    Arena          arena; /* all that stays: graph, names, program */
    KrsProgram     program;
    const Graph   *graph;
    Module         module; /* what text is printed from */
    Roots          roots;
    size_t         component_count, camera_count, light_count;
    size_t         zone_count; /* declared; all have one root */
    KrsComponent  *components;
    KrsBounds     *bounds; /* of each component */
    RetainedSlope *slopes; /* those that the program needs */
    size_t         slope_count;
    Parameter     *parameters;
    size_t         parameter_count;
    SceneCamera   *cameras; /* their nodes are not used: the roots are */
    SceneLight    *lights;
    bool           framed; /* the first camera stands in, and framing.c has placed it here: */
    double         framed_eye[3], framed_target[3];
    SceneImage     image;
    char           hash[17];
    Tape           distance; /* of all components, and zones */
    Tape           guarded;  /* of all components: roots.guarded, with what may be left out */
    Tape           ahead;    /* with sheets: of all components, and zones, how far rays may go */
    Tape           turned;   /* with sheets: gradients of all components */
    Tape           surface;  /* all roots of all components */
    Tape           view;     /* cameras, lights and sky */
};

/* A frame: what varies, and memory for the values of all nodes. */
struct KrsFrame {
    const KrsScene *scene;
    NodeValue      *parameters; /* the parameter block: slot 0 is the time; slopes are always those
                                   of the other values */
    void           *workspace;  /* to find the slopes in */
    const char     *unbounded;  /* the place of one that had no bound in the frame refused last */
    NodeValue      *values;     /* of every node */
    KrsLight       *lights;
    bool            fresh; /* frame values are of these parameters */
    double          zones[KRS_MOST_ZONES][4];
    size_t          zone_count; /* of the caller */
};

/* Computes what depends on parameters only, once after each change. */
void frame_refresh(KrsFrame *frame);
/* Of all that points and the view get from the frame, something that is not finite; NODE_NONE. */
Node frame_infinite(KrsFrame *frame);
/* The value of a node that is a vector of 3. */
void frame_copy(const KrsFrame *frame, Node node, double to[3]);
/* Any length but 0: squares of what is very long or short would overflow, or vanish. */
void vector_normalize(double v[3]);

static inline Node zone_root(const KrsScene *scene)
{
    return scene->zone_count ? *scene->roots.zone : NODE_NONE;
}

#endif
