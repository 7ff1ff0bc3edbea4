/*
 * lists.c: the built-in functions of lists, and of several numbers as if they were one.
 */
#include "compiler/eval/builtins/builtins.h"

#include <math.h>

/* Reduces values with a binary operation, in pairs, so that the graph stays shallow. */
static Value reduce(Elaboration *e, Op op, const Value *items, size_t count, const Syntax *origin)
{
    if (count == 1)
        return items[0];
    size_t half = count / 2;
    Value  a    = reduce(e, op, items, half, origin);
    Value  b    = reduce(e, op, items + half, count - half, origin);
    if (a.type == VALUE_ERROR || b.type == VALUE_ERROR)
        return value_error();
    Node nodes[] = {value_node(e, a), value_node(e, b)};
    if (nodes[0] == NODE_NONE || nodes[1] == NODE_NONE) {
        type_error(e, origin, nodes[0] == NODE_NONE ? a : b,
                   op == OP_and || op == OP_or ? "truth values" : "numbers or vectors");
        return value_error();
    }
    GraphType types[] = {e->graph->items[nodes[0]].type, e->graph->items[nodes[1]].type};
    if (!graph_op_type(op, types, 2)) {
        diag_add(e->diags, DIAG_TYPE_MISMATCH, origin->span, "%s and %s do not go together",
                 value_type_name(e, a), value_type_name(e, b));
        return value_error();
    }
    if (op == OP_and || op == OP_or)
        return value_of_node(e, graph_op(e->graph, op, nodes));
    return value_map_op(e, op, (Value[]){a, b}, 2, origin);
}

/* Reduces the elements of the first argument; `empty` is the value when it has none. */
static Value reduce_list(Elaboration *e, Call *call, Op op, Value empty)
{
    if (call->arguments[0].value.type == VALUE_EXPRESSION) { /* a vector known only as a node */
        Node     vector = call->arguments[0].value.node;
        Value    components[4];
        uint32_t type = e->graph->items[vector].type;
        if (type > TYPE_VEC4) {
            type_error(e, call->arguments[0].syntax, call->arguments[0].value, "a list");
            return value_error();
        }
        for (uint32_t i = 0; i < type; i++)
            components[i] = value_of_node(e, graph_component(e->graph, vector, i));
        return reduce(e, op, components, type, call->syntax);
    }
    const List *list = want_list(e, call, 0);
    if (!list)
        return value_error();
    return list->count ? reduce(e, op, list->items, list->count, call->syntax) : empty;
}

Value builtin_sum(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_add, value_number(0));
}

Value builtin_product(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_mul, value_number(1));
}

Value builtin_any(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_or, value_boolean(false));
}

Value builtin_all(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_and, value_boolean(true));
}

/* Finds the least or the greatest of all arguments, or of the elements of the only one. */
static Value extreme(Elaboration *e, Call *call, Op op)
{
    if (call->rest_count == 0) {
        Diag *diag  = diag_add(e->diags, DIAG_MISSING_ARGUMENT, call->syntax->span,
                               "`%s` needs something to choose from", call->name);
        diag->label = "nothing is given";
        return value_error();
    }
    if (call->rest_count == 1) {
        call->arguments[0] = call->rest[0];
        if (call->rest[0].value.type == VALUE_LIST && call->rest[0].value.list->count == 0) {
            diag_add(e->diags, DIAG_BAD_VALUE, call->rest[0].syntax->span, "the list is empty");
            return value_error();
        }
        return reduce_list(e, call, op, value_error());
    }
    Value *values = arena_new_array(e->values, Value, call->rest_count);
    for (uint32_t i = 0; i < call->rest_count; i++)
        values[i] = call->rest[i].value;
    return reduce(e, op, values, call->rest_count, call->syntax);
}

Value builtin_least(Elaboration *e, Call *call) { return extreme(e, call, OP_min); }
Value builtin_greatest(Elaboration *e, Call *call) { return extreme(e, call, OP_max); }

Value builtin_len(Elaboration *e, Call *call)
{
    Value value = call->arguments[0].value;
    if (value.type == VALUE_EXPRESSION && e->graph->items[value.node].type <= TYPE_VEC4 &&
        e->graph->items[value.node].type >= TYPE_VEC2)
        return value_number(e->graph->items[value.node].type);
    const List *list = want_list(e, call, 0);
    return list ? value_number((double)list->count) : value_error();
}

Value builtin_range(Elaboration *e, Call *call)
{
    double from = 0, to = 0, by = 1;
    if (!want_constant(e, call, 0, &from) || !want_constant(e, call, 1, &to) ||
        !want_constant(e, call, 2, &by))
        return value_error();
    if (!is_given(call, 1)) {
        to   = from;
        from = 0;
    }
    double count = ceil((to - from) / by);
    if (!(by != 0) || !(count <= MAX_ELEMENTS)) {
        bool  ends  = by != 0;
        Diag *diag  = diag_add(e->diags, ends ? DIAG_LIMIT : DIAG_BAD_VALUE, call->syntax->span,
                              ends ? "a range of more than 4 million elements"
                                    : "a range with steps of 0 does not end");
        diag->label = "this range";
        return value_error();
    }
    size_t size  = count > 0 ? (size_t)count : 0;
    Value *items = arena_new_array(e->values, Value, size + 1);
    for (size_t i = 0; i < size; i++)
        items[i] = value_number(from + (double)i * by);
    return value_list(e, items, size);
}
