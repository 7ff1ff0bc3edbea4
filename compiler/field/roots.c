/* roots.c: false position that halves an end that stays (Illinois). */
#include "compiler/field/roots.h"

#include <math.h>

#include "compiler/base/vec.h"

/* Finds the next place, by false position, and now and then in the middle. */
static void place_root(RootSearch *search, int round, double point[3])
{
    double width   = search->high - search->low;
    bool   finite  = isfinite(search->at_low) && isfinite(search->at_high) && round % 4 != 3;
    double part    = finite ? search->at_low / (search->at_low - search->at_high) : 0.5;
    search->middle = search->low + width * part;
    add_scaled3(point, search->from, search->middle, search->along);
}

/* An end that stays has its value halved (Illinois). */
static void narrow_root(RootSearch *search, double value, double enough)
{
    if (value == 0) {
        search->low = search->high = search->middle;
    } else if (value < 0) {
        search->low    = search->middle;
        search->at_low = value;
        search->at_high *= search->side < 0 ? 0.5 : 1;
        search->side = -1;
    } else {
        search->high    = search->middle;
        search->at_high = value;
        search->at_low *= search->side > 0 ? 0.5 : 1;
        search->side = 1;
    }
    search->done = (search->high - search->low) * search->length <= enough;
}

void find_roots(const MeshField *field, RootSearch *searches, size_t count, double enough)
{
    enum { MAX_ROUNDS = 60 };
    for (int round = 0; round < MAX_ROUNDS; round++) {
        double points[MAX_FIELD_POINTS][3], values[MAX_FIELD_POINTS];
        size_t open[MAX_FIELD_POINTS], left = 0;
        for (size_t i = 0; i < count; i++)
            if (!searches[i].done) {
                place_root(&searches[i], round, points[left]);
                open[left++] = i;
            }
        if (left == 0)
            return;
        field_distances(field, (const double(*)[3])points, left, values);
        for (size_t i = 0; i < left; i++)
            narrow_root(&searches[open[i]], values[i], enough);
    }
}
