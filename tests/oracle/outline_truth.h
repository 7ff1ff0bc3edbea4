/*
 * outline_truth.h: signed distances to what contours fill, by brute force.
 *
 * Contours are cut into short lines, and these where they cross.  A line is on the outline if the
 * fill rule says something else on its two sides, by windings that are counted here.  The least
 * distance to such a line is the truth, and the winding at a point says whether it is inside.
 */
#ifndef ORACLE_OUTLINE_TRUTH_H
#define ORACLE_OUTLINE_TRUTH_H

#include "compiler/outline/outline.h"

enum { PARTS = 128 /* of a curve */, MAX_LINES = 40000 };

typedef struct Line {
    double a[2], b[2];
} Line;

typedef struct Truth {
    Line     lines[MAX_LINES]; /* those on the outline first */
    size_t   count, outline;
    FillRule rule;
} Truth;

void   find_truth(Truth *truth, const Curves *curves, FillRule rule);
double true_distance(const Truth *truth, const double p[2]);

#endif
