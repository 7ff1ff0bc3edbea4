/*
 * timed.c: what depends on the time.
 */
#include "compiler/graph/timed.h"

#include "compiler/graph/instance_table.h"

enum { TIME_SLOT = 0 }; /* of the parameter block */

static bool any_timed(const bool *timed, const Node *nodes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (timed[nodes[i]])
            return true;
    return false;
}

static bool is_timed_table(const Instances *instances, const InstanceTable *table,
                           const bool *timed)
{
    for (uint32_t i = 0; i < table->columns; i++) {
        const Node *column = column_nodes(instances, table, i);
        if (column && any_timed(timed, column, table->rows))
            return true;
    }
    size_t places = 0;
    for (uint32_t i = 0; table->places && i < table->rows; i++)
        places += place_nodes(table->places[i].kind);
    return places > 0 &&
           any_timed(timed, instances->frame_numbers.items + table->first_place, places);
}

static bool is_timed_call(const Graph *graph, const Expr *call, const bool *timed)
{
    const InstanceFunction *function =
        &graph->instances->functions.items[called_function(graph, call)];
    return any_timed(timed, graph->instances->bodies.items + function->first_body,
                     body_count(function)) ||
           is_timed_table(graph->instances, &graph->instances->tables.items[function->table_number],
                          timed);
}

static bool is_timed(const Graph *graph, const Expr *e, const bool *timed)
{
    if (e->op == OP_PARAMETER && e->index == TIME_SLOT)
        return true;
    return any_timed(timed, e->operands, e->operand_count) ||
           (is_call((Op)e->op) && is_timed_call(graph, e, timed));
}

/* Marks what depends on time.  Operands come first, but bodies of functions need not. */
void graph_mark_timed(const Graph *graph, bool *timed)
{
    bool changes = true;
    for (Node node = 0; node < graph->count; node++)
        timed[node] = false;
    while (changes) {
        changes = false;
        for (Node node = 0; node < graph->count; node++)
            if (!timed[node] && is_timed(graph, &graph->items[node], timed))
                changes = timed[node] = true;
    }
}
