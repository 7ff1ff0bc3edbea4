/*
 * bend.c: bent along a circle.  C is a box for each segment.
 */
#include "compiler/family/deform.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/build.h"
#include "compiler/lower/join.h"
#include "compiler/lower/map_chain.h"

/* Below this, sin(a) / a and atan(a) / a are 1 but for their rounding. */
static const double SMALL_ANGLE = 1e-6;

/* ---- how it is made ---- */

/* Returns the range of sin(a) / a, whose slope is below 1/2 everywhere. */
static Range range_sinc(Range a)
{
    double middle = 0.5 * (a.low + a.high), half = 0.5 * (a.high - a.low);
    if (!isfinite(half))
        return (Range){-0.2173, 1};
    double value = middle == 0 ? 1 : real_sin(middle) / middle, rise = 0.5 * half + 1e-15;
    return (Range){fmax(value - rise, -0.2173), fmin(value + rise, 1)};
}

/* Bounds y and z of the bent box: the union of its cells, for all cells of the range of the rate. */
static Box bend_box(Box box, Range rate)
{
    Range z = box.axis[2], half = range_of(0.5);
    Box   bent  = box_empty;
    int   rates = range_is_single(rate) ? 1 : DEFORM_CELLS;
    for (int i = 0; i < rates * DEFORM_CELLS; i++) {
        Range k = rates == 1 ? rate : range_cell(rate, i / DEFORM_CELLS);
        Range y = range_cell(box.axis[1], i % DEFORM_CELLS), angle = range_mul(k, y);
        Range lean = range_mul(half, angle), sinc = range_sinc(lean);
        Range along   = range_mul(y, range_sinc(angle)); /* of the line z = 0 */
        Range lateral = range_mul(range_mul(y, lean), range_square(sinc));
        Box   cell    = {{box.axis[0], range_sub(along, range_mul(z, range_sin(angle))),
                          range_add(lateral, range_mul(z, range_cos(angle)))}};
        bent          = box_hull(bent, cell);
    }
    return bent;
}

/* Segments of a quarter turn each, for the largest rate. */
static uint32_t bend_segments(Box box, Range rate)
{
    double turn = range_largest(rate) * (box.axis[1].high - box.axis[1].low);
    double most = ceil(turn / (0.5 * M_PI) - 1e-9);
    return most > 1 ? (uint32_t)fmin(most, MAX_BEND_SEGMENTS + 1) : 1;
}

/* A bend with the rate k has its axis at z = 1 / k, where all lengths vanish; this much must be
   left of them. */
static const double MIN_LENGTH = 0.01;

static bool check_bend(ShapeBuilder *builder, const DeformArguments *asked, Box box, Range rate)
{
    Range z = box.axis[2], shrink = range_mul(rate, z);
    bool  reaches = !(shrink.high <= 1 - MIN_LENGTH);
    if (!reaches && bend_segments(box, rate) <= MAX_BEND_SEGMENTS)
        return true;
    double most = 0.5 * M_PI * MAX_BEND_SEGMENTS / (box.axis[1].high - box.axis[1].low);
    double high = z.high > 0 ? (1 - MIN_LENGTH) / z.high : INFINITY;
    double low  = z.low < 0 ? (1 - MIN_LENGTH) / z.low : -INFINITY;
    Diag  *diag = diag_add(builder->diags, DIAG_BAD_VALUE, asked->number_spans[0],
                          reaches ? "so bent, the shape would reach the axis of the bend"
                                   : "so bent, the shape would turn around more than %d times",
                           MAX_BEND_SEGMENTS / 4);
    diag->label = range_is_single(rate) ? diag_text(builder->diags, "this is %g", rate.low)
                  : isinf(rate.low) && isinf(rate.high)
                      ? "this can be any number"
                      : diag_text(builder->diags, "this can be from %g to %g", rate.low, rate.high);
    diag->help  = diag_text(builder->diags, "from %.4g to %.4g is possible here", fmax(low, -most),
                            fmin(high, most));
    return false;
}

/* Finds the least length of what is bent, for a length of 1 that it had. */
static double min_length(Box box, Range rate)
{
    return fmin(1 - range_mul(rate, box.axis[2]).high, 1);
}

/* The region stays well away from the axis of the bend. */
static const Shape *in_bend_region(ShapeBuilder *builder, const Shape *shape, Range rate)
{
    double       most  = 0.5 * min_length(shape->box, rate) / fmax(range_largest(rate), 1e-9);
    const Shape *child = in_region(builder, shape, most);
    return bend_segments(child->box, rate) <= MAX_BEND_SEGMENTS ? child : shape;
}

