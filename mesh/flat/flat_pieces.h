/*
 * flat_pieces.h: represents a solid in a box by half-spaces, intersections and unions.
 *
 * Where a distance is made of linear numbers by minima, maxima and absolute values, its sign is
 * that of minima and maxima of linear numbers alone.  So the distance to a prism, which mirrors
 * space until one side is left, is in a box around an edge the maximum of what its two sides cut.
 */
#ifndef KRS_MESH_FLAT_PIECES_H
#define KRS_MESH_FLAT_PIECES_H

#include "compiler/field/field.h"
#include "mesh/flat/flat_planes.h"
#include "mesh/flat/flat_rounds.h"

/* The working memory of one thread. */
typedef struct FlatWork {
    struct Form *forms;
    int         *conditions;
} FlatWork;

FlatWork flat_work_new(const MeshField *field, Arena *arena);

/* Finds the half-spaces in a box within the one that was entered last, where `size` is that of what
   is meshed.  Returns false if the solid is not made of half-spaces, or of too many. */
bool flat_pieces(MeshField *field, Box box, double size, FlatRounds *rounds, FlatUse use,
                 FlatWork *work, FlatPieces *pieces);

#endif
