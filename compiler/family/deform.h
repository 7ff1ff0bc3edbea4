/*
 * deform.h: what the deformations share; each has a file of its own.
 */
#ifndef KRS_DEFORM_H
#define KRS_DEFORM_H

#include "compiler/family/family.h"
#include "compiler/lower/context.h"

/* ---- how they are made ---- */

/* The number of cells into which a range is cut where the box of a deformed shape is looked for. */
enum { DEFORM_CELLS = 64 };

/* Slopes of weights may cost so much: a quarter of the step. */
#define COST_OF_WEIGHT 0.25

/* Checks a solid, whose distance is one; false: reported. */
bool check_solid(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked);
/* Checks a solid with an end in every direction. */
bool check_deformable(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked);
/* Returns the rotation that brings an axis to y; NULL: it is y. */
const Map *raise_axis(ShapeBuilder *builder, Node axis);
Shape *deformed_shape(ShapeBuilder *builder, ShapeKind kind, const char *name, const Shape *shape,
                      const DeformArguments *asked);
/* Notes what the deformation was divided by, at most, if there is a limit: for reports. */
void note_slope(Shape *deformed, double slope);
/* These return how far regions reach beyond a box for meshes (builder_region), else 0; and the
   shape in a box that is larger by that, and by no more than `most`. */
double       region_room(const ShapeBuilder *builder, Box box);
const Shape *in_region(ShapeBuilder *builder, const Shape *shape, double most);

/* Returns (b + sqrt(b^2 + 4)) / 2, the norm of a shear by b. */
double shear_slope(double b);
/* Returns cell `i` of the DEFORM_CELLS of a range. */
Range range_cell(Range range, int i);
/* Returns the largest distance from the y axis in a box. */
double box_radius(Box box);
/* Deforms a shape in the position to which a rotation brings it, and rotates it back; NULL:
   reported. */
const Shape *deform_rotated(ShapeBuilder *builder, const Shape *shape, const Map *rotation,
                            MakeDeformed *deform, const DeformArguments *asked);

/* ---- how they are lowered ---- */

/* The deformation undone at the point of C that is nearest to a point: how far that is, and the
   point before the deformation. */
typedef struct InverseDeformation {
    Node offset, point;
    Node in[3], out[3]; /* rows of matrices that take normals to the child's space, and back */
    Node shrink;        /* how much larger things are in the child's space; NODE_NONE: not */
} InverseDeformation;

/* Lowers the child where the deformation is undone, by a distance with the slope 1. */
Lowered lower_undone(Lowering *l, const Shape *shape, LowerContext context,
                     const InverseDeformation *inverse);
/* Finds the distance outside of C as well, from `result`, that in C.  `is_inside`: a condition that
   tells C; NODE_NONE: the offset is 0 there. */
Lowered with_region(Lowering *l, Lowered result, Node offset, Node is_inside);
/* Cuts a distance to what a weight of slope `steep` needs: a fraction of the width of the solid
   where that is less.  *cost is what the weight adds to the slope. */
Node cut_distance(Graph *g, Node distance, double width, Node steep, Node *cost);
/* Tells how far the solid reaches from the y axis. */
double axis_radius(Box box);
/* Returns a point with x and z scaled and another y. */
Node across_scaled(Graph *g, Node point, Node y, Node factor);
Node radius_of(Graph *g, Node point);
/* Returns (b + sqrt(b^2 + 4)) / 2, the norm of a shear by b. */
Node shear_norm(Graph *g, Node b);

static inline Node least(Graph *g, Node a, Node b) { return graph_op2(g, OP_min, a, b); }
static inline Node most(Graph *g, Node a, Node b) { return graph_op2(g, OP_max, a, b); }
static inline Node row(Graph *g, Node x, Node y, Node z) { return graph_op3(g, OP_vec3, x, y, z); }
static inline Node length_of(Graph *g, Node a, Node b)
{
    return graph_op1(g, OP_length, graph_op2(g, OP_vec2, a, b));
}

#endif
