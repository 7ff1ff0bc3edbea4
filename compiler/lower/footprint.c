/*
 * footprint.c: how far what a material computes changes within a pixel.
 *
 * A pixel is a disc of radius r across the ray with the direction d.  The rays through it meet the
 * surface, of normal n, in an ellipse.  A step s across the ray moves the point on the surface by
 * s - d (s.n) / (d.n).  An expression with the gradient g changes by s.h then, where
 *     h = g - n (g.d) / (d.n),
 * and h is across the ray.  So from one side of the pixel to the other it changes by 2 r |h|.
 *
 * Two expressions together, with h and k, map the disc to an ellipse.  Its sides are 2 r times the roots
 * of the eigenvalues of the matrix of h.h, h.k and k.k.
 *
 * Where no ray is known, as of instances of groups, the surface is taken to be seen from its front.
 */
#include "compiler/lower/footprint.h"

#include "compiler/graph/build.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/derive.h"

/* Nearer to grazing than this cosine, pixels are taken to be no longer. */
static const double MIN_COSINE_SQUARED = 1e-6;

/* Bodies of instance groups have leaves of their own. */
Pixel pixel_of(Graph *g, Node expression, Arena *scratch)
{
    uint32_t table_number = 0;
    bool     in_instances = false;
    Tape     tape         = tape_new(g, &expression, 1, scratch);
    for (size_t i = tape.frame_count; i < tape.count; i++)
        if (g->items[tape.nodes[i]].op == OP_INSTANCE_POINT) {
            table_number = g->items[tape.nodes[i]].index;
            in_instances = true;
        }
    Pixel pixel = {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE};
    if (!in_instances) {
        pixel.point  = graph_leaf(g, OP_POINT);
        pixel.normal = graph_leaf(g, OP_NORMAL);
        pixel.view   = graph_leaf(g, OP_VIEW);
        pixel.radius = graph_leaf(g, OP_FOOTPRINT);
        return pixel;
    }
    pixel.point  = graph_instance_leaf(g, OP_INSTANCE_POINT, table_number);
    pixel.normal = pixel.view = graph_instance_leaf(g, OP_INSTANCE_NORMAL, table_number);
    pixel.radius              = graph_instance_leaf(g, OP_INSTANCE_FOOTPRINT, table_number);
    return pixel;
}

/* Returns the part of a gradient that steps across the ray see. */
static Node seen_gradient(Graph *g, Pixel pixel, Node gradient)
{
    Node cosine = graph_op2(g, OP_dot, pixel.normal, pixel.view);
    Node along  = graph_op2(g, OP_dot, gradient, pixel.view);
    Node least  = graph_number(g, MIN_COSINE_SQUARED);
    Node square = graph_op2(g, OP_mul, cosine, cosine);
    Node size   = graph_op2(g, OP_max, square, least);
    Node share  = graph_op2(g, OP_div, graph_op2(g, OP_mul, along, cosine), size);
    Node bent   = graph_op2(g, OP_scale, pixel.normal, share);
    return graph_op2(g, OP_sub, gradient, bent);
}

static Node width_of(Graph *g, Node expression, Arena *scratch)
{
    Node  gradient = graph_known_gradient(g, expression, scratch);
    Pixel pixel    = pixel_of(g, expression, scratch);
    Node  seen     = seen_gradient(g, pixel, gradient);
    Node  length   = graph_op1(g, OP_length, seen);
    Node  width    = graph_op2(g, OP_add, pixel.radius, pixel.radius);
    return graph_op2(g, OP_mul, width, length);
}

/* Returns the long side of that ellipse, and its width across. */
static Node axes_of(Graph *g, Node place, Arena *scratch)
{
    Pixel pixel = pixel_of(g, place, scratch);
    Node  seen[2];
    for (uint32_t i = 0; i < 2; i++) {
        Node part = graph_component(g, place, i);
        seen[i]   = seen_gradient(g, pixel, graph_known_gradient(g, part, scratch));
    }
    Node hh = graph_op2(g, OP_dot, seen[0], seen[0]), kk = graph_op2(g, OP_dot, seen[1], seen[1]);
    Node hk   = graph_op2(g, OP_dot, seen[0], seen[1]);
    Node half = graph_number(g, 0.5), one = graph_number(g, 1);
    Node mean = mul(g, half, add(g, hh, kk)), half_difference = mul(g, half, sub(g, hh, kk));
    Node mixed = mul(g, hk, hk);
    Node root  = root_of(g, add(g, mul(g, half_difference, half_difference), mixed), 2);
    /* Twice the angle of the long side has this cosine; there is none where it is a circle. */
    Node double_cosine = over(g, half_difference, at_least(g, root, 1e-30));
    Node cosine        = root_of(g, at_least(g, mul(g, half, add(g, one, double_cosine)), 0), 2);
    Node sine          = root_of(g, at_least(g, mul(g, half, sub(g, one, double_cosine)), 0), 2);
    Node falls         = graph_op2(g, OP_less, hk, graph_number(g, 0));
    sine               = graph_op3(g, OP_select, falls, neg(g, sine), sine);
    Node width         = add(g, pixel.radius, pixel.radius);
    Node length        = mul(g, width, root_of(g, add(g, mean, root), 2));
    Node across        = mul(g, width, root_of(g, at_least(g, sub(g, mean, root), 0), 2));
    Node up            = mul(g, length, sine);
    return graph_op3(g, OP_vec3, mul(g, length, cosine), up, across);
}

Node lower_footprints(Graph *graph, Node root, Arena *scratch)
{
    Tape  tape = tape_new(graph, &root, 1, scratch);
    Node *by   = NULL;
    Span  here = graph->here;
    for (size_t i = 0; i < tape.count; i++) {
        Expr e = graph->items[tape.nodes[i]];
        if (e.op != OP_footprint && e.op != OP_footprint_axes)
            continue;
        graph->here = e.span;
        if (!by)
            by = arena_new_array(scratch, Node, tape.count);
        by[i] = 1 + (e.op == OP_footprint ? width_of(graph, e.operands[0], scratch)
                                          : axes_of(graph, e.operands[0], scratch));
    }
    graph->here = here;
    return by ? graph_replace_nodes(graph, root, &tape, by, scratch) : root;
}
