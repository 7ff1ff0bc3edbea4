/*
 * figure_outline.h: the outline of a figure of which the numbers of all parts are known.
 */
#ifndef KRS_FIGURE_OUTLINE_H
#define KRS_FIGURE_OUTLINE_H

#include "compiler/outline/path.h"
#include "compiler/shape/shape.h"

/* Finds the outline of a figure, with the inside on its left; false: it is not known.  *changed: some part of an outline is
   gone, or its distance is only a bound.  All that is made is in the arena. */
bool figure_outline(Graph *graph, const Shape *figure, Arena *arena, Curves *curves, bool *changed);
/* Returns the size of some curves. */
double curves_size(const Curves *curves);

#endif
