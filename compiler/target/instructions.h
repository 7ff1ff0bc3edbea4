/*
 * instructions.h: a module of SPIR-V as lists of instructions, for the passes that flatten it.
 */
#ifndef KRS_INSTRUCTIONS_H
#define KRS_INSTRUCTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "compiler/base/arena.h"

/* Numbers of the specification of SPIR-V. */
enum {
    HEADER_WORDS             = 5,
    BOUND_WORD               = 3, /* of the header: ids are below it */
    SPIRV_SOURCE_CONTINUED   = 2,
    SPIRV_SOURCE             = 3,
    SPIRV_SOURCE_EXTENSION   = 4,
    SPIRV_NAME               = 5,
    SPIRV_MEMBER_NAME        = 6,
    SPIRV_EXTENSION          = 10,
    SPIRV_IMPORT             = 11,
    SPIRV_MEMORY_MODEL       = 14,
    SPIRV_ENTRY_POINT        = 15,
    SPIRV_EXECUTION_MODE     = 16,
    SPIRV_CAPABILITY         = 17,
    SPIRV_TYPE_POINTER       = 32,
    SPIRV_CONSTANT           = 43,
    SPIRV_FUNCTION           = 54,
    SPIRV_PARAMETER          = 55,
    SPIRV_FUNCTION_END       = 56,
    SPIRV_CALL               = 57,
    SPIRV_VARIABLE           = 59,
    SPIRV_LOAD               = 61,
    SPIRV_STORE              = 62,
    SPIRV_ACCESS_CHAIN       = 65,
    SPIRV_IN_BOUNDS_CHAIN    = 66,
    SPIRV_DECORATE           = 71,
    SPIRV_MEMBER_DECORATE    = 72,
    SPIRV_COMPOSITE_EXTRACT  = 81,
    SPIRV_ATOMIC_FIRST       = 227,
    SPIRV_ATOMIC_LAST        = 242,
    SPIRV_PHI                = 245,
    SPIRV_LOOP_MERGE         = 246,
    SPIRV_SELECTION_MERGE    = 247,
    SPIRV_LABEL              = 248,
    SPIRV_BRANCH             = 249,
    SPIRV_BRANCH_CONDITIONAL = 250,
    SPIRV_SWITCH             = 251,
    SPIRV_RETURN             = 253,
    SPIRV_RETURN_VALUE       = 254,
    SPIRV_UNREACHABLE        = 255,
    CLASS_PRIVATE            = 6, /* storage classes */
    CLASS_FUNCTION           = 7,
    DECORATION_BUILTIN       = 11
};

typedef struct Instruction {
    uint32_t       *words;
    const uint16_t *ids; /* which words are ids that it uses, that of its type included */
    uint16_t        opcode, length, id_count, result_at; /* result_at: the word; 0: no result */
} Instruction;

typedef struct Instructions {
    Instruction *items;
    size_t       count, capacity;
} Instructions;

typedef struct ShaderModule {
    Arena       *arena;
    uint32_t     header[HEADER_WORDS], bound;
    Instructions globals;     /* all in front of the first function */
    Instructions functions;   /* as read */
    Instructions decorations; /* of values of the entry point that are copies */
    Instructions variables;   /* those of the entry point, once it is flat */
    Instructions body;        /* its other instructions, from the first block's label to the end */
    Instruction  entry;       /* its OpFunction */
    uint32_t    *same;        /* for each id: the id that it stands for, or 0; once it is flat */
    uint32_t    *root; /* for each id: the variable of the entry point to which it points, or 0 */
} ShaderModule;

/* Returns the id that an instruction defines; 0: none. */
static inline uint32_t result_of(const Instruction *instruction)
{
    return instruction->result_at ? instruction->words[instruction->result_at] : 0;
}

/* Takes a module apart.  The words must live as long, and may be changed.  Returns false if they are
   no SPIR-V. */
bool module_read(ShaderModule *module, uint32_t *words, size_t count);
/* Returns the id that an id stands for. */
uint32_t module_resolve(const ShaderModule *module, uint32_t id);
/* Copies an instruction, with words of its own. */
Instruction module_copy(const ShaderModule *module, const Instruction *instruction);
/* Makes a new instruction of these words.  Word `result_at` is its result; those listed are ids. */
Instruction module_make(const ShaderModule *module, uint16_t opcode, const uint32_t *operands,
                        uint16_t count, uint16_t result_at, const uint16_t *ids, uint16_t id_count);

#endif
