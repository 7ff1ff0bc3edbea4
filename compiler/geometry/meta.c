/*
 * meta.c: metasurfaces, from the call to the nodes.
 *
 * Each shape counts 1 where it is, and less with the distance d from it: f(d / reach), 0 from the
 * end of its reach.  The solid is where the sum F is at least the level T.
 *
 * Within a step s the share of a shape can rise by L s, L = steepest / reach, and that of one whose
 * reach begins only after a gap by L (s - gap).  So s is safe as long as
 *     sum over all of max(s - gap_i, 0) <= (T - F) / L = room.
 * With all gaps and s counted from the nearest gap on, max(s - gap, 0) <= s max(1 - gap / most, 0)
 * for s <= most = T / L, and room is never more than that.  So
 *     s = nearest + room / sum of max(1 - (gap_i - nearest) / most, 0)
 * is safe.  The sum is at least 1, at least the number of shapes that can be felt (which serves
 * inside), and changes gradually, so that normals found by differences show no seams.
 *
 * Where something above needs the slope, the sum is no more than n: nearest + room / n is
 * 1-Lipschitz, since F is 0 wherever there is a gap.
 *
 * A bound d may be much below the distance, and then what counts by it is fat.  The distance to
 * the shape's box is a bound as well, but shows: flat faces.  So such a d is lengthened, by a
 * factor k for which it is the longer of the two around the box (found by looking).  Its shape
 * counts f(k d / reach), which rises by k L s in a step s, from a gap of d - reach / k on: so it
 * counts k times in the sums above, and all else holds.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>

#include "compiler/geometry/lowering.h"
#include "compiler/graph/evaluate.h"

static const struct {
    const char *spelling;
    double      steepest; /* of t -> f(t) */
} falloff_info[FALLOFF_COUNT] = {
#define FALLOFF(name, spelling, steepest, meaning) {spelling, steepest},
#include "compiler/geometry/falloffs.def"
#undef FALLOFF
};

/* ---- the shape ---- */

static const char *const falloff_spellings[] = {
#define FALLOFF(name, spelling, steepest, meaning) spelling,
#include "compiler/geometry/falloffs.def"
#undef FALLOFF
};
static const Choices falloff_names = {
    .noun    = "falloff",
    .wanted  = "the name of a falloff, a string",
    .unknown = "unknown falloff",
    .more    = "",
    .items   = falloff_spellings,
    .count   = FALLOFF_COUNT,
};

/* A number above 0; NODE_NONE: reported. */
static Node want_positive(Elaboration *e, const Call *call, uint32_t index, double otherwise,
                          const char *what)
{
    Node node = want_number(e, call, index, otherwise);
    if (node == NODE_NONE || !is_given(call, index) ||
        check_positive(e, node, call->arguments[index].syntax, what))
        return node;
    return NODE_NONE;
}

Value builtin_meta(Elaboration *e, Call *call)
{
    Values          values = {0};
    uint32_t        falloff;
    const Argument *list = &call->arguments[0];
    if (!collect_shapes(e, call, list->value, list->syntax, &values) ||
        !want_name(e, &call->arguments[2], &falloff_names, &falloff))
        return value_error();
    Node level = want_positive(e, call, 1, 0.5, "the level of a metasurface");
    Node reach = want_positive(e, call, 3, 0.5, "the reach of a falloff");
    if (level == NODE_NONE || reach == NODE_NONE)
        return value_error();
    const Shape **shapes = joinable_shapes(e, call, &values);
    if (!shapes)
        return value_error();
    Span   span     = call->syntax->span;
    Shape *meta     = shape_new(e, SHAPE_META, "meta", span, shapes, (uint32_t)values.count);
    meta->values[0] = level;
    meta->values[1] = reach;
    meta->falloff   = (FalloffKind)falloff;
    meta->exact     = false;
    meta->box       = box_empty;
    for (size_t i = 0; i < values.count; i++)
        meta->box = box_hull(meta->box, box_grow(shapes[i]->box, node_range(e, reach, 0).high));
    check_steady(e, meta, "`meta`", span);
    return value_shape(meta);
}

/* ---- nodes ---- */

/* exp(-4 x), lowered to be 0 at 1. */
static Node faded(Graph *g, Node x)
{
    double end   = exp(-4);
    Node   power = graph_op2(g, OP_mul, x, graph_number(g, -4));
    Node   high  = graph_op1(g, OP_exp, power);
    high         = graph_op2(g, OP_sub, high, graph_number(g, end));
    return graph_op2(g, OP_mul, high, graph_number(g, 1 / (1 - end)));
}

