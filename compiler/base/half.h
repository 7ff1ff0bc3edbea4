/*
 * half.h: numbers of half precision, IEEE 754 binary16.
 */
#ifndef KRS_HALF_H
#define KRS_HALF_H

#include <stdint.h>

/* These return the nearest half-precision number, ties to even.  Finite numbers beyond the largest
   half become 65504, that half.  So a very bright pixel does not become infinite, which no filter
   survives.  Infinities and NaN stay as they are. */
uint16_t half_from_float(float number);
float    float_from_half(uint16_t half);

#endif
