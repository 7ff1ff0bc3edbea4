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

#include "compiler/graph/evaluate.h"

/* A number in the ball. */
typedef struct BallTerm {
    Node value, gradient, first, second;
    Node steep; /* slope in the ball, where more is known than the others say, or NODE_NONE */
} BallTerm;

typedef struct BallTerms {
    uint32_t  count;
    BallTerm *items;
} BallTerms;

typedef struct BallContext {
    Graph *graph;
    Arena *scratch;
    Box    box;
    Node   radius; /* NODE_NONE: gradients only, and slopes without what needs a radius */
    Node   limit;  /* the radius ends there as well */
    bool   bounded;
} BallContext;

/* Keeps quotients finite; what is smaller has no digits left in single precision. */
static const double TINY = 1e-30, SMALL = 1e-6;

/* How many cells the box is cut into for what has no rule. */
enum { CELLS = 256 };

/* ---- arithmetic that leaves out what is 0 or 1 ---- */

static Node number(const BallContext *x, double value) { return graph_number(x->graph, value); }

/* Of a FLOAT or, for 0, of a vector. */
static bool is_number(const BallContext *x, Node node, double value)
{
    const Expr *e    = &x->graph->items[node];
    bool        same = e->op == OP_CONSTANT && (e->type == TYPE_FLOAT || value == 0);
    for (uint32_t i = 0; same && i < (uint32_t)e->type; i++)
        same = e->number[i] == value;
    return same;
}

static Node plus(const BallContext *x, Node a, Node b)
{
    if (is_number(x, a, 0) || is_number(x, b, 0))
        return is_number(x, a, 0) ? b : a;
    return graph_op2(x->graph, OP_add, a, b);
}

static Node times(const BallContext *x, Node a, Node b)
{
    if (is_number(x, a, 0) || is_number(x, b, 1))
        return a;
    if (is_number(x, b, 0) || is_number(x, a, 1))
        return b;
    return a == b ? graph_op1(x->graph, OP_square, a) : graph_op2(x->graph, OP_mul, a, b);
}

/* A vector times a number. */
static Node stretch(const BallContext *x, Node vector, Node by)
{
    if (is_number(x, vector, 0) || is_number(x, by, 1))
        return vector;
    return is_number(x, by, 0) ? graph_vec3(x->graph, 0, 0, 0)
                               : graph_op2(x->graph, OP_scale, vector, by);
}

static Node minus(const BallContext *x, Node a, Node b)
{
    return graph_op2(x->graph, OP_sub, a, b);
}
static Node over(const BallContext *x, Node a, Node b) { return graph_op2(x->graph, OP_div, a, b); }
static Node negative(const BallContext *x, Node a) { return graph_op1(x->graph, OP_neg, a); }
static Node size_of(const BallContext *x, Node a) { return graph_op1(x->graph, OP_abs, a); }

static Node at_least(const BallContext *x, Node node, double least)
{
    return graph_op2(x->graph, OP_max, node, number(x, least));
}

/* ---- terms ---- */

static bool has_radius(const BallContext *x) { return x->radius != NODE_NONE; }

static BallTerm constant_term(const BallContext *x, Node value)
{
    Node zero = number(x, 0);
    return (BallTerm){value, graph_vec3(x->graph, 0, 0, 0), zero, zero, NODE_NONE};
}

/* Slope at the point. */
static Node slope_here(const BallContext *x, const BallTerm *a)
{
    return plus(x, graph_op1(x->graph, OP_length, a->gradient), a->first);
}

/* Slope in the ball. */
static Node steepness(const BallContext *x, const BallTerm *a)
{
    if (a->steep != NODE_NONE)
        return a->steep;
    Node here = slope_here(x, a);
    return has_radius(x) ? plus(x, here, times(x, a->second, x->radius)) : here;
}

