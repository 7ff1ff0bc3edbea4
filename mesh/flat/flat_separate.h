/*
 * flat_separate.h: separates surfaces that touch along edges or in points.
 */
#ifndef KRS_MESH_FLAT_SEPARATE_H
#define KRS_MESH_FLAT_SEPARATE_H

#include "mesh/flat/polygons.h"

/* Duplicates vertices, so that each edge is in two triangles, once in each direction: where it is
   in more, pairs are those that have the solid between them.  Where only corners meet, vertices are
   duplicated, too.  Returns false if the triangles are not closed. */
bool flat_separate(FlatVertices *vertices, Triangles *triangles, Arena *arena);

#endif
