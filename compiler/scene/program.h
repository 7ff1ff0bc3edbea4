/*
 * program.h: a compiled scene: made by the passes, used by program.c, state.c and query.c.
 */
#ifndef KRS_PROGRAM_H
#define KRS_PROGRAM_H

#include "compiler/scene/bounds.h"
#include "compiler/scene/compiled.h"
#include "compiler/scene/assembly.h"
#include "compiler/scene/daylight.h"
#include "compiler/scene/emissive.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/research/research.h"
#include "compiler/shape/scene.h"
#include "compiler/graph/evaluate.h"
#include "compiler/print/module.h"

/*
 * Kinds of roots of the graph.  All roots are in one array, ordered by kind, so that they are
 * simplified together.
 */
typedef enum RootKind {
    ROOTS_SURFACE, /* for each component an array that is indexed by ComponentRoot */
    ROOTS_ZONE,    /* the depth in the zones; none if there are no zones */
    ROOTS_VOLUME,  /* VolumeRoots of each medium */
    ROOTS_CAMERA,  /* CameraNodes of each camera */
    ROOTS_LIGHT,   /* LightNodes of each light */
    ROOTS_SKY,     /* SkyRoots, with fog */
    /* The kinds from here on are for the march, gradients and slopes only. */
    ROOTS_GUARDED,         /* for each component: lower_guarded */
    ROOTS_ALONG,           /* for each component: lower_along */
    ROOTS_RESEARCH,        /* for each method, for each component: lower_research; or none */
    ROOTS_PLANE,           /* PlaneRoots of the nearest half-space */
    ROOTS_GRADIENT,        /* GradientRoots of each component, then of all zones */
    ROOTS_SLOPE,           /* each slope that is computed per state */
    ROOTS_BOX,             /* numbers by which boxes of a state are found */
    ROOTS_ASSEMBLY,        /* what the assembly's items refer to */
    ROOTS_PLACE,           /* for meshes: where each component reads its texture; FLOAT: nowhere */
    ROOTS_CAMERA_RELATIVE, /* surfaces, plane and zones again for camera-relative points, or none */
    ROOT_KINDS
} RootKind;

typedef struct VolumeRoots {
    Node density; /* 0 outside of the shape that the medium is in */
    Node albedo;  /* for each colour the part of light that is scattered */
    Node anisotropy, emission;
} VolumeRoots;
typedef struct SkyRoots {
    Node zenith, horizon, ground, rotation, intensity, turbidity;
    Node fog_color, fog_density, fog_fall, fog_base;
} SkyRoots;
typedef struct PlaneRoots {
    Node step, cosine; /* length of the ray up to the plane; dot product of normal and direction */
} PlaneRoots;
typedef struct GradientRoots {
    Node gradient, near; /* results of lower_gradient; without one both are the distance */
} GradientRoots;

/* The number of nodes in such a struct of roots. */
#define NODES_OF(type) (sizeof(type) / sizeof(Node))

typedef struct Roots {
    Node  *all;
    size_t first[ROOT_KINDS + 1]; /* index where each kind begins; the last is the total number */
} Roots;

/* A range of consecutive roots. */
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

/* Returns the roots of a component, to be indexed by ComponentRoot. */
static inline Node *surface_roots(const Roots *roots, size_t component)
{
    return roots_of(roots, ROOTS_SURFACE).items + component * ROOT_COUNT;
}

static inline Node distance_root(const Roots *roots, size_t component)
{
    return surface_roots(roots, component)[ROOT_DISTANCE];
}

/* Returns the root of each component for a method of research that was asked for. */
static inline Node *research_roots(const Roots *roots, ResearchMethod method)
{
    RootRange all = roots_of(roots, ROOTS_RESEARCH);
    return all.items + method * (all.count / RESEARCH_COUNT);
}

static inline VolumeRoots *volume_roots(const Roots *roots, size_t volume)
{
    return (VolumeRoots *)roots_of(roots, ROOTS_VOLUME).items + volume;
}

static inline CameraNodes *camera_roots(const Roots *roots, size_t camera)
{
    return (CameraNodes *)roots_of(roots, ROOTS_CAMERA).items + camera;
}

static inline LightNodes *light_roots(const Roots *roots, size_t light)
{
    return (LightNodes *)roots_of(roots, ROOTS_LIGHT).items + light;
}

static inline SkyRoots *sky_roots(const Roots *roots)
{
    return (SkyRoots *)roots_of(roots, ROOTS_SKY).items;
}

