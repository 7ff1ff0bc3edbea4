/*
 * lane_prune.c: what a lane tape need not do in a box.
 *
 * A step whose result is one number all over the box, or always that of one operand, is not needed;
 * nor is what only such steps need.  In one sector of repeat_polar the angle is known: no call is needed.  Results stay the same, bit for bit: an operand is taken only
 * where it is sure to be a number, and a blend only where nothing is taken off.
 */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/blend_shares.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "compiler/graph/lanes/lane_rows.h"
#include "compiler/graph/lanes/lane_steps.h"

/* ---- the shorter tape ---- */

typedef struct Pruning {
    const LaneTape   *from;
    const LaneRanges *ranges;
    LaneSteps         to;
    uint32_t         *same;    /* of each value: the operand that stands for it */
    uint32_t          call_at; /* the value of the last call in `to` */
} Pruning;

static uint32_t stand_in(const Pruning *p, uint32_t operand)
{
    return operand == NODE_NONE || (operand & LANE_SCALAR) ? operand : p->same[operand];
}

/* Tells whether the step has one number in every point. */
static bool is_single(const Pruning *p, size_t value, double *number)
{
    Range range = p->ranges->ranges[value];
    *number     = range.low + 0.0;
    return p->ranges->sure[value] && range_is_single(range) && isfinite(range.low);
}

/* Tells whether an operand is a finite number in every point of the box. */
static bool number_at(const Pruning *p, uint32_t operand, Range *range)
{
    *range = lane_range_at(p->from, p->ranges, operand);
    return lane_is_sure(p->from, p->ranges, operand) && is_finite(*range);
}

/* Returns the operand whose value the step has in every point; NODE_NONE: there is none. */
static uint32_t same_operand(const Pruning *p, const LaneStep *step)
{
    const unsigned BOTH = CHOOSES_A | CHOOSES_B; /* of LANE_LESSER and LANE_GREATER */
    const unsigned sure = step->op < OP_COUNT ? lane_row(step)->sure : BOTH;
    for (uint32_t k = 0; k < step->operand_count; k++)
        if ((sure >> k & 1) && !lane_is_sure(p->from, p->ranges, step->operands[k]))
            return NODE_NONE;
    uint32_t only = lane_only_of(step, lane_chooses(p->from, p->ranges, step));
    return only == NODE_NONE || sure || lane_is_sure(p->from, p->ranges, only) ? only : NODE_NONE;
}

static void prune_step(Pruning *p, size_t i)
{
    LaneStep step = p->from->steps[i], whole = step;
    uint32_t value = (uint32_t)(LANE_INPUTS + i);
    Range    first;
    double   number;
    bool     call   = step.op == LANE_CALL || step.op == LANE_PART;
    bool     single = is_single(p, value, &number);
    uint32_t other  = call || single ? NODE_NONE : same_operand(p, &whole);
    for (uint32_t k = 0; k < step.operand_count && !call; k++)
        step.operands[k] = stand_in(p, step.operands[k]);
    if (step.op == LANE_PART)
        step.operands[0] = p->call_at;
    /* A clamped number may stay the same; then the step is that less itself. */
    if (step.op == OP_sub && step.operands[0] == step.operands[1] &&
        number_at(p, whole.operands[0], &first)) {
        single = true;
        number = 0;
    }
    /* The complement is one step as well, but then more may be known. */
    if (step.op == OP_abs && lane_range_at(p->from, p->ranges, whole.operands[0]).high <= 0)
        step.op = OP_neg;
    uint32_t added = lane_steps_add(&p->to, step);
    if (step.op == LANE_CALL)
        p->call_at = added;
    p->same[value] = single               ? lane_steps_number(&p->to, number)
                     : other != NODE_NONE ? stand_in(p, other)
                                          : added;
}

/* ---- rotations ---- */

/* Tells whether cell_polar is a rotation by an angle that is known, as within one sector. */
static bool is_rotation(const Pruning *p, const LaneCall *call, double *cosine, double *sine)
{
    const Expr *e = &p->from->tape->graph->items[call->node];
    if (e->op != OP_cell_polar || !(call->operands[1][0] & LANE_SCALAR))
        return false;
    Range  x, z;
    double count = p->from->scalars[call->operands[1][0] & ~LANE_SCALAR];
    if (!(count >= 1) || isinf(count) || !number_at(p, call->operands[0][0], &x) ||
        !number_at(p, call->operands[0][2], &z))
        return false;
    double sector  = 2 * M_PI / count;
    Range  sectors = range_round(range_div(range_atan2(z, x), range_of(sector)));
    double angle   = sector * (sectors.low + 0.0);
    *cosine        = real_cos(angle);
    *sine          = real_sin(angle);
    return range_is_single(sectors) && isfinite(angle);
}

