/*
 * flat_proof.c: searches for shifts by which half-spaces change by more than they are off.
 *
 * Let each be off by no more than its slack.  A solid is made of them by intersections and unions
 * alone.  So if each half-space that has one end of a shift, slack included, also has the other
 * end, the same is true of the solid.
 */
#include "mesh/flat/flat_proof.h"

#include <string.h>

#include "compiler/base/minmax.h"
#include "mesh/flat/flat_shifts.h"

/* The task of a proof: a box, the length of shifts, and the part of the slack that counts, with its
   least value. */
typedef struct Proof {
    const FlatPieces *pieces;
    const Box        *box;
    double            shift, part, least;
} Proof;

static double slack_of(const Proof *proof, double slack)
{
    return max2(proof->part * slack, min2(slack, proof->least));
}

static FlatGrowth growth_of(const Proof *proof, size_t plane, int sign)
{
    FlatGrowth growth  = flat_growth(proof->pieces, plane, sign, proof->box);
    growth.slack.below = slack_of(proof, growth.slack.below);
    growth.slack.above = slack_of(proof, growth.slack.above);
    return growth;
}

static double largest_of(FlatSlack slack) { return max2(slack.below, slack.above); }

/* ---- one shift for all ---- */

typedef struct Seen {
    bool by_sign[2][MAX_FLATS];
} Seen;

/* Returns 1 if all of the box is outside, -1 if all is inside, by more than the slack; else 0. */
static int side_of(const FlatGrowth *growth)
{
    return growth->low - growth->slack.below > 0    ? 1
           : growth->high + growth->slack.above < 0 ? -1
                                                    : 0;
}

/* Returns the side of a node by those of its parts: 1, -1, or 0 if it is not known. */
static signed char side_of_node(const FlatNode *node, const signed char *sides,
                                const signed char *known)
{
    if (node->kind == FLAT_HALF_SPACE)
        return (signed char)(node->second * sides[node->first]);
    signed char first = known[node->first], second = known[node->second];
    signed char decides = node->kind == FLAT_BOTH ? 1 : -1;
    if (first == decides || second == decides)
        return decides;
    return first == second ? first : 0;
}

/* Collects the half-spaces whose side makes a difference where some sides are known; NULL: none is.
   Parts of a node come before it. */
static void collect(const FlatPieces *pieces, const signed char *sides, Seen *seen)
{
    signed char known[MAX_FLAT_NODES];
    bool        counts[MAX_FLAT_NODES];
    size_t      count = (size_t)(pieces->root + 1);
    if (pieces->root < 0)
        return;
    memset(known, 0, count);
    memset(counts, 0, count);
    for (size_t i = 0; sides && i < count; i++)
        known[i] = side_of_node(&pieces->nodes[i], sides, known);
    counts[pieces->root] = true;
    for (size_t i = count; i-- > 0;) {
        const FlatNode *node = &pieces->nodes[i];
        if (!counts[i] || known[i] != 0)
            continue;
        if (node->kind == FLAT_HALF_SPACE)
            seen->by_sign[node->second > 0][node->first] = true;
        else
            counts[node->first] = counts[node->second] = true;
    }
}

/* Returns how much a number must grow; one that has the same sign in all of the box may even
   fall. */
static double need_of(const FlatGrowth *growth)
{
    int side = side_of(growth);
    return side == 0  ? largest_of(growth->slack)
           : side > 0 ? growth->slack.below - growth->low
                      : growth->slack.above + growth->high;
}

typedef enum OneShift { ONE_SHIFT, NO_SHIFT, SEAM } OneShift;

static OneShift find_one_shift(const Proof *proof, const signed char *sides)
{
    Seen        seen = {{{false}}};
    FlatGrowths growths;
    growths.count = 0;
    growths.level = (FlatShift){{0, 0, 0}, {{0}}, 0};
    collect(proof->pieces, sides, &seen);
    for (size_t i = 0; i < proof->pieces->count; i++) {
        bool below = seen.by_sign[1][i], above = seen.by_sign[0][i];
        if (below && above) {
            if (largest_of(proof->pieces->slack[i]) > 0)
                return proof->pieces->chooses[i] ? SEAM : NO_SHIFT;
            flat_growths_level(&growths, proof->pieces->list[i].normal);
        } else if (below || above) {
            FlatGrowth *growth = &growths.list[growths.count++];
            *growth            = growth_of(proof, i, below ? 1 : -1);
            growth->need       = need_of(growth);
        }
    }
    return flat_has_shift(&growths, proof->shift) ? ONE_SHIFT : NO_SHIFT;
}

/* Tells whether all half-spaces in the box or beside it have one shift. */
static bool all_have_one_shift(const Proof *proof)
{
    return find_one_shift(proof, NULL) == ONE_SHIFT;
}

/* Finds one shift for what makes a difference in the box: then no two parts of the surface meet
   there, nor does a hole close. */
static OneShift find_local_shift(const Proof *proof)
{
    signed char sides[MAX_FLATS];
    for (size_t i = 0; i < proof->pieces->count; i++) {
        FlatGrowth growth = growth_of(proof, i, 1);
        sides[i]          = (signed char)side_of(&growth);
    }
    return find_one_shift(proof, sides);
}

/* ---- a shift for each set ---- */

enum { MAX_MEMBERS = 64, MAX_SETS = 128 };

/* Sets of half-spaces and complements; bit i is the growth i. */
typedef struct Sets {
    uint64_t items[MAX_SETS];
    size_t   count;
    bool     failed; /* there are more, or more members */
} Sets;

