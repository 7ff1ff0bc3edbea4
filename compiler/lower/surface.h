/*
 * surface.h: what is known of the surface at a hit where two shapes are joined.
 */
#ifndef KRS_SURFACE_H
#define KRS_SURFACE_H

#include "compiler/lower/context.h"

/* Returns `a` where the condition holds, else `b`. */
Surface choose_surface(Graph *g, Node condition, Surface a, Surface b);
/* Returns the weighted mean of both; `weight` 1 gives `a`.  What cannot be mixed is that of `a`
   where `nearer` holds, else that of `b`. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b);

#endif
