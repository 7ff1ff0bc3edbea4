/*
 * normal.h: normals of surfaces through maps of space, in and out again.
 */
#ifndef KRS_NORMAL_H
#define KRS_NORMAL_H

#include "compiler/lower/context.h"

/* One map of space, or a kernel that joins what is further in, from outside inwards. */
typedef struct NormalStep {
    enum { NORMAL_MIRROR, NORMAL_TURN, NORMAL_STRETCH, NORMAL_KERNEL } kind;
    Node axis, amount;   /* MIRROR: unit; how much of it, on the way out */
    Node rows[3];        /* TURN; [0] of STRETCH: factors */
    Node normal, nearer; /* KERNEL: of its surface; that it is nearer than all further out */
} NormalStep;

/* The maps that a normal passes, from outside inwards; empty in a lowering without surfaces. */
typedef struct NormalPath {
    LowerContext innermost; /* normal, footprint and smoothing behind the steps so far */
    NormalStep  *steps;
    uint32_t     count;
} NormalPath;

/* `most`: steps that will be taken. */
NormalPath normal_path(Lowering *l, LowerContext context, uint32_t most);
/* Before x -> stretch * rows * x + shift. */
void normal_turn(Lowering *l, NormalPath *path, const Node rows[3], Node stretch);
/* Before a turn about y that brings `inner` to where `outer` is. */
void normal_turn_about_y(Lowering *l, NormalPath *path, Node outer, Node inner);
/* Before x -> factors * x, element by element; `least` of them. */
void normal_stretch(Lowering *l, NormalPath *path, Node factors, Node least);
/* Before a reflection along a unit vector that depends on the point. */
void normal_flip(Lowering *l, NormalPath *path, Node axis);
/* OP_fold at the point; mirrors are where smoothing is. */
void normal_fold(Lowering *l, NormalPath *path, Node point, Node axis, Node offset);
/* A kernel was lowered here; `outer` is all that was joined before. */
void normal_kernel(Lowering *l, NormalPath *path, Lowered outer, Lowered kernel);
/* The normal in the space where the path began, of what was lowered behind it: of its kernels, or
   `inner` where there is none. */
Node normal_out(Lowering *l, const NormalPath *path, Node inner);
/* The context behind the steps, at a point there. */
LowerContext context_behind(const NormalPath *path, LowerContext context, Node point);
/* A unit vector; `otherwise` where nothing is left of the normal. */
Node unit_normal(Graph *g, Node normal, Node otherwise);
/* The same as lower_shape behind maps that have been taken down, at a point there. */
Lowered lower_behind(Lowering *l, const Shape *child, LowerContext context, const NormalPath *path,
                     Node point);

#endif
