/*
 * compiled.h: a compiled scene, for the runtime: its program, and the view of a state.
 */
#ifndef KRS_COMPILED_H
#define KRS_COMPILED_H

#include "krs/krs.h"
#include "compiler/print/variant.h"

/* Camera, light and image, which the host evaluates once per state. */
typedef struct KrsView {
    KrsCamera       camera;
    KrsSky          sky;
    KrsFog          fog;
    KrsImage        image;
    size_t          light_count;
    const KrsLight *lights; /* lives as long as the state, until the next krs_state_view */
} KrsView;

/* A ball around something that emits light, and about the mean radiance of its disc. */
typedef struct KrsEmissive {
    double middle[3], radius, radiance;
} KrsEmissive;
enum { KRS_MAX_EMISSIVE = 32 };

/* Components that are marched as one, separately from other groups.  A text may have one group
   only, chosen by its number from 1. */
typedef struct KrsMarchGroup {
    double flops;           /* of the distances of its components */
    double low[3], high[3]; /* box around them */
} KrsMarchGroup;
enum { KRS_MAX_MARCH_GROUPS = 8 };

typedef struct KrsProgram {
    uint64_t      shaders; /* the same number: the same shaders (krs_scene_update found no other) */
    size_t        glsl_length;     /* bytes of the entry points (krs_entry_points) */
    uint32_t      parameter_slots; /* slots (vec4) of the parameter block */
    uint32_t      value_slots;     /* further slots, if the host computes values of the state */
    double        low[3], high[3]; /* box around all components; infinite where unbounded */
    size_t        operations;      /* in krs_distance */
    double        flops;           /* of krs_distance, weighted by op_cost */
    uint32_t      loops;           /* most iterations of loops in krs_distance */
    bool          planes;          /* there is krs_plane_t */
    double        rest_low[3], rest_high[3]; /* box around the components that are not planes */
    bool          camera_relative;           /* points may be relative to the camera */
    uint32_t      camera_relative_slots;     /* then: further slots, behind those of zones */
    bool          gradients;                 /* there is krs_gradient, by derivatives */
    bool          algebraic;                 /* normals are by krs_gradient by default */
    bool          along;                     /* there is krs_along */
    bool          open_surfaces; /* there are surfaces without thickness, where krs_distance is not
                                negative: rays need krs_along, and normals krs_gradient */
    bool          inverts;       /* maps that invert make arcs of rays */
    bool          research;      /* krs_along has steps of research, too, and there is krs_probe */
    bool          plain;         /* no component is curved (shape_is_curved) */
    bool          shadows;       /* a light casts shadows */
    bool          emits;         /* a component may emit light */
    bool          sky_map;       /* the sky is a picture of all directions */
    bool          mirrors; /* a material is smooth enough to show images, or lets light through */
    bool          media;   /* a component may let light through: there are variants of KrsGlass */
    bool          layers;  /* a material has a coat, sheen, or a mirror other than usual */
    bool          films;   /* a material may have a thin film */
    size_t        volumes; /* media that scatter light */
    bool          subsurface;  /* light may go on below the surface of a component */
    bool          anisotropic; /* a material may be rougher along its tangent than across */
    KrsMarchGroup march_groups[KRS_MAX_MARCH_GROUPS];
    size_t        march_group_count; /* 0: all components are marched together */
    bool          per_component;     /* it is faster to march one group after the other */
    uint32_t      scene_parts;       /* number of parts of krs_scene_part_distance */
    uint32_t      expensive;         /* components that cost enough for a group of their own */
    size_t        table_rows;        /* texels of the tables (krs_state_tables); 0: none */
    size_t        table_cells;
    bool          rows_vary; /* tables depend on parameters or the time (krs_state_table_inputs) */
    size_t        table_count, table_instances; /* tables, and the rows of all of them */
    size_t        texture_count, texture_texels;
    size_t        noises;  /* in krs_surface */
    bool          views;   /* krs_surface reads krs_view, the direction of the ray that sees it */
    const double *pass_ms; /* time of each pass (krs_pass, compile.h), in milliseconds */
    double        front_ms, glsl_ms; /* time of all passes before `emit`, and of `emit` */
} KrsProgram;

/* Returns the scene's program; lives as long as the scene. */
const KrsProgram *krs_scene_program(const KrsScene *scene);
/* Returns the GLSL of a variant: the wanted functions, the functions that they call, and comments
   with lines of the scene.  The caller releases it, with free() if `allocator` is NULL. NULL when
   there is no memory.  The program must have what a function needs, such as planes. */
char *krs_scene_text(const KrsScene *scene, const KrsVariant *variant, const KrsFunction *wanted,
                     size_t count, const KrsAllocator *allocator);
/* Returns the GLSL of all functions that the scene has, without comments: scenes whose shaders are
   equal have the same.  Memory is as of krs_scene_text. */
char *krs_scene_plain_text(const KrsScene *scene, const KrsAllocator *allocator);
/* The functions that `krs compile` writes; returns how many.  They are krs_distance, krs_surface
   and, for devices with many threads, krs_distance_lod.  krs_gradient is added if the program has
   gradients, and krs_along if it has open surfaces. */
enum { KRS_MAX_ENTRY_POINTS = 5 };
size_t krs_entry_points(const KrsScene *scene, bool many_threads,
                        KrsFunction entry_points[KRS_MAX_ENTRY_POINTS]);
