/*
 * scene_text.c: prints the text of a compiled scene: what is wanted of it, or all of it.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/scene/program.h"

size_t krs_entry_points(const KrsScene *scene, bool many_threads,
                        KrsFunction entry_points[KRS_MAX_ENTRY_POINTS])
{
    size_t count          = 0;
    entry_points[count++] = KRS_FUNCTION_DISTANCE;
    entry_points[count++] = KRS_FUNCTION_SURFACE;
    if (many_threads)
        entry_points[count++] = KRS_FUNCTION_DISTANCE_LOD;
    if (scene->program.gradients)
        entry_points[count++] = KRS_FUNCTION_GRADIENT;
    if (scene->program.open_surfaces)
        entry_points[count++] = KRS_FUNCTION_ALONG;
    return count;
}

/* ---- all functions ---- */

/* Finds all functions that a scene has in a variant. */
static size_t known_functions(const KrsScene *scene, const KrsVariant *variant,
                              KrsFunction wanted[KRS_FUNCTION_COUNT])
{
    const KrsProgram *program = &scene->program;
    size_t            count   = 0;
    wanted[count++]           = KRS_FUNCTION_DISTANCE;
    wanted[count++]           = KRS_FUNCTION_SURFACE;
    wanted[count++]           = KRS_FUNCTION_SCENE_PART_DISTANCE;
    wanted[count++]           = KRS_FUNCTION_SCENE_PART_BOX;
    if (program->planes) {
        wanted[count++] = KRS_FUNCTION_PLANE_T;
        wanted[count++] = KRS_FUNCTION_PLANE_COSINE;
    }
    if (variant->many_threads)
        wanted[count++] = KRS_FUNCTION_DISTANCE_LOD;
    if (program->gradients && !variant->camera_relative)
        wanted[count++] = KRS_FUNCTION_GRADIENT;
    if (program->along && !variant->camera_relative)
        wanted[count++] = KRS_FUNCTION_ALONG;
    if (scene->volume_count > 0) {
        wanted[count++] = KRS_FUNCTION_DENSITY;
        wanted[count++] = KRS_FUNCTION_ALBEDO;
        wanted[count++] = KRS_FUNCTION_ANISOTROPY;
        wanted[count++] = KRS_FUNCTION_EMISSION;
    }
    return count;
}

/* Takes out comments, which name lines of the scene. */
static void strip_comments(char *text)
{
    char *to = text;
    for (const char *from = text; *from;) {
        if (from[0] == '/' && from[1] == '/')
            from += strcspn(from, "\n");
        else
            *to++ = *from++;
    }
    *to = '\0';
}

char *scene_plain_text(const KrsScene *scene, const KrsVariant *variant, Arena *arena)
{
    KrsFunction wanted[KRS_FUNCTION_COUNT];
    size_t      count = known_functions(scene, variant, wanted);
    Text        text  = {.arena = arena};
    module_print(&scene->module, variant, wanted, count, &glsl_printer, &text);
    strip_comments(text.bytes);
    return text.bytes;
}

const Printer *const printers[] = {
#define KRS_TARGET(id, name, about) [KRS_TARGET_##id] = &name##_printer,
#include "krs/targets.def"
};

/* ---- in the caller's memory ---- */

/* A text to be printed, and its memory. */
typedef struct Printing {
    const KrsScene    *scene;
    const Printer     *printer;
    const KrsVariant  *variant;
    const KrsFunction *wanted; /* NULL: all functions, without comments */
    size_t             count;
    Memory             memory;
    Arena              arena;
} Printing;

/* Returns a copy in memory of the caller's allocator, or NULL. */
static char *copy_text(const char *text, const Memory *memory)
{
    size_t bytes = strlen(text) + 1;
    char  *copy  = memory->allocate ? memory->allocate(memory->user, bytes) : malloc(bytes);
    if (copy)
        memcpy(copy, text, bytes);
    return copy;
}

static const char *print_wanted(Printing *printing)
{
    Text text = {.arena = &printing->arena};
    module_print(&printing->scene->module, printing->variant, printing->wanted, printing->count,
                 printing->printer, &text);
    return text.bytes;
}

/* Prints the text; NULL if memory runs out, in which case longjmp returns here. */
static char *print_guarded(Printing *printing)
{
    jmp_buf exhausted;
    printing->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return NULL;
    const char *text = printing->wanted
                           ? print_wanted(printing)
                           : scene_plain_text(printing->scene, printing->variant, &printing->arena);
    return copy_text(text, &printing->memory);
}

static char *print(Printing *printing, const KrsAllocator *allocator)
{
    if (allocator)
        printing->memory = (Memory){.allocate = allocator->allocate,
                                    .release  = allocator->release,
                                    .user     = allocator->user};
    printing->arena.memory = &printing->memory;
    char *text             = print_guarded(printing);
    arena_free(&printing->arena);
    return text;
}

char *krs_scene_text(const KrsScene *scene, const KrsVariant *variant, const KrsFunction *wanted,
                     size_t count, const KrsAllocator *allocator)
{
    return print(&(Printing){scene, &glsl_printer, variant, wanted, count, {0}, {0}}, allocator);
}

KrsStatus krs_text(const KrsScene *scene, KrsTarget target, const KrsTextOptions *options,
                   char **text)
{
    const KrsTextOptions how     = options ? *options : (KrsTextOptions){0};
    const KrsVariant     variant = {
            .many_threads = !how.no_early_outs, .values = how.state_values, .shares = true};
    KrsFunction  wanted[KRS_MAX_ENTRY_POINTS];
    const size_t count = krs_entry_points(scene, variant.many_threads, wanted);
    *text              = NULL;
    if ((unsigned)target >= KRS_TARGET_COUNT)
        return KRS_BAD_ARGUMENT;
    if (scene->too_large)
        return KRS_BAD_SCENE;
    *text = print(&(Printing){scene, printers[target], &variant, wanted, count, {0}, {0}},
                  &scene->options.allocator);
    return *text ? KRS_OK : KRS_OUT_OF_MEMORY;
}

char *krs_scene_plain_text(const KrsScene *scene, const KrsAllocator *allocator)
{
    const KrsVariant all = {.values = true, .many_threads = true};
    return print(&(Printing){.scene = scene, .variant = &all}, allocator);
}