static inline PlaneRoots *plane_roots(const Roots *roots)
{
    return (PlaneRoots *)roots_of(roots, ROOTS_PLANE).items;
}

/* Returns the roots of a component; with the number of components, those of all zones. */
static inline GradientRoots *gradient_roots(const Roots *roots, size_t component)
{
    return (GradientRoots *)roots_of(roots, ROOTS_GRADIENT).items + component;
}

/* A slope that is computed per state (shape/slope.c). */
typedef struct RetainedSlope {
    uint32_t    slot;
    SlopeTask   task;
    const char *place; /* "scene.krs:3:14" */
} RetainedSlope;

/* The place of something in the texts of the scene. */
typedef struct RetainedPlace {
    const char *source; /* name of the text */
    Position    position;
} RetainedPlace;

/* A medium of a scene. */
typedef struct RetainedVolume {
    Box           box;    /* around it, for all values of the parameters */
    uint32_t      before; /* components that count as shown before it */
    RetainedPlace place;
} RetainedVolume;

struct KrsScene {
    Memory           memory;
    Arena            arena;   /* of all that is below: graph, names, program */
    const char      *name;    /* as it was compiled, */
    KrsOptions       options; /* and how: for krs_scene_update */
    KrsProgram       program;
    KrsDiagnostic   *too_large; /* why no shader is made of it; NULL: shaders are */
    const Graph     *graph;
    Module           module; /* what text is printed from */
    Roots            roots;
    size_t           component_count, shown_count, camera_count, light_count;
    size_t           zone_count; /* zones that the scene declares; they share one root */
    RetainedVolume  *volumes;
    size_t           volume_count;
    KrsComponent    *components; /* all that are shown */
    size_t          *lowered;    /* of each of these: its index among those that are lowered, */
    size_t          *rank;       /* and krs_joined_rank */
    KrsBounds       *bounds;     /* of each component */
    Assembly         assembly;   /* nothing unless the options ask for it */
    RetainedSlope   *slopes;     /* slopes that are computed per state */
    size_t           slope_count;
    BoxPlan          boxes; /* of shown components in a state, */
    StateFloor       floor; /* and what stands below them */
    Tape             box_numbers;
    EmissivePart    *emissive;
    size_t           emissive_count;
    Parameter       *parameters;
    RetainedPlace   *parameter_places; /* of their names */
    RetainedPlace   *camera_places;    /* of their blocks */
    size_t           parameter_count;
    size_t           material_count;
    const char     **materials; /* names; the numbers of surfaces count from 1 */
    SceneCamera     *cameras;   /* for their values use the roots, not the nodes in here */
    SceneLight      *lights;
    const KrsSkyMap *sky_map; /* NULL: the sky is colours, or daylight, */
    bool             daylight;
    size_t           daylight_by; /* which is that of this light */
    bool             framed;      /* the scene has no camera, and framing.c has placed one: */
    double           framed_eye[3], framed_target[3];
    SceneImage       image;
    char             hash[17];
    Tape             distance; /* distances of all components, and zones */
    Tape             guarded;  /* the same with guards (ROOTS_GUARDED) */
    Tape ahead;        /* if there are open surfaces: ROOTS_ALONG of all components, and zones */
    Tape gradients;    /* if there are open surfaces: gradients of all components */
    Tape surface;      /* all roots of all components, and zones */
    Tape volumes_tape; /* ROOTS_VOLUME */
    Tape places;       /* ROOTS_PLACE; empty if nobody asks for meshes */
    Tape view;         /* cameras, lights and sky */
    Tape rows;         /* numbers of tables that depend on the state */
    Tape frame;        /* of all these, what does not depend on points */
};

/* The tapes of the scene that read tables, over the tables of a state where these are its own. */
typedef struct StateTapes {
    Tape distance, guarded, ahead, gradients, surface, places;
} StateTapes;

