/*
 * inline.c: copies the bodies of functions to where they are called.
 *
 * Each copy has ids of its own.  Where a body has several blocks, the block with the call ends in
 * the body's last one, so phis behind it name that one.
 */
#include "compiler/target/inline.h"

#include <string.h>

/* The body may grow exponentially in the depth of calls.  Beyond this the driver had better see the
   functions. */
static const size_t MAX_INSTRUCTIONS = 1 << 22;

typedef struct Pair {
    uint32_t id, other;
} Pair;
typedef struct Pairs {
    Pair  *items;
    size_t count, capacity;
} Pairs;

typedef struct Inliner {
    ShaderModule *module;
    uint32_t     *copy_of; /* for each id of the function that is copied: that of the copy, or 0 */
    size_t       *function_at; /* for each function: its index behind its OpFunction; 0: none */
    bool         *active;      /* for each function: it is being copied */
    size_t       *decorated;   /* for each id: the index behind the last global that decorates it */
    size_t       *before;      /* for each global: that of the decoration before, or 0 */
    Pairs         ends;        /* blocks, and the labels of those in which they end now */
    Pairs         values;      /* of calls, and what their functions return */
    uint32_t      label;       /* of the block that is being made */
    bool          refused;
} Inliner;

static void index_module(Inliner *inliner)
{
    ShaderModule *module = inliner->module;
    inliner->copy_of     = arena_new_array(module->arena, uint32_t, module->bound);
    inliner->function_at = arena_new_array(module->arena, size_t, module->bound);
    inliner->active      = arena_new_array(module->arena, bool, module->bound);
    inliner->decorated   = arena_new_array(module->arena, size_t, module->bound);
    inliner->before      = arena_new_array(module->arena, size_t, module->globals.count + 1);
    for (size_t i = 0; i < module->functions.count; i++)
        if (module->functions.items[i].opcode == SPIRV_FUNCTION)
            inliner->function_at[result_of(&module->functions.items[i])] = i + 1;
    for (size_t i = 0; i < module->globals.count; i++) {
        const Instruction *global = &module->globals.items[i];
        if (global->opcode != SPIRV_DECORATE)
            continue;
        inliner->before[i]                   = inliner->decorated[global->words[1]];
        inliner->decorated[global->words[1]] = i + 1;
    }
}

static uint32_t copied(const Inliner *inliner, uint32_t id)
{
    return inliner->copy_of[id] ? inliner->copy_of[id] : id;
}

/* Copies an instruction, with the ids of the copy that is being made. */
static Instruction copy_of(const Inliner *inliner, const Instruction *instruction)
{
    Instruction copy = module_copy(inliner->module, instruction);
    if (copy.result_at)
        copy.words[copy.result_at] = copied(inliner, copy.words[copy.result_at]);
    for (uint16_t i = 0; i < copy.id_count; i++)
        copy.words[copy.ids[i]] = copied(inliner, copy.words[copy.ids[i]]);
    return copy;
}

static void emit(Inliner *inliner, Instruction instruction)
{
    array_push_large(inliner->module->arena, &inliner->module->body, instruction);
}

/* Gives the copy of a value the decorations of the value. */
static void decorate_copy(Inliner *inliner, uint32_t value, uint32_t copy)
{
    ShaderModule *module = inliner->module;
    for (size_t at = inliner->decorated[value]; at != 0; at = inliner->before[at - 1]) {
        Instruction decoration = module_copy(module, &module->globals.items[at - 1]);
        decoration.words[1]    = copy;
        array_push(module->arena, &module->decorations, decoration);
    }
}

/* Chooses new ids for all that a function defines. */
static void name_copies(Inliner *inliner, const Instruction *from)
{
    for (; from->opcode != SPIRV_FUNCTION_END; from++) {
        uint32_t result = result_of(from);
        if (result == 0 || from->opcode == SPIRV_PARAMETER)
            continue;
        inliner->copy_of[result] = inliner->module->bound++;
        decorate_copy(inliner, result, inliner->copy_of[result]);
    }
}

static void copy_function(Inliner *inliner, size_t at, const Instruction *call);

static void copy_call(Inliner *inliner, const Instruction *call)
{
    const uint32_t function = call->words[3];
    const size_t   at       = inliner->function_at[function];
    if (at == 0 || inliner->active[function]) {
        inliner->refused = true;
        return;
    }
    inliner->active[function] = true;
    copy_function(inliner, at, call);
    inliner->active[function] = false;
}

/* Copies a variable of a function to those of the entry point.  Those that begin with a value, as whether
   the function has returned, begin with it at each call. */
static void copy_variable(Inliner *inliner, const Instruction *variable, bool called)
{
    static const uint16_t ids[]  = {1, 2};
    ShaderModule         *module = inliner->module;
    Instruction           copy   = copy_of(inliner, variable);
    if (called && copy.length > 4) {
        const uint32_t operands[] = {copy.words[2], copy.words[4]};
        emit(inliner, module_make(module, SPIRV_STORE, operands, 2, 0, ids, 2));
        copy.length = 4;
        copy.id_count--;
        copy.words[0] = 4u << 16 | SPIRV_VARIABLE;
    }
    array_push_large(module->arena, &module->variables, copy);
}

