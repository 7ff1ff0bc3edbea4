/*
 * program.h: a compiled scene, as compile.c makes it, and program.c, frame.c and query.c ask it.
 */
#ifndef KRS_PROGRAM_H
#define KRS_PROGRAM_H

#include "compiler/bounds.h"
#include "compiler/compiled.h"
#include "compiler/lower/lower.h"
#include "compiler/shape/scene.h"
#include "compiler/graph/evaluate.h"
#include "compiler/print/module.h"

/*
 * What is asked of the graph: nodes in one array, kind behind kind, so that they are simplified
 * together.
 */
typedef enum RootKind {
    ROOTS_SURFACE, /* of each component as many as there are kinds of ComponentRoot */
    ROOTS_ZONE,    /* the depth in zones, if there are any */
    ROOTS_CAMERA,
    ROOTS_LIGHT,
    ROOTS_SKY,
    /* From here on for the march alone; nothing else depends on these. */
    ROOTS_GUARDED,         /* of each component: lower_guarded */
    ROOTS_ALONG,           /* of each component, method by method: lower_along */
    ROOTS_PLANE,           /* of the nearest half-space */
    ROOTS_GRADIENT,        /* of each component, and then of all zones */
    ROOTS_SLOPE,           /* of each slope that is found for each frame */
    ROOTS_CAMERA_RELATIVE, /* surfaces and plane again, for points that are, or nothing */
    ROOT_KINDS
} RootKind;

typedef struct CameraRoots {
    Node eye, target, up, fov, height;
} CameraRoots;
typedef struct LightRoots {
    Node vector, color, softness;
} LightRoots;
typedef struct SkyRoots {
    Node zenith, horizon, ground;
} SkyRoots;
typedef struct PlaneRoots {
    Node step, rise; /* how far a ray is from it, and how steeply the ray falls */
} PlaneRoots;
typedef struct GradientRoots {
    Node gradient, near; /* lower_gradient's two; the same FLOAT twice where there is none */
} GradientRoots;

/* How many nodes such a group of roots has. */
#define NODES_OF(type) (sizeof(type) / sizeof(Node))

typedef struct Roots {
    Node  *all;
    size_t first[ROOT_KINDS + 1]; /* where each kind begins; the last: how many there are */
} Roots;

/* Roots that follow each other. */
typedef struct RootRange {
    Node  *items;
    size_t count;
} RootRange;

static inline RootRange roots_from(const Roots *roots, RootKind first, RootKind last)
{
    return (RootRange){roots->all + roots->first[first],
                       roots->first[last + 1] - roots->first[first]};
}

static inline RootRange roots_of(const Roots *roots, RootKind kind)
{
    return roots_from(roots, kind, kind);
}

/* What is computed for a component: to be indexed by ComponentRoot. */
static inline Node *surface_roots(const Roots *roots, size_t component)
{
    return roots_of(roots, ROOTS_SURFACE).items + component * ROOT_COUNT;
}

static inline Node distance_root(const Roots *roots, size_t component)
{
    return surface_roots(roots, component)[ROOT_DISTANCE];
}

/* Of each component, by one method. */
static inline Node *along_roots(const Roots *roots, AlongMethod method)
{
    RootRange along = roots_of(roots, ROOTS_ALONG);
    return along.items + method * (along.count / ALONG_COUNT);
}

static inline CameraRoots *camera_roots(const Roots *roots, size_t camera)
{
    return (CameraRoots *)roots_of(roots, ROOTS_CAMERA).items + camera;
}

static inline LightRoots *light_roots(const Roots *roots, size_t light)
{
    return (LightRoots *)roots_of(roots, ROOTS_LIGHT).items + light;
}

static inline SkyRoots *sky_roots(const Roots *roots)
{
    return (SkyRoots *)roots_of(roots, ROOTS_SKY).items;
}

static inline PlaneRoots *plane_roots(const Roots *roots)
{
    return (PlaneRoots *)roots_of(roots, ROOTS_PLANE).items;
}

/* Of a component; behind the last, of all zones. */
static inline GradientRoots *gradient_roots(const Roots *roots, size_t component)
{
    return (GradientRoots *)roots_of(roots, ROOTS_GRADIENT).items + component;
}

/* A slope that is found for each frame (shape/slope.c). */
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
    Tape           guarded;  /* of all components: ROOTS_GUARDED, with what may be left out */
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

/* What krs.h and compiled.h have under the same names, for the compiler itself, which asks a scene
   before it is handed out: from `retain` on. */
KrsStatus frame_new(const KrsScene *scene, KrsFrame **frame);
void      frame_free(KrsFrame *frame);
KrsStatus frame_view(KrsFrame *frame, size_t camera, KrsView *view);
KrsStatus frame_raycast(KrsFrame *frame, const double (*origins)[3], const double (*directions)[3],
                        size_t count, double farthest, double tolerance, KrsHit *hits);
void      scene_free(KrsScene *scene);

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
    RootRange zone = roots_of(&scene->roots, ROOTS_ZONE);
    return zone.count ? zone.items[0] : NODE_NONE;
}

#endif
