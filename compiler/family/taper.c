/*
 * taper.c: scaled across an axis, by a factor that changes along it.  C is a frustum about y.
 */
#include "compiler/family/deform.h"

#include <math.h>

#include "compiler/graph/build.h"

/* ---- how it is made ---- */

/* The part of the smallest factor that is left at the ends of the region, which is longer than the shape. */
static const double LEFT_AT_ENDS = 0.5;

/* Returns the factor so far beyond the end that has one, in heights. */
static Node factor_beyond(Graph *g, Node here, Node there, double beyond)
{
    Node change = sub(g, here, there);
    return add(g, here, mul(g, change, graph_number(g, beyond)));
}

static const Shape *taper_upright(ShapeBuilder *builder, const Shape *shape,
                                  const DeformArguments *asked)
{
    Graph       *g       = builder->graph;
    Range        side    = shape->box.axis[1];
    Range        scale   = range_hull(node_range(builder, asked->numbers[0], 0),
                                      node_range(builder, asked->numbers[1], 0));
    double       height  = fmax(side.high - side.low, 1e-9);
    double       rise    = (scale.high - scale.low) / height;
    const Shape *child   = in_region(builder, shape, LEFT_AT_ENDS * fmax(scale.low, 0) / rise);
    double       room    = child->box.axis[1].high - side.high;
    Shape       *tapered = deformed_shape(builder, SHAPE_TAPER, "taper", child, asked);
    for (int i = 0; i < 2; i++)
        tapered->values[i] = factor_beyond(g, asked->numbers[i], asked->numbers[1 - i],
                                           room / height);
    tapered->box = shape->box;
    for (int i = 0; i < 3; i += 2)
        tapered->box.axis[i] = range_mul(shape->box.axis[i], scale);
    double shear     = shear_slope(rise * box_radius(child->box));
    double least     = scale.low - rise * room;
    tapered->divided = (shear + COST_OF_WEIGHT) / fmin(fmax(least, 0), 1);
    note_slope(tapered, shear);
    return tapered;
}

const Shape *make_taper(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked)
{
    for (int i = 0; i < 2; i++)
        if (!require_positive(builder, asked->numbers[i], asked->number_spans[i],
                              "a factor of a taper"))
            return NULL;
    if (!check_deformable(builder, shape, asked))
        return NULL;
    return deform_rotated(builder, shape, raise_axis(builder, asked->axis), taper_upright, asked);
}

/* ---- how it is lowered ---- */

/* The radius of the frustum at its ends, and where they are. */
typedef struct Frustum {
    Node   low, high, bottom, top; /* radii, y */
    double height;
} Frustum;

/* Returns (radius, y) of the nearest point of the frustum to one at (r, y): of the slanted side, or
   of the disc at its height or the nearest end, where it is itself if it is inside. */
static Node frustum_nearest(Graph *g, const Frustum *f, Node r, Node y, Node *is_inside)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1);
    Node position = graph_op2(g, OP_vec2, r, y), foot = graph_op2(g, OP_vec2, f->low, f->bottom);
    Node tip = graph_op2(g, OP_vec2, f->high, f->top), side = sub(g, tip, foot);
    Node along    = graph_op2(g, OP_dot, sub(g, position, foot), side);
    Node fraction = over(g, along, graph_op2(g, OP_dot, side, side));
    fraction      = graph_op3(g, OP_clamp, fraction, zero, one);
    Node slant    = add(g, foot, graph_op2(g, OP_scale, side, fraction));
    Node height   = graph_op3(g, OP_clamp, y, f->bottom, f->top);
    Node whole    = graph_number(g, f->height);
    Node level    = over(g, sub(g, height, f->bottom), whole);
    Node reach    = graph_op3(g, OP_mix, f->low, f->high, level);
    Node disc     = graph_op2(g, OP_vec2, least(g, r, reach), height);
    Node to_slant = graph_op1(g, OP_length, sub(g, position, slant));
    Node to_disc  = graph_op1(g, OP_length, sub(g, position, disc));
    Node nearer   = graph_op2(g, OP_less, to_disc, to_slant);
    Node below    = graph_op2(g, OP_less_equal, y, f->top);
    Node within   = graph_op2(g, OP_and, graph_op2(g, OP_less_equal, f->bottom, y), below);
    *is_inside    = graph_op2(g, OP_and, within, graph_op2(g, OP_less_equal, r, reach));
    return graph_op3(g, OP_select, nearer, disc, slant);
}

