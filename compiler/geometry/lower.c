/*
 * lower.c: from shapes to nodes of the graph: the walk through a tree of shapes.
 *
 * Going down the tree the point is mapped into each shape's own space; going up, distances are
 * joined.  The same walk makes the distance alone, which is what is marched, and the distance
 * with all that a hit needs (material, level, instance), which is evaluated once per hit.
 *
 * Distances are 1-Lipschitz up to the slope that shapes.c derived, by which the root divides.
 * Where only sharp joints and maps of space lie above a primitive, its sharper `bound` serves:
 * it need not be Lipschitz, only never exceed the distance.
 */
#include "compiler/geometry/lowering.h"

#include <assert.h>

#include "compiler/graph/derive.h"
#include "compiler/graph/evaluate.h"

/* Farther than any scene: the distance to nothing.  Finite, so that sums stay numbers. */
static const double NOWHERE = 1e30;

const Lowered lowered_nothing = {NODE_NONE,
                                 {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE,
                                  NODE_NONE, NODE_NONE, NODE_NONE}};

LowerContext context_new(Node point, bool lipschitz)
{
    return (LowerContext){point, NODE_NONE, NODE_NONE, lipschitz, NODE_NONE, NODE_NONE, NODE_NONE};
}

LowerContext context_at(LowerContext context, Node point)
{
    context.point = point;
    return context;
}

LowerContext context_lipschitz(LowerContext context)
{
    context.lipschitz = true;
    return context;
}

static Lowered lower_kind(Lowering *l, const Shape *shape, LowerContext context)
{
    switch (shape->kind) {
    case SHAPE_EMPTY: return lowered_nothing;
    case SHAPE_PRIMITIVE: return lower_primitive(l, shape, context);
    case SHAPE_TRANSFORM: return lower_transform(l, shape, context);
    case SHAPE_INVERSION: return lower_inversion(l, shape, context);
    case SHAPE_STRETCH: return lower_stretch(l, shape, context);
    case SHAPE_UNION: return lower_union(l, shape, joint_context(shape, context));
    case SHAPE_INTERSECTION: return lower_intersection(l, shape, joint_context(shape, context));
    case SHAPE_DIFFERENCE: return lower_difference(l, shape, joint_context(shape, context));
    case SHAPE_XOR: return lower_xor(l, shape, joint_context(shape, context));
    case SHAPE_MORPH: return lower_morph(l, shape, context);
    case SHAPE_META: return lower_meta(l, shape, context);
    case SHAPE_OFFSET: return lower_offset(l, shape, context);
    case SHAPE_SHELL: return lower_shell(l, shape, context);
    case SHAPE_ELONGATE: return lower_elongate(l, shape, context);
    case SHAPE_EXTRUDE: return lower_extrude(l, shape, context);
    case SHAPE_REVOLVE: return lower_revolve(l, shape, context);
    case SHAPE_REPEAT: return lower_repeat(l, shape, context);
    case SHAPE_REPEAT_POLAR: return lower_repeat_polar(l, shape, context);
    case SHAPE_MIRROR: return lower_mirror(l, shape, context);
    case SHAPE_TWIST: return lower_twist(l, shape, context);
    case SHAPE_BEND: return lower_bend(l, shape, context);
    case SHAPE_TAPER: return lower_taper(l, shape, context);
    case SHAPE_DISPLACE: return lower_displace(l, shape, context);
    case SHAPE_SMOOTH: return lower_smooth(l, shape, context);
    case SHAPE_PAINT: return lower_paint(l, shape, context);
    case SHAPE_KRS: return lower_krs(l, shape, context);
    }
    assert(!"every kind of shape has a rule");
    return lowered_nothing;
}

bool rays_pass(const Shape *shape)
{
    switch (shape->kind) {
    case SHAPE_PRIMITIVE:
    case SHAPE_TRANSFORM:
    case SHAPE_STRETCH:
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: return true;
    case SHAPE_SHELL: return shape->sheet;
    case SHAPE_UNION:
    case SHAPE_INTERSECTION: return shape->blend.width == NODE_NONE;
    case SHAPE_DIFFERENCE:
        for (uint32_t i = 1; i < shape->child_count; i++)
            if (shape->children[i]->sheets)
                return false;
        return shape->blend.width == NODE_NONE;
    default: return false;
    }
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

Lowered lower_shape(Lowering *l, const Shape *shape, LowerContext context)
{
    bool thin      = l->thin;
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow)
        return lowered_nothing;
    l->thin        = thin && rays_pass(shape);
    Lowered result = lower_kind(l, shape, context);
    l->thin        = thin;
    /* Where no mirror is smooth, the normal that came in is the one that comes out. */
    if (result.distance != NODE_NONE && context.smoothing == NODE_NONE && !shape->smooth)
        result.surface.normal = context.normal;
    if (l->lowered_shapes)
        array_push(l->scratch, l->lowered_shapes,
                   ((LoweredShape){shape, context.point, result.distance}));
    return result;
}

Node divide_by_slope(Graph *g, Node distance, double slope)
{
    if (slope <= 1 + 1e-9)
        return distance;
    Node factor = graph_number(g, 1 / slope);
    return graph_op2(g, OP_mul, distance, factor);
}

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
