/*
 * map_chain.c: points and distances through conformal maps: the centred bound of math.md,
 * section 2.4.
 *
 * An inversion maps balls to balls.  Let a ball of radius d around the image of a point be empty.
 * Its preimage is a ball, too, but the point is not its centre.  The largest ball in the preimage
 * with its centre at the point has the radius r, where 1 / r = sigma / d + 1 / X.  Here sigma is
 * the factor by which the map enlarges at the point, and X the distance to the map's pole.  This is
 * affine in 1 / d, so two numbers suffice for a chain of maps: r = d / (A + B |d|).
 */
#include "compiler/lower/map_chain.h"

#include <math.h>

#include "compiler/base/elementary.h"

/* X is at least this fraction of the radius of the sphere, so that all numbers are finite. */
static const double NEAR_POLE = 1e-6;

/* A ball needs a hull unless the pole is at least this far from its surface, in radii. */
static const double CLEAR = 0.5;

/* ROUNDING: balls are enlarged by this fraction, for errors of single precision.  KEEP_OFF: the
   least distance from the pole to the surface of a ball that is inverted, as a fraction of the
   ball's radius.  Nearer, the image would be almost a half-space. */
static const double ROUNDING = 1e-5, KEEP_OFF = 0.1;

Node before_map(Graph *g, const Map *map, Node point)
{
    Node rows[3];
    transpose_rows(g, map->rows, rows);
    Node moved   = graph_op2(g, OP_sub, point, map->shift);
    Node rotated = moved;
    Node e0 = graph_vec3(g, 1, 0, 0), e1 = graph_vec3(g, 0, 1, 0), e2 = graph_vec3(g, 0, 0, 1);
    if (rows[0] != e0 || rows[1] != e1 || rows[2] != e2)
        rotated = graph_op4(g, OP_rotate, moved, rows[0], rows[1], rows[2]);
    Node one = graph_number(g, 1);
    if (map->scale == one)
        return rotated;
    Node factor = graph_op2(g, OP_div, one, map->scale);
    return graph_op2(g, OP_scale, rotated, factor);
}

MapChain map_chain_new(Graph *g, Node point)
{
    return (MapChain){point, graph_number(g, 1), NODE_NONE, NODE_NONE};
}

Node rotate_behind(Graph *g, const Map *map, Node direction)
{
    Node rows[3];
    transpose_rows(g, map->rows, rows);
    Node e0 = graph_vec3(g, 1, 0, 0), e1 = graph_vec3(g, 0, 1, 0), e2 = graph_vec3(g, 0, 0, 1);
    if (rows[0] == e0 && rows[1] == e1 && rows[2] == e2)
        return direction;
    return graph_op4(g, OP_rotate, direction, rows[0], rows[1], rows[2]);
}

/* Returns R^T offset * factor + pole. */
static Node behind_inversion(Graph *g, const Map *map, Node offset, Node factor)
{
    offset = graph_op2(g, OP_scale, rotate_behind(g, map, offset), factor);
    return graph_op2(g, OP_add, offset, map->pole);
}

Inversion inversion_at(Graph *g, const Map *map, Node point)
{
    Inversion at;
    at.offset   = graph_op2(g, OP_sub, point, map->shift);
    Node square = graph_op2(g, OP_dot, at.offset, at.offset);
    Node limit  = graph_number(g, NEAR_POLE * NEAR_POLE);
    limit       = graph_op2(g, OP_mul, map->scale, limit);
    square      = graph_op2(g, OP_max, square, limit);
    at.sigma    = graph_op2(g, OP_div, map->scale, square);
    at.inverse  = graph_op1(g, OP_inversesqrt, map->scale);
    Node size   = graph_op1(g, OP_sqrt, at.sigma);
    at.inverse  = graph_op2(g, OP_mul, size, at.inverse);
    at.axis     = graph_op2(g, OP_scale, at.offset, at.inverse);
    return at;
}

