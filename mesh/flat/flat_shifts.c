/* flat_shifts.c: finds the shortest shift by quadratic programming in three dimensions. */
#include "mesh/flat/flat_shifts.h"

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

/* Changes a shift as little as possible, so that one more number grows exactly as it must; returns
   false if those before determine it. */
static bool fix(FlatShift *shift, const double normal[3], double need)
{
    if (shift->count == 3)
        return false;
    double *across = shift->normals[shift->count];
    memcpy(across, normal, sizeof shift->normals[0]);
    for (int k = 0; k < shift->count; k++)
        add_scaled3(across, across, -dot3(across, shift->normals[k]), shift->normals[k]);
    double size = length3(across);
    if (!(size > 1e-6))
        return false;
    add_scaled3(shift->along, shift->along, (need - dot3(normal, shift->along)) / (size * size),
                across);
    normalize3(across);
    shift->count++;
    return true;
}

void flat_growths_level(FlatGrowths *growths, const double normal[3])
{
    fix(&growths->level, normal, 0);
}

/* Finds the shortest shift for the first `count` numbers.  Where one does not grow enough by the
   shortest shift for those before it, it grows exactly so by the shortest for it as well, as R.
   Seidel solves linear programs (Small-dimensional linear programming and convex hulls made easy,
   1991). */
static bool find_shortest(const FlatGrowths *growths, size_t count, double most, FlatShift *shift)
{
    const FlatShift begin = *shift;
    for (size_t i = 0; i < count; i++) {
        const FlatGrowth *growth = &growths->list[i];
        if (dot3(growth->normal, shift->along) >= growth->need - 1e-9 * most)
            continue;
        *shift = begin;
        if (!fix(shift, growth->normal, growth->need) || length3(shift->along) > most ||
            !find_shortest(growths, i, most, shift))
            return false;
    }
    return true;
}

bool flat_has_shift(const FlatGrowths *growths, double most)
{
    FlatShift shift = growths->level;
    return find_shortest(growths, growths->count, most, &shift);
}
