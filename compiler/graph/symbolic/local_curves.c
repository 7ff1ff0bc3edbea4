/*
 * local_curves.c: smooth functions of one number in the ball.
 */
#include "compiler/graph/symbolic/local_curves.h"

#include <math.h>

#include "compiler/graph/build.h"

/* Returns |u|, from which the poles at 0 are no more than half as far away as the ball may reach. */
static Node clear_of_zero(BallContext *x, BallTerm u, Node *reach)
{
    Graph *g    = x->graph;
    Node   size = at_least(g, graph_op1(g, OP_abs, u.value), SMALL),
         half   = times(g, size, graph_number(g, 0.5));
    Node steep  = at_least(g, steepness(x, &u), TINY);
    Node margin = over(g, times(g, graph_op1(g, OP_abs, u.value), graph_number(g, 0.5)), steep);
    x->limit    = x->limit == NODE_NONE ? margin : graph_op2(g, OP_min, x->limit, margin);
    *reach      = graph_op2(g, OP_min, *reach, half);
    return sub(g, size, *reach);
}

/* Returns e^reach - 1 over the ball, of which no more is used than reaches by 1. */
static Node growth(BallContext *x, BallTerm u, Node reach)
{
    Graph *g      = x->graph;
    Node   one    = graph_number(g, 1);
    Node   margin = over(g, one, at_least(g, steepness(x, &u), TINY));
    x->limit      = x->limit == NODE_NONE ? margin : graph_op2(g, OP_min, x->limit, margin);
    reach         = graph_op2(g, OP_min, reach, one);
    return plus(g, one, times(g, reach, graph_number(g, 1.7183)));
}

Curve curve_square(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    return (Curve){times(g, u.value, graph_number(g, 2)), graph_number(g, 2)};
}

Curve curve_sin(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){graph_op1(g, OP_cos, u.value), one};
}

Curve curve_cos(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){neg(g, graph_op1(g, OP_sin, u.value)), one};
}

Curve curve_atan(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){over(g, one, plus(g, one, graph_op1(g, OP_square, u.value))),
                   graph_number(g, 0.6496)};
}

Curve curve_tanh(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)u, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){sub(g, one, graph_op1(g, OP_square, value)), graph_number(g, 0.7699)};
}

Curve curve_exp(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g   = x->graph;
    Node   one = graph_number(g, 1);
    return (Curve){value, has_radius(x) ? times(g, value, growth(x, u, reach)) : one};
}

Curve curve_exp2(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g    = x->graph;
    Node   one  = graph_number(g, 1);
    u           = scale_term(x, u.value, u, graph_number(g, M_LN2));
    reach       = has_radius(x) ? times(g, reach, graph_number(g, M_LN2)) : reach;
    Curve curve = {times(g, value, graph_number(g, M_LN2)), one};
    if (has_radius(x)) {
        Node factor = graph_number(g, M_LN2 * M_LN2);
        curve.bend  = times(g, times(g, value, growth(x, u, reach)), factor);
    }
    return curve;
}

/* The bend of both is that of the steeper. */
static Node bend_of_cosh(BallContext *x, BallTerm u, Node cosh, Node reach)
{
    Graph *g = x->graph;
    return has_radius(x) ? times(g, cosh, growth(x, u, reach)) : graph_number(g, 1);
}

Curve curve_sinh(BallContext *x, BallTerm u, Node value, Node reach)
{
    (void)value;
    Node cosh = graph_op1(x->graph, OP_cosh, u.value);
    return (Curve){cosh, bend_of_cosh(x, u, cosh, reach)};
}

Curve curve_cosh(BallContext *x, BallTerm u, Node value, Node reach)
{
    (void)value;
    Node cosh  = graph_op1(x->graph, OP_cosh, u.value);
    Node slope = graph_op1(x->graph, OP_sinh, u.value);
    return (Curve){slope, bend_of_cosh(x, u, cosh, reach)};
}

Curve curve_log(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value;
    Node  near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Node  least = at_least(g, u.value, TINY), one = graph_number(g, 1);
    Curve curve = {.slope = over(g, one, least)};
    if (has_radius(x))
        curve.bend = over(g, one, times(g, near, near));
    return curve;
}

