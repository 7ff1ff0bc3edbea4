/*
 * ray_images.c: images of rays and balls in sequences with maps that invert (math.md, section 2).
 * They tell how far a ray may go (RESEARCH_DIRECTIONAL), and whether a ball is empty (RESEARCH_PROBE).
 *
 * The image of a ray p + t v under a conformal map F is a circle or a line through q = F(p).  Let
 * A = |F'(p)|, w the image's direction at q, and h a vector at q, which is 0 if no map inverts:
 *     F(p + t v) = q + A (t w + t^2 h) / Q,    Q = 1 + 2 t w.h + t^2 h.h.
 * The distance of the image from q is A t / sqrt(Q).  So besides the point only w and h are passed
 * inwards.  Rotations and mirrors rotate and mirror them.  An inversion at the offset z from its
 * pole turns h into R^T (h reflected along z - A z / |z|^2).  |h| is at most the B of the centred
 * bound, which is the exit below in the worst direction.  No preimage of a ball is computed, so no
 * terms cancel.
 *
 * Let a ball of radius d around q be empty.  The image of the ray leaves it at the t where
 * A t = d sqrt(Q).  If there is an inversion behind a mirror, this holds only until the image of
 * the ray crosses the mirror: the centre of the ball's preimage may be on the other side.
 *
 * The image of a ball under conformal maps is a ball.  A mirror may cut it.  Then the centre is
 * folded and the radius kept, which is safe since folding does not increase distances.
 */
#include "compiler/graph/build.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/map_chain.h"
#include "compiler/lower/research/methods.h"
#include "compiler/shape/slope.h"

/* Error of single precision in inverse lengths, relative to those of the centred bound. */
static const double ROUNDING = 1e-5;

/* A ball counts as containing the pole if its surface is this near to it, relative to the distance
   between its centre and the pole. */
static const double NEAR_POLE = 1e-3;

static const double TINY = 1e-30;

/* The image of a ray or ball behind the maps so far. */
typedef struct RayImage {
    bool     probes; /* it is a ball */
    MapChain chain;
    Node     direction;    /* of a ray: w */
    Node     bow;          /* h; NODE_NONE: 0, since no map inverts */
    Node     tilt, square; /* h.w and h.h, unless h is NODE_NONE */
    Node     crossing;   /* 1 / t where the ray crosses the first mirror since the last inversion */
    Node outer_crossing; /* the same of mirrors before an inversion; NODE_NONE: there are none */
    Node radius;         /* of the ball */
} RayImage;

static Node larger(Lowering *l, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE)
        return a == NODE_NONE ? b : a;
    return graph_op2(l->graph, OP_max, a, b);
}

/* Returns a - axis * along. */
static Node subtract_along(Lowering *l, Node a, Node axis, Node along)
{
    Node parallel = graph_op2(l->graph, OP_scale, axis, along);
    return sub(l->graph, a, parallel);
}

static Node reflected(Lowering *l, Node a, Node axis)
{
    Graph *g     = l->graph;
    Node   along = graph_op2(g, OP_dot, axis, a);
    return subtract_along(l, a, axis, mul(g, along, graph_number(g, 2)));
}

/* Returns A: the length of the image of a short piece of the ray, relative to the piece. */
static Node shrink_of(Lowering *l, const RayImage *image)
{
    Graph          *g     = l->graph;
    const MapChain *chain = &image->chain;
    if (chain->shrink != NODE_NONE)
        return chain->shrink;
    return over(g, graph_number(g, 1), chain->scale);
}

/* ---- leaves ---- */

