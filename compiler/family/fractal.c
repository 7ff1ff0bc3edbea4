/*
 * fractal.c: Julia sets and Mandelbulbs as shapes.
 *
 * The number of iterations may change from frame to frame; the greatest that its range permits
 * bounds the loop on the device.  A Julia set's distance is a bound that is 1-Lipschitz
 * (compiler/graph/fractal.c) and may stand anywhere.  A Mandelbulb's is an estimate: nothing is
 * proven of it, least of all a slope, so nothing may move its surface.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>

#include "compiler/graph/fractal.h"

/* ---- estimates ---- */

static const Shape *find_estimate(const Shape *shape)
{
    while (shape->child_count > 0) {
        uint32_t i = 0;
        while (i + 1 < shape->child_count && !shape->children[i]->estimate)
            i++;
        shape = shape->children[i];
    }
    return shape;
}

void check_lipschitz(Elaboration *e, const Shape *shape, const char *what, Span span)
{
    if (!shape->estimate)
        return;
    const Shape *source = find_estimate(shape);
    Diag *diag = diag_add(e->diags, DIAG_ESTIMATE, span, "%s needs a distance whose slope is known",
                          what);
    diag->label = diag_text(e->diags, "that of `%s` is an estimate", source->name);
    diag_secondary(e->diags, diag, source->span, "nothing is proven of this distance");
    diag->help = "join it with `|`, `&` or `-`, which work with estimates, too";
}

/* ---- arguments ---- */

/* The iterations as a whole number of frame time, and the most there can be; false: reported. */
static bool want_iterations(Elaboration *e, const Call *call, uint32_t index, double otherwise,
                            Node *iterations, double *most)
{
    Node node = want_number(e, call, index, otherwise);
    if (node == NODE_NONE)
        return false;
    Range range  = node_range(e, node, 0);
    bool  broken = range.low == range.high && range.low != floor(range.low);
    if (!(range.low >= 1 && range.high < MOST_ITERATIONS + 1) || broken) {
        const Syntax *syntax = call->arguments[index].syntax;
        Diag         *diag   = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span,
                                        "the iterations of `%s` must be whole numbers from 1 to %d",
                                        call->name, MOST_ITERATIONS);
        diag->label = diag_text(e->diags, range.low == range.high ? "this is %g" : "from %g to %g",
                                range.low, range.high);
        if (range.low != range.high)
            diag->help = "give the `param` a range, or use `clamp(..., 1, 16)`: the most there can "
                         "be bounds the loop";
        return false;
    }
    *most       = floor(range.high);
    *iterations = graph_op1(e->graph, OP_floor, node);
    return true;
}

/* As many as give details of about a thousandth of the whole. */
static double usual_iterations(uint32_t power) { return ceil(10 / log2(power)); }

/* A list of four numbers of frame time; NODE_NONE: reported. */
static Node want_quaternion(Elaboration *e, const Call *call, uint32_t index)
{
    static const double otherwise[4] = {-0.2, 0.6, 0.2, 0.1};
    const Argument     *argument     = &call->arguments[index];
    if (!argument->syntax)
        return graph_constant(e->graph, TYPE_VEC4, otherwise);
    Node node = value_size(e, argument->value) == 4 ? value_node(e, argument->value) : NODE_NONE;
    if (node == NODE_NONE) {
        type_error(e, argument->syntax, argument->value, "a quaternion, [re, i, j, k]");
        return NODE_NONE;
    }
    if (e->graph->items[node].time == TIME_POINT) {
        point_error(e, argument->syntax, diag_text(e->diags, "`c` of `%s`", call->name));
        return NODE_NONE;
    }
    return check_finite(e, node, argument->syntax) ? node : NODE_NONE;
}

static Node pair(Elaboration *e, double a, double b)
{
    return graph_constant(e->graph, TYPE_VEC2, (double[]){a, b});
}

/* ---- shapes ---- */

