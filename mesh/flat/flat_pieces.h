/*
 * flat_pieces.h: a solid in a box, as half-spaces that are joined by intersections and unions.
 *
 * Where a distance is made of linear numbers by minima, maxima and absolute values, its sign is that of minima
 * and maxima of linear numbers alone.  So the distance to a prism, which mirrors space until one side is left, is in
 * a box around an edge the maximum of what its two sides cut.
 */
#ifndef KRS_MESH_FLAT_PIECES_H
#define KRS_MESH_FLAT_PIECES_H

#include "compiler/field/field.h"
#include "mesh/flat/flat_planes.h"
#include "mesh/flat/flat_rounds.h"

/* Room for what is found of steps; for one thread. */
typedef struct FlatWork {
    struct Form *forms;
    int         *conditions;
} FlatWork;

FlatWork flat_work_new(const MeshField *field, Arena *arena);

/* In a box within that which was entered last.  `size`: of what is meshed; half-spaces that differ by less than
   rounding are one.  False: it is not made like that, or of more. */
bool flat_pieces(MeshField *field, Box box, double size, FlatRounds *rounds, FlatUse use,
                 FlatWork *work, FlatPieces *pieces);

#endif
