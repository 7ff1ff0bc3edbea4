/*
 * claim_pairs.c: claims of a declaration as pairs of numbers that are nowhere above 0 both.
 */
#include "compiler/eval/declared/claim_pairs.h"
#include "compiler/eval/elaborate.h"
#include "compiler/lower/context.h"
#include "compiler/shape/slope.h"

/* Returns a declared shape, or one that was moved. */
static const Shape *declared_in(const Shape *shape)
{
    while (!shape->declaration)
        shape = shape->children[0];
    return shape;
}

static void add_claim(ShapeClaims *claims, const Shape *shape, const char *property,
                      const char *wrong, Node a, Node b)
{
    const Shape *declared          = declared_in(shape);
    Span         span              = find_property(declared->declaration->syntax, property)->span;
    claims->items[claims->count++] = (ShapeClaim){property, wrong, a, b, declared, span};
}

/* A number of a plane figure is the same at every z. */
static void claim_flat(Graph *g, ShapeClaims *claims, const Shape *shape, Node number,
                       const char *wrong, Arena *scratch)
{
    Node zero = graph_number(g, 0), point = graph_leaf(g, OP_POINT);
    Node x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Node flat  = graph_op3(g, OP_vec3, x, y, zero);
    Node other = graph_substitute(g, number, substitute_point(flat), scratch);
    if (other == number)
        return;
    Node change = graph_op2(g, OP_sub, number, other);
    change      = graph_op1(g, OP_abs, change);
    add_claim(claims, shape, "figure", wrong, change, change);
}

static void claim_figure(Graph *g, ShapeClaims *claims, const Shape *shape, Arena *scratch)
{
    claim_flat(g, claims, shape, shape->declared, "its `distance` changes with z", scratch);
    if (shape->bound != NODE_NONE)
        claim_flat(g, claims, shape, shape->bound, "its `bound` changes with z", scratch);
    for (uint32_t i = 0; i < 2 && shape->uv != NODE_NONE; i++)
        claim_flat(g, claims, shape, graph_component(g, shape->uv, i), "its `uv` changes with z",
                   scratch);
}

/* The shape is where a number is not above 0. */
static void claim_region(Graph *g, ShapeClaims *claims, const Shape *shape, const char *property,
                         Node region, const char *solid, const char *empty)
{
    Node depth = graph_op1(g, OP_neg, region), inside = graph_op1(g, OP_neg, shape->distance);
    add_claim(claims, shape, property, solid, region, inside);
    add_claim(claims, shape, property, empty, depth, shape->distance);
}

static void claim_plane(Graph *g, ShapeClaims *claims, const Shape *shape)
{
    Node point  = graph_leaf(g, OP_POINT);
    Node size   = graph_op1(g, OP_length, shape->plane_normal);
    Node height = graph_op2(g, OP_dot, shape->plane_normal, point);
    height      = graph_op2(g, OP_sub, height, shape->plane_offset);
    height      = graph_op2(g, OP_div, height, size);
    claim_region(g, claims, shape, "plane", height, "it is solid outside of the half-space",
                 "it is empty inside of the half-space");
}

/* Claims that the solid is in the ball about the origin, where its radius is not negative. */
static void claim_ball(Graph *g, ShapeClaims *claims, const Shape *shape)
{
    Node height = graph_op1(g, OP_length, graph_leaf(g, OP_POINT));
    height      = graph_op2(g, OP_sub, height, shape->ball_radius);
    claim_region(g, claims, shape, "ball", height, "it is solid outside of the ball",
                 "it is empty inside of the ball");
}

/* Returns the distance of a shape where an offset is above it. */
static Node offset_distance(Graph *g, const Shape *shape, Arena *scratch)
{
    Lowering l   = {.graph = g, .scratch = scratch, .most = g->count + MAX_LOWERED};
    Lowered  all = lower_shape(&l, shape, context_new(graph_leaf(g, OP_POINT), true));
    return l.overflow || all.distance == NODE_NONE ? NODE_NONE
                                                   : divide_by_slope(g, all.distance, shape->slope);
}

/* The core is what is deeper than `rounding` in the shape: nothing less, and grown by `rounding` it
   stays within the shape.  The distances have slope 1, so one that is below -rounding at a point
   has a ball of that radius around it. */
ShapeClaims core_claims(Graph *g, const Shape *shape, const Shape *core, Node rounding,
                        Arena *scratch)
{
    ShapeClaims claims = {.count = 0};
    Node outer = offset_distance(g, shape, scratch), inner = offset_distance(g, core, scratch);
    if (outer == NODE_NONE || inner == NODE_NONE)
        return claims;
    Node grown = graph_op2(g, OP_sub, rounding, inner);
    Node deep  = graph_op1(g, OP_neg, graph_op2(g, OP_add, outer, rounding));
    add_claim(&claims, shape, "core", "grown by `rounding` it is outside of the shape", grown,
              outer);
    add_claim(&claims, shape, "core", "it leaves out what is deeper in the shape than `rounding`",
              deep, inner);
    return claims;
}

ShapeClaims hull_claims(Graph *g, const Shape *shape, const Shape *hull, Arena *scratch)
{
    ShapeClaims claims  = {.count = 0};
    Node        outside = offset_distance(g, hull, scratch);
    Node        inside  = graph_op1(g, OP_neg, shape->distance);
    if (outside != NODE_NONE)
        add_claim(&claims, shape, "hull", "it is solid outside of this hull", outside, inside);
    return claims;
}

ShapeClaims claims_of(Graph *graph, const Shape *shape, Arena *scratch)
{
    ShapeClaims claims = {.count = 0};
    if (shape->rounded)
        claims = core_claims(graph, shape->rounded, shape->children[0], shape->values[0], scratch);
    if (!shape->declaration)
        return claims;
    if (shape->figure)
        claim_figure(graph, &claims, shape, scratch);
    if (shape->plane_normal != NODE_NONE)
        claim_plane(graph, &claims, shape);
    if (shape->ball_radius != NODE_NONE)
        claim_ball(graph, &claims, shape);
    if (shape->bound != NODE_NONE) {
        Node inside = graph_op1(graph, OP_neg, shape->distance);
        add_claim(&claims, shape, "bound", "it is above 0 inside of the shape", shape->bound,
                  inside);
    }
    return claims;
}
