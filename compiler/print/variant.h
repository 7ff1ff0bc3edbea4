/*
 * variant.h: what a caller chooses of a scene's text before it is printed: a variant, and
 * functions.
 */
#ifndef KRS_VARIANT_H
#define KRS_VARIANT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Functions that a caller may want.  Each text has these in any case:
 *
 *     layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[N]; };
 *     void krs_prepare();    once, first in main: all that is constant in a frame
 */
typedef enum KrsFunction {
    /* float krs_distance(vec3 p): safe distance to the scene in world units, < 0 inside. */
    KRS_FUNCTION_DISTANCE,
    /* float krs_plane_t(vec3 p, vec3 direction): how far it is along a ray to the nearest plane,
       and float krs_plane_cosine(vec3 direction): how steeply the ray falls towards one. */
    KRS_FUNCTION_PLANE_T,
    KRS_FUNCTION_PLANE_COSINE,
    /* float krs_along(vec3 p, vec3 direction, float footprint): how far a ray may go, by the
       variant's step. */
    KRS_FUNCTION_ALONG,
    /* vec2 krs_steps(vec3 p, vec3 direction, float footprint): krs_along is the lesser of the two.
       The second is a distance to all components of which rays know no more, as large as any may
       be: what is known of empty balls holds for it. */
    KRS_FUNCTION_STEPS,
    /* float krs_probe(vec3 p, float footprint): whether a ball is empty. */
    KRS_FUNCTION_PROBE,
    /* float krs_distance_lod(vec3 p, float footprint): what a graphics card should march by.  It is
       never above the distance to the nearest surface and not above 0 in the same places as
       krs_distance, but often less: what is far away for its size is not looked at.  What is
       smaller than `footprint`, the radius of a pixel's cone at p, counts as the box around it (0:
       nothing does).  Where a branch saves no work, krs_distance costs less. */
    KRS_FUNCTION_DISTANCE_LOD,
    /* const uint KRS_SCENE_PARTS;
       float krs_scene_part_distance(uint scene_part, vec3 p): the distance of one part, and
       void krs_scene_part_box(uint scene_part, inout vec3 low, inout vec3 high): a box around it. */
    KRS_FUNCTION_SCENE_PART_DISTANCE,
    KRS_FUNCTION_SCENE_PART_BOX,
    /* vec3 krs_gradient(vec3 p, float reach): where krs_distance rises fastest at a surface. */
    KRS_FUNCTION_GRADIENT,
    /* vec4 krs_tangent(vec3 p, float reach): that gradient of the nearest component, and how far the
       plane is that has it: about the distance near surfaces, < 0 inside.  It costs less than the
       safe distance of a polynomial.  Far away it is at least the distance to the box around a
       component, since polynomials may be beyond all numbers there. */
    KRS_FUNCTION_TANGENT,
    /* KrsSurface krs_surface(vec3 p, vec3 normal, float footprint): what is at p: the component
       with the least distance.  It is given the unit gradient of krs_distance at p, and the radius
       of the pixel's cone there in world units (0 for a point).  The normal that it returns is the
       one to light: unit, outwards, and the given one unless mirrors are smooth or there are bumps.

       KrsSurface has float distance; properties of the material (krs/surface.def): vec3 color,
       float roughness and others; uint component, level, instance; vec3 normal. */
    KRS_FUNCTION_SURFACE,
    /* uint krs_medium_at(vec3 p): the medium there, as in krs_medium; where glass is nested. */
    KRS_FUNCTION_MEDIUM_AT,
    /* float krs_glass(vec3 p): the distance to components of glass alone, < 0 inside of one. */
    KRS_FUNCTION_GLASS,
    /* float krs_subsurface(vec3 p): the distance to components below whose surface light may go on
       (KrsProgram.subsurface), < 0 inside of one. */
    KRS_FUNCTION_SUBSURFACE,
    /* Media that scatter light (KrsProgram.volumes), numbered from 0:
       float krs_volume_density(uint volume, vec3 p): how much of the light that goes on from p is lost
       or scattered, on a unit of length; 0 outside of the medium.
       vec3 krs_volume_albedo: the part of that which is scattered.
       float krs_volume_anisotropy: the mean cosine of scattering.
       vec3 krs_volume_emission: what the medium sends out itself where it is dense. */
    KRS_FUNCTION_DENSITY,
    KRS_FUNCTION_ALBEDO,
    KRS_FUNCTION_ANISOTROPY,
    KRS_FUNCTION_EMISSION,
    /* float krs_sin(float a), krs_cos, krs_tan: for callers that need them as well. */
    KRS_FUNCTION_SINES,
    /* float krs_atan2(float a, float b), likewise. */
    KRS_FUNCTION_ARCS,
    KRS_FUNCTION_COUNT
} KrsFunction;

/* The method by which krs_along tells how far a ray may go. */
typedef enum KrsRayStep {
    KRS_STEP_EXACT,
    KRS_STEP_TAYLOR,
    KRS_STEP_ROOT_FREE,
    KRS_STEP_DIRECTIONAL
} KrsRayStep;

/* Stands in place of a march group's number, for the planes that rays meet without a march. */
enum { KRS_MARCH_GROUP_OF_PLANES = 255 };

/*
 * The meaning of distances of components that may let light through, if the scene has any
 * (KrsProgram.media).  GLASS_NESTED: they are media, and a ray is in one of them or in none.  Its
 * number is in the global krs_medium, which the caller sets.  If several contain a point, the one
 * that is shown last is the medium there.  Distances and steps are those to where the ray leaves
 * its medium, enters one that is shown later, or meets a solid that lets no light through.  There
 * krs_surface tells what is known of the boundary (compiler/print/media.c).
 */
typedef enum KrsGlass {
    KRS_GLASS_SOLID,    /* they are like all others */
    KRS_GLASS_NESTED,   /* as above */
    KRS_GLASS_LEFT_OUT, /* distances leave them out */
} KrsGlass;

typedef struct KrsVariant {
    uint32_t   zones;       /* of the caller, that the block has room for, behind all other slots */
    uint32_t   march_group; /* krs_distance and krs_along are of this group alone; 0: of all */
    KrsRayStep step;        /* of krs_along */
    KrsGlass   glass;       /* what distances say of components that may let light through */
    bool       planes;      /* distances leave out the planes that krs_plane_t knows */
    bool camera_relative; /* points are relative to an origin near them (graph/rewrite/rebase.h) */
    bool many_threads; /* for devices with many threads: operations count, and branches save work.
                           Elsewhere what has to be waited for counts, and built-in min and max of
                           variables are three instructions, since they mind what is not a number */
    bool shares;  /* where both are wanted, krs_surface goes on from what krs_distance has found:
                           half the text, in which operations have another order */
    bool values;  /* the host fills in what depends on the state alone (krs_state_values) */
    bool buffers; /* tables are storage buffers, for devices that read too few texels */
    /* krs_surface finds the nearest component by the planes of krs_gradient: for points of surfaces,
       where these cost less than the safe distances of polynomials.  Outside of the box around a
       component it is the box that counts. */
    bool tangents;
    /* Many noises in krs_surface are one loop: a driver that copies functions to where they are
       called has less to translate.  GLSL then needs GL_EXT_control_flow_attributes. */
    bool gathers_noises;
} KrsVariant;

/* Fewer noises are not worth a loop. */
enum { KRS_MIN_FUSED_NOISES = 4 };

/* Returns a number that tells texts apart, for caches. */
uint64_t krs_variant_hash(const KrsVariant *variant, const KrsFunction *wanted, size_t count);

#endif
