/*
 * flat_joins.h: joins half-spaces to solids.
 */
#ifndef KRS_MESH_FLAT_JOINS_H
#define KRS_MESH_FLAT_JOINS_H

#include "mesh/flat/flat_forms.h"

/* These intersect and unite solids, without what makes no difference: faces of parts within others,
   and where parts touch. */
int flat_both(Finding *f, int a, int b);
int flat_either(Finding *f, int a, int b);
int flat_complement(Finding *f, int solid);
/* Returns how far planes may be moved: one that is no farther from the box may have a part in it. */
double flat_moved(const Finding *f);
/* Returns the half-space where a form without kinks is below 0. */
int flat_half_space(Finding *f, const Form *form);
/* Returns the solid where any form is below 0 (flat_pieces.c). */
int flat_solid(Finding *f, const Form *form);

#endif