/* Returns the t at which the image of the ray leaves the ball of radius |d| around the point. */
static Node exit_of(Lowering *l, const RayImage *image, Node d)
{
    Graph *g = l->graph;
    if (image->bow == NODE_NONE)
        return mul(g, d, image->chain.scale);
    Node shrink    = image->chain.shrink;
    Node size      = graph_op1(g, OP_abs, d);
    Node whole     = add(g, shrink, mul(g, image->chain.bend, size)); /* centred bound: d / whole */
    Node across    = sub(g, image->square, graph_op1(g, OP_square, image->tilt));
    Node bent      = mul(g, across, graph_op1(g, OP_square, size));
    Node remainder = sub(g, graph_op1(g, OP_square, shrink), bent);
    Node root      = graph_op1(g, OP_sqrt, larger(l, remainder, graph_number(g, 0)));
    Node rate      = sub(g, root, mul(g, image->tilt, size));
    if (image->outer_crossing != NODE_NONE)
        rate = larger(l, rate, mul(g, image->outer_crossing, size));
    rate = larger(l, rate, graph_number(g, 0));
    rate = add(g, rate, mul(g, whole, graph_number(g, ROUNDING)));
    rate = graph_op2(g, OP_min, rate, whole);
    return over(g, d, rate);
}

/* Converts a distance at the image into a length outside.  For a ray that is how far it may go.
   For a ball it is the distance times the ratio of the ball's radii outside and here.  So it
   exceeds the radius outside when the ball is empty. */
static Node length_outside(Lowering *l, const RayImage *image, Node distance)
{
    Graph *g = l->graph;
    if (distance == NODE_NONE)
        return NODE_NONE;
    if (!image->probes)
        return exit_of(l, image, distance);
    Node radius = graph_leaf(g, OP_FOOTPRINT);
    if (image->radius == radius)
        return distance;
    Node ratio = over(g, radius, image->radius);
    return mul(g, distance, ratio);
}

/* ---- maps ---- */

static void bend_ray(Lowering *l, RayImage *image, const Map *map, const Inversion *inversion)
{
    Graph *g       = l->graph;
    Node   curving = mul(g, shrink_of(l, image), inversion->inverse), bow;
    if (image->bow == NODE_NONE) {
        bow = graph_op2(g, OP_scale, inversion->axis, neg(g, curving));
    } else {
        Node along = graph_op2(g, OP_dot, inversion->axis, image->bow);
        along      = add(g, mul(g, along, graph_number(g, 2)), curving);
        bow        = subtract_along(l, image->bow, inversion->axis, along);
    }
    Node direction        = reflected(l, image->direction, inversion->axis);
    image->direction      = rotate_behind(g, map, direction);
    image->bow            = rotate_behind(g, map, bow);
    image->tilt           = graph_op2(g, OP_dot, direction, bow);
    image->square         = graph_op2(g, OP_dot, bow, bow);
    image->outer_crossing = larger(l, image->outer_crossing, image->crossing);
    image->crossing       = NODE_NONE;
}

/* Inverts the ball.  Returns the length outside at which a ball would contain the pole. */
static Node invert_ball(Lowering *l, RayImage *image, const Map *map)
{
    Graph *g           = l->graph;
    Node   offset      = sub(g, image->chain.point, map->shift);
    Node   square      = graph_op2(g, OP_dot, offset, offset);
    Node   remainder   = sub(g, square, graph_op1(g, OP_square, image->radius));
    Node   least       = mul(g, square, graph_number(g, NEAR_POLE));
    least              = add(g, least, graph_number(g, TINY));
    Node factor        = over(g, map->scale, larger(l, remainder, least));
    Node reach         = graph_op1(g, OP_length, offset);
    reach              = mul(g, reach, graph_number(g, 1 - NEAR_POLE));
    Node to_pole       = length_outside(l, image, reach);
    Node centre        = graph_op2(g, OP_scale, rotate_behind(g, map, offset), factor);
    image->chain.point = add(g, centre, map->pole);
    image->radius      = mul(g, image->radius, factor);
    return to_pole;
}

