/*
 * csg_nodes.h: CSG nodes without what no surface needs.
 *
 * A blend of two shapes is more than their minimum only where both distances are about the same.  If
 * that is nowhere near the surface of the whole, the minimum will do.  The tool that cuts a hole right
 * through a plate may as well have no ends; and the distance around the edges of a tool is asked for inside
 * of what it cuts only, where that to its sides will do.
 *
 * The distance is seen as a tree of minima, maxima and blends whose leaves are distances that are not
 * looked into.  Boxes that the surface may pass are halved, down to a 96th of the whole; in each,
 * intervals tell which leaves, blends and sides may have an influence.  What has none in any of them is
 * left out.  So on the surface, and outside of it nearby, the distance is the same as before.  Elsewhere it
 * is another one: but intervals prove as well that it has the same sign everywhere, and a tree of this
 * kind is as steep as its steepest leaf.  Therefore it is a bound of the distance, too.
 */
#ifndef KRS_CSG_NODES_H
#define KRS_CSG_NODES_H

#include "compiler/graph/graph.h"
#include "compiler/graph/range.h"

/* Returns the distance `root` of a solid in `box` without what its CSG nodes do not need; `root`
   itself where all is needed, or where it depends on the frame. */
Node csg_nodes_prune(Graph *graph, Node root, Box box, Arena *scratch);

#endif
