/*
 * local.c: how fast an expression can change near a point.
 *
 * local_terms.c adds and multiplies, local_curves.c has the smooth functions; what has a kink, what
 * is made of vectors and the loop over the nodes are here.
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
#include "compiler/graph/symbolic/local.h"

#include <math.h>

#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/local_curves.h"
#include "compiler/graph/symbolic/parity.h"

typedef struct BallTerms {
    uint32_t  count;
    BallTerm *items;
} BallTerms;

/* ---- kinks ---- */

/* Tells how much steeper what has a kink at w = 0 may be than on this side of it. */
static Node over_kink(const BallContext *x, Node w, Node steep)
{
    Graph *g    = x->graph;
    Node   zero = graph_number(g, 0);
    if (!has_radius(x))
        return zero;
    Node radius = at_least(g, x->radius, TINY);
    Node margin = over(g, graph_op1(g, OP_abs, w), radius);
    return graph_op2(g, OP_max, sub(g, steep, margin), zero);
}

static BallTerm size_term(const BallContext *x, Node value, BallTerm u)
{
    Graph   *g    = x->graph;
    BallTerm term = u;
    Node     sign = graph_op2(g, OP_less, u.value, graph_number(g, 0));
    term.value    = value;
    term.gradient = graph_op3(g, OP_select, sign, neg(g, u.gradient), u.gradient);
    Node more     = over_kink(x, u.value, steepness(x, &u));
    term.first    = plus(g, term.first, times(g, more, graph_number(g, 2)));
    return term;
}

/* Finds the term of a smoothstep between known edges: t^2 (3 - 2 t), t = (u - low) / (high - low)
   within 0 and 1.  Its second derivative by t is at most 6, and 0 where t does not come within 0
   and 1. */
static BallTerm smoothstep_term(BallContext *x, Node value, Node low, Node high, BallTerm u)
{
    Graph      *g = x->graph;
    const Expr *a = &g->items[low], *b = &g->items[high];
    if (a->op != OP_CONSTANT || b->op != OP_CONSTANT || !(a->number[0] < b->number[0]))
        return opaque_term(x, value);
    Node  whole = graph_number(g, 1 / (b->number[0] - a->number[0])), half = graph_number(g, 0.5);
    Node  across = times(g, sub(g, u.value, low), whole), zero = graph_number(g, 0);
    Node  t         = graph_op3(g, OP_clamp, across, zero, graph_number(g, 1));
    Node  six       = graph_number(g, 6);
    Curve curve     = {times(g, times(g, t, sub(g, graph_number(g, 1), t)), six), NODE_NONE};
    BallTerm scaled = scale_term(x, across, u, whole);
    if (has_radius(x)) {
        Node reach  = times(g, steepness(x, &scaled), x->radius);
        Node offset = sub(g, graph_op1(g, OP_abs, sub(g, across, half)), half);
        Node level  = graph_op2(g, OP_less, reach, offset);
        curve.bend  = graph_op3(g, OP_select, level, zero, graph_number(g, 6));
    }
    return bend_term(x, value, scaled, curve);
}

static Node choose(const BallContext *x, Node which, Node a, Node b)
{
    return a == b ? a : graph_op3(x->graph, OP_select, which, a, b);
}

/* Makes the term of min and max. */
static BallTerm choice_term(const BallContext *x, Op op, Node value, BallTerm a, BallTerm b)
{
    Graph   *g          = x->graph;
    Node     less       = graph_op2(g, OP_less, a.value, b.value);
    Node     difference = sub(g, a.value, b.value);
    BallTerm left = op == OP_min ? a : b, right = op == OP_min ? b : a;
    BallTerm offset = add_terms(x, difference, a, negate_term(x, b.value, b));
    BallTerm chosen = {value, choose(x, less, left.gradient, right.gradient),
                       choose(x, less, left.first, right.first),
                       choose(x, less, left.second, right.second), NODE_NONE};
    chosen.first    = plus(g, chosen.first, over_kink(x, difference, steepness(x, &offset)));
    return chosen;
}

/* ---- vectors ---- */

static BallTerms new_terms(const BallContext *x, uint32_t count)
{
    return (BallTerms){count, arena_new_array(x->scratch, BallTerm, count)};
}

/* Returns component i of an operand; a number counts for all components. */
static BallTerm term_of(const BallTerms *terms, uint32_t i)
{
    return terms->items[terms->count > i ? i : 0];
}

/* Returns the square of a vector's slope in the ball; that of one whose components are linear is
   known. */
