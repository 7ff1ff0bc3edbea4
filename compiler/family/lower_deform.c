/*
 * lower_deform.c: deformed shapes.
 *
 * A deformation F is undone by its inverse T, which is steep where F makes things small, and far
 * from the axis it is arbitrarily steep.  So it is used in a convex region C only that surely
 * holds the deformed solid.  For a point q let c be the nearest point of C, and let g be an
 * expression whose slope over C is 1, negative in the solid: then the distance is at least
 *
 *     hypot(|q - c|, max(g(c), 0)) + min(g(c), 0)
 *
 * for |q - s|^2 >= |q - c|^2 + |c - s|^2 for every s in C; and its slope is 1, as g(c) does not
 * change in the direction of q - c.  With the child's distance d, cut to at most `most` in size
 * where that makes it smaller, g is m(c) d(T(c)) / L: the weight m evens out where T is steep and
 * where it is not, and L >= m |T'| + |m'| most.  What depends on parameters in this is a frame-time
 * node, so it follows them from frame to frame, and no range of them is needed for the slope.
 */
#include "compiler/lower/lowering.h"

#include <math.h>

#include "compiler/graph/build.h"

/* Slopes of weights may cost so much: a quarter of the step. */
static const double COST_OF_WEIGHT = 0.25;

/* Farther than any scene. */
static const double ENDLESS = 1e30;

/* Below this, sin(a) / a and atan(a) / a are 1 but for their rounding. */
static const double SMALL_ANGLE = 1e-6;

static Node least(Graph *g, Node a, Node b) { return graph_op2(g, OP_min, a, b); }
static Node most(Graph *g, Node a, Node b) { return graph_op2(g, OP_max, a, b); }

static Node length_of(Graph *g, Node a, Node b)
{
    return graph_op1(g, OP_length, graph_op2(g, OP_vec2, a, b));
}

/* (b + sqrt(b^2 + 4)) / 2, the norm of a shear by b. */
static Node shear_norm(Graph *g, Node b)
{
    Node four = graph_number(g, 4), half = graph_number(g, 0.5);
    Node root = add(g, graph_op1(g, OP_square, b), four);
    Node sum  = add(g, graph_op1(g, OP_sqrt, root), b);
    return mul(g, sum, half);
}

/* f(a) / a for an odd f with f(a) / a = 1 at 0. */
static Node over_angle(Graph *g, Op f, Node a)
{
    Node small = graph_number(g, SMALL_ANGLE), size = graph_op1(g, OP_abs, a);
    size     = most(g, size, small);
    Node top = graph_op1(g, f, size);
    return over(g, top, size);
}

/* ---- what deformations share ---- */

/* The deformation undone at the point of C that is nearest to a point: how far that is, and the
   point before the deformation. */
typedef struct InverseDeformation {
    Node offset, point;
    Node in[3], out[3]; /* rows of matrices that take normals to the child's space, and back */
    Node shrink;        /* how much larger things are in the child's space; NODE_NONE: not */
} InverseDeformation;

static Node times_rows(Graph *g, const Node rows[3], Node vector)
{
    Node products[3];
    for (int i = 0; i < 3; i++)
        products[i] = graph_op2(g, OP_dot, rows[i], vector);
    return graph_op(g, OP_vec3, products);
}

static Node row(Graph *g, Node x, Node y, Node z) { return graph_op3(g, OP_vec3, x, y, z); }

/* The child where the deformation is undone, by a distance with the slope 1. */
static Lowered lower_undone(Lowering *l, const Shape *shape, LowerContext context,
                            const InverseDeformation *inverse)
{
    Graph       *g     = l->graph;
    const Shape *child = shape->children[0];
    LowerContext inner = context_lipschitz(context_at(context, inverse->point));
    if (l->surfaces) {
        inner.normal = graph_op1(g, OP_normalize, times_rows(g, inverse->in, context.normal));
        if (inverse->shrink != NODE_NONE)
            inner.footprint = mul(g, inner.footprint, inverse->shrink);
        if (inverse->shrink != NODE_NONE && inner.smoothing != NODE_NONE)
            inner.smoothing = mul(g, inner.smoothing, inverse->shrink);
    }
    Lowered result = lower_shape(l, child, inner);
    if (result.distance == NODE_NONE)
        return result;
    result.distance = divide_by_slope(g, result.distance, child->slope);
    if (!l->surfaces || result.surface.normal == inner.normal)
        result.surface.normal = context.normal;
    else {
        Node back             = times_rows(g, inverse->out, result.surface.normal);
        result.surface.normal = graph_op1(g, OP_normalize, back);
    }
    return result;
}

