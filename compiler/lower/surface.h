/*
 * surface.h: what a hit knows of the surface: chosen from one of two shapes, or mixed.
 */
#ifndef KRS_SURFACE_H
#define KRS_SURFACE_H

#include "compiler/lower/context.h"

/* The one where the condition holds, the other elsewhere. */
Surface choose_surface(Graph *g, Node condition, Surface a, Surface b);
/* `weight` 1 is a; what cannot be mixed is taken from a where `nearer`. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b);

#endif
