/*
 * flat_proof.c: looks for a way along which all half-spaces change by more than they are off.
 *
 * Let each be off by no more than its slack.  A solid is made of them by intersections and unions alone, so if each
 * that is entered at one end of a way, slack and all, is also entered at the other, so is the solid.
 */
#include "compiler/mesh/flat_proof.h"

#include <string.h>

#include "compiler/base/minmax.h"
#include "compiler/base/vec.h"

enum { MOST_LEVELS = 3 };

/* What a box meets of a half-space. */
typedef struct Growth {
    double    normal[3]; /* outwards */
    double    low, high; /* its values in the box */
    FlatSlack slack;
} Growth;

typedef struct Growths {
    Growth list[MOST_FLATS];
    double levels[MOST_LEVELS]
                 [3]; /* normals of what must not change, at right angles to each other */
    size_t count, level_count;
    bool   seen[2][MOST_FLATS];
} Growths;

static void collect(const FlatPieces *pieces, int root, Growths *growths)
{
    if (root < 0)
        return;
    const FlatNode *node = &pieces->nodes[root];
    if (node->kind == FLAT_HALF_SPACE)
        growths->seen[node->second > 0][node->first] = true;
    else {
        collect(pieces, node->first, growths);
        collect(pieces, node->second, growths);
    }
}

static double largest_of(FlatSlack slack) { return max2(slack.below, slack.above); }

static bool add_level(Growths *growths, const double normal[3])
{
    if (growths->level_count == MOST_LEVELS)
        return false;
    double *level = growths->levels[growths->level_count];
    memcpy(level, normal, sizeof growths->levels[0]);
    for (size_t k = 0; k < growths->level_count; k++)
        add_scaled3(level, level, -dot3(level, growths->levels[k]), growths->levels[k]);
    if (length3(level) > 1e-6 && normalize3(level))
        growths->level_count++;
    return true;
}

static void add_growth(Growths *growths, const HalfSpace *plane, double sign, FlatSlack slack,
                       const Box *box)
{
    Growth *growth = &growths->list[growths->count++];
    double  middle = plane->offset, half = 0;
    for (int k = 0; k < 3; k++) {
        const Range *along = &box->axis[k];
        middle += plane->normal[k] * 0.5 * (along->low + along->high);
        half += fabs(plane->normal[k]) * 0.5 * (along->high - along->low);
        growth->normal[k] = sign * plane->normal[k];
    }
    growth->low   = sign * middle - half;
    growth->high  = sign * middle + half;
    growth->slack = sign > 0 ? slack : (FlatSlack){slack.above, slack.below};
}

/* What is exact and has the solid on both sides must not change at all. */
static bool list_growths(const FlatPieces *pieces, const Box *box, Growths *growths)
{
    for (size_t i = 0; i < pieces->count; i++) {
        bool below = growths->seen[1][i], above = growths->seen[0][i];
        if (below && above) {
            if (largest_of(pieces->slack[i]) > 0 || !add_level(growths, pieces->list[i].normal))
                return false;
        } else if (below || above)
            add_growth(growths, &pieces->list[i], below ? 1 : -1, pieces->slack[i], box);
    }
    return true;
}

static bool make_level(const Growths *growths, double direction[3])
{
    for (size_t k = 0; k < growths->level_count; k++)
        add_scaled3(direction, direction, -dot3(direction, growths->levels[k]), growths->levels[k]);
    return length3(direction) > 1e-9 && normalize3(direction);
}

/* By how much less than needed a half-space grows along a way from all points of the box; none where all stay on one side. */
static double lack_of(const Growth *growth, const double direction[3], double way, double part)
{
    double grown = way * dot3(growth->normal, direction);
    double below = part * growth->slack.below, above = part * growth->slack.above;
    bool   inwards  = growth->low - below > 0 || growth->high - grown + above <= 0;
    bool   outwards = growth->high + above < 0 || growth->low + grown - below >= 0;
    return inwards && outwards ? 0 : max2(below, above) - grown;
}

/* Goes towards what grows too slowly, by smaller and smaller steps.  `part`: of the slack. */
static bool find_direction(const Growths *growths, double way, double part)
{
    enum { TRIES = 20 };
    double direction[3] = {0, 0, 0};
    bool   any          = false;
    for (size_t i = 0; i < growths->count; i++) {
        const Growth *growth = &growths->list[i];
        if (growth->low - growth->slack.below > 0 || growth->high + growth->slack.above < 0)
            continue;
        add_scaled3(direction, direction, 0.1 * way + largest_of(growth->slack), growth->normal);
        any = true;
    }
    if (!any)
        return true;
    for (int i = 0; i < TRIES && make_level(growths, direction); i++) {
        const Growth *worst = NULL;
        double        most  = 0;
        for (size_t k = 0; k < growths->count; k++) {
            double lack = lack_of(&growths->list[k], direction, way, part);
            if (lack > most) {
                worst = &growths->list[k];
                most  = lack;
            }
        }
        if (!worst)
            return true;
        add_scaled3(direction, direction, 1.0 / (2 + i), worst->normal);
    }
    return false;
}

FlatNearness flat_nearness(const FlatPieces *pieces, const Box *box, double error)
{
    static const double WAYS[] = {1, 0.75, 0.55, 0.4};
    Growths             growths;
    growths.count = growths.level_count = 0;
    memset(growths.seen, 0, sizeof growths.seen);
    collect(pieces, pieces->root, &growths);
    if (!list_growths(pieces, box, &growths))
        return FLAT_THIN;
    for (int i = 0; i < 4; i++)
        if (find_direction(&growths, WAYS[i] * error, 1))
            return FLAT_NEAR;
    return find_direction(&growths, 0.3 * error, 0.1) ? FLAT_ROUGH : FLAT_THIN;
}

int flat_widest_axis(const FlatPieces *pieces, const Box *box)
{
    static const double LEAST  = 1e-3;
    int                 widest = 0;
    double              most   = 0;
    for (int k = 0; k < 3; k++) {
        double change = LEAST;
        for (size_t i = 0; i < pieces->count; i++)
            change = max2(change, fabs(pieces->list[i].normal[k]));
        double width = change * (box->axis[k].high - box->axis[k].low);
        if (width > most) {
            widest = k;
            most   = width;
        }
    }
    return widest;
}