Curve curve_sqrt(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Node   least = at_least(g, value, TINY);
    Curve  curve = {.slope = over(g, graph_number(g, 0.5), least)};
    if (has_radius(x)) {
        Node power = times(g, near, graph_op1(g, OP_sqrt, near));
        curve.bend = over(g, graph_number(g, 0.25), power);
    }
    return curve;
}

Curve curve_inversesqrt(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Node   half  = graph_number(g, -0.5);
    Curve  curve = {.slope = times(g, times(g, times(g, value, value), value), half)};
    if (has_radius(x)) {
        Node root  = graph_op1(g, OP_inversesqrt, near);
        Node fifth = times(g, graph_op1(g, OP_square, times(g, root, root)), root);
        curve.bend = times(g, fifth, graph_number(g, 0.75));
    }
    return curve;
}

Curve curve_inverse(BallContext *x, BallTerm u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Curve  curve = {.slope = neg(g, times(g, value, value))};
    if (has_radius(x)) {
        Node cube  = times(g, times(g, near, near), near);
        curve.bend = over(g, graph_number(g, 2), cube);
    }
    return curve;
}

BallTerm bend_term(const BallContext *x, Node value, BallTerm u, Curve curve)
{
    Graph   *g    = x->graph;
    BallTerm term = scale_term(x, value, u, curve.slope);
    if (has_radius(x)) {
        Node square = graph_op1(g, OP_square, steepness(x, &u));
        Node rest   = times(g, times(g, curve.bend, graph_number(g, 0.5)), square);
        term.second = plus(g, term.second, rest);
    }
    return term;
}

BallTerm curved_term(BallContext *x, CurveOf *curve_of, Node value, BallTerm u)
{
    Graph *g     = x->graph;
    Node   reach = has_radius(x) ? times(g, steepness(x, &u), x->radius) : NODE_NONE;
    return bend_term(x, value, u, curve_of(x, u, value, reach));
}

/* Makes the term of |u|^n for a constant n >= 2, which has no kink at 0: M = n (n - 1) (|u| +
   reach)^(n - 2). */
BallTerm even_power_term(BallContext *x, Node value, BallTerm u, double n)
{
    Graph *g     = x->graph;
    Node   least = at_least(g, graph_op1(g, OP_square, u.value), TINY);
    Node   ratio = over(g, times(g, value, u.value), least);
    Curve  curve = {times(g, ratio, graph_number(g, n)), NODE_NONE};
    if (has_radius(x)) {
        Node reach = times(g, steepness(x, &u), x->radius);
        Node most  = at_least(g, plus(g, graph_op1(g, OP_abs, u.value), reach), TINY);
        Node power = graph_power(g, most, graph_number(g, n - 2));
        curve.bend = times(g, power, graph_number(g, n * (n - 1)));
    }
    return bend_term(x, value, u, curve);
}

/*
 * Makes the term of u^n for another constant n, u >= 0.  For n between 1 and 2 it is that of u -
 * reach, while this is more than u / 2; nearer to 0 the derivative is within n |h|^(n - 1) of what
 * it is at u, and the tail at most |h|^n <= reach^(n - 1) |h|.
 */
BallTerm power_term(BallContext *x, Node value, BallTerm u, double n)
{
    Graph *g     = x->graph;
    Node   base  = at_least(g, u.value, TINY), reach;
    Curve  curve = {over(g, times(g, value, graph_number(g, n)), base), NODE_NONE};
    if (!has_radius(x))
        return bend_term(x, value, u, curve);
    reach       = times(g, steepness(x, &u), x->radius);
    Node factor = graph_number(g, fabs(n * (n - 1))), exponent = graph_number(g, n - 2);
    if (n <= 1) {
        Node least = clear_of_zero(x, u, &reach);
        curve.bend = times(g, factor, graph_power(g, least, exponent));
        return bend_term(x, value, u, curve);
    }
    Node clear = graph_op2(g, OP_less, times(g, reach, graph_number(g, 2)), u.value);
    Node least = graph_op3(g, OP_select, clear, sub(g, u.value, reach), reach);
    Node power = graph_power(g, at_least(g, least, TINY), exponent), zero = graph_number(g, 0);
    curve.bend     = graph_op3(g, OP_select, clear, times(g, factor, power), zero);
    BallTerm term  = bend_term(x, value, u, curve);
    Node     steep = steepness(x, &u), rise = times(g, times(g, reach, power), steep);
    term.first = plus(g, term.first, graph_op3(g, OP_select, clear, zero, rise));
    return term;
}