/* A state: values of the parameters, and memory for the values of all nodes. */
struct KrsState {
    const KrsScene *scene;
    NodeValue      *parameters; /* the parameter block: the time in slot 0, parameters, slopes.  The
                                   slopes always belong to the other values */
    size_t         *lit;        /* parts of the scene that may emit light (state_emissive.c) */
    void           *workspace;  /* memory for the computation of slopes */
    Box            *boxes;      /* memory for those of planned shapes (BoxPlan) */
    double          framed_eye[3], framed_target[3]; /* if the scene is framed: as there, or placed
                                                        for this state */
    const char     *unbounded; /* location of the slope without a bound, after a refusal */
    NodeValue      *values;    /* of every node */
    KrsLight       *lights;
    float (*sky)[3];              /* of daylight, */
    KrsSkyMap           sky_map;  /* which these texels are of, */
    Daylight            sky_made; /* as it was made; turbidity 0: not yet */
    StateTapes          tapes;
    struct StateTables *tables; /* NULL: they are those of the scene */
    struct StateLanes  *lanes;  /* points.h; NULL: nobody has asked for many points */
    bool                exact;  /* rays are marched with exact distances of instance groups */
    uint64_t            ran; /* operations that marching rays has taken; one for many points at once
                                   counts as one */
    bool                fresh; /* the state values in `values` belong to the parameters */
    uint64_t stamp; /* of those values, once they are fresh: no other values have had it */
    double   zones[KRS_MAX_ZONES][4];
    size_t   zone_count; /* zones of the caller */
};

/* Rays remain unresolved after so many steps each, or when the state has run so many operations. */
typedef struct RayLimits {
    size_t   steps;
    uint64_t ran;
} RayLimits;

/* These are the functions of krs.h and compiled.h with the same names.  The compiler itself calls
   them, after the pass `retain`. */
KrsStatus state_new(const KrsScene *scene, KrsState **state);
void      state_free(KrsState *state);
KrsStatus state_view(KrsState *state, size_t camera, KrsView *view);
KrsStatus state_raycast(KrsState *state, const double (*origins)[3], const double (*directions)[3],
                        size_t count, double farthest, double tolerance, RayLimits limits,
                        KrsHit *hits);
/* Answers as krs_probe does; without `normals` those of the answers may be 0, and materials must
   not depend on them. */
KrsStatus state_probe(KrsState *state, const double (*points)[3], size_t count, bool normals,
                      KrsHit *hits);
void      scene_free(KrsScene *scene);
/* Copies a state of the same scene with the same parameters, time and zones. */
KrsStatus state_copy_of(const KrsState *state, KrsState **copy);

/* Returns the GLSL of all functions that the scene has in a variant, without comments, so that it
   says nothing of names and lines. */
char *scene_plain_text(const KrsScene *scene, const KrsVariant *variant, Arena *arena);

/* Evaluates the nodes that depend on parameters only, unless their values are up to date. */
void state_refresh(KrsState *state);
/* Does the same, and the tables of the state: for values at points. */
void state_refresh_points(KrsState *state);

/* Finds bounds as krs_state_volume does, in cells that the caller has chosen; `at` is the cell without a
   bound. */
KrsStatus state_volume(KrsState *state, size_t number, const KrsVolume *volume, float (*bounds)[2],
                       uint32_t at[3]);

/* state_boxes.c: the boxes of the shown components, but for a floor, at the values of the state; NULL:
   they are those of all states. */
const Box *state_find_boxes(KrsState *state);
/* Return, with these boxes, that of a component, and that around all which have an end, empty if
   none has. */
Box state_box(const KrsState *state, const Box *boxes, size_t component);
Box state_outer_box(const KrsState *state, const Box *boxes);
/* Puts the height of the floor into its slot, if it depends on another one. */
void state_find_floor(KrsState *state, uint32_t changed);

/* state_tables.c: tables where instances of groups move, and tapes over them.  False: memory has run out. */
bool state_tables_new(KrsState *state);
/* Lets its tapes add what they run to its own count: after it was copied to another place. */
void state_count_operations(KrsState *state);
void state_tables_free(KrsState *state);
/* Notes that values of the state have changed; the tables are found when they are needed. */
void state_tables_change(KrsState *state);
void state_tables_refresh(const KrsState *state);

/* Returns the component that is nearest, counted from 1; 0: there is none. */
uint32_t state_nearest_component(KrsState *state, const double point[3]);
/* Returns a value of the state, used by points or the view, that is not finite; NODE_NONE: there is
   none. */
Node state_infinite(KrsState *state);
/* Copies the value of a node of type VEC3. */
void state_copy(const KrsState *state, Node node, double to[3]);
/* Scales a vector to length 1, unless it is 0.  It may be so long or short that the square of its
   length would overflow or be 0. */
void vector_normalize(double v[3]);

static inline Node zone_root(const KrsScene *scene)
{
    RootRange zone = roots_of(&scene->roots, ROOTS_ZONE);
    return zone.count ? zone.items[0] : NODE_NONE;
}

#endif
