/*
 * iteration_boxes.c: boxes of a shape in each iteration of a loop, by the rules of its kinds.
 *
 * Only what depends on the iteration is looked at.  Its numbers are found for all iterations at once, where
 * they need no other parameter; else their ranges are found for one iteration after the other.
 */
#include "compiler/shape/iteration_boxes.h"

#include <math.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/instances/iterations.h"
#include "compiler/graph/op_values.h"

enum { BLOCK = 64 /* iterations whose boxes are found together */ };

/* What a node depends on. */
enum { ON_ITERATION = 1, ON_OTHERS = 2 };

/* A number of a shape: a column of the table, or ranges. */
typedef struct IterationNumber {
    Node   node;
    int    depends;
    size_t column;    /* ON_TURN alone: of its first component */
    Range  ranges[4]; /* of its components, in the iteration that is looked at */
} IterationNumber;

/* A shape whose box is found in each iteration; without parts and numbers: it is the same in all. */
typedef struct IterationShape {
    const Shape           *shape;
    IterationNumber       *numbers;
    struct IterationShape *parts;
    uint32_t               number_count, part_count;
} IterationShape;

typedef struct Iterations {
    BoxNumbers     numbers; /* those of `current` */
    const Graph   *graph;
    Arena         *scratch;
    Node           iteration;
    unsigned char *depends; /* by nodes */
    struct {
        Node  *items;
        size_t count, capacity;
    } roots; /* of the table */
    size_t                columns;
    double               *table;
    GraphParameter       *parameter; /* of the leaf */
    const double         *values;    /* that it has */
    const IterationShape *current;
    bool                  failed;
} Iterations;

/* ---- what depends on the iteration ---- */

static void mark_nodes(Iterations *t)
{
    t->depends = arena_new_array(t->scratch, unsigned char, t->graph->count);
    for (Node node = 0; node < t->graph->count; node++) {
        const Expr *e     = &t->graph->items[node];
        int         found = e->op == OP_PARAMETER ? ON_OTHERS : 0;
        for (int k = 0; k < e->operand_count; k++)
            found |= t->depends[e->operands[k]];
        t->depends[node] = (unsigned char)(node == t->iteration ? ON_ITERATION : found);
    }
}

/* ---- the numbers of a shape ---- */

static bool any_iterated(const Iterations *t, const Node *nodes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (nodes[i] != NODE_NONE && t->depends[nodes[i]] & ON_ITERATION)
            return true;
    return false;
}

static bool stage_is_iterated(const Iterations *t, const SequenceStage *stage)
{
    Node     nodes[MAX_BOX_NODES];
    uint32_t count = 0;
    switch (stage->kind) {
    case SEQUENCE_REFLECT: return any_iterated(t, (Node[]){stage->normal, stage->offset}, 2);
    case SEQUENCE_SPHERE: return any_iterated(t, (Node[]){stage->centre, stage->radius}, 2);
    case SEQUENCE_MAP:
        count = map_box_nodes(&stage->map, nodes, 0);
        if (stage->map.pole != NODE_NONE)
            nodes[count++] = stage->map.pole;
        return any_iterated(t, nodes, count);
    default: return false;
    }
}

/* Tells whether anything in the tree of a shape without a rule depends on the iteration. */
static bool is_iterated(const Iterations *t, const Shape *shape)
{
    const Node others[] = {shape->distance, shape->bound, shape->formula, shape->blend.steps,
                           shape->map.scale != NODE_NONE ? shape->map.pole : NODE_NONE};
    Node       nodes[MAX_BOX_NODES];
    bool       found = any_iterated(t, nodes, box_nodes(shape, nodes)) ||
                 any_iterated(t, others, sizeof others / sizeof *others);
    for (uint32_t i = 0; i < shape->stage_count && !found; i++)
        found = stage_is_iterated(t, &shape->stages[i]);
    for (uint32_t i = 0; i < box_part_count(shape) && !found; i++)
        found = is_iterated(t, box_part(shape, i));
    return found || (shape->iterated && is_iterated(t, shape->iterated));
}

/* ---- the plan ---- */

static IterationNumber plan_number(Iterations *t, Node node)
{
    IterationNumber number = {.node = node, .depends = t->depends[node]};
    const uint32_t  size   = components((GraphType)t->graph->items[node].type);
    if (number.depends == ON_ITERATION) {
        number.column = t->columns;
        t->columns += size;
        array_push(t->scratch, &t->roots, node);
    } else if (!(number.depends & ON_ITERATION))
        for (uint32_t i = 0; i < size; i++)
            number.ranges[i] = graph_frame_range(t->graph, node, i, t->scratch);
    return number;
}

