/*
 * tape.c: lists of nodes that are ready to be run, and what running them costs.
 */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/fractal.h"
#include "compiler/graph/regions.h"

/* The nodes found so far, in a hash table; its size is a power of 2, at most half is full. */
typedef struct NodeSet {
    Node  *slots; /* node + 1; 0 is free */
    size_t size;
    Node  *nodes; /* in the order in which they were found */
    size_t count, capacity;
} NodeSet;

/* Tells whether the node is new; then it takes its slot. */
static bool set_take(NodeSet *set, Node node)
{
    size_t i = (size_t)(node * (uint64_t)0x9E3779B97F4A7C15u >> 20) & (set->size - 1);
    for (; set->slots[i]; i = (i + 1) & (set->size - 1))
        if (set->slots[i] == node + 1)
            return false;
    set->slots[i] = node + 1;
    return true;
}

static void set_add(NodeSet *set, Node node, Arena *arena)
{
    if (2 * (set->count + 1) > set->size) {
        set->size  = set->size ? 2 * set->size : 64;
        set->slots = arena_new_array(arena, Node, set->size);
        for (size_t i = 0; i < set->count; i++)
            set_take(set, set->nodes[i]);
    }
    if (!set_take(set, node))
        return;
    if (set->count == set->capacity)
        set->nodes = arena_grow(arena, set->nodes, set->count, &set->capacity, sizeof *set->nodes);
    set->nodes[set->count++] = node;
}

/* Most lists are short: they are sorted as cards are. */
enum { MAX_CARDS = 32 };

/* Sorts nodes by a byte; those of the same byte keep their order. */
static void sort_by_byte(const Node *from, Node *to, size_t count, int shift)
{
    size_t places[257] = {0};
    for (size_t i = 0; i < count; i++)
        places[(from[i] >> shift & 255) + 1]++;
    for (int i = 0; i < 255; i++)
        places[i + 1] += places[i];
    for (size_t i = 0; i < count; i++)
        to[places[from[i] >> shift & 255]++] = from[i];
}

/* Sorts by the last byte first, and ends where all others are 0. */
static void sort_many(NodeSet *set, Arena *arena)
{
    Node *other = arena_new_array(arena, Node, set->count), most = 0;
    for (size_t i = 0; i < set->count; i++)
        most = set->nodes[i] > most ? set->nodes[i] : most;
    set->capacity = set->count;
    for (int shift = 0; shift < 32 && most >> shift; shift += 8) {
        Node *sorted = other;
        sort_by_byte(set->nodes, sorted, set->count, shift);
        other      = set->nodes;
        set->nodes = sorted;
    }
}

static void sort_nodes(NodeSet *set, Arena *arena)
{
    Node        *nodes = set->nodes;
    const size_t count = set->count;
    if (count > MAX_CARDS) {
        sort_many(set, arena);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const Node node = nodes[i];
        size_t     at   = i;
        for (; at > 0 && nodes[at - 1] > node; at--)
            nodes[at] = nodes[at - 1];
        nodes[at] = node;
    }
}

/* Adds the frame's numbers in the column that OP_row reads. */
static void add_column(NodeSet *set, const Graph *graph, const Expr *row, Arena *arena)
{
    uint32_t    count;
    const Node *nodes = row_nodes(graph, row, &count);
    for (uint32_t i = 0; i < count; i++)
        set_add(set, nodes[i], arena);
}

