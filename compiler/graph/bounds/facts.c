/*
 * facts.c: ranges and slopes of every expression over a box, in one pass.
 *
 * Facts of a graph are one loop over its nodes (rules.c has the rules).  The slope of an
 * expression is refined by cutting the box where it is steepest.
 */
#include "compiler/graph/bounds/facts.h"

#include <assert.h>
#include <math.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/range.h"
#include "compiler/graph/texture.h"

/* ---- facts of nodes ---- */

/* The needed nodes for which facts are computed, each with its index in `facts`. */
typedef struct Analysis {
    const Graph *graph;
    Tape         tape;
    bool         whole; /* facts of all nodes, else of those on the tape, in its order */
    const double (*parameters)[4];
    Fact *facts;
} Analysis;

static Fact *analysis_fact(const Analysis *analysis, Node node)
{
    return &analysis->facts[analysis->whole ? node : tape_index(&analysis->tape, node)];
}

/* The range of each component of a leaf. */
static const Range leaf_ranges[OP_COUNT] = {
#define LEAF(name, text, type, low, high, value, meaning) [OP_##name] = {low, high},
#include "compiler/graph/ops.def"
};

static Fact leaf_fact(const Analysis *analysis, const Expr *e, Box box)
{
    Fact fact = {.slope = HUGE_VAL};
    for (uint32_t i = 0; i < components(e->type); i++)
        fact.value[i] = leaf_ranges[e->op];
    if (e->op == OP_POINT) {
        fact = (Fact){.value = {box.axis[0], box.axis[1], box.axis[2]}, .slope = 1};
        for (int i = 0; i < 3; i++)
            fact.gradient[i][i] = range_of(1);
    } else if (e->op == OP_PARAMETERISED) {
        fact = (Fact){0};
        for (uint32_t i = 0; i < components(e->type); i++)
            fact.value[i] = range_of(e->number[i]);
    } else if (e->op == OP_PARAMETER) {
        fact                    = (Fact){0};
        const GraphParameter *p = e->index < analysis->graph->parameters.count
                                      ? &analysis->graph->parameters.items[e->index]
                                      : NULL;
        for (uint32_t i = 0; i < components(e->type); i++)
            fact.value[i] = analysis->parameters ? range_of(analysis->parameters[e->index][i])
                            : p                  ? (Range){p->low[i], p->high[i]}
                                                 : ANYTHING;
    } else
        for (uint32_t i = 0; i < components(e->type); i++)
            for (int j = 0; j < 3; j++)
                fact.gradient[i][j] = ANYTHING;
    return fact;
}

static Fact node_fact(const Analysis *analysis, Node node, Box box)
{
    const Expr *e = &analysis->graph->items[node];
    GraphType   types[MAX_OPERANDS];
    Fact        operands[MAX_OPERANDS];
    if (e->operand_count == 0 && e->op != OP_CONSTANT)
        return leaf_fact(analysis, e, box);
    for (int i = 0; i < e->operand_count; i++) {
        types[i]    = analysis->graph->items[e->operands[i]].type;
        operands[i] = *analysis_fact(analysis, e->operands[i]);
    }
    if (is_texture(e->op))
        return texture_fact_of(analysis->graph, e, operands);
    /* Rules do not know that two operands are the same number; a square is not negative. */
    bool same = e->operand_count == 2 && e->operands[0] == e->operands[1];
    Op   op   = same && e->op == OP_mul ? OP_square : (Op)e->op;
    Fact fact = op_fact(op, e->type, e->index, types, operands, e->number);
    if (same && op == OP_dot)
        fact.value[0] = range_intersect(fact.value[0], (Range){0, HUGE_VAL});
    return fact;
}

static void analysis_run(const Analysis *analysis, Box box, size_t from, size_t to)
{
    for (size_t i = from; i < to; i++)
        *analysis_fact(analysis, analysis->tape.nodes[i]) = node_fact(analysis,
                                                                      analysis->tape.nodes[i], box);
}

Fact *graph_facts(const Graph *graph, Box box, const double (*parameters)[4], Arena *arena)
{
    Analysis analysis = {.graph = graph, .whole = true, .parameters = parameters};
    analysis.facts    = arena_new_array(arena, Fact, graph->count);
    for (Node node = 0; node < graph->count; node++)
        analysis.facts[node] = node_fact(&analysis, node, box);
    return analysis.facts;
}

RangeTask range_task(const Graph *graph, const Node *roots, size_t count, Arena *arena)
{
    RangeTask task    = {.tape = tape_new(graph, roots, count, arena)};
    task.facts        = arena_new_array(arena, Fact, task.tape.count);
    Analysis analysis = {.graph = graph, .tape = task.tape, .facts = task.facts};
    analysis_run(&analysis, (Box){0}, 0, task.tape.frame_count);
    return task;
}

void range_task_set(const RangeTask *task, const double (*parameters)[4])
{
    Analysis analysis = {.graph      = task->tape.graph,
                         .tape       = task->tape,
                         .facts      = task->facts,
                         .parameters = parameters};
    analysis_run(&analysis, (Box){0}, 0, task->tape.frame_count);
}

void range_task_run(const RangeTask *task, Box box)
{
    Analysis analysis = {.graph = task->tape.graph, .tape = task->tape, .facts = task->facts};
    analysis_run(&analysis, box, task->tape.frame_count, task->tape.count);
}

Range range_task_value(const RangeTask *task, Node node)
{
    return task->facts[tape_index(&task->tape, node)].value[0];
}

