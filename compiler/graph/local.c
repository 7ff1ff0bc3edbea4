/*
 * local.c: how fast an expression can change near a point.
 *
 * Every number u of the formula is known in the ball of a trial radius R around the point p by
 *     |u(p + h) - u(p) - g.h| <= first |h| + second |h|^2,     |h| <= R,
 * g its gradient at p, exact where there is one, else 0.  So its slope in the ball is at most
 * steep = |g| + first + second R.  One rule for each kind of operation:
 *   products: (a + da)(b + db) leaves a tail of b, b tail of a, and da db <= steep steep |h|^2;
 *   smooth functions: f'(u) tail of u, and M du^2 / 2, M the largest |f''| within steep R of u;
 *   max(w, 0), and with it abs, min and clamp: what reaches over the kink, steep |h| - |w|, which
 *     for |h| <= R is at most |h| (steep - |w| / R);
 *   everything else, noise for one: its slope over the box, as `first`.
 * Where f'' has a pole, M holds half the way there, and the radius ends there.
 */
#include "compiler/graph/local.h"

#include <math.h>

#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/parity.h"

/* A number in the ball. */
typedef struct Part {
    Node value, gradient, first, second;
    Node steep; /* slope in the ball, where more is known than the others say, or NODE_NONE */
} Part;

typedef struct Parts {
    uint32_t count;
    Part    *items;
} Parts;

typedef struct Nearby {
    Graph *graph;
    Arena *scratch;
    Box    box;
    Node   radius; /* NODE_NONE: gradients only, and slopes without what needs a radius */
    Node   limit;  /* the radius ends there as well */
    bool   bounded;
} Nearby;

/* Keeps quotients finite; what is smaller has no digits left in single precision. */
static const double TINY = 1e-30, SMALL = 1e-6;

/* How many parts the box is cut into for what has no rule. */
enum { CELLS = 256 };

/* ---- parts ---- */

static bool has_radius(const Nearby *x) { return x->radius != NODE_NONE; }

static Part still_part(const Nearby *x, Node value)
{
    Graph *g    = x->graph;
    Node   zero = graph_number(g, 0);
    return (Part){value, graph_vec3(g, 0, 0, 0), zero, zero, NODE_NONE};
}

/* Slope at the point. */
static Node slope_here(const Nearby *x, const Part *a)
{
    Graph *g = x->graph;
    return plus(g, graph_op1(g, OP_length, a->gradient), a->first);
}

/* Slope in the ball. */
static Node steepness(const Nearby *x, const Part *a)
{
    Graph *g = x->graph;
    if (a->steep != NODE_NONE)
        return a->steep;
    Node here = slope_here(x, a);
    return has_radius(x) ? plus(g, here, times(g, a->second, x->radius)) : here;
}

/* Of which nothing is known but its slope over the box. */
static Part opaque_part(Nearby *x, Node value)
{
    Graph *g     = x->graph;
    Part   part  = still_part(x, value);
    double slope = graph_slope(g, value, x->box, NULL, CELLS, NULL, x->scratch);
    x->bounded   = x->bounded && isfinite(slope);
    part.first   = graph_number(g, isfinite(slope) ? slope : 0);
    return part;
}

static Part add_parts(const Nearby *x, Node value, Part a, Part b)
{
    Graph *g = x->graph;
    return (Part){value, plus(g, a.gradient, b.gradient), plus(g, a.first, b.first),
                  plus(g, a.second, b.second), NODE_NONE};
}

static Part negate_part(const Nearby *x, Node value, Part a)
{
    Graph *g = x->graph;
    return (Part){value, neg(g, a.gradient), a.first, a.second, a.steep};
}

/* `factor` times the part, for a rule that adds the rest. */
static Part scale_part(const Nearby *x, Node value, Part a, Node factor)
{
    Graph *g    = x->graph;
    Node   size = graph_op1(g, OP_abs, factor);
    return (Part){value, stretch(g, a.gradient, factor), times(g, a.first, size),
                  times(g, a.second, size), NODE_NONE};
}

