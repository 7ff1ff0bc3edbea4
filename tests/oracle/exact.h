/*
 * exact.h: where rays meet solids, in closed form and in double precision, and the picture that
 * a camera takes of many of them.
 *
 * Known here are the definitions of the solids and of the cameras (interface.md), and nothing of
 * distances or of marching.  Nothing is shared with the compiler or the runtime.
 */
#ifndef ORACLE_EXACT_H
#define ORACLE_EXACT_H

#include "tests/oracle/expand.h"

/* A ray; the direction is of unit length. */
typedef struct Line {
    Vec origin, direction;
} Line;
static inline Vec line_at(Line line, double t)
{
    return vec_add(line.origin, vec_scale(t, line.direction));
}

/* The part of a line that is inside of a convex solid; none where enter > leave. */
typedef struct Chord {
    double enter, leave;
} Chord;
static inline bool  chord_is_empty(Chord chord) { return !(chord.enter <= chord.leave); }
static inline Chord chord_meet(Chord a, Chord b)
{
    return (Chord){fmax(a.enter, b.enter), fmin(a.leave, b.leave)};
}

Chord chord_of_ball(Line line, Vec centre, double radius);
Chord chord_of_half(Line line, Half half);
Chord chord_of_box(Line line, Vec low, Vec high);
/* Returns all points within `radius` of a segment of some length. */
Chord chord_of_capsule(Line line, Vec from, Vec to, double radius);

/* What a capsule and some half-spaces have in common. */
typedef struct Rod {
    Vec    from, to;
    double radius;
    Half   cuts[EXPAND_MIRRORS];
    int    cut_count;
} Rod;

Chord chord_of_rod(Line line, const Rod *rod);
/* Returns a copy of a capsule, in the world. */
Rod rod_of_copy(const Copy *copy);

/* A camera with y up, and the size of its picture in pixels. */
typedef struct Lens {
    Vec    eye, right, up, forward; /* unit vectors, orthogonal */
    double half;     /* half of the picture's height: at distance 1, if perspective */
    bool   parallel; /* orthographic */
    int    width, height;
} Lens;

Lens lens_make(Vec eye, Vec target, double half, bool parallel, int width, int height);
/* Returns the ray through a place of the picture, in pixels from its top left corner. */
Line lens_ray(const Lens *lens, double x, double y);
/* Returns the width of a pixel at a depth, which is taken along the view axis. */
double lens_pixel(const Lens *lens, double depth);

/* Where the ray through (i + x, j + y) of each pixel enters the first rod; HUGE_VAL where it
   meets none.  All rods are in front of the eye. */
void rods_seen(const Rod *rods, size_t count, const Lens *lens, double x, double y, double *enter);

#endif