static void map_chain_invert(Lowering *l, MapChain *chain, const Map *map, NormalPath *path)
{
    Graph    *g  = l->graph;
    Inversion at = inversion_at(g, map, chain->point);
    if (chain->shrink == NODE_NONE) {
        Node one      = graph_number(g, 1);
        chain->shrink = graph_op2(g, OP_div, one, chain->scale);
        chain->bend   = graph_number(g, 0);
    }
    Node bend     = graph_op2(g, OP_mul, chain->shrink, at.inverse);
    chain->bend   = graph_op2(g, OP_add, chain->bend, bend);
    chain->shrink = graph_op2(g, OP_mul, chain->shrink, at.sigma);
    chain->point  = behind_inversion(g, map, at.offset, at.sigma);
    if (l->surfaces) {
        Node one   = graph_number(g, 1);
        Node grown = graph_op2(g, OP_div, one, at.sigma);
        normal_flip(l, path, at.axis);
        normal_rotate(l, path, map->rows, grown);
    }
}

void map_chain_append(Lowering *l, MapChain *chain, const Map *map, NormalPath *path)
{
    Graph *g = l->graph;
    if (map->pole != NODE_NONE) {
        map_chain_invert(l, chain, map, path);
        return;
    }
    chain->point = before_map(g, map, chain->point);
    normal_rotate(l, path, map->rows, map->scale);
    if (chain->shrink == NODE_NONE)
        chain->scale = graph_op2(g, OP_mul, chain->scale, map->scale);
    else
        chain->shrink = graph_op2(g, OP_div, chain->shrink, map->scale);
}

Lowered map_chain_out(Lowering *l, const MapChain *chain, Lowered result)
{
    Graph *g = l->graph;
    if (chain->shrink == NODE_NONE || result.distance == NODE_NONE)
        return scale_distance(l, result, chain->scale);
    Node size       = graph_op1(g, OP_abs, result.distance);
    Node bend       = graph_op2(g, OP_mul, chain->bend, size);
    Node divisor    = graph_op2(g, OP_add, chain->shrink, bend);
    result.distance = graph_op2(g, OP_div, result.distance, divisor);
    return result;
}

Node enter_map_chain(Lowering *l, const MapChain *chain)
{
    if (!l->guarded || chain->shrink == NODE_NONE)
        return enter_scale(l, chain->scale);
    Node one = graph_number(l->graph, 1);
    return enter_scale(l, graph_op2(l->graph, OP_div, one, chain->shrink));
}

static Range frame_range(Lowering *l, Node node, uint32_t component)
{
    if (graph_is_constant(l->graph, node))
        return range_of(l->graph->items[node].number[component]);
    return graph_frame_range(l->graph, node, component, l->scratch);
}

/*
 * The centred bound is less than X, so at a pole it is 0 as on a surface.  But the inverted shape
 * lies in a ball.  The image of the ball is the inside or the outside of another ball, and does not
 * contain the pole.  The distance to that image is a larger bound near the pole, and 1-Lipschitz.
 */
Node map_chain_hull(Lowering *l, const MapChain *chain, const Map *map, Ball *ball)
{
    Graph *g = l->graph;
    if (ball->radius < 0 || isinf(ball->radius))
        return NODE_NONE;
    Node offset    = graph_constant(g, TYPE_VEC3, ball->centre);
    offset         = graph_op2(g, OP_sub, offset, map->pole);
    Node   square  = graph_op2(g, OP_dot, offset, offset);
    Range  squared = frame_range(l, square, 0);
    double radius  = ball->radius * (1 + ROUNDING);
    bool   outside = !(squared.low >= radius * radius * (1 + KEEP_OFF) * (1 + KEEP_OFF));
    if (outside)
        radius = fmax(radius, sqrt(squared.high) * (1 + KEEP_OFF));
    if (isinf(radius) || radius == 0)
        return NODE_NONE;
    ball->radius = radius;
    /* Centre and radius of the image: scale (R offset, radius) / (|offset|^2 - radius^2).  The
       divisor is negative where the image is the outside of a ball. */
    Node rest           = graph_number(g, radius * radius);
    rest                = graph_op2(g, OP_sub, square, rest);
    Node factor         = graph_op2(g, OP_div, map->scale, rest);
    Node centre         = graph_op4(g, OP_rotate, offset, map->rows[0], map->rows[1], map->rows[2]);
    centre              = graph_op2(g, OP_scale, centre, factor);
    centre              = graph_op2(g, OP_add, centre, map->shift);
    Node size           = graph_number(g, radius);
    size                = graph_op2(g, OP_mul, size, factor);
    Node    from_centre = graph_op2(g, OP_sub, chain->point, centre);
    Node    length      = graph_op1(g, OP_length, from_centre);
    Lowered bound       = lowered_nothing;
    if (outside)
        length = graph_op1(g, OP_neg, length);
    bound.distance = graph_op2(g, OP_sub, length, size);
    return map_chain_out(l, chain, bound).distance;
}

