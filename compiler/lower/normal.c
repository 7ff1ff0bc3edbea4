/*
 * normal.c: maps the normal of a surface into each shape's space, and back.
 *
 * On the way in it is mapped like the point, so that materials have both in the shape's space.  The
 * way back is needed only where mirrors are smooth (math.md, section 1, "Smooth shading").  On the
 * way in a mirror reflects the normal or leaves it.  On the way out it reflects by an amount that
 * rises from 0 to 1 across the mirror.  Elsewhere the result is the normal at the start.
 */
#include "compiler/lower/normal.h"

#include "compiler/shape/map.h"

/* The least width of a smooth mirror that is divided by, so that quotients are finite. */
static const double NO_WIDTH = 1e-30;
/* A normal whose squared length is less has no direction: smooth mirrors have averaged it away. */
static const double NO_LENGTH = 1e-8;

/* Returns normal - 2 amount (axis . normal) axis: it is reflected where the amount is 1. */
static Node mirrored(Graph *g, Node normal, Node axis, Node amount)
{
    Node along      = graph_op2(g, OP_dot, normal, axis);
    Node two        = graph_number(g, 2);
    Node twice      = graph_op2(g, OP_mul, amount, two);
    Node back       = graph_op2(g, OP_mul, twice, along);
    Node correction = graph_op2(g, OP_scale, axis, back);
    return graph_op2(g, OP_sub, normal, correction);
}

static Node rotated(Graph *g, Node vector, const Node rows[3])
{
    return graph_op4(g, OP_rotate, vector, rows[0], rows[1], rows[2]);
}

Node unit_normal(Graph *g, Node normal, Node otherwise)
{
    if (normal == otherwise)
        return normal;
    Node least  = graph_number(g, NO_LENGTH);
    Node square = graph_op2(g, OP_dot, normal, normal);
    Node gone   = graph_op2(g, OP_less, square, least);
    Node unit   = graph_op1(g, OP_normalize, normal);
    return graph_op3(g, OP_select, gone, otherwise, unit);
}

/* Converts the lengths of a context into a space whose unit is `stretch` times as long outside. */
static LowerContext place_stretched(Graph *g, LowerContext context, Node stretch)
{
    if (stretch == graph_number(g, 1))
        return context;
    context.footprint = graph_op2(g, OP_div, context.footprint, stretch);
    if (context.smoothing != NODE_NONE)
        context.smoothing = graph_op2(g, OP_div, context.smoothing, stretch);
    return context;
}

/* Returns by how much a mirror reflects the normal: 0 or 1 or, for a smooth mirror, a ramp from 0
   to 1 across it.  `height` is the point's signed distance to the mirror, `front` whether it is
   reflected. */
static Node mirrored_amount(Graph *g, LowerContext context, Node height, Node front)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1);
    if (context.smoothing == NODE_NONE)
        return graph_op3(g, OP_select, front, one, zero);
    Node least = graph_number(g, NO_WIDTH), half = graph_number(g, 0.5);
    Node width  = graph_op2(g, OP_max, context.smoothing, least);
    Node amount = graph_op2(g, OP_div, height, width);
    amount      = graph_op2(g, OP_add, amount, half);
    return graph_op3(g, OP_clamp, amount, zero, one);
}

/* ---- steps ---- */

NormalPath normal_path(Lowering *l, LowerContext context, uint32_t most)
{
    NormalPath path = {.innermost = context};
    if (l->surfaces)
        path.steps = arena_new_array(l->scratch, NormalStep, most + 1);
    return path;
}

static NormalStep *add_step(NormalPath *path, NormalStep step)
{
    path->steps[path->count] = step;
    return &path->steps[path->count++];
}

void normal_rotate(Lowering *l, NormalPath *path, const Node rows[3], Node stretch)
{
    Graph *g = l->graph;
    if (!l->surfaces)
        return;
    Node back[3];
    transpose_rows(g, rows, back);
    path->innermost        = place_stretched(g, path->innermost, stretch);
    path->innermost.normal = rotated(g, path->innermost.normal, back);
    NormalStep *step       = add_step(path, (NormalStep){.kind = NORMAL_ROTATE});
    for (int i = 0; i < 3; i++)
        step->rows[i] = rows[i];
}

/* Finds the rows of the rotation about y that takes one direction to another, both projected to the
   plane of x and z. */
static void rows_about_y(Graph *g, Node from, Node to, Node rows[3])
{
    Node a[2][2], zero = graph_number(g, 0);
    for (int i = 0; i < 2; i++) {
        Node point = i ? to : from;
        Node x = graph_component(g, point, 0), z = graph_component(g, point, 2);
        Node flat = graph_op2(g, OP_vec2, x, z);
        flat      = graph_op1(g, OP_normalize, flat);
        a[i][0]   = graph_component(g, flat, 0);
        a[i][1]   = graph_component(g, flat, 1);
    }
    Node xx     = graph_op2(g, OP_mul, a[0][0], a[1][0]);
    Node zz     = graph_op2(g, OP_mul, a[0][1], a[1][1]);
    Node xz     = graph_op2(g, OP_mul, a[0][0], a[1][1]);
    Node zx     = graph_op2(g, OP_mul, a[0][1], a[1][0]);
    Node cosine = graph_op2(g, OP_add, xx, zz);
    Node sine   = graph_op2(g, OP_sub, xz, zx);
    Node back   = graph_op1(g, OP_neg, sine);
    rows[0]     = graph_op3(g, OP_vec3, cosine, zero, back);
    rows[1]     = graph_vec3(g, 0, 1, 0);
    rows[2]     = graph_op3(g, OP_vec3, sine, zero, cosine);
}