static Node steepness_squared(const BallContext *x, Node vector, const BallTerms *terms)
{
    Graph *g      = x->graph;
    bool   linear = true;
    Node   sum    = graph_number(g, 0);
    for (uint32_t i = 0; i < terms->count; i++) {
        const BallTerm *term = &terms->items[i];
        linear = linear && graph_is_constant(g, term->gradient) && is_number(g, term->first, 0) &&
                 is_number(g, term->second, 0);
        sum = plus(g, sum, graph_op1(g, OP_square, steepness(x, term)));
    }
    if (!linear)
        return sum;
    double slope = graph_slope(g, vector, x->box, NULL, 1, NULL, x->scratch);
    Node   whole = graph_number(g, slope * slope);
    return isfinite(slope) ? graph_op2(g, OP_min, sum, whole) : sum;
}

/* Sums of products of components; of a vector with itself, the tail is the square of its slope. */
static BallTerm dot_term(const BallContext *x, Node node, const BallTerms *a, const BallTerms *b)
{
    Graph     *g    = x->graph;
    const Expr e    = g->items[node];
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
        sum.second = plus(g, sum.second, steepness_squared(x, e.operands[0], a));
    return sum;
}

/* Makes the term of a length: |v + h| is between |v| + n.h and that and |h|^2 / (2 |v|), n = v /
   |v|. */
static BallTerm length_term(const BallContext *x, Node node, const BallTerms *a)
{
    Graph     *g     = x->graph;
    const Expr e     = g->items[node];
    BallTerm   sum   = constant_term(x, node);
    Node       least = at_least(g, node, SMALL);
    for (uint32_t i = 0; i < a->count; i++) {
        BallTerm term = term_of(a, i);
        sum = add_terms(x, node, sum, scale_term(x, node, term, over(g, term.value, least)));
    }
    if (has_radius(x)) {
        Node bend  = over(g, steepness_squared(x, e.operands[0], a), least);
        sum.second = plus(g, sum.second, times(g, bend, graph_number(g, 0.5)));
    }
    return sum;
}

/* ---- any operation ---- */

static BallTerm divide_terms(BallContext *x, Node value, BallTerm a, BallTerm b)
{
    Graph *g       = x->graph;
    Node   inverse = over(g, graph_number(g, 1), b.value);
    if (g->items[b.value].time != TIME_POINT)
        return scale_term(x, value, a, inverse);
    BallTerm turned = curved_term(x, curve_inverse, inverse, b);
    return multiply_terms(x, value, a, turned);
}

static BallTerm mix_terms(BallContext *x, Node value, BallTerm a, BallTerm b, BallTerm t)
{
    Graph   *g          = x->graph;
    BallTerm less       = negate_term(x, a.value, a);
    BallTerm difference = add_terms(x, sub(g, b.value, a.value), b, less);
    BallTerm change     = multiply_terms(x, value, difference, t);
    return add_terms(x, value, a, change);
}

/* One component of an operation: of what works component by component, a, b and c are the
   components of its operands; operands not all there are filled up with the first. */
typedef struct OpComponent {
    Expr             e;
    Node             node, value; /* the whole, and the component */
    uint32_t         component;
    const BallTerms *operands;
    BallTerm         a, b, c;
} OpComponent;

typedef BallTerm Rule(BallContext *x, const OpComponent *p);

static BallTerm local_none(BallContext *x, const OpComponent *p)
{
    return opaque_term(x, p->value);
}
static BallTerm local_add(BallContext *x, const OpComponent *p)
{
    return add_terms(x, p->value, p->a, p->b);
}
static BallTerm local_neg(BallContext *x, const OpComponent *p)
{
    return negate_term(x, p->value, p->a);
}
static BallTerm local_mul(BallContext *x, const OpComponent *p)
{
    return multiply_terms(x, p->value, p->a, p->b);
}
static BallTerm local_div(BallContext *x, const OpComponent *p)
{
    return divide_terms(x, p->value, p->a, p->b);
}
static BallTerm local_abs(BallContext *x, const OpComponent *p)
{
    return size_term(x, p->value, p->a);
}
static BallTerm local_mix(BallContext *x, const OpComponent *p)
{
    return mix_terms(x, p->value, p->a, p->b, p->c);
}
static BallTerm local_dot(BallContext *x, const OpComponent *p)
{
    return dot_term(x, p->node, &p->operands[0], &p->operands[1]);
}
static BallTerm local_length(BallContext *x, const OpComponent *p)
{
    return length_term(x, p->node, &p->operands[0]);
}