/* Of which nothing is known but its slope over the box. */
static BallTerm opaque_term(BallContext *x, Node value)
{
    BallTerm term  = constant_term(x, value);
    double   slope = graph_slope(x->graph, value, x->box, NULL, CELLS, NULL, x->scratch);
    x->bounded     = x->bounded && isfinite(slope);
    term.first     = number(x, isfinite(slope) ? slope : 0);
    return term;
}

static BallTerm add_terms(const BallContext *x, Node value, BallTerm a, BallTerm b)
{
    return (BallTerm){value, plus(x, a.gradient, b.gradient), plus(x, a.first, b.first),
                      plus(x, a.second, b.second), NODE_NONE};
}

static BallTerm negate_term(const BallContext *x, Node value, BallTerm a)
{
    return (BallTerm){value, negative(x, a.gradient), a.first, a.second, a.steep};
}

/* `factor` times the term, for a rule that adds the rest. */
static BallTerm scale_term(const BallContext *x, Node value, BallTerm a, Node factor)
{
    Node size = size_of(x, factor);
    return (BallTerm){value, stretch(x, a.gradient, factor), times(x, a.first, size),
                      times(x, a.second, size), NODE_NONE};
}

static BallTerm multiply_terms(const BallContext *x, Node value, BallTerm a, BallTerm b)
{
    BallTerm first   = scale_term(x, value, a, b.value);
    BallTerm second  = scale_term(x, value, b, a.value);
    BallTerm product = add_terms(x, value, first, second);
    if (has_radius(x)) {
        Node both      = times(x, steepness(x, &a), steepness(x, &b));
        product.second = plus(x, product.second, both);
    }
    return product;
}

/* ---- smooth functions of one number ---- */

/* f'(u) and M, from u, f(u) and how far u may go in the ball. */
typedef struct Curve {
    Node slope, bend;
} Curve;

/* |u|, from which the poles at 0 are no more than half as far away as the ball may reach. */
static Node clear_of_zero(BallContext *x, BallTerm u, Node *reach)
{
    Graph *g    = x->graph;
    Node   size = at_least(x, size_of(x, u.value), SMALL), half = times(x, size, number(x, 0.5));
    Node   margin = over(x, times(x, size_of(x, u.value), number(x, 0.5)),
                         at_least(x, steepness(x, &u), TINY));
    x->limit      = x->limit == NODE_NONE ? margin : graph_op2(g, OP_min, x->limit, margin);
    *reach        = graph_op2(g, OP_min, *reach, half);
    return minus(x, size, *reach);
}

/* e^reach - 1 over the ball, of which no more is used than reaches by 1. */
static Node growth(BallContext *x, BallTerm u, Node reach)
{
    Graph *g      = x->graph;
    Node   one    = number(x, 1);
    Node   margin = over(x, one, at_least(x, steepness(x, &u), TINY));
    x->limit      = x->limit == NODE_NONE ? margin : graph_op2(g, OP_min, x->limit, margin);
    reach         = graph_op2(g, OP_min, reach, one);
    return plus(x, one, times(x, reach, number(x, 1.7183)));
}

static Curve curve_of_pole(BallContext *x, Op op, BallTerm u, Node value, Node reach)
{
    Graph *g     = x->graph;
    Curve  curve = {0};
    Node   near  = has_radius(x) ? clear_of_zero(x, u, &reach) : NODE_NONE;
    switch (op) {
    case OP_log:
        curve.slope = over(x, number(x, 1), at_least(x, u.value, TINY));
        if (has_radius(x))
            curve.bend = over(x, number(x, 1), times(x, near, near));
        break;
    case OP_sqrt:
        curve.slope = over(x, number(x, 0.5), at_least(x, value, TINY));
        if (has_radius(x))
            curve.bend = over(x, number(x, 0.25), times(x, near, graph_op1(g, OP_sqrt, near)));
        break;
    case OP_inversesqrt: {
        curve.slope = times(x, times(x, times(x, value, value), value), number(x, -0.5));
        if (has_radius(x)) {
            Node root  = graph_op1(g, OP_inversesqrt, near);
            Node fifth = times(x, graph_op1(g, OP_square, times(x, root, root)), root);
            curve.bend = times(x, fifth, number(x, 0.75));
        }
        break;
    }
    default: { /* 1 / u */
        curve.slope = negative(x, times(x, value, value));
        if (has_radius(x))
            curve.bend = over(x, number(x, 2), times(x, times(x, near, near), near));
        break;
    }
    }
    return curve;
}

