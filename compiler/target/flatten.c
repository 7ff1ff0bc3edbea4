/*
 * flatten.c: makes one function of a module, by passes that take time in proportion to its size.
 *
 * Passes of SPIRV-Tools do the same instruction by instruction, and keep account of all uses.  They
 * take several times as long as glslang, and grow faster than the module.
 */
#include "compiler/target/flatten.h"

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/target/forward.h"
#include "compiler/target/inline.h"
#include "compiler/target/live.h"

/* Writes what is needed, with ids that have no gaps: drivers keep room for each id below the
   bound. */
typedef struct Writing {
    const ShaderModule *module;
    const bool         *live;
    uint32_t           *number; /* for each id: the new one, or 0 */
    uint32_t            bound;
    uint32_t           *words; /* NULL: they are counted alone */
    size_t              count;
} Writing;

static uint32_t number_of(Writing *writing, uint32_t id)
{
    id = module_resolve(writing->module, id);
    if (writing->number[id] == 0)
        writing->number[id] = writing->bound++;
    return writing->number[id];
}

static void write(Writing *writing, const Instruction *instruction)
{
    uint32_t *to = writing->words ? writing->words + writing->count : NULL;
    if (!is_live(writing->module, writing->live, instruction))
        return;
    writing->count += instruction->length;
    if (!to)
        return;
    memcpy(to, instruction->words, instruction->length * sizeof *to);
    if (instruction->result_at)
        to[instruction->result_at] = number_of(writing, to[instruction->result_at]);
    for (uint16_t i = 0; i < instruction->id_count; i++)
        to[instruction->ids[i]] = number_of(writing, to[instruction->ids[i]]);
}

static void write_all(Writing *writing, const Instructions *instructions)
{
    for (size_t i = 0; i < instructions->count; i++)
        write(writing, &instructions->items[i]);
}

/* Writes what stands in front of the functions; decorations of copies come with those of what they were copied
   from. */
static void write_globals(Writing *writing)
{
    const Instructions *globals   = &writing->module->globals;
    bool                decorated = false;
    for (size_t i = 0; i < globals->count; i++) {
        if (globals->items[i].opcode == SPIRV_DECORATE && !decorated) {
            write_all(writing, &writing->module->decorations);
            decorated = true;
        }
        write(writing, &globals->items[i]);
    }
}

static void write_module(Writing *writing)
{
    uint32_t            end_words[] = {1u << 16 | SPIRV_FUNCTION_END};
    const Instruction   end    = {.words = end_words, .opcode = SPIRV_FUNCTION_END, .length = 1};
    const ShaderModule *module = writing->module;
    writing->count             = HEADER_WORDS;
    write_globals(writing);
    write(writing, &module->entry);
    write(writing, &module->body.items[0]); /* the label */
    write_all(writing, &module->variables);
    write_all(writing, &(Instructions){module->body.items + 1, module->body.count - 1, 0});
    write(writing, &end);
    if (!writing->words)
        return;
    memcpy(writing->words, module->header, sizeof module->header);
    writing->words[BOUND_WORD] = writing->bound;
}

/* Writes the module to memory that is malloc'ed, or NULL. */
static uint32_t *make_words(ShaderModule *module, size_t *count)
{
    Writing writing = {.module = module,
                       .live   = find_live(module),
                       .number = arena_new_array(module->arena, uint32_t, module->bound),
                       .bound  = 1};
    write_module(&writing);
    writing.words = malloc(writing.count * sizeof *writing.words);
    if (writing.words)
        write_module(&writing);
    *count = writing.count;
    return writing.words;
}

Flattening flatten_module(uint32_t *words, size_t count, uint32_t **made, size_t *made_count)
{
    jmp_buf             exhausted;
    Memory              memory = {.exhausted = &exhausted};
    Arena               arena  = {.memory = &memory};
    ShaderModule        module = {.arena = &arena};
    volatile Flattening result = FLATTEN_NO_MEMORY;
    if (setjmp(exhausted) == 0) {
        result = FLATTEN_REFUSED;
        if (module_read(&module, words, count) && inline_functions(&module)) {
            forward_stores(&module);
            *made  = make_words(&module, made_count);
            result = *made ? FLATTEN_OK : FLATTEN_NO_MEMORY;
        }
    } else {
        result = FLATTEN_NO_MEMORY;
    }
    arena_free(&arena);
    return result;
}
