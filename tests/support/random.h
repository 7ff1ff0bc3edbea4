/*
 * random.h: random numbers that are the same on every machine.
 */
#ifndef SUPPORT_RANDOM_H
#define SUPPORT_RANDOM_H

#include <stdint.h>

/* Zero it, or give it a seed. */
typedef struct Random {
    uint64_t state;
} Random;

uint32_t random_bits(Random *random);
double   random_between(Random *random, double low, double high);
uint32_t random_below(Random *random, uint32_t n);

#endif
