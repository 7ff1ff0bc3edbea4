/*
 * instructions.c: takes a module of SPIR-V apart.
 */
#include "compiler/target/instructions.h"

#include <string.h>

#include <spirv-tools/libspirv.h>

/* SPIRV-Tools is C++, which no longjmp may cross: what the parser notes has its room before. */
typedef struct Reading {
    uint32_t     *next; /* words of the next instruction */
    uint16_t     *ids;  /* room for the offsets of ids */
    Instructions *to;
} Reading;

static bool is_id(spv_operand_type_t type)
{
    return type == SPV_OPERAND_TYPE_ID || type == SPV_OPERAND_TYPE_TYPE_ID ||
           type == SPV_OPERAND_TYPE_SCOPE_ID || type == SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID;
}

static spv_result_t note(void *user, const spv_parsed_instruction_t *parsed)
{
    Reading    *reading     = user;
    Instruction instruction = {.words  = reading->next,
                               .ids    = reading->ids,
                               .opcode = parsed->opcode,
                               .length = parsed->num_words};
    for (uint16_t i = 0; i < parsed->num_operands; i++) {
        const spv_parsed_operand_t *operand = &parsed->operands[i];
        if (operand->type == SPV_OPERAND_TYPE_RESULT_ID)
            instruction.result_at = operand->offset;
        else if (is_id(operand->type))
            reading->ids[instruction.id_count++] = operand->offset;
    }
    reading->next += instruction.length;
    reading->ids += instruction.id_count;
    reading->to->items[reading->to->count++] = instruction;
    return SPV_SUCCESS;
}

bool module_read(ShaderModule *module, uint32_t *words, size_t count)
{
    if (count < HEADER_WORDS)
        return false;
    memcpy(module->header, words, sizeof module->header);
    module->bound = words[BOUND_WORD];
    /* There are no more instructions than words, and no more ids. */
    Instructions *all = &module->globals;
    *all              = (Instructions){arena_new_array(module->arena, Instruction, count), 0, 0};
    Reading reading = {words + HEADER_WORDS, arena_new_array(module->arena, uint16_t, count), all};
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_1);
    bool        parsed  = context &&
                  spvBinaryParse(context, &reading, words, count, NULL, note, NULL) == SPV_SUCCESS;
    spvContextDestroy(context);
    size_t first = 0;
    while (first < all->count && all->items[first].opcode != SPIRV_FUNCTION)
        first++;
    module->functions = (Instructions){all->items + first, all->count - first, 0};
    all->count        = first;
    return parsed;
}

uint32_t module_resolve(const ShaderModule *module, uint32_t id)
{
    uint32_t last = id;
    while (module->same[last] != 0)
        last = module->same[last];
    while (module->same[id] != 0) { /* the next search is short */
        uint32_t next    = module->same[id];
        module->same[id] = last;
        id               = next;
    }
    return last;
}

Instruction module_copy(const ShaderModule *module, const Instruction *instruction)
{
    Instruction copy = *instruction;
    copy.words       = arena_new_array(module->arena, uint32_t, copy.length);
    memcpy(copy.words, instruction->words, copy.length * sizeof *copy.words);
    return copy;
}

Instruction module_make(const ShaderModule *module, uint16_t opcode, const uint32_t *operands,
                        uint16_t count, uint16_t result_at, const uint16_t *ids, uint16_t id_count)
{
    Instruction made = {.words     = arena_new_array(module->arena, uint32_t, count + 1u),
                        .ids       = ids,
                        .opcode    = opcode,
                        .length    = (uint16_t)(count + 1u),
                        .id_count  = id_count,
                        .result_at = result_at};
    made.words[0]    = (uint32_t)(count + 1u) << 16 | opcode;
    memcpy(made.words + 1, operands, count * sizeof *operands);
    return made;
}
