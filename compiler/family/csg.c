/*
 * csg.c: CSG nodes of shapes: union, intersection, difference, xor, and morph; sharp or blended.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/lower/blend.h"
#include "compiler/lower/boundary.h"
#include "compiler/lower/join.h"
#include "compiler/lower/surface.h"
#include "compiler/shape/overlap.h"

/* ---- how it is made ---- */

/* Tells how many operands of a blend can act at one point.  One that is farther than the reach acts only as the
   least of all, alone; and no distance is less than that to the box (lower_operand).  Of pairs two act, and
   the solid that others are taken from. */
static uint32_t acting_at_once(ShapeBuilder *builder, const Shape *csg_node)
{
    const BlendKind kind    = csg_node->blend.kind;
    const uint32_t  solid   = csg_node->kind == SHAPE_DIFFERENCE; /* acts in all of its inside */
    double          far     = blend_reach(kind, csg_node->child_count) * csg_node->blend.widest;
    uint32_t        count   = csg_node->child_count;
    uint32_t        at_once = blend_many(kind).way == MANY_PAIRS ? solid + 2 : UINT32_MAX;
    bool            joins   = csg_node->kind == SHAPE_UNION || solid;
    if (!joins || !isfinite(far) || count < 3)
        return count < at_once ? count : at_once;
    ArenaMark mark  = arena_mark(builder->scratch);
    Box      *boxes = arena_new_array(builder->scratch, Box, count);
    for (uint32_t i = solid; i < count; i++)
        boxes[i - solid] = csg_node->children[i]->box;
    uint32_t most = max_overlap(boxes, count - solid, fmax(far, 0), builder->scratch);
    arena_rewind(builder->scratch, mark);
    return solid + most < at_once ? solid + most : at_once;
}

const Shape *make_csg_node(ShapeBuilder *builder, ShapeKind kind, const Shape *const *shapes,
                           uint32_t count, Blend blend, Span span)
{
    Shape *csg_node = shape_new(builder, kind, shape_info[kind].name, span, shapes, count);
    csg_node->blend = blend;
    if (blend.width != NODE_NONE) {
        check_lipschitz(builder, csg_node, "a blend", span);
        csg_node->blend.widest = node_range(builder, blend.width, 0).high;
    }
    /* Outside, the least of exact distances is exact; every other CSG node only bounds it. */
    csg_node->exact = csg_node->exact && kind == SHAPE_UNION && blend.width == NODE_NONE;
    csg_node->box   = builder_box(builder, csg_node);
    if (blend.width == NODE_NONE && csg_node->figure)
        csg_node->boundary = boundary_new(builder->arena);
    if (blend.width != NODE_NONE && count > 1) {
        const BlendInfo *info = &blend_info[blend.kind];
        /* Each further operand adds a partial derivative; their squares sum to 1, so the sum of
           n of them is at most sqrt(n): for two operands the factor of the table.  What pairs of tools are
           to a solid is less: (1 + sqrt 2) / sqrt 2. */
        if (info->slope > 1)
            csg_node->slope *= real_pow(info->slope, real_log2(acting_at_once(builder, csg_node)));
    }
    return csg_node;
}

const Shape *make_clip(ShapeBuilder *builder, const Shape *shape, const Shape *region,
                       const Node corners[2], Span span)
{
    const Shape *parts[] = {shape, region};
    Shape       *clip    = shape_new(builder, SHAPE_CLIP, "clip", span, parts, region ? 2 : 1);
    clip->exact          = false;
    clip->without_uv     = shape->without_uv;
    for (int i = 0; i < 2 && corners; i++)
        clip->corners[i] = corners[i];
    clip->box = builder_box(builder, clip);
    return clip;
}

const Shape *make_morph(ShapeBuilder *builder, const Shape *a, const Shape *b, Node t, Span span)
{
    const Shape *children[] = {a, b};
    Shape       *morph      = shape_new(builder, SHAPE_MORPH, "morph", span, children, 2);
    morph->values[0]        = t;
    check_lipschitz(builder, morph, "`morph`", span);
    morph->exact = false;
    morph->box   = builder_box(builder, morph);
    return morph;
}

/* ---- how it is lowered ---- */

static Lowered complement(Lowering *l, Lowered a)
{
    if (a.distance != NODE_NONE)
        a.distance = graph_op1(l->graph, OP_neg, a.distance);
    return a;
}

LowerContext csg_node_context(const Shape *shape, LowerContext context)
{
    const Blend *blend = &shape->blend;
    if (blend->width == NODE_NONE)
        return context;
    double widths = blend_reach(blend->kind, shape->child_count);
    return context_lipschitz_within(context, widths * blend->widest);
}

static Lowered lower_joined(Lowering *l, const Shape *csg_node, const Shape *child,
                            LowerContext context)
{
    return csg_node->blend.width == NODE_NONE ? lower_shape(l, child, context)
                                              : lower_operand(l, child, context);
}

/* Joins shapes sharply in pairs, so that the graph stays shallow. */
static Lowered union_in_pairs(Lowering *l, const Shape *shape, const Shape *const *children,
                              uint32_t count, LowerContext context)
{
    if (count == 0)
        return lowered_nothing;
    if (count == 1)
        return lower_shape(l, children[0], context);
    uint32_t half  = count / 2;
    Lowered  left  = union_in_pairs(l, shape, children, half, context);
    Lowered  right = union_in_pairs(l, shape, children + half, count - half, context);
    return join_two(l, shape->blend, left, right);
}

