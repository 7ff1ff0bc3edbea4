/*
 * rows.c: the rows of a profile, whose shares are the whole frame.
 *
 * Times are differences between two frames, so those of parts that share something, or hide something, need not add up.
 * Then shares are smaller than times say, and the times stay as they were measured.
 */
#include "profile/rows.h"

#include <math.h>
#include <stdlib.h>

typedef struct Rows {
    ProfileRow *items;
    size_t      count, capacity;
} Rows;

typedef struct Listing {
    const Parts       *parts;
    const PartProfile *found;
    Arena             *arena;
    double             least; /* milliseconds of a row */
    Rows               rows;
} Listing;

static bool is_worth_a_row(const Listing *l, size_t index)
{
    return l->found[index].timed && l->found[index].ms >= l->least;
}

/* Tells whether a part is in this one, and in no other. */
static bool is_operand(const Listing *l, size_t index, size_t parent)
{
    const Part *part = &l->parts->items[index];
    return part->parent == parent && !part->shared && is_worth_a_row(l, index);
}

void part_cost_subtract(PartCost *cost, const PartCost *other)
{
    cost->flops      = fmax(cost->flops - other->flops, 0);
    cost->operations = fmax(cost->operations - other->operations, 0);
    cost->glsl_bytes = fmax(cost->glsl_bytes - other->glsl_bytes, 0);
}

static void list_part(Listing *l, size_t index, double share);

/* Lists the rows of the parts in one, which has this share of the frame and takes these
   milliseconds.  Leaves what is not theirs. */
static void list_operands(Listing *l, size_t parent, ProfileRow *whole)
{
    double sum = 0;
    for (size_t i = 0; i < l->parts->count; i++)
        if (is_operand(l, i, parent))
            sum += l->found[i].ms;
    const double share_of_ms = whole->share / fmax(fmax(sum, whole->ms), 1e-9);
    for (size_t i = 0; i < l->parts->count; i++)
        if (is_operand(l, i, parent)) {
            list_part(l, i, l->found[i].ms * share_of_ms);
            part_cost_subtract(&whole->cost, &l->found[i].cost);
        }
    whole->share = fmax(whole->share - sum * share_of_ms, 0);
    whole->ms    = fmax(whole->ms - sum, 0);
}

/* Lists a part; what is left of it and too little for a row is among the others. */
static void list_part(Listing *l, size_t index, double share)
{
    const size_t before = l->rows.count;
    ProfileRow   row    = {&l->parts->items[index], false, l->found[index].ms, share,
                           l->found[index].cost};
    list_operands(l, index, &row);
    row.rest = l->rows.count > before;
    if (!row.rest || row.ms >= l->least)
        array_push(l->arena, &l->rows, row);
}

static int compare_rows(const void *a, const void *b)
{
    const ProfileRow *x = a, *y = b;
    return (x->share < y->share) - (x->share > y->share);
}

static bool is_in_shared(const Parts *parts, size_t index)
{
    while (index != NO_PART && !parts->items[index].shared)
        index = parts->items[index].parent;
    return index != NO_PART;
}

/* Tells whether what an heir is cut from is seen as the heir. */
static bool has_heir(const Listing *l, size_t index)
{
    for (size_t i = index + 1; i < l->parts->count; i++)
        if (l->parts->items[i].parent == index && l->found[i].heir && is_worth_a_row(l, i))
            return true;
    return false;
}

/* Lists the rows of parts that are in several others, and of parts in them: others have their time
   already, so these are as they were measured. */
static void list_shared(Listing *l, const Profile *profile)
{
    const size_t first = l->rows.count;
    for (size_t i = 0; i < l->parts->count; i++)
        if (is_in_shared(l->parts, i) && is_worth_a_row(l, i) && !has_heir(l, i)) {
            ProfileRow row = {&l->parts->items[i], false, l->found[i].ms,
                              l->found[i].ms / profile->frame_ms, l->found[i].cost};
            array_push(l->arena, &l->rows, row);
        }
    qsort(l->rows.items + first, l->rows.count - first, sizeof *l->rows.items, compare_rows);
}

void profile_rows(const Parts *parts, const PartProfile *found, Arena *arena, Profile *profile)
{
    Listing    l      = {parts, found, arena, PROFILE_MIN * profile->frame_ms, {0}};
    ProfileRow others = {.ms = profile->frame_ms, .share = 1, .cost = profile->whole};
    ProfileRow whole  = others;
    list_operands(&l, NO_PART, &whole);
    if (l.rows.count > 0)
        qsort(l.rows.items, l.rows.count, sizeof *l.rows.items, compare_rows);
    for (size_t i = 0; i < l.rows.count; i++) {
        others.share -= l.rows.items[i].share;
        others.ms -= l.rows.items[i].ms;
        part_cost_subtract(&others.cost, &l.rows.items[i].cost);
    }
    others.share    = fmax(others.share, 0);
    others.ms       = fmax(others.ms, 0);
    profile->others = l.rows.count;
    array_push(arena, &l.rows, others);
    list_shared(&l, profile);
    profile->rows      = l.rows.items;
    profile->row_count = l.rows.count;
}