/* Returns what the roots need, ascending. */
static NodeSet find_needed(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    NodeSet set = {0};
    for (size_t i = 0; i < root_count; i++)
        set_add(&set, roots[i], arena);
    for (size_t i = 0; i < set.count; i++) {
        const Expr *e = &graph->items[set.nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            set_add(&set, e->operands[k], arena);
        if (e->op == OP_row && graph->instances)
            add_column(&set, graph, e, arena);
    }
    sort_nodes(&set, arena);
    return set;
}

/* ---- instance functions ---- */

/* Gives functions that are called here a tape, which is still empty; their numbers are below `end`. */
static void note_calls(Tape *functions, size_t end, const Graph *graph, const Node *nodes,
                       size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (is_call((Op)graph->items[nodes[i]].op)) {
            uint32_t id = called_function(graph, &graph->items[nodes[i]]);
            assert(id < end);
            (void)end;
            functions[id].graph = graph;
        }
}

/* Fills the tape of a function at each instance; what that needs of the frame is added to `frame`. */
static void fill_function(Tape *functions, uint32_t id, const Graph *graph, NodeSet *frame,
                          Arena *arena)
{
    const Instances        *instances = graph->instances;
    const InstanceFunction *function  = &instances->functions.items[id];
    NodeSet                 set = find_needed(graph, instances->bodies.items + function->first_body,
                                              function->state_count, arena);
    Node                   *nodes = arena_new_array(arena, Node, set.count + 1);
    size_t                  count = 0;
    for (size_t i = 0; i < set.count; i++)
        if (graph->items[set.nodes[i]].time == TIME_POINT)
            nodes[count++] = set.nodes[i];
        else
            set_add(frame, set.nodes[i], arena);
    note_calls(functions, id, graph, nodes, count);
    functions[id] = (Tape){.graph = graph, .nodes = nodes, .count = count, .functions = functions};
}

/* Returns the functions that the nodes of a set call, and those that these call, which have smaller
   numbers; what they need of the frame joins the set. */
static Tape *find_functions(const Graph *graph, NodeSet *set, Arena *arena)
{
    size_t count     = graph->instances->functions.count;
    Tape  *functions = arena_new_array(arena, Tape, count);
    note_calls(functions, count, graph, set->nodes, set->count);
    for (size_t id = count; id-- > 0;)
        if (functions[id].graph)
            fill_function(functions, (uint32_t)id, graph, set, arena);
    sort_nodes(set, arena);
    return functions;
}

static bool any_calls(const Graph *graph, const NodeSet *set)
{
    for (size_t i = 0; graph->instances && i < set->count; i++)
        if (is_call((Op)graph->items[set->nodes[i]].op))
            return true;
    return false;
}

/* ---- tapes ---- */

/* The work grows with what the roots need, not with the graph: most expressions are small and
   the graph of many of them is large.  Nothing of frame time needs anything of point time, so
   it can all go first. */
Tape tape_new(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    NodeSet set  = find_needed(graph, roots, root_count, arena);
    Tape    tape = {.graph = graph};
    if (any_calls(graph, &set)) {
        tape.functions      = find_functions(graph, &set, arena);
        tape.function_count = (uint32_t)graph->instances->functions.count;
    }
    Node *nodes = arena_new_array(arena, Node, set.count + 1);
    for (int frame = 1; frame >= 0; frame--)
        for (size_t i = 0; i < set.count; i++)
            if ((graph->items[set.nodes[i]].time != TIME_POINT) == frame) {
                nodes[tape.count++] = set.nodes[i];
                tape.frame_count += (size_t)frame;
            }
    tape.nodes = nodes;
    return tape;
}

/* A tape on which each region follows its guard. */
typedef struct Layout {
    const Regions *regions;
    Node          *nodes;
    uint32_t      *skips;
    size_t         count;
} Layout;

static void lay_out(Layout *layout, uint32_t region)
{
    const Regions *regions = layout->regions;
    for (Node node = regions->list.items[region].first; node != NODE_NONE;
         node      = regions->next[node]) {
        if (regions->body[node] != NO_REGION) {
            size_t test                    = layout->count;
            layout->nodes[layout->count++] = node;
            lay_out(layout, regions->body[node]);
            layout->skips[test] = (uint32_t)(layout->count - test);
        }
        layout->nodes[layout->count++] = node;
    }
}

Tape tape_new_guarded(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    Tape    tape    = tape_new(graph, roots, root_count, arena);
    Regions regions = {0};
    graph_regions(&regions, graph, roots, root_count, arena);
    size_t most   = tape.count + regions.list.count;
    Layout layout = {&regions, arena_new_array(arena, Node, most + 1),
                     arena_new_array(arena, uint32_t, most + 1), tape.frame_count};
    memcpy(layout.nodes, tape.nodes, tape.frame_count * sizeof *layout.nodes);
    lay_out(&layout, REGION_ALWAYS);
    tape.nodes = layout.nodes;
    tape.skips = layout.skips;
    tape.count = layout.count;
    return tape;
}

/* ---- what it needs ---- */

bool tape_needs_frame(const Tape *tape)
{
    for (size_t i = 0; i < tape->frame_count; i++)
        if (tape->graph->items[tape->nodes[i]].time == TIME_FRAME)
            return true;
    return false;
}

size_t tape_operations(const Tape *tape)
{
    size_t count = tape->count - tape->frame_count;
    for (uint32_t id = 0; id < tape->function_count; id++)
        count += tape->functions[id].count;
    return count;
}

static const InstanceTable *table_of(const Tape *tape, uint32_t function)
{
    const Instances *instances = tape->graph->instances;
    return &instances->tables.items[instances->functions.items[function].table_number];
}

static double flops_of(const Tape *tape, bool separate);

/* Counts the operations of a call for all instances, or for a typical list and one instance
   more. */
static double call_flops(const Tape *tape, uint32_t function, bool separate)
{
    const InstanceTable *table = table_of(tape, function);
    const Grid          *grid  = &table->cells;
    size_t               cells = grid_cell_count(grid);
    double               mean  = (double)grid->first[cells] / (double)cells;
    return (separate ? table->rows : mean + 1) * flops_of(&tape->functions[function], separate);
}

static double node_flops(const Tape *tape, Node node, bool separate)
{
    const Expr *expr = &tape->graph->items[node];
    GraphType   types[MAX_OPERANDS];
    if (expr->operand_count == 0 || (separate && expr->op == OP_row))
        return 0;
    for (uint32_t k = 0; k < expr->operand_count; k++)
        types[k] = tape->graph->items[expr->operands[k]].type;
    double flops = op_cost((Op)expr->op, expr->type, types);
    if (!is_call((Op)expr->op))
        return flops;
    double loop = call_flops(tape, called_function(tape->graph, expr), separate);
    return separate ? loop : flops + loop;
}

static double flops_of(const Tape *tape, bool separate)
{
    double flops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++)
        flops += node_flops(tape, tape->nodes[i], separate);
    return flops;
}

