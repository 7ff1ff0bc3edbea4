/*
 * sequence_box.h: how the box of a sequence of reflections and similarities follows from those of its
 * kernels and from its numbers (box_rules.h).
 */
#ifndef KRS_SEQUENCE_BOX_H
#define KRS_SEQUENCE_BOX_H

#include "compiler/shape/box_rules.h"
#include "compiler/shape/reach.h"

/* Returns the box; `reach` has room for the stages; `bounds` gets those of the stages, unless it is
   NULL. */
Box sequence_box(const BoxInput *in, ReachStage *reach, LevelBound *bounds);
/* The numbers that are asked for: at most MAX_STAGE_NODES of each stage. */
enum { MAX_STAGE_NODES = 5 };
uint32_t sequence_nodes(const Shape *krs, Node *nodes);
/* Tells whether all of its stages are such. */
bool sequence_is_rigid(const Shape *krs);

#endif
