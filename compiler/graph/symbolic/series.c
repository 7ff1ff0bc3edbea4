/*
 * series.c: power series of polynomials, along lines and in balls.
 *
 * One loop over the nodes that the polynomial needs.  Along a line a product is the product of
 * the series.  In a ball the parts of order k are bounded by their sizes: the size of a product
 * is at most the product of the sizes; the first order alone is exact, as its gradient is carried
 * along, because it decides where the bound is needed most, near the surface.
 */
#include "compiler/graph/symbolic/series.h"

#include <assert.h>
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"

/* The series of one number, in a ball with the gradient beside it, and while the degree is at most
   2 and the numbers are known, the second derivatives: x^2 + y^2 + z^2 is r^2 in size, not 3 r^2.
   */
typedef struct SeriesElement {
    Series series;
    Node   gradient; /* VEC3; NODE_NONE along lines */
    bool   quadric;
    double hessian[3][3];
} SeriesElement;

/* The series of a number, or of the components of a vector. */
typedef struct SeriesElements {
    uint32_t       count;
    SeriesElement *items;
} SeriesElements;

typedef struct Expansion {
    Graph       *graph;
    Arena       *scratch;
    Node         origin, direction; /* direction: NODE_NONE in a ball */
    SeriesFault *fault;
} Expansion;

static bool in_ball(const Expansion *x) { return x->direction == NODE_NONE; }

/* Returns order k of a series, as a size in balls. */
static Node order(const Expansion *x, const Series *series, uint32_t k)
{
    return k == 0 && in_ball(x) ? graph_op1(x->graph, OP_abs, series->c[0]) : series->c[k];
}

static void set_gradient(const Expansion *x, SeriesElement *element, Node gradient)
{
    element->gradient = gradient;
    if (in_ball(x) && element->series.degree > 0)
        element->series.c[1] = graph_op1(x->graph, OP_length, gradient);
}

/* Returns the largest size of an eigenvalue of a symmetric matrix: how fast what has these second
   derivatives can bend in any direction. */
static double largest_bend(double a[3][3])
{
    double mean = (a[0][0] + a[1][1] + a[2][2]) / 3, m[3][3], deviation = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            m[i][j] = a[i][j] - (i == j ? mean : 0);
            deviation += m[i][j] * m[i][j] / 6;
        }
    deviation          = sqrt(deviation);
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    double cubed  = 2 * deviation * deviation * deviation;
    double angle  = real_acos(cubed > 0 ? fmin(fmax(determinant / cubed, -1), 1) : 1) / 3;
    double top    = mean + 2 * deviation * real_cos(angle);
    double bottom = mean + 2 * deviation * real_cos(angle + 2 * M_PI / 3);
    return fmax(fabs(top), fabs(bottom)) * (1 + 1e-7);
}

/* Puts what the second derivatives say into order 2. */
static void settle_quadric(const Expansion *x, SeriesElement *element)
{
    if (element->quadric && element->series.degree == 2)
        element->series.c[2] = graph_number(x->graph, 0.5 * largest_bend(element->hessian));
}

static bool gradient_is_known(const Expansion *x, const SeriesElement *element)
{
    return element->quadric && element->series.degree <= 1 &&
           graph_is_constant(x->graph, element->gradient);
}

static Node no_gradient(const Expansion *x)
{
    return in_ball(x) ? graph_vec3(x->graph, 0, 0, 0) : NODE_NONE;
}

static SeriesElement constant_element(const Expansion *x, Node node)
{
    SeriesElement element = {.gradient = no_gradient(x), .quadric = in_ball(x)};
    element.series.c[0]   = node;
    return element;
}

/* Returns coordinate i of the point. */
static SeriesElement coordinate_element(const Expansion *x, uint32_t i)
{
    SeriesElement element = {.series = {.degree = 1}, .quadric = in_ball(x)};
    element.series.c[0]   = graph_component(x->graph, x->origin, i);
    if (in_ball(x)) {
        element.gradient    = graph_vec3(x->graph, i == 0, i == 1, i == 2);
        element.series.c[1] = graph_number(x->graph, 1);
    } else {
        element.gradient    = NODE_NONE;
        element.series.c[1] = graph_component(x->graph, x->direction, i);
    }
    return element;
}

