/*
 * doublings.h: exact sums over the samples of a pixel, and its error, which is estimated whenever its samples have doubled.
 */
#ifndef KRS_DOUBLINGS_H
#define KRS_DOUBLINGS_H

#include <stdbool.h>

#include "runtime/film/exact.h"

enum { SAMPLES_OF_BLOCK = 64 }; /* a power of two, as errors are estimated at powers of two */

static inline bool is_power_of_two(uint32_t number) { return (number & (number - 1)) == 0; }

/* What the error of a pixel is estimated from, when its samples have doubled. */
typedef struct Doubling {
    Exact earlier[3]; /* the sums when they had doubled before */
    float variance;   /* as noise.comp has it */
    float error;      /* that was estimated last */
} Doubling;

/* Takes the sums over `count` samples, which are twice as many as before; `floor`: KrsRenderOptions.noise_floor. */
void doubling_take(Doubling *doubling, const Exact sums[3], uint32_t count, float floor);
/* Tells whether errors are estimated by doubling_take at so many samples. */
bool doubling_is_due(uint32_t samples);

/* The sums of a pixel of a film as numbers of 32 bits: of R, G, B and A, each from the lowest bits on, and then, where
   errors are estimated, those of Doubling. */
enum { SUM_NUMBERS = 16, SUM_AND_NOISE_NUMBERS = SUM_NUMBERS + 14 };
void sums_to_numbers(const Exact sums[4], const Doubling *doubling,
                     uint32_t numbers[SUM_AND_NOISE_NUMBERS]);
void sums_of_numbers(const uint32_t numbers[SUM_AND_NOISE_NUMBERS], Exact sums[4],
                     Doubling *doubling);

#endif
