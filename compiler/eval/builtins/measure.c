/*
 * measure.c: what shapes tell of themselves: their distance at a point, and their bounds.
 */
#include "compiler/eval/builtins/builtins.h"

#include <math.h>

#include "compiler/lower/context.h"
#include "compiler/shape/slope.h"

/* Returns the point of an argument, of two numbers for a figure and three for a solid; NODE_NONE:
   reported. */
static Node want_place(Elaboration *e, const Shape *shape, const Call *call)
{
    const Argument *argument = &call->arguments[0];
    uint32_t        size     = shape->figure ? 2 : 3;
    Node node = value_size(e, argument->value) == size ? value_node(e, argument->value) : NODE_NONE;
    if (node == NODE_NONE)
        type_error(e, argument->syntax, argument->value,
                   shape->figure ? "a point of the figure's plane, [x, y]"
                                 : "a point in space, [x, y, z]");
    if (node == NODE_NONE || !shape->figure)
        return node;
    Graph *g = e->graph;
    Node   x = graph_component(g, node, 0), y = graph_component(g, node, 1);
    return graph_op3(g, OP_vec3, x, y, graph_number(g, 0));
}

/* The distance may be put to any use, so it is one of slope 1.  `reach: 0` says that it is used near the
   surface alone: then it may be less farther away, and jump there. */
Value method_distance(Elaboration *e, const Shape *shape, Call *call)
{
    Node   point  = want_place(e, shape, call);
    size_t errors = e->diags->errors;
    double reach  = HUGE_VAL;
    if (point == NODE_NONE || !want_constant(e, call, 1, &reach) ||
        !check_bounded(e->builder, shape))
        return value_error();
    check_lipschitz(e->builder, shape, "`.distance`", call->syntax->span);
    if (e->diags->errors > errors)
        return value_error();
    Lowering l   = {.graph   = e->graph,
                    .scratch = e->scratch,
                    .far     = reach > 0,
                    .most    = e->graph->count + MAX_LOWERED};
    Lowered  all = lower_shape(&l, shape, context_new(point, true));
    if (l.overflow || all.distance == NODE_NONE) {
        Diag *diag  = diag_add(e->diags, DIAG_LIMIT, call->syntax->span, "%s",
                              l.overflow ? "this shape is too large for `.distance`"
                                          : "an empty shape has no distance");
        diag->label = "in this call";
        return value_error();
    }
    Node distance = divide_by_slope(e->graph, all.distance, shape->slope);
    return value_of_node(e, distance);
}

Value method_bounds(Elaboration *e, const Shape *shape, Call *call)
{
    uint32_t size = shape->figure ? 2 : 3;
    Value   *ends = arena_new_array(e->arena, Value, 2);
    for (int end = 0; end < 2; end++) {
        Value *corner = arena_new_array(e->arena, Value, size);
        for (uint32_t i = 0; i < size; i++) {
            const Range *axis = &shape->box.axis[i];
            double       side = end ? axis->high : axis->low;
            if (!isfinite(side)) {
                Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->syntax->span,
                                       "this shape has no bounds");
                diag->label = diag_text(e->diags, "`%s` is endless or empty", shape->name);
                diag->help  = "cut it with `.within`, and give a `param` that moves it a range";
                return value_error();
            }
            corner[i] = value_number(side);
        }
        ends[end] = value_list(e, corner, size);
    }
    return value_list(e, ends, 2);
}
