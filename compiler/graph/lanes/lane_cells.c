/*
 * lane_cells.c: short tapes for cells of space.
 *
 * What an operation is bounded by comes from its value in the middle and its slope.  Where it has no slope, as
 * comparisons have none, its row of ops.def tells a range by those of its operands.
 */
#include "compiler/graph/lanes/lane_cells.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_call.h"

/* As many instances of a call have their bodies in a tape at most, and these as many steps. */
enum { MAX_CELL_INSTANCES = 64, MAX_BODY_STEPS = 4096 };

struct CellWork {
    NodeValue *values;
    float    **rows; /* of each depth */
    /* By row, while a tape is made: whether it is needed, and then between a floor and a cap; the row that stands for it;
       and where that is in the tape that is made. */
    bool     *needed;
    float    *caps, *floors;
    uint32_t *same, *now;
    CellStep *steps; /* a stack */
    CellCall *calls; /* a stack, too */
    size_t    step_count, call_count;
    /* By call of the tape that is shortened: the instances that may count in the ball; none: it stays a call. */
    uint32_t (*instances)[MAX_CELL_INSTANCES];
    uint32_t *instance_counts;
    uint32_t *body_rows, *body_scalars; /* of a body whose steps are added */
};

/* ---- operations ---- */

static bool is_lesser(uint16_t op) { return op == OP_min || op == LANE_LESSER; }
static bool is_greater(uint16_t op) { return op == OP_max || op == LANE_GREATER; }

/* What ops.def says of an operation. */
static const NumberRow *row_of_op(uint16_t op)
{
    return &number_rows[is_lesser(op)    ? OP_min
                        : is_greater(op) ? OP_max
                        : op < OP_COUNT  ? op
                                         : OP_CONSTANT];
}

/* ---- instance groups ---- */

/* The function of a call that takes the least distance of its instances, one after the other; NULL: it is none. */
static const InstanceFunction *least_of_instances(const LaneTape *tape, const LaneCall *call)
{
    const Graph *graph = tape->tape->graph;
    if (!call->body || tape->tape->by_cells || call->body->tape.call_count > 0 ||
        graph->items[call->node].op != OP_instance_distance)
        return NULL;
    const InstanceFunction *function = &graph->instances->functions.items[call->body->function];
    const InstanceTable    *table    = &graph->instances->tables.items[call->body->table];
    const bool least = function->slope > 0 && function->state_count == 1 && !function->either &&
                       !function->joins && !function->sums && function->type == TYPE_FLOAT;
    return least && table->bounds ? function : NULL;
}

/* Steps that its body becomes for an instance at most: numbers of rows are steps, too. */
static size_t steps_of_instance(const LaneBody *body)
{
    return body->tape.count + body->tape.scalar_count;
}

/* ---- the tape for all of space ---- */

static uint32_t row_of(uint32_t operand, uint32_t inputs)
{
    return operand & LANE_SCALAR ? operand & ~LANE_SCALAR : inputs + operand;
}

/* How fast a row changes at most; 0: not known. */
static double steepest_of(const CellStep *steps, uint32_t inputs, uint32_t row)
{
    const uint32_t first = inputs + LANE_INPUTS;
    if (row < inputs)
        return 1e-30;
    return row >= first                    ? (double)steps[row - first].steepest
           : row < inputs + LANE_POINT + 3 ? 1
                                           : 0;
}

/* That of a call, by how fast the point of the call moves. */
static double steepest_of_call(const LaneTape *tape, const CellCall *call, const CellStep *steps,
                               uint32_t inputs)
{
    const InstanceFunction *function = least_of_instances(tape, call->call);
    double                  square   = 0;
    bool                    itself   = true;
    if (!function)
        return 0;
    for (uint32_t c = 0; c < 3; c++) {
        const double by = steepest_of(steps, inputs, call->from[1][c]);
        if (by == 0)
            return 0;
        square += by * by;
        itself = itself && call->from[1][c] == inputs + LANE_POINT + c;
    }
    return function->slope * (itself ? 1 : sqrt(square));
}

/* That of what lane tapes know nothing of, since it is made of calls: by derivatives that hold everywhere. */
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
        if (steep == 0)
            return 0;
        sum += range_largest(by[k]) * steep;
        most = fmax(most, steep);
    }
    most = row->norm == NORM_CONVEX ? most : sum;
    return isfinite(most) ? most : 0;
}

