/*
 * around.c: a path from a point of the surface, along which the distance grows, ends where bounds
 * of some tetrahedron tell on which side of the mesh it is (docs/math.md, section 8).
 *
 * The path ends in a tetrahedron that has a corner in common with the first, if it is shorter than
 * all around are wide.  Let some of the corners be good: all tetrahedra that have one of them are
 * bounded.  The sum of barycentric coordinates for good corners is 0 in tetrahedra without good
 * corners, and along a path it falls by no more than its length over the least width.  So where the
 * sum is more than that at the beginning, the path ends where there are bounds.
 *
 * Where functions around are different ones, each is 0 where the path begins.  So it is above the
 * largest value that is on the wrong side where it has grown to that along the path.
 */
#include "mesh/proof/around.h"

#include <string.h>

#include "compiler/base/minmax.h"
#include "compiler/base/vec.h"

static const double ROUNDING = 1 + 1e-6, ROUNDED = 1e-9;

/* ---- growths ---- */

void growth_add(Growth *growth, const Range by[3], double sign)
{
    bool     full = growth->count == MAX_GROWING;
    uint32_t at   = full ? MAX_GROWING - 1 : growth->count++;
    for (int k = 0; k < 3; k++) {
        double a = sign * by[k].low, b = sign * by[k].high, low = min2(a, b), high = max2(a, b);
        if (full) {
            double middle = growth->middle[at][k], rest = growth->rest[at][k];
            low  = min2(low, middle - rest);
            high = max2(high, middle + rest);
        }
        float middle          = (float)(0.5 * (low + high));
        growth->middle[at][k] = middle;
        growth->rest[at][k]   = (float)(max2(high - middle, middle - low) * ROUNDING);
    }
}

double growth_along(const Growth *growth, const float direction[3])
{
    double least = INFINITY;
    for (uint32_t i = 0; i < growth->count; i++) {
        double sum = 0;
        for (int k = 0; k < 3; k++)
            sum += growth->middle[i][k] * direction[k] - growth->rest[i][k] * fabsf(direction[k]);
        least = min2(least, sum);
    }
    return least < INFINITY ? least - (ROUNDING - 1) * fabs(least) : 0;
}

static float distance_of(const Tet *tet)
{
    return tet->slope > 0 ? tet->deviation / tet->slope * (1 + 1e-6F) : INFINITY;
}

static void add_function(Around *around, const Tet *tet)
{
    bool other        = around->origin != 0 && around->origin != tet->origin;
    around->mixed     = around->mixed || tet->origin == 0 || other;
    around->in_pieces = around->in_pieces || tet->steep > 0;
    around->origin    = tet->origin;
}

void arounds_find(Arounds *arounds, const Tets *tets, Arena *arena)
{
    static const Around nothing = {.width = INFINITY};
    while (arounds->count < tets->points.count)
        array_push_large(arena, arounds, nothing);
    for (size_t i = 0; i < arounds->count; i++)
        arounds->items[i] = nothing;
    for (size_t i = 0; i < tets->list.count; i++) {
        const Tet *tet       = &tets->list.items[i];
        bool       none      = tet->state == TET_EMPTY;
        float      deviation = none ? 0 : tet->deviation, distance = none ? 0 : distance_of(tet);
        for (int k = 0; k < 4; k++) {
            Around *around    = &arounds->items[tet->points[k]];
            around->deviation = deviation > around->deviation ? deviation : around->deviation;
            around->width     = tet->width < around->width ? tet->width : around->width;
            around->distance  = distance > around->distance ? distance : around->distance;
            if (!none)
                add_function(around, tet);
        }
    }
}

/* Returns the length of path, in the direction of a tetrahedron, after which all functions around a
   corner are above what the mesh has on the wrong side. */
static double path_by_growths(const Arounds *arounds, const Tets *tets, uint32_t point,
                              const Tet *tet)
{
    const Growth *growths = arounds->growths.items;
    double        longest = 0, grows = 0;
    uint32_t      last = 0;
    if (tet->growth == 0)
        return INFINITY;
    for (uint32_t at = tets->points.items[point].first; at; at = tets->links.items[at - 1].next) {
        const Tet *other = &tets->list.items[tets->links.items[at - 1].tet];
        if (other->state == TET_EMPTY)
            continue;
        if (other->growth == 0)
            return INFINITY;
        if (other->growth != last)
            grows = growth_along(&growths[other->growth - 1], growths[tet->growth - 1].direction);
        last = other->growth;
        if (!(grows > 0))
            return INFINITY;
        longest = max2(longest, other->deviation / grows);
    }
    return longest;
}

/* Returns the length of path after which no point around the corner is on the wrong side of the
   mesh.  Pieces have the sign of the distance, but not its size.  So between different pieces only
   the largest distance to the surface counts. */
static double path_length(const Arounds *arounds, const Tets *tets, uint32_t point, const Tet *tet,
                          double error)
{
    static const double SHORT  = 0.25;
    const Around       *around = &arounds->items[point];
    double              steep  = tet->steep > 0 ? tet->steep : 1;
    if (!around->in_pieces || !around->mixed)
        return around->deviation / tet->slope;
    double by_distance = around->distance <= error ? steep * around->distance / tet->slope
                                                   : INFINITY;
    if (around->deviation == INFINITY || by_distance <= SHORT * error)
        return by_distance;
    return min2(by_distance, path_by_growths(arounds, tets, point, tet));
}

/* Finds the linear function that is 1 at good corners and 0 at the others. */
static void find_sum(const double corners[4][3], const bool good[4], Sure *sure)
{
    double edges[3][3], normals[3][3];
    for (int i = 0; i < 3; i++)
        add_scaled3(edges[i], corners[i + 1], -1, corners[0]);
    for (int i = 0; i < 3; i++)
        cross3(edges[(i + 1) % 3], edges[(i + 2) % 3], normals[i]);
    double volume = dot3(edges[0], normals[0]);
    memset(sure->slope, 0, sizeof sure->slope);
    for (int i = 0; i < 3; i++)
        add_scaled3(sure->slope, sure->slope, (good[i + 1] - good[0]) / volume, normals[i]);
    sure->offset = good[0] - dot3(sure->slope, corners[0]);
}

void sure_find(const Arounds *arounds, const Tets *tets, const Tet *tet, double error, Sure *sure)
{
    double corners[4][3], longest = 0, width = INFINITY;
    bool   good[4];
    int    count = 0;
    for (int k = 0; k < 4; k++) {
        const Around *around = &arounds->items[tet->points[k]];
        double        path   = ROUNDING * path_length(arounds, tets, tet->points[k], tet, error);
        good[k]              = path <= error && path < around->width &&
                  (tet->room == 0 || path + around->distance < tet->room);
        if (!good[k])
            continue;
        longest = max2(longest, path);
        width   = min2(width, around->width);
        count++;
    }
    *sure            = (Sure){.least = ROUNDING * longest / width + ROUNDED};
    sure->anywhere   = count > 0 && sure->least < 1;
    sure->everywhere = count == 4 && sure->anywhere;
    tets_corners(tets, tet, corners);
    if (sure->anywhere)
        find_sum((const double(*)[3])corners, good, sure);
}

bool sure_has(const Sure *sure, const double corners[4][3])
{
    for (int i = 0; i < 4; i++)
        if (!(dot3(sure->slope, corners[i]) + sure->offset > sure->least))
            return false;
    return true;
}
