/*
 * exact.h: sums that do not depend on the order of their terms.
 *
 * Floats are rounded to multiples of 2^-80 of at most 2^36, and these are added as integers.  What is rounded is
 * below 1e-24, and no picture tells what is above 2^36 from infinite.  Since terms are added without an error, the sum of
 * parts' sums is that of all terms.
 */
#ifndef KRS_EXACT_H
#define KRS_EXACT_H

#include <stdint.h>

/* high * 2^-16 + low * 2^-80; the lowest of all numbers: one term was not a number. */
typedef struct Exact {
    uint64_t low;
    int64_t  high;
} Exact;

Exact exact_of(float number);
Exact exact_sum(Exact a, Exact b);
/* Returns the nearest float. */
float exact_float(Exact number);

#endif