/* ---- bounds around the poles of sequences ---- */

/* Returns a ball around all positions of a ball whose centre depends on parameters. */
static Ball ball_about(Lowering *l, Node centre, double radius)
{
    Ball   ball;
    double spread = 0;
    for (uint32_t i = 0; i < 3; i++) {
        Range range    = frame_range(l, centre, i);
        ball.centre[i] = 0.5 * (range.low + range.high);
        spread         = real_hypot(spread, 0.5 * (range.high - range.low));
    }
    ball.radius = isfinite(spread) ? radius + spread : HUGE_VAL;
    return ball;
}

void pole_bounds_fold(Lowering *l, PoleBounds *pole_bounds, Node normal, Node offset)
{
    if (isinf(pole_bounds->within.radius))
        return;
    Node centre         = graph_constant(l->graph, TYPE_VEC3, pole_bounds->within.centre);
    centre              = graph_op3(l->graph, OP_fold, centre, normal, offset);
    pole_bounds->within = ball_about(l, centre, pole_bounds->within.radius);
}

/* Returns a ball around the image of a ball under the inverse of a map.  Its radius is infinite if
   the pole is not CLEAR of the ball. */
static Ball ball_behind(Lowering *l, const Map *map, Ball ball)
{
    Graph *g      = l->graph;
    Ball   around = {.radius = HUGE_VAL};
    if (isinf(ball.radius))
        return around;
    Node centre = graph_constant(g, TYPE_VEC3, ball.centre);
    if (map->pole == NODE_NONE) {
        Range scale = frame_range(l, map->scale, 0);
        return ball_about(l, before_map(g, map, centre), ball.radius / scale.low);
    }
    double least  = (1 + CLEAR) * ball.radius;
    Node   offset = graph_op2(g, OP_sub, centre, map->shift);
    Node   square = graph_op2(g, OP_dot, offset, offset);
    if (!(frame_range(l, square, 0).low >= least * least))
        return around;
    Node rest   = graph_number(g, ball.radius * ball.radius);
    rest        = graph_op2(g, OP_sub, square, rest);
    Node factor = graph_op2(g, OP_div, map->scale, rest);
    centre      = behind_inversion(g, map, offset, factor);
    return ball_about(l, centre, ball.radius * frame_range(l, factor, 0).high);
}

bool pole_bounds_append(Lowering *l, PoleBounds *pole_bounds, const MapChain *chain, const Map *map,
                        Ball ball)
{
    pole_bounds->within = ball_behind(l, map, pole_bounds->within);
    if (map->pole == NODE_NONE || !isinf(pole_bounds->within.radius))
        return false;
    Node hull = map_chain_hull(l, chain, map, &ball);
    if (hull == NODE_NONE)
        return false;
    pole_bounds->within   = ball;
    pole_bounds->distance = farther_of(l->graph, pole_bounds->distance, hull);
    return true;
}

Node nearer_of(Graph *g, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE)
        return a == NODE_NONE ? b : a;
    return graph_op2(g, OP_min, a, b);
}

Node farther_of(Graph *g, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE)
        return a == NODE_NONE ? b : a;
    return graph_op2(g, OP_max, a, b);
}
