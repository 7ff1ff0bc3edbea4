/*
 * cut.h: computes volumes of boxes that are cut by planes.
 */
#ifndef KRS_MEASURE_CUT_H
#define KRS_MEASURE_CUT_H

#include <stdbool.h>

#include "compiler/field/field.h"

/* The points where at + slope . p is below 0. */
typedef struct HalfSpace {
    double at, slope[3];
} HalfSpace;

/* Half-spaces and their joins in postfix order, as of pieces: minima are unions, maxima
   intersections. */
typedef struct HalfSpaces {
    size_t    count, step_count;
    int       steps[MAX_PIECE_STEPS];
    HalfSpace items[MAX_PIECES];
} HalfSpaces;

/* Finds the volume of what is in a box around 0 with these half sides and in the half-spaces, and
   the integral of p over it; returns false if it has too many parts. */
bool cut_box(const double half[3], const HalfSpaces *spaces, double *volume, double moment[3]);

#endif