typedef struct Members {
    const Proof *proof;
    FlatGrowths  growths;
    int          numbers[2][MAX_FLATS]; /* of growths, by sign; or UNSEEN, NEVER, ALWAYS */
} Members;

enum { UNSEEN = -1, NEVER = -2, ALWAYS = -3 };

/* Adds a set, and drops sets that contain another. */
static void add_set(Sets *sets, uint64_t set)
{
    size_t kept = 0;
    for (size_t i = 0; i < sets->count; i++)
        if ((sets->items[i] & set) == sets->items[i])
            return;
    for (size_t i = 0; i < sets->count; i++)
        if ((sets->items[i] & set) != set)
            sets->items[kept++] = sets->items[i];
    sets->count  = kept;
    sets->failed = sets->failed || kept == MAX_SETS;
    if (!sets->failed)
        sets->items[sets->count++] = set;
}

/* Returns the number of a growth; NEVER if it is below 0 in the box, ALWAYS if it is above 0 for
   all shifts. */
static int member_of(Members *members, size_t plane, int sign)
{
    int *number = &members->numbers[sign > 0][plane];
    if (*number != UNSEEN || members->growths.count == MAX_MEMBERS)
        return *number;
    FlatGrowth *growth = &members->growths.list[members->growths.count];
    *growth            = growth_of(members->proof, plane, sign);
    growth->need       = min2(growth->slack.below - growth->low, largest_of(growth->slack));
    if (growth->high + growth->slack.above < 0)
        return *number = NEVER;
    if (growth->need <= -members->proof->shift)
        return *number = ALWAYS;
    return *number = (int)members->growths.count++;
}

static void add_all(const Sets *from, Sets *to)
{
    for (size_t i = 0; i < from->count && !to->failed; i++)
        add_set(to, from->items[i]);
}

static void add_common(const Sets *first, const Sets *second, Sets *to)
{
    for (size_t i = 0; i < first->count; i++)
        for (size_t k = 0; k < second->count && !to->failed; k++)
            add_set(to, first->items[i] | second->items[k]);
}

/* Finds the sets of numbers such that a point is outside of the solid if all numbers of one set are
   above 0; with `inside`, such that it is inside. */
static void find_sets(Members *members, int root, bool inside, Sets *sets)
{
    sets->count  = 0;
    sets->failed = false;
    if (root < 0) {
        if ((root == FLAT_ALL) == inside)
            add_set(sets, 0);
        return;
    }
    const FlatNode *node = &members->proof->pieces->nodes[root];
    if (node->kind == FLAT_HALF_SPACE) {
        int member = member_of(members, (size_t)node->first, inside ? -node->second : node->second);
        sets->failed = member == UNSEEN;
        if (member >= 0 || member == ALWAYS)
            add_set(sets, member >= 0 ? (uint64_t)1 << member : 0);
        return;
    }
    Sets first, second;
    find_sets(members, node->first, inside, &first);
    find_sets(members, node->second, inside, &second);
    sets->failed = first.failed || second.failed;
    if ((node->kind == FLAT_EITHER) != inside)
        add_common(&first, &second, sets);
    else {
        add_all(&first, sets);
        add_all(&second, sets);
    }
}

static bool set_has_shift(const Members *members, uint64_t set)
{
    FlatGrowths growths;
    growths.count = 0;
    growths.level = (FlatShift){{0, 0, 0}, {{0}}, 0};
    for (size_t i = 0; i < members->growths.count; i++)
        if (set >> i & 1)
            growths.list[growths.count++] = members->growths.list[i];
    return flat_has_shift(&growths, members->proof->shift);
}

static bool sets_have_shifts(const Proof *proof)
{
    Members members;
    members.proof         = proof;
    members.growths.count = 0;
    for (int sign = 0; sign < 2; sign++)
        for (size_t i = 0; i < proof->pieces->count; i++)
            members.numbers[sign][i] = UNSEEN;
    for (int inside = 0; inside < 2; inside++) {
        Sets sets;
        find_sets(&members, proof->pieces->root, inside, &sets);
        for (size_t i = 0; i < sets.count && !sets.failed; i++)
            sets.failed = !set_has_shift(&members, sets.items[i]);
        if (sets.failed)
            return false;
    }
    return true;
}

/* ---- boxes ---- */

/* Tells whether planes are near enough to the surface.  In sharp wedges none are, since their
   number is limited. */
FlatNearness flat_nearness(const FlatPieces *pieces, const Box *box, double error)
{
    Proof now = {pieces, box, error, 1, 0}, finer = {pieces, box, 0.3 * error, 0.1, 0.02 * error};
    if (all_have_one_shift(&now))
        return FLAT_NEAR;
    if (find_local_shift(&now) == ONE_SHIFT && sets_have_shifts(&now))
        return FLAT_HARD;
    if (all_have_one_shift(&finer))
        return FLAT_UNPROVEN;
    OneShift local = find_local_shift(&finer);
    if (local == ONE_SHIFT && sets_have_shifts(&finer))
        return FLAT_UNPROVEN;
    return local == SEAM ? FLAT_SEAM : FLAT_THIN;
}

double flat_largest_slack(const FlatPieces *pieces)
{
    double largest = 0;
    for (size_t i = 0; i < pieces->count; i++)
        largest = max2(largest, largest_of(pieces->slack[i]));
    return largest;
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
