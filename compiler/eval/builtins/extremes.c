/*
 * extremes.c: between which numbers an expression of the point stays in a box, by intervals.
 *
 * Cells of the box are cut in two as long as one of them may reach beyond the numbers that are known to
 * occur by more than a hundredth of their difference.  So the result is a bound, also of what jumps, and
 * a sharp one where the expression is simple.  Where a slope is given or found, the value in the middle
 * of a cell limits the others: also those that come from tables, of which intervals know nothing.
 */
#include <math.h>

#include "compiler/eval/builtins/builtins.h"
#include "compiler/graph/bounds/facts.h"

enum { MAX_CELLS = 4000, MAX_CUTS = 24 };

typedef struct Cell {
    Box      box;
    Range    range; /* holds all values in it */
    uint32_t cuts;
} Cell;

typedef struct Extremes {
    Arena     *arena;
    RangeTask  task;
    Node       root;
    double     slope;  /* as given; infinite without */
    bool       varies; /* from frame to frame */
    NodeValue *values; /* at a point */
    Range      found;  /* values that occur, but for rounding */
    Range      sure;   /* of the cells that are not cut any further */
    uint32_t   count;  /* of cells so far */
    struct {
        Cell  *items;
        size_t count, capacity;
    } open;
} Extremes;

/* Returns the range that the value in the middle gives with a slope of the cell. */
static Range range_by_slope(const Extremes *x, Box box, double slope)
{
    double middle[3], reach = slope * 0.5 * box_diagonal(box);
    box_centre(box, middle);
    tape_run_point(&x->task.tape, middle, x->values);
    double value = x->values[x->root].v[0];
    reach += 1e-12 * (reach + fabs(value)); /* for rounding */
    return isfinite(value) ? (Range){value - reach, value + reach} : ANYTHING;
}

static Range range_in(const Extremes *x, Box box)
{
    range_task_run(&x->task, box);
    Range  range = range_task_value(&x->task, x->root);
    double slope = fmin(x->slope, range_task_slope(&x->task, x->root));
    return isfinite(slope) && !x->varies ? range_intersect(range, range_by_slope(x, box, slope))
                                         : range;
}

static void open_cell(Extremes *x, Box box, uint32_t cuts)
{
    double centre[3];
    box_centre(box, centre);
    Box   middle  = {{range_of(centre[0]), range_of(centre[1]), range_of(centre[2])}};
    Range at      = range_in(x, middle);
    x->found.low  = fmin(x->found.low, at.high);
    x->found.high = fmax(x->found.high, at.low);
    Cell cell     = {box, range_in(x, box), cuts};
    x->count++;
    array_push(x->arena, &x->open, cell);
}

static void cut_cell(Extremes *x, const Cell *cell)
{
    Box halves[2];
    box_halve(cell->box, halves);
    open_cell(x, halves[0], cell->cuts + 1);
    open_cell(x, halves[1], cell->cuts + 1);
}

/* Cuts all open cells that may matter; false: there are none. */
static bool cut_all(Extremes *x)
{
    size_t count = x->open.count, before = x->count;
    double slack = 0.01 * fmax(x->found.high - x->found.low, 0);
    Cell  *cells = arena_new_array(x->arena, Cell, count + 1);
    for (size_t i = 0; i < count; i++)
        cells[i] = x->open.items[i];
    x->open.count = 0;
    for (size_t i = 0; i < count; i++) {
        const Cell *cell    = &cells[i];
        bool        matters = cell->range.low < x->found.low - slack ||
                       cell->range.high > x->found.high + slack;
        if (matters && cell->cuts < MAX_CUTS && x->count < MAX_CELLS)
            cut_cell(x, cell);
        else
            x->sure = range_hull(x->sure, cell->range);
    }
    return x->count > before;
}

static Range extremes_of(Elaboration *e, Node node, Box box, double slope)
{
    Extremes x = {
        .arena = e->scratch, .root = node, .found = {HUGE_VAL, -HUGE_VAL}, .slope = slope};
    x.sure          = x.found;
    x.task          = range_task(e->graph, &node, 1, e->scratch);
    x.values        = arena_new_array(e->scratch, NodeValue, e->graph->count);
    x.varies        = tape_needs_frame(&x.task.tape);
    NodeValue *none = arena_new_array(e->scratch, NodeValue, e->graph->parameters.count + 1);
    tape_run_frame(&x.task.tape, none, x.values);
    open_cell(&x, box, 0);
    while (cut_all(&x))
        ;
    arena_free(e->scratch);
    return x.sure;
}

/* Finds the corner of a box that an argument is; of a figure's plane it has two numbers. */
static bool want_corner(Elaboration *e, const Argument *argument, double corner[3], bool high)
{
    uint32_t size = value_size(e, argument->value);
    Node     node = size == 2 || size == 3 ? value_node(e, argument->value) : NODE_NONE;
    if (node == NODE_NONE || value_time(e, argument->value) == TIME_POINT) {
        type_error(e, argument->syntax, argument->value, "a corner of a box, [x, y, z] or [x, y]");
        return false;
    }
    corner[2] = 0;
    for (uint32_t i = 0; i < size; i++) {
        Range range = node_range(e->builder, node, i);
        corner[i]   = high ? range.high : range.low;
    }
    return true;
}

static Value report_endless(Elaboration *e, const Call *call)
{
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[0].syntax->span,
                           "this has no limits in the box");
    diag->label = "it may be infinite there";
    return value_error();
}

Value builtin_extremes(Elaboration *e, Call *call)
{
    double       low[3], high[3], slope = HUGE_VAL;
    Box          box;
    const Value *known = &call->arguments[0].value;
    if (known->type == VALUE_NUMBER) {
        const double both[] = {known->number, known->number};
        return value_vector(e, both, 2);
    }
    Node node = want_numeric(e, call, 0);
    if (node == NODE_NONE || !want_corner(e, &call->arguments[1], low, false) ||
        !want_corner(e, &call->arguments[2], high, true) || !want_constant(e, call, 3, &slope))
        return value_error();
    if (e->graph->items[node].type != TYPE_FLOAT) {
        type_error(e, call->arguments[0].syntax, call->arguments[0].value, "a number");
        return value_error();
    }
    for (int i = 0; i < 3; i++)
        box.axis[i] = (Range){fmin(low[i], high[i]), fmax(low[i], high[i])};
    Range        found  = extremes_of(e, node, box, fabs(slope));
    const double ends[] = {found.low, found.high};
    return isfinite(ends[0]) && isfinite(ends[1]) ? value_vector(e, ends, 2)
                                                  : report_endless(e, call);
}
