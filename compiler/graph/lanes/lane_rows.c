/*
 * lane_rows.c: which steps of a lane tape are needed, and which rows they work on.
 *
 * Rows are given out in one pass: a row is free again behind the last step that reads it, so there are
 * never more rows than values that are needed at the same time.
 */
#include "compiler/graph/lanes/lane_rows.h"

#include <string.h>

#include "compiler/graph/op_values.h"

/* Calls f for the place of each operand of a step. */
typedef void Visit(void *data, uint32_t *operand);

static void visit_operands(LaneSteps *steps, LaneStep *step, Visit *visit, void *data)
{
    if (step->op != LANE_CALL) {
        for (uint32_t k = 0; k < step->operand_count; k++)
            visit(data, &step->operands[k]);
        return;
    }
    LaneCall *call = &steps->calls.items[step->operands[0]];
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4; c++)
            if (call->operands[k][c] != NODE_NONE)
                visit(data, &call->operands[k][c]);
}

/* ---- what is needed ---- */

static void mark_value(void *data, uint32_t *operand)
{
    bool *needed = data;
    if (!(*operand & LANE_SCALAR))
        needed[*operand] = true;
}

/* A call and its parts are needed together; a part comes behind its call. */
static void mark_parts(const LaneSteps *steps, bool *needed, size_t step)
{
    while (steps->steps.items[step].op == LANE_PART)
        step--;
    for (uint32_t k = 0; steps->steps.items[step].op == LANE_CALL &&
                         k < steps->calls.items[steps->steps.items[step].operands[0]].parts;
         k++)
        needed[LANE_INPUTS + step + k] = true;
}

static bool *find_needed(LaneSteps *steps)
{
    size_t count  = steps->steps.count;
    bool  *needed = arena_new_array(steps->arena, bool, LANE_INPUTS + count);
    for (size_t i = 0; i < steps->outputs.count; i++)
        mark_value(needed, &steps->outputs.items[i]);
    for (size_t i = count; i-- > 0;)
        if (needed[LANE_INPUTS + i]) {
            mark_parts(steps, needed, i);
            visit_operands(steps, &steps->steps.items[i], mark_value, needed);
        }
    return needed;
}

/* New numbers for values, scalars and calls; 0: none. */
typedef struct Renumbering {
    uint32_t   *values, *scalars;
    LaneScalar *sources; /* as they were */
    LaneSteps  *steps;
} Renumbering;

static void renumber(void *data, uint32_t *operand)
{
    Renumbering *by = data;
    if (!(*operand & LANE_SCALAR)) {
        *operand = by->values[*operand];
        return;
    }
    uint32_t scalar = *operand & ~LANE_SCALAR;
    if (!by->scalars[scalar]) {
        array_push(by->steps->arena, &by->steps->sources, by->sources[scalar]);
        by->scalars[scalar] = (uint32_t)by->steps->sources.count;
    }
    *operand = LANE_SCALAR | (by->scalars[scalar] - 1);
}

/* Keeps the order of what is left. */
static void drop_others(LaneSteps *steps, const bool *needed)
{
    Renumbering by    = {.sources = steps->sources.items, .steps = steps};
    size_t      count = steps->steps.count, left = 0, calls = 0;
    by.values  = arena_new_array(steps->arena, uint32_t, LANE_INPUTS + count);
    by.scalars = arena_new_array(steps->arena, uint32_t, steps->sources.count + 1);
    memset(&steps->sources, 0, sizeof steps->sources);
    for (uint32_t i = 0; i < LANE_INPUTS; i++)
        by.values[i] = i;
    for (size_t i = 0; i < count; i++) {
        LaneStep step = steps->steps.items[i];
        if (!needed[LANE_INPUTS + i])
            continue;
        if (step.op == LANE_CALL) {
            steps->calls.items[calls] = steps->calls.items[step.operands[0]];
            step.operands[0]          = (uint32_t)calls++;
        }
        visit_operands(steps, &step, renumber, &by);
        by.values[LANE_INPUTS + i] = (uint32_t)(LANE_INPUTS + left);
        steps->steps.items[left++] = step;
    }
    steps->steps.count = left;
    steps->calls.count = calls;
    for (size_t i = 0; i < steps->outputs.count; i++)
        renumber(&by, &steps->outputs.items[i]);
}

/* ---- rows ---- */

#define ALWAYS UINT32_MAX

typedef struct Rows {
    uint32_t *last; /* of each value: the last step, from 1, that reads it; ALWAYS: an output */
    uint32_t *row;  /* of each value */
    uint32_t *free; /* a stack */
    size_t    free_count;
    uint32_t  count;
    uint32_t  now;
} Rows;

static void note_use(void *data, uint32_t *operand)
{
    Rows *rows = data;
    if (!(*operand & LANE_SCALAR) && rows->last[*operand] != ALWAYS)
        rows->last[*operand] = rows->now;
}

static void free_if_last(void *data, uint32_t *operand)
{
    Rows *rows = data;
    if ((*operand & LANE_SCALAR) || *operand < LANE_INPUTS || rows->last[*operand] != rows->now)
        return;
    rows->last[*operand]           = 0; /* an operand may stand there twice */
    rows->free[rows->free_count++] = rows->row[*operand];
}

