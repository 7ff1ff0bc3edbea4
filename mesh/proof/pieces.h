/*
 * pieces.h: does as smooth.h where the surface has edges: the sign of the distance is that of
 * minima and maxima of pieces whose derivatives do not jump.
 *
 * A tetrahedron is cut into smaller ones, cones from a vertex of the mesh over the parts of its
 * boundary on both sides.  In each of them every piece is bounded by its values at the corners and
 * its second derivatives, and minima and maxima of the bounds are bounds.  Where that is not enough
 * a part is halved.
 *
 * Where parts of the solid face each other across a gap, or sides of a wall, a way along which a
 * part grows may come to the next one.  So there is a bound, too, of how far they are apart.
 */
#ifndef KRS_MESH_PIECES_H
#define KRS_MESH_PIECES_H

#include "mesh/proof/facing.h"
#include "mesh/proof/smooth.h"

typedef struct PieceCell {
    bool        known;
    FieldPieces pieces;
    double      above[MAX_PIECES][6], below[MAX_PIECES][6]; /* as of SmoothCell */
    /* All pieces of a part grow by `slope` along one direction, and none by more than `steep` along
       any. */
    double slope, steep;
    Facing facing;
    Growth growth; /* of one part; its count is 0 if there are several */
} PieceCell;

/* Bounds the pieces in a box, which the field has entered last. */
void pieces_bound(MeshField *field, Box box, PieceCell *cell);
/* Does as smooth_measure, but stops as soon as the deviation fits the error. */
bool pieces_measure(const Contour *contour, const MeshField *field, const PieceCell *cell,
                    double error, Tet *tet);

#endif
