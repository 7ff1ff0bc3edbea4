/*
 * letters.c: letters.h by the module of web/letters, which the page fetches.
 */
#include "web/letters/letters.h"

#include <stdlib.h>

#include "web/core/page.h"

static void draw_step(Path *path, LetterStep step, const double *points)
{
    switch (step) {
    case STEP_MOVE: path_move(path, points); break;
    case STEP_LINE: path_line(path, points); break;
    case STEP_QUADRATIC: path_quadratic(path, points, points + 2); break;
    case STEP_CUBIC: path_cubic(path, points, points + 2, points + 4); break;
    default: path_close(path);
    }
}

/* Lets memory that runs out unwind to here, so that the page's numbers are freed. */
static bool draw_steps(Path *path, const double *numbers, size_t count)
{
    Memory  *memory = path->arena->memory;
    jmp_buf *outer  = memory->exhausted;
    jmp_buf  unwind;
    memory->exhausted = &unwind;
    bool enough       = setjmp(unwind) == 0;
    if (enough)
        for (size_t i = 0; i < count;) {
            const LetterStep step = (LetterStep)numbers[i++];
            draw_step(path, step, numbers + i);
            i += 2 * (size_t)letter_points[step];
        }
    memory->exhausted = outer;
    return enough;
}

bool letters_draw(Path *path, const Font *font, const char *text, const Lettering *lettering,
                  uint32_t *missing)
{
    size_t  count = 0;
    double *drawn = page_letters(font->bytes, font->length, font->face, text, lettering, &count);
    if (!drawn) {
        if (count == LETTERS_NO_MEMORY)
            arena_exhausted(path->arena);
        return false;
    }
    *missing    = (uint32_t)drawn[0];
    bool enough = draw_steps(path, drawn + 1, count - 1);
    free(drawn);
    if (!enough)
        arena_exhausted(path->arena);
    return true;
}
