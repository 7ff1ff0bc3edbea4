/*
 * bits.h: bits of numbers.
 */
#ifndef KRS_BITS_H
#define KRS_BITS_H

#include <stdint.h>

/* Returns the place of the lowest bit that is 1; there is one. */
static inline uint32_t lowest_bit(uint64_t bits) { return (uint32_t)__builtin_ctzll(bits); }

#endif
