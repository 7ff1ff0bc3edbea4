/*
 * lane_steepest.c: how fast expressions change with the point at most (Lipschitz constants).
 *
 * Facts of the whole space have slopes.  But those hold within a cell of a repetition, and across a choice
 * they hold for its pieces.  So only what is made of operations that never jump has a bound here.
 */
#include <math.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/lanes/lane_rows.h"

static bool op_never_jumps(Op op)
{
    return number_rows[op].map ? number_rows[op].norm != NORM_NONE
                               : op_has_traits(op, BUILDS) || op_has_traits(op, STEADY);
}

double *lane_steepest(const Graph *graph, Arena *arena)
{
    double         *steepest = arena_new_array(arena, double, graph->count + 1);
    const ArenaMark mark     = arena_mark(arena);
    const Fact     *facts = graph_facts(graph, (Box){{ANYTHING, ANYTHING, ANYTHING}}, NULL, arena);
    for (Node node = 0; node < graph->count; node++) {
        const Expr *e = &graph->items[node];
        bool steady   = e->time != TIME_POINT || e->op == OP_POINT || op_never_jumps((Op)e->op);
        for (uint32_t k = 0; k < e->operand_count && e->time == TIME_POINT; k++)
            steady = steady && isfinite(steepest[e->operands[k]]);
        steepest[node] = steady ? facts[node].slope : HUGE_VAL;
    }
    arena_rewind(arena, mark);
    return steepest;
}
