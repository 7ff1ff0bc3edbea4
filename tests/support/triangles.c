/*
 * triangles.c: distances from triangles by orthogonal projection, and sides by sorting.
 */
#include "tests/support/triangles.h"

#include <math.h>
#include <stdlib.h>

static double product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void minus(const double a[3], const double b[3], double difference[3])
{
    for (int k = 0; k < 3; k++)
        difference[k] = a[k] - b[k];
}

static double distance_to_side(const double from[3], const double to[3], const double point[3])
{
    double side[3], way[3];
    minus(to, from, side);
    minus(point, from, way);
    const double square = product(side, side);
    const double share  = square > 0 ? fmin(fmax(product(side, way) / square, 0), 1) : 0;
    for (int k = 0; k < 3; k++)
        way[k] -= share * side[k];
    return sqrt(product(way, way));
}

/* The foot of the perpendicular counts if it is within; else the nearest point is on a side. */
double distance_to_triangle(const double corners[3][3], const double point[3])
{
    double a[3], b[3], way[3], least = INFINITY;
    minus(corners[1], corners[0], a);
    minus(corners[2], corners[0], b);
    minus(point, corners[0], way);
    const double aa = product(a, a), ab = product(a, b), bb = product(b, b);
    const double aw = product(a, way), bw = product(b, way), area = aa * bb - ab * ab;
    const double u = (bb * aw - ab * bw) / area, v = (aa * bw - ab * aw) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) {
        for (int k = 0; k < 3; k++)
            way[k] -= u * a[k] + v * b[k];
        least = sqrt(product(way, way));
    }
    for (int i = 0; i < 3; i++)
        least = fmin(least, distance_to_side(corners[i], corners[(i + 1) % 3], point));
    return least;
}

static int compare(const void *a, const void *b)
{
    const uint64_t first = *(const uint64_t *)a, second = *(const uint64_t *)b;
    return first < second ? -1 : first > second;
}

/* Returns how many of sorted keys are this one. */
static size_t count_of(const uint64_t *keys, size_t count, uint64_t key)
{
    size_t low = 0, high = count, found = 0;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (keys[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < count && keys[low] == key; low++)
        found++;
    return found;
}

size_t count_open_sides(const uint32_t (*triangles)[3], size_t count)
{
    uint64_t *keys = malloc((3 * count + 1) * sizeof *keys);
    size_t    open = 0;
    for (size_t i = 0; i < 3 * count; i++)
        keys[i] = (uint64_t)triangles[i / 3][i % 3] << 32 | triangles[i / 3][(i + 1) % 3];
    qsort(keys, 3 * count, sizeof *keys, compare);
    for (size_t i = 0; i < 3 * count; i++)
        open += count_of(keys, 3 * count, keys[i]) != 1 ||
                count_of(keys, 3 * count, keys[i] << 32 | keys[i] >> 32) != 1;
    free(keys);
    return open;
}
