/*
 * local_terms.c: sums and products of what is known of numbers in the ball.
 */
#include "compiler/graph/symbolic/local_terms.h"

#include <math.h>

#include "compiler/graph/build.h"

/* The cells into which the box is cut for what has no rule. */
enum { CELLS = 256 };

bool has_radius(const BallContext *x) { return x->radius != NODE_NONE; }

BallTerm constant_term(const BallContext *x, Node value)
{
    Graph *g    = x->graph;
    Node   zero = graph_number(g, 0);
    return (BallTerm){value, graph_vec3(g, 0, 0, 0), zero, zero, NODE_NONE};
}

Node slope_here(const BallContext *x, const BallTerm *a)
{
    Graph *g = x->graph;
    return plus(g, graph_op1(g, OP_length, a->gradient), a->first);
}

Node steepness(const BallContext *x, const BallTerm *a)
{
    Graph *g = x->graph;
    if (a->steep != NODE_NONE)
        return a->steep;
    Node here = slope_here(x, a);
    return has_radius(x) ? plus(g, here, times(g, a->second, x->radius)) : here;
}

BallTerm opaque_term(BallContext *x, Node value)
{
    Graph   *g     = x->graph;
    BallTerm term  = constant_term(x, value);
    double   slope = graph_slope(g, value, x->box, NULL, CELLS, NULL, x->scratch);
    x->bounded     = x->bounded && isfinite(slope);
    term.first     = graph_number(g, isfinite(slope) ? slope : 0);
    return term;
}

BallTerm add_terms(const BallContext *x, Node value, BallTerm a, BallTerm b)
{
    Graph *g = x->graph;
    return (BallTerm){value, plus(g, a.gradient, b.gradient), plus(g, a.first, b.first),
                      plus(g, a.second, b.second), NODE_NONE};
}

BallTerm negate_term(const BallContext *x, Node value, BallTerm a)
{
    Graph *g = x->graph;
    return (BallTerm){value, neg(g, a.gradient), a.first, a.second, a.steep};
}

BallTerm scale_term(const BallContext *x, Node value, BallTerm a, Node factor)
{
    Graph *g    = x->graph;
    Node   size = graph_op1(g, OP_abs, factor);
    return (BallTerm){value, stretch(g, a.gradient, factor), times(g, a.first, size),
                      times(g, a.second, size), NODE_NONE};
}

BallTerm multiply_terms(const BallContext *x, Node value, BallTerm a, BallTerm b)
{
    Graph   *g       = x->graph;
    BallTerm first   = scale_term(x, value, a, b.value);
    BallTerm second  = scale_term(x, value, b, a.value);
    BallTerm product = add_terms(x, value, first, second);
    if (has_radius(x)) {
        Node steep     = steepness(x, &b);
        Node both      = times(g, steepness(x, &a), steep);
        product.second = plus(g, product.second, both);
    }
    return product;
}