/* With g as the distance in C: the distance outside of C as well. */
static Lowered with_region(Lowering *l, Lowered result, Node offset)
{
    Graph *g        = l->graph;
    Node   zero     = graph_number(g, 0);
    Node   outside  = length_of(g, offset, most(g, result.distance, zero));
    Node   inside   = least(g, result.distance, zero);
    result.distance = add(g, outside, inside);
    return result;
}

/* As much of a distance as a weight needs whose slope is `steep`: a fraction of the width of the solid
   where that is less.  *cost is what the weight adds to the slope. */
static Node cut_distance(Graph *g, Node distance, double width, Node steep, Node *cost)
{
    Node fraction = graph_number(g, COST_OF_WEIGHT);
    Node whole    = graph_number(g, COST_OF_WEIGHT / fmax(width, 1e-9));
    Node limit    = over(g, fraction, most(g, steep, whole));
    Node low      = neg(g, limit);
    *cost         = mul(g, steep, limit);
    return graph_op3(g, OP_clamp, distance, low, limit);
}

/* How far the solid reaches from the y axis. */
static double axis_radius(Box box)
{
    double x = range_largest(box.axis[0]), z = range_largest(box.axis[2]);
    return fmax(hypot(x, z), 1e-9);
}

/* x and z scaled, y another. */
static Node across_scaled(Graph *g, Node point, Node y, Node factor)
{
    Node x = mul(g, graph_component(g, point, 0), factor);
    Node z = mul(g, graph_component(g, point, 2), factor);
    return row(g, x, y, z);
}

static Node radius_of(Graph *g, Node point)
{
    Node x = graph_component(g, point, 0), z = graph_component(g, point, 2);
    return length_of(g, x, z);
}

/* ---- twist: C is a cylinder about y ---- */

/* Turned about y by minus the angle: of the map (x, y, z) -> (c x - s z, y, s x + c z), and, for
   normals, of its derivative, which has rate * (-z, 0, x) along y besides. */
static void undo_twist(Lowering *l, Node point, Node rate, InverseDeformation *inverse)
{
    Graph *g     = l->graph;
    Node   angle = mul(g, graph_component(g, point, 1), rate);
    Node   c = graph_op1(g, OP_cos, angle), s = graph_op1(g, OP_sin, angle);
    Node   zero = graph_number(g, 0), one = graph_number(g, 1), minus = neg(g, s);
    Node   rows[3]  = {row(g, c, zero, minus), graph_vec3(g, 0, 1, 0), row(g, s, zero, c)};
    inverse->point  = graph_op4(g, OP_turn, point, rows[0], rows[1], rows[2]);
    inverse->shrink = NODE_NONE;
    if (!l->surfaces)
        return;
    Node against    = neg(g, rate);
    Node x          = mul(g, graph_component(g, inverse->point, 2), against);
    Node z          = mul(g, graph_component(g, inverse->point, 0), rate);
    Node back       = row(g, x, zero, z), turned[3];
    inverse->out[0] = row(g, c, zero, s);
    inverse->out[1] = row(g, x, one, z);
    inverse->out[2] = row(g, minus, zero, c);
    transpose_rows(g, rows, turned);
    Node level     = graph_op4(g, OP_turn, back, turned[0], turned[1], turned[2]);
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
    return with_region(l, result, inverse.offset);
}

/* ---- bend: C is a box for each segment ---- */

/*
 * Material at (x, y, z) goes along the circle through the origin with curvature k: to the angle
 * k y, at the distance 1 / k - z from the axis of the bend.  All formulas are such that they hold
 * for k = 0 too.  A segment reaches from -half to half along y, less than a right angle to either
 * side: more would have the axis in its convex hull, and turns that T cannot tell apart.
 */
typedef struct BendSegment {
    Node rate, middle, half; /* where on y, and how far to both sides */
    Map  map;                /* from the segment about its middle to the whole bend */
} BendSegment;

