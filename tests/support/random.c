/*
 * random.c: a linear congruence, its high bits stirred into the low ones.
 */
#include "tests/support/random.h"

uint32_t random_bits(Random *random)
{
    random->state = random->state * 6364136223846793005u + 1442695040888963407u;
    uint64_t x    = random->state;
    x ^= x >> 33;
    x *= 0xff51afd7ed558ccdu;
    return (uint32_t)(x >> 32);
}

double random_between(Random *random, double low, double high)
{
    return low + (high - low) * (random_bits(random) / 4294967295.0);
}

uint32_t random_below(Random *random, uint32_t n) { return random_bits(random) % n; }
