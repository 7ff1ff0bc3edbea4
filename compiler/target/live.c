/*
 * live.c: what of a flat module something depends on.
 *
 * What writes to memory and what branches is needed, with all that it uses.  A variable is needed if
 * something that is needed loads it, and then all that is stored in it is, too.
 */
#include "compiler/target/live.h"

typedef struct Marking {
    const ShaderModule *module;
    bool               *live;
    uint32_t           *waiting; /* ids whose operands are still to be marked */
    size_t              waiting_count;
    const Instruction **made_by; /* for each id: the instruction that defines it */
    size_t *last_store;          /* for each variable: 1 + the last store to it or a part of it */
    size_t *store_before;        /* for each instruction: the same of the store before, or 0 */
} Marking;

static bool is_about_another(const Instruction *instruction)
{
    return instruction->opcode == SPIRV_NAME || instruction->opcode == SPIRV_MEMBER_NAME ||
           instruction->opcode == SPIRV_DECORATE || instruction->opcode == SPIRV_MEMBER_DECORATE;
}

static bool is_source_text(const Instruction *instruction)
{
    return instruction->opcode >= SPIRV_SOURCE_CONTINUED &&
           instruction->opcode <= SPIRV_SOURCE_EXTENSION;
}

static bool is_atomic(const Instruction *instruction)
{
    return instruction->opcode >= SPIRV_ATOMIC_FIRST && instruction->opcode <= SPIRV_ATOMIC_LAST;
}

/* Returns the variable of the entry point in which an instruction stores, or 0. */
static uint32_t stored_variable(const ShaderModule *module, const Instruction *instruction)
{
    return instruction->opcode == SPIRV_STORE ? module->root[instruction->words[1]] : 0;
}

static void mark(Marking *marking, uint32_t id)
{
    id = module_resolve(marking->module, id);
    if (!marking->live[id])
        marking->waiting[marking->waiting_count++] = id;
    marking->live[id] = true;
}

static void mark_operands(Marking *marking, const Instruction *instruction)
{
    for (uint16_t i = 0; i < instruction->id_count; i++)
        mark(marking, instruction->words[instruction->ids[i]]);
}

static void list_definitions(Marking *marking, const Instructions *instructions)
{
    for (size_t i = 0; i < instructions->count; i++)
        if (result_of(&instructions->items[i]) != 0)
            marking->made_by[result_of(&instructions->items[i])] = &instructions->items[i];
}

static void list_stores(Marking *marking)
{
    const Instructions *body = &marking->module->body;
    for (size_t i = 0; i < body->count; i++) {
        uint32_t variable = stored_variable(marking->module, &body->items[i]);
        if (variable == 0)
            continue;
        marking->store_before[i]      = marking->last_store[variable];
        marking->last_store[variable] = i + 1;
    }
}

/* Marks what instructions need that are needed themselves, whatever else is. */
static void mark_roots(Marking *marking, const Instructions *instructions)
{
    for (size_t i = 0; i < instructions->count; i++) {
        const Instruction *instruction   = &instructions->items[i];
        bool               is_block_size = instruction->opcode == SPIRV_DECORATE &&
                             instruction->words[2] == DECORATION_BUILTIN;
        if (is_block_size || is_atomic(instruction))
            mark(marking, is_block_size ? instruction->words[1] : result_of(instruction));
        else if (result_of(instruction) == 0 && !is_about_another(instruction) &&
                 stored_variable(marking->module, instruction) == 0)
            mark_operands(marking, instruction);
    }
}

static void mark_waiting(Marking *marking)
{
    const Instructions *body = &marking->module->body;
    while (marking->waiting_count > 0) {
        uint32_t id = marking->waiting[--marking->waiting_count];
        if (marking->made_by[id])
            mark_operands(marking, marking->made_by[id]);
        for (size_t at = marking->last_store[id]; at != 0; at = marking->store_before[at - 1])
            mark_operands(marking, &body->items[at - 1]);
    }
}

bool *find_live(const ShaderModule *module)
{
    Arena  *arena   = module->arena;
    Marking marking = {.module       = module,
                       .live         = arena_new_array(arena, bool, module->bound),
                       .waiting      = arena_new_array(arena, uint32_t, module->bound),
                       .made_by      = arena_new_array(arena, const Instruction *, module->bound),
                       .last_store   = arena_new_array(arena, size_t, module->bound),
                       .store_before = arena_new_array(arena, size_t, module->body.count)};
    list_definitions(&marking, &module->globals);
    list_definitions(&marking, &module->variables);
    list_definitions(&marking, &module->body);
    list_stores(&marking);
    mark_operands(&marking, &module->entry);
    mark_roots(&marking, &module->globals);
    mark_roots(&marking, &module->body);
    mark_waiting(&marking);
    return marking.live;
}

bool is_live(const ShaderModule *module, const bool *live, const Instruction *instruction)
{
    uint32_t variable = stored_variable(module, instruction);
    if (is_source_text(instruction))
        return false;
    if (is_about_another(instruction))
        return live[instruction->words[1]];
    if (variable != 0)
        return live[variable];
    return result_of(instruction) == 0 || instruction->opcode == SPIRV_LABEL ||
           instruction->opcode == SPIRV_IMPORT || live[result_of(instruction)];
}