static BendSegment bend_segment(Graph *g, const Shape *shape, uint32_t i)
{
    Range  side = shape->children[0]->box.axis[1];
    double step = (side.high - side.low) / shape->cells[0], middle = side.low + (i + 0.5) * step;
    double excess       = shape->cells[0] > 1 ? shape->overlap : 0;
    BendSegment segment = {.rate = shape->values[0], .middle = graph_number(g, middle)};
    segment.half        = graph_number(g, 0.5 * step + excess);
    Node zero = graph_number(g, 0), half = graph_number(g, 0.5);
    Node angle = mul(g, segment.rate, segment.middle), lean = mul(g, angle, half);
    Node c = graph_op1(g, OP_cos, angle), s = graph_op1(g, OP_sin, angle);
    Node chord          = mul(g, segment.middle, over_angle(g, OP_sin, lean)); /* from the origin */
    Node along          = mul(g, chord, graph_op1(g, OP_cos, lean));
    Node lateral        = mul(g, chord, graph_op1(g, OP_sin, lean));
    segment.map.scale   = graph_number(g, 1);
    segment.map.rows[0] = graph_vec3(g, 1, 0, 0);
    segment.map.rows[1] = row(g, zero, c, neg(g, s));
    segment.map.rows[2] = row(g, zero, s, c);
    segment.map.shift   = row(g, zero, along, lateral);
    segment.map.pole    = NODE_NONE;
    return segment;
}

/* The box around the bent segment; rate * z stays below 1 in the child's box. */
static void segment_region(Graph *g, const BendSegment *segment, Box box, Node *low, Node *high)
{
    Node one = graph_number(g, 1), half = graph_number(g, 0.5);
    Node z0 = graph_number(g, box.axis[2].low), z1 = graph_number(g, box.axis[2].high);
    Node angle = mul(g, segment->rate, segment->half), lean = mul(g, angle, half);
    Node c       = graph_op1(g, OP_cos, angle);
    Node chord   = mul(g, segment->half, over_angle(g, OP_sin, lean));
    Node lateral = mul(g, chord, graph_op1(g, OP_sin, lean));
    Node long0   = sub(g, one, mul(g, segment->rate, z0));
    Node long1   = sub(g, one, mul(g, segment->rate, z1));
    Node across  = mul(g, segment->half, over_angle(g, OP_sin, angle));
    Node y       = mul(g, across, most(g, long0, long1));
    Node end0    = add(g, mul(g, z0, c), lateral);
    Node end1    = add(g, mul(g, z1, c), lateral);
    Node bottom = least(g, z0, end0), top = most(g, z1, end1), back = neg(g, y);
    *low  = row(g, graph_number(g, box.axis[0].low), back, bottom);
    *high = row(g, graph_number(g, box.axis[0].high), y, top);
}

/* *lengths: how much longer things along y are there than they were. */
static void undo_bend(Lowering *l, const BendSegment *segment, Node point,
                      InverseDeformation *inverse, Node *lengths)
{
    Graph *g   = l->graph;
    Node   one = graph_number(g, 1), zero = graph_number(g, 0);
    Node   x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Node   z = graph_component(g, point, 2);
    Node   u = mul(g, segment->rate, y), w = sub(g, one, mul(g, segment->rate, z));
    Node   along  = over_angle(g, OP_atan, over(g, u, w));
    Node   y_less = over(g, y, w), y_old = mul(g, y_less, along);
    Node   y_part   = mul(g, u, y); /* z (2 - rate z) - rate y^2 over 1 + lengths */
    Node   z_part   = mul(g, z, add(g, w, one));
    *lengths        = length_of(g, u, w);
    Node both       = add(g, *lengths, one);
    Node z_old      = over(g, sub(g, z_part, y_part), both);
    inverse->point  = row(g, x, y_old, z_old);
    inverse->shrink = NODE_NONE;
    if (!l->surfaces)
        return;
    Node s = over(g, u, *lengths), c = over(g, w, *lengths), minus = neg(g, s);
    Node s_less = over(g, s, *lengths), c_less = over(g, c, *lengths);
    inverse->in[0] = inverse->out[0] = graph_vec3(g, 1, 0, 0);
    inverse->in[1]                   = row(g, zero, w, u);
    inverse->in[2]                   = row(g, zero, minus, c);
    inverse->out[1]                  = row(g, zero, c_less, minus);
    inverse->out[2]                  = row(g, zero, s_less, c);
}

