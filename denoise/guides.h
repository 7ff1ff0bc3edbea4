/*
 * guides.h: how alike two pixels are by their guides.
 */
#ifndef KRS_DENOISE_GUIDES_H
#define KRS_DENOISE_GUIDES_H

#include "denoise/tile.h"

static inline float larger(float a, float b) { return a > b ? a : b; }

static inline float square_between(const Guide *guide, size_t i, size_t q)
{
    const float a = guide->at[0][i] - guide->at[0][q], b = guide->at[1][i] - guide->at[1][q],
                c = guide->at[2][i] - guide->at[2][q];
    return a * a + b * b + c * c;
}

/* Returns how far the place of one pixel is from the plane of the surface at another. */
static inline float off_plane(const Tile *tile, size_t i, size_t q, float dx, float dy)
{
    const float x = tile->place.at[0][q] - tile->place.at[0][i],
                y = tile->place.at[1][q] - tile->place.at[1][i],
                z = tile->place.at[2][q] - tile->place.at[2][i];
    return tile->by_depth
               ? z - tile->slope[0][i] * dx - tile->slope[1][i] * dy
               : x * tile->normal.at[0][i] + y * tile->normal.at[1][i] + z * tile->normal.at[2][i];
}

/* Returns the largest squared difference of guides, each by its scale. */
static inline float guide_distance(const Tile *tile, size_t i, size_t q, float dx, float dy)
{
    const float normal = square_between(&tile->normal, i, q) * tile->normal.scale[i];
    const float albedo = square_between(&tile->albedo, i, q) * tile->albedo.scale[i];
    const float off    = off_plane(tile, i, q, dx, dy);
    const float most   = larger(off * off * tile->place.scale[i], larger(normal, albedo));
    return most < 1e9f ? most : 1e9f; /* also where it is no number */
}

/* Returns about exp(-distance), and 0 from 8 on. */
static inline float likeness(float distance)
{
    float part = larger(1 - distance * 0.125f, 0);
    part *= part;
    part *= part;
    return part * part;
}

#endif
