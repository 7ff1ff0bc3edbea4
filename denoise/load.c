/*
 * load.c: loads colours, variances and guides of a square of the picture.
 *
 * Outside of the picture stand the pixels of its edge, which have no weight.
 */
#include "denoise/guides.h"

#include <math.h>

/* Differences of guides below these count as none: of normals, of colours of surfaces; in pixels and as a part of the
   depth, from the plane of the surface. */
static const float NORMAL_SCALE = 0.02f, ALBEDO_SCALE = 0.002f, PLACE_SCALE = 9, DEPTH_PART = 1e-6f;
/* Part of a color's square that rounding makes its variance at least. */
static const float ROUNDING = 1e-7f, LEAST_VARIANCE = 1e-12f;
static const float LARGEST_COLOR = 1e9f, LARGEST_GUIDE = 1e12f;

/* Returns the pixel of the picture whose numbers stand at a place of the square. */
static size_t clamped(size_t first, size_t at, size_t count)
{
    const size_t place = first + at; /* plus MARGIN */
    return place < MARGIN ? 0 : place - MARGIN < count ? place - MARGIN : count - 1;
}

static bool is_inside(size_t first, size_t at, size_t count)
{
    return first + at >= MARGIN && first + at - MARGIN < count;
}

static void load_plane(const Tile *tile, const DenoisePlane *plane, float most, Square square)
{
    const DenoisePicture *picture = tile->picture;
    for (size_t y = 0; y < SIDE; y++) {
        const size_t row = clamped(tile->y, y, picture->height) * picture->width;
        for (size_t x = 0; x < SIDE; x++) {
            const size_t pixel   = row + clamped(tile->x, x, picture->width);
            const float  number  = plane->samples ? plane->samples[pixel * plane->stride] : 0;
            square[y * SIDE + x] = fabsf(number) <= most ? number : NAN;
        }
    }
}

/* Loads guides; what is not finite becomes 0. */
static void load_guide(const Tile *tile, const DenoisePlane planes[3], Guide *guide)
{
    for (int k = 0; k < 3; k++) {
        load_plane(tile, &planes[k], LARGEST_GUIDE, guide->at[k]);
        for (size_t i = 0; i < PIXELS; i++)
            guide->at[k][i] = isnan(guide->at[k][i]) ? 0 : guide->at[k][i];
    }
}

static void load_colors(Tile *tile)
{
    for (int k = 0; k < 3; k++)
        load_plane(tile, &tile->picture->color[k], LARGEST_COLOR, tile->color[k]);
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            const size_t i    = y * SIDE + x;
            const bool   good = !isnan(tile->color[0][i] + tile->color[1][i] + tile->color[2][i]);
            tile->known[i]    = good && is_inside(tile->x, x, tile->picture->width) &&
                             is_inside(tile->y, y, tile->picture->height);
            for (int k = 0; k < 3 && !good; k++)
                tile->color[k][i] = 0;
        }
}

/* ---- variances ---- */

/* Returns the variance that colours around a pixel tell, where they are as on a plane but for noise (Immerkaer 1996). */
static float estimate_variance(const Tile *tile, size_t i)
{
    float sum = 0;
    for (int k = 0; k < 3; k++) {
        const float *c    = &tile->color[k][i];
        const float  bent = 4 * c[0] - 2 * (c[-1] + c[1] + c[-SIDE] + c[SIDE]) + c[-SIDE - 1] +
                           c[-SIDE + 1] + c[SIDE - 1] + c[SIDE + 1];
        sum += bent * bent;
    }
    return sum / (3 * 36);
}

static float find_variance(const Tile *tile, const float *deviation, size_t i)
{
    const float known = deviation[i];
    return isnan(known) ? estimate_variance(tile, i) : known * known;
}

/* Returns 1 where guides are even around a pixel, and less where they change: there colours are mixed. */
static float evenness(const Tile *tile, size_t i)
{
    const float normal = NORMAL_SCALE * tile->normal.scale[i];
    const float albedo = ALBEDO_SCALE * tile->albedo.scale[i];
    return normal < albedo ? normal : albedo;
}

/* Makes each variance the mean of those around it that are alike by guides: two halves of a pixel's samples tell little
   of it.  On even ground its own counts if that is more: a single bright pixel is noise there. */
static void smooth_variances(Tile *tile, const Square single)
{
    enum { AROUND = SMOOTH + 1 };
    for (size_t y = AROUND; y < SIDE - AROUND; y++)
        for (size_t x = AROUND; x < SIDE - AROUND; x++) {
            const size_t i   = y * SIDE + x;
            float        sum = 0, count = 0, square = 0;
            for (int dy = -SMOOTH; dy <= SMOOTH; dy++)
                for (int dx = -SMOOTH; dx <= SMOOTH; dx++) {
                    const size_t q    = (size_t)((ptrdiff_t)i + dy * SIDE + dx);
                    const float  part = tile->known[q] *
                                       likeness(guide_distance(tile, i, q, (float)dx, (float)dy));
                    sum += part * single[q];
                    count += part;
                }
            for (int k = 0; k < 3; k++)
                square += tile->color[k][i] * tile->color[k][i] / 3;
            tile->variance[i] = larger(count > 0 ? sum / count : 0, evenness(tile, i) * single[i]) +
                                ROUNDING * square + LEAST_VARIANCE;
        }
}