/* A segment, at a point of its own space. */
static Lowered lower_segment(Lowering *l, const Shape *shape, LowerContext context,
                             const BendSegment *segment)
{
    Graph             *g   = l->graph;
    Box                box = shape->children[0]->box;
    Node               one = graph_number(g, 1), low, high, lengths, cost;
    InverseDeformation inverse;
    segment_region(g, segment, box, &low, &high);
    Node nearest   = graph_op3(g, OP_clamp, context.point, low, high);
    inverse.offset = graph_op1(g, OP_length, sub(g, context.point, nearest));
    undo_bend(l, segment, nearest, &inverse, &lengths);
    Node height  = graph_component(g, inverse.point, 1);
    Node whole_y = add(g, height, segment->middle);
    Node x = graph_component(g, inverse.point, 0), z = graph_component(g, inverse.point, 2);
    inverse.point  = row(g, x, whole_y, z);
    Lowered result = lower_undone(l, shape, context, &inverse);
    if (result.distance == NODE_NONE)
        return result;
    if (shape->cells[0] > 1) {
        Node ends       = sub(g, graph_op1(g, OP_abs, height), segment->half);
        result.distance = most(g, result.distance, ends);
    }
    double x_size = box.axis[0].high - box.axis[0].low, z_size = box.axis[2].high - box.axis[2].low;
    double width  = 0.5 * fmax(x_size, z_size);
    Node   steep  = graph_op1(g, OP_abs, segment->rate);
    Node   cut    = cut_distance(g, result.distance, width, steep, &cost);
    Node   weight = least(g, lengths, one), slope = add(g, cost, one);
    result.distance = over(g, mul(g, cut, weight), slope);
    return with_region(l, result, inverse.offset);
}

Lowered lower_bend(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered result = lowered_nothing;
    for (uint32_t i = 0; i < shape->cells[0]; i++) {
        BendSegment segment = bend_segment(l->graph, shape, i);
        NormalPath  path    = normal_path(l, context, 1);
        Node        point   = before_map(l->graph, &segment.map, context.point);
        normal_turn(l, &path, segment.map.rows, segment.map.scale);
        LowerContext inner  = context_behind(&path, context, point);
        Lowered      bent   = lower_segment(l, shape, inner, &segment);
        bent.surface.normal = bent.surface.normal == inner.normal
                                  ? context.normal
                                  : normal_out(l, &path, bent.surface.normal);
        result              = join_two(l, blend_sharp, result, bent);
    }
    return result;
}

/* ---- taper: C is a frustum about y ---- */

/* The radius of the frustum at its ends, and where they are. */
typedef struct Frustum {
    Node   low, high, bottom, top; /* radii, y */
    double height;
} Frustum;

/* (radius, y) of the nearest point of the frustum to one at (r, y): itself, or the nearer of the
   nearest of the slanted side and the nearest of the end that is on its side. */
static Node frustum_nearest(Graph *g, const Frustum *f, Node r, Node y)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1), middle = graph_number(g, 0.5);
    Node position = graph_op2(g, OP_vec2, r, y), foot = graph_op2(g, OP_vec2, f->low, f->bottom);
    Node tip = graph_op2(g, OP_vec2, f->high, f->top), side = sub(g, tip, foot);
    Node along    = graph_op2(g, OP_dot, sub(g, position, foot), side);
    Node fraction = over(g, along, graph_op2(g, OP_dot, side, side));
    fraction      = graph_op3(g, OP_clamp, fraction, zero, one);
    Node slant    = add(g, foot, graph_op2(g, OP_scale, side, fraction));
    Node level    = sub(g, y, f->bottom);
    level         = over(g, level, graph_number(g, f->height));
    Node upper    = graph_op2(g, OP_less, middle, level);
    Node ring     = graph_op3(g, OP_select, upper, f->high, f->low);
    Node edge     = graph_op3(g, OP_select, upper, f->top, f->bottom);
    Node end      = graph_op2(g, OP_vec2, least(g, r, ring), edge);
    Node to_slant = graph_op1(g, OP_length, sub(g, position, slant));
    Node to_end   = graph_op1(g, OP_length, sub(g, position, end));
    Node nearer   = graph_op2(g, OP_less, to_end, to_slant);
    Node outside  = graph_op3(g, OP_select, nearer, end, slant);
    Node above    = graph_op2(g, OP_less_equal, zero, level);
    Node below    = graph_op2(g, OP_less_equal, level, one);
    Node inside   = graph_op2(g, OP_and, above, below);
    Node reach    = graph_op3(g, OP_mix, f->low, f->high, level);
    inside        = graph_op2(g, OP_and, inside, graph_op2(g, OP_less_equal, r, reach));
    return graph_op3(g, OP_select, inside, position, outside);
}

