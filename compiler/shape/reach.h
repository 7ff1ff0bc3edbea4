/*
 * reach.h: how far a kernel-reflection sequence reaches.
 *
 * Boxes and balls that grow mirror by mirror grow faster than what is in them, and after some
 * twenty mirrors are many times too large.  A ray that misses the tree would still be traced.
 */
#ifndef KRS_REACH_H
#define KRS_REACH_H

#include <stdint.h>

#include "compiler/shape/box.h"

/* A stage of a sequence whose numbers are known. */
typedef struct ReachStage {
    enum { REACH_KERNEL, REACH_REFLECT, REACH_MAP } kind;
    Box    kernel;               /* KERNEL: the box around it */
    double normal[3], offset;    /* REFLECT: unit normal and offset */
    double rows[3][3], shift[3]; /* MAP: x -> rows x + shift */
    Box    box;                  /* around the set after this stage; reach_tighten makes it */
    Ball   ball;                 /* smaller */
} ReachStage;

/* Makes box and ball of the last of `count` stages as tight as a bounded search can, usually to
   1 %, given those of the stages before. */
void reach_tighten(ReachStage *stages, uint32_t count);

#endif