static Curve curve_of(BallContext *x, Op op, BallTerm u, Node value, Node reach)
{
    Graph *g   = x->graph;
    Node   one = number(x, 1);
    switch (op) {
    case OP_square: return (Curve){times(x, u.value, number(x, 2)), number(x, 2)};
    case OP_sin: return (Curve){graph_op1(g, OP_cos, u.value), one};
    case OP_cos: return (Curve){negative(x, graph_op1(g, OP_sin, u.value)), one};
    case OP_atan:
        return (Curve){over(x, one, plus(x, one, graph_op1(g, OP_square, u.value))),
                       number(x, 0.6496)};
    case OP_tanh: return (Curve){minus(x, one, graph_op1(g, OP_square, value)), number(x, 0.7699)};
    case OP_exp: return (Curve){value, has_radius(x) ? times(x, value, growth(x, u, reach)) : one};
    case OP_exp2:
        u     = scale_term(x, u.value, u, number(x, M_LN2));
        reach = has_radius(x) ? times(x, reach, number(x, M_LN2)) : reach;
        return (Curve){
            times(x, value, number(x, M_LN2)),
            has_radius(x) ? times(x, times(x, value, growth(x, u, reach)), number(x, M_LN2 * M_LN2))
                          : one};
    case OP_sinh:
    case OP_cosh: {
        Node cosh  = graph_op1(g, OP_cosh, u.value);
        Node slope = op == OP_sinh ? cosh : graph_op1(g, OP_sinh, u.value);
        return (Curve){slope, has_radius(x) ? times(x, cosh, growth(x, u, reach)) : one};
    }
    default: return curve_of_pole(x, op, u, value, reach);
    }
}

static BallTerm bend_term(const BallContext *x, Node value, BallTerm u, Curve curve)
{
    BallTerm term = scale_term(x, value, u, curve.slope);
    if (has_radius(x)) {
        Node square = graph_op1(x->graph, OP_square, steepness(x, &u));
        Node rest   = times(x, times(x, curve.bend, number(x, 0.5)), square);
        term.second = plus(x, term.second, rest);
    }
    return term;
}

static BallTerm curved_term(BallContext *x, Op op, Node value, BallTerm u)
{
    Node reach = has_radius(x) ? times(x, steepness(x, &u), x->radius) : NODE_NONE;
    return bend_term(x, value, u, curve_of(x, op, u, value, reach));
}

/* |u|^n for a constant n >= 2, which has no kink at 0: M = n (n - 1) (|u| + reach)^(n - 2). */
static BallTerm even_power_term(BallContext *x, Node value, BallTerm u, double n)
{
    Graph *g     = x->graph;
    Node   least = at_least(x, graph_op1(g, OP_square, u.value), TINY);
    Node   ratio = over(x, times(x, value, u.value), least);
    Curve  curve = {times(x, ratio, number(x, n)), NODE_NONE};
    if (has_radius(x)) {
        Node reach = times(x, steepness(x, &u), x->radius);
        Node most  = at_least(x, plus(x, size_of(x, u.value), reach), TINY);
        Node power = graph_power(g, most, number(x, n - 2));
        curve.bend = times(x, power, number(x, n * (n - 1)));
    }
    return bend_term(x, value, u, curve);
}

