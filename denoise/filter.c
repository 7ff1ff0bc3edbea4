/*
 * filter.c: candidates for the colours of a tile: means over pixels that are alike (non-local means).
 *
 * One offset after the other, all pixels are compared with those at that offset (Rousselle, Manzi and Zwicker 2013).
 * Sums are always over the same pixels in the same order, so they do not depend on tiles.
 */
#include "denoise/guides.h"

#include <string.h>

typedef struct Filter {
    float color, guides; /* 1 over the square of what may differ; 0: it does not count */
    int   patch;
} Filter;

#define PER_SQUARE(k) ((k) > 0 ? 1 / ((k) * (k) + 1e-30f) : 0)
static const Filter filters[FILTERS] = {
#define FILTER(id, color, patch, guides) {PER_SQUARE(color), PER_SQUARE(guides), patch},
#include "denoise/filters.def"
#undef FILTER
};

static float smaller(float a, float b) { return a < b ? a : b; }

/* Compares the colours of pixels of a row with those at an offset: squares of differences beyond those that noise
   makes, by their variance. */
static void compare_colors(Tile *tile, size_t first, size_t count, ptrdiff_t offset)
{
    const float *restrict c0 = &tile->color[0][first], *restrict c1 = &tile->color[1][first],
                          *restrict c2 = &tile->color[2][first];
    const float *restrict v = &tile->variance[first], *restrict known = &tile->known[first];
    float *restrict distance = &tile->distance[first], *restrict share = &tile->share[first];
    for (size_t i = 0; i < count; i++) {
        const float *q0 = c0 + offset, *q1 = c1 + offset, *q2 = c2 + offset;
        const float  a = c0[i] - q0[i], b = c1[i] - q1[i], c = c2[i] - q2[i];
        const float  other = v[i + (size_t)offset], both = 1 / (v[i] + other);
        const float  square = (a * a + b * b + c * c) * (1.0f / 3);
        share[i]            = both;
        distance[i]         = known[i] * known[i + (size_t)offset] *
                      (square - v[i] - smaller(v[i], other)) * both;
    }
}

/* Adds up distances of patches: first along rows. */
static void add_rows(const Tile *tile, int patch, const float *distance, float *restrict rows)
{
    for (size_t y = tile->begin[1] - PATCH; y < tile->end[1] + PATCH; y++)
        for (size_t x = tile->begin[0]; x < tile->end[0]; x++) {
            const float *at  = &distance[y * SIDE + x];
            float        sum = at[0];
            for (int k = 1; k <= patch; k++)
                sum += at[-k] + at[k];
            rows[y * SIDE + x] = sum;
        }
}

static void add_columns(const Tile *tile, int patch, const float *rows, float *restrict patches)
{
    const float part = 1 / (float)((2 * patch + 1) * (2 * patch + 1));
    for (size_t y = tile->begin[1]; y < tile->end[1]; y++)
        for (size_t x = tile->begin[0]; x < tile->end[0]; x++) {
            const float *at  = &rows[y * SIDE + x];
            float        sum = at[0];
            for (int k = 1; k <= patch; k++)
                sum += at[-k * SIDE] + at[k * SIDE];
            patches[y * SIDE + x] = sum * part;
        }
}

static void compare_guides(Tile *tile, size_t first, size_t count, int dx, int dy)
{
    const size_t offset = (size_t)(dy * SIDE + dx);
    for (size_t i = first; i < first + count; i++)
        tile->guides[i] = guide_distance(tile, i, i + offset, (float)dx, (float)dy);
}

/* Adds the pixels at an offset to the sums of pixels of a row. */
static void add_pixels(Tile *tile, int number, size_t first, size_t count, size_t offset)
{
    const Filter *filter    = &filters[number];
    Candidate    *candidate = &tile->candidates[number];
    const float   slope     = 2 * filter->color /
                        (3 * (float)((2 * filter->patch + 1) * (2 * filter->patch + 1)));
    const float *patches = tile->patches[filter->patch];
    for (size_t i = first; i < first + count; i++) {
        const size_t q      = i + offset;
        const float  color  = patches[i] * filter->color;
        const float  guides = tile->guides[i] * filter->guides;
        const float  weight = likeness(larger(larger(color, guides), 0)) * tile->known[q];
        const float  steep  = color > guides && color > 0 ? weight * slope * tile->share[i] : 0;
        candidate->weight[i] += weight;
        for (int k = 0; k < 3; k++) {
            const float c = tile->color[k][q], more = steep * (c - tile->color[k][i]);
            candidate->color[k][i] += weight * c;
            candidate->slope[k][i] += more;
            candidate->slope_square[i] += more * c;
        }
    }
}

static void add_offset(Tile *tile, int dx, int dy)
{
    const ptrdiff_t offset = dy * SIDE + dx;
    const size_t    x = tile->begin[0], count = tile->end[0] - x;
    bool            made[PATCH + 1] = {false};
    for (size_t y = tile->begin[1] - PATCH; y < tile->end[1] + PATCH; y++)
        compare_colors(tile, y * SIDE + x - PATCH, count + 2 * PATCH, offset);
    for (size_t y = tile->begin[1]; y < tile->end[1]; y++)
        compare_guides(tile, y * SIDE + x, count, dx, dy);
    for (int k = 0; k < FILTERS; k++) {
        const int patch = filters[k].patch;
        if (!made[patch]) {
            add_rows(tile, patch, tile->distance, tile->rows);
            add_columns(tile, patch, tile->rows, tile->patches[patch]);
        }
        made[patch] = true;
        for (size_t y = tile->begin[1]; y < tile->end[1]; y++)
            add_pixels(tile, k, y * SIDE + x, count, (size_t)offset);
    }
}

/* Divides the sums of a pixel by its weights, and estimates the error of the result (Stein's unbiased risk
   estimate): how far it is from the colour, less what noise makes of that. */
static void finish_pixel(const Tile *tile, Candidate *candidate, size_t i)
{
    const float variance = tile->variance[i], all = candidate->weight[i];
    const float part   = all > 0 ? 1 / all : 0;
    float       square = 0, slope = 3 * tile->known[i] + candidate->slope_square[i];
    for (int k = 0; k < 3; k++) {
        const float mean = candidate->color[k][i] * part, change = mean - tile->color[k][i];
        slope -= mean * candidate->slope[k][i];
        square += change * change;
        candidate->color[k][i] = mean;
    }
    candidate->error[i] = all > 0 ? square / 3 - variance + 2 * variance * slope * part / 3 : 1e18f;
}

void tile_filter(Tile *tile)
{
    memset(tile->candidates, 0, sizeof tile->candidates);
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++)
            add_offset(tile, dx, dy);
    for (int k = 0; k < FILTERS; k++)
        for (size_t y = tile->begin[1]; y < tile->end[1]; y++)
            for (size_t x = tile->begin[0]; x < tile->end[0]; x++)
                finish_pixel(tile, &tile->candidates[k], y * SIDE + x);
}
