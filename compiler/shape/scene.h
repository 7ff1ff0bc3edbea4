/*
 * scene.h: the elaborated scene: trees of shapes, and what the picture needs beside them.
 */
#ifndef KRS_SCENE_H
#define KRS_SCENE_H

#include "compiler/shape/box_plan.h"
#include "compiler/shape/parameters.h"
#include "compiler/shape/shape.h"
#include "compiler/shape/sky_map.h"

#define NO_COMPONENT SIZE_MAX

/* A capsule between two balls, or one ball twice. */
typedef struct SceneBeam {
    Node ends[2], radii[2];
} SceneBeam;

/* The shape of a `show`; or, if many are alike, all that are lowered as one. */
typedef struct Component {
    const char *name;
    size_t      first, count; /* of those in Scene.shown that it has: the first, and how many */
    /* Set in Scene.shown: the index in Scene.components; how many before it are lowered with it;
       and the index of the next that is, or NO_COMPONENT. */
    size_t       lowered, rank, next;
    const Shape *shape;
    Span         span;
    Node         plane_normal, plane_offset; /* of a half-space and nothing else, or NODE_NONE */
    bool         figure;                     /* a plane figure, made solid */
    const SceneBeam *beams; /* that it is the sharp union of; none: it is not, or nobody asks */
    size_t           beam_count;
} Component;

/* Rows of camera.def that depend on the state. */
typedef struct CameraNodes {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) Node name;
#include "krs/camera.def"
} CameraNodes;

typedef struct SceneCamera {
    const char *name; /* or NULL */
    Span        span; /* of its `eye`, or else of all of it */
    Span        block;
    CameraNodes nodes;
#define KRS_CAMERA_FIXED(name, type, part, counts) uint32_t name;
#include "krs/camera.def"
    bool lens;        /* it may have an aperture or a shift */
    bool standing_in; /* for a scene that has no camera: framing.c finds eye and target */
} SceneCamera;

/* Rows of lights.def. */
typedef struct LightNodes {
#define KRS_LIGHT(member, kind, of_direction, of_position, ...) Node member;
#include "krs/lights.def"
} LightNodes;

typedef struct SceneLight {
    const char *name; /* or NULL */
    bool        positional, shadow;
    bool        spot;    /* its angle is given */
    bool        colored; /* its color is given */
    uint32_t    type;    /* a number of light_types.def; 0: none of them */
    LightNodes  nodes;   /* the color is times the intensity */
    Span        span;    /* of its `intensity`, if that is given, or of where it is */
} SceneLight;

typedef struct SceneImage {
    uint32_t    width, height, samples, bounces;
    const char *integrator, *tone_map, *pixel_filter;
    double      exposure, error, noise;
    double      white_balance[2]; /* kelvins, or 0, and tint */
} SceneImage;

/* The sky: three colours, a picture of all directions, or daylight. */
typedef struct SceneSky {
    Node zenith, horizon, ground; /* NODE_NONE: there is no sky yet */
    Node rotation, intensity, turbidity;
    /* NULL: there is none. */
    const KrsSkyMap *map;
    const char      *sun; /* the name of a light; NULL: not given */
    Span             sun_span;
    bool             daylight; /* by the light `light`, */
    size_t           light;    /* once lights are known */
} SceneSky;

/* Fog; its color is NODE_NONE where there is none. */
typedef struct SceneFog {
    Node color, density, fall, base; /* fall: 1 / height, 0 where the fog is even */
} SceneFog;

/* The height of a floor below all components of a scene without surroundings: a slot of the parameter
   block, found for the values of each state.  It stays where it is for all of them (or, if that has no
   end, for the defaults) while it would be above a camera. */
typedef struct StateFloor {
    uint32_t slot;      /* 0: there is no floor, or its height is the same in all states */
    double   otherwise; /* where it stays */
    struct {
        PlannedNumber *items;
        size_t         count, capacity;
    } eyes; /* of cameras */
} StateFloor;

/* Rows of medium.def. */
typedef struct MediumNodes {
#define KRS_MEDIUM(name, type, otherwise, low, high) Node name;
#include "compiler/shape/medium.def"
} MediumNodes;

enum { MAX_VOLUMES = 8 };

/* A medium: what fills a shape and scatters light, as smoke does.  Surfaces know nothing of it. */
typedef struct SceneVolume {
    const Shape *within;
    MediumNodes  nodes;
    size_t before; /* components that were shown before; glass that is shown later has none of it */
    Span   span;   /* of its density, or else of its block */
} SceneVolume;

typedef struct Scene {
    Graph *graph;
    struct {
        Component *items;
        size_t     count, capacity;
    } components,
        shown; /* what is lowered; what has a number for the user: more, where many are alike */
    Parameters  parameters;
    StateSlopes slopes;
    BoxPlan     boxes; /* of what is shown, in this order, but for a floor */
    StateFloor  floor;
    /* Declared half-spaces, which may be in no component: mirrors. */
    struct {
        const Shape **items;
        size_t        count, capacity;
    } half_spaces;
    struct {
        SceneCamera *items;
        size_t       count, capacity;
    } cameras;
    struct {
        SceneLight *items;
        size_t      count, capacity;
    } lights;
    struct {
        SceneVolume *items;
        size_t       count, capacity;
    } volumes;
    struct {
        const char **items;
        size_t       count, capacity;
    } materials; /* their names, each once */
    SceneSky   sky;
    SceneFog   fog;
    Node       zone; /* the depth of OP_POINT in zones, negative outside; NODE_NONE without any */
    size_t     zone_count;
    bool       mirrors;     /* a material is smooth enough to show images, or lets light through */
    bool       layers;      /* a material has a coat, sheen, or a mirror other than usual */
    bool       films;       /* a material may have a thin film */
    bool       anisotropic; /* a material may be rougher along its tangent than across */
    SceneImage image;
    Box        box; /* around all components */
} Scene;

/* Prints the scene as indented text, for `krs dump --after=scene`. */
void scene_print(const Scene *scene, const Sources *sources, Text *out);

#endif
