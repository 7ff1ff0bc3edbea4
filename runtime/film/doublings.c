/*
 * doublings.c: exact sums over the samples of a pixel, and its error, which is estimated whenever its samples have doubled.
 */
#include "runtime/film/doublings.h"

#include <math.h>
#include <string.h>

bool doubling_is_due(uint32_t samples)
{
    return samples > SAMPLES_OF_BLOCK && is_power_of_two(samples);
}

static float mean_of(const float v[3]) { return (v[0] + v[1] + v[2]) / 3; }

/* As find_error of noise.comp does for fewer samples. */
void doubling_take(Doubling *doubling, const Exact sums[3], uint32_t count, float floor)
{
    float sum[3], squares[3];
    for (int i = 0; i < 3; i++) {
        sum[i]        = exact_float(sums[i]);
        const float d = (sum[i] - 2 * exact_float(doubling->earlier[i])) / (float)count;
        squares[i]    = d * d;
    }
    doubling->variance = 0.5F * mean_of(squares) + 0.25F * doubling->variance;
    doubling->error    = sqrtf(doubling->variance) / (mean_of(sum) / (float)count + floor);
    memcpy(doubling->earlier, sums, sizeof doubling->earlier);
}

/* ---- as numbers ---- */

static void put(Exact number, uint32_t numbers[4])
{
    const uint64_t words[2] = {number.low, (uint64_t)number.high};
    for (int i = 0; i < 4; i++)
        numbers[i] = (uint32_t)(words[i / 2] >> 32 * (i % 2));
}

static Exact get(const uint32_t numbers[4])
{
    return (Exact){numbers[0] | (uint64_t)numbers[1] << 32,
                   (int64_t)(numbers[2] | (uint64_t)numbers[3] << 32)};
}

void sums_to_numbers(const Exact sums[4], const Doubling *doubling,
                     uint32_t numbers[SUM_AND_NOISE_NUMBERS])
{
    for (size_t i = 0; i < 4; i++)
        put(sums[i], numbers + 4 * i);
    for (size_t i = 0; i < 3; i++)
        put(doubling->earlier[i], numbers + SUM_NUMBERS + 4 * i);
    memcpy(&numbers[SUM_AND_NOISE_NUMBERS - 2], &doubling->variance, sizeof *numbers);
    memcpy(&numbers[SUM_AND_NOISE_NUMBERS - 1], &doubling->error, sizeof *numbers);
}

void sums_of_numbers(const uint32_t numbers[SUM_AND_NOISE_NUMBERS], Exact sums[4],
                     Doubling *doubling)
{
    for (size_t i = 0; i < 4; i++)
        sums[i] = get(numbers + 4 * i);
    for (size_t i = 0; i < 3; i++)
        doubling->earlier[i] = get(numbers + SUM_NUMBERS + 4 * i);
    memcpy(&doubling->variance, &numbers[SUM_AND_NOISE_NUMBERS - 2], sizeof *numbers);
    memcpy(&doubling->error, &numbers[SUM_AND_NOISE_NUMBERS - 1], sizeof *numbers);
}
