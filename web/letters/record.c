/*
 * record.c: the functions of path.h that letters are drawn by, which here write down what they are asked.
 */
#include "web/letters/letters.h"

#include <stdlib.h>
#include <string.h>

typedef struct Numbers {
    double *items;
    size_t  count, capacity;
} Numbers;

typedef struct Recorder {
    Path    path; /* the first, so that a path is its recorder */
    Numbers numbers;
} Recorder;

static void record(Path *path, LetterStep step, const double *const points[])
{
    Numbers *numbers = &((Recorder *)path)->numbers;
    array_push(path->arena, numbers, (double)step);
    for (unsigned i = 0; i < letter_points[step]; i++)
        for (int k = 0; k < 2; k++)
            array_push(path->arena, numbers, points[i][k]);
}

void path_move(Path *path, const double to[2])
{
    record(path, STEP_MOVE, (const double *const[]){to});
}

void path_line(Path *path, const double to[2])
{
    record(path, STEP_LINE, (const double *const[]){to});
}

void path_quadratic(Path *path, const double via[2], const double to[2])
{
    record(path, STEP_QUADRATIC, (const double *const[]){via, to});
}

void path_cubic(Path *path, const double first[2], const double second[2], const double to[2])
{
    record(path, STEP_CUBIC, (const double *const[]){first, second, to});
}

void path_close(Path *path) { record(path, STEP_CLOSE, NULL); }

static double *copy_of(const Numbers *numbers, uint32_t missing)
{
    double *copy = malloc((numbers->count + 1) * sizeof *copy);
    if (!copy)
        return NULL;
    copy[0] = missing;
    if (numbers->count)
        memcpy(copy + 1, numbers->items, numbers->count * sizeof *copy);
    return copy;
}

double *letters_of(const unsigned char *font, size_t length, int face, const char *text,
                   const Lettering *lettering, size_t *count)
{
    const Font whole = {font, length, face};
    jmp_buf    unwind;
    Memory     memory   = {.exhausted = &unwind};
    Arena      arena    = {.memory = &memory};
    Recorder   recorder = {.path = {.arena = &arena}};
    double    *drawn    = NULL;
    uint32_t   missing;
    *count = LETTERS_NO_MEMORY;
    if (setjmp(unwind) == 0) {
        if (!letters_draw(&recorder.path, &whole, text, lettering, &missing))
            *count = LETTERS_NO_FONT;
        else if ((drawn = copy_of(&recorder.numbers, missing)))
            *count = recorder.numbers.count + 1;
        arena_free(&arena);
    }
    return drawn;
}