static SeriesElement add_elements(const Expansion *x, SeriesElement a, SeriesElement b)
{
    Graph        *g = x->graph;
    const Series *s = &a.series, *t = &b.series;
    SeriesElement sum = {.series = {.degree = s->degree > t->degree ? s->degree : t->degree}};
    for (uint32_t k = 0; k <= sum.series.degree; k++)
        sum.series.c[k] = k > s->degree   ? t->c[k]
                          : k > t->degree ? s->c[k]
                                          : plus(g, s->c[k], t->c[k]);
    set_gradient(x, &sum, in_ball(x) ? plus(g, a.gradient, b.gradient) : NODE_NONE);
    sum.quadric = a.quadric && b.quadric;
    for (int i = 0; i < 9; i++)
        sum.hessian[i / 3][i % 3] = a.hessian[i / 3][i % 3] + b.hessian[i / 3][i % 3];
    settle_quadric(x, &sum);
    return sum;
}

static SeriesElement negate_element(const Expansion *x, SeriesElement a)
{
    for (uint32_t k = 0; k <= a.series.degree; k++)
        if (k == 0 || !in_ball(x))
            a.series.c[k] = neg(x->graph, a.series.c[k]);
    if (in_ball(x))
        a.gradient = neg(x->graph, a.gradient);
    for (int i = 0; i < 9; i++)
        a.hessian[i / 3][i % 3] = -a.hessian[i / 3][i % 3];
    return a;
}

/* Multiplies the second derivatives of a product of two known linear numbers, or of a quadric and a
   known constant. */
static void multiply_quadrics(const Expansion *x, const SeriesElement *a, const SeriesElement *b,
                              SeriesElement *product)
{
    const Expr          *u = &x->graph->items[a->gradient], *v = &x->graph->items[b->gradient];
    bool                 scaled = a->series.degree == 0 || b->series.degree == 0;
    const SeriesElement *other  = a->series.degree == 0 ? b : a,
                        *factor = a->series.degree == 0 ? a : b;
    if (scaled) {
        const Expr *number = &x->graph->items[factor->series.c[0]];
        product->quadric   = other->quadric && number->op == OP_CONSTANT;
        for (int i = 0; product->quadric && i < 9; i++)
            product->hessian[i / 3][i % 3] = number->number[0] * other->hessian[i / 3][i % 3];
    } else if (gradient_is_known(x, a) && gradient_is_known(x, b)) {
        product->quadric = true;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                product->hessian[i][j] = u->number[i] * v->number[j] + v->number[i] * u->number[j];
    }
    settle_quadric(x, product);
}

static SeriesElement multiply_elements(const Expansion *x, SeriesElement a, SeriesElement b)
{
    Graph        *g       = x->graph;
    SeriesElement product = {.series = {.degree = a.series.degree + b.series.degree}};
    assert(product.series.degree <= MAX_DEGREE);
    product.series.c[0] = times(g, a.series.c[0], b.series.c[0]);
    for (uint32_t k = 1; k <= product.series.degree; k++) {
        Node sum = graph_number(g, 0);
        for (uint32_t i = 0; i <= k; i++) {
            if (i > a.series.degree || k - i > b.series.degree)
                continue;
            Node other = order(x, &b.series, k - i);
            Node term  = times(g, order(x, &a.series, i), other);
            sum        = plus(g, sum, term);
        }
        product.series.c[k] = sum;
    }
    Node gradient = NODE_NONE;
    if (in_ball(x)) {
        Node first  = stretch(g, b.gradient, a.series.c[0]);
        Node second = stretch(g, a.gradient, b.series.c[0]);
        gradient    = plus(g, first, second);
    }
    set_gradient(x, &product, gradient);
    if (in_ball(x))
        multiply_quadrics(x, &a, &b, &product);
    return product;
}

static bool is_constant(SeriesElement element) { return element.series.degree == 0; }

static SeriesElements new_elements(const Expansion *x, uint32_t count)
{
    return (SeriesElements){count, arena_new_array(x->scratch, SeriesElement, count)};
}

/* Returns component i of an operand; a number counts for all components. */
static SeriesElement element_of(const SeriesElements *elements, uint32_t i)
{
    return elements->items[elements->count > i ? i : 0];
}

static bool multiply(Expansion *x, Node node, SeriesElement a, SeriesElement b,
                     SeriesElement *product)
{
    uint32_t degree = a.series.degree + b.series.degree;
    if (degree > MAX_DEGREE) {
        *x->fault = (SeriesFault){node, degree};
        return false;
    }
    *product = multiply_elements(x, a, b);
    return true;
}

/* Sums of products of components: dot, and each component of cross. */
static bool dot_elements(Expansion *x, Node node, const SeriesElements *a, const SeriesElements *b,
                         SeriesElement *sum)
{
    for (uint32_t i = 0; i < a->count; i++) {
        SeriesElement product;
        if (!multiply(x, node, a->items[i], b->items[i], &product))
            return false;
        *sum = i == 0 ? product : add_elements(x, *sum, product);
    }
    return true;
}