/* Adds a c + b s, or a c - b s. */
static uint32_t add_rotated(Pruning *p, uint16_t op, uint32_t a, uint32_t c, uint32_t b, uint32_t s)
{
    LaneStep first  = {.op = OP_mul, .operand_count = 2, .operands = {c, a}};
    LaneStep second = {.op = OP_mul, .operand_count = 2, .operands = {s, b}};
    LaneStep sum    = {.op            = op,
                       .operand_count = 2,
                       .operands = {lane_steps_add(&p->to, first), lane_steps_add(&p->to, second)}};
    return lane_steps_add(&p->to, sum);
}

/* Prunes the steps of its three components; false: it stays a call. */
static bool prune_rotation(Pruning *p, size_t i)
{
    const LaneStep *step = &p->from->steps[i];
    double          cosine, sine;
    if (step->op != LANE_CALL ||
        !is_rotation(p, &p->from->calls[step->operands[0]], &cosine, &sine))
        return false;
    const LaneCall *call = &p->from->calls[step->operands[0]];
    uint32_t        x = stand_in(p, call->operands[0][0]), z = stand_in(p, call->operands[0][2]);
    uint32_t        c = lane_steps_number(&p->to, cosine), s = lane_steps_number(&p->to, sine);
    p->same[LANE_INPUTS + i]     = add_rotated(p, OP_add, x, c, z, s);
    p->same[LANE_INPUTS + i + 1] = stand_in(p, call->operands[0][1]);
    p->same[LANE_INPUTS + i + 2] = add_rotated(p, OP_sub, z, c, x, s);
    return true;
}

/* ---- blends of many ---- */

/* Returns the numbers that may have a share somewhere in the box; their count, or 0: that is not
   known. */
static uint32_t find_sharers(const Pruning *p, const LaneCall *call, uint32_t vectors, double width,
                             uint32_t sharers[MAX_SHARERS])
{
    double   least = HUGE_VAL;
    uint32_t count = 0;
    Range    range;
    for (uint32_t k = 0; k < vectors; k++)
        for (uint32_t c = 0; c < 4; c++) {
            if (!number_at(p, call->operands[k][c], &range))
                return 0;
            least = min2(least, range.high);
        }
    for (uint32_t k = 0; k < vectors; k++)
        for (uint32_t c = 0; c < 4; c++)
            if (number_at(p, call->operands[k][c], &range) &&
                (range.low - least) * (1 - 0x1p-50) <= width)
                sharers[count++] = call->operands[k][c];
    return count;
}

/* Replaces a call where one or two instances have a share; false: it stays a call. */
static bool prune_shares(Pruning *p, size_t i)
{
    LaneStep step = p->from->steps[i];
    uint32_t sharers[MAX_SHARERS];
    if (step.op != LANE_CALL)
        return false;
    const LaneCall *call    = &p->from->calls[step.operands[0]];
    const Expr     *e       = &p->from->tape->graph->items[call->node];
    const uint32_t  vectors = e->operand_count - 1u, width = call->operands[vectors][0];
    if (!sharing_op((Op)e->op).find || !(width & LANE_SCALAR))
        return false;
    double   known = p->from->scalars[width & ~LANE_SCALAR];
    uint32_t count = find_sharers(p, call, vectors, max2(known, 0), sharers);
    if (count != 1 && count != 2)
        return false;
    step.op                  = (uint16_t)sharing_op((Op)e->op).of_two;
    step.operand_count       = 3;
    step.operands[0]         = stand_in(p, sharers[0]);
    step.operands[1]         = stand_in(p, sharers[count - 1]);
    step.operands[2]         = width;
    p->same[LANE_INPUTS + i] = count == 1 ? step.operands[0] : lane_steps_add(&p->to, step);
    return true;
}

/* ---- instance groups ---- */

/* Tells whether an instance function takes the least distance of all instances, one after the other. */
static bool takes_least(const InstanceFunction *function)
{
    return function->slope > 0 && function->state_count == 1 && !function->either &&
           !function->joins && !function->sums && function->type == TYPE_FLOAT;
}

/* Finds the instances that may be nearer than the nearest is at most, in the box; false: they are
   not known, or too many. */