static Shape *fractal_new(Elaboration *e, const Call *call, double radius)
{
    Shape *shape      = shape_new(e, SHAPE_PRIMITIVE, call->name, call->syntax->span, NULL, 0);
    shape->exact      = false;
    shape->trapped    = true;
    shape->without_uv = shape;
    for (int i = 0; i < 3; i++)
        shape->box.axis[i] = (Range){-radius, radius};
    return shape;
}

/* julia_radius for a |c| of frame time: Newton's steps stay above the root. */
static Node radius_node(Elaboration *e, Node c, uint32_t power)
{
    Graph *g    = e->graph;
    Node   size = graph_op1(g, OP_length, c);
    if (graph_is_constant(g, size))
        return graph_number(g, julia_radius(g->items[size].number[0], power));
    Node whole = graph_number(g, power), less = graph_number(g, power - 1);
    Node one = graph_number(g, 1), twice = graph_op2(g, OP_mul, size, graph_number(g, 2));
    Node r = graph_op2(g, OP_pow, twice, graph_number(g, 1.0 / power));
    r      = graph_op2(g, OP_max, r, graph_number(g, exp2(1.0 / (power - 1))));
    for (int i = 0; i < 4; i++) {
        Node lower = graph_power(g, r, less);
        Node above = graph_op2(g, OP_mul, graph_op2(g, OP_mul, lower, r), less);
        Node below = graph_op2(g, OP_mul, lower, whole);
        above      = graph_op2(g, OP_add, above, size);
        below      = graph_op2(g, OP_sub, below, one);
        r          = graph_op2(g, OP_div, above, below);
    }
    return r;
}

/* The largest |c| for all values of the parameters. */
static double largest_size(Elaboration *e, Node c)
{
    double size = 0;
    for (uint32_t i = 0; i < 4; i++)
        size = hypot_upward(size, range_largest(node_range(e, c, i)));
    return size;
}

Value builtin_julia(Elaboration *e, Call *call)
{
    uint32_t power;
    double   most;
    Node     iterations, c = want_quaternion(e, call, 0);
    if (c == NODE_NONE || !want_count(e, call, 1, 2, MOST_POWER, 2, &power) ||
        !want_iterations(e, call, 2, usual_iterations(power), &iterations, &most))
        return value_error();
    Graph *g        = e->graph;
    g->here         = call->syntax->span;
    Node   point    = graph_leaf(g, OP_POINT);
    Node   radius   = radius_node(e, c, power);
    Node   settings = graph_op2(g, OP_vec2, iterations, radius), range = pair(e, power, most);
    double largest = largest_size(e, c);
    /* Roots of single precision may be larger by a little. */
    double reach    = isfinite(largest) ? julia_radius(largest, power) * (1 + 1e-6) : INFINITY;
    Shape *shape    = fractal_new(e, call, reach);
    shape->distance = graph_op4(g, OP_julia, point, c, range, settings);
    shape->trap     = graph_op4(g, OP_julia_trap, point, c, range, settings);
    return value_shape(shape);
}

Value builtin_mandelbulb(Elaboration *e, Call *call)
{
    uint32_t power;
    double   most;
    Node     iterations;
    if (!want_count(e, call, 0, 2, MOST_POWER, 8, &power) ||
        !want_iterations(e, call, 1, usual_iterations(power), &iterations, &most))
        return value_error();
    Graph *g     = e->graph;
    g->here      = call->syntax->span;
    double reach = mandelbulb_radius(power);
    Node   point = graph_leaf(g, OP_POINT), radius = graph_number(g, reach);
    Node   settings = graph_op2(g, OP_vec2, iterations, radius), range = pair(e, power, most);
    Shape *shape    = fractal_new(e, call, reach);
    shape->estimate = true;
    shape->distance = graph_op3(g, OP_mandelbulb, point, range, settings);
    shape->trap     = graph_op3(g, OP_mandelbulb_trap, point, range, settings);
    return value_shape(shape);
}
