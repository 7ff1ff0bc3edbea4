/*
 * ray_step.c: how far a ray may go, where that is more than a distance.
 *
 * A distance is safe in all directions, but a ray has one direction.  Along it a polynomial of the
 * point is a polynomial of one number t, whose next root is the surface:
 *     f(p + t v) = c0 + c1 t + ... + cn t^n,           |c0| > 0, taken as c0 > 0
 * At each point of the ray one long safe step towards the root is computed.  So the march along the
 * ray is the iteration.
 *
 * Only negative coefficients make f decrease.  Let m_k be their absolute values.  The least of
 * (c0 / m_k)^(1/k) is between the root of c0 = sum m_k t^k and twice that (Cauchy).  So it gives a
 * good length w of the interval to consider.  On [0, w] the graph of f lies in the convex hull of
 * its Bernstein coefficients b_i at t = i w / n.  So f is above the line from b0 with the steepest
 * descent to any b_i, and has no root before
 *     t = w min(1, b0 / max_i (b0 - b_i) n / i).
 * Near a simple root this is almost Newton's step, but never too long.  The series is about the
 * current point, which keeps single precision accurate near roots (math.md, section 3).
 *
 * An open surface is where f changes its sign.  At each point of a ray it is looked for back to the
 * previous point, at a distance of OP_FOOTPRINT.  All steps before were safe, up to the tolerance.
 * So an open surface needs no thickness, and has two sides.
 *
 * Unions, intersections and differences join these numbers like distances.  Affine maps leave them
 * unchanged, since t is a parameter of the original ray.  Other shapes contribute their distance.
 */
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/far.h"
#include "compiler/graph/build.h"
#include "compiler/graph/symbolic/series.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/map_chain.h"
#include "compiler/lower/ray_step.h"
#include "compiler/shape/slope.h"

/* A ray in the space of a shape: point + t direction, with the same t everywhere. */
typedef struct Ray {
    Node point, direction, speed; /* speed: the length of direction */
    Node
        back; /* how far backwards open surfaces are looked for: to the previous point of the ray */
} Ray;

/* One term may decrease by so much over the interval, in units of c0.  Of the values from 1 to 16,
   this one needs few evaluations.  To double the interval's length instead, whatever the degree,
   would let t^20 decrease by a million, and steps could be a millionth of the interval. */
static const double MAX_FALL = 4;
static const double TINY     = 1e-30;

/* ---- polynomials ---- */

/* Returns the length w of the interval, limited so that its powers are finite in single precision.
   Roots other than square roots, and square roots of these, are compared by their logarithms, and
   one power of 2 is taken in the end: drivers write it as some twenty instructions. */
static Node interval_length(Lowering *l, const Series *s)
{
    Graph *g        = l->graph;
    Node   least    = graph_number(g, real_pow(10, 34.0 / s->degree));
    Node   whole    = mul(g, s->c[0], graph_number(g, MAX_FALL));
    Node   exponent = NODE_NONE;
    for (uint32_t k = 1; k <= s->degree; k++) {
        Node fall     = at_least(g, neg(g, s->c[k]), TINY);
        Node quotient = over(g, whole, fall);
        if ((k & (k - 1)) == 0) {
            least = graph_op2(g, OP_min, least, root_of(g, quotient, k));
            continue;
        }
        Node other = log_of_root(g, quotient, k);
        exponent   = exponent == NODE_NONE ? other : graph_op2(g, OP_min, exponent, other);
    }
    return exponent == NODE_NONE ? least
                                 : graph_op2(g, OP_min, least, graph_op1(g, OP_exp2, exponent));
}

static double binomial(uint32_t n, uint32_t k)
{
    double value = 1;
    for (uint32_t i = 1; i <= k; i++)
        value = value * (n - k + i) / i;
    return value;
}

/* Returns (b0 - b_i) n / i from the terms c_k w^k: the descent to the i-th Bernstein coefficient,
   as the decrease over the whole interval. */
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

/* Returns the safe step for a series that is positive at t = 0. */
static Node safe_step(Lowering *l, const Series *s)
{
    Graph *g      = l->graph;
    Node   length = interval_length(l, s), power = length, steepest = NODE_NONE;
    Node   terms[MAX_DEGREE + 1];
    for (uint32_t k = 1; k <= s->degree; k++) {
        terms[k] = mul(g, s->c[k], power);
        power    = mul(g, power, length);
    }
    for (uint32_t i = 1; i <= s->degree; i++) {
        Node fall = fall_towards(l, terms, s->degree, i);
        steepest  = steepest == NODE_NONE ? fall : graph_op2(g, OP_max, steepest, fall);
    }
    Node fraction = over(g, s->c[0], at_least(g, steepest, TINY));
    fraction      = graph_op2(g, OP_min, fraction, graph_number(g, 1));
    return mul(g, length, fraction);
}

