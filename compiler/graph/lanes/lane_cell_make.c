/*
 * lane_cell_make.c: cell tapes for all of space are made of lane tapes, and run at points.
 */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/lanes/lane_cell_work.h"

/* ---- instance groups ---- */

const InstanceFunction *distance_of_instances(const LaneTape *tape, const LaneCall *call)
{
    const Graph *graph = tape->tape->graph;
    if (!call->body || tape->tape->by_cells || graph->items[call->node].op != OP_instance_distance)
        return NULL;
    const InstanceFunction *function = &graph->instances->functions.items[call->body->function];
    return function->slope > 0 && function->type == TYPE_FLOAT ? function : NULL;
}

const InstanceFunction *min_of_instances(const LaneTape *tape, const LaneCall *call)
{
    const InstanceFunction *function = distance_of_instances(tape, call);
    if (!function || call->body->tape.call_count > 0)
        return NULL;
    const InstanceTable *table = &tape->tape->graph->instances->tables.items[call->body->table];
    const bool least = function->state_count == 1 && !function->either && !function->joins &&
                       !function->sums;
    return least && table->bounds ? function : NULL;
}

/* ---- the tape for all of space ---- */

static uint32_t row_of(uint32_t operand, uint32_t inputs)
{
    return operand & LANE_SCALAR ? operand & ~LANE_SCALAR : inputs + operand;
}

/* Returns how fast a row changes at most; 0: not known. */
static double steepest_of(const CellStep *steps, uint32_t inputs, uint32_t row)
{
    const uint32_t first = inputs + LANE_INPUTS;
    if (row < inputs)
        return 1e-30;
    return row >= first                    ? (double)steps[row - first].steepest
           : row < inputs + LANE_POINT + 3 ? 1
                                           : 0;
}

/* Returns how steep a call is, by how fast the point of the call moves. */
static double steepest_of_call(const LaneTape *tape, const CellCall *call, const CellStep *steps,
                               uint32_t inputs)
{
    const InstanceFunction *function = distance_of_instances(tape, call->call);
    double                  by[3];
    for (uint32_t c = 0; c < 3 && function; c++) {
        by[c] = steepest_of(steps, inputs, call->from[1][c]);
        by[c] = by[c] == 0 ? HUGE_VAL : by[c];
    }
    const double moves = function ? cell_call_moves(call, by, 1) : HUGE_VAL;
    return isfinite(moves) ? function->slope * moves : 0;
}

/* Returns how steep a step is of which lane tapes know nothing, since it is made of calls: by
   derivatives that hold everywhere. */
static double steepest_of_step(const LaneTape *tape, const CellStep *step, const CellStep *steps,
                               uint32_t inputs)
{
    const NumberRow *row = row_of_op(step->op);
    Range            o[MAX_OPERANDS], by[MAX_OPERANDS];
    double           sum = 0, most = 0;
    if (!row->map || row->norm == NORM_NONE || row->norm == NORM_MIX)
        return 0;
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        o[k] = k < step->operand_count && step->from[k] < inputs
                   ? range_of(tape->scalars[step->from[k]])
                   : ANYTHING;
    row->first(o, ANYTHING, by);
    for (uint32_t k = 0; k < step->operand_count; k++) {
        const double steep = steepest_of(steps, inputs, step->from[k]);
        if (step->from[k] < inputs)
            continue;
        if (steep == 0)
            return 0;
        sum += range_largest(by[k]) * steep;
        most = fmax(most, steep);
    }
    most = row->norm == NORM_CONVEX ? most : sum;
    return isfinite(most) ? most : 0;
}

bool cell_all_steep(const CellStep *steps, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!(steps[i].steepest > 0) && steps[i].op != LANE_NUMBER)
            return false;
    return true;
}

