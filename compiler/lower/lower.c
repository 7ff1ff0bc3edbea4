/*
 * lower.c: from the shape of a component to the roots of its graph.
 */
#include "compiler/lower/lower.h"

#include "compiler/graph/derive.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/normal.h"
#include "compiler/shape/slope.h"

/* Farther than any scene: the distance to nothing.  Finite, so that sums stay numbers. */
static const double NOWHERE = 1e30;

static Node or_else(Node node, Node otherwise) { return node == NODE_NONE ? otherwise : node; }

bool lower_component(Graph *graph, const Shape *shape, Arena *scratch, Node *roots)
{
    Lowering     l        = {.graph    = graph,
                             .scratch  = scratch,
                             .surfaces = true,
                             .thin     = true,
                             .most     = graph->count + MOST_LOWERED};
    LowerContext context  = context_new(graph_leaf(graph, OP_POINT), false);
    context.normal        = graph_leaf(graph, OP_NORMAL);
    context.footprint     = graph_leaf(graph, OP_FOOTPRINT);
    Lowered all           = lower_shape(&l, shape, context);
    Node    distance      = or_else(all.distance, graph_number(graph, NOWHERE));
    roots[ROOT_DISTANCE]  = divide_by_slope(graph, distance, shape->slope);
    roots[ROOT_COLOR]     = or_else(all.surface.color, graph_vec3(graph, 0.6, 0.6, 0.6));
    roots[ROOT_ROUGHNESS] = or_else(all.surface.roughness, graph_number(graph, 0.6));
    roots[ROOT_METALLIC]  = or_else(all.surface.metallic, graph_number(graph, 0));
    roots[ROOT_EMISSION]  = or_else(all.surface.emission, graph_vec3(graph, 0, 0, 0));
    roots[ROOT_LEVEL]     = or_else(all.surface.level, graph_number(graph, 0));
    roots[ROOT_INSTANCE]  = or_else(all.surface.instance, graph_uint(graph, 1));
    Node normal           = or_else(all.surface.normal, context.normal);
    roots[ROOT_NORMAL]    = unit_normal(graph, normal, context.normal);
    return !l.overflow;
}

Node lower_guarded(Graph *graph, const Shape *shape, Node plain, Arena *scratch)
{
    Lowering l   = {.graph   = graph,
                    .scratch = scratch,
                    .guarded = true,
                    .thin    = true,
                    .unit    = graph_number(graph, 1),
                    .most    = graph->count + MOST_LOWERED};
    Lowered  all = lower_shape(&l, shape, context_new(graph_leaf(graph, OP_POINT), false));
    if (all.distance == NODE_NONE || l.overflow)
        return plain;
    return divide_by_slope(graph, all.distance, shape->slope);
}

/* Three derivatives a node: what is larger is looked at by differences. */
enum { MOST_DERIVED = 20000 };

bool lower_gradient(Graph *graph, const Shape *shape, Node *gradient, Node *near, Arena *scratch)
{
    Nodes    held_constant = {0};
    Lowering l             = {.graph         = graph,
                              .scratch       = scratch,
                              .held_constant = &held_constant,
                              .thin          = true,
                              .most          = graph->count + MOST_DERIVED};
    Lowered  all = lower_shape(&l, shape, context_new(graph_leaf(graph, OP_POINT), false));
    if (all.distance == NODE_NONE || l.overflow)
        return false;
    *near     = divide_by_slope(graph, all.distance, shape->slope);
    Tape tape = tape_new(graph, near, 1, scratch);
    return tape.count <= MOST_DERIVED &&
           graph_gradient_of(graph, *near, held_constant.items, held_constant.count, gradient, NULL,
                             scratch) != DERIVED_NOT;
}

bool has_thin_sheets(const Shape *shape)
{
    if (!shape->sheets || !rays_pass(shape))
        return false;
    bool found = shape->sheet;
    for (uint32_t i = 0; i < shape->child_count; i++)
        found = found || has_thin_sheets(shape->children[i]);
    return found;
}