static Part multiply_parts(const Nearby *x, Node value, Part a, Part b)
{
    Graph *g       = x->graph;
    Part   first   = scale_part(x, value, a, b.value);
    Part   second  = scale_part(x, value, b, a.value);
    Part   product = add_parts(x, value, first, second);
    if (has_radius(x)) {
        Node both      = times(g, steepness(x, &a), steepness(x, &b));
        product.second = plus(g, product.second, both);
    }
    return product;
}

/* ---- smooth functions of one number ---- */

/* f'(u) and M, from u, f(u) and how far u may go in the ball. */
typedef struct Curve {
    Node slope, bend;
} Curve;

/* |u|, from which the poles at 0 are no more than half as far away as the ball may reach. */
static Node clear_of_zero(Nearby *x, Part u, Node *reach)
{
    Graph *g    = x->graph;
    Node   size = at_least(g, graph_op1(g, OP_abs, u.value), SMALL),
         half   = times(g, size, graph_number(g, 0.5));
    Node room   = over(g, times(g, graph_op1(g, OP_abs, u.value), graph_number(g, 0.5)),
                       at_least(g, steepness(x, &u), TINY));
    x->limit    = x->limit == NODE_NONE ? room : graph_op2(g, OP_min, x->limit, room);
    *reach      = graph_op2(g, OP_min, *reach, half);
    return sub(g, size, *reach);
}

/* e^reach - 1 over the ball, of which no more is used than reaches by 1. */
static Node growth(Nearby *x, Part u, Node reach)
{
    Graph *g    = x->graph;
    Node   one  = graph_number(g, 1);
    Node   room = over(g, one, at_least(g, steepness(x, &u), TINY));
    x->limit    = x->limit == NODE_NONE ? room : graph_op2(g, OP_min, x->limit, room);
    reach       = graph_op2(g, OP_min, reach, one);
    return plus(g, one, times(g, reach, graph_number(g, 1.7183)));
}

typedef Curve CurveOf(Nearby *x, Part u, Node value, Node reach);

static Curve curve_square(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    return (Curve){times(g, u.value, graph_number(g, 2)), graph_number(g, 2)};
}

static Curve curve_sin(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){graph_op1(g, OP_cos, u.value), one};
}

static Curve curve_cos(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){neg(g, graph_op1(g, OP_sin, u.value)), one};
}

static Curve curve_atan(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){over(g, one, plus(g, one, graph_op1(g, OP_square, u.value))),
                   graph_number(g, 0.6496)};
}

static Curve curve_tanh(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)u, (void)reach;
    Node one = graph_number(g, 1);
    return (Curve){sub(g, one, graph_op1(g, OP_square, value)), graph_number(g, 0.7699)};
}

static Curve curve_exp(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g   = x->graph;
    Node   one = graph_number(g, 1);
    return (Curve){value, has_radius(x) ? times(g, value, growth(x, u, reach)) : one};
}

static Curve curve_exp2(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g   = x->graph;
    Node   one = graph_number(g, 1);
    u          = scale_part(x, u.value, u, graph_number(g, M_LN2));
    reach      = has_radius(x) ? times(g, reach, graph_number(g, M_LN2)) : reach;
    return (Curve){times(g, value, graph_number(g, M_LN2)),
                   has_radius(x) ? times(g, times(g, value, growth(x, u, reach)),
                                         graph_number(g, M_LN2 * M_LN2))
                                 : one};
}

/* The bend of both is that of the steeper. */
static Node bend_of_cosh(Nearby *x, Part u, Node cosh, Node reach)
{
    Graph *g = x->graph;
    return has_radius(x) ? times(g, cosh, growth(x, u, reach)) : graph_number(g, 1);
}

static Curve curve_sinh(Nearby *x, Part u, Node value, Node reach)
{
    (void)value;
    Node cosh = graph_op1(x->graph, OP_cosh, u.value);
    return (Curve){cosh, bend_of_cosh(x, u, cosh, reach)};
}