/* Undoes (x, y, z) -> (x / s, y, z / s) with s = scale(y), whose slope is `rise`. */
static void undo_taper(Lowering *l, Node point, Node scale, Node rise, InverseDeformation *inverse)
{
    Graph *g    = l->graph;
    Node   zero = graph_number(g, 0), one = graph_number(g, 1), less = over(g, one, scale);
    inverse->point  = across_scaled(g, point, graph_component(g, point, 1), less);
    inverse->shrink = less;
    if (!l->surfaces)
        return;
    Node x          = mul(g, graph_component(g, inverse->point, 0), rise);
    Node z          = mul(g, graph_component(g, inverse->point, 2), rise);
    Node back       = neg(g, less);
    inverse->in[0]  = row(g, scale, zero, zero);
    inverse->in[1]  = row(g, x, one, z);
    inverse->in[2]  = row(g, zero, zero, scale);
    inverse->out[0] = row(g, less, zero, zero);
    inverse->out[1] = graph_op2(g, OP_scale, row(g, x, zero, z), back);
    inverse->out[1] = add(g, inverse->out[1], graph_vec3(g, 0, 1, 0));
    inverse->out[2] = row(g, zero, zero, less);
}

Lowered lower_taper(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph  *g      = l->graph;
    Box     box    = shape->children[0]->box;
    double  radius = axis_radius(box);
    Range   side   = box.axis[1];
    Node    wide = graph_number(g, radius), tiny = graph_number(g, 1e-20);
    Node    one = graph_number(g, 1), cost;
    Frustum f   = {.bottom = graph_number(g, side.low), .top = graph_number(g, side.high)};
    f.low       = mul(g, wide, shape->values[0]);
    f.high      = mul(g, wide, shape->values[1]);
    f.height    = fmax(side.high - side.low, 1e-9);
    Node y = graph_component(g, context.point, 1), r = radius_of(g, context.point);
    Node is_inside, offset                           = graph_op2(g, OP_vec2, r, y);
    Node nearest = frustum_nearest(g, &f, r, y, &is_inside);
    Node inner_r = graph_component(g, nearest, 0), inner_y = graph_component(g, nearest, 1);
    Node inside                = over(g, inner_r, most(g, r, tiny));
    inside                     = graph_op3(g, OP_select, is_inside, one, inside);
    Node               height  = graph_number(g, f.height);
    Node               level   = over(g, sub(g, inner_y, f.bottom), height);
    Node               scale   = graph_op3(g, OP_mix, shape->values[0], shape->values[1], level);
    Node               rise    = over(g, sub(g, shape->values[1], shape->values[0]), height);
    InverseDeformation inverse = {.offset = graph_op1(g, OP_length, sub(g, offset, nearest))};
    undo_taper(l, across_scaled(g, context.point, inner_y, inside), scale, rise, &inverse);
    Lowered result = lower_undone(l, shape, context, &inverse);
    if (result.distance == NODE_NONE)
        return result;
    Node steep = graph_op1(g, OP_abs, rise), shear = mul(g, steep, wide);
    Node cut    = cut_distance(g, result.distance, radius, steep, &cost);
    Node weight = least(g, scale, one), slope = add(g, shear_norm(g, shear), cost);
    result.distance = over(g, mul(g, cut, weight), slope);
    return with_region(l, result, inverse.offset, is_inside);
}