static Node along_series(Lowering *l, Series *s)
{
    Graph *g    = l->graph;
    Node   sign = graph_op1(g, OP_sign, s->c[0]);
    if (l->series_step)
        return mul(g, l->series_step(g, s), sign);
    for (uint32_t k = 0; k <= s->degree; k++)
        s->c[k] = mul(g, s->c[k], sign);
    return mul(g, safe_step(l, s), sign);
}

/* Finds the part of a ray in a box, some of whose sides may be infinite: from `enter`, which is 0
   inside, to `leave`.  The ray misses the box where `leave` is less than `enter`. */
static void clip_ray(Lowering *l, Box box, Ray ray, Node *enter, Node *leave)
{
    Graph *g = l->graph;
    *enter   = graph_number(g, 0);
    *leave   = graph_number(g, NOWHERE);
    for (uint32_t i = 0; i < 3; i++) {
        Range side = box.axis[i];
        if (!isfinite(side.low) && !isfinite(side.high))
            continue;
        Node from = graph_component(g, ray.point, i), slope = graph_component(g, ray.direction, i);
        Node tiny = graph_number(g, 1e-18);
        slope    = graph_op3(g, OP_select, graph_op2(g, OP_less, graph_op1(g, OP_abs, slope), tiny),
                             tiny, slope);
        Node low = sub(g, graph_number(g, fmax(side.low, -FAR_SIDE)), from);
        Node high = sub(g, graph_number(g, fmin(side.high, FAR_SIDE)), from);
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
        low[i]  = fmax(box.axis[i].low, -FAR_SIDE);
        high[i] = fmin(box.axis[i].high, FAR_SIDE);
    }
    Node least = graph_constant(l->graph, TYPE_VEC3, low);
    return graph_op3(l->graph, OP_clamp, point, least, graph_constant(l->graph, TYPE_VEC3, high));
}

/* Returns the point where a ray enters a box, clamped to the box, since the point is rounded. */
static Node entrance(Lowering *l, Box box, Ray ray, Node enter)
{
    Node offset = graph_op2(l->graph, OP_scale, ray.direction, enter);
    return clamp_to(l, add(l->graph, ray.point, offset), box);
}

/* Finds the step along a polynomial whose zeros all lie in a box.  A ray from outside first goes to
   the box.  The series is about the point where it enters: about a far point all its digits would
   be lost. */
static Node along_boxed(Lowering *l, const Shape *shape, Ray ray)
{
    Graph      *g = l->graph;
    Series      s;
    SeriesFault fault;
    Node        enter, leave, side = graph_number(g, shape->field->zeros.sign);
    clip_ray(l, shape->field->zeros.box, ray, &enter, &leave);
    Node origin = entrance(l, shape->field->zeros.box, ray, enter);
    if (!graph_line_series(g, shape->formula, origin, ray.direction, &s, &fault, l->scratch))
        return NODE_NONE;
    Node before = mul(g, side, enter);
    Node step   = add(g, along_series(l, &s), before);
    Node misses = graph_op2(g, OP_less, leave, enter);
    return graph_op3(g, OP_select, misses, graph_number(g, NOWHERE * shape->field->zeros.sign),
                     step);
}

/* Finds the step along a polynomial that is intersected with a region.  Outside of the region the
   result is 0, since the distance to the region is larger there. */
static Node along_cut(Lowering *l, const Shape *shape, Ray ray)
{
    Graph      *g = l->graph;
    Series      s;
    SeriesFault fault;
    Node        origin = clamp_to(l, ray.point, shape->field->region);
    if (!graph_line_series(g, shape->formula, origin, ray.direction, &s, &fault, l->scratch))
        return NODE_NONE;
    Node offset = sub(g, ray.point, origin);
    Node square = graph_op2(g, OP_dot, offset, offset), zero = graph_number(g, 0);
    Node outside = graph_op2(g, OP_less, zero, square);
    return graph_op3(g, OP_select, outside, zero, along_series(l, &s));
}

static Node along_polynomial(Lowering *l, const Shape *shape, Ray ray)
{
    Series      s;
    SeriesFault fault;
    if (box_is_finite(shape->field->region))
        return along_cut(l, shape, ray);
    if (shape->field->zeros.sign != 0)
        return along_boxed(l, shape, ray);
    return graph_line_series(l->graph, shape->formula, ray.point, ray.direction, &s, &fault,
                             l->scratch)
               ? along_series(l, &s)
               : NODE_NONE;
}