static Curve curve_cosh(Nearby *x, Part u, Node value, Node reach)
{
    (void)value;
    Node cosh  = graph_op1(x->graph, OP_cosh, u.value);
    Node slope = graph_op1(x->graph, OP_sinh, u.value);
    return (Curve){slope, bend_of_cosh(x, u, cosh, reach)};
}

static Curve curve_log(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g = x->graph;
    (void)value;
    Node  near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Curve curve = {.slope = over(g, graph_number(g, 1), at_least(g, u.value, TINY))};
    if (has_radius(x))
        curve.bend = over(g, graph_number(g, 1), times(g, near, near));
    return curve;
}

static Curve curve_sqrt(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Curve  curve = {.slope = over(g, graph_number(g, 0.5), at_least(g, value, TINY))};
    if (has_radius(x)) {
        Node root  = graph_op1(g, OP_sqrt, near);
        curve.bend = over(g, graph_number(g, 0.25), times(g, near, root));
    }
    return curve;
}

static Curve curve_inversesqrt(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Curve  curve = {
         .slope = times(g, times(g, times(g, value, value), value), graph_number(g, -0.5))};
    if (has_radius(x)) {
        Node root  = graph_op1(g, OP_inversesqrt, near);
        Node fifth = times(g, graph_op1(g, OP_square, times(g, root, root)), root);
        curve.bend = times(g, fifth, graph_number(g, 0.75));
    }
    return curve;
}

/* 1 / u */
static Curve curve_inverse(Nearby *x, Part u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    Curve  curve = {.slope = neg(g, times(g, value, value))};
    if (has_radius(x))
        curve.bend = over(g, graph_number(g, 2), times(g, times(g, near, near), near));
    return curve;
}

static Part bend_part(const Nearby *x, Node value, Part u, Curve curve)
{
    Graph *g    = x->graph;
    Part   part = scale_part(x, value, u, curve.slope);
    if (has_radius(x)) {
        Node square = graph_op1(g, OP_square, steepness(x, &u));
        Node rest   = times(g, times(g, curve.bend, graph_number(g, 0.5)), square);
        part.second = plus(g, part.second, rest);
    }
    return part;
}

static Part curved_part(Nearby *x, CurveOf *curve_of, Node value, Part u)
{
    Graph *g     = x->graph;
    Node   reach = has_radius(x) ? times(g, steepness(x, &u), x->radius) : NODE_NONE;
    return bend_part(x, value, u, curve_of(x, u, value, reach));
}

/* |u|^n for a constant n >= 2, which has no kink at 0: M = n (n - 1) (|u| + reach)^(n - 2). */
static Part even_power_part(Nearby *x, Node value, Part u, double n)
{
    Graph *g     = x->graph;
    Node   least = at_least(g, graph_op1(g, OP_square, u.value), TINY);
    Node   share = over(g, times(g, value, u.value), least);
    Curve  curve = {times(g, share, graph_number(g, n)), NODE_NONE};
    if (has_radius(x)) {
        Node reach = times(g, steepness(x, &u), x->radius);
        Node most  = at_least(g, plus(g, graph_op1(g, OP_abs, u.value), reach), TINY);
        Node power = graph_power(g, most, graph_number(g, n - 2));
        curve.bend = times(g, power, graph_number(g, n * (n - 1)));
    }
    return bend_part(x, value, u, curve);
}

/*
 * u^n for another constant n, u >= 0.  For n between 1
 * and 2 it is that of u - reach, while this is more than u / 2; nearer to 0 the derivative is
 * within n |h|^(n - 1) of what it is at u, and the tail at most |h|^n <= reach^(n - 1) |h|.
 */