CellTape cell_tape_alone(const LaneTape *tape, CellCall **all_calls, Arena *arena)
{
    const uint32_t inputs = (uint32_t)tape->scalar_count;
    CellStep      *steps  = arena_new_array(arena, CellStep, tape->count + 1);
    CellCall      *calls  = arena_new_array(arena, CellCall, tape->call_count + 1);
    *all_calls            = calls;
    for (size_t i = 0; i < tape->count; i++) {
        const LaneStep *from  = &tape->steps[i];
        const bool      plain = from->op != LANE_CALL && from->op != LANE_PART;
        steps[i]              = (CellStep){.op            = from->op,
                                           .operand_count = plain ? from->operand_count : 0,
                                           .steepest      = from->steepest,
                                           .component     = from->component};
        for (uint32_t k = 0; k < steps[i].operand_count; k++)
            steps[i].from[k] = row_of(from->operands[k], inputs);
        if (from->op == LANE_CALL)
            steps[i].from[0] = from->operands[0];
        steps[i].scalars = scalars_of(&steps[i], inputs);
    }
    for (size_t i = 0; i < tape->call_count; i++) {
        calls[i].call = &tape->calls[i];
        for (uint32_t k = 0; k < MAX_OPERANDS; k++)
            for (uint32_t c = 0; c < 4; c++) {
                const uint32_t operand = tape->calls[i].operands[k][c];
                calls[i].from[k][c]    = operand == NODE_NONE ? NODE_NONE : row_of(operand, inputs);
            }
    }
    for (size_t i = 0; i < tape->count; i++)
        if (steps[i].steepest == 0)
            steps[i].steepest = (float)(steps[i].op == LANE_CALL
                                            ? steepest_of_call(tape, &calls[steps[i].from[0]],
                                                               steps, inputs)
                                            : steepest_of_step(tape, &steps[i], steps, inputs));
    return (CellTape){.steep      = cell_all_steep(steps, (uint32_t)tape->count),
                      .whole      = tape,
                      .steps      = steps,
                      .calls      = calls,
                      .count      = (uint32_t)tape->count,
                      .call_count = (uint32_t)tape->call_count,
                      .inputs     = inputs,
                      .output     = row_of(tape->outputs[0], inputs),
                      .cap        = HUGE_VALF,
                      .slope      = 1};
}

CellTape cell_tape_new(const LaneTape *tape, const NodeValue *values, Arena *arena)
{
    CellCall      *calls;
    const CellTape made = cell_tape_alone(tape, &calls, arena);
    cell_bodies_new(&made, calls, values, arena);
    return made;
}

/* ---- what a thread needs ---- */

float cell_constant(const LaneTape *tape, size_t i)
{
    const Node node = tape->sources[i].node;
    return cell_number(node == NODE_NONE ? TYPE_FLOAT
                                         : (GraphType)tape->tape->graph->items[node].type,
                       tape->scalars[i]);
}

static void fill_constants(const CellTape *tape, float *rows)
{
    for (size_t i = 0; i < tape->inputs; i++) {
        const float number = cell_constant(tape->whole, i);
        for (int lane = 0; lane < CELL_LANES; lane++)
            rows[i * CELL_LANES + lane] = number;
    }
}

/* Allocates so many numbers, aligned for vectors. */
static float *new_numbers(size_t count, Arena *arena)
{
    enum { ALIGNMENT = 64 };
    char *memory = arena_alloc(arena, count * sizeof(float) + ALIGNMENT, 1);
    return (float *)(memory + (ALIGNMENT - (uintptr_t)memory % ALIGNMENT) % ALIGNMENT);
}

static float *new_rows(const CellTape *tape, size_t count, Arena *arena)
{
    float *rows = new_numbers(count * CELL_LANES, arena);
    fill_constants(tape, rows);
    for (uint32_t i = 0; i < tape->call_count; i++) {
        const CellBody *body = tape->calls[i].body;
        if (body)
            fill_constants(&body->tape, rows + (size_t)body->first_row * CELL_LANES);
    }
    return rows;
}

size_t cell_steps_of_bodies(const CellTape *tape, size_t *longest)
{
    size_t all = 0;
    *longest   = 0;
    for (uint32_t i = 0; i < tape->call_count; i++)
        if (min_of_instances(tape->whole, tape->calls[i].call)) {
            const LaneBody *body = tape->calls[i].call->body;
            const size_t    each = steps_of_instance(body);
            all += each < MAX_BODY_STEPS ? MAX_BODY_STEPS : 0;
            *longest = body->tape.count > *longest ? body->tape.count : *longest;
            *longest = body->tape.scalar_count > *longest ? body->tape.scalar_count : *longest;
        }
    return all;
}

