/*
 * brute.c: vectors, random numbers, and clouds of points with a k-d tree over them.
 *
 * The tree is implicit: of a range of points, the middle one splits it, and the axis of the
 * split goes round with the depth.
 */
#include "tests/oracle/brute.h"

#include <stdio.h>
#include <stdlib.h>

Vec vec_across(Vec a)
{
    Vec other = fabs(a.x) < fabs(a.y) ? vec(1, 0, 0) : vec(0, 1, 0);
    if (fabs(a.z) < fmin(fabs(a.x), fabs(a.y)))
        other = vec(0, 0, 1);
    return vec_unit(vec_cross(a, other));
}

Vec vec_rotate(Vec p, Vec axis, double angle)
{
    Vec up    = vec_unit(axis);
    Vec along = vec_scale(vec_dot(p, up), up);
    Vec out   = vec_sub(p, along);
    return vec_add(along,
                   vec_add(vec_scale(cos(angle), out), vec_scale(sin(angle), vec_cross(up, out))));
}

Vec random_in_cube(Random *random, double half)
{
    double x = random_between(random, -half, half);
    double y = random_between(random, -half, half);
    return vec(x, y, random_between(random, -half, half));
}

Vec random_unit(Random *random)
{
    for (;;) {
        Vec    v      = random_in_cube(random, 1);
        double length = vec_length(v);
        if (length > 0.1 && length <= 1)
            return vec_scale(1 / length, v);
    }
}

Vec random_in_ball(Random *random, Vec centre, double radius)
{
    bool   rim = random_below(random, 2);
    double r   = rim ? random_between(random, 0.99, 1) : cbrt(random_between(random, 0, 1));
    return vec_add(centre, vec_scale(radius * r, random_unit(random)));
}

void cloud_free(Cloud *cloud)
{
    free(cloud->points);
    *cloud = (Cloud){0};
}

void cloud_add(Cloud *cloud, Vec point)
{
    if (cloud->count == cloud->capacity) {
        cloud->capacity = cloud->capacity ? 2 * cloud->capacity : 4096;
        cloud->points   = realloc(cloud->points, cloud->capacity * sizeof *cloud->points);
        if (!cloud->points) {
            fprintf(stderr, "no memory for a cloud of %zu points\n", cloud->capacity);
            exit(EXIT_FAILURE);
        }
    }
    cloud->points[cloud->count++] = point;
    cloud->indexed                = 0;
}

/* Returns the length of the longest of a few lines of a patch, along u or along v. */
static double patch_extent(Patch *patch, const void *user, bool along_u)
{
    enum { LINES = 9, PIECES = 32 };
    double longest = 0;
    for (int line = 0; line < LINES; line++) {
        double across = line / (LINES - 1.0), length = 0;
        for (int i = 0; i < PIECES; i++) {
            double a = (double)i / PIECES, b = (i + 1.0) / PIECES;
            double piece = along_u ? vec_distance(patch(user, a, across), patch(user, b, across))
                                   : vec_distance(patch(user, across, a), patch(user, across, b));
            length += isnan(piece) ? 0 : piece;
        }
        longest = fmax(longest, length);
    }
    return longest;
}

/* Returns the longest side or diagonal of the cell whose corners are the first two of both rows. */
static double cell_size(const Vec *row, const Vec *next)
{
    double sides     = fmax(vec_distance(row[0], row[1]), vec_distance(row[0], next[0]));
    double diagonals = fmax(vec_distance(row[0], next[1]), vec_distance(row[1], next[0]));
    return fmax(sides, diagonals);
}

void cloud_patch(Cloud *cloud, Patch *patch, Keep *keep, const void *user, double step)
{
    size_t rows    = 2 + (size_t)(patch_extent(patch, user, true) / step);
    size_t columns = 2 + (size_t)(patch_extent(patch, user, false) / step);
    Vec   *before = calloc(columns, sizeof *before), *row = calloc(columns, sizeof *row);
    if (!before || !row)
        exit(EXIT_FAILURE);

    double longest = 0;
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < columns; j++) {
            row[j] = patch(user, (double)i / (rows - 1.0), (double)j / (columns - 1.0));
            if (!keep || keep(user, row[j]))
                cloud_add(cloud, row[j]);
        }
        for (size_t j = 0; i > 0 && j + 1 < columns; j++)
            longest = fmax(longest, cell_size(before + j, row + j));
        Vec *swap = before;
        before    = row;
        row       = swap;
    }
    free(before);
    free(row);

    /* A triangle is covered from its corners by 1/sqrt(3) of its longest side, and a little
       more where it bends.  A cell that `keep` cuts may be covered from the next one. */
    cloud->spacing = fmax(cloud->spacing, (keep ? 1.3 : 0.65) * longest);
}

static double vec_axis(const Vec *v, int axis)
{
    return axis == 0 ? v->x : axis == 1 ? v->y : v->z;
}

/* Puts the point that belongs into the middle there, lesser ones before it (Hoare's find). */
static void split_range(Vec *points, size_t count, int axis)
{
    ptrdiff_t low = 0, high = (ptrdiff_t)count - 1, middle = (ptrdiff_t)count / 2;
    while (low < high) {
        double    pivot = vec_axis(&points[middle], axis);
        ptrdiff_t i = low, j = high;
        while (i <= j) {
            while (vec_axis(&points[i], axis) < pivot)
                i++;
            while (vec_axis(&points[j], axis) > pivot)
                j--;
            if (i <= j) {
                Vec swap    = points[i];
                points[i++] = points[j];
                points[j--] = swap;
            }
        }
        if (j < middle)
            low = i;
        if (middle < i)
            high = j;
    }
}

static void index_range(Vec *points, size_t count, int axis)
{
    if (count < 2)
        return;
    split_range(points, count, axis);
    size_t middle = count / 2;
    index_range(points, middle, (axis + 1) % 3);
    index_range(points + middle + 1, count - middle - 1, (axis + 1) % 3);
}

/* Returns the square of the distance to the nearest point of a range, if it is below `best`. */
static double nearest_in_range(const Vec *points, size_t count, int axis, Vec p, double best)
{
    if (count == 0)
        return best;
    size_t middle     = count / 2;
    Vec    to         = vec_sub(points[middle], p);
    best              = fmin(best, vec_dot(to, to));
    double     excess = vec_axis(&p, axis) - vec_axis(&points[middle], axis);
    const Vec *upper  = points + middle + 1;
    size_t     above  = count - middle - 1;
    int        next   = (axis + 1) % 3;
    if (excess < 0) {
        best = nearest_in_range(points, middle, next, p, best);
        return excess * excess < best ? nearest_in_range(upper, above, next, p, best) : best;
    }
    best = nearest_in_range(upper, above, next, p, best);
    return excess * excess < best ? nearest_in_range(points, middle, next, p, best) : best;
}

double cloud_nearest(Cloud *cloud, Vec point)
{
    if (cloud->indexed != cloud->count) {
        index_range(cloud->points, cloud->count, 0);
        cloud->indexed = cloud->count;
    }
    return sqrt(nearest_in_range(cloud->points, cloud->count, 0, point, HUGE_VAL));
}