/* ---- shapes ---- */

static Node along(Lowering *l, const Shape *shape, Ray ray);

/* Finds, from outside, where a ray meets the ball of radius r about the origin.  The point of the
   ray that is nearest to the middle is at t = m, and the chord reaches as far to both of its sides.
   Its far end is found first; the near one follows from the product of both, so that nothing
   cancels.  Inside it is the distance, which is short behind the surface, as chords need it, and
   free behind the point as well. */
static Node along_ball(Lowering *l, const Shape *shape, Ray ray)
{
    Graph *g      = l->graph;
    Node   r      = at_least(g, shape->ball_radius, 0);
    Node   square = graph_op2(g, OP_dot, ray.direction, ray.direction);
    Node   m      = neg(g, over(g, graph_op2(g, OP_dot, ray.point, ray.direction), square));
    Node   offset = graph_op2(g, OP_scale, ray.direction, m);
    Node   miss   = graph_op1(g, OP_length, add(g, ray.point, offset));
    Node   size   = graph_op1(g, OP_length, ray.point);
    Node   sum    = add(g, r, miss);
    Node   half   = at_least(g, mul(g, sub(g, r, miss), sum), 0);
    Node   end    = add(g, m, root_of(g, over(g, half, square), 2));
    Node   height = sub(g, size, r);
    Node   far    = at_least(g, end, TINY);
    Node   near   = over(g, over(g, mul(g, height, add(g, size, r)), square), far);
    Node   behind = graph_op2(g, OP_less, m, graph_number(g, 0));
    Node   misses = graph_op2(g, OP_or, behind, graph_op2(g, OP_less, r, miss));
    Node   enters = graph_op3(g, OP_select, misses, graph_number(g, NOWHERE), near);
    Node   inside = over(g, height, ray.speed);
    return graph_op3(g, OP_select, graph_op2(g, OP_less, r, size), enters, inside);
}

static Node along_distance(Lowering *l, const Shape *shape, Ray ray)
{
    if (shape->ball_radius != NODE_NONE && !l->series_step)
        return along_ball(l, shape, ray);
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

/* ---- values whose sign tells inside from outside ---- */

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

/* Returns the previous point of the ray. */
static Node previous_point(Lowering *l, Ray ray)
{
    Node offset = graph_op2(l->graph, OP_scale, ray.direction, ray.back);
    return sub(l->graph, ray.point, offset);
}

/* Tells how far backwards open surfaces are looked for in an intersection.  `ahead` is the result of `along` for
   its parts without open surfaces.  If the previous point is in these parts, too, the open surfaces are looked
   for back to it.  Else no farther than the parts certainly reach. */
static Node back_within(Lowering *l, const Shape *shape, Ray ray, Node ahead)
{
    Graph *g      = l->graph;
    Node   behind = previous_point(l, ray), before = NODE_NONE;
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!shape->children[i]->open_surfaces)
            before = joined(l, OP_max, before, value_at(l, shape->children[i], behind));
    Node depth  = at_least(g, neg(g, ahead), 0);
    Node within = graph_op2(g, OP_less, before, graph_number(g, 0));
    return graph_op3(g, OP_select, within, ray.back, graph_op2(g, OP_min, ray.back, depth));
}

/* Marches along an intersection.  Parts with open surfaces come last, since their open surfaces are
   looked for inside of the others only. */
static Node along_intersection(Lowering *l, const Shape *shape, Ray ray)
{
    Node all = NODE_NONE;
    for (int open_surfaces = 0; open_surfaces < 2; open_surfaces++) {
        if (open_surfaces && shape->open_surfaces && all != NODE_NONE)
            ray.back = back_within(l, shape, ray, all);
        for (uint32_t i = 0; i < shape->child_count; i++) {
            if (shape->children[i]->open_surfaces != (open_surfaces == 1))
                continue;
            Node next = along(l, shape->children[i], ray);
            if (next == NODE_NONE)
                return NODE_NONE;
            all = joined(l, OP_max, all, next);
        }
    }
    return all;
}

/* Returns the least result of the parts from index `first` on. */
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

/* The inverse of x -> rows x scale + shift maps the ray. */
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

/* Returns the t up to which the sign does not change; negative if it changed since the previous
   point. */
