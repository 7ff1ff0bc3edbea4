/*
 * flat_separate.h: surfaces that touch along edges or in points, taken apart there.
 */
#ifndef KRS_MESH_FLAT_SEPARATE_H
#define KRS_MESH_FLAT_SEPARATE_H

#include "mesh/flat/polygons.h"

/* Has each edge in two triangles, once in each direction: where it is in more, those belong together that have the
   solid between them.  There, and where only corners meet, vertices are double.  False: the triangles are not closed. */
bool flat_separate(FlatVertices *vertices, Triangles *triangles, Arena *arena);

#endif