double range_task_slope(const RangeTask *task, Node node)
{
    return task->facts[tape_index(&task->tape, node)].slope;
}

/* ---- the slope of an expression, over cells of a box ---- */

/* Parts of the box in a heap, the steepest first. */
typedef struct Cell {
    Box    box;
    double slope;
} Cell;

static double cell_slope(const Analysis *analysis, Node root, Box box)
{
    analysis_run(analysis, box, analysis->tape.frame_count, analysis->tape.count);
    return analysis_fact(analysis, root)->slope;
}

/* Sinks a cell from the top of the heap to its position. */
static void heap_sink(Cell *heap, size_t count, Cell cell)
{
    size_t hole = 0;
    for (size_t child; (child = 2 * hole + 1) < count; hole = child) {
        if (child + 1 < count && heap[child + 1].slope > heap[child].slope)
            child++;
        if (heap[child].slope <= cell.slope)
            break;
        heap[hole] = heap[child];
    }
    heap[hole] = cell;
}

static void heap_rise(Cell *heap, size_t count, Cell cell)
{
    size_t hole = count;
    for (; hole && heap[(hole - 1) / 2].slope < cell.slope; hole = (hole - 1) / 2)
        heap[hole] = heap[(hole - 1) / 2];
    heap[hole] = cell;
}

/* The cell that holds the middle point is at least as steep as that point alone, however small
   it is cut: when that is as steep as the whole, cutting is of no use. */
static bool cutting_helps(const Analysis *analysis, Node root, Cell cell)
{
    Box middle;
    for (int i = 0; i < 3; i++)
        middle.axis[i] = range_of(range_cut(cell.box.axis[i]));
    return cell_slope(analysis, root, middle) < cell.slope * (1 - 1e-9);
}

/* The facts, about, that are found at most to make a bound less that there is. */
enum { MAX_FACTS = 1 << 18 };

/* Cuts the steepest cell in two until there are `cells`; the steepest is then the first.  A long
   expression is cut into fewer, once there is a bound. */
static void heap_refine(const Analysis *analysis, Node root, Cell *heap, size_t cells)
{
    const size_t enough = MAX_FACTS / (analysis->tape.count + 1);
    for (size_t count = 1; count < cells; count++) {
        Cell worst = heap[0];
        if ((count > enough && worst.slope < HUGE_VAL) || !(worst.slope > 0) ||
            !cutting_helps(analysis, root, worst))
            return;
        int    axis                   = box_longest_axis(&worst.box);
        double cut                    = range_cut(worst.box.axis[axis]);
        Cell   halves[2]              = {worst, worst};
        halves[0].box.axis[axis].high = cut;
        halves[1].box.axis[axis].low  = cut;
        for (int i = 0; i < 2; i++)
            halves[i].slope = fmin(worst.slope, cell_slope(analysis, root, halves[i].box));
        heap_sink(heap, count, halves[0]);
        heap_rise(heap, count, halves[1]);
    }
}

/* Goes down the steepest operands: to the node where the slope first becomes infinite or, when it
   never does, the one that multiplies it most. */
static Node analysis_blame(const Analysis *analysis, Node root)
{
    Node   worst = root;
    double most  = 0;
    for (Node node = root;;) {
        const Expr *e   = &analysis->graph->items[node];
        double      own = analysis_fact(analysis, node)->slope, steepest = 0;
        Node        next = node;
        for (int i = 0; i < e->operand_count; i++) {
            double slope = analysis_fact(analysis, e->operands[i])->slope;
            next         = slope > steepest ? e->operands[i] : next;
            steepest     = fmax(slope, steepest);
        }
        if (next == node)
            return own == HUGE_VAL ? node : worst;
        if (own == HUGE_VAL && steepest < HUGE_VAL)
            return node;
        if (own < HUGE_VAL && own / steepest > most) {
            most  = own / steepest;
            worst = node;
        }
        node = next;
    }
}

SlopeTask slope_task(const Graph *graph, Node root, Box box, uint32_t cells, Arena *arena)
{
    return (SlopeTask){tape_new(graph, &root, 1, arena), root, box, cells};
}

size_t slope_task_size(const SlopeTask *task)
{
    return task->tape.count * sizeof(Fact) + ((size_t)task->cells + 1) * sizeof(Cell);
}

double slope_task_run(const SlopeTask *task, const double (*parameters)[4], void *workspace,
                      Node *blame)
{
    Analysis analysis = {.graph      = task->tape.graph,
                         .tape       = task->tape,
                         .parameters = parameters,
                         .facts      = workspace};
    Cell    *heap     = (Cell *)(analysis.facts + task->tape.count);
    analysis_run(&analysis, (Box){0}, 0, task->tape.frame_count);
    heap[0] = (Cell){task->box, cell_slope(&analysis, task->root, task->box)};
    heap_refine(&analysis, task->root, heap, task->cells);
    if (blame) {
        cell_slope(&analysis, task->root, heap[0].box);
        *blame = analysis_blame(&analysis, task->root);
    }
    return heap[0].slope;
}

double graph_slope(const Graph *graph, Node root, Box box, const double (*parameters)[4],
                   uint32_t cells, Node *blame, Arena *scratch)
{
    SlopeTask task      = slope_task(graph, root, box, cells, scratch);
    double   *workspace = arena_alloc(scratch, slope_task_size(&task), 1);
    return slope_task_run(&task, parameters, workspace, blame);
}
