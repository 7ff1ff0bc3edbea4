/*
 * bounds.h: finds which tetrahedra fit, by bounds of derivatives.
 */
#ifndef KRS_MESH_BOUNDS_H
#define KRS_MESH_BOUNDS_H

#include "mesh/proof/mesher.h"

double proven_error(const Mesher *m);
void   tet_box(const Mesher *m, const Tet *tet, double low[3], double high[3]);
Box    box_and_margin(double margin, const double low[3], const double high[3]);
Tet   *tet_of_group(Mesher *m, const Group *group, uint32_t i);

/* Returns the state of a tetrahedron whose deviation and slope are known. */
TetState state_by_bounds(const Mesher *m, const Tet *tet);
/* These are called before and after the states of all groups are found. */
void bounds_begin(Mesher *m);
void bounds_end(Mesher *m);
/* Finds the states of the tetrahedra of a group. */
void bound_group(Mesher *m, Verifier *verifier, const Group *group);

#endif
