/*
 * lane_run.c: lane tapes are run over many points, by the best instruction set that there is.
 */
#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/lanes/lanes.h"
#include "compiler/graph/op_values.h"

/* ---- instruction sets ---- */

static _Atomic(const LaneSet *) used_set;

void lane_use_set(const LaneSet *set) { atomic_store(&used_set, set); }

const LaneSet *lane_used_set(void)
{
    const LaneSet *set = atomic_load_explicit(&used_set, memory_order_relaxed);
    if (!set) {
        lane_sets(&set);
        atomic_store(&used_set, set);
    }
    return set;
}

void lane_cell_run(const struct CellTape *tape, NodeValue *values, float *rows)
{
    lane_used_set()->run_cells(tape, values, rows);
}

void lane_wide_run(const struct CellTape *tape, const float *constants, float *rows, size_t blocks)
{
    lane_used_set()->run_wide(tape, constants, rows, blocks);
}

/* ---- point by point ---- */

NodeValue lane_call(const Tape *tape, NodeValue *values, Node node, const NodeValue *operands)
{
    const Expr *e = &tape->graph->items[node];
    GraphType   types[MAX_OPERANDS];
    if (op_has_traits((Op)e->op, READS_TABLES))
        return tape_run_reader(tape, node, operands, values);
    for (uint32_t k = 0; k < e->operand_count; k++)
        types[k] = tape->graph->items[e->operands[k]].type;
    return op_evaluate((Op)e->op, e->type, e->index, types, operands);
}

double lane_length(const double *vector, uint32_t size)
{
    GraphType type  = (GraphType)size;
    NodeValue value = {0};
    memcpy(value.v, vector, size * sizeof *vector);
    return op_evaluate(OP_length, TYPE_FLOAT, 0, &type, &value).v[0];
}

/* ---- rows ---- */

enum { ROW_ALIGNMENT = 64 };

size_t lane_work_bytes(const LaneTape *tape)
{
    size_t rows = lane_max_rows(tape) > tape->bodies_end ? lane_max_rows(tape) : tape->bodies_end;
    return rows * LANES * sizeof(double) + ROW_ALIGNMENT;
}

LaneWork lane_work_in(void *memory, NodeValue *values)
{
    size_t past = (uintptr_t)memory % ROW_ALIGNMENT;
    void  *rows = (char *)memory + (past ? ROW_ALIGNMENT - past : 0);
    return (LaneWork){.rows = rows, .values = values, .whole = rows};
}

static void put(const LaneWork *work, LanePrecision precision, size_t at, double number)
{
    if (precision == LANE_SINGLE)
        ((float *)work->rows)[at] = (float)number + 0.0f;
    else
        ((double *)work->rows)[at] = number + 0.0;
}

static double get(const LaneWork *work, LanePrecision precision, size_t at)
{
    return precision == LANE_SINGLE ? (double)((const float *)work->rows)[at]
                                    : ((const double *)work->rows)[at];
}

static void fill_inputs(const LaneWork *work, LanePrecision precision, const LanePoints *points,
                        size_t first, size_t count)
{
    size_t filled = (count + LANE_BLOCK - 1) / LANE_BLOCK * LANE_BLOCK;
    for (size_t i = 0; i < filled; i++) {
        size_t at = first + (i < count ? i : count - 1);
        for (uint32_t k = 0; k < 3; k++) {
            put(work, precision, (LANE_POINT + k) * LANES + i, points->points[at][k]);
            put(work, precision, (LANE_NORMAL + k) * LANES + i,
                points->normals ? points->normals[at][k] : 0);
            put(work, precision, (LANE_VIEW + k) * LANES + i,
                points->normals ? points->normals[at][k] : 0);
        }
        put(work, precision, LANE_FOOTPRINT * LANES + i,
            points->footprints ? points->footprints[at] : 0);
        put(work, precision, LANE_FRONT * LANES + i, 1);
    }
}

static double output_at(const LaneTape *tape, const LaneWork *work, LanePrecision precision,
                        size_t output, size_t lane)
{
    uint32_t row = tape->output_rows[output];
    if (row & LANE_SCALAR)
        return tape->scalars[row & ~LANE_SCALAR];
    return get(work, precision, (size_t)row * LANES + lane);
}

void lane_run(const LaneTape *tape, const LaneWork *work, LanePrecision precision,
              LanePoints points, size_t first, size_t outputs, double *results)
{
    LaneRun *run = lane_used_set()->run[precision];
    assert(first + outputs <= tape->output_count);
    for (size_t begin = 0; begin < points.count; begin += LANES) {
        size_t count = points.count - begin < LANES ? points.count - begin : LANES;
        fill_inputs(work, precision, &points, begin, count);
        run(tape, work, count);
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < outputs; k++)
                results[(begin + i) * outputs + k] = output_at(tape, work, precision, first + k, i);
    }
}
