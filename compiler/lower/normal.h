/*
 * normal.h: normals of surfaces, mapped into the spaces of shapes and back.
 */
#ifndef KRS_NORMAL_H
#define KRS_NORMAL_H

#include "compiler/lower/context.h"

/* A step on the way inwards: a map of space, or a kernel that is joined there. */
typedef struct NormalStep {
    enum { NORMAL_MIRROR, NORMAL_ROTATE, NORMAL_STRETCH, NORMAL_KERNEL } kind;
    Node axis, amount;   /* MIRROR: unit vector; by how much it reflects on the way out */
    Node rows[3];        /* ROTATE: the matrix; STRETCH: [0] has the factors */
    Node normal, nearer; /* KERNEL: its normal; whether it is nearer than those further out */
} NormalStep;

/* The steps of a normal, from outside inwards; empty in a lowering without surfaces. */
typedef struct NormalPath {
    LowerContext innermost; /* normal, footprint and smoothing behind the steps so far */
    NormalStep  *steps;
    uint32_t     count;
} NormalPath;

/* Returns a path without steps; at most `most` will be added. */
NormalPath normal_path(Lowering *l, LowerContext context, uint32_t most);
/* Adds the inverse of x -> stretch * rows * x + shift. */
void normal_rotate(Lowering *l, NormalPath *path, const Node rows[3], Node stretch);
/* Adds the rotation about y that takes the direction of `outer` to that of `inner`. */
void normal_rotate_about_y(Lowering *l, NormalPath *path, Node outer, Node inner);
/* Adds the inverse of x -> factors * x, element by element.  `least` is the smallest factor. */
void normal_stretch(Lowering *l, NormalPath *path, Node factors, Node least);
/* Adds a reflection along a unit vector, which may depend on the point. */
void normal_flip(Lowering *l, NormalPath *path, Node axis);
/* Adds OP_fold at a point: a mirror, which is smooth where the context has a smoothing. */
void normal_fold(Lowering *l, NormalPath *path, Node point, Node axis, Node offset);
/* Adds a mirror of any kind.  `axis` is a unit vector at right angles to it, `height` how far the
   point is beyond it, and `front` whether it is. */
void normal_mirror(Lowering *l, NormalPath *path, Node axis, Node height, Node front);
/* Lengths behind this are 1 / stretch of those before it. */
void normal_stretch_evenly(Lowering *l, NormalPath *path, Node stretch);
/* Adds a kernel that was lowered here; `outer` is the union of the kernels before it. */
void normal_kernel(Lowering *l, NormalPath *path, Lowered outer, Lowered kernel);
/* Maps a normal back to the space where the path began.  It is the normal of the nearest kernel of
   the path, or `inner` where no kernel is nearest. */
Node normal_out(Lowering *l, const NormalPath *path, Node inner);
/* Returns the context behind the steps, at a point in that space. */
LowerContext context_behind(const NormalPath *path, LowerContext context, Node point);
/* Returns the normal, scaled to length 1; `otherwise` where its length is almost 0. */
Node unit_normal(Graph *g, Node normal, Node otherwise);
/* Lowers a shape at a point behind the steps; its normal is mapped back. */
Lowered lower_behind(Lowering *l, const Shape *child, LowerContext context, const NormalPath *path,
                     Node point);

#endif