double tape_node_flops(const Tape *tape, Node node) { return node_flops(tape, node, false); }
double tape_flops(const Tape *tape) { return flops_of(tape, false); }
double tape_flops_separate(const Tape *tape) { return flops_of(tape, true); }

/* Counts the loops of a call for the longest list. */
static double call_loops(const Tape *tape, uint32_t function)
{
    return (double)table_of(tape, function)->cells.max_listed *
           (1 + (double)tape_loops(&tape->functions[function]));
}

uint32_t tape_loops(const Tape *tape)
{
    const Expr *items = tape->graph->items;
    double      loops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *expr  = &items[tape->nodes[i]];
        uint32_t    range = expr->op == OP_julia ? 2 : expr->op == OP_mandelbulb ? 1 : 0;
        if (range > 0) /* always a constant (fractal.c) */
            loops += fractal_loops((Op)expr->op, items[expr->operands[range]].number[1]);
        if (is_call((Op)expr->op))
            loops += call_loops(tape, called_function(tape->graph, expr));
    }
    return loops < UINT32_MAX ? (uint32_t)loops : UINT32_MAX;
}

size_t tape_index(const Tape *tape, Node node)
{
    bool   point = tape->graph->items[node].time == TIME_POINT;
    size_t low = point ? tape->frame_count : 0, high = point ? tape->count : tape->frame_count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (tape->nodes[middle] <= node)
            low = middle;
        else
            high = middle;
    }
    assert(low < tape->count && tape->nodes[low] == node);
    return low;
}

bool tape_depends_on(const Tape *tape, uint32_t slot)
{
    for (size_t i = 0; i < tape->frame_count; i++) {
        const Expr *e = &tape->graph->items[tape->nodes[i]];
        if (e->op == OP_PARAMETER && (e->index == slot || slot == ANY_SLOT))
            return true;
    }
    return false;
}