static void take_row(Rows *rows, uint32_t value)
{
    rows->row[value] = rows->free_count ? rows->free[--rows->free_count] : rows->count++;
}

static uint32_t located(const Rows *rows, uint32_t operand)
{
    return operand == NODE_NONE || (operand & LANE_SCALAR) ? operand : rows->row[operand];
}

static void find_last_uses(LaneSteps *steps, Rows *rows)
{
    for (size_t i = 0; i < steps->steps.count; i++) {
        rows->now = (uint32_t)i + 1;
        visit_operands(steps, &steps->steps.items[i], note_use, rows);
    }
    for (size_t i = 0; i < steps->outputs.count; i++)
        if (!(steps->outputs.items[i] & LANE_SCALAR))
            rows->last[steps->outputs.items[i]] = ALWAYS;
}

/* Locates the rows of a call and its parts: it writes them all at once, while it reads its
   operands. */
static void locate_call(LaneSteps *steps, Rows *rows, size_t i)
{
    LaneCall *call = &steps->calls.items[steps->steps.items[i].operands[0]];
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4; c++)
            call->from[k][c] = located(rows, call->operands[k][c]);
    for (uint32_t c = 0; c < call->parts; c++) {
        take_row(rows, (uint32_t)(LANE_INPUTS + i + c));
        call->to[c] = rows->row[LANE_INPUTS + i + c];
    }
}

/* Frees the rows of components of a call that nobody reads. */
static void free_unread(const LaneSteps *steps, Rows *rows, size_t i)
{
    uint32_t parts = steps->calls.items[steps->steps.items[i].operands[0]].parts;
    for (uint32_t c = 0; c < parts; c++)
        if (rows->last[LANE_INPUTS + i + c] == 0)
            rows->free[rows->free_count++] = rows->row[LANE_INPUTS + i + c];
}

static void locate_step(const Rows *rows, const LaneStep *step, LaneCode *code)
{
    unsigned scalars = 0;
    for (uint32_t k = 0; k < step->operand_count; k++) {
        bool scalar = step->operands[k] & LANE_SCALAR;
        scalars |= (unsigned)scalar << k;
        code->from[k] = scalar ? step->operands[k] & ~LANE_SCALAR : rows->row[step->operands[k]];
    }
    if (step->operand_count == 0)
        code->from[0] = step->operands[0];
    code->op            = step->op;
    code->operand_count = (uint8_t)step->operand_count;
    code->scalars       = (uint8_t)scalars;
}

static void locate(LaneSteps *steps, Rows *rows, LaneCode *code)
{
    for (size_t i = 0; i < steps->steps.count; i++) {
        LaneStep *step  = &steps->steps.items[i];
        uint32_t  value = (uint32_t)(LANE_INPUTS + i);
        rows->now       = (uint32_t)i + 1;
        if (step->op == LANE_CALL) {
            locate_call(steps, rows, i);
            code[i] = (LaneCode){.op = LANE_CALL, .from = {step->operands[0]}};
            visit_operands(steps, step, free_if_last, rows);
            free_unread(steps, rows, i);
        } else if (step->op == LANE_PART) {
            code[i] = (LaneCode){.op = LANE_PART};
        } else {
            locate_step(rows, step, &code[i]);
            visit_operands(steps, step, free_if_last, rows);
            take_row(rows, value);
            code[i].to = rows->row[value];
        }
    }
}

static bool any_reads_tables(const Graph *graph, const LaneSteps *steps)
{
    for (size_t i = 0; i < steps->calls.count; i++)
        if (op_has_traits((Op)graph->items[steps->calls.items[i].node].op, READS_TABLES))
            return true;
    return false;
}

LaneTape lane_steps_finish(LaneSteps *steps, const Tape *tape)
{
    drop_others(steps, find_needed(steps));
    size_t   count = steps->steps.count, values = LANE_INPUTS + count;
    Arena   *arena   = steps->arena;
    Rows     rows    = {.count = LANE_INPUTS};
    LaneTape made    = {.tape         = tape,
                        .steps        = steps->steps.items,
                        .count        = count,
                        .calls        = steps->calls.items,
                        .call_count   = steps->calls.count,
                        .reads_tables = any_reads_tables(tape->graph, steps),
                        .sources      = steps->sources.items,
                        .scalar_count = steps->sources.count,
                        .outputs      = steps->outputs.items,
                        .output_count = steps->outputs.count};
    rows.last        = arena_new_array(arena, uint32_t, values);
    rows.row         = arena_new_array(arena, uint32_t, values);
    rows.free        = arena_new_array(arena, uint32_t, values);
    made.code        = arena_new_array(arena, LaneCode, count + 1);
    made.output_rows = arena_new_array(arena, uint32_t, made.output_count + 1);
    for (uint32_t i = 0; i < LANE_INPUTS; i++)
        rows.row[i] = i;
    find_last_uses(steps, &rows);
    locate(steps, &rows, made.code);
    for (size_t i = 0; i < made.output_count; i++)
        made.output_rows[i] = located(&rows, made.outputs[i]);
    made.rows = rows.count;
    return made;
}
