/*
 * flatten.c: leaves of a module what its entry point needs, once all calls are inlined.
 *
 * Two passes of SPIRV-Tools do the same instruction by instruction, and keep account of all uses.
 * That takes half as long as glslang and all other passes together.
 */
#include "compiler/target/flatten.h"

#include <stdlib.h>
#include <string.h>

#include <spirv-tools/libspirv.h>

/* From the specification of SPIR-V. */
enum {
    HEADER_WORDS    = 5,
    BOUND           = 3, /* the header's word that is larger than each id */
    OP_NAME         = 5,
    OP_ENTRY_POINT  = 15,
    OP_TYPE_POINTER = 32,
    OP_FUNCTION     = 54,
    OP_FUNCTION_END = 56,
    OP_CALL         = 57,
    OP_VARIABLE     = 59,
    OP_DECORATE     = 71,
    OP_LABEL        = 248,
    CLASS_PRIVATE   = 6, /* storage classes */
    CLASS_FUNCTION  = 7
};

typedef struct Instruction {
    uint32_t opcode, length, result; /* result: the id that it defines; 0: none */
} Instruction;

typedef struct Module {
    uint32_t    *words;
    size_t       count;
    Instruction *instructions;
    size_t       instruction_count;
    bool        *dropped; /* for each id: it is defined in a function that is left out */
    uint32_t    *locals;  /* private globals, as local variables */
    size_t       local_words;
    uint32_t     entry; /* id of the entry point's function */
} Module;

static spv_result_t note(void *user, const spv_parsed_instruction_t *parsed)
{
    Module *module                                    = user;
    module->instructions[module->instruction_count++] = (Instruction){
        .opcode = parsed->opcode, .length = parsed->num_words, .result = parsed->result_id};
    return SPV_SUCCESS;
}

/* Lists the instructions, of which there are no more than words. */
static bool parse(Module *module)
{
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_1);
    bool parsed = context && spvBinaryParse(context, module, module->words, module->count, NULL,
                                            note, NULL) == SPV_SUCCESS;
    spvContextDestroy(context);
    return parsed;
}

/* Finds the entry point, and what other functions define.  Returns whether it calls none of them. */
static bool find_dropped(Module *module)
{
    const uint32_t *at    = module->words + HEADER_WORDS;
    uint32_t        in    = 0; /* the function around */
    bool            calls = false;
    for (size_t i = 0; i < module->instruction_count; i++) {
        const Instruction *instruction = &module->instructions[i];
        if (instruction->opcode == OP_ENTRY_POINT)
            module->entry = at[2];
        in = instruction->opcode == OP_FUNCTION ? instruction->result : in;
        if (in != 0 && in != module->entry && instruction->result != 0)
            module->dropped[instruction->result] = true;
        calls = calls || (in == module->entry && instruction->opcode == OP_CALL);
        in    = instruction->opcode == OP_FUNCTION_END ? 0 : in;
        at += instruction->length;
    }
    return !calls;
}

/* Whether it names or decorates a value that is left out. */
static bool is_about_dropped(const Module *module, const Instruction *instruction,
                             const uint32_t *words)
{
    return (instruction->opcode == OP_NAME || instruction->opcode == OP_DECORATE) &&
           module->dropped[words[1]];
}

/* Keeps the declaration of a private global for the entry point's first block. */
static void make_local(Module *module, const uint32_t *words, size_t length)
{
    uint32_t *local = module->locals + module->local_words;
    memcpy(local, words, length * sizeof *local);
    local[3] = CLASS_FUNCTION;
    module->local_words += length;
}

/* Moves what is kept to the front.  Local variables need the room of the globals that they were, so
   nothing is written where it is still to be read. */
static void keep(Module *module)
{
    const uint32_t *from = module->words + HEADER_WORDS;
    uint32_t       *to   = module->words + HEADER_WORDS;
    uint32_t        in   = 0;
    for (size_t i = 0; i < module->instruction_count; i++) {
        const Instruction *instruction = &module->instructions[i];
        const size_t       length      = instruction->length;
        const uint32_t     opcode      = instruction->opcode;
        in                             = opcode == OP_FUNCTION ? instruction->result : in;
        bool is_local = in == 0 && opcode == OP_VARIABLE && from[3] == CLASS_PRIVATE;
        bool is_kept = in == 0 ? !is_about_dropped(module, instruction, from) : in == module->entry;
        if (is_local) {
            make_local(module, from, length);
        } else if (is_kept) {
            memmove(to, from, length * sizeof *to);
            if (opcode == OP_TYPE_POINTER && to[2] == CLASS_PRIVATE)
                to[2] = CLASS_FUNCTION;
            to += length;
        }
        from += length;
        if (opcode == OP_LABEL && in == module->entry && module->local_words > 0) {
            memcpy(to, module->locals, module->local_words * sizeof *to);
            to += module->local_words;
            module->local_words = 0;
        }
        in = opcode == OP_FUNCTION_END ? 0 : in;
    }
    module->count = (size_t)(to - module->words);
}

bool flatten_module(uint32_t *words, size_t *count)
{
    Module module = {.words = words, .count = *count};
    if (*count < HEADER_WORDS)
        return false;
    module.instructions = malloc(*count * sizeof *module.instructions);
    module.dropped      = calloc(words[BOUND], sizeof *module.dropped);
    module.locals       = malloc(*count * sizeof *module.locals);
    bool ready          = module.instructions && module.dropped && module.locals && parse(&module);
    if (ready && find_dropped(&module))
        keep(&module);
    *count = module.count;
    free(module.instructions);
    free(module.dropped);
    free(module.locals);
    return ready;
}
