/*
 * flat_joins.h: half-spaces and how they are joined.
 */
#ifndef KRS_MESH_FLAT_JOINS_H
#define KRS_MESH_FLAT_JOINS_H

#include "mesh/flat/flat_forms.h"

int flat_node(Finding *f, FlatNode node);
/* Leave out what makes no difference: faces of parts within others, and where parts touch. */
int flat_both(Finding *f, int a, int b);
int flat_either(Finding *f, int a, int b);
int flat_complement(Finding *f, int solid);
/* Where a form without kinks is below 0. */
int flat_half_space(Finding *f, const Form *form);
/* flat_pieces.c: where any form is below 0. */
int flat_solid(Finding *f, const Form *form);

#endif
