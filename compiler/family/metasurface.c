/*
 * metasurface.c: metasurfaces, from the call to the nodes.
 *
 * Each shape counts 1 where it is, and less with the distance d from it: f(d / reach), 0 from the
 * end of its reach.  The solid is where the sum F is at least the level T.
 *
 * Within a step s the falloff of a shape can rise by L s, L = steepest / reach.  A shape whose reach
 * begins only after a distance, its entry, can rise by L (s - entry).  So s is safe as long as
 *     sum over all of max(s - entry_i, 0) <= (T - F) / L = margin.
 * Let all entries and s be counted from the nearest entry.  Then
 *     max(s - entry, 0) <= s max(1 - entry / most, 0)   for s <= most = T / L,
 * and the margin is never more than `most`.  So
 *     s = nearest + margin / sum of max(1 - (entry_i - nearest) / most, 0)
 * is safe.  The sum is at least 1.  Inside it is at least the number of shapes within reach, which is
 * what matters there.  It changes gradually, so normals found by differences show no edges.
 *
 * Where something above needs the slope, the sum is n: nearest + margin / n is 1-Lipschitz, since F is
 * 0 outside of every reach.
 *
 * A bound d may be much below the distance, and then what counts by it is fat.  The distance to
 * the shape's box is a bound as well, but shows: flat faces.  So such a d is lengthened, by a
 * factor k for which it is the longer of the two around the box (found by looking).  Its shape
 * counts f(k d / reach), which rises by k L s in a step s, from the entry d - reach / k on: so it
 * counts k times in the sums above, and all else holds.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/box_distance.h"
#include "compiler/lower/surface.h"

static const struct {
    double steepest; /* of t -> f(t) */
} falloff_info[FALLOFF_COUNT] = {
#define FALLOFF(name, spelling, steepest, meaning) {steepest},
#include "compiler/shape/falloffs.def"
#undef FALLOFF
};

/* ---- how it is made ---- */

const Shape *make_meta(ShapeBuilder *builder, const Shape *const *shapes, uint32_t count,
                       Node level, Node reach, FalloffKind falloff, Span span)
{
    Shape *meta     = shape_new(builder, SHAPE_META, "meta", span, shapes, count);
    meta->values[0] = level;
    meta->values[1] = reach;
    meta->falloff   = falloff;
    meta->exact     = false;
    meta->box       = builder_box(builder, meta);
    check_lipschitz(builder, meta, "`meta`", span);
    return meta;
}

/* ---- how it is lowered ---- */

/* Returns exp(-4 x), lowered to be 0 at 1. */
static Node faded(Graph *g, Node x)
{
    double end   = real_exp(-4);
    Node   power = graph_op2(g, OP_mul, x, graph_number(g, -4));
    Node   high  = graph_op1(g, OP_exp, power);
    high         = graph_op2(g, OP_sub, high, graph_number(g, end));
    return graph_op2(g, OP_mul, high, graph_number(g, 1 / (1 - end)));
}

/* Makes the falloff at t in [0, 1]. */
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

/* Points of a face of the box, and how far above it they are looked at, in fractions of the reach. */
enum { FACE_POINTS = 7, FACE_LEVELS = 3 };

/* Beyond it, steps would be too short, and a box shows. */
static const double MAX_STRETCH = 12;

/* Returns the values of parameters in the middle of their ranges. */
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

/* Finds a point `above` face `face` of a box, by two numbers from 0 to 1. */
static void point_above(Box box, int face, double u, double v, double above, double point[3])
{
    int   axis = face / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    Range side = box.axis[axis], a = box.axis[first], b = box.axis[second];
    point[axis]   = face % 2 ? side.high + above : side.low - above;
    point[first]  = a.low + u * (a.high - a.low);
    point[second] = b.low + v * (b.high - b.low);
}

/* Tells how many times longer than `distance` the way to the box is around it, at most. */
static double stretch_around(const Tape *tape, Node distance, Box box, double reach,
                             NodeValue *values)
{
    double most = 1;
    for (int i = 0; i < 6 * FACE_LEVELS * FACE_POINTS * FACE_POINTS; i++) {
        int    cell = i % (FACE_POINTS * FACE_POINTS), face = i / (FACE_POINTS * FACE_POINTS);
        double above = reach * (1 + face / 6) / FACE_LEVELS, point[3];
        double u     = cell % FACE_POINTS / (FACE_POINTS - 1.0);
        double v     = cell / FACE_POINTS / (FACE_POINTS - 1.0);
        point_above(box, face % 6, u, v, above, point);
        tape_run_point(tape, point, values);
        most = fmax(most, fmin(above / fmax(values[distance].v[0], 1e-30), MAX_STRETCH));
    }
    return most;
}

static double stretch_of(const Lowering *l, const Shape *meta, const Shape *child)
{
    Graph   *g       = l->graph;
    Lowering plain   = {.graph = g, .scratch = l->scratch, .most = l->most};
    Lowered  lowered = lower_shape(&plain, child, context_new(graph_leaf(g, OP_POINT), true));
    if (lowered.distance == NODE_NONE || plain.overflow)
        return 1;
    Node       roots[] = {lowered.distance, meta->values[1]};
    Tape       tape    = tape_new(g, roots, 2, l->scratch);
    NodeValue *values  = arena_new_array(l->scratch, NodeValue, g->count);
    tape_run_frame(&tape, middle_parameters(g, l->scratch), values);
    double reach   = values[roots[1]].v[0];
    double stretch = stretch_around(&tape, lowered.distance, child->box, reach, values);
    return stretch > 1 + 1e-6 ? stretch : 1;
}