static Node along_open_surface(Lowering *l, const Shape *shape, Ray ray)
{
    Graph *g    = l->graph;
    Node   step = along(l, shape->children[0], ray);
    if (step == NODE_NONE)
        return step;
    Node here   = value_at(l, shape->children[0], ray.point);
    Node before = value_at(l, shape->children[0], previous_point(l, ray));
    Node turned = graph_op1(g, OP_sign, before);
    turned      = mul(g, graph_op1(g, OP_sign, here), turned);
    Node size = graph_op1(g, OP_abs, here), all = graph_op1(g, OP_abs, before);
    all         = at_least(g, add(g, size, all), TINY);
    Node inside = mul(g, ray.back, over(g, size, all));
    step        = graph_op1(g, OP_abs, step);
    inside      = neg(g, inside);
    return graph_op3(g, OP_select, graph_op2(g, OP_less, turned, graph_number(g, 0)), inside, step);
}

static Node along_part(Lowering *l, const Shape *shape, Ray ray)
{
    return along(l, shape->children[0], ray);
}

/* ---- whether there is a polynomial in a shape, below kinds that `along` maps rays through ---- */

static bool reaches_polynomial(const Shape *shape);

static bool reaches_none(const Shape *shape)
{
    (void)shape;
    return false;
}

static bool reaches_formula(const Shape *shape)
{
    return shape->formula != NODE_NONE && shape->field->degree > 0;
}

static bool reaches_open_surface(const Shape *shape) { return shape->open_surface; }

static bool reaches_in_part(const Shape *shape) { return reaches_polynomial(shape->children[0]); }

static bool reaches_in_sharp_parts(const Shape *shape)
{
    for (uint32_t i = 0; shape->blend.width == NODE_NONE && i < shape->child_count; i++)
        if (reaches_polynomial(shape->children[i]))
            return true;
    return false;
}

/* ---- kinds ---- */

typedef struct StepRule {
    bool (*reaches)(const Shape *shape);
    Node (*value)(Lowering *l, const Shape *shape, Node point);
    Node (*along)(Lowering *l, const Shape *shape, Ray ray);
} StepRule;

static const StepRule step_none         = {reaches_none, value_distance, along_distance};
static const StepRule step_polynomial   = {reaches_formula, value_formula, along_polynomial};
static const StepRule step_map          = {reaches_in_part, value_map, along_map};
static const StepRule step_stretch      = {reaches_in_part, value_stretch, along_stretch};
static const StepRule step_open_surface = {reaches_open_surface, value_distance,
                                           along_open_surface};
static const StepRule step_union        = {reaches_in_sharp_parts, value_distance, along_union};
static const StepRule step_intersection = {reaches_in_sharp_parts, value_distance,
                                           along_intersection};
static const StepRule step_difference = {reaches_in_sharp_parts, value_distance, along_difference};
static const StepRule step_part       = {reaches_in_part, value_part, along_part};

static const StepRule *rule_of(const Shape *shape)
{
    static const StepRule *const rules[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, rays, step, ...) &step_##step,
#include "compiler/shape/shapes.def"
    };
    return rules[shape->kind];
}

static Node value_at(Lowering *l, const Shape *shape, Node point)
{
    return rule_of(shape)->value(l, shape, point);
}

static bool reaches_polynomial(const Shape *shape) { return rule_of(shape)->reaches(shape); }

/* Returns the t up to which a ray from outside stays outside; negative inside.  NODE_NONE: the
   empty set. */
static Node along(Lowering *l, const Shape *shape, Ray ray)
{
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow || !reaches_polynomial(shape) || !rays_pass(shape))
        return l->overflow ? NODE_NONE : along_distance(l, shape, ray);
    return rule_of(shape)->along(l, shape, ray);
}

Node lower_along_by(Graph *graph, const Shape *shape, Node plain, SeriesStep *step,
                    struct LoweredGroups *groups, Arena *scratch)
{
    if (!reaches_polynomial(shape))
        return plain;
    Lowering l = {.graph       = graph,
                  .scratch     = scratch,
                  .most        = graph->count + MAX_LOWERED,
                  .series_step = step,
                  .groups      = groups,
                  .thin        = true};
    Ray ray = {graph_leaf(graph, OP_POINT), graph_leaf(graph, OP_DIRECTION), graph_number(graph, 1),
               graph_leaf(graph, OP_FOOTPRINT)};
    Node all = along(&l, shape, ray);
    return l.overflow || all == NODE_NONE ? plain : all;
}

Node lower_along(Graph *graph, const Shape *shape, Node plain, struct LoweredGroups *groups,
                 Arena *scratch)
{
    return lower_along_by(graph, shape, plain, NULL, groups, scratch);
}
