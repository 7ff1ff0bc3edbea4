/*
 * research.h: methods beside lower_along that tell how far a ray may go.
 */
#ifndef KRS_LOWER_RESEARCH_H
#define KRS_LOWER_RESEARCH_H

#include "compiler/shape/shape.h"

struct LoweredGroups; /* compiler/lower/instance_groups.h */

/* All are safe. */
typedef enum ResearchMethod {
    /* These are for polynomials (series_radii.c). */
    RESEARCH_TAYLOR,    /* by the slope of a Taylor series (Ban and Valasek): the r with
                         r sum n |P_n| r^(n-1) = |P_0| */
    RESEARCH_ROOT_FREE, /* by a radius in which a Taylor series has no root: the r with
                         sum |P_n| r^n = |P_0| */
    /* These are for sequences with maps that invert (ray_images.c). */
    RESEARCH_DIRECTIONAL, /* by where the ray leaves empty balls */
    RESEARCH_PROBE, /* tests a ball around OP_POINT of radius OP_FOOTPRINT: it is empty when the result
                       exceeds the radius.  The result is no distance, but about the radius that an
                       empty ball could have. */
    RESEARCH_COUNT
} ResearchMethod;

/* Lowers the step along a ray by another method; `plain` if it does not apply. */
Node lower_research(Graph *graph, const Shape *shape, Node plain, ResearchMethod method,
                    struct LoweredGroups *groups, Arena *scratch);

#endif
