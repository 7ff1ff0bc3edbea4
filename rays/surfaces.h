/*
 * surfaces.h: what is at points on surfaces, by lanes of the host, without shaders.
 *
 * It is what krs_surface of a scene's text finds.  Points that are near each other are in a ball, and there most
 * of the scene has no influence (graph/lanes/lane_cells.h): other components, and other shapes of the same one.
 */
#ifndef KRS_RAYS_SURFACES_H
#define KRS_RAYS_SURFACES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "krs/krs.h"

typedef struct SurfacePoint {
    float    position[3], normal[3]; /* the normal is on the outside of the solid */
    float    view[3];                /* of the ray that sees it, unit */
    float    footprint;              /* the radius of a pixel there */
    float   *found;                  /* where to write what is found */
    uint32_t order;                  /* by which surface_points_sort sorts */
} SurfacePoint;

/* The numbers of a surface, in this order. */
#define FLOAT(name) float name;
#define VEC3(name)  float name[3];
#define UINT(name)  uint32_t name;
typedef struct FoundSurface {
    float distance, normal[3];
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) shown(name)
#include "krs/surface.def"
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) type(name)
#include "krs/surface.def"
} FoundSurface;
#undef FLOAT
#undef VEC3
#undef UINT

/* The numbers that are found: those that all materials have, color to emission, or those of layers,
   too. */
enum {
    PLAIN_SURFACE_NUMBERS = offsetof(FoundSurface, specular) / sizeof(float),
    SURFACE_NUMBERS       = sizeof(FoundSurface) / sizeof(float)
};

/* Surfaces of a state of a scene. */
typedef struct SurfaceField SurfaceField;

/* Makes a field; the state stays as it is while that is in use.  NULL: memory has run out. */
SurfaceField *surface_field_new(KrsState *state, bool layers);
void          surface_field_free(SurfaceField *field);
/* Tells whether surfaces can be found: not where light goes through something or surfaces are open, or where
   there is nothing. */
bool surface_field_suits(const KrsScene *scene);

/* Sorts points so that those which follow each other are near each other. */
void surface_points_sort(SurfacePoint *points, size_t count);

/* Finds surfaces, in one of the parts of run_in_parallel.  Points are near those before and behind them; as many as
   SURFACES_AT_ONCE cost the least. */
enum { SURFACES_AT_ONCE = 16384 };
void surface_field_find(const SurfaceField *field, size_t part, const SurfacePoint *points,
                        size_t count);
/* Finds the colors of points alone. */
void surface_field_find_colors(const SurfaceField *field, size_t part, const SurfacePoint *points,
                               size_t count);

#endif