static void load_variances(Tile *tile)
{
    float *deviation = tile->rows, *single = tile->share;
    if (tile->picture->deviation.samples)
        load_plane(tile, &tile->picture->deviation, LARGEST_COLOR, deviation);
    for (size_t i = 0; i < PIXELS; i++) {
        if (!tile->picture->deviation.samples)
            deviation[i] = NAN;
        single[i]         = 0;
        tile->variance[i] = LEAST_VARIANCE;
    }
    for (size_t y = 1; y < SIDE - 1; y++)
        for (size_t x = 1; x < SIDE - 1; x++)
            single[y * SIDE + x] = find_variance(tile, deviation, y * SIDE + x);
    smooth_variances(tile, single);
}

/* ---- guides ---- */

/* Makes the scales of a guide: where it changes from pixel to pixel, differences of that size count as small.  So a
   pixel of an edge, whose colour is one of both sides, finds others like it on both. */
static void scale_guide(Guide *guide, float least)
{
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            const size_t i    = y * SIDE + x;
            const size_t left = x > 0 ? i - 1 : i, right = x + 1 < SIDE ? i + 1 : i;
            const size_t up = y > 0 ? i - SIDE : i, down = y + 1 < SIDE ? i + SIDE : i;
            const float  change = 0.5f *
                                 (square_between(guide, i, left) + square_between(guide, i, right) +
                                  square_between(guide, i, up) + square_between(guide, i, down));
            guide->scale[i] = 1 / (change > least ? change : least);
        }
}

/* Makes the scales of places: the square of the side of a pixel on the surface. */
static void scale_places(Tile *tile)
{
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            const size_t i       = y * SIDE + x;
            const size_t near[4] = {x > 0 ? i - 1 : i, x + 1 < SIDE ? i + 1 : i,
                                    y > 0 ? i - SIDE : i, y + 1 < SIDE ? i + SIDE : i};
            float least = INFINITY;
            for (int k = 0; k < 4; k++) {
                const float square = square_between(&tile->place, i, near[k]);
                if (square > 0 && square < least)
                    least = square;
            }
            tile->place.scale[i] = least < INFINITY ? 1 / (PLACE_SCALE * least + 1e-30f) : 0;
        }
}

/* Returns how much a depth changes to a neighbour: to the one where it changes less. */
static float slope_of(const float *depth, size_t before, size_t i, size_t after)
{
    const float a = depth[i] - depth[before], b = depth[after] - depth[i];
    return before == i ? b : after == i || fabsf(a) < fabsf(b) ? a : b;
}

static void slope_depths(Tile *tile)
{
    const float *depth = tile->place.at[2];
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            const size_t i  = y * SIDE + x;
            float       *dx = &tile->slope[0][i], *dy = &tile->slope[1][i];
            *dx = slope_of(depth, x > 0 ? i - 1 : i, i, x + 1 < SIDE ? i + 1 : i);
            *dy = slope_of(depth, y > 0 ? i - SIDE : i, i, y + 1 < SIDE ? i + SIDE : i);
            tile->place.scale[i] = 1 / (PLACE_SCALE * (*dx * *dx + *dy * *dy) +
                                        DEPTH_PART * depth[i] * depth[i] + 1e-30f);
        }
}

/* Finds which candidates are in the picture. */
static void find_made(Tile *tile)
{
    const size_t at[2]    = {tile->x, tile->y};
    const size_t count[2] = {tile->picture->width, tile->picture->height};
    for (int k = 0; k < 2; k++) {
        tile->begin[k] = FIRST + (at[k] < RIM ? RIM - at[k] : 0);
        tile->end[k]   = count[k] - at[k] < TILE_SIDE + RIM ? MARGIN + count[k] - at[k]
                                                            : FIRST + MADE;
    }
}

void tile_load(Tile *tile)
{
    const DenoisePicture *picture  = tile->picture;
    const DenoisePlane    depth[3] = {{NULL, 0}, {NULL, 0}, picture->depth};
    find_made(tile);
    load_colors(tile);
    load_guide(tile, picture->normal, &tile->normal);
    load_guide(tile, picture->albedo, &tile->albedo);
    scale_guide(&tile->normal, NORMAL_SCALE);
    scale_guide(&tile->albedo, ALBEDO_SCALE);
    tile->by_depth = !picture->position[0].samples;
    load_guide(tile, tile->by_depth ? depth : picture->position, &tile->place);
    if (tile->by_depth)
        slope_depths(tile);
    else
        scale_places(tile);
    load_variances(tile);
}
