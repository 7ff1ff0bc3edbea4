/*
 * brute.h: geometry the slow and obvious way, to hold the compiler against.
 *
 * Surfaces are clouds of points that lie on them, so the distance to the nearest point of a
 * cloud is never less than the distance to the surface, and more by at most the cloud's
 * `spacing`.  Nothing here knows a distance formula, and nothing is shared with the compiler.
 */
#ifndef ORACLE_BRUTE_H
#define ORACLE_BRUTE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tests/support/random.h"

typedef struct Vec {
    double x, y, z;
} Vec;

static inline Vec    vec(double x, double y, double z) { return (Vec){x, y, z}; }
static inline Vec    vec_add(Vec a, Vec b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline Vec    vec_sub(Vec a, Vec b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline Vec    vec_scale(double s, Vec a) { return vec(s * a.x, s * a.y, s * a.z); }
static inline double vec_dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline double vec_length(Vec a) { return sqrt(vec_dot(a, a)); }
static inline double vec_distance(Vec a, Vec b) { return vec_length(vec_sub(a, b)); }
static inline Vec    vec_unit(Vec a) { return vec_scale(1 / vec_length(a), a); }
static inline Vec    vec_mix(Vec a, Vec b, double t)
{
    return vec_add(vec_scale(1 - t, a), vec_scale(t, b));
}
static inline Vec vec_cross(Vec a, Vec b)
{
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* Any unit vector at right angles to `a`. */
Vec vec_across(Vec a);
/* `p` turned about an axis through the origin, counter-clockwise seen from the axis' tip. */
Vec vec_rotate(Vec p, Vec axis, double angle);

/* {x : normal.x <= offset}, the normal of unit length. */
typedef struct Half {
    Vec    normal;
    double offset;
} Half;
static inline double half_excess(Half half, Vec p) { return vec_dot(half.normal, p) - half.offset; }

Vec random_unit(Random *random);
Vec random_in_cube(Random *random, double half);
/* In the ball around `centre`, half of the time within a hundredth of its surface. */
Vec random_in_ball(Random *random, Vec centre, double radius);

/* Points on a surface.  Zero is an empty cloud; cloud_free returns it to that. */
typedef struct Cloud {
    Vec   *points;
    size_t count, capacity;
    size_t indexed; /* how many points stand in the order of the search tree */
    double spacing; /* no point of the surface is farther than this from the cloud */
} Cloud;

/* A piece of a surface: the unit square mapped into space, or to NaN where it does not exist;
   `keep` then has to say no. */
typedef Vec Patch(const void *user, double u, double v);
/* Which points of a patch belong to the surface. */
typedef bool Keep(const void *user, Vec point);

void cloud_free(Cloud *cloud);
void cloud_add(Cloud *cloud, Vec point);
/* Covers a patch with samples about `step` apart and widens `spacing` to what came of it; with
   `keep` (may be NULL), only the samples it accepts. */
void cloud_patch(Cloud *cloud, Patch *patch, Keep *keep, const void *user, double step);
/* Distance to the nearest point; HUGE_VAL for an empty cloud. */
double cloud_nearest(Cloud *cloud, Vec point);

#endif
