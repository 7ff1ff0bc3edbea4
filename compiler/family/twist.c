/*
 * twist.c: rotated about an axis, by an angle that grows along it.  C is a cylinder about y.
 */
#include "compiler/family/deform.h"

#include <math.h>

#include "compiler/graph/build.h"

/* ---- how it is made ---- */

/* Bounds a twisted box.  Each slice is rotated by angles of its own, in any case within a
   cylinder. */
static Box twist_box(Box box, Range rate)
{
    double radius = box_radius(box);
    Range  across = {-radius, radius};
    Box    whole = {{across, box.axis[1], across}}, hull = box_empty;
    for (int i = 0; i < DEFORM_CELLS; i++) {
        Range angle = range_mul(rate, range_cell(box.axis[1], i));
        Range c = range_cos(angle), s = range_sin(angle), one = range_of(1), zero = range_of(0);
        Range rows[3][3] = {{c, zero, s}, {zero, one, zero}, {range_neg(s), zero, c}};
        hull             = box_hull(hull, box_rotate(box, rows));
    }
    return box_common(whole, hull);
}

static const Shape *twist_upright(ShapeBuilder *builder, const Shape *shape,
                                  const DeformArguments *asked)
{
    const Shape *child   = in_region(builder, shape, INFINITY);
    Shape       *twisted = deformed_shape(builder, SHAPE_TWIST, "twist", child, asked);
    twisted->values[0]   = asked->numbers[0];
    Range rate           = node_range(builder, asked->numbers[0], 0);
    twisted->box         = twist_box(shape->box, rate);
    twisted->divided     = shear_slope(range_largest(rate) * box_radius(child->box));
    note_slope(twisted, twisted->divided);
    return twisted;
}

const Shape *make_twist(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked)
{
    if (!check_deformable(builder, shape, asked))
        return NULL;
    if (asked->numbers[0] == graph_number(builder->graph, 0))
        return shape;
    return deform_rotated(builder, shape, raise_axis(builder, asked->axis), twist_upright, asked);
}

/* ---- how it is lowered ---- */

/* Undoes the twist by a rotation about y by minus the angle: by the map (x, y, z) -> (c x - s z, y,
   s x + c z), and, for normals, of its derivative, which has rate * (-z, 0, x) along y besides. */
static void undo_twist(Lowering *l, Node point, Node rate, InverseDeformation *inverse)
{
    Graph *g     = l->graph;
    Node   angle = mul(g, graph_component(g, point, 1), rate);
    Node   c = graph_op1(g, OP_cos, angle), s = graph_op1(g, OP_sin, angle);
    Node   zero = graph_number(g, 0), one = graph_number(g, 1), minus = neg(g, s);
    Node   rows[3]  = {row(g, c, zero, minus), graph_vec3(g, 0, 1, 0), row(g, s, zero, c)};
    inverse->point  = graph_op4(g, OP_rotate, point, rows[0], rows[1], rows[2]);
    inverse->shrink = NODE_NONE;
    if (!l->surfaces)
        return;
    Node against    = neg(g, rate);
    Node x          = mul(g, graph_component(g, inverse->point, 2), against);
    Node z          = mul(g, graph_component(g, inverse->point, 0), rate);
    Node back       = row(g, x, zero, z), inverted[3];
    inverse->out[0] = row(g, c, zero, s);
    inverse->out[1] = row(g, x, one, z);
    inverse->out[2] = row(g, minus, zero, c);
    transpose_rows(g, rows, inverted);
    Node level     = graph_op4(g, OP_rotate, back, inverted[0], inverted[1], inverted[2]);
    inverse->in[0] = rows[0];
    inverse->in[1] = sub(g, rows[1], level);
    inverse->in[2] = rows[2];
}

Lowered lower_twist(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph *g    = l->graph;
    Box    box  = shape->children[0]->box;
    Node   zero = graph_number(g, 0), rate = shape->values[0];
    Node   radius = graph_number(g, axis_radius(box));
    Node   low = graph_number(g, box.axis[1].low), high = graph_number(g, box.axis[1].high);
    Node   y = graph_component(g, context.point, 1), r = radius_of(g, context.point);
    Node   level               = graph_op3(g, OP_clamp, y, low, high);
    Node   inside              = over(g, radius, most(g, r, radius));
    Node   excess              = most(g, sub(g, r, radius), zero);
    Node   above               = sub(g, y, level);
    InverseDeformation inverse = {.offset = length_of(g, excess, above)};
    undo_twist(l, across_scaled(g, context.point, level, inside), rate, &inverse);
    Lowered result = lower_undone(l, shape, context, &inverse);
    if (result.distance == NODE_NONE)
        return result;
    Node shear      = mul(g, graph_op1(g, OP_abs, rate), radius);
    result.distance = over(g, result.distance, shear_norm(g, shear));
    return with_region(l, result, inverse.offset, NODE_NONE);
}
