/*
 * ray_step.c: how far a ray may go, where that is more than a distance.
 *
 * A distance holds for all directions.  A ray has one, and along it a polynomial of the point is
 * one of a single number t, whose next zero is the surface itself.  What is computed at a point is
 * no zero yet but a long safe step towards it, so that the march along the ray does the iterations:
 *     f(p + t v) = c0 + c1 t + ... + cn t^n,           |c0| > 0, taken as c0 > 0
 * Only negative coefficients can bring it down: with m_k their sizes the least of (c0 / m_k)^(1/k)
 * is between the root of c0 = sum m_k t^k and twice that (Cauchy), so it tells a good length w of
 * the piece to look at.  On [0, w] the polynomial lies in the hull of its Bernstein coefficients
 * b_i at t = i w / n, thus above the line from b0 through the one towards which the fall is
 * steepest,
 *     t = w min(1, b0 / max_i (b0 - b_i) n / i).
 * Near a simple zero that is Newton's step, from the safe side; expanding about the point itself
 * keeps single precision good where it matters (math.md, section 3).
 *
 * A sheet is where the sign changes.  At a point of a ray it is asked for between that point and the
 * one before, which is OP_FOOTPRINT behind; there all steps before have said that nothing is but
 * within what may stay open.  So a sheet needs no thickness, and has two sides.
 *
 * Unions, intersections and differences join such numbers as they join distances; affine maps keep
 * them, as t counts the ray's own steps; whatever else there is counts with its distance.
 */
#include <math.h>

#include "compiler/graph/build.h"
#include "compiler/graph/series.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/map_chain.h"
#include "compiler/lower/ray_images.h"
#include "compiler/shape/slope.h"

/* A ray in the space of a shape: point + t direction, with the same t everywhere. */
typedef struct Ray {
    Node point, direction, speed; /* speed: the length of direction */
    Node back; /* how far behind a point its sheets are looked for: up to the place before */
} Ray;

/* How far a term alone may fall over the piece, in c0; of 1 .. 16, few evaluations.  Twice the
   length for all terms alike would let t^20 fall by a million, and a step be a millionth. */
static const double PIECE = 4;
static const double TINY  = 1e-30;

/* ---- polynomials ---- */

/* The length of the piece; bounded, so that its powers are numbers in single precision. */
static Node piece_length(Lowering *l, const Series *s)
{
    Graph *g     = l->graph;
    Node   least = graph_number(g, pow(10, 34.0 / s->degree));
    Node   whole = mul(g, s->c[0], graph_number(g, PIECE));
    for (uint32_t k = 1; k <= s->degree; k++) {
        Node fall  = at_least(g, neg(g, s->c[k]), TINY);
        Node guess = root_of(g, over(g, whole, fall), k);
        least      = graph_op2(g, OP_min, least, guess);
    }
    return least;
}

static double binomial(uint32_t n, uint32_t k)
{
    double value = 1;
    for (uint32_t i = 1; i <= k; i++)
        value = value * (n - k + i) / i;
    return value;
}

/* (b0 - b_i) n / i from the terms c_k w^k: the fall to the i-th Bernstein coefficient, a piece. */
static Node fall_towards(Lowering *l, const Node *terms, uint32_t n, uint32_t i)
{
    Graph *g   = l->graph;
    Node   sum = NODE_NONE;
    for (uint32_t k = 1; k <= i; k++) {
        double fraction = -binomial(i, k) / binomial(n, k) * n / i;
        Node   term     = mul(g, terms[k], graph_number(g, fraction));
        sum             = sum == NODE_NONE ? term : add(g, sum, term);
    }
    return sum;
}

/* The safe step, for a series that is positive at t = 0. */
static Node safe_step(Lowering *l, const Series *s)
{
    Graph *g     = l->graph;
    Node   piece = piece_length(l, s), power = piece, steepest = NODE_NONE;
    Node   terms[MOST_DEGREE + 1];
    for (uint32_t k = 1; k <= s->degree; k++) {
        terms[k] = mul(g, s->c[k], power);
        power    = mul(g, power, piece);
    }
    for (uint32_t i = 1; i <= s->degree; i++) {
        Node fall = fall_towards(l, terms, s->degree, i);
        steepest  = steepest == NODE_NONE ? fall : graph_op2(g, OP_max, steepest, fall);
    }
    Node fraction = over(g, s->c[0], at_least(g, steepest, TINY));
    fraction      = graph_op2(g, OP_min, fraction, graph_number(g, 1));
    return mul(g, piece, fraction);
}

/* The r with r sum n |Pn| r^(n-1) = |P0|: the fixed point of the paper, found as a root, since its
   iterates run away from it where high orders count (math.md, section 3). */