static Part power_part(Nearby *x, Node value, Part u, double n)
{
    Graph *g     = x->graph;
    Node   base  = at_least(g, u.value, TINY), reach;
    Curve  curve = {over(g, times(g, value, graph_number(g, n)), base), NODE_NONE};
    if (!has_radius(x))
        return bend_part(x, value, u, curve);
    reach       = times(g, steepness(x, &u), x->radius);
    Node factor = graph_number(g, fabs(n * (n - 1))), exponent = graph_number(g, n - 2);
    if (n <= 1) {
        Node least = clear_of_zero(x, u, &reach);
        curve.bend = times(g, factor, graph_power(g, least, exponent));
        return bend_part(x, value, u, curve);
    }
    Node clear = graph_op2(g, OP_less, times(g, reach, graph_number(g, 2)), u.value);
    Node least = graph_op3(g, OP_select, clear, sub(g, u.value, reach), reach);
    Node power = graph_power(g, at_least(g, least, TINY), exponent), zero = graph_number(g, 0);
    curve.bend = graph_op3(g, OP_select, clear, times(g, factor, power), zero);
    Part part  = bend_part(x, value, u, curve);
    Node rise  = times(g, times(g, reach, power), steepness(x, &u));
    part.first = plus(g, part.first, graph_op3(g, OP_select, clear, zero, rise));
    return part;
}

/* ---- kinks ---- */

/* How much steeper what has a kink at w = 0 may be than on this side of it. */
static Node over_kink(const Nearby *x, Node w, Node steep)
{
    Graph *g    = x->graph;
    Node   zero = graph_number(g, 0);
    if (!has_radius(x))
        return zero;
    Node room = over(g, graph_op1(g, OP_abs, w), at_least(g, x->radius, TINY));
    return graph_op2(g, OP_max, sub(g, steep, room), zero);
}

static Part size_part(const Nearby *x, Node value, Part u)
{
    Graph *g      = x->graph;
    Part   part   = u;
    Node   sign   = graph_op2(g, OP_less, u.value, graph_number(g, 0));
    part.value    = value;
    part.gradient = graph_op3(g, OP_select, sign, neg(g, u.gradient), u.gradient);
    Node more     = over_kink(x, u.value, steepness(x, &u));
    part.first    = plus(g, part.first, times(g, more, graph_number(g, 2)));
    return part;
}

/* Between edges that are known: t^2 (3 - 2 t), t = (u - low) / (high - low) within 0 and 1.  Its
   second derivative by t is at most 6, and 0 where t does not come within 0 and 1. */
static Part smoothstep_part(Nearby *x, Node value, Node low, Node high, Part u)
{
    Graph      *g = x->graph;
    const Expr *a = &g->items[low], *b = &g->items[high];
    if (a->op != OP_CONSTANT || b->op != OP_CONSTANT || !(a->number[0] < b->number[0]))
        return opaque_part(x, value);
    Node  whole = graph_number(g, 1 / (b->number[0] - a->number[0])), half = graph_number(g, 0.5);
    Node  across = times(g, sub(g, u.value, low), whole), zero = graph_number(g, 0);
    Node  t      = graph_op3(g, OP_clamp, across, zero, graph_number(g, 1));
    Curve curve  = {times(g, times(g, t, sub(g, graph_number(g, 1), t)), graph_number(g, 6)),
                    NODE_NONE};
    Part  scaled = scale_part(x, across, u, whole);
    if (has_radius(x)) {
        Node reach = times(g, steepness(x, &scaled), x->radius);
        Node away  = sub(g, graph_op1(g, OP_abs, sub(g, across, half)), half);
        Node level = graph_op2(g, OP_less, reach, away);
        curve.bend = graph_op3(g, OP_select, level, zero, graph_number(g, 6));
    }
    return bend_part(x, value, scaled, curve);
}

static Node choose(const Nearby *x, Node which, Node a, Node b)
{
    return a == b ? a : graph_op3(x->graph, OP_select, which, a, b);
}

