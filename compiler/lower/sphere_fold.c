/*
 * sphere_fold.c: mirrors that are spheres: points, distances and normals through them (math.md,
 * section 1, "Spheres").
 *
 * What is outside of the sphere stays, and its image is inside.  A point inside is taken out by the
 * inversion.  Let a ball of radius d around it be empty there.  With q, the distance of the point
 * from the centre, the ball around the point is empty whose radius is d / max(1, (k + d) / q).  Here
 * k is r for a point outside, and r^2 / q for one inside: the centred bound of inversions.
 */
#include "compiler/lower/sphere_fold.h"

#include <math.h>

#include "compiler/graph/build.h"

/* q is at least this fraction of the radius, so that all numbers are finite. */
static const double NEAR_CENTRE = 1e-6;

/* Balls are enlarged by this fraction, for errors of single precision. */
static const double ROUNDING = 1e-5;

/* A point inside has no image farther out than the ball reaches, unless it is nearer to the centre
   than the image of that place.  So the distance to that core is a bound in it, where the centred
   bound falls to 0. */
static Node core_distance(Graph *g, const SequenceStage *stage, Node square, Node length, Ball ball)
{
    if (!(ball.radius >= 0) || isinf(ball.radius))
        return NODE_NONE;
    Node centre = graph_constant(g, TYPE_VEC3, ball.centre);
    Node reach  = graph_op1(g, OP_length, sub(g, centre, stage->centre));
    reach       = add(g, reach, graph_number(g, ball.radius));
    reach       = mul(g, reach, graph_number(g, 1 + ROUNDING));
    reach       = graph_op2(g, OP_max, reach, stage->radius);
    return sub(g, over(g, square, reach), length);
}

SphereFold sphere_fold_at(Graph *g, const SequenceStage *stage, Node point, Ball ball)
{
    SphereFold fold;
    Node       one = graph_number(g, 1), zero = graph_number(g, 0);
    Node       offset = sub(g, point, stage->centre);
    Node       length = graph_op1(g, OP_length, offset);
    Node       most   = mul(g, stage->radius, stage->radius);
    Node       limit  = mul(g, stage->radius, graph_number(g, NEAR_CENTRE));
    fold.inverse      = over(g, one, graph_op2(g, OP_max, length, limit));
    Node ratio        = mul(g, stage->radius, fold.inverse);
    Node grown        = graph_op2(g, OP_max, ratio, one);
    fold.least        = mul(g, stage->radius, grown);
    fold.sigma        = mul(g, grown, grown);
    /* Outside nothing is added, so that points stay what they are. */
    Node excess = graph_op2(g, OP_max, sub(g, mul(g, ratio, ratio), one), zero);
    fold.point  = add(g, point, graph_op2(g, OP_scale, offset, excess));
    fold.core   = core_distance(g, stage, most, length, ball);
    return fold;
}

Lowered sphere_fold_out(Lowering *l, const SphereFold *fold, Lowered result)
{
    Graph *g = l->graph;
    if (result.distance == NODE_NONE)
        return result;
    Node reach      = add(g, fold->least, graph_op1(g, OP_abs, result.distance));
    Node divisor    = mul(g, reach, fold->inverse);
    divisor         = graph_op2(g, OP_max, divisor, graph_number(g, 1));
    result.distance = over(g, result.distance, divisor);
    if (fold->core != NODE_NONE)
        result.distance = graph_op2(g, OP_max, result.distance, fold->core);
    return result;
}

/* Tells how deep a point is inside of the sphere. */
static Node depth_of(Graph *g, const SequenceStage *stage, Node point)
{
    Node length = graph_op1(g, OP_length, sub(g, point, stage->centre));
    return sub(g, stage->radius, length);
}

Node sphere_front(Graph *g, const SequenceStage *stage, Node point)
{
    Node depth = depth_of(g, stage, point);
    return graph_op2(g, OP_less, graph_number(g, 0), depth);
}

void normal_sphere(Lowering *l, NormalPath *path, const SequenceStage *stage, Node point,
                   const SphereFold *fold)
{
    Graph *g = l->graph;
    if (!l->surfaces)
        return;
    Node axis  = graph_op2(g, OP_scale, sub(g, point, stage->centre), fold->inverse);
    Node front = sphere_front(g, stage, point), depth = depth_of(g, stage, point);
    normal_mirror(l, path, axis, depth, front);
    normal_stretch_evenly(l, path, over(g, graph_number(g, 1), fold->sigma));
}
