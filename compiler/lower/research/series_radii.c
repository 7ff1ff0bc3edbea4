/*
 * series_radii.c: radii in which a polynomial along a ray has no root (math.md, section 3).
 *
 * A radius holds in both directions, and needs no interval; so it is shorter than the step of ray_step.c.
 */
#include "compiler/graph/build.h"
#include "compiler/graph/symbolic/series.h"
#include "compiler/lower/research/methods.h"

static void drop_signs(Graph *graph, Series *series)
{
    for (uint32_t k = 0; k <= series->degree; k++)
        series->c[k] = graph_op1(graph, OP_abs, series->c[k]);
}

Node series_step_of_root_free(Graph *graph, Series *series)
{
    drop_signs(graph, series);
    return series_radius(graph, series);
}

/* Returns the r with r sum n |P_n| r^(n-1) = |P_0|: the fixed point of Ban and Valasek.  It is
   found as a root, since their iteration diverges where terms of high order are large (math.md,
   section 3). */
Node series_step_of_taylor(Graph *graph, Series *series)
{
    drop_signs(graph, series);
    for (uint32_t k = 2; k <= series->degree; k++)
        series->c[k] = mul(graph, series->c[k], graph_number(graph, k));
    return series_radius(graph, series);
}
