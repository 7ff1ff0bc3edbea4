/*
 * crowd_frame.h: the tables of crowds in a frame.
 *
 * A grid for all frames has in its lists whatever is near a cell in any of them.  Where members move, a
 * grid for one frame has much shorter lists.
 */
#ifndef KRS_CROWD_FRAME_H
#define KRS_CROWD_FRAME_H

#include "compiler/graph/crowd.h"

/* Whether the members of some table move. */
bool crowds_move(const Crowds *crowds);

/* A copy with tables of its own, which share all that they have; NULL of NULL. */
Crowds *crowds_for_frames(const Crowds *crowds, Arena *arena);

/* Gives each table of such a copy whose members move a grid of the frame that `values` are of. */
void crowds_enter_frame(Crowds *crowds, const NodeValue *values, Arena *arena, Arena *scratch);

/* A box under a similarity: its scale, the rows of its turn, and its shift. */
Box box_under_map(const Box *box, const NodeValue *const map[5]);

#endif
