/*
 * lane_cell_prune.c: what is left of a cell tape in a ball.
 *
 * What an operation is bounded by comes from its value in the middle and its slope.  Where it has no slope, as
 * comparisons have none, its row of ops.def tells a range by those of its operands.
 */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/lanes/lane_cell_work.h"

/* ---- bounds ---- */

float cell_row_reach(const CellTape *tape, uint32_t row, float radius, float margin)
{
    return reach_of(&(Ball){tape, NULL, radius, margin, NULL, NULL}, row);
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

/* Returns how much less a row may count as than in the middle.  Of a component without a slope the
   surface is no nearer than that: this is what rays go by. */
static float reach_below(const Ball *ball, uint32_t row)
{
    const CellStep *step  = step_of(ball->tape, row);
    const float     reach = reach_of(ball, row), moves = ball->radius + ball->margin;
    return step && step->component && moves < reach ? moves : reach;
}

/* Notes what a minimum needs, or with sign -1 a maximum.  Operands that are above the cap in all of
   the ball are not needed, but for one. */
static void need_of_least(Pruning *p, const CellStep *step, uint32_t row, float sign)
{
    CellWork      *work = p->work;
    const uint32_t a = step->from[0], b = step->from[1];
    const float    value_a = sign * value_of(&p->ball, a), value_b = sign * value_of(&p->ball, b);
    const float    reach_a = reach_of(&p->ball, a), reach_b = reach_of(&p->ball, b);
    const float    below_a = sign > 0 ? reach_below(&p->ball, a) : reach_a,
                below_b    = sign > 0 ? reach_below(&p->ball, b) : reach_b;
    float cap              = sign > 0 ? work->caps[row] : -work->floors[row];
    if (value_a + reach_a < cap)
        cap = value_a + reach_a;
    if (value_b + reach_b < cap)
        cap = value_b + reach_b;
    bool drops_a = value_a - below_a > cap, drops_b = value_b - below_b > cap;
    if (drops_a && drops_b) {
        drops_a = value_a - below_a > value_b - below_b;
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

/* Returns the only operand that it may be; `row`: there may be several. */
static uint32_t only_operand(const Pruning *p, const CellStep *step, uint32_t row)
{
    const NumberRow *known           = step->op < OP_COUNT ? &number_rows[step->op] : NULL;
    Range            o[MAX_OPERANDS] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    if (!known || !known->chooses || is_arithmetic(step->op))
        return row;
    for (uint32_t k = 0; k < step->operand_count; k++)
        o[k] = cell_range(&p->ball, step->from[k]);
    const unsigned chosen = known->chooses(o);
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (chosen == 1u << k && isfinite(o[k].low) && isfinite(o[k].high))
            return step->from[k];
    return row;
}

/* Makes steps of bodies, if they are few and that is possible. */
static bool bodies_expand(const CellTape *tape, const CellCall *call, uint32_t count)
{
    return min_of_instances(tape->whole, call->call) && count <= MAX_CELL_INSTANCES &&
           count * steps_of_instance(call->call->body) <= MAX_BODY_STEPS;
}

/* Returns the distance to the instances; of a call that is none, that of another one at the same
   point, if there is any. */
static Range distance_of_call(const Pruning *p, const CellCall *call, uint32_t row)
{
    const CellTape *tape = p->ball.tape;
    if (!call->body || distance_of_instances(tape->whole, call->call))
        return cell_range(&p->ball, row);
    for (uint32_t i = 0; i < tape->count; i++) {
        const CellStep *step  = &tape->steps[i];
        const CellCall *other = &tape->calls[step->op == LANE_CALL ? step->from[0] : 0];
        if (step->op == LANE_CALL && other->body && other->body->table == call->body->table &&
            distance_of_instances(tape->whole, other->call) &&
            memcmp(other->from[1], call->from[1], 3 * sizeof other->from[1][0]) == 0)
            return cell_range(&p->ball, tape->inputs + LANE_INPUTS + i);
    }
    return ANYTHING;
}

/* Lists the instances of a call that may count in the ball; else it has those that it had. */
static void find_instances(Pruning *p, const CellStep *step, uint32_t row)
{
    const CellTape *tape = p->ball.tape;
    const CellCall *call = &tape->calls[step->from[0]];
    CellWork       *work = p->work;
    CellList       *list = &work->lists[step->from[0]];
    CellView        view = {.value = distance_of_call(p, call, row)};
    double          by[3];
    uint32_t        count;
    *list = (CellList){call->instances, call->instance_count, false};
    if (!call->body || work->max_listed - work->listed_count < MAX_LISTED)
        return;
    for (int k = 0; k < 3; k++) {
        view.at[k] = cell_range(&p->ball, call->from[1][k]);
        by[k]      = (double)reach_of(&p->ball, call->from[1][k]);
    }
    view.radius     = cell_call_moves(call, by, (double)p->ball.radius + (double)p->ball.margin);
    uint32_t *found = work->listed + work->listed_count;
    if (!cell_find_instances(call, &view, found, MAX_LISTED, &count))
        return;
    *list = (CellList){found, count, bodies_expand(tape, call, count)};
    work->listed_count += count;
}

static void need_of_call(Pruning *p, const CellStep *step, uint32_t row)
{
    const CellCall *call = &p->ball.tape->calls[step->from[0]];
    find_instances(p, step, row);
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
            need(p, call->from[k][c], HUGE_VALF, -HUGE_VALF);
}

/* Notes what opposites, sums with a constant, and products by one above 0 need; false: it is none
   of them. */
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

/* Returns where a row of the longer tape is in the shorter one; what is before the steps stays
   where it is. */
static uint32_t moved(const Pruning *p, uint32_t row)
{
    return step_of(p->ball.tape, row) ? p->work->now[row] : row;
}

/* Returns the row that stands for a step whose operands have moved, by those that are constants;
   `row`: none. */
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

/* Returns how fast a step changes in the ball; 0: it is not known. */
static float steepest_in_ball(const Pruning *p, const CellStep *step)
{
    return p->ball.steepest ? p->ball.steepest[step - p->ball.tape->steps] : step->steepest;
}

/* Returns how fast a row of the shorter tape changes; infinite: that is not known. */
static double steepest_of_moved(const Pruning *p, uint32_t row)
{
    const CellTape *tape  = p->ball.tape;
    const uint32_t  first = tape->inputs + LANE_INPUTS;
    if (row < first)
        return row < tape->inputs ? 0 : row < tape->inputs + LANE_POINT + 3 ? 1 : HUGE_VAL;
    const CellStep *step = &p->work->steps[p->work->step_count + row - first];
    return step->op == LANE_NUMBER ? 0 : step->steepest > 0 ? (double)step->steepest : HUGE_VAL;
}

/* Returns the size of a row of the shorter tape that is a number; infinite: it is none. */
static double size_of_number(const Pruning *p, uint32_t row)
{
    const CellTape *tape  = p->ball.tape;
    const uint32_t  first = tape->inputs + LANE_INPUTS;
    float           number;
    if (row < tape->inputs)
        return (double)fabsf(value_of(&p->ball, row));
    if (row < first || p->work->steps[p->work->step_count + row - first].op != LANE_NUMBER)
        return HUGE_VAL;
    memcpy(&number, &p->work->steps[p->work->step_count + row - first].from[0], sizeof number);
    return (double)fabsf(number);
}

/* Returns how fast a step changes by how fast its operands do; infinite: that is not known. */
static double steepest_by_operands(const Pruning *p, const CellStep *step)
{
    double by[MAX_OPERANDS] = {0}, square = 0;
    for (uint32_t k = 0; k < step->operand_count; k++) {
        by[k] = steepest_of_moved(p, step->from[k]);
        square += by[k] * by[k];
    }
    if (is_lesser(step->op) || is_greater(step->op))
        return fmax(by[0], by[1]);
    if (step->op == OP_neg || step->op == OP_abs)
        return by[0];
    if (step->op == OP_add || step->op == OP_sub)
        return by[0] + by[1];
    if (step->op == OP_length)
        return sqrt(square);
    if (step->op == OP_mul && (by[0] == 0 || by[1] == 0))
        return size_of_number(p, step->from[by[0] == 0 ? 0 : 1]) * by[by[0] == 0 ? 1 : 0];
    return HUGE_VAL;
}

/* Returns how fast a step changes without what was steeper. */
static float min_steepest(const Pruning *p, const CellStep *step)
{
    const double steep = fmax(steepest_by_operands(p, step) * (1 + 1e-6), 1e-30);
    return steep < 1e30 && !(step->steepest > 0 && (double)step->steepest <= steep)
               ? (float)steep
               : step->steepest;
}

static CellStep moved_step(Pruning *p, const CellStep *from, CellCall *calls, uint32_t *call_count)
{
    CellStep    step     = *from;
    const float steepest = steepest_in_ball(p, from);
    step.steepest        = isfinite(steepest) ? steepest : 0;
    for (uint32_t k = 0; k < step.operand_count; k++)
        step.from[k] = moved(p, step.from[k]);
    step.scalars  = scalars_of(&step, p->ball.tape->inputs);
    step.steepest = min_steepest(p, &step);
    if (step.op != LANE_CALL)
        return step;
    CellCall *call = &calls[*call_count];
    *call          = p->ball.tape->calls[step.from[0]];
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
            call->from[k][c] = moved(p, call->from[k][c]);
    call->instances      = p->work->lists[step.from[0]].instances;
    call->instance_count = p->work->lists[step.from[0]].count;
    step.from[0]         = (*call_count)++;
    return step;
}

/* ---- bodies of instances in place of a call ---- */

static uint32_t add_step(Pruning *p, CellTape *to, CellStep step)
{
    p->work->steps[p->work->step_count + to->count] = step;
    return to->inputs + LANE_INPUTS + to->count++;
}

static uint32_t add_number(Pruning *p, CellTape *to, float number)
{
    const CellStep step = {.op = LANE_NUMBER, .from = {lane_bits_of(number)}};
    return add_step(p, to, step);
}

/* Returns a number of the instance that a step of the body reads, as a row holds it. */
static float number_of_instance(const Pruning *p, const InstanceTable *table, const LaneStep *step,
                                uint32_t instance)
{
    const Instances *groups = p->ball.tape->whole->tape->graph->instances;
    if (step->op == LANE_INSTANCE)
        return lane_bits(instance);
    const Node *nodes = column_nodes(groups, table, step->operands[0]);
    return cell_number(
        TYPE_FLOAT, nodes ? p->work->values[nodes[instance]].v[0]
                          : table->numbers[(size_t)instance * table->columns + step->operands[0]]);
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
        step.scalars     = scalars_of(&step, to->inputs);
        const bool least = is_lesser(step.op) && (step.from[0] == before || step.from[1] == before);
        const uint32_t other = step.from[0] == before ? step.from[1] : step.from[0];
        step.steepest        = least ? steepest : min_steepest(p, &step);
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
    const CellList         *list     = &p->work->lists[step->from[0]];
    const LaneTape         *body     = &call->call->body->tape;
    const float             steepest = steepest_in_ball(p, step);
    const InstanceFunction *function = min_of_instances(p->ball.tape->whole, call->call);
    for (size_t i = 0; i < body->scalar_count; i++)
        p->work->body_scalars[i] = add_number(p, to, cell_constant(&call->body->lanes, i));
    uint32_t state = add_number(p, to, cell_number(TYPE_FLOAT, function->states[0].first[0]));
    for (uint32_t i = 0; i < list->count; i++)
        state = add_instance(p, to, call, list->instances[i], state,
                             isfinite(steepest) ? steepest : 0);
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
    if (from->op == LANE_CALL && work->lists[from->from[0]].expands) {
        work->now[row] = add_instances(p, to, from);
        return;
    }
    const uint32_t next = first + to->count;
    CellStep      *step = &work->steps[work->step_count + to->count];
    *step               = moved_step(p, from, &work->calls[work->call_count], &to->call_count);
    work->now[row]      = simpler(p, step, next);
    to->count += work->now[row] == next;
}

/* Returns the ball of a lane.  If all steps have slopes nothing has to be found. */
static Ball ball_of_lane(const CellTape *tape, const CellWork *work, uint32_t depth, uint32_t lane,
                         float radius, float margin)
{
    return (Ball){.tape     = tape,
                  .rows     = work->rows[depth] + lane,
                  .radius   = radius,
                  .margin   = margin,
                  .steepest = tape->steep ? NULL : work->steepest,
                  .ranges   = tape->steep ? NULL : work->ranges};
}

/* Returns the shorter tape, of no steps yet. */
static CellTape begin_shorter(const Ball *ball, CellWork *work)
{
    const CellTape *tape = ball->tape;
    CellTape        to   = *tape;
    if (ball->steepest)
        cell_find_slopes(ball, work->steepest, work->ranges);
    to.steps = work->steps + work->step_count;
    to.calls = work->calls + work->call_count;
    to.count = to.call_count = 0;
    memset(work->needed + tape->inputs + LANE_INPUTS, 0, tape->count * sizeof *work->needed);
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
    to->steep = cell_all_steep(to->steps, to->count);
    p->work->step_count += to->count;
    p->work->call_count += to->call_count;
}

/* A distance is no steeper than 1; one that does not change is no less steep than that, for who divides by it. */
static double steepest_of_output(const CellTape *to)
{
    const uint32_t first = to->inputs + LANE_INPUTS;
    const double   steep = to->output < first ? 0 : (double)to->steps[to->output - first].steepest;
    return steep > 1e-3 && steep < 1 ? steep : 1;
}

CellTape cell_prune(const CellTape *tape, CellWork *work, uint32_t depth, uint32_t lane,
                    float radius, float margin)
{
    Pruning     p    = {ball_of_lane(tape, work, depth, lane, radius, margin), work};
    CellTape    to   = begin_shorter(&p.ball, work);
    const float most = value_of(&p.ball, tape->output) + reach_of(&p.ball, tape->output);
    const float wide = 2 * radius;
    to.cap           = most < wide || tape->cap < wide ? tape->cap : wide;
    need(&p, tape->output, most < wide ? most : wide, -HUGE_VALF);
    move_steps(&p, &to);
    to.output = moved(&p, tape->output);
    to.slope  = (float)steepest_of_output(&to);
    return to;
}

CellTape cell_prune_rows(const CellTape *tape, CellWork *work, uint32_t depth, uint32_t lane,
                         float radius, float margin, uint32_t *rows, size_t count)
{
    Pruning  p  = {ball_of_lane(tape, work, depth, lane, radius, margin), work};
    CellTape to = begin_shorter(&p.ball, work);
    for (size_t i = 0; i < count; i++)
        need(&p, rows[i], HUGE_VALF, -HUGE_VALF);
    move_steps(&p, &to);
    for (size_t i = 0; i < count; i++)
        rows[i] = moved(&p, rows[i]);
    return to;
}

CellMark cell_mark(const CellWork *work)
{
    return (CellMark){work->step_count, work->call_count, work->listed_count};
}

void cell_release(CellWork *work, CellMark mark)
{
    work->step_count   = mark.steps;
    work->call_count   = mark.calls;
    work->listed_count = mark.listed;
}
