/*
 * grid_blend.h: how the instances of a grid are blended.
 */
#ifndef KRS_GRID_BLEND_H
#define KRS_GRID_BLEND_H

#include "compiler/graph/grid.h"
#include "compiler/graph/lanes/lanes.h"

typedef struct GridBlend {
    Op     op; /* a smooth minimum whose slope is 1 (blends.def): of two, or of eight if `shares` */
    bool   shares; /* near instances share the result */
    bool   sums;   /* all instances make one sum of powers */
    double width;
    double steps;            /* their number, of blends that have some */
    const LaneTape *tape;    /* its output is the distance of an instance */
    double         *scalars; /* of each instance: tape->scalar_count */
    double          slope;   /* of all distances */
    bool            fades;   /* as blends.def says, and only distances count */
    bool            sifted; /* listed instances are all that count: no clearance ends their cells */
    double          acts;   /* an instance that is farther above the least of all changes nothing */
    double          reach;  /* as of the grid; infinite where any instance may change a result */
    double          swell;  /* how far the least instance may be above a result of 0 */
    double          margin; /* likewise, as it was given */
} GridBlend;

#endif
