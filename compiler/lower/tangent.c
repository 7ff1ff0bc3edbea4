/*
 * tangent.c: the direction in which the highlights of a surface are drawn out.
 *
 * A shape's own space is a map of the scene: q = f(p).  A step d in the scene is J d there, where the
 * rows of J are the gradients of q's coordinates.  So a direction t of the shape is d = J^-1 t of
 * the scene, and with a, b and c for the rows of J
 *     d = (t.x b x c + t.y c x a + t.z a x b) / (a . (b x c)).
 * That is right behind any maps, mirrors and deformations, as graph_known_gradient knows them.
 *
 * On the surface v stays where a step is across its gradient and across the normal.  Where the surface
 * is one of those on which v is the same all over, the gradient of u is taken.
 */
#include "compiler/lower/tangent.h"

#include "compiler/graph/build.h"
#include "compiler/graph/symbolic/derive.h"
#include "compiler/lower/footprint.h"

/* The part of v's gradient that is along the surface, squared: less is none. */
static const double MIN_SHARE = 1e-4;

/* Returns the vector, or its opposite where a number is below 0. */
static Node turned_by_sign(Graph *g, Node vector, Node number)
{
    Node below = graph_op2(g, OP_less, number, graph_number(g, 0));
    Node back  = neg(g, vector);
    return graph_op3(g, OP_select, below, back, vector);
}

Node tangent_outwards(Graph *g, Node tangent, Node point, Arena *scratch)
{
    Node rows[3], across[3], sum = NODE_NONE;
    if (tangent == NODE_NONE || point == pixel_of(g, point, scratch).point)
        return tangent == NODE_NONE ? NODE_NONE : graph_op1(g, OP_normalize, tangent);
    for (int i = 0; i < 3; i++) {
        Node coordinate = graph_component(g, point, (uint32_t)i);
        rows[i]         = graph_known_gradient(g, coordinate, scratch);
    }
    for (int i = 0; i < 3; i++)
        across[i] = graph_op2(g, OP_cross, rows[(i + 1) % 3], rows[(i + 2) % 3]);
    for (int i = 0; i < 3; i++) {
        Node part = graph_op2(g, OP_scale, across[i], graph_component(g, tangent, (uint32_t)i));
        sum       = sum == NODE_NONE ? part : add(g, sum, part);
    }
    Node volume = graph_op2(g, OP_dot, rows[0], across[0]);
    return graph_op1(g, OP_normalize, turned_by_sign(g, sum, volume));
}

Node tangent_of_uv(Graph *g, Node uv, Arena *scratch)
{
    Node u = graph_component(g, uv, 0), v = graph_component(g, uv, 1);
    Node of_u = graph_known_gradient(g, u, scratch), of_v = graph_known_gradient(g, v, scratch);
    Node along  = graph_op2(g, OP_cross, of_v, pixel_of(g, uv, scratch).normal);
    Node grows  = graph_op2(g, OP_dot, along, of_u);
    Node ahead  = turned_by_sign(g, along, grows);
    Node square = graph_op2(g, OP_dot, along, along), all = graph_op2(g, OP_dot, of_v, of_v);
    Node least = mul(g, all, graph_number(g, MIN_SHARE));
    Node stays = graph_op2(g, OP_less, square, least); /* v does all over, as on a lid */
    return graph_op1(g, OP_normalize, graph_op3(g, OP_select, stays, of_u, ahead));
}
