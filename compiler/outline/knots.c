/*
 * knots.c: a grid with cells of twice the tolerance, in a hash table.
 */
#include "compiler/outline/knots.h"

#include <math.h>

#include "compiler/base/elementary.h"

/* The cells of a small figure far away have larger numbers than integers can be. */
static uint64_t bits_of(double cell) { return (uint64_t)(int64_t)fmod(cell, 0x1p62); }

static size_t slot_of(const Knots *knots, double x, double y)
{
    uint64_t hash = bits_of(x) * 0x9e3779b97f4a7c15u ^ bits_of(y) * 0xc2b2ae3d27d4eb4fu;
    hash ^= hash >> 29;
    return (hash * 0x9e3779b97f4a7c15u >> 20) & (knots->slot_count - 1);
}

static double cell_of(const Knots *knots, double coordinate)
{
    return floor(coordinate / (2 * knots->tolerance));
}

static void put_in_slot(Knots *knots, uint32_t number)
{
    Knot  *knot        = &knots->items[number];
    size_t slot        = slot_of(knots, cell_of(knots, knot->at[0]), cell_of(knots, knot->at[1]));
    knot->next         = knots->slots[slot];
    knots->slots[slot] = number + 1;
}

static void grow(Knots *knots)
{
    knots->slot_count = knots->slot_count ? 2 * knots->slot_count : 256;
    knots->slots      = arena_new_array(knots->arena, uint32_t, knots->slot_count);
    for (uint32_t i = 0; i < knots->count; i++)
        put_in_slot(knots, i);
}

static uint32_t find_in_cell(const Knots *knots, double x, double y, const double point[2])
{
    uint32_t number = knots->slots[slot_of(knots, x, y)];
    for (; number; number = knots->items[number - 1].next) {
        const double *at = knots->items[number - 1].at;
        if (real_hypot(at[0] - point[0], at[1] - point[1]) <= knots->tolerance)
            break;
    }
    return number;
}

uint32_t knot_at(Knots *knots, const double point[2])
{
    if (2 * knots->count >= knots->slot_count)
        grow(knots);
    double x = cell_of(knots, point[0]), y = cell_of(knots, point[1]);
    for (int i = -1; i <= 1; i++)
        for (int k = -1; k <= 1; k++) {
            uint32_t found = find_in_cell(knots, x + i, y + k, point);
            if (found)
                return found - 1;
        }
    Knot knot = {.at = {point[0], point[1]}};
    array_push_large(knots->arena, knots, knot);
    put_in_slot(knots, (uint32_t)knots->count - 1);
    return (uint32_t)knots->count - 1;
}
