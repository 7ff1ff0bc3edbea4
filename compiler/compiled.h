/*
 * compiled.h: a compiled scene, as the runtime sees it: its program, and what a frame of it shows.
 */
#ifndef KRS_COMPILED_H
#define KRS_COMPILED_H

#include "compiler/krs.h"
#include "compiler/print/variant.h"

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

/* Components that are best marched by themselves, one group after another: texts may have one group
   alone, by its number from 1. */
typedef struct KrsMarchGroup {
    double flops;           /* as below, of its components */
    double low[3], high[3]; /* box around them */
} KrsMarchGroup;
enum { KRS_MOST_MARCH_GROUPS = 8 };

typedef struct KrsProgram {
    size_t        glsl_length; /* of all that kernels call, one function beside the other */
    uint32_t      parameter_slots;
    uint32_t      value_slots;     /* how many follow where the host finds values of the frame */
    double        low[3], high[3]; /* box around all components; infinite where unbounded */
    size_t        operations;      /* of krs_distance */
    double        flops;           /* of krs_distance, weighted as op_cost has it */
    uint32_t      loops;           /* iterations of loops in it, at most */
    bool          planes;          /* there is krs_plane_t */
    double        rest_low[3], rest_high[3]; /* with planes: the box around what is left to march */
    bool          camera_relative;           /* points may be relative to the camera */
    uint32_t      camera_relative_slots; /* then: how many more slots follow those of the zones */
    bool          gradients;             /* there is krs_gradient by derivatives */
    bool          algebraic; /* normals are by krs_gradient unless asked for otherwise */
    bool          along;     /* there is krs_along */
    bool          sheets;    /* surfaces without thickness, where krs_distance is not negative: rays
                                 go by krs_along, normals by krs_gradient */
    bool          inverts;   /* there are its steps for sequences with maps that invert */
    bool          plain;     /* no component is curved (shape_is_curved) */
    bool          shadows;   /* a light casts some */
    KrsMarchGroup march_groups[KRS_MOST_MARCH_GROUPS];
    size_t        march_group_count; /* 0: all components belong together */
    bool          per_component;     /* marching groups one after the other is worth it */
    uint32_t      scene_parts;       /* of krs_scene_part_distance */
    uint32_t      expensive;         /* components that cost enough to be marched by themselves */
    const double *pass_ms;           /* time spent: in each pass (krs_pass, compile.h), */
    double        front_ms, glsl_ms; /* in all before `emit`, and in `emit` */
} KrsProgram;

/* The scene's program; lives as long as the scene. */
const KrsProgram *krs_scene_program(const KrsScene *scene);
/* The GLSL of a variant: the wanted functions, what they call, and comments with lines of the scene.
   Released by the caller, with free() where there is no allocator (NULL); NULL when there is no
   memory.  Where a function needs something of the program (planes, along...), it must have that. */
char *krs_scene_text(const KrsScene *scene, const KrsVariant *variant, const KrsFunction *wanted,
                     size_t count, const KrsAllocator *allocator);
/* Those that `krs compile` writes: krs_distance and krs_surface; krs_distance_lod for many threads;
   what is found by derivatives, and what surfaces without thickness need.  Returns how many. */
enum { KRS_MOST_PROMISED = 5 };
size_t krs_promised_functions(const KrsScene *scene, bool many_threads,
                              KrsFunction promised[KRS_MOST_PROMISED]);
/* Whether a camera of the scene is a panorama. */
bool krs_scene_is_panoramic(const KrsScene *scene);
/* Zones that the scene declares. */
size_t krs_zone_count(const KrsScene *scene);
/* What the `image` block says. */
KrsImage krs_scene_image(const KrsScene *scene);
/* Camera `camera`, lights, sky and image at the frame's parameters and time. */
KrsStatus krs_frame_view(KrsFrame *frame, size_t camera, KrsView *view);
/* Whether what single precision does not tell of such a coordinate shows in pixels of that width,
   so that points have to be relative to an origin near it. */
bool krs_needs_rebase(double coordinate, double pixel);
/* What camera-relative kernels get for their origin: camera_relative_slots vec4s, found in double
   precision. */
void krs_frame_rebase(KrsFrame *frame, const double rebase_origin[3], float (*block)[4]);
/* The zones of the caller (center, radius), to stand behind the parameter block of a variant with
   room for that many or more; the others must have a radius that is far
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
