/*
 * bump.c: normals of a surface that seems to be higher in some places.
 *
 * The height h is looked at a pixel's radius from the point, on both sides along two tangents of the
 * surface.  So what is finer than a pixel turns no normal.  A step moves the point in the space of the
 * material by a vector d, and h changes by c.  There the surface leans against d by c / |d|: the normal
 * is n - d c / |d|^2, for both tangents.
 */
#include "compiler/lower/bump.h"

#include "compiler/lower/footprint.h"

/* The least step, in parts of the distance from the origin and of 1: where nobody looks, a pixel has
   no size, and nearer points have no difference in single precision. */
static const double MIN_STEP = 1e-4;
/* The least that |d|^2 counts as. */
static const double MIN_SQUARE = 1e-30;

static Node step_of(Graph *g, Pixel pixel)
{
    Node far   = graph_op1(g, OP_length, pixel.point);
    Node one   = graph_number(g, 1);
    Node size  = graph_op2(g, OP_add, far, one);
    Node least = graph_number(g, MIN_STEP);
    least      = graph_op2(g, OP_mul, size, least);
    return graph_op2(g, OP_max, pixel.radius, least);
}

/* Finds two unit vectors across a normal and each other.  The axis is one that the normal is not
   near to. */
static void find_tangents(Graph *g, Node normal, Node tangents[2])
{
    Node x = graph_component(g, normal, 0), half = graph_number(g, 0.6);
    Node size    = graph_op1(g, OP_abs, x);
    Node across  = graph_op2(g, OP_less, size, half);
    Node along_x = graph_vec3(g, 1, 0, 0), along_y = graph_vec3(g, 0, 1, 0);
    Node axis    = graph_op3(g, OP_select, across, along_x, along_y);
    Node tangent = graph_op2(g, OP_cross, axis, normal);
    tangents[0]  = graph_op1(g, OP_normalize, tangent);
    tangents[1]  = graph_op2(g, OP_cross, normal, tangents[0]);
}

/* Tells how much an expression changes from one side of the point to the other. */
static Node change_of(Graph *g, Node expression, Pixel pixel, Node step, Arena *scratch)
{
    Node ahead = graph_op2(g, OP_add, pixel.point, step);
    Node back  = graph_op2(g, OP_sub, pixel.point, step);
    Node here  = graph_replace_leaf(g, expression, pixel.point, ahead, scratch);
    Node there = graph_replace_leaf(g, expression, pixel.point, back, scratch);
    return graph_op2(g, OP_sub, here, there);
}

Node bumped_normal(Graph *graph, Node height, Node point, Node normal, Arena *scratch)
{
    Pixel pixel = pixel_of(graph, point, scratch);
    Node  size  = step_of(graph, pixel), tangents[2];
    Node  least = graph_number(graph, MIN_SQUARE);
    find_tangents(graph, pixel.normal, tangents);
    for (int i = 0; i < 2; i++) {
        Node step   = graph_op2(graph, OP_scale, tangents[i], size);
        Node rise   = change_of(graph, height, pixel, step, scratch);
        Node moved  = change_of(graph, point, pixel, step, scratch);
        Node square = graph_op2(graph, OP_dot, moved, moved);
        Node length = graph_op2(graph, OP_max, square, least);
        Node share  = graph_op2(graph, OP_div, rise, length);
        Node lean   = graph_op2(graph, OP_scale, moved, share);
        normal      = graph_op2(graph, OP_sub, normal, lean);
    }
    return graph_op1(graph, OP_normalize, normal);
}