/*
 * u^n for another constant n, u >= 0.  For n between 1
 * and 2 it is that of u - reach, while this is more than u / 2; nearer to 0 the derivative is
 * within n |h|^(n - 1) of what it is at u, and the tail at most |h|^n <= reach^(n - 1) |h|.
 */
static BallTerm power_term(BallContext *x, Node value, BallTerm u, double n)
{
    Graph *g     = x->graph;
    Node   base  = at_least(x, u.value, TINY), reach;
    Curve  curve = {over(x, times(x, value, number(x, n)), base), NODE_NONE};
    if (!has_radius(x))
        return bend_term(x, value, u, curve);
    reach       = times(x, steepness(x, &u), x->radius);
    Node factor = number(x, fabs(n * (n - 1))), exponent = number(x, n - 2);
    if (n <= 1) {
        Node least = clear_of_zero(x, u, &reach);
        curve.bend = times(x, factor, graph_power(g, least, exponent));
        return bend_term(x, value, u, curve);
    }
    Node clear = graph_op2(g, OP_less, times(x, reach, number(x, 2)), u.value);
    Node least = graph_op3(g, OP_select, clear, minus(x, u.value, reach), reach);
    Node power = graph_power(g, at_least(x, least, TINY), exponent), zero = number(x, 0);
    curve.bend    = graph_op3(g, OP_select, clear, times(x, factor, power), zero);
    BallTerm term = bend_term(x, value, u, curve);
    Node     rise = times(x, times(x, reach, power), steepness(x, &u));
    term.first    = plus(x, term.first, graph_op3(g, OP_select, clear, zero, rise));
    return term;
}

/* ---- kinks ---- */

/* How much steeper what has a kink at w = 0 may be than on this side of it. */
static Node over_kink(const BallContext *x, Node w, Node steep)
{
    Node zero = number(x, 0);
    if (!has_radius(x))
        return zero;
    Node margin = over(x, size_of(x, w), at_least(x, x->radius, TINY));
    return graph_op2(x->graph, OP_max, minus(x, steep, margin), zero);
}

static BallTerm size_term(const BallContext *x, Node value, BallTerm u)
{
    Graph   *g    = x->graph;
    BallTerm term = u;
    Node     sign = graph_op2(g, OP_less, u.value, number(x, 0));
    term.value    = value;
    term.gradient = graph_op3(g, OP_select, sign, negative(x, u.gradient), u.gradient);
    Node more     = over_kink(x, u.value, steepness(x, &u));
    term.first    = plus(x, term.first, times(x, more, number(x, 2)));
    return term;
}

/* Between edges that are known: t^2 (3 - 2 t), t = (u - low) / (high - low) within 0 and 1.  Its
   second derivative by t is at most 6, and 0 where t does not come within 0 and 1. */
static BallTerm smoothstep_term(BallContext *x, Node value, Node low, Node high, BallTerm u)
{
    Graph      *g = x->graph;
    const Expr *a = &g->items[low], *b = &g->items[high];
    if (a->op != OP_CONSTANT || b->op != OP_CONSTANT || !(a->number[0] < b->number[0]))
        return opaque_term(x, value);
    Node     whole = number(x, 1 / (b->number[0] - a->number[0])), half = number(x, 0.5);
    Node     across = times(x, minus(x, u.value, low), whole), zero = number(x, 0);
    Node     t      = graph_op3(g, OP_clamp, across, zero, number(x, 1));
    Curve    curve  = {times(x, times(x, t, minus(x, number(x, 1), t)), number(x, 6)), NODE_NONE};
    BallTerm scaled = scale_term(x, across, u, whole);
    if (has_radius(x)) {
        Node reach  = times(x, steepness(x, &scaled), x->radius);
        Node offset = minus(x, size_of(x, minus(x, across, half)), half);
        Node level  = graph_op2(g, OP_less, reach, offset);
        curve.bend  = graph_op3(g, OP_select, level, zero, number(x, 6));
    }
    return bend_term(x, value, scaled, curve);
}