CellWork *cell_work_new(const CellTape *tape, uint32_t depth, NodeValue *values, Arena *arena)
{
    CellWork    *work = arena_new(arena, CellWork);
    size_t       longest;
    const size_t count = tape->count + cell_steps_of_bodies(tape, &longest);
    const size_t rows = cell_row_count(tape), calls = tape->call_count + 1;
    const size_t lists = tape->call_count < MAX_LISTS ? tape->call_count : MAX_LISTS;
    *work              = (CellWork){.values       = values,
                                    .rows         = arena_new_array(arena, float *, depth + 1),
                                    .needed       = arena_new_array(arena, bool, rows),
                                    .now          = arena_new_array(arena, uint32_t, rows),
                                    .caps         = arena_new_array(arena, float, rows),
                                    .floors       = arena_new_array(arena, float, rows),
                                    .same         = arena_new_array(arena, uint32_t, rows),
                                    .steepest     = arena_new_array(arena, float, count + 1),
                                    .ranges       = arena_new_array(arena, Range, count + 1),
                                    .steps        = arena_new_array(arena, CellStep, count * depth + 1),
                                    .calls        = arena_new_array(arena, CellCall, calls * depth),
                                    .lists        = arena_new_array(arena, CellList, calls),
                                    .max_listed   = lists * MAX_LISTED * depth,
                                    .body_rows    = arena_new_array(arena, uint32_t, LANE_INPUTS + longest),
                                    .body_scalars = arena_new_array(arena, uint32_t, longest + 1)};
    work->listed       = arena_new_array(arena, uint32_t, work->max_listed + 1);
    for (uint32_t i = 0; i <= depth; i++)
        work->rows[i] = new_rows(tape, rows, arena);
    work->found     = new_numbers(CELL_WIDE, arena);
    work->wide      = new_numbers((LANE_INPUTS + MAX_WIDE_STEPS) * (size_t)CELL_WIDE, arena);
    work->constants = new_numbers(tape->inputs + 1, arena);
    for (uint32_t i = 0; i < tape->inputs; i++)
        work->constants[i] = cell_constant(tape->whole, i);
    return work;
}

/* ---- points ---- */

const float *cell_run(const CellTape *tape, CellWork *work, uint32_t depth,
                      const float points[3][CELL_LANES])
{
    float *rows = work->rows[depth];
    memcpy(rows + (size_t)(tape->inputs + LANE_POINT) * CELL_LANES, points,
           3 * CELL_LANES * sizeof(float));
    lane_cell_run(tape, work->values, rows);
    return rows + (size_t)tape->output * CELL_LANES;
}

/* Runs a tape block by block. */
static void run_blocks(const CellTape *tape, CellWork *work, uint32_t depth,
                       const float points[3][CELL_WIDE], size_t blocks)
{
    for (size_t b = 0; b < blocks; b++) {
        float part[3][CELL_LANES];
        for (int k = 0; k < 3; k++)
            memcpy(part[k], points[k] + b * CELL_LANES, sizeof part[k]);
        memcpy(work->found + b * CELL_LANES,
               cell_run(tape, work, depth, (const float(*)[CELL_LANES])part),
               CELL_LANES * sizeof *work->found);
    }
}

const float *cell_run_wide(const CellTape *tape, CellWork *work, uint32_t depth,
                           const float points[3][CELL_WIDE], size_t blocks)
{
    if (blocks < 2 || tape->call_count > 0 || tape->count > MAX_WIDE_STEPS ||
        is_constant(tape, tape->output)) {
        run_blocks(tape, work, depth, points, blocks);
        return work->found;
    }
    for (int k = 0; k < 3; k++)
        memcpy(work->wide + (size_t)(LANE_POINT + k) * CELL_WIDE, points[k],
               blocks * CELL_LANES * sizeof(float));
    lane_wide_run(tape, work->constants, work->wide, blocks);
    return work->wide + (size_t)(tape->output - tape->inputs) * CELL_WIDE;
}

const float *cell_run_seen(const CellTape *tape, CellWork *work, const float points[3][CELL_LANES],
                           const float directions[3][CELL_LANES])
{
    memcpy(work->rows[0] + (size_t)(tape->inputs + LANE_NORMAL) * CELL_LANES, directions,
           3 * CELL_LANES * sizeof(float));
    return cell_run(tape, work, 0, points);
}

void cell_outputs(const CellTape *tape, uint32_t *rows)
{
    for (size_t i = 0; i < tape->whole->output_count; i++)
        rows[i] = row_of(tape->whole->outputs[i], tape->inputs);
}

/* A solid is seen from its front where the ray goes against its normal. */
static void fill_fronts(const CellPoints *points, float *fronts)
{
    for (int i = 0; i < CELL_LANES; i++) {
        float along = 0;
        for (int k = 0; k < 3; k++)
            along += points->view[k][i] * points->normal[k][i];
        fronts[i] = along > 0 ? 0 : 1;
    }
}

const float *cell_run_surfaces(const CellTape *tape, CellWork *work, uint32_t depth,
                               const CellPoints *points)
{
    float *rows = work->rows[depth], *inputs = rows + (size_t)tape->inputs * CELL_LANES;
    memcpy(inputs + LANE_POINT * CELL_LANES, points->point, sizeof points->point);
    memcpy(inputs + LANE_NORMAL * CELL_LANES, points->normal, sizeof points->normal);
    memcpy(inputs + LANE_FOOTPRINT * CELL_LANES, points->footprint, sizeof points->footprint);
    memcpy(inputs + LANE_VIEW * CELL_LANES, points->view, sizeof points->view);
    fill_fronts(points, inputs + LANE_FRONT * CELL_LANES);
    lane_cell_run(tape, work->values, rows);
    return rows;
}