static bool find_min_instances(const Pruning *p, const LaneCall *call, const InstanceTable *table,
                               double farthest, uint32_t *instances, uint32_t *count)
{
    Range at[3];
    *count = 0;
    for (int k = 0; k < 3; k++)
        if (!number_at(p, call->operands[1][k], &at[k]))
            return false;
    if (p->ranges->longest > 1)
        farthest += (p->ranges->longest * p->ranges->longest - 1) *
                    (farthest + 0.5 * table->widest);
    for (uint32_t i = 0; i < table->rows; i++) {
        if (distance_of_boxes(&table->bounds[i], at) > farthest * table->stretch)
            continue;
        if (*count == MAX_LANE_INSTANCES ||
            (*count + 1) * call->body->tape.count > MAX_STEPS_OF_INSTANCES)
            return false;
        instances[(*count)++] = i;
    }
    return *count > 0;
}

/* Returns what a step reads of the instance, as a number. */
static uint32_t instance_number(Pruning *p, const InstanceTable *table, const LaneStep *step,
                                uint32_t instance)
{
    const Instances *groups = p->from->tape->graph->instances;
    if (step->op == LANE_INSTANCE)
        return lane_steps_number(&p->to, instance);
    const Node *nodes = column_nodes(groups, table, step->operands[0]);
    return lane_steps_number(
        &p->to, nodes ? p->ranges->values[nodes[instance]].v[0]
                      : table->numbers[(size_t)instance * table->columns + step->operands[0]]);
}

static uint32_t body_scalar(Pruning *p, const LaneBody *body, uint32_t scalar)
{
    const LaneScalar *source = &body->tape.sources[scalar];
    return lane_steps_number(&p->to, source->node == NODE_NONE
                                         ? source->number
                                         : p->ranges->values[source->node].v[source->component]);
}

/* Numbers of steps of bodies are above those of all tapes. */
static uint32_t kin_of_instance_step(uint32_t function, size_t step)
{
    static const uint32_t BODIES = 1u << 31, STEPS = 1u << 16;
    return BODIES | (function * STEPS + (uint32_t)step % STEPS) % BODIES;
}

/* Returns the step of a body whose value the least distance of all takes, if it takes the lesser of
   two numbers; else one behind the last. */
static size_t distance_step(const LaneTape *body)
{
    const LaneStep *last = lane_step_of(body, body->outputs[0]);
    for (uint32_t k = 0; last && (last->op == OP_min || last->op == LANE_LESSER) && k < 2; k++) {
        const LaneStep *own = lane_step_of(body, last->operands[k]);
        if (own && own->op != LANE_STATE)
            return (size_t)(own - body->steps);
    }
    return body->count;
}

/* Origins of distances of instances are above those of all tapes; 0: there are too many calls or
   instances to number them. */
static uint32_t origin_of_instance(uint32_t call, uint32_t instance)
{
    static const uint32_t INSTANCES = 1u << 31, ROWS = 1u << 18;
    return call > 0 && call < INSTANCES / ROWS && instance < ROWS
               ? INSTANCES | (call * ROWS + instance)
               : 0;
}

/* Adds the steps of a body for one instance; returns the operand of its state. */
static uint32_t add_instance(Pruning *p, const LaneStep *of, const InstanceTable *table,
                             uint32_t instance, uint32_t state, uint32_t *values)
{
    const LaneCall *call  = &p->from->calls[of->operands[0]];
    const LaneBody *body  = call->body;
    const size_t    least = distance_step(&body->tape);
    for (int k = 0; k < 3; k++)
        values[LANE_POINT + k] = stand_in(p, call->operands[1][k]);
    for (size_t i = 0; i < body->tape.count; i++) {
        LaneStep step = body->tape.steps[i];
        if (step.op == LANE_STATE)
            values[LANE_INPUTS + i] = state;
        else if (step.op == LANE_ROW || step.op == LANE_INSTANCE)
            values[LANE_INPUTS + i] = instance_number(p, table, &step, instance);
        else {
            step.origin   = i == least ? origin_of_instance(of->origin, instance) : 0;
            step.kin      = kin_of_instance_step(body->function, i);
            step.instance = instance + 1;
            for (uint32_t k = 0; k < step.operand_count; k++)
                step.operands[k] = step.operands[k] & LANE_SCALAR
                                       ? body_scalar(p, body, step.operands[k] & ~LANE_SCALAR)
                                       : values[step.operands[k]];
            values[LANE_INPUTS + i] = lane_steps_add(&p->to, step);
        }
    }
    uint32_t output = body->tape.outputs[0];
    return output & LANE_SCALAR ? body_scalar(p, body, output & ~LANE_SCALAR) : values[output];
}

