/*
 * exact.c: sums that do not depend on the order of their terms, as integers of 128 bits.
 */
#include "runtime/film/exact.h"

#include <math.h>
#include <stdbool.h>

enum {
    MANTISSA = 24,
    FRACTION = 80,
    LARGEST  = 36
}; /* bits of a float and of a fraction; 2^LARGEST */

static const Exact not_a_number = {0, INT64_MIN};

static bool is_number(Exact number) { return number.high != INT64_MIN; }

static Exact negated(Exact number)
{
    const uint64_t high = ~(uint64_t)number.high + (number.low == 0);
    return (Exact){~number.low + 1, (int64_t)high};
}

static Exact shifted(uint64_t mantissa, int by)
{
    if (by <= -64)
        return (Exact){0, 0};
    if (by <= 0)
        return (Exact){mantissa >> -by, 0};
    if (by < 64)
        return (Exact){mantissa << by, (int64_t)(mantissa >> (64 - by))};
    return (Exact){0, (int64_t)(mantissa << (by - 64))};
}

Exact exact_of(float number)
{
    const float most = ldexpf(1, LARGEST);
    int         exponent;
    if (isnan(number))
        return not_a_number;
    const float size   = fminf(fabsf(number), most);
    const float part   = frexpf(size, &exponent);
    const Exact result = shifted((uint64_t)ldexpf(part, MANTISSA), exponent - MANTISSA + FRACTION);
    return number < 0 ? negated(result) : result;
}

Exact exact_sum(Exact a, Exact b)
{
    const uint64_t low = a.low + b.low;
    if (!is_number(a) || !is_number(b))
        return not_a_number;
    return (Exact){low, (int64_t)((uint64_t)a.high + (uint64_t)b.high + (low < a.low))};
}

float exact_float(Exact number)
{
    if (!is_number(number))
        return NAN;
    const bool  negative = number.high < 0;
    const Exact size     = negative ? negated(number) : number;
    uint64_t    top = (uint64_t)size.high, rest = size.low;
    int         by = 64 - FRACTION;
    if (top == 0)
        top = rest, rest = 0, by -= 64;
    while (top != 0 && top >> 63 == 0) { /* as many bits as there are are moved to the front */
        top = top << 1 | rest >> 63;
        rest <<= 1;
        by--;
    }
    const float value = ldexpf((float)(top | (rest != 0)),
                               by); /* the last bit tells of all behind it */
    return negative ? -value : value;
}