static bool cross_elements(Expansion *x, Node node, const SeriesElements *a,
                           const SeriesElements *b, SeriesElements *result)
{
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t      j = (i + 1) % 3, k = (i + 2) % 3;
        SeriesElement first, second;
        if (!multiply(x, node, a->items[j], b->items[k], &first) ||
            !multiply(x, node, a->items[k], b->items[j], &second))
            return false;
        result->items[i] = add_elements(x, first, negate_element(x, second));
    }
    return true;
}

/* A rule gives the components of the result; false: no polynomial, or one of too high a degree. */
typedef bool Rule(Expansion *x, Node node, const SeriesElements *operands, SeriesElements *result);

static bool series_none(Expansion *x, Node node, const SeriesElements *operands,
                        SeriesElements *result)
{
    (void)x, (void)node, (void)operands, (void)result;
    return false;
}

/* Expands a sum or a difference. */
static bool expand_sum(Expansion *x, const SeriesElements *operands, bool minus,
                       SeriesElements *result)
{
    for (uint32_t i = 0; i < result->count; i++) {
        SeriesElement a = element_of(&operands[0], i), b = element_of(&operands[1], i);
        result->items[i] = add_elements(x, a, minus ? negate_element(x, b) : b);
    }
    return true;
}

static bool series_add(Expansion *x, Node node, const SeriesElements *operands,
                       SeriesElements *result)
{
    (void)node;
    return expand_sum(x, operands, false, result);
}

static bool series_sub(Expansion *x, Node node, const SeriesElements *operands,
                       SeriesElements *result)
{
    (void)node;
    return expand_sum(x, operands, true, result);
}

static bool series_neg(Expansion *x, Node node, const SeriesElements *operands,
                       SeriesElements *result)
{
    (void)node;
    for (uint32_t i = 0; i < result->count; i++)
        result->items[i] = negate_element(x, element_of(&operands[0], i));
    return true;
}

static bool expand_product(Expansion *x, Node node, const SeriesElements *a,
                           const SeriesElements *b, SeriesElements *result)
{
    for (uint32_t i = 0; i < result->count; i++)
        if (!multiply(x, node, element_of(a, i), element_of(b, i), &result->items[i]))
            return false;
    return true;
}

static bool series_mul(Expansion *x, Node node, const SeriesElements *operands,
                       SeriesElements *result)
{
    return expand_product(x, node, &operands[0], &operands[1], result);
}

static bool series_square(Expansion *x, Node node, const SeriesElements *operands,
                          SeriesElements *result)
{
    return expand_product(x, node, &operands[0], &operands[0], result);
}

static bool series_div(Expansion *x, Node node, const SeriesElements *operands,
                       SeriesElements *result)
{
    for (uint32_t i = 0; i < result->count; i++) {
        SeriesElement a = element_of(&operands[0], i), b = element_of(&operands[1], i);
        if (!is_constant(b))
            return false;
        b.series.c[0] = over(x->graph, graph_number(x->graph, 1), b.series.c[0]);
        if (!multiply(x, node, a, b, &result->items[i]))
            return false;
    }
    return true;
}

static bool series_component(Expansion *x, Node node, const SeriesElements *operands,
                             SeriesElements *result)
{
    result->items[0] = element_of(&operands[0], x->graph->items[node].index);
    return true;
}

/* Makes the series of a built vector. */
static bool series_vector(Expansion *x, Node node, const SeriesElements *operands,
                          SeriesElements *result)
{
    bool several = x->graph->items[node].operand_count > 1;
    for (uint32_t i = 0; i < result->count; i++)
        result->items[i] = operands[several ? i : 0].items[0];
    return true;
}

static bool series_dot(Expansion *x, Node node, const SeriesElements *operands,
                       SeriesElements *result)
{
    return dot_elements(x, node, &operands[0], &operands[1], &result->items[0]);
}

static bool series_cross(Expansion *x, Node node, const SeriesElements *operands,
                         SeriesElements *result)
{
    return cross_elements(x, node, &operands[0], &operands[1], result);
}

static bool series_rotate(Expansion *x, Node node, const SeriesElements *operands,
                          SeriesElements *result)
{
    for (uint32_t i = 0; i < 3; i++)
        if (!dot_elements(x, node, &operands[0], &operands[i + 1], &result->items[i]))
            return false;
    return true;
}

