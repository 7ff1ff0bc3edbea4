/*
 * vary.h: repeated content that depends on its cell: a leaf of the graph, that of `values[1]`, stands
 * for the cell's numbers, and is replaced when the content is lowered.
 */
#ifndef KRS_VARY_H
#define KRS_VARY_H

#include "compiler/lower/context.h"

/* Tells whether an expression needs a leaf. */
bool depends_on_leaf(const Graph *graph, Node root, Node leaf, Arena *scratch);
/* Tells whether the content's distance depends on its cell, not its surface alone. */
bool content_varies(Lowering *l, const Shape *repeat);
/* Returns the copy of an expression with a leaf. */
typedef Node CopyWithLeaf(Lowering *l, Node node, const void *user);
/* Copies what was lowered: the surface as well where there is one, and nodes that count as constants,
   those from index `held` on. */
void copy_lowered(Lowering *l, Lowered *lowered, size_t held, CopyWithLeaf *copy, const void *user);
/* Lowers the content in a cell with these numbers (VEC3), seen from a place in that cell's space.
   `operand`: as an operand of what needs its slope. */
Lowered lower_in_cell(Lowering *l, const Shape *repeat, LowerContext context, Node numbers,
                      bool operand);

#endif
