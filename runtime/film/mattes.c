/*
 * mattes.c: counts rays by what they hit.
 *
 * Each pixel has room for a few parts.  What comes later than these is not counted: a pixel that
 * shows more of them is a mixture of all anyway.
 */
#include "runtime/film/mattes.h"

#include <string.h>

static size_t entries_of(const KrsPicture *picture)
{
    return (size_t)picture->window.width * picture->window.height * KRS_MATTE_RANKS;
}

bool mattes_new(Gpu *gpu, KrsPicture *picture)
{
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++) {
        picture->mattes[kind] = gpu_alloc(gpu, entries_of(picture), sizeof(KrsMatte),
                                          "count rays for mattes");
        if (!picture->mattes[kind])
            return false;
        picture->stats.peak_memory_bytes += entries_of(picture) * sizeof(KrsMatte);
    }
    return true;
}

static void count_ray(KrsPicture *picture, KrsMatteKind kind, size_t pixel, uint32_t part,
                      uint32_t instance)
{
    KrsMatte *entries = &picture->mattes[kind][pixel * KRS_MATTE_RANKS];
    for (int i = 0; i < KRS_MATTE_RANKS; i++) {
        KrsMatte *entry = &entries[i];
        if (entry->rays == 0)
            *entry = (KrsMatte){part, instance, 0};
        if (entry->part == part && entry->instance == instance) {
            entry->rays++;
            return;
        }
    }
}

/* Returns a number of results that is an integer: its bits are there. */
static uint32_t bits_at(const float *results, size_t row_pixels, uint32_t row, size_t pixel,
                        size_t number)
{
    uint32_t bits;
    memcpy(&bits, &results[(row * row_pixels + pixel) * RESULT_NUMBERS + number], sizeof bits);
    return bits;
}

void mattes_take(KrsPicture *picture, const float *results, size_t row_pixels, size_t first,
                 size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const uint32_t component = bits_at(results, row_pixels, ROW_NORMALS, k, 3);
        const uint32_t instance  = bits_at(results, row_pixels, ROW_COUNTS, k, 0);
        const uint32_t material  = bits_at(results, row_pixels, ROW_COUNTS, k, 2);
        if (component == 0 ||
            (picture->noise && bits_at(results, row_pixels, ROW_NOISE, k, 1) != 0))
            continue; /* it hits nothing, or the samples of the pixel have ended */
        count_ray(picture, KRS_MATTE_COMPONENTS, first + k, component, 0);
        count_ray(picture, KRS_MATTE_INSTANCES, first + k, component, instance);
        count_ray(picture, KRS_MATTE_MATERIALS, first + k, material, 0);
    }
}

void mattes_clear(KrsPicture *picture)
{
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        if (picture->mattes[kind])
            memset(picture->mattes[kind], 0, entries_of(picture) * sizeof(KrsMatte));
}

/* Sorts by insertion, the most covered first; equal ones stay in the order in which they were
   hit. */
static void sort_entries(KrsMatte entries[KRS_MATTE_RANKS])
{
    for (int i = 1; i < KRS_MATTE_RANKS; i++) {
        KrsMatte entry = entries[i];
        int      at    = i;
        for (; at > 0 && entries[at - 1].rays < entry.rays; at--)
            entries[at] = entries[at - 1];
        entries[at] = entry;
    }
}

void mattes_sort(KrsPicture *picture)
{
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        for (size_t i = 0; picture->mattes[kind] && i < entries_of(picture); i += KRS_MATTE_RANKS)
            sort_entries(&picture->mattes[kind][i]);
}