static Rule *const rules[OP_COUNT] = {
#define RULES(name, cost, traits, simplify, derive, local, series, ...) [OP_##name] = series,
#include "compiler/graph/ops.def"
};

/* Expands a node of point time whose operands are expanded. */
static bool expand_node(Expansion *x, Node node, const Tape *tape, const SeriesElements *all,
                        SeriesElements *result)
{
    Expr e         = x->graph->items[node];
    x->graph->here = e.span;
    *result        = new_elements(x, components((GraphType)e.type));
    if (e.time != TIME_POINT) {
        for (uint32_t i = 0; e.type <= TYPE_VEC4 && i < result->count; i++)
            result->items[i] = constant_element(x, graph_component(x->graph, node, i));
        return true;
    }
    if (e.op == OP_POINT) {
        for (uint32_t i = 0; i < 3; i++)
            result->items[i] = coordinate_element(x, i);
        return true;
    }
    SeriesElements operands[MAX_OPERANDS];
    for (int i = 0; i < e.operand_count; i++)
        operands[i] = all[tape_index(tape, e.operands[i])];
    return e.type <= TYPE_VEC4 && e.operand_count > 0 && rules[e.op](x, node, operands, result);
}

static bool expand(Expansion *x, Node root, Series *series)
{
    Span            here = x->graph->here;
    Tape            tape = tape_new(x->graph, &root, 1, x->scratch);
    SeriesElements *all  = arena_new_array(x->scratch, SeriesElements, tape.count);
    assert(x->graph->items[root].type == TYPE_FLOAT);
    for (size_t i = 0; i < tape.count; i++) {
        *x->fault = (SeriesFault){tape.nodes[i], 0};
        if (!expand_node(x, tape.nodes[i], &tape, all, &all[i])) {
            x->graph->here = here;
            return false;
        }
    }
    x->graph->here = here;
    *series        = all[tape_index(&tape, root)].items[0].series;
    return true;
}

bool graph_line_series(Graph *graph, Node root, Node origin, Node direction, Series *series,
                       SeriesFault *fault, Arena *scratch)
{
    Expansion x = {graph, scratch, origin, direction, fault};
    return expand(&x, root, series);
}

bool graph_ball_series(Graph *graph, Node root, Node point, Series *series, SeriesFault *fault,
                       Arena *scratch)
{
    Expansion x = {graph, scratch, point, NODE_NONE, fault};
    return expand(&x, root, series);
}

/* ---- the radius of a ball series ---- */

enum { NEWTON_STEPS = 3 };

/* Keeps quotients finite; below every coefficient that counts in single precision. */
static const double TINY = 1e-30;

/* Returns the least root of one term alone: at least r*, and at most twice that. */
static Node first_guess(Graph *g, const Series *s, Node size)
{
    Node least = NODE_NONE;
    for (uint32_t k = 1; k <= s->degree; k++) {
        if (is_number(g, s->c[k], 0))
            continue;
        Node quotient = over(g, size, at_least(g, s->c[k], TINY));
        Node root     = root_of(g, quotient, k);
        least         = least == NODE_NONE ? root : graph_op2(g, OP_min, least, root);
    }
    return least;
}

/* Returns S(r) and, beside it, its derivative, by Horner's rule. */
static Node series_sum(Graph *g, const Series *s, Node r, Node *derivative)
{
    Node sum = s->c[s->degree], slope = sum;
    for (uint32_t k = s->degree; k-- > 0;) {
        if (k + 1 < s->degree)
            slope = add(g, mul(g, slope, r), sum);
        sum = mul(g, sum, r);
        if (k > 0)
            sum = add(g, sum, s->c[k]);
    }
    *derivative = slope;
    return sum;
}

/* Returns the radius of a series by Newton's steps, which come down to the root from above, as the
   sum is convex; the chord from 0 ends below it. */
Node series_radius(Graph *g, const Series *s)
{
    Node size = graph_op1(g, OP_abs, s->c[0]);
    Node r    = first_guess(g, s, size), slope;
    for (int i = 0; i < NEWTON_STEPS && s->degree > 1; i++) {
        Node sum    = series_sum(g, s, r, &slope);
        Node excess = sub(g, sum, size);
        Node step   = over(g, excess, at_least(g, slope, TINY));
        r           = sub(g, r, step);
    }
    Node sum      = series_sum(g, s, r, &slope);
    Node fraction = over(g, size, at_least(g, sum, TINY));
    fraction      = graph_op2(g, OP_min, fraction, graph_number(g, 1));
    return mul(g, r, fraction);
}
