/*
 * iterations.c: numbers of the frame that depend on the iteration of a loop, for all iterations.
 *
 * Lanes run the same expressions at many points, so the iteration stands in the place of a coordinate.
 */
#include "compiler/graph/instances/iterations.h"

#include <string.h>

#include "compiler/graph/lanes/lanes.h"
#include "compiler/graph/op_values.h"

void graph_mark_iterated(const Graph *graph, Node leaf, bool *depends)
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

static void run(const LaneTape *tape, const double *iterations, size_t count, double *results,
                Arena *scratch)
{
    enum { AT_ONCE = 8 * LANES };
    double         points[AT_ONCE][3] = {{0}};
    const LaneWork work = lane_work_in(arena_alloc(scratch, lane_work_bytes(tape), 1), NULL);
    for (size_t first = 0; first < count; first += AT_ONCE) {
        const size_t some = count - first < AT_ONCE ? count - first : AT_ONCE;
        for (size_t i = 0; i < some; i++)
            points[i][0] = iterations[first + i];
        lane_run(tape, &work, LANE_DOUBLE,
                 (LanePoints){.points = (const double(*)[3])points, .count = some}, 0,
                 tape->output_count, results + first * tape->output_count);
    }
}

void graph_at_iterations(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                         const double *iterations, size_t iteration_count, double *results,
                         Arena *scratch)
{
    if (root_count == 0 || iteration_count == 0)
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
    run(&lanes, iterations, iteration_count, results, scratch);
    arena_rewind(scratch, mark);
}

bool graph_needs_parameters(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                            Arena *scratch)
{
    const ArenaMark mark  = arena_mark(scratch);
    const Tape      tape  = tape_new(graph, roots, root_count, scratch);
    bool            found = false;
    for (size_t i = 0; i < tape.count; i++)
        found = found || (tape.nodes[i] != leaf && graph->items[tape.nodes[i]].op == OP_PARAMETER);
    arena_rewind(scratch, mark);
    return found;
}

/* ---- one iteration ---- */

typedef struct NodeList {
    Node  *items;
    size_t count, capacity;
} NodeList;

/* Returns what the host finds, as numbers of the text. */
static Node settled(Graph *graph, Node node, NodeValue value)
{
    const Expr     e     = graph->items[node];
    const uint32_t first = (uint32_t)graph->items[e.operands[2]].number[0];
    Node           parts[3];
    for (uint32_t k = 0; k < components((GraphType)e.type); k++)
        parts[k] = graph_parameterised(graph, TYPE_FLOAT, &value.v[k], first + k);
    return e.type == TYPE_FLOAT ? parts[0] : graph_op(graph, OP_vec3, parts);
}

static Node settle_random(Graph *graph, Node root, Arena *scratch)
{
    const Tape tape  = tape_new(graph, &root, 1, scratch);
    NodeList   found = {0};
    for (size_t i = 0; i < tape.frame_count; i++)
        if (op_has_traits((Op)graph->items[tape.nodes[i]].op, OF_HOST))
            array_push(scratch, &found, tape.nodes[i]);
    if (found.count == 0)
        return root;
    Node *copies = arena_new_array(scratch, Node, found.count);
    memcpy(copies, found.items, found.count * sizeof *copies);
    const Graph *own    = graph_extract(graph, copies, found.count, scratch);
    const Tape   alone  = tape_new(own, copies, found.count, scratch);
    NodeValue   *values = arena_new_array(scratch, NodeValue, own->count);
    Node        *by     = arena_new_array(scratch, Node, tape.count);
    tape_run_frame(&alone, NULL, values);
    for (size_t i = 0; i < found.count; i++)
        by[tape_index(&tape, found.items[i])] = 1 +
                                                settled(graph, found.items[i], values[copies[i]]);
    return graph_replace_nodes(graph, root, &tape, by, scratch);
}

Node graph_in_iteration(Graph *graph, Node root, Node leaf, double iteration, Arena *scratch)
{
    const ArenaMark mark = arena_mark(scratch);
    Node result = graph_replace_leaf(graph, root, leaf, graph_number(graph, iteration), scratch);
    result      = settle_random(graph, result, scratch);
    arena_rewind(scratch, mark);
    return result;
}
