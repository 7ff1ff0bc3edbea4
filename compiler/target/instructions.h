/*
 * instructions.h: a module of SPIR-V as lists of instructions, for the passes that flatten it.
 */
#ifndef KRS_INSTRUCTIONS_H
#define KRS_INSTRUCTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "compiler/base/arena.h"

/* From the specification of SPIR-V. */
enum {
    HEADER_WORDS          = 5,
    BOUND_WORD            = 3, /* of the header: ids are below it */
    OP_SOURCE_CONTINUED   = 2,
    OP_SOURCE             = 3,
    OP_SOURCE_EXTENSION   = 4,
    OP_NAME               = 5,
    OP_MEMBER_NAME        = 6,
    OP_EXTENSION          = 10,
    OP_IMPORT             = 11,
    OP_MEMORY_MODEL       = 14,
    OP_ENTRY_POINT        = 15,
    OP_EXECUTION_MODE     = 16,
    OP_CAPABILITY         = 17,
    OP_TYPE_POINTER       = 32,
    OP_CONSTANT           = 43,
    OP_FUNCTION           = 54,
    OP_PARAMETER          = 55,
    OP_FUNCTION_END       = 56,
    OP_CALL               = 57,
    OP_VARIABLE           = 59,
    OP_LOAD               = 61,
    OP_STORE              = 62,
    OP_ACCESS_CHAIN       = 65,
    OP_IN_BOUNDS_CHAIN    = 66,
    OP_DECORATE           = 71,
    OP_MEMBER_DECORATE    = 72,
    OP_COMPOSITE_EXTRACT  = 81,
    OP_ATOMIC_FIRST       = 227,
    OP_ATOMIC_LAST        = 242,
    OP_PHI                = 245,
    OP_LOOP_MERGE         = 246,
    OP_SELECTION_MERGE    = 247,
    OP_LABEL              = 248,
    OP_BRANCH             = 249,
    OP_BRANCH_CONDITIONAL = 250,
    OP_SWITCH             = 251,
    OP_RETURN             = 253,
    OP_RETURN_VALUE       = 254,
    OP_UNREACHABLE        = 255,
    CLASS_PRIVATE         = 6, /* storage classes */
    CLASS_FUNCTION        = 7,
    DECORATION_BUILTIN    = 11
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

/* The id that an instruction defines; 0: none. */
static inline uint32_t result_of(const Instruction *instruction)
{
    return instruction->result_at ? instruction->words[instruction->result_at] : 0;
}

/* Takes a module apart.  The words must live as long, and may be changed.  Returns false if they are
   no SPIR-V. */
bool module_read(ShaderModule *module, uint32_t *words, size_t count);
/* The id that an id stands for. */
uint32_t module_resolve(const ShaderModule *module, uint32_t id);
/* Copies an instruction, with words of its own. */
Instruction module_copy(const ShaderModule *module, const Instruction *instruction);
/* A new instruction of these words.  Word `result_at` is its result; those listed are ids. */
Instruction module_make(const ShaderModule *module, uint16_t opcode, const uint32_t *operands,
                        uint16_t count, uint16_t result_at, const uint16_t *ids, uint16_t id_count);

#endif