/* Of t in [0, 1]. */
static Node falloff_at(Graph *g, FalloffKind kind, Node t)
{
    Node one = graph_number(g, 1), square = graph_op1(g, OP_square, t);
    switch (kind) {
    case FALLOFF_WYVILL: {
        Node rest  = graph_op2(g, OP_sub, one, square);
        Node twice = graph_op1(g, OP_square, rest);
        return graph_op2(g, OP_mul, twice, rest);
    }
    case FALLOFF_SOFT: {
        Node sum = graph_op2(g, OP_mul, square, graph_number(g, -4.0 / 9));
        sum      = graph_op2(g, OP_add, sum, graph_number(g, 17.0 / 9));
        sum      = graph_op2(g, OP_mul, sum, square);
        sum      = graph_op2(g, OP_sub, sum, graph_number(g, 22.0 / 9));
        sum      = graph_op2(g, OP_mul, sum, square);
        return graph_op2(g, OP_add, sum, one);
    }
    case FALLOFF_GAUSSIAN: return faded(g, square);
    case FALLOFF_EXPONENTIAL: return faded(g, t);
    case FALLOFF_COUNT: break;
    }
    return NODE_NONE;
}

/* ---- bounds that are too short ---- */

/* Points of a face of the box, and how far above it they are looked at, in parts of the reach. */
enum { FACE_POINTS = 7, FACE_LEVELS = 3 };

/* Beyond it, steps would be too short, and a box shows. */
static const double MOST_STRETCH = 12;

/* The values of parameters in the middle of their ranges. */
static NodeValue *middle_parameters(const Graph *g, Arena *scratch)
{
    NodeValue *values = arena_new_array(scratch, NodeValue, g->parameters.count + 1);
    for (size_t i = 0; i < g->parameters.count; i++)
        for (int k = 0; k < 4; k++) {
            double low = g->parameters.items[i].low[k], high = g->parameters.items[i].high[k];
            values[i].v[k] = isfinite(low) && isfinite(high) ? 0.5 * low + 0.5 * high
                             : isfinite(low)                 ? low + 1
                             : isfinite(high)                ? high - 1
                                                             : 0;
        }
    return values;
}

/* A point `above` face `face` of a box, by two numbers from 0 to 1. */
static void point_above(Box box, int face, double u, double v, double above, double point[3])
{
    int   axis = face / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    Range side = box.axis[axis], a = box.axis[first], b = box.axis[second];
    point[axis]   = face % 2 ? side.high + above : side.low - above;
    point[first]  = a.low + u * (a.high - a.low);
    point[second] = b.low + v * (b.high - b.low);
}

/* How many times longer than `distance` the way to the box is around it, at most. */
static double stretch_around(const Tape *tape, Node distance, Box box, double reach,
                             NodeValue *values)
{
    double most = 1;
    for (int i = 0; i < 6 * FACE_LEVELS * FACE_POINTS * FACE_POINTS; i++) {
        int    place = i % (FACE_POINTS * FACE_POINTS), face = i / (FACE_POINTS * FACE_POINTS);
        double above = reach * (1 + face / 6) / FACE_LEVELS, point[3];
        double u     = place % FACE_POINTS / (FACE_POINTS - 1.0);
        double v     = place / FACE_POINTS / (FACE_POINTS - 1.0);
        point_above(box, face % 6, u, v, above, point);
        tape_run_point(tape, point, values);
        most = fmax(most, fmin(above / fmax(values[distance].v[0], 1e-30), MOST_STRETCH));
    }
    return most;
}

static double stretch_of(const Lowering *l, const Shape *meta, const Shape *child)
{
    Graph   *g     = l->graph;
    Lowering plain = {.graph = g, .scratch = l->scratch, .most = l->most};
    Lowered  part  = lower_shape(&plain, child, place_bare(graph_leaf(g, OP_POINT), true));
    if (part.distance == NODE_NONE || plain.overflow)
        return 1;
    Node       roots[] = {part.distance, meta->values[1]};
    Tape       tape    = tape_new(g, roots, 2, l->scratch);
    NodeValue *values  = arena_new_array(l->scratch, NodeValue, g->count);
    tape_run_frame(&tape, middle_parameters(g, l->scratch), values);
    double reach   = values[roots[1]].v[0];
    double stretch = stretch_around(&tape, part.distance, child->box, reach, values);
    return stretch > 1 + 1e-6 ? stretch : 1;
}

/* The shapes of a metasurface that there are. */
typedef struct Parts {
    Graph   *graph;
    Node    *shares, *gaps;
    double  *stretches, stretched; /* by how much distances are lengthened; the sum of all */
    uint32_t count;
    Surface  surface; /* mixed by the shares, `total` of them so far */
    Node     total;
} Parts;

/* In pairs, so that the graph stays shallow. */
static Node reduce(Graph *g, Op op, const Node *nodes, uint32_t count)
{
    if (count == 1)
        return nodes[0];
    Node left  = reduce(g, op, nodes, count / 2);
    Node right = reduce(g, op, nodes + count / 2, count - count / 2);
    return graph_op2(g, op, left, right);
}

