/*
 * half.c: numbers of half precision, IEEE 754 binary16.
 */
#include "compiler/base/half.h"

#include <math.h>
#include <string.h>

uint16_t half_from_float(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    uint32_t size = bits & 0x7fffffff;
    if (size > 0x7f800000)
        return sign | 0x7e00; /* NaN, quiet */
    if (size == 0x7f800000)
        return sign | 0x7c00;
    if (size >= 0x477ff000)
        return sign | 0x7bff; /* would round to more than 65504 */
    if (size < 0x33000001)
        return sign; /* up to half of the smallest half, 2^-25, rounds to zero */

    /* `kept` is the result, rounded down; `lost` is the rest, in fractions of `unit`. */
    uint32_t kept, lost, unit;
    if (size < 0x38800000) { /* the result is subnormal: the leading 1 becomes explicit */
        uint32_t shift    = 126 - (size >> 23);
        uint32_t fraction = (size & 0x7fffff) | 0x800000;
        kept              = fraction >> shift;
        unit              = 1u << shift;
        lost              = fraction & (unit - 1);
    } else {
        kept = (size - 0x38000000) >> 13;
        unit = 1u << 13;
        lost = size & (unit - 1);
    }
    if (lost > unit / 2 || (lost == unit / 2 && (kept & 1)))
        kept++;
    return (uint16_t)(sign | kept);
}

float float_from_half(uint16_t half)
{
    int   exponent = half >> 10 & 31;
    float fraction = half & 0x3ff, size;
    if (exponent == 31)
        size = fraction > 0 ? NAN : INFINITY;
    else
        size = exponent ? ldexpf(fraction + 1024, exponent - 25) : ldexpf(fraction, -24);
    return half & 0x8000 ? -size : size;
}
