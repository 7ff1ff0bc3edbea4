/*
 * displace.c: the surface moved outwards by a formula.  C is a box, which may be endless.
 */
#include "compiler/base/far.h"
#include "compiler/family/deform.h"

#include <math.h>

#include "compiler/graph/build.h"
#include "compiler/graph/rewrite/simplify.h"

/* ---- how it is made ---- */

/* The expression as a graph of its own, which is quick to analyse. */
typedef struct Bump {
    Graph *graph;
    Node   root;
    Range  amplitude;
} Bump;

static double bump_size(ShapeBuilder *builder, const Bump *bump, Box box)
{
    return range_largest(
        graph_facts(bump->graph, box, NULL, builder->scratch)[bump->root].value[0]);
}

/* Tells how large the expression can be where the displaced surface can be; that grows with it. */
static double bump_reach(ShapeBuilder *builder, const Bump *bump, Box box)
{
    enum { TRIALS = 40 };
    double most      = bump_size(builder, bump, box_infinite),
           amplitude = range_largest(bump->amplitude);
    if (isfinite(most) || !isfinite(amplitude))
        return most;
    most = bump_size(builder, bump, box);
    for (int i = 0; i < TRIALS; i++) {
        double next = bump_size(builder, bump, box_grow(box, amplitude * most));
        if (next <= most)
            return most;
        most = 1.05 * next;
    }
    return INFINITY;
}

static void report_large_bump(ShapeBuilder *builder, Span formula_span)
{
    Diag *diag  = diag_add(builder->diags, DIAG_STEEP, formula_span,
                           "the size of this displacement has no bound");
    diag->label = "this can become arbitrarily large";
    diag->help  = "keep it in limits with `clamp`, cut the shape with `.within`, give a `param` in "
                  "it a range, or take what grows as the `amplitude`";
}

static void report_bump(ShapeBuilder *builder, Span formula_span, Blame blame)
{
    Diag *diag = diag_add(builder->diags, DIAG_STEEP, blame.span.source ? blame.span : formula_span,
                          "the slope of this displacement has no bound");
    diag->label = "this can change arbitrarily fast";
    explain_steep(builder, diag, blame);
    diag->help = "keep it in limits with `clamp`, cut the shape with `.within`, and give a "
                 "`param` in it a range";
}

/* Bounds the slope of the formula everywhere or, failing that, where the displaced surface can be.
   False: there is no bound on that or on its size, which is reported. */
static bool bound_bump(ShapeBuilder *builder, Shape *displaced, Span formula_span, Steepness *slope)
{
    Box  regions[2] = {box_infinite, displaced->box};
    bool bounded    = find_slope(builder, displaced->formula, regions,
                              box_is_finite(displaced->box) ? 2 : 1, formula_span, slope);
    if (bounded && isfinite(displaced->reach))
        return true;
    if (bounded)
        report_large_bump(builder, formula_span);
    else
        report_bump(builder, formula_span, slope->blame);
    return false;
}

const Shape *make_displace(ShapeBuilder *builder, const Shape *shape, Node formula,
                           Span formula_span, const DeformArguments *asked)
{
    if (!check_solid(builder, shape, asked))
        return NULL;
    if (box_is_empty(shape->box))
        return shape;
    Node   amplitude     = asked->numbers[0];
    Shape *displaced     = deformed_shape(builder, SHAPE_DISPLACE, "displace", shape, asked);
    displaced->formula   = formula;
    displaced->values[0] = amplitude;
    Bump bump            = {.root = formula, .amplitude = node_range(builder, amplitude, 0)};
    bump.graph           = graph_simplify(builder->graph, &bump.root, 1, builder->scratch);
    displaced->reach     = bump_reach(builder, &bump, shape->box);
    double grown         = product_upward(range_largest(bump.amplitude), displaced->reach);
    displaced->moved     = grown;
    displaced->box       = isfinite(grown) ? box_grow(shape->box, grown) : box_infinite;
    Steepness slope;
    bool      bounded = bound_bump(builder, displaced, formula_span, &slope);
    if (bounded) {
        displaced->values[1] = steepness_node(builder->graph, &slope);
        displaced->per_frame = displaced->per_frame || slope.slot != NODE_NONE;
        double steep         = range_largest(bump.amplitude) * slope.bound;
        displaced->divided   = slope.slot == NODE_NONE ? steep + shape->slope : HUGE_VAL;
        note_slope(displaced, 1 + steep);
    }
    arena_free(builder->scratch);
    return bounded ? displaced : NULL;
}

/* ---- how it is lowered ---- */

/* Tells how far above the high side and below the low one, the most of all axes; negative within. */
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
        low[i]  = fmax(box->axis[i].low, -NOWHERE);
        high[i] = fmin(box->axis[i].high, NOWHERE);
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

/* Lowers d - amplitude * formula, over the sum of both slopes. */
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
    LowerContext inner  = context_divided(context_at(context, point), shape->divided);
    Lowered      result = lower_shape(l, child, context_lipschitz_within(inner, shape->moved));
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
    return with_region(l, result, offset, NODE_NONE);
}
