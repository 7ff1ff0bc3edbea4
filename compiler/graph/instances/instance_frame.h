/*
 * instance_frame.h: the tables of instance groups in a frame.
 *
 * A grid for all frames has in its lists whatever is near a cell in any of them.  Where instances move, a
 * grid for one frame has much shorter lists.
 */
#ifndef KRS_INSTANCE_FRAME_H
#define KRS_INSTANCE_FRAME_H

#include "compiler/graph/instance_table.h"

/* Tells whether the instances of some table move. */
bool instances_move(const Instances *instances);

/* Returns a copy with tables of its own, which share all that they have; NULL of NULL. */
Instances *instances_for_frames(const Instances *instances, Arena *arena);

/* Gives each table of such a copy whose instances move a grid of the frame that `values` are of. */
void instances_enter_frame(Instances *instances, const NodeValue *values, Arena *arena,
                           Arena *scratch);

/* Returns a box under a similarity: its scale, the rows of its rotation, and its shift. */
Box box_under_map(const Box *box, const NodeValue *const map[5]);

#endif
