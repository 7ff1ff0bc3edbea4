/*
 * compiled.h: a compiled scene, as the runtime sees it: its program, and what a frame of it shows.
 */
#ifndef KRS_COMPILED_H
#define KRS_COMPILED_H

#include "compiler/krs.h"

typedef struct KrsCamera {
    enum { KRS_PERSPECTIVE, KRS_ORTHOGRAPHIC, KRS_PANORAMA } projection;
    double eye[3], target[3], up[3];
    double fov;    /* vertical, radians */
    double height; /* orthographic: of the picture, world units */
} KrsCamera;

typedef struct KrsLight {
    bool   positional; /* else directional */
    double vector[3];  /* position, or unit direction towards the light */
    double color[3];   /* linear, already times intensity */
    double softness;   /* directional: angular diameter, radians; positional: radius */
    bool   shadow;
} KrsLight;

typedef struct KrsSky {
    double zenith[3], horizon[3], ground[3]; /* linear radiance */
} KrsSky;

/* What the `image` block says; zero where it is silent. */
typedef struct KrsImage {
    uint32_t    width, height, samples;
    const char *integrator; /* "preview", "direct", or NULL */
    double      exposure;   /* stops; 0 changes nothing */
    const char *tone_map;   /* or NULL */
    double      error;      /* permitted distance from the surface in pixels; 0: the default */
} KrsImage;

/* Everything about a picture that the host evaluates once per frame. */
typedef struct KrsView {
    KrsCamera       camera;
    KrsSky          sky;
    KrsImage        image;
    size_t          light_count;
    const KrsLight *lights; /* lives as long as the frame, until the next krs_frame_view */
} KrsView;

/* Components that are best marched by themselves, one group after another: with MARCH_GROUP defined
   as the number of a group, from 1, krs_distance is that of the group's components alone. */
typedef struct KrsMarchGroup {
    double flops;           /* as below, of its components */
    double low[3], high[3]; /* box around them */
} KrsMarchGroup;
enum { KRS_MOST_MARCH_GROUPS = 8 };

typedef struct KrsProgram {
    const char *glsl; /* promised functions, readable, with comments of source lines */
    size_t      glsl_length;
    uint32_t    parameter_slots;
    uint32_t    value_slots;     /* how many follow for kernels with #define FRAME_VALUES */
    double      low[3], high[3]; /* box around all components; infinite where unbounded */
    size_t      operations;      /* of krs_distance */
    double      flops;           /* of krs_distance, weighted as op_cost has it */
    uint32_t    loops;           /* iterations of loops in it, at most */
    bool        planes;          /* there is krs_plane_t, for kernels with #define PLANES */
    double      rest_low[3], rest_high[3]; /* with planes: the box around what is left to march */
    bool camera_relative; /* points may be relative to the camera, with #define CAMERA_RELATIVE */
    uint32_t      camera_relative_slots; /* then: how many more slots follow those of the zones */
    bool          gradients; /* there is krs_gradient, for kernels with #define GRADIENT */
    bool          algebraic; /* normals are by krs_gradient unless asked for otherwise */
    bool          along;     /* there is krs_along, for kernels with #define ALONG */
    bool          sheets;    /* surfaces without thickness, where krs_distance is not negative: rays
                                 go by krs_along, normals by krs_gradient, with #define SHEETS */
    bool          inverts;   /* there are its variants for sequences with maps that invert */
    bool          plain;     /* no component is curved (shape_is_curved): #define PLAIN */
    bool          shadows;   /* a light casts some */
    KrsMarchGroup march_groups[KRS_MOST_MARCH_GROUPS];
    size_t        march_group_count; /* 0: all components belong together */
    bool          per_component;     /* marching groups one after the other is worth it */
    uint32_t      scene_parts;       /* how many (emit.h), for kernels with #define PACKED */
    uint32_t      expensive;         /* components that cost enough to be marched by themselves */
    const double *pass_ms;           /* time spent: in each pass (krs_pass, compile.h), */
    double        front_ms, glsl_ms; /* in all before `emit`, and in `emit` */
} KrsProgram;

/* The scene's program; lives as long as the scene. */
const KrsProgram *krs_scene_program(const KrsScene *scene);
/* Whether a camera of the scene is a panorama. */
bool krs_scene_is_panoramic(const KrsScene *scene);
/* The number of cameras and their names (the first is the default; NULL when unnamed). */
size_t      krs_camera_count(const KrsScene *scene);
const char *krs_camera_name(const KrsScene *scene, size_t index);
/* Zones that the scene declares. */
size_t krs_zone_count(const KrsScene *scene);
/* Camera `camera`, lights, sky and image at the frame's parameters and time. */
KrsStatus krs_frame_view(KrsFrame *frame, size_t camera, KrsView *view);
/* Whether what single precision does not tell of such a coordinate shows in pixels of that width,
   so that points have to be relative to an origin near it. */
bool krs_needs_rebase(double coordinate, double pixel);
/* What camera-relative kernels get for their origin: camera_relative_slots vec4s, found in double
   precision. */
void krs_frame_rebase(KrsFrame *frame, const double rebase_origin[3], float (*block)[4]);
/* The zones of the caller (center, radius), to stand behind the parameter block when the GLSL is
   compiled with ZONES defined as that many or more; the others must have a radius that is far
   below 0.  Returns how many. */
size_t krs_frame_zones(const KrsFrame *frame, float (*zones)[4]);
/* A ray as questions march it: in a unit direction, and from `start` to `end`, which is what the
   box around the scene has of [0, farthest]; nothing of it when `end` is the smaller.  With `walls`
   the box ends there: a ray from inside of a solid has left it by then. */
typedef struct KrsRay {
    double origin[3], direction[3], start, end;
    bool   walls;
} KrsRay;
KrsRay krs_ray(const KrsScene *scene, const double origin[3], const double direction[3],
               double farthest);
/* Where there are sheets the normals of a hit face where its ray comes from. */
void krs_face(const KrsRay *ray, KrsHit *hit);
/* Whether these are arguments that krs_raycast accepts. */
bool krs_rays_are_valid(const double (*origins)[3], const double (*directions)[3], size_t count,
                        double farthest, double tolerance);
/* 64-bit FNV-1a of the whole text (used files included), 16 hexadecimal digits. */
const char *krs_scene_hash(const KrsScene *scene);

#endif