static Node choose(const BallContext *x, Node which, Node a, Node b)
{
    return a == b ? a : graph_op3(x->graph, OP_select, which, a, b);
}

/* min and max. */
static BallTerm choice_term(const BallContext *x, Op op, Node value, BallTerm a, BallTerm b)
{
    Graph   *g          = x->graph;
    Node     less       = graph_op2(g, OP_less, a.value, b.value);
    Node     difference = minus(x, a.value, b.value);
    BallTerm left = op == OP_min ? a : b, right = op == OP_min ? b : a;
    BallTerm offset = add_terms(x, difference, a, negate_term(x, b.value, b));
    BallTerm chosen = {value, choose(x, less, left.gradient, right.gradient),
                       choose(x, less, left.first, right.first),
                       choose(x, less, left.second, right.second), NODE_NONE};
    chosen.first    = plus(x, chosen.first, over_kink(x, difference, steepness(x, &offset)));
    return chosen;
}

/* ---- vectors ---- */

static BallTerms new_terms(const BallContext *x, uint32_t count)
{
    return (BallTerms){count, arena_new_array(x->scratch, BallTerm, count)};
}

/* Component i of an operand; a number counts for all components. */
static BallTerm term_of(const BallTerms *terms, uint32_t i)
{
    return terms->items[terms->count > i ? i : 0];
}

/* The square of a vector's slope in the ball; that of one whose components are linear is known. */
static Node steepness_squared(const BallContext *x, Node vector, const BallTerms *terms)
{
    bool linear = true;
    Node sum    = number(x, 0);
    for (uint32_t i = 0; i < terms->count; i++) {
        const BallTerm *term = &terms->items[i];
        linear               = linear && graph_is_constant(x->graph, term->gradient) &&
                 is_number(x, term->first, 0) && is_number(x, term->second, 0);
        sum = plus(x, sum, graph_op1(x->graph, OP_square, steepness(x, term)));
    }
    if (!linear)
        return sum;
    double slope = graph_slope(x->graph, vector, x->box, NULL, 1, NULL, x->scratch);
    Node   whole = number(x, slope * slope);
    return isfinite(slope) ? graph_op2(x->graph, OP_min, sum, whole) : sum;
}

/* Sums of products of components; of a vector with itself, the tail is the square of its slope. */
static BallTerm dot_term(const BallContext *x, Node node, const BallTerms *a, const BallTerms *b)
{
    const Expr e    = x->graph->items[node];
    bool       same = e.operands[0] == e.operands[1];
    BallTerm   sum  = constant_term(x, node);
    for (uint32_t i = 0; i < a->count; i++) {
        BallTerm left = term_of(a, i), right = term_of(b, i);
        if (same) {
            BallTerm half = scale_term(x, node, left, left.value);
            sum           = add_terms(x, node, sum, add_terms(x, node, half, half));
        } else
            sum = add_terms(x, node, sum, multiply_terms(x, node, left, right));
    }
    if (same && has_radius(x))
        sum.second = plus(x, sum.second, steepness_squared(x, e.operands[0], a));
    return sum;
}

/* |v + h| is between |v| + n.h and that and |h|^2 / (2 |v|), n = v / |v|. */
static BallTerm length_term(const BallContext *x, Node node, const BallTerms *a)
{
    const Expr e     = x->graph->items[node];
    BallTerm   sum   = constant_term(x, node);
    Node       least = at_least(x, node, SMALL);
    for (uint32_t i = 0; i < a->count; i++) {
        BallTerm term = term_of(a, i);
        sum = add_terms(x, node, sum, scale_term(x, node, term, over(x, term.value, least)));
    }
    if (has_radius(x)) {
        Node bend  = over(x, steepness_squared(x, e.operands[0], a), least);
        sum.second = plus(x, sum.second, times(x, bend, number(x, 0.5)));
    }
    return sum;
}

