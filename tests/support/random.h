/*
 * random.h: random numbers that are the same on every machine.
 */
#ifndef SUPPORT_RANDOM_H
#define SUPPORT_RANDOM_H

#include <stdint.h>

/* Zero it, or give it a seed: any state is a valid start. */
typedef struct Random {
    uint64_t state;
} Random;

uint64_t random_bits(Random *random);
double   random_between(Random *random, double low, double high);
/* From 0 to count - 1. */
int random_below(Random *random, int count);
/* A point of the cube around the origin with sides of twice this length. */
void random_vector(Random *random, double size, double v[3]);

#endif