static Node taylor_radius(Lowering *l, Series *s)
{
    Graph *g = l->graph;
    for (uint32_t k = 2; k <= s->degree; k++)
        s->c[k] = mul(g, s->c[k], graph_number(g, k));
    return series_radius(g, s);
}

static Node along_series(Lowering *l, Series *s)
{
    Graph *g    = l->graph;
    Node   sign = graph_op1(g, OP_sign, s->c[0]);
    for (uint32_t k = 0; k <= s->degree; k++)
        s->c[k] = l->method == ALONG_EXACT ? mul(g, s->c[k], sign) : graph_op1(g, OP_abs, s->c[k]);
    Node step = l->method == ALONG_EXACT    ? safe_step(l, s)
                : l->method == ALONG_TAYLOR ? taylor_radius(l, s)
                                            : series_radius(g, s);
    return mul(g, step, sign);
}

static const double FAR = 1e30; /* farther than anything is; and 1e18, than any box is large */

/* Where a ray is in a box that may be endless on some sides: from here or from `enter` on; not at
   all where `leave` is less. */
static void clip_ray(Lowering *l, Box box, Ray ray, Node *enter, Node *leave)
{
    Graph *g = l->graph;
    *enter   = graph_number(g, 0);
    *leave   = graph_number(g, FAR);
    for (uint32_t i = 0; i < 3; i++) {
        Range side = box.axis[i];
        if (!isfinite(side.low) && !isfinite(side.high))
            continue;
        Node from = graph_component(g, ray.point, i), slope = graph_component(g, ray.direction, i);
        Node tiny = graph_number(g, 1e-18);
        slope    = graph_op3(g, OP_select, graph_op2(g, OP_less, graph_op1(g, OP_abs, slope), tiny),
                             tiny, slope);
        Node low = sub(g, graph_number(g, fmax(side.low, -1e18)), from);
        Node high = sub(g, graph_number(g, fmin(side.high, 1e18)), from);
        low       = over(g, low, slope);
        high      = over(g, high, slope);
        *enter    = graph_op2(g, OP_max, *enter, graph_op2(g, OP_min, low, high));
        *leave    = graph_op2(g, OP_min, *leave, graph_op2(g, OP_max, low, high));
    }
}

static Node clamp_to(Lowering *l, Node point, Box box)
{
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i]  = fmax(box.axis[i].low, -1e18);
        high[i] = fmin(box.axis[i].high, 1e18);
    }
    Node least = graph_constant(l->graph, TYPE_VEC3, low);
    return graph_op3(l->graph, OP_clamp, point, least, graph_constant(l->graph, TYPE_VEC3, high));
}

/* The place of a ray where it enters a box; in the box, whatever is rounded. */
static Node entrance(Lowering *l, Box box, Ray ray, Node enter)
{
    Node offset = graph_op2(l->graph, OP_scale, ray.direction, enter);
    return clamp_to(l, add(l->graph, ray.point, offset), box);
}

/* Where all zeros are in a box, a ray from outside goes there first, and the series is that about
   where it comes in: from far away no digit of it would be right. */
static Node along_boxed(Lowering *l, const Shape *shape, Ray ray)
{
    Graph      *g = l->graph;
    Series      s;
    SeriesFault fault;
    Node        enter, leave, side = graph_number(g, shape->zeros.sign);
    clip_ray(l, shape->zeros.box, ray, &enter, &leave);
    Node origin = entrance(l, shape->zeros.box, ray, enter);
    if (!graph_line_series(g, shape->formula, origin, ray.direction, &s, &fault, l->scratch))
        return NODE_NONE;
    Node step   = add(g, along_series(l, &s), mul(g, side, enter));
    Node misses = graph_op2(g, OP_less, leave, enter);
    return graph_op3(g, OP_select, misses, graph_number(g, FAR * shape->zeros.sign), step);
}

/* What is cut to a region is not looked at outside of it, where the region says how far to go. */
static Node along_cut(Lowering *l, const Shape *shape, Ray ray)
{
    Graph      *g = l->graph;
    Series      s;
    SeriesFault fault;
    Node        origin = clamp_to(l, ray.point, shape->region);
    if (!graph_line_series(g, shape->formula, origin, ray.direction, &s, &fault, l->scratch))
        return NODE_NONE;
    Node offset  = sub(g, ray.point, origin);
    Node outside = graph_op2(g, OP_less, graph_number(g, 0), graph_op2(g, OP_dot, offset, offset));
    return graph_op3(g, OP_select, outside, graph_number(g, 0), along_series(l, &s));
}

static Node along_polynomial(Lowering *l, const Shape *shape, Ray ray)
{
    Series      s;
    SeriesFault fault;
    if (box_is_finite(shape->region))
        return along_cut(l, shape, ray);
    if (shape->zeros.sign != 0)
        return along_boxed(l, shape, ray);
    return graph_line_series(l->graph, shape->formula, ray.point, ray.direction, &s, &fault,
                             l->scratch)
               ? along_series(l, &s)
               : NODE_NONE;
}

