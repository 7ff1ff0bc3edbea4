/*
 * blocks.h: collapses edges in blocks of neighbouring triangles, up to their borders.
 *
 * What is needed of a block fits into a cache, and threads share blocks.  So most triangles go in a
 * part of the time that collapses of a large mesh take.
 */
#ifndef KRS_MESH_BLOCKS_H
#define KRS_MESH_BLOCKS_H

#include "mesh/simplify/collapse.h"

/* Collapses edges of a mesh as far as bounds permit, until a part of the triangles is left; `order`
   has neighbours one after the other.  Writes those that are left, with what rules have of them and
   of vertices, and returns how many; 0: it was stopped. */
size_t collapse_blocks(const double (*vertices)[3], size_t    vertex_count,
                       const uint32_t (*triangles)[3], size_t count, const uint32_t *order,
                       const CollapseRules *rules, uint32_t (*left)[3], Arena *arena);

#endif
