/*
 * dominators.c: the tree of dominators, by the method of Cooper, Harvey and Kennedy.
 *
 * Blocks that are reached are numbered in reverse postorder, so that a block has a larger number
 * than its dominators.
 */
#include "compiler/target/dominators.h"

static const uint32_t NO_BLOCK = UINT32_MAX;

typedef struct Flow {
    const ShaderModule *module;
    uint32_t           *of_label; /* for each id: 1 + the block that begins with this label, or 0 */
    size_t             *end;      /* of each block: its last instruction */
    uint32_t            count;    /* blocks */
    uint32_t           *order;    /* blocks that are reached, in reverse postorder */
    uint32_t            reached;
    uint32_t           *number;    /* of each block: its place in that order, or NO_BLOCK */
    uint32_t           *dominator; /* of each number: that of the immediate dominator */
} Flow;

/* Finds the blocks of the body. */
static void find_blocks(Flow *flow, Dominators *dominators)
{
    const Instructions *body = &flow->module->body;
    for (size_t i = 0; i < body->count; i++) {
        if (body->items[i].opcode == SPIRV_LABEL)
            flow->of_label[result_of(&body->items[i])] = ++flow->count;
        dominators->block[i]       = flow->count - 1;
        flow->end[flow->count - 1] = i;
    }
}

/* Returns the number of operands of a branch that may be labels, and the block that such a one
   begins. */
static uint32_t targets(const Flow *flow, uint32_t block)
{
    return flow->module->body.items[flow->end[block]].id_count;
}

static uint32_t target(const Flow *flow, uint32_t block, uint32_t at)
{
    const Instruction *branch = &flow->module->body.items[flow->end[block]];
    return flow->of_label[branch->words[branch->ids[at]]] - 1; /* 0 - 1: NO_BLOCK */
}

/* Numbers the blocks in the reverse of the order in which a depth-first search leaves them. */
static void order_blocks(Flow *flow)
{
    Arena    *arena = flow->module->arena;
    uint32_t *stack = arena_new_array(arena, uint32_t, flow->count);
    uint32_t *next  = arena_new_array(arena, uint32_t, flow->count); /* branch to follow */
    bool     *seen  = arena_new_array(arena, bool, flow->count);
    uint32_t  depth = 0, left = flow->count;
    stack[depth++] = 0;
    seen[0]        = true;
    while (depth > 0) {
        uint32_t block = stack[depth - 1];
        if (next[block] == targets(flow, block)) {
            flow->order[--left] = block;
            depth--;
            continue;
        }
        uint32_t to = target(flow, block, next[block]++);
        if (to != NO_BLOCK && !seen[to]) {
            seen[to]       = true;
            stack[depth++] = to;
        }
    }
    flow->order += left;
    flow->reached = flow->count - left;
    for (uint32_t i = 0; i < flow->count; i++)
        flow->number[i] = NO_BLOCK;
    for (uint32_t i = 0; i < flow->reached; i++)
        flow->number[flow->order[i]] = i;
}

/* Returns the nearest block that dominates both. */
static uint32_t meet(const Flow *flow, uint32_t a, uint32_t b)
{
    while (a != b)
        if (a > b)
            a = flow->dominator[a];
        else
            b = flow->dominator[b];
    return a;
}

/* Follows all branches once.  Returns whether a dominator has changed. */
static bool follow_branches(Flow *flow)
{
    bool changed = false;
    for (uint32_t from = 0; from < flow->reached; from++) {
        uint32_t block = flow->order[from];
        for (uint32_t i = 0; i < targets(flow, block); i++) {
            uint32_t to = target(flow, block, i);
            if (to == NO_BLOCK)
                continue;
            uint32_t *dominator = &flow->dominator[flow->number[to]];
            uint32_t  found     = *dominator == NO_BLOCK ? from : meet(flow, *dominator, from);
            changed             = changed || found != *dominator;
            *dominator          = found;
        }
    }
    return changed;
}

/* Numbers the tree in preorder.  A block comes before all that it dominates. */
static void number_tree(const Flow *flow, Dominators *dominators)
{
    uint32_t *used = arena_new_array(flow->module->arena, uint32_t, flow->reached);
    for (uint32_t i = flow->reached; i-- > 0;) {
        uint32_t *count = &dominators->count[flow->order[i]];
        ++*count;
        if (i > 0)
            dominators->count[flow->order[flow->dominator[i]]] += *count;
    }
    for (uint32_t i = 1; i < flow->reached; i++) {
        uint32_t above = flow->dominator[i], block = flow->order[i];
        dominators->first[block] = dominators->first[flow->order[above]] + 1 + used[above];
        used[above] += dominators->count[block];
    }
}

Dominators dominators_find(const ShaderModule *module)
{
    Arena       *arena      = module->arena;
    const size_t count      = module->body.count;
    Dominators   dominators = {.block = arena_new_array(arena, uint32_t, count)};
    Flow         flow       = {.module   = module,
                               .of_label = arena_new_array(arena, uint32_t, module->bound),
                               .end      = arena_new_array(arena, size_t, count)};
    find_blocks(&flow, &dominators);
    flow.order       = arena_new_array(arena, uint32_t, flow.count);
    flow.number      = arena_new_array(arena, uint32_t, flow.count);
    flow.dominator   = arena_new_array(arena, uint32_t, flow.count);
    dominators.first = arena_new_array(arena, uint32_t, flow.count);
    dominators.count = arena_new_array(arena, uint32_t, flow.count);
    order_blocks(&flow);
    for (uint32_t i = 1; i < flow.reached; i++)
        flow.dominator[i] = NO_BLOCK;
    while (follow_branches(&flow))
        ;
    number_tree(&flow, &dominators);
    return dominators;
}

bool dominators_order(const Dominators *dominators, size_t earlier, size_t later)
{
    uint32_t a = dominators->block[earlier], b = dominators->block[later];
    if (a == b)
        return earlier < later;
    return dominators->count[b] > 0 &&
           dominators->first[b] - dominators->first[a] < dominators->count[a];
}