/* min and max. */
static Part choice_part(const Nearby *x, Op op, Node value, Part a, Part b)
{
    Graph *g     = x->graph;
    Node   less  = graph_op2(g, OP_less, a.value, b.value);
    Node   apart = sub(g, a.value, b.value);
    Part   left = op == OP_min ? a : b, right = op == OP_min ? b : a;
    Part   away   = add_parts(x, apart, a, negate_part(x, b.value, b));
    Part   chosen = {value, choose(x, less, left.gradient, right.gradient),
                     choose(x, less, left.first, right.first),
                     choose(x, less, left.second, right.second), NODE_NONE};
    chosen.first  = plus(g, chosen.first, over_kink(x, apart, steepness(x, &away)));
    return chosen;
}

/* ---- vectors ---- */

static Parts new_parts(const Nearby *x, uint32_t count)
{
    return (Parts){count, arena_new_array(x->scratch, Part, count)};
}

/* Component i of an operand; a number counts for all components. */
static Part part_of(const Parts *parts, uint32_t i)
{
    return parts->items[parts->count > i ? i : 0];
}

/* The square of a vector's slope in the ball; that of one whose components are linear is known. */
static Node steepness_squared(const Nearby *x, Node vector, const Parts *parts)
{
    Graph *g      = x->graph;
    bool   linear = true;
    Node   sum    = graph_number(g, 0);
    for (uint32_t i = 0; i < parts->count; i++) {
        const Part *part = &parts->items[i];
        linear = linear && graph_is_constant(g, part->gradient) && is_number(g, part->first, 0) &&
                 is_number(g, part->second, 0);
        sum = plus(g, sum, graph_op1(g, OP_square, steepness(x, part)));
    }
    if (!linear)
        return sum;
    double slope = graph_slope(g, vector, x->box, NULL, 1, NULL, x->scratch);
    Node   whole = graph_number(g, slope * slope);
    return isfinite(slope) ? graph_op2(g, OP_min, sum, whole) : sum;
}

/* Sums of products of components; of a vector with itself, the tail is the square of its slope. */
static Part dot_part(const Nearby *x, Node node, const Parts *a, const Parts *b)
{
    Graph     *g    = x->graph;
    const Expr e    = g->items[node];
    bool       same = e.operands[0] == e.operands[1];
    Part       sum  = still_part(x, node);
    for (uint32_t i = 0; i < a->count; i++) {
        Part left = part_of(a, i), right = part_of(b, i);
        if (same) {
            Part half = scale_part(x, node, left, left.value);
            sum       = add_parts(x, node, sum, add_parts(x, node, half, half));
        } else
            sum = add_parts(x, node, sum, multiply_parts(x, node, left, right));
    }
    if (same && has_radius(x))
        sum.second = plus(g, sum.second, steepness_squared(x, e.operands[0], a));
    return sum;
}

/* |v + h| is between |v| + n.h and that and |h|^2 / (2 |v|), n = v / |v|. */
static Part length_part(const Nearby *x, Node node, const Parts *a)
{
    Graph     *g     = x->graph;
    const Expr e     = g->items[node];
    Part       sum   = still_part(x, node);
    Node       least = at_least(g, node, SMALL);
    for (uint32_t i = 0; i < a->count; i++) {
        Part part = part_of(a, i);
        sum       = add_parts(x, node, sum, scale_part(x, node, part, over(g, part.value, least)));
    }
    if (has_radius(x)) {
        Node bend  = over(g, steepness_squared(x, e.operands[0], a), least);
        sum.second = plus(g, sum.second, times(g, bend, graph_number(g, 0.5)));
    }
    return sum;
}

/* ---- any operation ---- */

static Part divide_parts(Nearby *x, Node value, Part a, Part b)
{
    Graph *g       = x->graph;
    Node   inverse = over(g, graph_number(g, 1), b.value);
    if (g->items[b.value].time != TIME_POINT)
        return scale_part(x, value, a, inverse);
    Part turned = curved_part(x, curve_inverse, inverse, b);
    return multiply_parts(x, value, a, turned);
}