/* Joins shapes; `reach` is that of their union, and the context's that of each child. */
static Lowered union_of(Lowering *l, const Shape *shape, const Shape *const *children,
                        uint32_t count, double reach, LowerContext context)
{
    PartJoin join = {shape, children, count, false, reach};
    bool     nowhere;
    if (shape->blend.width != NODE_NONE)
        return lower_blend(l, join, context, &nowhere);
    Lowered groups = lower_groups(l, &join, context);
    Lowered others = union_in_pairs(l, shape, join.parts, join.count, context);
    return join_two(l, shape->blend, groups, others);
}

static Lowered union_by_parts(Lowering *l, const Shape *shape, LowerContext context)
{
    return union_of(l, shape, shape->children, shape->child_count, context.reach,
                    csg_node_context(shape, context));
}

Lowered lower_union(Lowering *l, const Shape *shape, LowerContext context)
{
    return lower_within_boundary(l, shape, context, context.point, union_by_parts);
}

static Lowered intersection_of_two(Lowering *l, const Shape *shape, Lowered a, Lowered b)
{
    Lowered not_b = complement(l, b), not_a = complement(l, a);
    return complement(l, join_two(l, shape->blend, not_a, not_b));
}

static Lowered intersection_by_parts(Lowering *l, const Shape *shape, LowerContext context)
{
    context = csg_node_context(shape, context);
    /* The complement of the union of the complements. */
    PartJoin join = {shape, shape->children, shape->child_count, true, context.reach};
    if (shape->blend.width != NODE_NONE) {
        bool    nowhere;
        Lowered blended = lower_blend(l, join, context, &nowhere);
        return nowhere ? lowered_nothing : complement(l, blended);
    }
    Lowered all = complement(l, lower_groups(l, &join, context));
    for (uint32_t i = 0; i < join.count; i++) {
        Lowered next = lower_shape(l, join.parts[i], context);
        if (next.distance == NODE_NONE)
            return lowered_nothing;
        all = all.distance == NODE_NONE ? next : intersection_of_two(l, shape, all, next);
    }
    return all;
}

Lowered lower_intersection(Lowering *l, const Shape *shape, LowerContext context)
{
    return lower_within_boundary(l, shape, context, context.point, intersection_by_parts);
}

static Lowered difference_by_parts(Lowering *l, const Shape *shape, LowerContext context)
{
    context       = csg_node_context(shape, context);
    Lowered left  = lower_joined(l, shape, shape->children[0], context);
    Lowered right = union_of(l, shape, shape->children + 1, shape->child_count - 1, context.reach,
                             context);
    if (left.distance == NODE_NONE || right.distance == NODE_NONE)
        return left;
    Lowered joined = join_two(l, shape->blend, complement(l, left), right);
    return complement(l, joined);
}

Lowered lower_difference(Lowering *l, const Shape *shape, LowerContext context)
{
    return lower_within_boundary(l, shape, context, context.point, difference_by_parts);
}

/* Lowers what is in one of two shapes: their union less what they share. */
static Lowered xor_by_parts(Lowering *l, const Shape *shape, LowerContext context)
{
    context   = csg_node_context(shape, context);
    Lowered a = lower_joined(l, shape, shape->children[0], context);
    Lowered b = lower_joined(l, shape, shape->children[1], context);
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return join_two(l, shape->blend, a, b);
    Lowered result = join_two(l, shape->blend, a, b);
    /* Their common part is the complement of: */
    b               = complement(l, b);
    Lowered shared  = join_two(l, shape->blend, complement(l, a), b);
    result.distance = graph_op2(l->graph, OP_max, result.distance, shared.distance);
    return result;
}

Lowered lower_xor(Lowering *l, const Shape *shape, LowerContext context)
{
    return lower_within_boundary(l, shape, context, context.point, xor_by_parts);
}

/* Lowers a clipped shape, of which all that is seen is of the part that is cut. */
Lowered lower_clip(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered    result   = lower_shape(l, shape->children[0], context);
    const bool surfaces = l->surfaces;
    if (shape->child_count == 1 || result.distance == NODE_NONE)
        return result;
    l->surfaces     = false;
    Lowered region  = lower_shape(l, shape->children[1], context);
    l->surfaces     = surfaces;
    result.distance = graph_op2(l->graph, OP_max, result.distance, region.distance);
    return result;
}

Lowered lower_morph(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered a = lower_shape(l, shape->children[0], context_lipschitz(context));
    Lowered b = lower_shape(l, shape->children[1], context_lipschitz(context));
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return a.distance == NODE_NONE ? b : a;
    Graph  *g       = l->graph;
    Lowered result  = lowered_nothing;
    Node    one     = graph_number(g, 1);
    Node    weight  = graph_op2(g, OP_sub, one, shape->values[0]);
    result.distance = graph_op3(g, OP_mix, a.distance, b.distance, shape->values[0]);
    if (l->surfaces) {
        Node half      = graph_number(g, 0.5);
        Node nearer    = graph_op2(g, OP_less, shape->values[0], half);
        result.surface = mix_surface(g, nearer, weight, a.surface, b.surface);
    }
    return result;
}
