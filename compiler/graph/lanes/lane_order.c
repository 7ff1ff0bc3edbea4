/*
 * lane_order.c: steps that do the same follow each other.
 *
 * Rays run many short tapes, each a few times.  Processors guess which operation comes next, and a wrong guess takes as
 * long as ten steps.
 */
#include "compiler/graph/lanes/lane_rows.h"

#include "compiler/base/vec.h"

enum { KINDS = LANE_NUMBER + 1 };

/* Steps that can come next are in a queue for each operation. */
typedef struct Ordering {
    LaneSteps *of;
    size_t     count;
    uint32_t  *waits;                          /* for so many operands */
    uint32_t  *first_user, *users, *next_user; /* of each step: a list of pairs */
    uint32_t   user_count;
    uint32_t  *next_ready, head[KINDS], tail[KINDS],
        ready[KINDS]; /* numbers, one more each; 0: none */
    uint32_t *place;  /* where each step goes */
    uint32_t  placed;
} Ordering;

static bool is_step(uint32_t operand)
{
    return operand != NODE_NONE && !(operand & LANE_SCALAR) && operand >= LANE_INPUTS;
}

static void add_use(Ordering *o, uint32_t operand, uint32_t user)
{
    if (!is_step(operand))
        return;
    const uint32_t used         = operand - LANE_INPUTS;
    o->users[o->user_count]     = user;
    o->next_user[o->user_count] = o->first_user[used];
    o->first_user[used]         = ++o->user_count;
    o->waits[user]++;
}

static void add_uses(Ordering *o, uint32_t user)
{
    const LaneStep *step = &o->of->steps.items[user];
    if (step->op != LANE_CALL) {
        for (uint32_t k = 0; k < step->operand_count; k++)
            add_use(o, step->operands[k], user);
        return;
    }
    const LaneCall *call = &o->of->calls.items[step->operands[0]];
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4; c++)
            add_use(o, call->operands[k][c], user);
}

static void add_ready(Ordering *o, uint32_t step)
{
    const uint16_t op = o->of->steps.items[step].op;
    if (op == LANE_PART) /* it follows its call */
        return;
    o->next_ready[step] = 0;
    if (o->ready[op]++ == 0)
        o->head[op] = step + 1;
    else
        o->next_ready[o->tail[op]] = step + 1;
    o->tail[op] = step;
}

static void put(Ordering *o, uint32_t step)
{
    o->place[step] = o->placed++;
    for (uint32_t use = o->first_user[step]; use > 0; use = o->next_user[use - 1])
        if (--o->waits[o->users[use - 1]] == 0)
            add_ready(o, o->users[use - 1]);
}

/* Goes on with the operation that most steps wait for. */
static uint32_t longest_queue(const Ordering *o)
{
    uint32_t longest = 0;
    for (uint32_t op = 1; op < KINDS; op++)
        longest = o->ready[op] > o->ready[longest] ? op : longest;
    return longest;
}

static void find_places(Ordering *o)
{
    for (uint32_t i = 0; i < o->count; i++)
        add_uses(o, i);
    for (uint32_t i = 0; i < o->count; i++)
        if (o->waits[i] == 0)
            add_ready(o, i);
    for (uint32_t op = 0; o->placed < o->count;) {
        op                  = o->ready[op] > 0 ? op : longest_queue(o);
        const uint32_t step = o->head[op] - 1;
        o->head[op]         = o->next_ready[step];
        o->ready[op]--;
        put(o, step);
        for (uint32_t part = step + 1;
             op == LANE_CALL && part < o->count && o->of->steps.items[part].op == LANE_PART; part++)
            put(o, part);
    }
}

static void move_operand(const Ordering *o, uint32_t *operand)
{
    if (is_step(*operand))
        *operand = LANE_INPUTS + o->place[*operand - LANE_INPUTS];
}

/* Calls have the order of their steps. */
static void move_calls(const Ordering *o)
{
    LaneSteps *steps = o->of;
    LaneCall  *moved = arena_new_array(steps->arena, LaneCall, steps->calls.count + 1);
    uint32_t   count = 0;
    for (size_t i = 0; i < o->count; i++) {
        LaneStep *step = &steps->steps.items[i];
        if (step->op != LANE_CALL)
            continue;
        moved[count]      = steps->calls.items[step->operands[0]];
        step->operands[0] = count;
        for (uint32_t k = 0; k < MAX_OPERANDS; k++)
            for (uint32_t c = 0; c < 4; c++)
                move_operand(o, &moved[count].operands[k][c]);
        count++;
    }
    steps->calls.items    = moved;
    steps->calls.capacity = steps->calls.count = count;
}

static void move_all(const Ordering *o)
{
    LaneSteps *steps = o->of;
    LaneStep  *moved = arena_new_array(steps->arena, LaneStep, o->count);
    for (size_t i = 0; i < o->count; i++) {
        LaneStep step = steps->steps.items[i];
        for (uint32_t k = 0; step.op != LANE_CALL && k < step.operand_count; k++)
            move_operand(o, &step.operands[k]);
        moved[o->place[i]] = step;
    }
    steps->steps.items    = moved;
    steps->steps.capacity = o->count;
    move_calls(o);
    for (size_t i = 0; i < steps->outputs.count; i++)
        move_operand(o, &steps->outputs.items[i]);
}

void lane_steps_order(LaneSteps *steps)
{
    const size_t count = steps->steps.count,
                 uses  = MAX_OPERANDS * (count + 4 * steps->calls.count) + 1;
    Arena   *arena     = steps->arena;
    Ordering o         = {.of         = steps,
                          .count      = count,
                          .waits      = arena_new_array(arena, uint32_t, count + 1),
                          .first_user = arena_new_array(arena, uint32_t, count + 1),
                          .users      = arena_new_array(arena, uint32_t, uses),
                          .next_user  = arena_new_array(arena, uint32_t, uses),
                          .next_ready = arena_new_array(arena, uint32_t, count + 1),
                          .place      = arena_new_array(arena, uint32_t, count + 1)};
    if (count == 0)
        return;
    find_places(&o);
    move_all(&o);
}