static Part mix_parts(Nearby *x, Node value, Part a, Part b, Part t)
{
    Graph *g      = x->graph;
    Part   apart  = add_parts(x, sub(g, b.value, a.value), b, negate_part(x, a.value, a));
    Part   change = multiply_parts(x, value, apart, t);
    return add_parts(x, value, a, change);
}

/* One component of an operation: of what works component by component, a, b and c are the
   components of its operands; operands not all there are filled up with the first. */
typedef struct Place {
    Expr         e;
    Node         node, value; /* the whole, and the component */
    uint32_t     component;
    const Parts *operands;
    Part         a, b, c;
} Place;

typedef Part Rule(Nearby *x, const Place *p);

static Part local_none(Nearby *x, const Place *p) { return opaque_part(x, p->value); }
static Part local_add(Nearby *x, const Place *p) { return add_parts(x, p->value, p->a, p->b); }
static Part local_neg(Nearby *x, const Place *p) { return negate_part(x, p->value, p->a); }
static Part local_mul(Nearby *x, const Place *p) { return multiply_parts(x, p->value, p->a, p->b); }
static Part local_div(Nearby *x, const Place *p) { return divide_parts(x, p->value, p->a, p->b); }
static Part local_abs(Nearby *x, const Place *p) { return size_part(x, p->value, p->a); }
static Part local_mix(Nearby *x, const Place *p)
{
    return mix_parts(x, p->value, p->a, p->b, p->c);
}
static Part local_dot(Nearby *x, const Place *p)
{
    return dot_part(x, p->node, &p->operands[0], &p->operands[1]);
}
static Part local_length(Nearby *x, const Place *p)
{
    return length_part(x, p->node, &p->operands[0]);
}

static Part local_sub(Nearby *x, const Place *p)
{
    return add_parts(x, p->value, p->a, negate_part(x, p->b.value, p->b));
}

static Part local_choice(Nearby *x, const Place *p)
{
    return choice_part(x, (Op)p->e.op, p->value, p->a, p->b);
}

static Part local_clamp(Nearby *x, const Place *p)
{
    Node raised = graph_op2(x->graph, OP_max, p->a.value, p->b.value);
    Part above  = choice_part(x, OP_max, raised, p->a, p->b);
    return choice_part(x, OP_min, p->value, above, p->c);
}

static Part local_smoothstep(Nearby *x, const Place *p)
{
    return smoothstep_part(x, p->value, p->a.value, p->b.value, p->c);
}

static Part local_pow(Nearby *x, const Place *p)
{
    const Expr *power = &x->graph->items[p->b.value];
    if (power->op != OP_CONSTANT)
        return opaque_part(x, p->value);
    return power->number[0] >= 2 ? even_power_part(x, p->value, p->a, power->number[0])
                                 : power_part(x, p->value, p->a, power->number[0]);
}