/* Replaces a call by the steps of its instances where few are near; false: it stays a call. */
static bool prune_group(Pruning *p, size_t i)
{
    const LaneStep *step  = &p->from->steps[i];
    Range           range = p->ranges->ranges[LANE_INPUTS + i];
    if (step->op != LANE_CALL || !p->ranges->unroll || !p->ranges->values ||
        p->from->tape->by_cells)
        return false;
    const LaneCall  *call   = &p->from->calls[step->operands[0]];
    const Instances *groups = p->from->tape->graph->instances;
    uint32_t         instances[MAX_LANE_INSTANCES], count;
    if (!call->body || p->from->tape->graph->items[call->node].op != OP_instance_distance ||
        call->body->tape.call_count > 0)
        return false;
    const InstanceFunction *function = &groups->functions.items[call->body->function];
    const InstanceTable    *table    = &groups->tables.items[call->body->table];
    if (!takes_least(function) || !table->bounds || !isfinite(range.high) ||
        !find_min_instances(p, call, table, range.high, instances, &count))
        return false;
    uint32_t  state  = lane_steps_number(&p->to, function->states[0].first[0]);
    uint32_t *values = arena_new_array(p->to.arena, uint32_t, LANE_INPUTS + call->body->tape.count);
    for (uint32_t k = 0; k < count; k++)
        state = add_instance(p, step, table, instances[k], state, values);
    p->same[LANE_INPUTS + i] = state;
    return true;
}

/* Outlines keep the instances that may be the nearest. */
static void prune_instances(Pruning *p, LaneCall *call, size_t step)
{
    uint32_t instances[MAX_LANE_INSTANCES], count;
    if (!lane_outline_instances(p->from, p->ranges, step, instances, &count))
        return;
    uint32_t *kept = arena_new_array(p->to.arena, uint32_t, MAX_LANE_INSTANCES);
    memcpy(kept, instances, count * sizeof *kept);
    call->instances      = kept;
    call->instance_count = count;
}

static void prune_calls(Pruning *p)
{
    for (size_t step = 0; step < p->from->count; step++) {
        if (p->from->steps[step].op != LANE_CALL)
            continue;
        LaneCall call = p->from->calls[p->from->steps[step].operands[0]];
        prune_instances(p, &call, step);
        for (uint32_t k = 0; k < MAX_OPERANDS; k++)
            for (uint32_t c = 0; c < 4; c++)
                call.operands[k][c] = stand_in(p, call.operands[k][c]);
        array_push(p->to.arena, &p->to.calls, call);
    }
}

/* Makes room for everything at once, so that nothing is copied. */
static void reserve(Pruning *p)
{
    Arena *arena           = p->to.arena;
    p->to.steps.capacity   = lane_max_steps(p->from) + 1;
    p->to.steps.items      = arena_new_array(arena, LaneStep, p->to.steps.capacity);
    p->to.sources.capacity = p->from->scalar_count + p->from->count + 2 * p->from->call_count + 1;
    p->to.sources.items    = arena_new_array(arena, LaneScalar, p->to.sources.capacity);
    p->same                = arena_new_array(arena, uint32_t, LANE_INPUTS + p->from->count);
}

LaneTape lane_prune(const LaneTape *tape, const LaneRanges *ranges, size_t outputs, Arena *arena)
{
    Pruning p = {.from = tape, .ranges = ranges, .to = {.arena = arena}};
    assert(outputs <= tape->output_count);
    reserve(&p);
    for (uint32_t i = 0; i < LANE_INPUTS; i++)
        p.same[i] = i;
    for (size_t i = 0; i < tape->scalar_count; i++)
        lane_steps_number(&p.to, tape->scalars[i]);
    for (size_t i = 0; i < tape->count; i++)
        if (prune_rotation(&p, i))
            i += 2;
        else if (!prune_shares(&p, i) && !prune_group(&p, i))
            prune_step(&p, i);
    prune_calls(&p);
    for (size_t i = 0; i < outputs; i++)
        array_push(arena, &p.to.outputs, stand_in(&p, tape->outputs[i]));
    LaneTape pruned   = lane_steps_finish(&p.to, tape->tape);
    pruned.bodies_end = tape->bodies_end;
    pruned.scalars    = arena_new_array(arena, double, pruned.scalar_count + 1);
    for (size_t i = 0; i < pruned.scalar_count; i++)
        pruned.scalars[i] = pruned.sources[i].number;
    return pruned;
}
