/*
 * grid_blend.h: how the instances of a grid are blended.
 */
#ifndef KRS_GRID_BLEND_H
#define KRS_GRID_BLEND_H

#include "compiler/graph/grid.h"
#include "compiler/graph/lanes/lanes.h"

typedef struct GridBlend {
    Op     op; /* a smooth minimum of which the slope is 1 (blends.def): of two, or of eight and */
    bool   shares;           /* they share the result; not of those that make a sum of powers, */
    bool   sums;             /* which is what all instances make, */
    double width;            /* and its width, */
    double steps;            /* and of some their number */
    const LaneTape *tape;    /* its output is the distance of an instance, */
    double         *scalars; /* with these scalars: tape->scalar_count for each */
    double          slope;   /* of all distances */
    bool            fades;   /* as blends.def says, and only distances count */
    bool            sifted; /* listed instances are all that count: no clearance ends their cells */
    double          acts;   /* an instance that is farther above the least of all changes nothing */
    double          reach;  /* as of the grid; infinite where any instance may change a result */
    double          swell;  /* how far the least instance may be above a result of 0 */
    double          margin; /* likewise, as it was given */
} GridBlend;

#endif