CellTape cell_tape_new(const LaneTape *tape, Arena *arena)
{
    const uint32_t inputs = (uint32_t)tape->scalar_count;
    CellStep      *steps  = arena_new_array(arena, CellStep, tape->count + 1);
    CellCall      *calls  = arena_new_array(arena, CellCall, tape->call_count + 1);
    for (size_t i = 0; i < tape->count; i++) {
        const LaneStep *from  = &tape->steps[i];
        const bool      plain = from->op != LANE_CALL && from->op != LANE_PART;
        steps[i]              = (CellStep){.op            = from->op,
                                           .operand_count = plain ? from->operand_count : 0,
                                           .steepest      = from->steepest};
        for (uint32_t k = 0; k < steps[i].operand_count; k++)
            steps[i].from[k] = row_of(from->operands[k], inputs);
        if (from->op == LANE_CALL)
            steps[i].from[0] = from->operands[0];
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
    return (CellTape){.whole      = tape,
                      .steps      = steps,
                      .calls      = calls,
                      .count      = (uint32_t)tape->count,
                      .call_count = (uint32_t)tape->call_count,
                      .inputs     = inputs,
                      .output     = row_of(tape->outputs[0], inputs),
                      .cap        = HUGE_VALF};
}

/* ---- what a thread needs ---- */

static float *new_rows(const CellTape *tape, size_t count, Arena *arena)
{
    enum { ALIGNMENT = 64 };
    char  *memory = arena_alloc(arena, count * CELL_LANES * sizeof(float) + ALIGNMENT, 1);
    float *rows   = (float *)(memory + (ALIGNMENT - (uintptr_t)memory % ALIGNMENT) % ALIGNMENT);
    for (size_t i = 0; i < tape->inputs; i++)
        for (int lane = 0; lane < CELL_LANES; lane++)
            rows[i * CELL_LANES + lane] = (float)tape->whole->scalars[i] + 0.0f;
    return rows;
}

/* What bodies of instances may add to all tapes that are made of one, and the steps of the longest body. */
static size_t steps_of_bodies(const CellTape *tape, size_t *longest)
{
    size_t all = 0;
    *longest   = 0;
    for (uint32_t i = 0; i < tape->call_count; i++)
        if (least_of_instances(tape->whole, tape->calls[i].call)) {
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
    const size_t count = tape->count + steps_of_bodies(tape, &longest);
    const size_t rows = (size_t)tape->inputs + LANE_INPUTS + count, calls = tape->call_count + 1;
    *work = (CellWork){.values          = values,
                       .rows            = arena_new_array(arena, float *, depth + 1),
                       .needed          = arena_new_array(arena, bool, rows),
                       .now             = arena_new_array(arena, uint32_t, rows),
                       .caps            = arena_new_array(arena, float, rows),
                       .floors          = arena_new_array(arena, float, rows),
                       .same            = arena_new_array(arena, uint32_t, rows),
                       .steps           = arena_new_array(arena, CellStep, count * depth + 1),
                       .calls           = arena_new_array(arena, CellCall, calls * depth),
                       .instances       = arena_alloc(arena, calls, sizeof *work->instances),
                       .instance_counts = arena_new_array(arena, uint32_t, calls),
                       .body_rows       = arena_new_array(arena, uint32_t, LANE_INPUTS + longest),
                       .body_scalars    = arena_new_array(arena, uint32_t, longest + 1)};
    for (uint32_t i = 0; i <= depth; i++)
        work->rows[i] = new_rows(tape, rows, arena);
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

/* ---- bounds ---- */

/* The ball of a lane. */
typedef struct Ball {
    const CellTape *tape;
    const float    *rows; /* values in its middle: those of the lane */
    float           radius, margin;
} Ball;

static bool is_constant(const CellTape *tape, uint32_t row) { return row < tape->inputs; }

static const CellStep *step_of(const CellTape *tape, uint32_t row)
{
    const uint32_t first = tape->inputs + LANE_INPUTS;
    return row < first ? NULL : &tape->steps[row - first];
}

/* How much a row may differ from its value in the middle; infinite: there is no bound. */
static float reach_of(const Ball *ball, uint32_t row)
{
    const CellStep *step = step_of(ball->tape, row);
    if (is_constant(ball->tape, row))
        return 0;
    if (!step)
        return row < ball->tape->inputs + LANE_POINT + 3 ? ball->radius + ball->margin : HUGE_VALF;
    if (step->op == LANE_NUMBER)
        return 0;
    return step->steepest > 0 ? step->steepest * (ball->radius + ball->margin) : HUGE_VALF;
}

static float value_of(const Ball *ball, uint32_t row)
{
    return ball->rows[(size_t)row * CELL_LANES];
}

static Range range_by_slope(const Ball *ball, uint32_t row)
{
    const double value = (double)value_of(ball, row), reach = (double)reach_of(ball, row);
    return isfinite(value) && isfinite(reach) ? (Range){value - reach, value + reach} : ANYTHING;
}

/* By the slope, or else by those of the operands. */
static Range range_of_row(const Ball *ball, uint32_t row)
{
    const CellStep *step = step_of(ball->tape, row);
    if (!step || step->steepest > 0 || step->op >= OP_COUNT || !number_rows[step->op].range)
        return range_by_slope(ball, row);
    Range o[MAX_OPERANDS] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    for (uint32_t k = 0; k < step->operand_count; k++)
        o[k] = range_by_slope(ball, step->from[k]);
    return number_rows[step->op].range(o);
}

float cell_row_reach(const CellTape *tape, uint32_t row, float radius, float margin)
{
    return reach_of(&(Ball){tape, NULL, radius, margin}, row);
}

float cell_reach(const CellTape *tape, float radius, float margin)
{
    return cell_row_reach(tape, tape->output, radius, margin);
}

/* ---- what is needed ---- */

typedef struct Pruning {
    Ball      ball;
    CellWork *work;
} Pruning;

/* A row is needed, and of it what lies between a floor and a cap. */
static void need(Pruning *p, uint32_t row, float cap, float floor)
{
    CellWork *work = p->work;
    if (is_constant(p->ball.tape, row))
        return;
    if (!work->needed[row]) {
        work->needed[row] = true;
        work->caps[row]   = cap;
        work->floors[row] = floor;
        return;
    }
    work->caps[row]   = cap > work->caps[row] ? cap : work->caps[row];
    work->floors[row] = floor < work->floors[row] ? floor : work->floors[row];
}

static void need_all(Pruning *p, const CellStep *step)
{
    for (uint32_t k = 0; k < step->operand_count; k++)
        need(p, step->from[k], HUGE_VALF, -HUGE_VALF);
}

/* Of a minimum, or with sign -1 of a maximum.  Operands that are above the cap in all of the ball are not
   needed, but for one. */
static void need_of_least(Pruning *p, const CellStep *step, uint32_t row, float sign)
{
    CellWork      *work = p->work;
    const uint32_t a = step->from[0], b = step->from[1];
    const float    value_a = sign * value_of(&p->ball, a), value_b = sign * value_of(&p->ball, b);
    const float    reach_a = reach_of(&p->ball, a), reach_b = reach_of(&p->ball, b);
    float          cap = sign > 0 ? work->caps[row] : -work->floors[row];
    if (value_a + reach_a < cap)
        cap = value_a + reach_a;
    if (value_b + reach_b < cap)
        cap = value_b + reach_b;
    bool drops_a = value_a - reach_a > cap, drops_b = value_b - reach_b > cap;
    if (drops_a && drops_b) {
        drops_a = value_a - reach_a > value_b - reach_b;
        drops_b = !drops_a;
    }
    work->same[row] = drops_a ? b : drops_b ? a : row;
    if (!drops_a)
        need(p, a, sign > 0 ? cap : HUGE_VALF, sign > 0 ? -HUGE_VALF : -cap);
    if (!drops_b)
        need(p, b, sign > 0 ? cap : HUGE_VALF, sign > 0 ? -HUGE_VALF : -cap);
}

/* Sums and products are one of their operands where the other is 0 or 1, which is seen later. */
static bool is_arithmetic(uint16_t op)
{
    return op == OP_add || op == OP_sub || op == OP_mul || op == OP_div;
}

/* The only operand that it may be; `row`: there may be several. */
static uint32_t only_operand(const Pruning *p, const CellStep *step, uint32_t row)
{
    const NumberRow *known           = step->op < OP_COUNT ? &number_rows[step->op] : NULL;
    Range            o[MAX_OPERANDS] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    if (!known || !known->chooses || is_arithmetic(step->op))
        return row;
    for (uint32_t k = 0; k < step->operand_count; k++)
        o[k] = range_of_row(&p->ball, step->from[k]);
    const unsigned chosen = known->chooses(o);
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (chosen == 1u << k && isfinite(o[k].low) && isfinite(o[k].high))
            return step->from[k];
    return row;
}

/* How far a box is from a range of points at least. */
static double distance_of_boxes(const Box *box, const Range at[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double off = max2(max2(box->axis[k].low - at[k].high, at[k].low - box->axis[k].high),
                                0);
        square += off * off;
    }
    return sqrt(square) * (1 - 1e-12);
}

/* Lists the instances of a call that may be the nearest in the ball; none: it stays a call. */
static void find_instances(Pruning *p, const CellStep *step, uint32_t row)
{
    const CellTape *tape  = p->ball.tape;
    const CellCall *call  = &tape->calls[step->from[0]];
    uint32_t       *found = p->work->instances[step->from[0]], count = 0;
    const Range     nearest = range_by_slope(&p->ball, row);
    Range           at[3];
    p->work->instance_counts[step->from[0]] = 0;
    if (!least_of_instances(tape->whole, call->call) || !isfinite(nearest.high))
        return;
    const InstanceTable *table =
        &tape->whole->tape->graph->instances->tables.items[call->call->body->table];
    for (int k = 0; k < 3; k++) {
        at[k] = range_by_slope(&p->ball, call->from[1][k]);
        if (!isfinite(at[k].high))
            return;
    }
    for (uint32_t i = 0; i < table->rows; i++) {
        if (distance_of_boxes(&table->bounds[i], at) > nearest.high * table->stretch)
            continue;
        if (count == MAX_CELL_INSTANCES ||
            (count + 1) * steps_of_instance(call->call->body) > MAX_BODY_STEPS)
            return;
        found[count++] = i;
    }
    p->work->instance_counts[step->from[0]] = count;
}

static void need_of_call(Pruning *p, const CellStep *step, uint32_t row)
{
    const CellCall *call = &p->ball.tape->calls[step->from[0]];
    find_instances(p, step, row);
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
            need(p, call->from[k][c], HUGE_VALF, -HUGE_VALF);
}

/* Of opposites, sums with a constant, and products by one above 0. */
static bool need_of_linear(Pruning *p, const CellStep *step, float cap, float floor)
{
    if (step->op == OP_neg) {
        need(p, step->from[0], -floor, -cap);
        return true;
    }
    const uint32_t a = step->from[0], b = step->from[1];
    const bool     constant_a = is_constant(p->ball.tape, a);
    const float    by         = value_of(&p->ball, constant_a ? a : b);
    if (step->operand_count != 2 || constant_a == is_constant(p->ball.tape, b))
        return false;
    const uint32_t other = constant_a ? b : a;
    if (step->op == OP_add)
        need(p, other, cap - by, floor - by);
    else if (step->op == OP_sub && !constant_a)
        need(p, other, cap + by, floor + by);
    else if (step->op == OP_mul && by > 0)
        need(p, other, cap / by, floor / by);
    else
        return false;
    return true;
}

static void need_of_step(Pruning *p, const CellStep *step, uint32_t row)
{
    CellWork   *work = p->work;
    const float cap = work->caps[row], floor = work->floors[row];
    work->same[row] = row;
    if (is_lesser(step->op) || is_greater(step->op)) {
        need_of_least(p, step, row, is_lesser(step->op) ? 1 : -1);
        return;
    }
    if (step->op == LANE_CALL) {
        need_of_call(p, step, row);
        return;
    }
    if (step->op == LANE_PART)
        need(p, row - 1, HUGE_VALF, -HUGE_VALF);
    if (step->op == LANE_PART || step->op == LANE_NUMBER)
        return;
    work->same[row] = only_operand(p, step, row);
    if (work->same[row] != row)
        need(p, work->same[row], cap, floor);
    else if (!need_of_linear(p, step, cap, floor))
        need_all(p, step);
}

/* ---- the shorter tape ---- */

/* Where a row of the longer tape is in the shorter one; what is before the steps stays where it is. */
static uint32_t moved(const Pruning *p, uint32_t row)
{
    return step_of(p->ball.tape, row) ? p->work->now[row] : row;
}

/* The row that stands for a step whose operands have moved, by those that are constants; `row`: none. */
static uint32_t simpler(const Pruning *p, const CellStep *step, uint32_t row)
{
    Range o[MAX_OPERANDS] = {ANYTHING, ANYTHING, ANYTHING, ANYTHING};
    if (!is_arithmetic(step->op))
        return row;
    for (uint32_t k = 0; k < step->operand_count; k++) {
        const bool constant = is_constant(p->ball.tape, step->from[k]);
        o[k] = constant ? range_of((double)value_of(&p->ball, step->from[k])) : ANYTHING;
        if (step->op == OP_mul && constant && range_is_zero(o[k]))
            return step->from[k];
    }
    const unsigned chosen = row_of_op(step->op)->chooses(o);
    return chosen == CHOOSES_A ? step->from[0] : chosen == CHOOSES_B ? step->from[1] : row;
}

static CellStep moved_step(Pruning *p, const CellStep *from, CellCall *calls, uint32_t *call_count)
{
    CellStep step = *from;
    for (uint32_t k = 0; k < step.operand_count; k++)
        step.from[k] = moved(p, step.from[k]);
    if (step.op != LANE_CALL)
        return step;
    CellCall *call = &calls[*call_count];
    *call          = p->ball.tape->calls[step.from[0]];
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
            call->from[k][c] = moved(p, call->from[k][c]);
    step.from[0] = (*call_count)++;
    return step;
}

/* ---- bodies of instances in place of a call ---- */

static uint32_t add_step(Pruning *p, CellTape *to, CellStep step)
{
    p->work->steps[p->work->step_count + to->count] = step;
    return to->inputs + LANE_INPUTS + to->count++;
}

static uint32_t add_number(Pruning *p, CellTape *to, double number)
{
    const float single = (float)number + 0.0f;
    CellStep    step   = {.op = LANE_NUMBER};
    memcpy(&step.from[0], &single, sizeof single);
    return add_step(p, to, step);
}

/* What a step of the body reads of the instance. */
static double number_of_instance(const Pruning *p, const InstanceTable *table, const LaneStep *step,
                                 uint32_t instance)
{
    const Instances *groups = p->ball.tape->whole->tape->graph->instances;
    if (step->op == LANE_INSTANCE)
        return instance;
    const Node *nodes = column_nodes(groups, table, step->operands[0]);
    return nodes ? p->work->values[nodes[instance]].v[0]
                 : table->numbers[(size_t)instance * table->columns + step->operands[0]];
}

/* Adds the steps of a body for one instance; returns the row of its state.  What takes the lesser of the state
   before and another number is a distance, so both are no steeper than the call. */
static uint32_t add_instance(Pruning *p, CellTape *to, const CellCall *call, uint32_t instance,
                             uint32_t state, float steepest)
{
    const LaneBody      *body = call->call->body;
    const InstanceTable *table =
        &p->ball.tape->whole->tape->graph->instances->tables.items[body->table];
    uint32_t      *rows   = p->work->body_rows;
    const uint32_t before = state, first = to->inputs + LANE_INPUTS;
    for (int k = 0; k < 3; k++)
        rows[LANE_POINT + k] = moved(p, call->from[1][k]);
    for (size_t i = 0; i < body->tape.count; i++) {
        const LaneStep *from = &body->tape.steps[i];
        if (from->op == LANE_STATE) {
            rows[LANE_INPUTS + i] = state;
            continue;
        }
        if (from->op == LANE_ROW || from->op == LANE_INSTANCE) {
            rows[LANE_INPUTS + i] = add_number(p, to, number_of_instance(p, table, from, instance));
            continue;
        }
        CellStep step = {.op = from->op, .operand_count = from->operand_count};
        for (uint32_t k = 0; k < step.operand_count; k++)
            step.from[k] = from->operands[k] & LANE_SCALAR
                               ? p->work->body_scalars[from->operands[k] & ~LANE_SCALAR]
                               : rows[from->operands[k]];
        const bool least = is_lesser(step.op) && (step.from[0] == before || step.from[1] == before);
        const uint32_t other = step.from[0] == before ? step.from[1] : step.from[0];
        step.steepest        = least ? steepest : 0;
        if (least && other >= first &&
            p->work->steps[p->work->step_count + other - first].op != LANE_NUMBER)
            p->work->steps[p->work->step_count + other - first].steepest = steepest;
        rows[LANE_INPUTS + i] = add_step(p, to, step);
    }
    const uint32_t output = body->tape.outputs[0];
    return output & LANE_SCALAR ? p->work->body_scalars[output & ~LANE_SCALAR] : rows[output];
}

/* Adds the bodies of the instances that may count; returns the row of the result. */
static uint32_t add_instances(Pruning *p, CellTape *to, const CellStep *step)
{
    const CellCall         *call     = &p->ball.tape->calls[step->from[0]];
    const LaneTape         *body     = &call->call->body->tape;
    const InstanceFunction *function = least_of_instances(p->ball.tape->whole, call->call);
    for (size_t i = 0; i < body->scalar_count; i++)
        p->work->body_scalars[i] = add_number(
            p, to,
            body->sources[i].node == NODE_NONE
                ? body->sources[i].number
                : p->work->values[body->sources[i].node].v[body->sources[i].component]);
    uint32_t state = add_number(p, to, function->states[0].first[0]);
    for (uint32_t i = 0; i < p->work->instance_counts[step->from[0]]; i++)
        state = add_instance(p, to, call, p->work->instances[step->from[0]][i], state,
                             step->steepest);
    return state;
}

/* Adds what is needed of a step to the shorter tape. */
static void move_step(Pruning *p, CellTape *to, uint32_t i)
{
    CellWork       *work  = p->work;
    const uint32_t  first = to->inputs + LANE_INPUTS, row = first + i;
    const CellStep *from = &p->ball.tape->steps[i];
    /* All parts of a call follow it, whether they are needed or not. */
    const bool part = from->op == LANE_PART;
    if (!work->needed[part ? row - 1 : row])
        return;
    work->needed[row] |= part;
    if (work->same[row] != row && !part) {
        work->now[row] = moved(p, work->same[row]);
        return;
    }
    if (from->op == LANE_CALL && work->instance_counts[from->from[0]] > 0) {
        work->now[row] = add_instances(p, to, from);
        return;
    }
    const uint32_t next = first + to->count;
    CellStep      *step = &work->steps[work->step_count + to->count];
    *step               = moved_step(p, from, &work->calls[work->call_count], &to->call_count);
    work->now[row]      = simpler(p, step, next);
    to->count += work->now[row] == next;
}

/* The shorter tape, of no steps yet. */
static CellTape begin_shorter(const CellTape *tape, CellWork *work)
{
    CellTape to = *tape;
    to.steps    = work->steps + work->step_count;
    to.calls    = work->calls + work->call_count;
    to.count = to.call_count = 0;
    memset(work->needed, 0,
           (tape->inputs + LANE_INPUTS + (size_t)tape->count) * sizeof *work->needed);
    return to;
}

/* Moves all that is needed for what is needed. */
static void move_steps(Pruning *p, CellTape *to)
{
    const CellTape *tape  = p->ball.tape;
    const uint32_t  first = tape->inputs + LANE_INPUTS;
    for (uint32_t i = tape->count; i-- > 0;)
        if (p->work->needed[first + i])
            need_of_step(p, &tape->steps[i], first + i);
    for (uint32_t i = 0; i < tape->count; i++)
        move_step(p, to, i);
    p->work->step_count += to->count;
    p->work->call_count += to->call_count;
}

CellTape cell_prune(const CellTape *tape, CellWork *work, uint32_t depth, uint32_t lane,
                    float radius, float margin)
{
    Pruning     p    = {{tape, work->rows[depth] + lane, radius, margin}, work};
    CellTape    to   = begin_shorter(tape, work);
    const float most = value_of(&p.ball, tape->output) + reach_of(&p.ball, tape->output);
    const float wide = 2 * radius;
    to.cap           = most < wide || tape->cap < wide ? tape->cap : wide;
    need(&p, tape->output, most < wide ? most : wide, -HUGE_VALF);
    move_steps(&p, &to);
    to.output = moved(&p, tape->output);
    return to;
}

CellTape cell_prune_rows(const CellTape *tape, CellWork *work, uint32_t depth, uint32_t lane,
                         float radius, float margin, uint32_t *rows, size_t count)
{
    Pruning  p  = {{tape, work->rows[depth] + lane, radius, margin}, work};
    CellTape to = begin_shorter(tape, work);
    for (size_t i = 0; i < count; i++)
        need(&p, rows[i], HUGE_VALF, -HUGE_VALF);
    move_steps(&p, &to);
    for (size_t i = 0; i < count; i++)
        rows[i] = moved(&p, rows[i]);
    return to;
}

CellMark cell_mark(const CellWork *work) { return (CellMark){work->step_count, work->call_count}; }

void cell_release(CellWork *work, CellMark mark)
{
    work->step_count = mark.steps;
    work->call_count = mark.calls;
}