/* Copies a return: the value of a call is what the function returns. */
static void copy_return(Inliner *inliner, const Instruction *from, const Instruction *call)
{
    inliner->refused = inliner->refused || from[1].opcode != SPIRV_FUNCTION_END;
    if (!call)
        emit(inliner, copy_of(inliner, from));
    else if (from->opcode == SPIRV_RETURN_VALUE)
        array_push_large(
            inliner->module->arena, &inliner->values,
            ((Pair){copied(inliner, result_of(call)), copied(inliner, from->words[1])}));
}

/* Copies the label of a block, unless it is the first of a function that is called: that goes on
   with the block of the call. */
static void copy_label(Inliner *inliner, const Instruction *from, bool first)
{
    if (first)
        return;
    emit(inliner, copy_of(inliner, from));
    inliner->label = copied(inliner, result_of(from));
}

static bool is_branch(const Instruction *instruction)
{
    return instruction->opcode >= SPIRV_BRANCH && instruction->opcode <= SPIRV_SWITCH;
}

/* Copies an instruction of a block, and of a function that is called, or NULL. */
static void copy_instruction(Inliner *inliner, const Instruction *from, const Instruction *call,
                             uint32_t block)
{
    switch (from->opcode) {
    case SPIRV_CALL: copy_call(inliner, from); return;
    case SPIRV_VARIABLE: copy_variable(inliner, from, call != NULL); return;
    case SPIRV_RETURN:
    case SPIRV_RETURN_VALUE: copy_return(inliner, from, call); return;
    case SPIRV_LOOP_MERGE: /* loops go back to this block, which must still be whole */
        inliner->refused = inliner->refused || inliner->label != block;
        break;
    default: break;
    }
    emit(inliner, copy_of(inliner, from));
    if (is_branch(from) && inliner->label != block)
        array_push_large(inliner->module->arena, &inliner->ends, ((Pair){block, inliner->label}));
}

/* Copies the function whose first instruction behind its OpFunction is `at`, for a call or, NULL, as
   the entry point. */
static void copy_function(Inliner *inliner, size_t at, const Instruction *call)
{
    const Instruction *from  = &inliner->module->functions.items[at];
    uint32_t           block = 0;
    if (call)
        name_copies(inliner, from);
    for (uint16_t word = 4; from->opcode == SPIRV_PARAMETER; from++, word++)
        inliner->copy_of[result_of(from)] = copied(inliner, call->words[word]);
    for (; from->opcode != SPIRV_FUNCTION_END && !inliner->refused; from++) {
        if (from->opcode == SPIRV_LABEL) {
            copy_label(inliner, from, call && block == 0);
            block = copied(inliner, result_of(from));
        } else {
            copy_instruction(inliner, from, call, block);
        }
    }
    uint16_t last    = from[-1].opcode;
    inliner->refused = inliner->refused || (last != SPIRV_RETURN && last != SPIRV_RETURN_VALUE) ||
                       inliner->module->body.count > MAX_INSTRUCTIONS;
}

/* ---- afterwards ---- */

/* Lets phis name the blocks in which their values come now. */
static void correct_phis(Inliner *inliner)
{
    ShaderModule *module = inliner->module;
    uint32_t     *ends   = arena_new_array(module->arena, uint32_t, module->bound);
    for (size_t i = 0; i < inliner->ends.count; i++)
        ends[inliner->ends.items[i].id] = inliner->ends.items[i].other;
    for (size_t i = 0; i < module->body.count; i++) {
        const Instruction *phi = &module->body.items[i];
        for (uint16_t word = 4; phi->opcode == SPIRV_PHI && word < phi->length; word += 2)
            if (ends[phi->words[word]])
                phi->words[word] = ends[phi->words[word]];
    }
}

static void note_values(Inliner *inliner)
{
    ShaderModule *module = inliner->module;
    module->same         = arena_new_array(module->arena, uint32_t, module->bound);
    for (size_t i = 0; i < inliner->values.count; i++)
        module->same[inliner->values.items[i].id] = inliner->values.items[i].other;
}

/* Turns private globals into variables of the only function that there is. */
static void move_private_globals(ShaderModule *module)
{
    size_t kept = 0;
    for (size_t i = 0; i < module->globals.count; i++) {
        Instruction global = module->globals.items[i];
        uint32_t *class    = global.opcode == SPIRV_VARIABLE       ? &global.words[3]
                             : global.opcode == SPIRV_TYPE_POINTER ? &global.words[2]
                                                                   : NULL;
        bool is_private    = class && *class == CLASS_PRIVATE;
        if (is_private)
            *class = CLASS_FUNCTION;
        if (is_private && global.opcode == SPIRV_VARIABLE)
            array_push_large(module->arena, &module->variables, global);
        else
            module->globals.items[kept++] = global;
    }
    module->globals.count = kept;
}

/* Returns the function of the entry point: its index behind its OpFunction; 0: there is none. */
static size_t find_entry(const Inliner *inliner)
{
    const ShaderModule *module = inliner->module;
    for (size_t i = 0; i < module->globals.count; i++)
        if (module->globals.items[i].opcode == SPIRV_ENTRY_POINT)
            return inliner->function_at[module->globals.items[i].words[2]];
    return 0;
}

bool inline_functions(ShaderModule *module)
{
    Inliner inliner = {.module = module};
    index_module(&inliner);
    size_t entry = find_entry(&inliner);
    if (entry == 0)
        return false;
    module->entry = module->functions.items[entry - 1];
    copy_function(&inliner, entry, NULL);
    if (inliner.refused)
        return false;
    correct_phis(&inliner);
    note_values(&inliner);
    move_private_globals(module);
    return true;
}
