/*
 * ranges.c: pictures of some of the samples each, as one picture.
 *
 * Sums are added, and divided by the samples, as a film does it that has all of them.
 */
#include "cli/farm/ranges.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/picture/sample_sums.h"
#include "runtime/film/noise.h"

/* Returns the number of a channel; that of all channels: there is none. */
static size_t find_channel(const Picture *picture, const char *name)
{
    size_t i = 0;
    while (i < picture->channel_count && strcmp(picture->channels[i].name, name) != 0)
        i++;
    return i;
}

static const char *find_text(const Picture *picture, const char *name)
{
    for (size_t i = 0; i < picture->text_count; i++)
        if (strcmp(picture->texts[i].name, name) == 0)
            return picture->texts[i].value;
    return NULL;
}

static bool has_sums(const Picture *picture, size_t from, size_t to)
{
    for (size_t i = from; i < to; i++) {
        const size_t at = find_channel(picture, sum_channels[i]);
        if (at == picture->channel_count || picture->channels[at].type != SAMPLE_UINT)
            return false;
    }
    return true;
}

const char *range_read(const Picture *picture, SampleRange *range)
{
    const char *samples = find_text(picture, SAMPLES_TEXT);
    const char *floor   = find_text(picture, NOISE_FLOOR_TEXT);
    char        more;
    *range = (SampleRange){.divided = samples != NULL};
    if (!samples)
        return NULL;
    if (sscanf(samples, "%u..%u/%u%c", &range->first, &range->last, &range->all, &more) != 3 ||
        range->first > range->last || range->last >= range->all || range->all > KRS_MAX_SAMPLES)
        return SAMPLES_TEXT " is no range of samples";
    if (!has_sums(picture, 0, SUM_NUMBERS))
        return "it has some of the samples, but not their sums";
    range->noise       = floor && has_sums(picture, SUM_NUMBERS, SUM_AND_NOISE_NUMBERS);
    range->noise_floor = floor ? strtof(floor, NULL) : 0;
    return NULL;
}

bool ranges_new(RangeSums *sums, size_t pixels)
{
    sums->sums      = calloc(pixels, sizeof *sums->sums);
    sums->doublings = calloc(pixels, sizeof *sums->doublings);
    return sums->sums && sums->doublings;
}

void ranges_free(RangeSums *sums)
{
    free(sums->sums);
    free(sums->doublings);
    *sums = (RangeSums){NULL, NULL};
}

/* Finds the planes of the numbers of SampleSums; NULL: there is none. */
static void find_planes(const Picture *picture, float *const *planes,
                        float *found[SUM_AND_NOISE_NUMBERS])
{
    for (size_t i = 0; i < SUM_AND_NOISE_NUMBERS; i++) {
        const size_t at = find_channel(picture, sum_channels[i]);
        found[i]        = at < picture->channel_count ? planes[at] : NULL;
    }
}

void ranges_add(RangeSums *sums, size_t pixel, size_t count, const SampleRange *range,
                const Picture *picture, float *const *planes, size_t from, bool begins)
{
    float *found[SUM_AND_NOISE_NUMBERS];
    find_planes(picture, planes, found);
    for (size_t k = 0; k < count; k++) {
        uint32_t  numbers[SUM_AND_NOISE_NUMBERS] = {0};
        Exact     own[4], *all = sums->sums[pixel + k];
        Doubling *doubling = &sums->doublings[pixel + k], earlier;
        for (size_t i = 0; i < SUM_AND_NOISE_NUMBERS; i++)
            if (found[i])
                memcpy(&numbers[i], &found[i][from + k], sizeof *numbers);
        sums_of_numbers(numbers, own, &earlier);
        for (size_t i = 0; i < 4; i++)
            all[i] = exact_sum(all[i], own[i]);
        if (begins)
            *doubling = earlier;
        else if (doubling_is_due(range->last + 1))
            doubling_take(doubling, all, range->last + 1, range->noise_floor);
    }
}

void ranges_finish(const RangeSums *sums, size_t pixels, uint32_t first, uint32_t last, bool noise,
                   const Picture *picture, float *const *planes)
{
    static const char *const colors[4] = {"R", "G", "B", "A"};
    const uint32_t           samples   = last - first + 1;
    const size_t             error     = find_channel(picture, "noise.X");
    const size_t             counts    = find_channel(picture, "samples.X");
    float                   *found[SUM_AND_NOISE_NUMBERS];
    find_planes(picture, planes, found);
    for (size_t k = 0; k < pixels; k++) {
        uint32_t numbers[SUM_AND_NOISE_NUMBERS];
        for (size_t i = 0; i < 4; i++) {
            const size_t at = find_channel(picture, colors[i]);
            if (at < picture->channel_count)
                planes[at][k] = exact_float(sums->sums[k][i]) / (float)samples;
        }
        if (noise && error < picture->channel_count)
            planes[error][k] = noise_since(samples) * sums->doublings[k].error;
        if (noise && counts < picture->channel_count)
            memcpy(&planes[counts][k], &samples, sizeof samples);
        sums_to_numbers(sums->sums[k], &sums->doublings[k], numbers);
        for (size_t i = 0; i < SUM_AND_NOISE_NUMBERS; i++)
            if (found[i])
                memcpy(&found[i][k], &numbers[i], sizeof *numbers);
    }
}
