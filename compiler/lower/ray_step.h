/*
 * ray_step.h: steps along rays where each polynomial has another step than that of lower_along.
 */
#ifndef KRS_RAY_STEP_H
#define KRS_RAY_STEP_H

#include "compiler/lower/context.h"

/* Lowers as lower_along does, by this step along polynomials; NULL: by its own. */
Node lower_along_by(Graph *graph, const Shape *shape, Node plain, SeriesStep *step,
                    struct LoweredGroups *groups, Arena *scratch);

#endif