/* Returns the length outside up to the pole of a map for a ball, else NODE_NONE. */
static Node map_image(Lowering *l, RayImage *image, const Map *map)
{
    Graph     *g    = l->graph;
    NormalPath none = normal_path(l, context_new(image->chain.point, false), 0);
    if (image->probes && map->pole != NODE_NONE)
        return invert_ball(l, image, map);
    if (image->probes)
        image->radius = over(g, image->radius, map->scale);
    else if (map->pole != NODE_NONE) {
        Inversion inversion = inversion_at(g, map, image->chain.point);
        bend_ray(l, image, map, &inversion);
    } else {
        image->direction = rotate_behind(g, map, image->direction);
        if (image->bow != NODE_NONE)
            image->bow = rotate_behind(g, map, image->bow);
    }
    map_chain_append(l, &image->chain, map, &none);
    return NODE_NONE;
}

/* Returns 1 / t where the image of the ray crosses a mirror.  `distance` is that to the mirror, and
   `speed` the rate at which the ray approaches it.  The result is the larger root y of distance y^2
   + (2 distance h.w - speed) y + distance h.h - A h.axis = 0. */
static Node crossing_of(Lowering *l, const RayImage *image, Node axis, Node distance, Node speed)
{
    Graph *g    = l->graph;
    Node   some = larger(l, distance, graph_number(g, TINY));
    if (image->bow == NODE_NONE)
        return over(g, speed, some);
    Node half    = mul(g, speed, graph_number(g, -0.5));
    half         = add(g, half, mul(g, distance, image->tilt));
    Node curving = graph_op2(g, OP_dot, axis, image->bow);
    curving      = mul(g, curving, image->chain.shrink);
    Node rest    = sub(g, mul(g, distance, image->square), curving);
    Node inner   = mul(g, distance, rest);
    inner        = sub(g, graph_op1(g, OP_square, half), inner);
    Node root    = graph_op1(g, OP_sqrt, larger(l, inner, graph_number(g, 0)));
    /* Take the one of two forms of the root that adds terms of the same sign. */
    Node divisor = add(g, half, root);
    divisor      = larger(l, divisor, graph_number(g, TINY));
    Node leaving = over(g, neg(g, rest), divisor);
    Node nearing = over(g, sub(g, root, half), some);
    Node leaves  = graph_op2(g, OP_less, graph_number(g, 0), half);
    return graph_op3(g, OP_select, leaves, leaving, nearing);
}

static void mirror_image(Lowering *l, RayImage *image, Node axis, Node offset)
{
    Graph *g           = l->graph;
    Node   point       = image->chain.point;
    image->chain.point = graph_op3(g, OP_fold, point, axis, offset);
    if (image->probes)
        return;
    Node front       = graph_op3(g, OP_front, point, axis, offset);
    Node mirrored    = reflected(l, image->direction, axis);
    image->direction = graph_op3(g, OP_select, front, mirrored, image->direction);
    if (image->bow != NODE_NONE) {
        mirrored   = reflected(l, image->bow, axis);
        image->bow = graph_op3(g, OP_select, front, mirrored, image->bow);
    }
    Node distance   = graph_op2(g, OP_dot, axis, point);
    distance        = graph_op1(g, OP_abs, sub(g, distance, offset));
    Node speed      = graph_op2(g, OP_dot, axis, image->direction);
    speed           = mul(g, speed, shrink_of(l, image));
    Node crossing   = crossing_of(l, image, axis, distance, speed);
    image->crossing = larger(l, image->crossing, crossing);
}

/* ---- shapes ---- */

static Node image_shape(Lowering *l, const Shape *shape, RayImage image);

static Node image_none(Lowering *l, const Shape *shape, RayImage image)
{
    Lowered ball = lower_shape(l, shape, context_new(image.chain.point, false));
    if (ball.distance == NODE_NONE)
        return NODE_NONE;
    return length_outside(l, &image, divide_by_slope(l->graph, ball.distance, shape->slope));
}

/* Returns a bound, by the hull around what an inversion is applied to, converted into a length
   outside. */
static Node hull_length(Lowering *l, const RayImage *image, const Map *map, Ball ball)
{
    MapChain here = map_chain_new(l->graph, image->chain.point);
    return length_outside(l, image, map_chain_hull(l, &here, map, &ball));
}