/* ---- any operation ---- */

static bool is_curved(Op op)
{
    switch (op) {
    case OP_square:
    case OP_sin:
    case OP_cos:
    case OP_atan:
    case OP_tanh:
    case OP_exp:
    case OP_exp2:
    case OP_sinh:
    case OP_cosh:
    case OP_log:
    case OP_sqrt:
    case OP_inversesqrt: return true;
    default: return false;
    }
}

static BallTerm divide_terms(BallContext *x, Node value, BallTerm a, BallTerm b)
{
    Graph *g       = x->graph;
    Node   inverse = over(x, number(x, 1), b.value);
    if (g->items[b.value].time != TIME_POINT)
        return scale_term(x, value, a, inverse);
    BallTerm turned = curved_term(x, OP_div, inverse, b);
    return multiply_terms(x, value, a, turned);
}

static BallTerm mix_terms(BallContext *x, Node value, BallTerm a, BallTerm b, BallTerm t)
{
    BallTerm difference = add_terms(x, minus(x, b.value, a.value), b, negate_term(x, a.value, a));
    BallTerm change     = multiply_terms(x, value, difference, t);
    return add_terms(x, value, a, change);
}

/* Component `value` of an operation; operands not all there are filled up with the first. */
static BallTerm component_term(BallContext *x, Op op, Node value, BallTerm a, BallTerm b,
                               BallTerm c)
{
    Graph      *g     = x->graph;
    const Expr *power = &g->items[b.value];
    switch (op) {
    case OP_add: return add_terms(x, value, a, b);
    case OP_sub: return add_terms(x, value, a, negate_term(x, b.value, b));
    case OP_neg: return negate_term(x, value, a);
    case OP_mul:
    case OP_scale: return multiply_terms(x, value, a, b);
    case OP_div: return divide_terms(x, value, a, b);
    case OP_abs: return size_term(x, value, a);
    case OP_min:
    case OP_max: return choice_term(x, op, value, a, b);
    case OP_clamp: {
        Node     raised = graph_op2(g, OP_max, a.value, b.value);
        BallTerm above  = choice_term(x, OP_max, raised, a, b);
        return choice_term(x, OP_min, value, above, c);
    }
    case OP_mix: return mix_terms(x, value, a, b, c);
    case OP_smoothstep: return smoothstep_term(x, value, a.value, b.value, c);
    case OP_pow:
        if (power->op != OP_CONSTANT)
            return opaque_term(x, value);
        return power->number[0] >= 2 ? even_power_term(x, value, a, power->number[0])
                                     : power_term(x, value, a, power->number[0]);
    default: return is_curved(op) ? curved_term(x, op, value, a) : opaque_term(x, value);
    }
}

static bool is_componentwise(Op op)
{
    switch (op) {
    case OP_add:
    case OP_sub:
    case OP_neg:
    case OP_mul:
    case OP_scale:
    case OP_div:
    case OP_abs:
    case OP_min:
    case OP_max:
    case OP_clamp:
    case OP_mix:
    case OP_pow:
    case OP_smoothstep: return true;
    default: return is_curved(op);
    }
}

static void find_operation(BallContext *x, Node node, const BallTerms *operands, BallTerms *result)
{
    Expr e = x->graph->items[node];
    for (uint32_t i = 0; i < result->count; i++) {
        Node      value = graph_component(x->graph, node, i);
        BallTerm *term  = &result->items[i];
        int       last  = e.operand_count - 1;
        switch (e.op) {
        case OP_COMPONENT: *term = term_of(&operands[0], e.index); break;
        case OP_splat2:
        case OP_splat3:
        case OP_splat4: *term = operands[0].items[0]; break;
        case OP_vec2:
        case OP_vec3:
        case OP_vec4: *term = operands[i].items[0]; break;
        case OP_dot: *term = dot_term(x, node, &operands[0], &operands[1]); break;
        case OP_length: *term = length_term(x, node, &operands[0]); break;
        default:
            *term = is_componentwise(e.op)
                        ? component_term(x, e.op, value, term_of(&operands[0], i),
                                         term_of(&operands[last > 0], i),
                                         term_of(&operands[last > 1 ? 2 : 0], i))
                        : opaque_term(x, value);
        }
    }
}

