/*
 * random.c: SplitMix64 (Steele, Lea and Flood 2014).
 */
#include "tests/support/random.h"

uint64_t random_bits(Random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z          = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double random_between(Random *random, double low, double high)
{
    return low + (high - low) * (double)(random_bits(random) >> 11) * 0x1p-53;
}

int random_below(Random *random, int count) { return (int)random_between(random, 0, count); }

void random_vector(Random *random, double size, double v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = random_between(random, -size, size);
}