static Node image_inversion(Lowering *l, const Shape *shape, RayImage image)
{
    Node hull  = hull_length(l, &image, &shape->map, ball_around(shape->children[0]->box));
    Node pole  = map_image(l, &image, &shape->map);
    Node inner = image_shape(l, shape->children[0], image);
    return inner == NODE_NONE ? NODE_NONE : larger(l, nearer_of(l->graph, inner, pole), hull);
}

/* Goes from the outermost stage inwards, so that nothing has to be stored.  Behind an inversion a
   kernel counts with the larger of its own length and those of the hulls so far. */
static Node image_krs(Lowering *l, const Shape *shape, RayImage image)
{
    Graph   *g    = l->graph;
    Node     hull = NODE_NONE, nearest = NODE_NONE;
    uint32_t first = 0; /* index of the first kernel; stages before it have no effect */
    while (first < shape->stage_count && shape->stages[first].kind != SEQUENCE_KERNEL)
        first++;
    for (uint32_t i = shape->stage_count; i-- > first;) {
        const SequenceStage *stage = &shape->stages[i];
        const Map           *map   = &stage->map;
        Node                 found = NODE_NONE;
        switch (stage->kind) {
        case SEQUENCE_REFLECT: mirror_image(l, &image, stage->normal, stage->offset); break;
        case SEQUENCE_SPHERE: break; /* inverts_krs */
        case SEQUENCE_KERNEL: found = image_shape(l, shape->children[stage->kernel], image); break;
        case SEQUENCE_MAP:
            if (map->pole != NODE_NONE)
                hull = larger(l, hull, hull_length(l, &image, map, shape->bounds[i - 1].ball));
            found = map_image(l, &image, map);
            break;
        }
        if (found != NODE_NONE)
            nearest = nearer_of(g, nearest, larger(l, found, hull));
    }
    return nearest;
}

static Node image_union(Lowering *l, const Shape *shape, RayImage image)
{
    Node nearest = NODE_NONE;
    for (uint32_t i = 0; i < shape->child_count; i++)
        nearest = nearer_of(l->graph, nearest, image_shape(l, shape->children[i], image));
    return nearest;
}

static Node image_map(Lowering *l, const Shape *shape, RayImage image)
{
    map_image(l, &image, &shape->map);
    return image_shape(l, shape->children[0], image);
}

static Node image_part(Lowering *l, const Shape *shape, RayImage image)
{
    return image_shape(l, shape->children[0], image);
}

/* ---- kinds ---- */

typedef Node ImageRule(Lowering *l, const Shape *shape, RayImage image);

static ImageRule *rule_of(const Shape *shape)
{
    static ImageRule *const rules[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, rays, step, image, ...) \
    image_##image,
#include "compiler/shape/shapes.def"
    };
    return rules[shape->kind];
}

static Node image_shape(Lowering *l, const Shape *shape, RayImage image)
{
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow)
        return NODE_NONE;
    return reaches_inversion(shape) ? rule_of(shape)(l, shape, image) : image_none(l, shape, image);
}

Node lower_image(Graph *graph, const Shape *shape, Node plain, bool probes,
                 struct LoweredGroups *groups, Arena *scratch)
{
    if (!reaches_inversion(shape))
        return plain;
    Lowering l      = {.graph   = graph,
                       .scratch = scratch,
                       .most    = graph->count + MAX_LOWERED,
                       .groups  = groups,
                       .thin    = true};
    RayImage image  = {.probes         = probes,
                       .bow            = NODE_NONE,
                       .tilt           = NODE_NONE,
                       .square         = NODE_NONE,
                       .crossing       = NODE_NONE,
                       .outer_crossing = NODE_NONE};
    image.chain     = map_chain_new(graph, graph_leaf(graph, OP_POINT));
    image.direction = graph_leaf(graph, OP_DIRECTION);
    image.radius    = graph_leaf(graph, OP_FOOTPRINT);
    Node all        = image_shape(&l, shape, image);
    return l.overflow || all == NODE_NONE ? plain : all;
}