static const Shape *bend_upright(ShapeBuilder *builder, const Shape *shape,
                                 const DeformArguments *asked)
{
    Range rate = node_range(builder, asked->numbers[0], 0);
    if (!check_bend(builder, asked, shape->box, rate))
        return NULL;
    const Shape *child = in_bend_region(builder, shape, rate);
    Shape       *bent  = deformed_shape(builder, SHAPE_BEND, "bend", child, asked);
    bent->values[0]    = asked->numbers[0];
    bent->cells[0]     = bend_segments(child->box, rate);
    bent->box          = bend_box(shape->box, rate);
    /* Segments overlap by the depth of the solid, so that they have no walls between them. */
    double depth  = 0.5 * (shape->box.axis[2].high - shape->box.axis[2].low);
    bent->overlap = fmin(depth, 0.6 / fmax(range_largest(rate), 1e-9));
    double least  = min_length(child->box, rate);
    bent->divided = (1 + COST_OF_WEIGHT) / least;
    return bent;
}

/* Returns the rotation that brings the axis to x, and to y what stands upright: y, or x where that
   is the axis. */
static const Map *bend_rotation(ShapeBuilder *builder, Node axis)
{
    Graph *g = builder->graph;
    Node   x = graph_vec3(g, 1, 0, 0), y = graph_vec3(g, 0, 1, 0);
    if (axis == x)
        return NULL;
    Map *rotation     = map_new(builder);
    Node unit         = graph_op1(g, OP_normalize, axis);
    Node height       = graph_component(g, unit, 1);
    Node steep        = graph_op1(g, OP_abs, height);
    Node upright      = graph_op2(g, OP_less, graph_number(g, 0.999), steep);
    Node stands       = graph_op3(g, OP_select, upright, x, y);
    Node along        = graph_op2(g, OP_dot, stands, unit);
    Node parallel     = graph_op2(g, OP_scale, unit, along);
    Node across       = graph_op2(g, OP_sub, stands, parallel);
    rotation->rows[0] = unit;
    rotation->rows[1] = graph_op1(g, OP_normalize, across);
    rotation->rows[2] = graph_op2(g, OP_cross, unit, rotation->rows[1]);
    return rotation;
}

const Shape *make_bend(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked)
{
    if (!check_deformable(builder, shape, asked))
        return NULL;
    if (asked->numbers[0] == graph_number(builder->graph, 0))
        return shape;
    return deform_rotated(builder, shape, bend_rotation(builder, asked->axis), bend_upright, asked);
}

/* ---- how it is lowered ---- */

/* Returns f(a) / a for an odd f with f(a) / a = 1 at 0. */
static Node over_angle(Graph *g, Op f, Node a)
{
    Node small = graph_number(g, SMALL_ANGLE), size = graph_op1(g, OP_abs, a);
    size     = most(g, size, small);
    Node top = graph_op1(g, f, size);
    return over(g, top, size);
}

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

/* Finds the box around the bent segment; rate * z stays below 1 in the child's box. */
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

/* Finds where on y a point was: atan(u / w) / rate, and y / w for the rate 0. */
static Node unbent_height(Graph *g, Node rate, Node y, Node u, Node w)
{
    Node tangent = over(g, u, w);
    if (graph_is_constant(g, rate)) /* it is not 0: make_bend */
        return over(g, graph_op1(g, OP_atan, tangent), rate);
    Node angle = over_angle(g, OP_atan, tangent);
    return mul(g, over(g, y, w), angle);
}

/* Undoes a bend; `lengths` are how much longer things along y are there than they were. */
static void undo_bend(Lowering *l, const BendSegment *segment, Node point,
                      InverseDeformation *inverse, Node *lengths)
{
    Graph *g   = l->graph;
    Node   one = graph_number(g, 1), zero = graph_number(g, 0);
    Node   x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Node   z = graph_component(g, point, 2);
    Node   u = mul(g, segment->rate, y), w = sub(g, one, mul(g, segment->rate, z));
    Node   y_old    = unbent_height(g, segment->rate, y, u, w);
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

/* Lowers a segment, at a point of its own space. */
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
    return with_region(l, result, inverse.offset, NODE_NONE);
}

Lowered lower_bend(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered result = lowered_nothing;
    for (uint32_t i = 0; i < shape->cells[0]; i++) {
        BendSegment segment = bend_segment(l->graph, shape, i);
        NormalPath  path    = normal_path(l, context, 1);
        Node        point   = before_map(l->graph, &segment.map, context.point);
        normal_rotate(l, &path, segment.map.rows, segment.map.scale);
        LowerContext inner  = context_behind(&path, context, point);
        Lowered      bent   = lower_segment(l, shape, inner, &segment);
        bent.surface.normal = bent.surface.normal == inner.normal
                                  ? context.normal
                                  : normal_out(l, &path, bent.surface.normal);
        result              = join_two(l, blend_sharp, result, bent);
    }
    return result;
}
