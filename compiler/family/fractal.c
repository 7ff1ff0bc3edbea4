/*
 * fractal.c: Julia sets and Mandelbulbs as shapes.
 *
 * The number of iterations may change from frame to frame; the greatest that its range permits
 * bounds the loop on the device.  A Julia set's distance is a bound that is 1-Lipschitz
 * (compiler/graph/fractal.c) and may stand anywhere.  A Mandelbulb's is an estimate: nothing is
 * proven of it, least of all a slope, so nothing may move its surface.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/fractal.h"

static Node pair(ShapeBuilder *builder, double a, double b)
{
    return graph_constant(builder->graph, TYPE_VEC2, (double[]){a, b});
}

/* Returns julia_radius for a |c| of frame time: Newton's steps stay above the root. */
static Node radius_node(ShapeBuilder *builder, Node c, uint32_t power)
{
    Graph *g    = builder->graph;
    Node   size = graph_op1(g, OP_length, c);
    if (graph_is_constant(g, size))
        return graph_number(g, julia_radius(g->items[size].number[0], power));
    Node whole = graph_number(g, power), less = graph_number(g, power - 1);
    Node one = graph_number(g, 1), twice = graph_op2(g, OP_mul, size, graph_number(g, 2));
    Node r = graph_op2(g, OP_pow, twice, graph_number(g, 1.0 / power));
    r      = graph_op2(g, OP_max, r, graph_number(g, real_exp2(1.0 / (power - 1))));
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

/* Returns the largest |c| for all values of the parameters. */
static double largest_size(ShapeBuilder *builder, Node c)
{
    double size = 0;
    for (uint32_t i = 0; i < 4; i++)
        size = hypot_upward(size, range_largest(node_range(builder, c, i)));
    return size;
}

static Shape *fractal_new(ShapeBuilder *builder, const char *name, Span span, double radius)
{
    Shape *shape      = shape_new(builder, SHAPE_PRIMITIVE, name, span, NULL, 0);
    shape->exact      = false;
    shape->trapped    = true;
    shape->without_uv = shape;
    for (int i = 0; i < 3; i++)
        shape->box.axis[i] = (Range){-radius, radius};
    return shape;
}

const Shape *make_julia(ShapeBuilder *builder, Node c, uint32_t power, Node iterations, double most,
                        Span span)
{
    Graph *g        = builder->graph;
    g->here         = span;
    Node   point    = graph_leaf(g, OP_POINT);
    Node   radius   = radius_node(builder, c, power);
    Node   settings = graph_op2(g, OP_vec2, iterations, radius), range = pair(builder, power, most);
    double largest = largest_size(builder, c);
    /* Roots of single precision may be larger by a little. */
    double reach    = isfinite(largest) ? julia_radius(largest, power) * (1 + 1e-6) : INFINITY;
    Shape *shape    = fractal_new(builder, "julia", span, reach);
    shape->distance = graph_op4(g, OP_julia, point, c, range, settings);
    shape->trap     = graph_op4(g, OP_julia_trap, point, c, range, settings);
    return shape;
}

const Shape *make_mandelbulb(ShapeBuilder *builder, uint32_t power, Node iterations, double most,
                             Span span)
{
    Graph *g     = builder->graph;
    g->here      = span;
    double reach = mandelbulb_radius(power);
    Node   point = graph_leaf(g, OP_POINT), radius = graph_number(g, reach);
    Node   settings = graph_op2(g, OP_vec2, iterations, radius), range = pair(builder, power, most);
    Shape *shape    = fractal_new(builder, "mandelbulb", span, reach);
    shape->estimate = true;
    shape->distance = graph_op3(g, OP_mandelbulb, point, range, settings);
    shape->trap     = graph_op3(g, OP_mandelbulb_trap, point, range, settings);
    return shape;
}
