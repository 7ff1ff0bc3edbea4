/*
 * outline.c: plane figures between contours, whose distance comes from a table.
 */
#include "compiler/family/family.h"

#include <string.h>

#include "compiler/lower/instance_groups.h"
#include "compiler/lower/outline.h"

/* ---- how it is made ---- */

static bool is_equal(const OutlineShape *shape, const Curves *curves, FillRule rule)
{
    return shape->rule == rule && shape->drawn.count == curves->count &&
           memcmp(shape->drawn.items, curves->items, curves->count * sizeof *curves->items) == 0;
}

/* Returns the outline of equal contours, if there is one. */
static OutlineShape *find_outline(const ShapeBuilder *builder, const Curves *curves, FillRule rule)
{
    for (size_t i = 0; i < builder->outlines.count; i++)
        if (is_equal(builder->outlines.items[i], curves, rule))
            return builder->outlines.items[i];
    return NULL;
}

static void report_fault(ShapeBuilder *builder, OutlineFault fault, const double at[2], Span span)
{
    bool  many  = fault == OUTLINE_TOO_MANY;
    Diag *diag  = diag_add(builder->diags, many ? DIAG_TOO_LARGE : DIAG_NO_OUTLINE, span,
                          many ? "contours of more than 400,000 curves, counted where they cross"
                                : "these contours run along each other, all but equal");
    diag->label = many ? "too many contours"
                       : diag_text(builder->diags, "near [%.6g, %.6g]", at[0], at[1]);
    diag->help  = many ? "draw it with fewer curves, or as several figures"
                       : "draw what touches with common points, or leave a gap, or join several "
                         "figures by `union`";
}

static OutlineShape *new_outline(ShapeBuilder *builder, const Curves *curves, FillRule rule,
                                 Span span)
{
    OutlineShape *shape = arena_new(builder->arena, OutlineShape);
    double        at[2];
    shape->drawn = (Curves){arena_new_array(builder->arena, Curve, curves->count + 1),
                            curves->count, curves->count + 1};
    shape->rule  = rule;
    shape->span  = span;
    memcpy(shape->drawn.items, curves->items, curves->count * sizeof *curves->items);
    OutlineFault fault = outline_make(&shape->outline, curves, rule, builder->arena,
                                      builder->scratch, at);
    if (fault != OUTLINE_GOOD) {
        report_fault(builder, fault, at, span);
        return NULL;
    }
    shape->instances = outline_instances(&shape->outline, builder->arena, builder->arena);
    array_push(builder->arena, &builder->outlines, shape);
    return shape;
}

const Shape *make_outline(ShapeBuilder *builder, const char *name, const Curves *curves,
                          FillRule rule, Span span)
{
    Graph        *g     = builder->graph;
    OutlineShape *found = find_outline(builder, curves, rule);
    if (!found)
        found = new_outline(builder, curves, rule, span);
    if (!found)
        return NULL;
    if (found->instances.count == 0) {
        Shape *empty  = shape_new(builder, SHAPE_EMPTY, name, span, NULL, 0);
        empty->figure = true;
        return empty;
    }
    Box    box = {{{found->outline.low[0], found->outline.high[0]},
                   {found->outline.low[1], found->outline.high[1]},
                   {0, 0}}};
    bool   is_new;
    Node   point    = graph_leaf(g, OP_POINT);
    Node   distance = outline_distance(g, found, 0, point, &is_new, builder->scratch);
    Node   x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Shape *figure      = primitive_new(builder, name, distance, box, span);
    figure->outline    = found;
    figure->exact      = true;
    figure->figure     = true;
    figure->claimed    = true;
    figure->uv         = graph_op2(g, OP_vec2, x, y);
    figure->without_uv = NULL;
    arena_free(builder->scratch);
    return figure;
}

/* ---- how it is lowered ---- */

Node lower_outline_distance(Lowering *l, const Shape *shape, LowerContext context)
{
    bool is_new;
    Node distance = outline_distance(l->graph, shape->outline, context.reach, context.point,
                                     &is_new, l->scratch);
    if (is_new && l->groups)
        lowered_groups_made(l->groups);
    return distance;
}
