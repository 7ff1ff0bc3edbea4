/* flat_ways.c: the shortest way, by quadratic programming in three dimensions. */
#include "mesh/flat/flat_ways.h"

#include <string.h>

#include "compiler/base/vec.h"

FlatGrowth flat_growth(const FlatPieces *pieces, size_t plane, int sign, const Box *box)
{
    const HalfSpace *half_space = &pieces->list[plane];
    FlatSlack        slack      = pieces->slack[plane];
    FlatGrowth       growth;
    double           middle = half_space->offset, half = 0;
    for (int k = 0; k < 3; k++) {
        const Range *along = &box->axis[k];
        middle += half_space->normal[k] * 0.5 * (along->low + along->high);
        half += fabs(half_space->normal[k]) * 0.5 * (along->high - along->low);
        growth.normal[k] = sign * half_space->normal[k];
    }
    growth.low   = sign * middle - half;
    growth.high  = sign * middle + half;
    growth.slack = sign > 0 ? slack : (FlatSlack){slack.above, slack.below};
    growth.need  = 0;
    return growth;
}

/* Makes one more grow exactly as it must, by as little as possible.  False: those before it determine how it grows. */
static bool fix(FlatWay *way, const double normal[3], double need)
{
    if (way->count == 3)
        return false;
    double *across = way->normals[way->count];
    memcpy(across, normal, sizeof way->normals[0]);
    for (int k = 0; k < way->count; k++)
        add_scaled3(across, across, -dot3(across, way->normals[k]), way->normals[k]);
    double size = length3(across);
    if (!(size > 1e-6))
        return false;
    add_scaled3(way->along, way->along, (need - dot3(normal, way->along)) / (size * size), across);
    normalize3(across);
    way->count++;
    return true;
}

void flat_growths_level(FlatGrowths *growths, const double normal[3])
{
    fix(&growths->level, normal, 0);
}

/* Where one does not grow enough on the shortest way for those before it, it grows exactly so on the shortest for it as well,
   as R. Seidel solves linear programs (Small-dimensional linear programming and convex hulls made easy, 1991). */
static bool find_shortest(const FlatGrowths *growths, size_t count, double most, FlatWay *way)
{
    const FlatWay begin = *way;
    for (size_t i = 0; i < count; i++) {
        const FlatGrowth *growth = &growths->list[i];
        if (dot3(growth->normal, way->along) >= growth->need - 1e-9 * most)
            continue;
        *way = begin;
        if (!fix(way, growth->normal, growth->need) || length3(way->along) > most ||
            !find_shortest(growths, i, most, way))
            return false;
    }
    return true;
}

bool flat_has_way(const FlatGrowths *growths, double most)
{
    FlatWay way = growths->level;
    return find_shortest(growths, growths->count, most, &way);
}