#define CURVED(name)                                         \
    static Part local_##name(Nearby *x, const Place *p)      \
    {                                                        \
        return curved_part(x, curve_##name, p->value, p->a); \
    }
CURVED(square)
CURVED(sin)
CURVED(cos)
CURVED(atan)
CURVED(tanh)
CURVED(exp)
CURVED(exp2)
CURVED(sinh)
CURVED(cosh)
CURVED(log)
CURVED(sqrt)
CURVED(inversesqrt)
#undef CURVED

static Part local_component(Nearby *x, const Place *p)
{
    (void)x;
    return part_of(&p->operands[0], p->e.index);
}

/* What builds a vector. */
static Part local_vector(Nearby *x, const Place *p)
{
    (void)x;
    return p->operands[p->e.operand_count > 1 ? p->component : 0].items[0];
}

static Rule *const rules[OP_COUNT] = {
#define RULES(name, cost, promises, simplify, derive, local, ...) [OP_##name] = local,
#include "compiler/graph/ops.def"
};

static void find_operation(Nearby *x, Node node, const Parts *operands, Parts *result)
{
    Place place = {.e = x->graph->items[node], .node = node, .operands = operands};
    int   last  = place.e.operand_count - 1;
    for (uint32_t i = 0; i < result->count; i++) {
        place.value      = graph_component(x->graph, node, i);
        place.component  = i;
        place.a          = part_of(&operands[0], i);
        place.b          = part_of(&operands[last > 0], i);
        place.c          = part_of(&operands[last > 1 ? 2 : 0], i);
        result->items[i] = rules[place.e.op](x, &place);
    }
}

/* Whether an operation does not ask for the sign of what it is applied to. */
static bool is_even(const Graph *g, const Expr *e)
{
    if (e->op != OP_pow)
        return op_parity((Op)e->op) == PARITY_EVEN;
    const Expr *power = &g->items[e->operands[1]];
    return power->op == OP_CONSTANT && power->number[0] >= 2;
}

/* A node whose operands are known. */
static Parts find_node(Nearby *x, Node node, const Tape *tape, const Parts *all)
{
    Expr  e     = x->graph->items[node];
    Parts found = new_parts(x, e.type <= TYPE_VEC4 ? e.type : 1), operands[MAX_OPERANDS];
    for (uint32_t i = 0; e.type <= TYPE_VEC4 && i < found.count; i++) {
        found.items[i] = still_part(x, graph_component(x->graph, node, i));
        if (e.op == OP_POINT)
            found.items[i].gradient = graph_vec3(x->graph, i == 0, i == 1, i == 2);
    }
    if (e.time != TIME_POINT || e.op == OP_POINT || e.type > TYPE_VEC4)
        return found;
    for (int i = 0; i < e.operand_count; i++)
        operands[i] = all[tape_place(tape, e.operands[i])];
    const Expr *inner = &x->graph->items[e.operands[0]];
    if (inner->op == OP_abs && e.op != OP_abs && is_even(x->graph, &e))
        operands[0] = all[tape_place(tape, inner->operands[0])];
    x->graph->here = e.span;
    find_operation(x, node, operands, &found);
    return found;
}

static Part find(Nearby *x, Node root)
{
    Span   here = x->graph->here;
    Tape   tape = tape_new(x->graph, &root, 1, x->scratch);
    Parts *all  = arena_new_array(x->scratch, Parts, tape.count);
    for (size_t i = 0; i < tape.count && x->bounded; i++)
        all[i] = find_node(x, tape.nodes[i], &tape, all);
    x->graph->here = here;
    return x->bounded ? all[tape_place(&tape, root)].items[0] : (Part){0};
}

bool graph_local_bound(Graph *graph, Node root, Box box, double least, LocalBound *bound,
                       Arena *scratch)
{
    Nearby x    = {graph, scratch, box, NODE_NONE, NODE_NONE, true};
    Part   here = find(&x, root);
    if (!x.bounded)
        return false;
    Node slope    = graph_op2(graph, OP_max, slope_here(&x, &here), graph_number(graph, least));
    x.radius      = over(graph, graph_op1(graph, OP_abs, root), slope);
    Part ball     = find(&x, root);
    bound->radius = x.limit == NODE_NONE ? x.radius : graph_op2(graph, OP_min, x.radius, x.limit);
    bound->first  = slope_here(&x, &ball);
    bound->second = ball.second;
    return x.bounded;
}

/* |f| = first r + second r^2. */
Node local_radius(Graph *graph, Node root, const LocalBound *bound)
{
    Node size    = graph_op1(graph, OP_abs, root);
    Node room    = times(graph, times(graph, size, bound->second), graph_number(graph, 4));
    Node squared = plus(graph, graph_op1(graph, OP_square, bound->first), room);
    Node sum     = plus(graph, bound->first, graph_op1(graph, OP_sqrt, squared));
    Node twice   = times(graph, size, graph_number(graph, 2));
    return graph_op2(graph, OP_min, over(graph, twice, at_least(graph, sum, TINY)), bound->radius);
}