/* (x, y, z) -> (x / s, y, z / s) with s = scale(y), whose slope is `rise`. */
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
    Node nearest = frustum_nearest(g, &f, r, y), offset = graph_op2(g, OP_vec2, r, y);
    Node inner_r = graph_component(g, nearest, 0), inner_y = graph_component(g, nearest, 1);
    Node inside                = over(g, inner_r, most(g, r, tiny));
    Node height                = graph_number(g, f.height);
    Node level                 = over(g, sub(g, inner_y, f.bottom), height);
    Node scale                 = graph_op3(g, OP_mix, shape->values[0], shape->values[1], level);
    Node rise                  = over(g, sub(g, shape->values[1], shape->values[0]), height);
    InverseDeformation inverse = {.offset = graph_op1(g, OP_length, sub(g, offset, nearest))};
    undo_taper(l, across_scaled(g, context.point, inner_y, inside), scale, rise, &inverse);
    Lowered result = lower_undone(l, shape, context, &inverse);
    if (result.distance == NODE_NONE)
        return result;
    Node steep = graph_op1(g, OP_abs, rise), shear = mul(g, steep, wide);
    Node cut    = cut_distance(g, result.distance, radius, steep, &cost);
    Node weight = least(g, scale, one), slope = add(g, shear_norm(g, shear), cost);
    result.distance = over(g, mul(g, cut, weight), slope);
    return with_region(l, result, inverse.offset);
}

/* ---- displace: C is a box, which may be endless ---- */

/* How far above the high side and below the low one, the most of all axes; negative within. */
static Node box_excess(Graph *g, Node point, Node low, Node high, Node *outside)
{
    Node below = sub(g, low, point), above = sub(g, point, high);
    Node excess = most(g, below, above);
    Node x = graph_component(g, excess, 0), y = graph_component(g, excess, 1);
    Node z = graph_component(g, excess, 2), zero = graph_number(g, 0);
    Node flat = most(g, x, y);
    *outside  = graph_op1(g, OP_length, most(g, excess, zero));
    return most(g, flat, z);
}

/* The sides of the child's box, and of C around it: as far as the displacement can reach. */
typedef struct Sides {
    Node low, high, below, above, grown;
} Sides;

static Sides sides_of(Graph *g, const Shape *shape, Node size)
{
    const Box *box = &shape->children[0]->box;
    double     low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i]  = fmax(box->axis[i].low, -ENDLESS);
        high[i] = fmin(box->axis[i].high, ENDLESS);
    }
    Sides sides = {.low  = graph_constant(g, TYPE_VEC3, low),
                   .high = graph_constant(g, TYPE_VEC3, high)};
    sides.grown = mul(g, size, graph_number(g, shape->reach));
    sides.below = sub(g, sides.low, sides.grown);
    sides.above = add(g, sides.high, sides.grown);
    return sides;
}

/* A distance that is only a bound reaches a value farther out than the box grown by it: that is
   cut off, so that what is left lies in C. */
static Node cut_to_sides(Graph *g, Node distance, Node point, const Sides *sides)
{
    Node outside, zero = graph_number(g, 0);
    Node inside = box_excess(g, point, sides->low, sides->high, &outside);
    Node whole  = add(g, outside, least(g, inside, zero));
    Node around = sub(g, whole, sides->grown);
    return most(g, distance, around);
}

/* d - amplitude * formula, over the sum of both slopes. */
Lowered lower_displace(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph       *g     = l->graph;
    const Shape *child = shape->children[0];
    Node         size  = graph_op1(g, OP_abs, shape->values[0]);
    Sides        sides = sides_of(g, shape, size);
    bool         ends  = false;
    for (int i = 0; i < 3; i++)
        ends = ends || isfinite(child->box.axis[i].low) || isfinite(child->box.axis[i].high);
    Node point = context.point;
    if (ends)
        point = graph_op3(g, OP_clamp, context.point, sides.below, sides.above);
    Lowered result = lower_shape(l, child, context_lipschitz(context_at(context, point)));
    if (result.distance == NODE_NONE)
        return result;
    Node bump       = graph_substitute(g, shape->formula, substitute_point(point), l->scratch);
    Node steep      = mul(g, size, shape->values[1]);
    Node slope      = add(g, steep, graph_number(g, child->slope));
    Node moved      = sub(g, result.distance, mul(g, bump, shape->values[0]));
    result.distance = over(g, moved, slope);
    if (!ends)
        return result;
    if (!child->exact)
        result.distance = cut_to_sides(g, result.distance, point, &sides);
    Node offset = graph_op1(g, OP_length, sub(g, context.point, point));
    return with_region(l, result, offset);
}