/* Tells whether a camera of the scene is a panorama. */
bool krs_scene_is_panoramic(const KrsScene *scene);
/* Tells whether a camera of the scene may have an aperture or a shift. */
bool krs_scene_has_lens(const KrsScene *scene);
/* Tells how many components before this one are one component of the shaders with it, as many that are alike
   are; 0 where it is the first, or alone. */
size_t krs_joined_rank(const KrsScene *scene, size_t component);
/* Tells whether drivers compile the shaders of a scene without its numbers in a reasonable time. */
bool krs_structure_is_affordable(const KrsScene *scene);
/* Returns the number of zones that the scene declares. */
size_t krs_zone_count(const KrsScene *scene);
/* Returns a number of the values of a state: another state, or other values, have another one. */
uint64_t krs_state_stamp(KrsState *state);
/* Finds camera `camera`, lights, sky and image at the state's parameters and time. */
KrsStatus krs_state_view(KrsState *state, size_t camera, KrsView *view);
/* Finds balls around what emits light in the state, within a box.  Returns how many; small ones and
   few cost least, so that none is divided whose radius is below `min_radius`.  Light that is
   emitted elsewhere is not in them. */
size_t krs_state_emissive(KrsState *state, const double low[3], const double high[3],
                          double min_radius, KrsEmissive balls[KRS_MAX_EMISSIVE]);
/* A medium that scatters light, in cells of a box around it; `before`: how many components count as
   shown before it. */
typedef struct KrsVolume {
    double   low[3], high[3];
    uint32_t cells[3], before;
} KrsVolume;
enum { KRS_MAX_VOLUME_CELLS = 16384 };
/* Tells where a medium is.  In all states of a scene this is the same. */
KrsVolume krs_scene_volume(const KrsScene *scene, size_t volume);
/* Finds bounds of its density in each cell, in this state, the columns of x first.  They are proven, by
   interval arithmetic over somewhat more than the cell, and hold for densities in single precision.
   Returns KRS_BAD_SCENE where there is no bound. */
KrsStatus krs_state_volume(KrsState *state, size_t volume, float (*bounds)[2]);
/* Returns its density at a point. */
double krs_state_density(KrsState *state, size_t volume, const double point[3]);
/* Tells whether the rounding error of such a coordinate in single precision is visible in pixels of this
   width.  Then points must be relative to an origin near the camera. */
bool krs_needs_rebase(double coordinate, double pixel);
/* Tells how far the taps for a normal reach at such a coordinate, for the sake of rounding, relative to what a
   pixel of this width wants: above 1 normals are blurred, below it those at edges may be. */
double krs_normal_blur(double coordinate, double pixel);
/* Tells how large camera-relative coordinates are about, at this distance from the eye: no larger, and in narrow
   views and orthographic ones twice the height of so many lines of pixels of this width. */
double krs_seen_reach(double distance, double pixel, double lines);
/* Camera-relative coordinates are not worth their cost where others are less than KRS_MIN_GAIN times as
   large, or the blur is less than KRS_MIN_BLUR.  krs_may_blur_normals tells whether what is seen may have
   more of both, where the eye has this coordinate, and the nearest surface this distance from it and pixels
   of this width. */
#define KRS_MIN_GAIN 4
#define KRS_MIN_BLUR 0.1
bool krs_may_blur_normals(double coordinate, double distance, double pixel, double lines);
/* Computes the slots of the values that depend on the origin of camera-relative points, in double
   precision: camera_relative_slots vec4s. */
void krs_state_rebase(KrsState *state, const double rebase_origin[3], float (*block)[4]);
/* Fills tables as krs_state_tables does, where shaders read only so many texels at the beginning of
   both; others may be left as they are.  With an origin (NULL: none) they are those of
   camera-relative points. */
void krs_state_tables_in_use(const KrsState *state, const double *rebase_origin, float (*rows)[4],
                             uint32_t (*cells)[2], size_t *row_count, size_t *cell_count);
/* Finds what these depend on, as parameter_slots numbers; states in which these are equal have
   equal tables. */
void krs_state_table_inputs(const KrsState *state, const double *rebase_origin,
                            double (*inputs)[4]);
/* Returns the caller's zones (center, radius), for the slots behind the parameter block.  With an
   origin (NULL: none) they are for camera-relative points: how deep the origin is in each takes the
   place of the radius.  Returns how many.  In a variant with room for more the others must have a
   radius far below 0. */
size_t krs_state_zones(const KrsState *state, const double *rebase_origin, float (*zones)[4]);
/* A ray of a query, with a unit direction.  It is marched from `start` to `end`: the part of
   [0, farthest] in the box around the scene, which is empty when `end` is less than `start`. */
typedef struct KrsRay {
    double origin[3], direction[3], start, end;
    bool   walls; /* the box, not `farthest`, ends the ray: no solid is beyond */
} KrsRay;
KrsRay krs_ray(const KrsScene *scene, const double origin[3], const double direction[3],
               double farthest);
/* Tells whether krs_raycast accepts these arguments. */
bool krs_rays_are_valid(const double (*origins)[3], const double (*directions)[3], size_t count,
                        double farthest, double tolerance);
/* Returns the 64-bit FNV-1a hash of the scene and the files that it uses, as 16 hexadecimal
   digits. */
const char *krs_scene_hash(const KrsScene *scene);

#endif
