/*
 * turns.c: numbers of the frame that depend on the turn of a loop, for all turns.
 *
 * Lanes run the same expressions at many points, so the turn stands in the place of a coordinate.
 */
#include "compiler/graph/turns.h"

#include "compiler/graph/lanes.h"
#include "compiler/graph/op_values.h"

void graph_mark_turned(const Graph *graph, Node leaf, bool *depends)
{
    depends[0] = true;
    for (Node node = leaf + 1; node < graph->count; node++) {
        const Expr *e        = &graph->items[node];
        depends[node - leaf] = false;
        for (int k = 0; k < e->operand_count; k++)
            if (e->operands[k] >= leaf && depends[e->operands[k] - leaf])
                depends[node - leaf] = true;
    }
}

size_t graph_numbers_of(const Graph *graph, const Node *roots, size_t root_count)
{
    size_t count = 0;
    for (size_t i = 0; i < root_count; i++)
        count += components((GraphType)graph->items[roots[i]].type);
    return count;
}

static void run(const LaneTape *tape, const double *turns, size_t count, double *results,
                Arena *scratch)
{
    enum { AT_ONCE = 8 * LANES };
    double         points[AT_ONCE][3] = {{0}};
    const LaneWork work = lane_work_in(arena_alloc(scratch, lane_work_bytes(tape), 1), NULL);
    for (size_t first = 0; first < count; first += AT_ONCE) {
        const size_t some = count - first < AT_ONCE ? count - first : AT_ONCE;
        for (size_t i = 0; i < some; i++)
            points[i][0] = turns[first + i];
        lane_run(tape, &work, LANE_DOUBLE,
                 (LanePoints){.points = (const double(*)[3])points, .count = some}, 0,
                 tape->output_count, results + first * tape->output_count);
    }
}

void graph_at_turns(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                    const double *turns, size_t turn_count, double *results, Arena *scratch)
{
    if (root_count == 0 || turn_count == 0)
        return;
    const ArenaMark mark   = arena_mark(scratch);
    Node           *copies = arena_new_array(scratch, Node, root_count);
    Graph          *own    = graph_extract_along(graph, roots, root_count, leaf, copies, scratch);
    Tape            tape   = tape_new(own, copies, root_count, scratch);
    NodeValue      *values = arena_new_array(scratch, NodeValue, own->count);
    tape_run_frame(&tape, NULL, values);
    LaneTape lanes = lane_tape_new(&tape, copies, root_count, false, 0, scratch);
    lanes.scalars  = arena_new_array(scratch, double, lanes.scalar_count + 1);
    lane_tape_scalars(&lanes, values, lanes.scalars);
    run(&lanes, turns, turn_count, results, scratch);
    arena_rewind(scratch, mark);
}
