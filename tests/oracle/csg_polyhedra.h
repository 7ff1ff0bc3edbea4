/*
 * csg_polyhedra.h: parts of random solids as fine polyhedra.
 *
 * Nothing of krs is used: sizes and words are taken by their meaning in docs/language.md.
 */
#ifndef KRS_CSG_POLYHEDRA_H
#define KRS_CSG_POLYHEDRA_H

#include "tests/oracle/csg_random.h"

/* Vertices, and faces that look outwards; faces of more than three corners are flat but for rounding. */
struct Polyhedron {
    std::vector<Vec>                      vertices;
    std::vector<std::vector<std::size_t>> faces;
};

/* A part is made of these, one after the other. */
struct Piece {
    char       csg_node; /* | - & */
    Polyhedron solid;
};

/* Grown by so much, or shrunk where that is below 0, with so many sides to a circle.  Throws where a part cannot be. */
std::vector<Piece> pieces_of(const Part &part, double by, int sides);

/* Returns the farthest that a part is from its facets. */
double sag_of(const Tree &tree, int sides);

#endif
