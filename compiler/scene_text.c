/*
 * scene_text.c: prints the text of a compiled scene.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/program.h"

size_t krs_promised_functions(const KrsScene *scene, bool many_threads,
                              KrsFunction promised[KRS_MOST_PROMISED])
{
    size_t count      = 0;
    promised[count++] = KRS_FUNCTION_DISTANCE;
    promised[count++] = KRS_FUNCTION_SURFACE;
    if (many_threads)
        promised[count++] = KRS_FUNCTION_DISTANCE_LOD;
    if (scene->program.gradients)
        promised[count++] = KRS_FUNCTION_GRADIENT;
    if (scene->program.sheets)
        promised[count++] = KRS_FUNCTION_ALONG;
    return count;
}

/* A text to be printed, and its memory. */
typedef struct Printing {
    const KrsScene    *scene;
    const KrsVariant  *variant;
    const KrsFunction *wanted;
    size_t             count;
    Memory             memory;
    Arena              arena;
} Printing;

/* A copy in memory of the caller's allocator, or NULL. */
static char *copy_text(const Text *text, const Memory *memory)
{
    size_t bytes = text->length + 1;
    char  *copy  = memory->allocate ? memory->allocate(memory->user, bytes) : malloc(bytes);
    if (copy)
        memcpy(copy, text->bytes, bytes);
    return copy;
}

/* Prints the text; NULL if memory runs out, in which case longjmp returns here. */
static char *print(Printing *printing)
{
    jmp_buf exhausted;
    Text    text               = {.arena = &printing->arena};
    printing->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return NULL;
    module_print(&printing->scene->module, printing->variant, printing->wanted, printing->count,
                 &glsl_printer, &text);
    return copy_text(&text, &printing->memory);
}

char *krs_scene_text(const KrsScene *scene, const KrsVariant *variant, const KrsFunction *wanted,
                     size_t count, const KrsAllocator *allocator)
{
    Printing printing = {.scene = scene, .variant = variant, .wanted = wanted, .count = count};
    if (allocator)
        printing.memory = (Memory){.allocate = allocator->allocate,
                                   .release  = allocator->release,
                                   .user     = allocator->user};
    printing.arena.memory = &printing.memory;
    char *text            = print(&printing);
    arena_free(&printing.arena);
    return text;
}