/* ---- shapes ---- */

static Node along(Lowering *l, const Shape *shape, Ray ray);

static Node along_distance(Lowering *l, const Shape *shape, Ray ray)
{
    Lowered ball = lower_shape(l, shape, context_new(ray.point, false));
    if (ball.distance == NODE_NONE)
        return NODE_NONE;
    Node distance = divide_by_slope(l->graph, ball.distance, shape->slope);
    return over(l->graph, distance, ray.speed);
}

static Node joined(Lowering *l, Op op, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE)
        return a == NODE_NONE ? b : a;
    return graph_op2(l->graph, op, a, b);
}

static Node opposite(Lowering *l, Node a) { return a == NODE_NONE ? a : neg(l->graph, a); }

/* ---- numbers that are negative inside ---- */

static Node value_at(Lowering *l, const Shape *shape, Node point);

static Node value_distance(Lowering *l, const Shape *shape, Node point)
{
    return lower_shape(l, shape, context_new(point, false)).distance;
}

static Node value_formula(Lowering *l, const Shape *shape, Node point)
{
    if (shape->formula == NODE_NONE)
        return value_distance(l, shape, point);
    return graph_substitute(l->graph, shape->formula, substitute_point(point), l->scratch);
}

static Node value_map(Lowering *l, const Shape *shape, Node point)
{
    return value_at(l, shape->children[0], before_map(l->graph, &shape->map, point));
}

static Node value_stretch(Lowering *l, const Shape *shape, Node point)
{
    return value_at(l, shape->children[0], over(l->graph, point, shape->values[0]));
}

static Node value_part(Lowering *l, const Shape *shape, Node point)
{
    return value_at(l, shape->children[0], point);
}

/* A place of the ray behind its point. */
static Node context_behind_point(Lowering *l, Ray ray)
{
    Node offset = graph_op2(l->graph, OP_scale, ray.direction, ray.back);
    return sub(l->graph, ray.point, offset);
}

/* How far behind a point sheets are looked for in what cuts them, `ahead` along the ray: up to the
   place before if that is in it as well, else no farther than it surely reaches. */
static Node back_within(Lowering *l, const Shape *shape, Ray ray, Node ahead)
{
    Graph *g      = l->graph;
    Node   behind = context_behind_point(l, ray), before = NODE_NONE;
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!shape->children[i]->sheets)
            before = joined(l, OP_max, before, value_at(l, shape->children[i], behind));
    Node depth  = at_least(g, neg(g, ahead), 0);
    Node within = graph_op2(g, OP_less, before, graph_number(g, 0));
    return graph_op3(g, OP_select, within, ray.back, graph_op2(g, OP_min, ray.back, depth));
}

/* What is cut comes last: its sheets are looked for in the rest. */
static Node along_intersection(Lowering *l, const Shape *shape, Ray ray)
{
    Node all = NODE_NONE;
    for (int sheets = 0; sheets < 2; sheets++) {
        if (sheets && shape->sheets && all != NODE_NONE)
            ray.back = back_within(l, shape, ray, all);
        for (uint32_t i = 0; i < shape->child_count; i++) {
            if (shape->children[i]->sheets != (sheets == 1))
                continue;
            Node next = along(l, shape->children[i], ray);
            if (next == NODE_NONE)
                return NODE_NONE;
            all = joined(l, OP_max, all, next);
        }
    }
    return all;
}

/* The least of the parts from `first` on. */
static Node along_least(Lowering *l, const Shape *shape, uint32_t first, Ray ray)
{
    Node least = NODE_NONE;
    for (uint32_t i = first; i < shape->child_count; i++) {
        Node next = along(l, shape->children[i], ray);
        least     = joined(l, OP_min, least, next);
    }
    return least;
}

static Node along_union(Lowering *l, const Shape *shape, Ray ray)
{
    return along_least(l, shape, 0, ray);
}

static Node along_difference(Lowering *l, const Shape *shape, Ray ray)
{
    Node first = along(l, shape->children[0], ray);
    Node rest  = along_least(l, shape, 1, ray);
    return first == NODE_NONE ? first : joined(l, OP_max, first, opposite(l, rest));
}

/* Through x -> rows x scale + shift. */
static Node along_map(Lowering *l, const Shape *shape, Ray ray)
{
    Graph *g      = l->graph;
    Map    linear = shape->map;
    linear.shift  = graph_vec3(g, 0, 0, 0);
    Ray inner     = {before_map(g, &shape->map, ray.point), before_map(g, &linear, ray.direction),
                     over(g, ray.speed, shape->map.scale), ray.back};
    return along(l, shape->children[0], inner);
}

