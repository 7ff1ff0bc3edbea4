/*
 * pixels.c: which part is seen at each pixel.
 */
#include "profile/pixels.h"

#include <math.h>

/* Depths that differ by more than this part are those of other surfaces. */
static const double SAME_DEPTH = 1e-3;

Pixels pixels_new(size_t count, const Parts *parts, Arena *arena)
{
    Pixels pixels = {count, arena_new_array(arena, size_t, count + 1),
                     arena_new_array(arena, size_t, parts->count + 1),
                     arena_new_array(arena, size_t, parts->count + 1)};
    for (size_t i = 0; i < count; i++)
        pixels.part[i] = NO_PART;
    for (size_t i = 0; i < parts->count; i++) {
        const size_t parent = parts->items[i].parent;
        pixels.depth[i]     = parent == NO_PART ? 0 : pixels.depth[parent] + 1;
    }
    return pixels;
}

static bool is_changed(const KrsPicture *whole, const KrsPicture *without, size_t at)
{
    const double depth = whole->depth[at];
    return isfinite(depth) && !(fabs(without->depth[at] - depth) <= SAME_DEPTH * fabs(depth));
}

static bool takes_from(const Pixels *pixels, size_t part, size_t other)
{
    if (other == NO_PART || pixels->depth[part] != pixels->depth[other])
        return other == NO_PART || pixels->depth[part] > pixels->depth[other];
    return pixels->changed[part] <= pixels->changed[other];
}

void pixels_take(Pixels *pixels, const KrsPicture *whole, const KrsPicture *without, size_t part)
{
    size_t changed = 0;
    for (size_t i = 0; i < pixels->count; i++)
        changed += is_changed(whole, without, i);
    pixels->changed[part] = changed;
    for (size_t i = 0; i < pixels->count; i++)
        if (is_changed(whole, without, i) && takes_from(pixels, part, pixels->part[i]))
            pixels->part[i] = part;
}

/* Returns the row from 1 of a part, or of the nearest around it that has one. */
static uint32_t row_of(const Parts *parts, const Profile *profile, size_t part)
{
    for (; part != NO_PART; part = parts->items[part].parent)
        for (size_t row = 0; row < profile->row_count; row++)
            if (profile->rows[row].part == &parts->items[part])
                return (uint32_t)row + 1;
    return 0;
}

/* Returns the heir of a part: it gets the pixels that no other part in it has. */
static size_t heir_of(const Parts *parts, const PartProfile *found, size_t part)
{
    for (size_t i = part + 1; i < parts->count; i++)
        if (parts->items[i].parent == part && found[i].heir)
            return heir_of(parts, found, i);
    return part;
}

uint32_t *pixels_rows(const Pixels *pixels, const Parts *parts, const PartProfile *found,
                      const Profile *profile, Arena *arena)
{
    uint32_t *rows = arena_new_array(arena, uint32_t, pixels->count + 1);
    uint32_t *of   = arena_new_array(arena, uint32_t, parts->count + 1);
    for (size_t part = 0; part < parts->count; part++)
        of[part] = row_of(parts, profile, heir_of(parts, found, part));
    for (size_t i = 0; i < pixels->count; i++)
        rows[i] = pixels->part[i] == NO_PART ? 0 : of[pixels->part[i]];
    return rows;
}
