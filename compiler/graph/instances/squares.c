/*
 * squares.c: a distance transform, axis by axis (Felzenszwalb and Huttenlocher, "Distance transforms
 * of sampled functions", 2012).
 */
#include "compiler/graph/instances/squares.h"

#include <math.h>

#include "compiler/base/parallel.h"

/* The least of parabolas: value[i] becomes the least value[k] + (i - k)^2 of any k. */
typedef struct Parabolas {
    double *value, *begin; /* of each parabola: its least value; where it begins to be the lowest */
    size_t *center;
} Parabolas;

/* Finds where the lower of two parabolas changes, the second one centered to the right. */
static double parabolas_cross(double value, size_t center, double other, size_t right)
{
    double a = (double)center, b = (double)right;
    return (other - value + b * b - a * a) / (2 * (b - a));
}

static void transform_line(double *values, size_t count, size_t stride, const Parabolas *lowest)
{
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        double value = values[i * stride], begin = -HUGE_VAL;
        if (value == HUGE_VAL)
            continue;
        while (used > 0) {
            begin = parabolas_cross(lowest->value[used - 1], lowest->center[used - 1], value, i);
            if (begin > lowest->begin[used - 1])
                break;
            used--;
            begin = -HUGE_VAL;
        }
        lowest->value[used]  = value;
        lowest->center[used] = i;
        lowest->begin[used]  = begin;
        used++;
    }
    for (size_t i = 0, at = 0; i < count && used > 0; i++) {
        while (at + 1 < used && lowest->begin[at + 1] < (double)i)
            at++;
        double away        = (double)i - (double)lowest->center[at];
        values[i * stride] = lowest->value[at] + away * away;
    }
}

/* The transform of all cells; each processor has lines of its own. */
typedef struct Transform {
    const uint32_t *cells;
    double         *values;
    Parabolas       lowest; /* of all processors, `longest` each */
    size_t          longest;
} Transform;

static Parabolas parabolas_of_part(const Transform *t, size_t part)
{
    size_t first = part * t->longest;
    return (Parabolas){t->lowest.value + first, t->lowest.begin + first, t->lowest.center + first};
}

static void transform_across(void *task, size_t part, size_t parts)
{
    const Transform *t      = task;
    Parabolas        lowest = parabolas_of_part(t, part);
    size_t           x = t->cells[0], y = t->cells[1], z = t->cells[2];
    for (size_t plane = part_begin(z, part, parts); plane < part_begin(z, part + 1, parts);
         plane++) {
        double *values = t->values + plane * x * y;
        for (size_t line = 0; line < y; line++)
            transform_line(values + line * x, x, 1, &lowest);
        for (size_t line = 0; line < x; line++)
            transform_line(values + line, y, x, &lowest);
    }
}

static void transform_along(void *task, size_t part, size_t parts)
{
    const Transform *t      = task;
    Parabolas        lowest = parabolas_of_part(t, part);
    size_t           plane  = (size_t)t->cells[0] * t->cells[1];
    size_t           end    = part_begin(plane, part + 1, parts);
    for (size_t line = part_begin(plane, part, parts); line < end; line++)
        transform_line(t->values + line, t->cells[2], plane, &lowest);
}

void squares_transform(const uint32_t cells[3], double *values, Arena *scratch)
{
    size_t longest = cells[0] > cells[1] ? cells[0] : cells[1];
    longest        = longest > cells[2] ? longest : cells[2];
    size_t    room = longest * MAX_PARTS;
    Transform t    = {.cells   = cells,
                      .values  = values,
                      .lowest  = {arena_new_array(scratch, double, room),
                                  arena_new_array(scratch, double, room),
                                  arena_new_array(scratch, size_t, room)},
                      .longest = longest};
    run_in_parallel(transform_across, &t);
    run_in_parallel(transform_along, &t);
}