static Node along_stretch(Lowering *l, const Shape *shape, Ray ray)
{
    Graph *g     = l->graph;
    Ray    inner = {over(g, ray.point, shape->values[0]), over(g, ray.direction, shape->values[0]),
                    NODE_NONE, ray.back};
    inner.speed  = graph_op1(g, OP_length, inner.direction);
    return along(l, shape->children[0], inner);
}

/* Up to where the sign changes next; negative if it has since the place before. */
static Node along_sheet(Lowering *l, const Shape *shape, Ray ray)
{
    Graph *g    = l->graph;
    Node   step = along(l, shape->children[0], ray);
    if (step == NODE_NONE)
        return step;
    Node here   = value_at(l, shape->children[0], ray.point);
    Node before = value_at(l, shape->children[0], context_behind_point(l, ray));
    Node turned = mul(g, graph_op1(g, OP_sign, here), graph_op1(g, OP_sign, before));
    Node size = graph_op1(g, OP_abs, here), all = graph_op1(g, OP_abs, before);
    all         = at_least(g, add(g, size, all), TINY);
    Node inside = mul(g, ray.back, over(g, size, all));
    return graph_op3(g, OP_select, graph_op2(g, OP_less, turned, graph_number(g, 0)),
                     neg(g, inside), graph_op1(g, OP_abs, step));
}

static Node along_part(Lowering *l, const Shape *shape, Ray ray)
{
    return along(l, shape->children[0], ray);
}

/* ---- whether a polynomial can be seen from here through what `along` can see through ---- */

static bool sees_polynomial(const Shape *shape);

static bool sees_nothing(const Shape *shape)
{
    (void)shape;
    return false;
}

static bool sees_formula(const Shape *shape)
{
    return shape->formula != NODE_NONE && shape->degree > 0;
}

static bool sees_sheet(const Shape *shape) { return shape->sheet; }

static bool sees_part(const Shape *shape) { return sees_polynomial(shape->children[0]); }

static bool sees_sharp_parts(const Shape *shape)
{
    for (uint32_t i = 0; shape->blend.width == NODE_NONE && i < shape->child_count; i++)
        if (sees_polynomial(shape->children[i]))
            return true;
    return false;
}

/* ---- kinds ---- */

typedef struct StepRule {
    bool (*sees)(const Shape *shape);
    Node (*value)(Lowering *l, const Shape *shape, Node point);
    Node (*along)(Lowering *l, const Shape *shape, Ray ray);
} StepRule;

static const StepRule step_none         = {sees_nothing, value_distance, along_distance};
static const StepRule step_polynomial   = {sees_formula, value_formula, along_polynomial};
static const StepRule step_map          = {sees_part, value_map, along_map};
static const StepRule step_stretch      = {sees_part, value_stretch, along_stretch};
static const StepRule step_sheet        = {sees_sheet, value_distance, along_sheet};
static const StepRule step_union        = {sees_sharp_parts, value_distance, along_union};
static const StepRule step_intersection = {sees_sharp_parts, value_distance, along_intersection};
static const StepRule step_difference   = {sees_sharp_parts, value_distance, along_difference};
static const StepRule step_part         = {sees_part, value_part, along_part};

static const StepRule *rule_of(const Shape *shape)
{
    static const StepRule *const rules[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, rays, step, ...) &step_##step,
#include "compiler/shape/shapes.def"
    };
    return rules[shape->kind];
}

static Node value_at(Lowering *l, const Shape *shape, Node point)
{
    return rule_of(shape)->value(l, shape, point);
}

static bool sees_polynomial(const Shape *shape) { return rule_of(shape)->sees(shape); }

/* The t up to which nothing changes from outside to inside, negative from within; NODE_NONE: the
   empty set. */
static Node along(Lowering *l, const Shape *shape, Ray ray)
{
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow || !sees_polynomial(shape) || !rays_pass(shape))
        return l->overflow ? NODE_NONE : along_distance(l, shape, ray);
    return rule_of(shape)->along(l, shape, ray);
}

Node lower_along(Graph *graph, const Shape *shape, Node plain, AlongMethod method, Arena *scratch)
{
    if (method >= ALONG_POLYNOMIALS)
        return lower_image(graph, shape, plain, method, scratch);
    if (!sees_polynomial(shape))
        return plain;
    Lowering l = {.graph   = graph,
                  .scratch = scratch,
                  .most    = graph->count + MOST_LOWERED,
                  .method  = method,
                  .thin    = true};
    Ray ray = {graph_leaf(graph, OP_POINT), graph_leaf(graph, OP_DIRECTION), graph_number(graph, 1),
               graph_leaf(graph, OP_FOOTPRINT)};
    Node all = along(&l, shape, ray);
    return l.overflow || all == NODE_NONE ? plain : all;
}
