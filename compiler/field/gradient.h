/*
 * gradient.h: ranges of derivatives, as a direction and how far they are from it.
 */
#ifndef KRS_FIELD_GRADIENT_H
#define KRS_FIELD_GRADIENT_H

#include "compiler/graph/lanes/lanes.h"

/* Derivatives in a box: those along the direction of their middle are from `least` to `most`, and those
   across it up to `across`. */
typedef struct Gradient {
    double middle[3], direction[3], least, most, across;
} Gradient;

/* Finds the gradient; false: the value does not grow along any direction that is known. */
bool find_gradient(const LaneSlope *slope, Gradient *gradient);

/* Returns the box of some corners, wider by a margin. */
Box corners_box(const double (*corners)[3], size_t count, double margin);

#endif