/* False: some box is not known. */
static bool plan_shape(Iterations *t, const Shape *shape, IterationShape *plan)
{
    *plan = (IterationShape){.shape = shape};
    if (!has_box_rule(shape))
        return !is_iterated(t, shape);
    Node      nodes[MAX_BOX_NODES];
    uint32_t  count = box_nodes(shape, nodes), parts = box_part_count(shape);
    bool      iterated = any_iterated(t, nodes, count);
    ArenaMark mark     = arena_mark(t->scratch);
    plan->parts        = arena_new_array(t->scratch, IterationShape, parts);
    for (uint32_t i = 0; i < parts; i++) {
        if (!plan_shape(t, box_part(shape, i), &plan->parts[i]))
            return false;
        iterated = iterated || plan->parts[i].parts;
    }
    if (!iterated) {
        arena_rewind(t->scratch, mark);
        plan->parts = NULL;
        return true;
    }
    plan->part_count   = parts;
    plan->number_count = count;
    plan->numbers      = arena_new_array(t->scratch, IterationNumber, count);
    for (uint32_t i = 0; i < count; i++)
        plan->numbers[i] = plan_number(t, nodes[i]);
    return true;
}

/* ---- boxes ---- */

/* As found when a shape is made, where a quarter iteration's cosine is 0 and other roundings differ. */
static void round_out(const double *vector, uint32_t size, Range *ranges)
{
    double largest = 0;
    for (uint32_t i = 0; i < size; i++)
        largest = fabs(vector[i]) > largest ? fabs(vector[i]) : largest;
    const double error = 0x1p-50 * largest;
    for (uint32_t i = 0; i < size; i++)
        ranges[i] = vector[i] == 0 ? range_of(0) : (Range){vector[i] - error, vector[i] + error};
}

static void set_ranges(Iterations *t, IterationNumber *number, size_t row)
{
    const GraphType type = (GraphType)t->graph->items[number->node].type;
    const uint32_t  size = components(type);
    if (number->depends == ON_ITERATION) {
        const double *vector = t->table + row * t->columns + number->column;
        for (uint32_t i = 0; i < size; i++)
            t->failed = t->failed || !isfinite(vector[i]);
        if (type == TYPE_BOOL)
            number->ranges[0] = range_of(vector[0]);
        else
            round_out(vector, size, number->ranges);
    } else if (number->depends & ON_ITERATION) {
        t->parameter->low[0] = t->parameter->high[0] = t->values[row];
        for (uint32_t i = 0; i < size; i++)
            number->ranges[i] = graph_frame_range(t->graph, number->node, i, t->scratch);
    }
}

static Range range_in_iteration(const BoxNumbers *numbers, Node node, uint32_t component)
{
    const IterationNumber *number = ((const Iterations *)numbers)->current->numbers;
    while (number->node != node)
        number++;
    return number->ranges[component];
}

static void find_boxes(Iterations *t, const IterationShape *plan, size_t first, size_t count,
                       Box *boxes)
{
    if (!plan->parts) {
        for (size_t i = 0; i < count; i++)
            boxes[i] = plan->shape->box;
        return;
    }
    const ArenaMark mark  = arena_mark(t->scratch);
    Box            *parts = arena_new_array(t->scratch, Box, plan->part_count * count);
    for (uint32_t i = 0; i < plan->part_count; i++)
        find_boxes(t, &plan->parts[i], first, count, parts + i * count);
    t->current = plan;
    for (size_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < plan->number_count; k++)
            set_ranges(t, &plan->numbers[k], first + i);
        boxes[i] = shape_box(&(BoxInput){&t->numbers, plan->shape, parts + i, count});
    }
    arena_rewind(t->scratch, mark);
}

bool iteration_boxes(ShapeBuilder *builder, const Shape *shape, Node iteration,
                     const double *iterations, size_t count, Box *boxes)
{
    Graph          *graph     = builder->graph;
    GraphParameter *parameter = &graph->parameters.items[graph->items[iteration].index];
    const double    low = parameter->low[0], high = parameter->high[0];
    const ArenaMark mark = arena_mark(builder->scratch);
    Iterations      t    = {.numbers   = {range_in_iteration},
                            .graph     = graph,
                            .scratch   = builder->scratch,
                            .iteration = iteration,
                            .parameter = parameter,
                            .values    = iterations};
    IterationShape  plan;
    mark_nodes(&t);
    t.failed = !plan_shape(&t, shape, &plan);
    if (!t.failed) {
        t.table = arena_new_array(t.scratch, double, count *t.columns);
        graph_at_iterations(graph, t.roots.items, t.roots.count, iteration, iterations, count,
                            t.table, t.scratch);
    }
    for (size_t first = 0; first < count && !t.failed; first += BLOCK)
        find_boxes(&t, &plan, first, count - first < BLOCK ? count - first : BLOCK, boxes + first);
    parameter->low[0]  = low;
    parameter->high[0] = high;
    arena_rewind(builder->scratch, mark);
    return !t.failed;
}