void normal_rotate_about_y(Lowering *l, NormalPath *path, Node outer, Node inner)
{
    Node rows[3];
    if (!l->surfaces)
        return;
    rows_about_y(l->graph, inner, outer, rows);
    normal_rotate(l, path, rows, graph_number(l->graph, 1));
}

void normal_stretch(Lowering *l, NormalPath *path, Node factors, Node least)
{
    if (!l->surfaces)
        return;
    path->innermost        = place_stretched(l->graph, path->innermost, least);
    path->innermost.normal = graph_op2(l->graph, OP_mul, path->innermost.normal, factors);
    path->innermost.normal = graph_op1(l->graph, OP_normalize, path->innermost.normal);
    add_step(path, (NormalStep){.kind = NORMAL_STRETCH, .rows = {factors}});
}

void normal_flip(Lowering *l, NormalPath *path, Node axis)
{
    if (!l->surfaces)
        return;
    Node whole             = graph_number(l->graph, 1);
    path->innermost.normal = mirrored(l->graph, path->innermost.normal, axis, whole);
    add_step(path, (NormalStep){.kind = NORMAL_MIRROR, .axis = axis, .amount = whole});
}

void normal_mirror(Lowering *l, NormalPath *path, Node axis, Node height, Node front)
{
    Graph       *g    = l->graph;
    LowerContext bare = path->innermost;
    bare.smoothing    = NODE_NONE;
    Node       hard   = mirrored_amount(g, bare, height, front);
    NormalStep step   = {.kind = NORMAL_MIRROR, .axis = axis};
    step.amount       = mirrored_amount(g, path->innermost, height, front);
    add_step(path, step);
    path->innermost.normal = mirrored(g, path->innermost.normal, axis, hard);
}

void normal_fold(Lowering *l, NormalPath *path, Node point, Node axis, Node offset)
{
    Graph *g = l->graph;
    if (!l->surfaces)
        return;
    Node along  = graph_op2(g, OP_dot, axis, point);
    Node height = graph_op2(g, OP_sub, along, offset);
    Node front  = graph_op3(g, OP_front, point, axis, offset);
    normal_mirror(l, path, axis, height, front);
}

void normal_stretch_evenly(Lowering *l, NormalPath *path, Node stretch)
{
    if (l->surfaces)
        path->innermost = place_stretched(l->graph, path->innermost, stretch);
}

void normal_kernel(Lowering *l, NormalPath *path, Lowered outer, Lowered kernel)
{
    if (!l->surfaces || kernel.distance == NODE_NONE)
        return;
    NormalStep step = {.kind = NORMAL_KERNEL, .normal = kernel.surface.normal};
    step.nearer     = outer.distance == NODE_NONE
                          ? graph_bool(l->graph, true)
                          : graph_op2(l->graph, OP_less, kernel.distance, outer.distance);
    add_step(path, step);
}

LowerContext context_behind(const NormalPath *path, LowerContext context, Node point)
{
    context.point     = point;
    context.normal    = path->innermost.normal;
    context.footprint = path->innermost.footprint;
    context.smoothing = path->innermost.smoothing;
    return context;
}

/* Goes from the innermost step outwards.  The normal is that of the nearest kernel so far.  `hit`
   says that this kernel is also nearer than all kernels further out. */
Node normal_out(Lowering *l, const NormalPath *path, Node inner)
{
    Graph *g      = l->graph;
    Node   normal = inner, hit = graph_bool(g, false);
    if (!l->surfaces || inner == NODE_NONE)
        return NODE_NONE;
    for (uint32_t i = path->count; i-- > 0;) {
        const NormalStep *step = &path->steps[i];
        if (step->kind == NORMAL_MIRROR)
            normal = mirrored(g, normal, step->axis, step->amount);
        else if (step->kind == NORMAL_ROTATE)
            normal = rotated(g, normal, step->rows);
        else if (step->kind == NORMAL_STRETCH) {
            normal = graph_op2(g, OP_div, normal, step->rows[0]);
            normal = graph_op1(g, OP_normalize, normal);
        } else {
            normal = graph_op3(g, OP_select, hit, normal, step->normal);
            hit    = graph_op2(g, OP_or, hit, step->nearer);
        }
    }
    return normal;
}

Lowered lower_behind(Lowering *l, const Shape *child, LowerContext context, const NormalPath *path,
                     Node point)
{
    Lowered result        = lower_shape(l, child, context_behind(path, context, point));
    result.surface.normal = normal_out(l, path, result.surface.normal);
    return result;
}