static BallTerm local_sub(BallContext *x, const OpComponent *p)
{
    return add_terms(x, p->value, p->a, negate_term(x, p->b.value, p->b));
}

static BallTerm local_choice(BallContext *x, const OpComponent *p)
{
    return choice_term(x, (Op)p->e.op, p->value, p->a, p->b);
}

static BallTerm local_clamp(BallContext *x, const OpComponent *p)
{
    Node     raised = graph_op2(x->graph, OP_max, p->a.value, p->b.value);
    BallTerm above  = choice_term(x, OP_max, raised, p->a, p->b);
    return choice_term(x, OP_min, p->value, above, p->c);
}

static BallTerm local_smoothstep(BallContext *x, const OpComponent *p)
{
    return smoothstep_term(x, p->value, p->a.value, p->b.value, p->c);
}

static BallTerm local_pow(BallContext *x, const OpComponent *p)
{
    const Expr *power = &x->graph->items[p->b.value];
    if (power->op != OP_CONSTANT)
        return opaque_term(x, p->value);
    return power->number[0] >= 2 ? even_power_term(x, p->value, p->a, power->number[0])
                                 : power_term(x, p->value, p->a, power->number[0]);
}

#define CURVED(name)                                                   \
    static BallTerm local_##name(BallContext *x, const OpComponent *p) \
    {                                                                  \
        return curved_term(x, curve_##name, p->value, p->a);           \
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

static BallTerm local_component(BallContext *x, const OpComponent *p)
{
    (void)x;
    return term_of(&p->operands[0], p->e.index);
}

/* Makes the term of a component of a built vector. */
static BallTerm local_vector(BallContext *x, const OpComponent *p)
{
    (void)x;
    return p->operands[p->e.operand_count > 1 ? p->component : 0].items[0];
}

static Rule *const rules[OP_COUNT] = {
#define RULES(name, cost, traits, simplify, derive, local, ...) [OP_##name] = local,
#include "compiler/graph/ops.def"
};

static void find_operation(BallContext *x, Node node, const BallTerms *operands, BallTerms *result)
{
    OpComponent place = {.e = x->graph->items[node], .node = node, .operands = operands};
    int         last  = place.e.operand_count - 1;
    for (uint32_t i = 0; i < result->count; i++) {
        place.value      = graph_component(x->graph, node, i);
        place.component  = i;
        place.a          = term_of(&operands[0], i);
        place.b          = term_of(&operands[last > 0], i);
        place.c          = term_of(&operands[last > 1 ? 2 : 0], i);
        result->items[i] = rules[place.e.op](x, &place);
    }
}

/* Tells whether an operation does not ask for the sign of what it is applied to. */
static bool is_even(const Graph *g, const Expr *e)
{
    if (e->op != OP_pow)
        return op_parity((Op)e->op) == PARITY_EVEN;
    const Expr *power = &g->items[e->operands[1]];
    return power->op == OP_CONSTANT && power->number[0] >= 2;
}

/* Returns a node whose operands are known. */
static BallTerms find_node(BallContext *x, Node node, const Tape *tape, const BallTerms *all)
{
    Expr      e     = x->graph->items[node];
    BallTerms found = new_terms(x, components((GraphType)e.type)), operands[MAX_OPERANDS];
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
    if (inner->op == OP_abs && e.op != OP_abs && is_even(x->graph, &e))
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
    Node lowest   = graph_number(graph, least);
    Node slope    = graph_op2(graph, OP_max, slope_here(&x, &here), lowest);
    x.radius      = over(graph, graph_op1(graph, OP_abs, root), slope);
    BallTerm ball = find(&x, root);
    bound->radius = x.limit == NODE_NONE ? x.radius : graph_op2(graph, OP_min, x.radius, x.limit);
    bound->first  = slope_here(&x, &ball);
    bound->second = ball.second;
    return x.bounded;
}

/* Returns the radius r where |f| = first r + second r^2. */
Node local_radius(Graph *graph, Node root, const LocalBound *bound)
{
    Node size    = graph_op1(graph, OP_abs, root);
    Node four    = graph_number(graph, 4);
    Node margin  = times(graph, times(graph, size, bound->second), four);
    Node squared = plus(graph, graph_op1(graph, OP_square, bound->first), margin);
    Node sum     = plus(graph, bound->first, graph_op1(graph, OP_sqrt, squared));
    Node twice   = times(graph, size, graph_number(graph, 2));
    return graph_op2(graph, OP_min, over(graph, twice, at_least(graph, sum, TINY)), bound->radius);
}
