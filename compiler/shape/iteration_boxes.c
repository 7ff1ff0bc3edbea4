/*
 * iteration_boxes.c: boxes of a shape in each iteration of a loop, planned as those of states are.
 *
 * Only what depends on the iteration is looked at.  Its numbers are found for all iterations at once.
 */
#include "compiler/shape/iteration_boxes.h"

#include <math.h>

#include "compiler/graph/instances/iterations.h"
#include "compiler/graph/op_values.h"
#include "compiler/shape/box_plan.h"

/* Finds ranges as when a shape is made, where a quarter turn's cosine is 0 and other roundings
   differ. */
static void round_out(const double *vector, uint32_t size, Range *ranges)
{
    double largest = 0;
    for (uint32_t i = 0; i < size; i++)
        largest = fabs(vector[i]) > largest ? fabs(vector[i]) : largest;
    const double error = 0x1p-50 * largest;
    for (uint32_t i = 0; i < size; i++)
        ranges[i] = vector[i] == 0 ? range_of(0) : (Range){vector[i] - error, vector[i] + error};
}

/* Takes the ranges of an iteration: `row` has the components of all nodes.  False: one is not finite. */
static bool set_ranges(const Graph *graph, const BoxPlan *plan, const size_t *columns,
                       const double *row)
{
    bool finite = true;
    for (size_t i = 0; i < plan->numbers.count; i++) {
        PlannedNumber  *number = &plan->numbers.items[i];
        const GraphType type   = (GraphType)graph->items[number->node].type;
        if (!number->asked)
            continue;
        const double *vector = row + columns[number->place];
        for (uint32_t k = 0; k < components(type); k++)
            finite = finite && isfinite(vector[k]);
        if (type == TYPE_BOOL)
            number->ranges[0] = range_of(vector[0]);
        else
            round_out(vector, components(type), number->ranges);
    }
    return finite;
}

static bool find_boxes(const Graph *graph, const BoxPlan *plan, Node leaf, const double *iterations,
                       size_t count, Box *boxes, Arena *arena)
{
    const Node  *nodes   = plan->nodes.items;
    const size_t width   = graph_numbers_of(graph, nodes, plan->nodes.count);
    size_t      *columns = arena_new_array(arena, size_t, plan->nodes.count);
    double      *table   = arena_new_array(arena, double, count *width);
    Box         *found   = arena_new_array(arena, Box, plan->shapes.count);
    for (size_t i = 0; i < plan->nodes.count; i++)
        columns[i] = graph_numbers_of(graph, nodes, i);
    graph_at_iterations(graph, nodes, plan->nodes.count, leaf, iterations, count, table, arena);
    for (size_t i = 0; i < count; i++) {
        if (!set_ranges(graph, plan, columns, table + i * width))
            return false;
        box_plan_find(plan, NULL, NULL, found);
        boxes[i] = found[0];
    }
    return true;
}

bool iteration_boxes(ShapeBuilder *builder, const Shape *shape, Node leaf, const double *iterations,
                     size_t count, Box *boxes, Arena *arena)
{
    BoxPlan plan;
    return box_plan_iterations(builder, shape, leaf, arena, &plan) &&
           find_boxes(builder->graph, &plan, leaf, iterations, count, boxes, arena);
}
