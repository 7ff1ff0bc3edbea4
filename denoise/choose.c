/*
 * choose.c: takes the candidates whose errors are smallest around each pixel.
 *
 * An estimated error is as noisy as the picture, so means of some pixels are compared, and so that no edge is seen where
 * another candidate begins, each pixel is a mean of those that pixels around it have chosen.
 */
#include "denoise/tile.h"

#include <string.h>

enum { NUMBERS = FILTERS + 1 }; /* of candidates, of which the last is the colour as it was */

/* Light to which the error of black pixels is relative. */
static const float DARK = 0.1f;

/* Makes 1 over the square of the brightness around each pixel: errors are as large as they look. */
static void scale_errors(const Tile *tile, Square scale)
{
    for (size_t y = tile->begin[1]; y < tile->end[1]; y++)
        for (size_t x = tile->begin[0]; x < tile->end[0]; x++) {
            float sum = 0, count = 0;
            for (size_t dy = y - CHOICE; dy <= y + CHOICE; dy++)
                for (size_t dx = x - CHOICE; dx <= x + CHOICE; dx++) {
                    const size_t i = dy * SIDE + dx;
                    count += tile->known[i];
                    sum += (tile->color[0][i] + tile->color[1][i] + tile->color[2][i]) / 3;
                }
            const float mean    = count > 0 ? sum / count : 0;
            scale[y * SIDE + x] = 1 / (mean * mean + DARK * DARK);
        }
}

static float error_of(const Tile *tile, int number, size_t i)
{
    return number < FILTERS ? tile->candidates[number].error[i] : tile->variance[i];
}

/* Returns the candidate with the smallest error around a pixel. */
static int best_around(const Tile *tile, size_t x, size_t y)
{
    float sums[NUMBERS] = {0};
    int   best          = 0;
    for (size_t dy = y - CHOICE; dy <= y + CHOICE; dy++)
        for (size_t dx = x - CHOICE; dx <= x + CHOICE; dx++) {
            const size_t i = dy * SIDE + dx;
            if (dx < tile->begin[0] || dx >= tile->end[0] || dy < tile->begin[1] ||
                dy >= tile->end[1])
                continue;
            for (int k = 0; k < NUMBERS; k++)
                sums[k] += tile->known[i] * tile->rows[i] * error_of(tile, k, i);
        }
    for (int k = 1; k < NUMBERS; k++)
        if (sums[k] < sums[best])
            best = k;
    return best;
}

/* Returns the candidate of a pixel whose colour is unknown: the last one for which others are alike. */
static int best_of_unknown(const Tile *tile, size_t i)
{
    int best = FILTERS - 1;
    while (best > 0 && tile->candidates[best].weight[i] == 0)
        best--;
    return best;
}

static void mix_pixel(const Tile *tile, const unsigned char *best, size_t x, size_t y,
                      float result[3])
{
    const size_t at    = y * SIDE + x;
    float        count = 0, shares[NUMBERS] = {0};
    for (size_t dy = y - CHOICE; dy <= y + CHOICE; dy++)
        for (size_t dx = x - CHOICE; dx <= x + CHOICE; dx++)
            if (dx >= tile->begin[0] && dx < tile->end[0] && dy >= tile->begin[1] &&
                dy < tile->end[1]) {
                shares[best[dy * SIDE + dx]]++;
                count++;
            }
    if (tile->known[at] == 0) { /* its neighbours and guides tell what it is */
        memset(shares, 0, sizeof shares);
        shares[best_of_unknown(tile, at)] = count;
    }
    for (int k = 0; k < 3; k++) {
        result[k] = shares[FILTERS] / count * tile->color[k][at];
        for (int n = 0; n < FILTERS; n++)
            result[k] += shares[n] / count * tile->candidates[n].color[k][at];
    }
}

void tile_choose(Tile *tile, float (*result)[3])
{
    const DenoisePicture *picture = tile->picture;
    unsigned char         best[PIXELS];
    scale_errors(tile, tile->rows);
    for (size_t y = tile->begin[1]; y < tile->end[1]; y++)
        for (size_t x = tile->begin[0]; x < tile->end[0]; x++)
            best[y * SIDE + x] = (unsigned char)best_around(tile, x, y);
    for (size_t y = MARGIN; y < MARGIN + TILE_SIDE && tile->y + y - MARGIN < picture->height; y++)
        for (size_t x = MARGIN; x < MARGIN + TILE_SIDE && tile->x + x - MARGIN < picture->width;
             x++)
            mix_pixel(tile, best, x, y,
                      result[(tile->y + y - MARGIN) * picture->width + tile->x + x - MARGIN]);
}
