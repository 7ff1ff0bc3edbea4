/*
 * forward.c: values of variables where it is known which store they come from.
 *
 * Most variables of a flat function are arguments, results and names of values.  A driver finds
 * their values as well, but does so at every start, among all that it has not looked at yet.
 *
 * Where the last change of a variable, in the order of the module, dominates a load, the load sees
 * it.  If another change could run in between, a way would lead to that one without passing the
 * last, which dominates nothing before it, and from there to the load.
 */
#include "compiler/target/forward.h"

#include <string.h>

#include "compiler/target/dominators.h"

enum { MAX_MEMBERS = 16 }; /* how deep a pointer may reach into a variable */

/* The uses of a variable. */
typedef struct Usage {
    size_t
         change; /* 1 + the last instruction that changes it, in the order of the module; 0: none */
    bool whole;  /* and stores all of it */
    bool other;  /* something else happens to it */
} Usage;

typedef struct Forwarding {
    ShaderModule *module;
    Usage        *usage;    /* for each id of a variable */
    size_t       *chain;    /* for each id: 1 + the access chain of the body that makes it, or 0 */
    uint32_t    **constant; /* for each id: the words of a constant, or NULL */
} Forwarding;

static bool is_chain(const Instruction *instruction)
{
    return instruction->opcode == SPIRV_ACCESS_CHAIN ||
           instruction->opcode == SPIRV_IN_BOUNDS_CHAIN;
}

/* Notes what an instruction does with a pointer, which is its word `at`. */
static void note_use(Forwarding *forwarding, size_t index, uint16_t at)
{
    ShaderModule      *module      = forwarding->module;
    const Instruction *instruction = &module->body.items[index];
    const uint32_t     pointer = instruction->words[at], root = module->root[pointer];
    Usage             *usage = &forwarding->usage[root];
    if (root == 0 || instruction->opcode == SPIRV_LOAD)
        return;
    if (instruction->opcode == SPIRV_STORE && at == 1) {
        usage->change = index + 1;
        usage->whole  = pointer == root;
    } else if (is_chain(instruction) && at == 3) {
        module->root[result_of(instruction)]      = root;
        forwarding->chain[result_of(instruction)] = index + 1;
    } else {
        usage->other = true;
    }
}

static void note_uses(Forwarding *forwarding)
{
    ShaderModule *module = forwarding->module;
    for (size_t i = 0; i < module->variables.count; i++) {
        const Instruction *variable       = &module->variables.items[i];
        module->root[result_of(variable)] = result_of(variable);
    }
    for (size_t i = 0; i < module->globals.count; i++)
        if (module->globals.items[i].opcode == SPIRV_CONSTANT)
            forwarding->constant[result_of(&module->globals.items[i])] =
                module->globals.items[i].words;
    for (size_t i = 0; i < module->body.count; i++)
        for (uint16_t k = 0; k < module->body.items[i].id_count; k++)
            note_use(forwarding, i, module->body.items[i].ids[k]);
}

/* Writes which member of which member of a variable a pointer means, from the last place of an array
   to the front.  Returns how many there are; MAX_MEMBERS: too many, or one that is computed. */
static uint16_t find_members(const Forwarding *forwarding, uint32_t pointer,
                             uint32_t members[MAX_MEMBERS])
{
    const ShaderModule *module = forwarding->module;
    uint16_t            count  = 0;
    while (forwarding->chain[pointer] != 0) {
        const Instruction *chain = &module->body.items[forwarding->chain[pointer] - 1];
        for (uint16_t word = chain->length; word-- > 4;) {
            const uint32_t *constant =
                forwarding->constant[module_resolve(module, chain->words[word])];
            if (!constant || count == MAX_MEMBERS - 1)
                return MAX_MEMBERS;
            members[MAX_MEMBERS - ++count] = constant[3];
        }
        pointer = chain->words[3];
    }
    return count;
}

/* Lets the result of a load be the value that was stored, or a member of it. */
static void forward(Forwarding *forwarding, Instruction *load, uint32_t value)
{
    static const uint16_t ids[]  = {1, 3};
    ShaderModule         *module = forwarding->module;
    uint32_t              members[MAX_MEMBERS], operands[MAX_MEMBERS + 3];
    const uint16_t        count = find_members(forwarding, load->words[3], members);
    if (count == MAX_MEMBERS)
        return;
    if (count == 0) {
        module->same[result_of(load)] = value;
        return;
    }
    memcpy(operands, (uint32_t[]){load->words[1], result_of(load), value}, 3 * sizeof *operands);
    memcpy(operands + 3, members + MAX_MEMBERS - count, count * sizeof *members);
    *load = module_make(module, SPIRV_COMPOSITE_EXTRACT, operands, count + 3, 2, ids, 2);
}

void forward_stores(ShaderModule *module)
{
    Arena     *arena      = module->arena;
    Forwarding forwarding = {.module   = module,
                             .usage    = arena_new_array(arena, Usage, module->bound),
                             .chain    = arena_new_array(arena, size_t, module->bound),
                             .constant = arena_new_array(arena, uint32_t *, module->bound)};
    module->root          = arena_new_array(arena, uint32_t, module->bound);
    note_uses(&forwarding);
    Dominators dominators = dominators_find(module);
    for (size_t i = 0; i < module->body.count; i++) {
        Instruction *load = &module->body.items[i];
        if (load->opcode != SPIRV_LOAD)
            continue;
        const Usage *usage = &forwarding.usage[module->root[load->words[3]]];
        if (usage->whole && !usage->other && dominators_order(&dominators, usage->change - 1, i))
            forward(&forwarding, load, module->body.items[usage->change - 1].words[2]);
    }
}
