/*
 * context.c: the walk through a tree of shapes that lowers it.
 *
 * On the way down the tree the point is mapped into each shape's own space.  On the way up
 * distances are joined.  There are two lowerings: of the distance alone, which rays evaluate at
 * every step, and of the distance with material, level and instance, evaluated once per hit.
 *
 * A distance has the slope that the family of its shape derived.  The root is divided by that of
 * the whole shape, and is then 1-Lipschitz.  A primitive may have a larger `bound` as well, which
 * need not be Lipschitz but never exceeds the distance.  It is used where only sharp CSG nodes and
 * maps of space are above the primitive.
 */
#include "compiler/lower/context.h"

#include <math.h>

const Lowered lowered_nothing = {
    .distance = NODE_NONE,
#define KRS_INNER(name, blends) .surface.name = NODE_NONE,
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "krs/surface.def"
};

LowerContext context_new(Node point, bool lipschitz)
{
    return (LowerContext){.point     = point,
                          .level     = NODE_NONE,
                          .instance  = NODE_NONE,
                          .lipschitz = lipschitz,
                          .normal    = NODE_NONE,
                          .footprint = NODE_NONE,
                          .reach     = lipschitz ? HUGE_VAL : 0,
                          .smoothing = NODE_NONE};
}

LowerContext context_at(LowerContext context, Node point)
{
    context.point = point;
    return context;
}

LowerContext context_lipschitz(LowerContext context)
{
    return context_lipschitz_within(context, HUGE_VAL);
}

LowerContext context_lipschitz_within(LowerContext context, double more)
{
    context.lipschitz = true;
    context.reach += fmax(more, 0);
    return context;
}

LowerContext context_divided(LowerContext context, double factor)
{
    context.lipschitz = true;
    if (context.reach > 0) /* 0 stays 0, even where the factor has no bound */
        context.reach = isfinite(factor) ? context.reach * factor : HUGE_VAL;
    return context;
}

double reach_behind(const Graph *graph, double reach, Node scale)
{
    if (reach == 0 || !isfinite(reach))
        return reach;
    const Expr *e = &graph->items[scale];
    return graph_is_constant(graph, scale) && e->number[0] > 0 ? reach / e->number[0] : HUGE_VAL;
}

/* ---- shapes whose parts a ray may step through (column `rays` of shapes.def) ---- */

static bool rays_always(const Shape *shape)
{
    (void)shape;
    return true;
}

static bool rays_never(const Shape *shape)
{
    (void)shape;
    return false;
}

static bool rays_open_surface(const Shape *shape) { return shape->open_surface; }

static bool rays_sharp(const Shape *shape) { return shape->blend.width == NODE_NONE; }

static bool rays_difference(const Shape *shape)
{
    for (uint32_t i = 1; i < shape->child_count; i++)
        if (shape->children[i]->open_surfaces)
            return false;
    return rays_sharp(shape);
}

/* ---- kinds ---- */

static const struct {
    LowerShape *lower;
    bool (*rays)(const Shape *shape);
} rules[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, rays, ...) \
    {lower_##name, rays_##rays},
#include "compiler/shape/shapes.def"
};

bool rays_pass(const Shape *shape) { return rules[shape->kind].rays(shape); }

Lowered lower_shape(Lowering *l, const Shape *shape, LowerContext context)
{
    bool thin      = l->thin;
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow)
        return lowered_nothing;
    l->thin        = thin && rays_pass(shape);
    Lowered result = rules[shape->kind].lower(l, shape, context);
    l->thin        = thin;
    /* Smooth mirrors and bumps alone change the normal. */
    if (result.distance != NODE_NONE && context.smoothing == NODE_NONE && !shape->smooth)
        result.surface.normal = context.normal;
    if (l->surfaces && result.surface.front == NODE_NONE)
        result.surface.front = graph_leaf(l->graph, OP_FRONT);
    if (l->surfaces && shape->shown > 0)
        result.surface.component = graph_uint(l->graph, shape->shown);
    if (l->lowered_shapes)
        array_push(l->scratch, l->lowered_shapes,
                   ((LoweredShape){shape, context.point, result.distance}));
    return result;
}

Lowered scale_distance(Lowering *l, Lowered result, Node factor)
{
    if (result.distance != NODE_NONE && factor != graph_number(l->graph, 1))
        result.distance = graph_op2(l->graph, OP_mul, result.distance, factor);
    return result;
}

Node enter_scale(Lowering *l, Node scale)
{
    Node unit = l->unit;
    if (l->guarded)
        l->unit = graph_op2(l->graph, OP_mul, unit, scale);
    return unit;
}
