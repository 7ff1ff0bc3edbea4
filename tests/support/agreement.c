/*
 * agreement.c: whether two pictures of a scene show the same.
 */
#include "tests/support/agreement.h"

#include <math.h>
#include <stdbool.h>

/* Steps of depth that are an outline, of the depth. */
static const double STEP = 0.02;

typedef struct Pair {
    const KrsPicture *a, *b;
    double            pixel_base, pixel_slope; /* width of a pixel at a depth */
} Pair;

static double column_length(const float m[4][4], int column)
{
    return sqrt((double)m[0][column] * m[0][column] + (double)m[1][column] * m[1][column] +
                (double)m[2][column] * m[2][column]);
}

static Pair pair_of(const KrsPicture *a, const KrsPicture *b)
{
    /* Camera space is as large as the world, so this is the stretch from it to the picture. */
    double stretch = column_length(a->world_to_ndc, 1), width = 2 / stretch / a->height;
    bool   perspective = column_length(a->world_to_ndc, 3) > 0;
    return (Pair){a, b, perspective ? 0 : width, perspective ? width : 0};
}

static bool same_shape(const KrsPicture *a, size_t i, const KrsPicture *b, size_t k)
{
    return a->component[i] == b->component[k] && a->level[i] == b->level[k] &&
           a->instance[i] == b->instance[k];
}

/* Tells whether the first picture shows something else around a pixel, or something much nearer or
   farther; at the border nobody knows. */
static bool is_outline(const KrsPicture *picture, uint32_t x, uint32_t y)
{
    size_t here = (size_t)y * picture->window.width + x;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            uint32_t column = x + (uint32_t)i, row = y + (uint32_t)j;
            if (column >= picture->window.width || row >= picture->window.height)
                return true;
            size_t there = (size_t)row * picture->window.width + column;
            double depth = picture->depth[here], other = picture->depth[there];
            if (!same_shape(picture, here, picture, there) ||
                (isfinite(depth) && fabs(other - depth) > STEP * depth))
                return true;
        }
    return false;
}

/* Returns what differs at a pixel: a counter of the agreement, or NULL. */
static size_t *find_difference(const Pair *pair, size_t k, double permitted, double *apart,
                               Agreement *counts)
{
    const KrsPicture *a = pair->a, *b = pair->b;
    *apart = 0;
    if ((a->component[k] != 0) != (b->component[k] != 0))
        return &counts->hits;
    if (a->component[k] != b->component[k])
        return &counts->components;
    if (a->component[k] == 0)
        return NULL;
    *apart = fabs((double)a->depth[k] - b->depth[k]) /
             (pair->pixel_base + pair->pixel_slope * a->depth[k]);
    if (a->level[k] != b->level[k])
        return &counts->levels;
    if (a->instance[k] != b->instance[k])
        return &counts->instances;
    return *apart <= permitted ? NULL : &counts->depths;
}

Agreement agreement_list(const KrsPicture *a, const KrsPicture *b, double permitted, FILE *report,
                         const char *prefix, size_t most)
{
    Pair      pair   = pair_of(a, b);
    Agreement counts = {0};
    for (uint32_t y = 0; y < a->window.height; y++)
        for (uint32_t x = 0; x < a->window.width; x++) {
            size_t  k = (size_t)y * a->window.width + x;
            double  apart;
            size_t *counter = find_difference(&pair, k, permitted, &apart, &counts);
            counts.pixels++;
            counts.solid += a->component[k] != 0;
            if (counter && is_outline(a, x, y))
                counter = &counts.outline;
            else
                counts.deepest = fmax(counts.deepest, apart);
            if (!counter)
                continue;
            ++*counter;
            if (counter != &counts.outline && report && agreement_faults(&counts) <= most)
                fprintf(report,
                        "%s%u,%u: component %u level %u instance %u depth %.7g;"
                        " %u %u %u %.7g\n",
                        prefix, x, y, a->component[k], a->level[k], a->instance[k], a->depth[k],
                        b->component[k], b->level[k], b->instance[k], b->depth[k]);
        }
    return counts;
}

Agreement agreement_of(const KrsPicture *a, const KrsPicture *b, double permitted)
{
    return agreement_list(a, b, permitted, NULL, "", 0);
}

size_t agreement_faults(const Agreement *agreement)
{
    return agreement->hits + agreement->components + agreement->levels + agreement->instances +
           agreement->depths;
}
