/*
 * csg_truth.h: random solids by CGAL's exact set operations.
 */
#ifndef KRS_CSG_TRUTH_H
#define KRS_CSG_TRUTH_H

#include "tests/oracle/csg_polyhedra.h"
#include "tests/oracle/csg_triangles.h"

/*
 * Of parts that are grown by so much.  Solids in general position are cut by corefinement.  Level ones are Nef polyhedra:
 * what touches along an edge or in a point is apart, as `krs mesh` has it.  Throws what CGAL cannot do.
 */
Triangles truth_of(const Solid &solid, double by, int sides);

#endif