static void mix_in(Lowering *l, Parts *parts, Surface surface, Node share)
{
    Graph *g = l->graph;
    if (parts->count == 0) {
        parts->surface = surface;
        parts->total   = share;
        return;
    }
    Node total     = graph_op2(g, OP_add, parts->total, share);
    Node divisor   = graph_op2(g, OP_max, total, graph_number(g, 1e-30));
    Node weight    = graph_op2(g, OP_div, share, divisor);
    Node half      = graph_number(g, 0.5);
    Node nearer    = graph_op2(g, OP_less, half, weight);
    parts->surface = mix_surface(g, nearer, weight, surface, parts->surface);
    parts->total   = total;
}

static void add_part(Lowering *l, const Shape *meta, const Shape *child, Place place, Parts *parts)
{
    Graph  *g    = l->graph;
    Node    zero = graph_number(g, 0), one = graph_number(g, 1), reach = meta->values[1];
    bool    loose = !child->exact && box_is_finite(child->box);
    Lowered part  = lower_shape(l, child, place_steady(place));
    if (part.distance == NODE_NONE)
        return;
    double stretch = loose ? stretch_of(l, meta, child) : 1;
    Node   begins  = graph_op2(g, OP_mul, reach, graph_number(g, 1 / stretch));
    Node   gap     = graph_op2(g, OP_sub, part.distance, begins);
    part.distance  = graph_op2(g, OP_mul, part.distance, graph_number(g, stretch));
    if (loose) {
        Node around   = box_distance(g, place.point, child->box);
        part.distance = graph_op2(g, OP_max, part.distance, around);
        gap           = graph_op2(g, OP_max, gap, graph_op2(g, OP_sub, around, reach));
    }
    Node t     = graph_op2(g, OP_div, part.distance, reach);
    t          = graph_op3(g, OP_clamp, t, zero, one);
    Node share = falloff_at(g, meta->falloff, t);
    if (l->surfaces)
        mix_in(l, parts, part.surface, share);
    parts->stretched += stretch;
    parts->stretches[parts->count] = stretch;
    parts->shares[parts->count]    = share;
    parts->gaps[parts->count++]    = graph_op2(g, OP_max, gap, zero);
}

/* How many shapes a step can meet: those whose reach begins at once, and others less, down to 0 at
   the longest there is, `most`. */
static Node count_felt(const Parts *parts, Node nearest, Node most)
{
    Graph *g    = parts->graph;
    Node   zero = graph_number(g, 0), one = graph_number(g, 1), sum = NODE_NONE;
    for (uint32_t i = 0; i < parts->count; i++) {
        Node behind = graph_op2(g, OP_sub, parts->gaps[i], nearest);
        Node part   = graph_op2(g, OP_div, behind, most);
        part        = graph_op2(g, OP_sub, one, part);
        part        = graph_op2(g, OP_max, part, zero);
        part        = graph_op2(g, OP_mul, part, graph_number(g, parts->stretches[i]));
        sum         = i == 0 ? part : graph_op2(g, OP_add, sum, part);
    }
    return sum;
}

static Node step_of(const Parts *parts, Node room, Node most, bool lipschitz)
{
    Graph *g       = parts->graph;
    Node   nearest = reduce(g, OP_min, parts->gaps, parts->count);
    Node   count   = lipschitz || parts->count == 1 ? graph_number(g, parts->stretched)
                                                    : count_felt(parts, nearest, most);
    Node   share   = graph_op2(g, OP_div, room, count);
    return graph_op2(g, OP_add, nearest, share);
}

Lowered lower_meta(Lowering *l, const Shape *shape, Place place)
{
    Graph  *g       = l->graph;
    Parts   parts   = {.graph = g, .surface = lowered_nothing.surface};
    Lowered all     = lowered_nothing;
    parts.shares    = arena_new_array(l->scratch, Node, shape->child_count + 1);
    parts.gaps      = arena_new_array(l->scratch, Node, shape->child_count + 1);
    parts.stretches = arena_new_array(l->scratch, double, shape->child_count + 1);
    for (uint32_t i = 0; i < shape->child_count; i++)
        add_part(l, shape, shape->children[i], place, &parts);
    if (parts.count == 0)
        return all;
    Node sum     = reduce(g, OP_add, parts.shares, parts.count);
    Node slope   = graph_number(g, 1 / falloff_info[shape->falloff].steepest);
    slope        = graph_op2(g, OP_mul, slope, shape->values[1]);
    Node most    = graph_op2(g, OP_mul, shape->values[0], slope);
    Node room    = graph_op2(g, OP_mul, sum, slope);
    room         = graph_op2(g, OP_sub, most, room);
    all.distance = step_of(&parts, room, most, place.lipschitz);
    all.surface  = parts.surface;
    return all;
}
