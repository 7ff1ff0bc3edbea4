/*
 * methods.h: what the methods of this room are made of.
 */
#ifndef KRS_LOWER_METHODS_H
#define KRS_LOWER_METHODS_H

#include "compiler/lower/context.h"

/* Steps of RESEARCH_TAYLOR and RESEARCH_ROOT_FREE along polynomials (series_radii.c). */
SeriesStep series_step_of_taylor, series_step_of_root_free;
/* Lowers an image by RESEARCH_DIRECTIONAL, or by RESEARCH_PROBE if `probes` (ray_images.c). */
Node lower_image(Graph *graph, const Shape *shape, Node plain, bool probes,
                 struct LoweredGroups *groups, Arena *scratch);

#endif
