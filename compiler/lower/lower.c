/*
 * lower.c: from the shape of a component to the roots of its graph.
 */
#include "compiler/lower/lower.h"

#include "compiler/base/far.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/derive.h"
#include "compiler/lower/instance_groups.h"
#include "compiler/lower/normal.h"
#include "compiler/shape/slope.h"

const RootInfo root_info[ROOT_COUNT] = {
#define LIMITED   true
#define UNLIMITED false
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    [ROOT_##name] = {#name, TYPE_##type, TYPE_##type, otherwise, nothing, true, low, high, asked},
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) \
    [ROOT_##name] = {#name, TYPE_##type, TYPE_##shown, otherwise, nothing, false, 0, 0, false},
#include "krs/surface.def"
};

Node root_otherwise(Graph *graph, ComponentRoot root)
{
    double       number     = root_info[root].otherwise;
    const double numbers[3] = {number, number, number};
    return graph_constant(graph, root_info[root].type, numbers);
}

static Node or_else(Node node, Node otherwise) { return node == NODE_NONE ? otherwise : node; }

bool lower_component(Graph *graph, const Shape *shape, uint32_t number,
                     struct LoweredGroups *groups, Arena *scratch, Node *roots, Node *place)
{
    Lowering     l       = {.graph    = graph,
                            .scratch  = scratch,
                            .surfaces = true,
                            .thin     = true,
                            .most     = graph->count + MAX_LOWERED,
                            .groups   = groups,
                            .places   = place != NULL};
    LowerContext context = context_new(graph_leaf(graph, OP_POINT), false);
    context.normal       = graph_leaf(graph, OP_NORMAL);
    context.footprint    = graph_leaf(graph, OP_FOOTPRINT);
    Lowered all          = lower_shape(&l, shape, context);
    Node    distance     = or_else(all.distance, graph_number(graph, NOWHERE));
    roots[ROOT_DISTANCE] = divide_by_slope(graph, distance, shape->slope);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    roots[ROOT_##name] = or_else(all.surface.name, root_otherwise(graph, ROOT_##name));
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) \
    roots[ROOT_##name] = or_else(all.surface.name, root_otherwise(graph, ROOT_##name));
#include "krs/surface.def"
    if (all.surface.component == NODE_NONE)
        roots[ROOT_component] = graph_uint(graph, number);
    if (place)
        *place = all.surface.place;
    Node normal        = or_else(all.surface.normal, context.normal);
    roots[ROOT_NORMAL] = unit_normal(graph, normal, context.normal);
    return !l.overflow;
}

bool lower_solid(Graph *graph, const Shape *shape, struct LoweredGroups *groups, Arena *scratch,
                 Node *distance)
{
    Lowering l   = {.graph   = graph,
                    .scratch = scratch,
                    .thin    = true,
                    .most    = graph->count + MAX_LOWERED,
                    .groups  = groups};
    Lowered  all = lower_shape(&l, shape, context_new(graph_leaf(graph, OP_POINT), false));
    *distance    = divide_by_slope(graph, or_else(all.distance, graph_number(graph, NOWHERE)),
                                   shape->slope);
    return !l.overflow;
}

Node lower_guarded(Graph *graph, const Shape *shape, Node plain, struct LoweredGroups *groups,
                   Arena *scratch)
{
    Lowering l   = {.graph   = graph,
                    .scratch = scratch,
                    .guarded = true,
                    .thin    = true,
                    .unit    = graph_number(graph, 1),
                    .most    = graph->count + MAX_LOWERED,
                    .groups  = groups};
    Lowered  all = lower_shape(&l, shape, context_new(graph_leaf(graph, OP_POINT), false));
    if (all.distance == NODE_NONE || l.overflow)
        return plain;
    return divide_by_slope(graph, all.distance, shape->slope);
}

/* Most nodes of which a gradient is derived, since each gets three derivatives.  Gradients of
   larger shapes are found by differences. */
enum { MAX_DERIVED = 20000 };

bool lower_gradient(Graph *graph, const Shape *shape, Node *gradient, Node *near,
                    struct LoweredGroups *groups, Arena *scratch)
{
    Nodes    held_constant = {0};
    Lowering l             = {.graph         = graph,
                              .scratch       = scratch,
                              .held_constant = &held_constant,
                              .thin          = true,
                              .most          = graph->count + MAX_DERIVED,
                              .groups        = groups};
    Lowered  all = lower_shape(&l, shape, context_new(graph_leaf(graph, OP_POINT), false));
    if (all.distance == NODE_NONE || l.overflow)
        return false;
    *near     = divide_by_slope(graph, all.distance, shape->slope);
    Tape tape = tape_new(graph, near, 1, scratch);
    return tape.count <= MAX_DERIVED &&
           graph_gradient_of(graph, *near, held_constant.items, held_constant.count, gradient, NULL,
                             scratch) != DERIVED_NOT;
}

bool has_thin_open_surfaces(const Shape *shape)
{
    if (!shape->open_surfaces || !rays_pass(shape))
        return false;
    bool found = shape->open_surface;
    for (uint32_t i = 0; i < shape->child_count; i++)
        found = found || has_thin_open_surfaces(shape->children[i]);
    return found;
}
