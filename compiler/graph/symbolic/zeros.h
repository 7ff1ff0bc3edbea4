/*
 * zeros.h: where a polynomial of the point may be 0, as a box.
 *
 * A ray needs no polynomial where it cannot be 0, and single precision has no digit left of one
 * that is looked at from thousands of units away.
 */
#ifndef KRS_ZEROS_H
#define KRS_ZEROS_H

#include "compiler/graph/bounds/facts.h"

typedef struct ZeroBox {
    Box box;  /* all zeros are in it; infinite where nothing is known */
    int sign; /* of the polynomial outside of it; 0: the box is infinite on all sides */
} ZeroBox;

/* Finds a box around the zeros of a FLOAT that is a polynomial of the point, for all values of the parameters. */
ZeroBox graph_zero_box(Graph *graph, Node polynomial, Arena *scratch);

#endif