/* The shapes of a metasurface that are not empty. */
typedef struct MetaTerms {
    Graph   *graph;
    Node    *falloffs, *entries;
    double  *stretches, stretched; /* by how much distances are lengthened; the sum of all */
    uint32_t count;
    Surface  surface; /* mixed by the falloffs, whose sum so far is `total` */
    Node     total;
} MetaTerms;

/* Joins nodes in pairs, so that the graph stays shallow. */
static Node reduce(Graph *g, Op op, const Node *nodes, uint32_t count)
{
    if (count == 1)
        return nodes[0];
    Node left  = reduce(g, op, nodes, count / 2);
    Node right = reduce(g, op, nodes + count / 2, count - count / 2);
    return graph_op2(g, op, left, right);
}

static void mix_in(Lowering *l, MetaTerms *terms, Surface surface, Node falloff)
{
    Graph *g = l->graph;
    if (terms->count == 0) {
        terms->surface = surface;
        terms->total   = falloff;
        return;
    }
    Node total     = graph_op2(g, OP_add, terms->total, falloff);
    Node divisor   = graph_op2(g, OP_max, total, graph_number(g, 1e-30));
    Node weight    = graph_op2(g, OP_div, falloff, divisor);
    Node half      = graph_number(g, 0.5);
    Node nearer    = graph_op2(g, OP_less, half, weight);
    terms->surface = mix_surface(g, nearer, weight, surface, terms->surface);
    terms->total   = total;
}

static void add_term(Lowering *l, const Shape *meta, const Shape *child, LowerContext context,
                     MetaTerms *terms)
{
    Graph  *g    = l->graph;
    Node    zero = graph_number(g, 0), one = graph_number(g, 1), reach = meta->values[1];
    bool    underestimates = !child->exact && box_is_finite(child->box);
    Lowered lowered        = lower_shape(l, child, context_lipschitz(context));
    if (lowered.distance == NODE_NONE)
        return;
    double stretch   = underestimates ? stretch_of(l, meta, child) : 1;
    Node   begins    = graph_op2(g, OP_mul, reach, graph_number(g, 1 / stretch));
    Node   entry     = graph_op2(g, OP_sub, lowered.distance, begins);
    lowered.distance = graph_op2(g, OP_mul, lowered.distance, graph_number(g, stretch));
    if (underestimates) {
        Node around      = box_distance(g, context.point, child->box);
        lowered.distance = graph_op2(g, OP_max, lowered.distance, around);
        entry            = graph_op2(g, OP_max, entry, graph_op2(g, OP_sub, around, reach));
    }
    Node t       = graph_op2(g, OP_div, lowered.distance, reach);
    t            = graph_op3(g, OP_clamp, t, zero, one);
    Node falloff = falloff_at(g, meta->falloff, t);
    if (l->surfaces)
        mix_in(l, terms, lowered.surface, falloff);
    terms->stretched += stretch;
    terms->stretches[terms->count] = stretch;
    terms->falloffs[terms->count]  = falloff;
    terms->entries[terms->count++] = graph_op2(g, OP_max, entry, zero);
}

/* Tells how many shapes a step can reach: one each for those whose reach begins at once, less for others,
   0 for those that the longest step, `most`, does not reach. */
static Node count_reached(const MetaTerms *terms, Node nearest, Node most)
{
    Graph *g    = terms->graph;
    Node   zero = graph_number(g, 0), one = graph_number(g, 1), sum = NODE_NONE;
    for (uint32_t i = 0; i < terms->count; i++) {
        Node behind = graph_op2(g, OP_sub, terms->entries[i], nearest);
        Node term   = graph_op2(g, OP_div, behind, most);
        term        = graph_op2(g, OP_sub, one, term);
        term        = graph_op2(g, OP_max, term, zero);
        term        = graph_op2(g, OP_mul, term, graph_number(g, terms->stretches[i]));
        sum         = i == 0 ? term : graph_op2(g, OP_add, sum, term);
    }
    return sum;
}

static Node step_of(const MetaTerms *terms, Node margin, Node most, bool lipschitz)
{
    Graph *g       = terms->graph;
    Node   nearest = reduce(g, OP_min, terms->entries, terms->count);
    Node   count   = lipschitz || terms->count == 1 ? graph_number(g, terms->stretched)
                                                    : count_reached(terms, nearest, most);
    Node   step    = graph_op2(g, OP_div, margin, count);
    return graph_op2(g, OP_add, nearest, step);
}

Lowered lower_meta(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph    *g     = l->graph;
    MetaTerms terms = {.graph = g, .surface = lowered_nothing.surface};
    Lowered   all   = lowered_nothing;
    terms.falloffs  = arena_new_array(l->scratch, Node, shape->child_count + 1);
    terms.entries   = arena_new_array(l->scratch, Node, shape->child_count + 1);
    terms.stretches = arena_new_array(l->scratch, double, shape->child_count + 1);
    for (uint32_t i = 0; i < shape->child_count; i++)
        add_term(l, shape, shape->children[i], context, &terms);
    if (terms.count == 0)
        return all;
    Node sum     = reduce(g, OP_add, terms.falloffs, terms.count);
    Node slope   = graph_number(g, 1 / falloff_info[shape->falloff].steepest);
    slope        = graph_op2(g, OP_mul, slope, shape->values[1]);
    Node most    = graph_op2(g, OP_mul, shape->values[0], slope);
    Node margin  = graph_op2(g, OP_mul, sum, slope);
    margin       = graph_op2(g, OP_sub, most, margin);
    all.distance = step_of(&terms, margin, most, context.lipschitz);
    all.surface  = terms.surface;
    return all;
}
