/*
 * minmax.h: the lesser and the greater of two numbers, as fmin and fmax have them, without a call.
 *
 * Compilers call the C library for those, since one operand may not be a number: then it is the other.
 */
#ifndef KRS_MINMAX_H
#define KRS_MINMAX_H

static inline double min2(double a, double b) { return b != b || a < b ? a : b; }
static inline double max2(double a, double b) { return b != b || a > b ? a : b; }

#endif