/* Whether an operation does not ask for the sign of what it is applied to. */
static bool is_even(const Graph *g, const Expr *e)
{
    if (e->op != OP_pow)
        return e->op == OP_square || e->op == OP_cos || e->op == OP_cosh;
    const Expr *power = &g->items[e->operands[1]];
    return power->op == OP_CONSTANT && power->number[0] >= 2;
}

/* A node whose operands are known. */
static BallTerms find_node(BallContext *x, Node node, const Tape *tape, const BallTerms *all)
{
    Expr      e     = x->graph->items[node];
    BallTerms found = new_terms(x, e.type <= TYPE_VEC4 ? e.type : 1), operands[MAX_OPERANDS];
    for (uint32_t i = 0; e.type <= TYPE_VEC4 && i < found.count; i++) {
        found.items[i] = constant_term(x, graph_component(x->graph, node, i));
        if (e.op == OP_POINT)
            found.items[i].gradient = graph_vec3(x->graph, i == 0, i == 1, i == 2);
    }
    if (e.time != TIME_POINT || e.op == OP_POINT || e.type > TYPE_VEC4)
        return found;
    for (int i = 0; i < e.operand_count; i++)
        operands[i] = all[tape_index(tape, e.operands[i])];
    const Expr *inner = &x->graph->items[e.operands[0]];
    if (inner->op == OP_abs && is_even(x->graph, &e))
        operands[0] = all[tape_index(tape, inner->operands[0])];
    x->graph->here = e.span;
    find_operation(x, node, operands, &found);
    return found;
}

static BallTerm find(BallContext *x, Node root)
{
    Span       here = x->graph->here;
    Tape       tape = tape_new(x->graph, &root, 1, x->scratch);
    BallTerms *all  = arena_new_array(x->scratch, BallTerms, tape.count);
    for (size_t i = 0; i < tape.count && x->bounded; i++)
        all[i] = find_node(x, tape.nodes[i], &tape, all);
    x->graph->here = here;
    return x->bounded ? all[tape_index(&tape, root)].items[0] : (BallTerm){0};
}

bool graph_local_bound(Graph *graph, Node root, Box box, double least, LocalBound *bound,
                       Arena *scratch)
{
    BallContext x    = {graph, scratch, box, NODE_NONE, NODE_NONE, true};
    BallTerm    here = find(&x, root);
    if (!x.bounded)
        return false;
    Node slope    = graph_op2(graph, OP_max, slope_here(&x, &here), graph_number(graph, least));
    x.radius      = graph_op2(graph, OP_div, size_of(&x, root), slope);
    BallTerm ball = find(&x, root);
    bound->radius = x.limit == NODE_NONE ? x.radius : graph_op2(graph, OP_min, x.radius, x.limit);
    bound->first  = slope_here(&x, &ball);
    bound->second = ball.second;
    return x.bounded;
}

/* |f| = first r + second r^2. */
Node local_radius(Graph *graph, Node root, const LocalBound *bound)
{
    BallContext x       = {.graph = graph};
    Node        size    = size_of(&x, root);
    Node        margin  = times(&x, times(&x, size, bound->second), number(&x, 4));
    Node        squared = plus(&x, graph_op1(graph, OP_square, bound->first), margin);
    Node        sum     = plus(&x, bound->first, graph_op1(graph, OP_sqrt, squared));
    Node        twice   = times(&x, size, number(&x, 2));
    return graph_op2(graph, OP_min, over(&x, twice, at_least(&x, sum, TINY)), bound->radius);
}
