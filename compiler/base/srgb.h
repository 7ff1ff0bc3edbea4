/*
 * srgb.h: the transfer function of sRGB, IEC 61966-2-1, and its inverse.
 */
#ifndef KRS_SRGB_H
#define KRS_SRGB_H

#include <math.h>

#include "compiler/base/elementary.h"

/* Light that is brighter than white goes on beyond 1. */
static inline double srgb_of_linear(double linear)
{
    if (linear <= 0.0031308)
        return 12.92 * linear;
    return linear == 1 ? 1 : 1.055 * pow(linear, 1 / 2.4) - 0.055; /* a little less for 1 */
}

static inline double linear_of_srgb(double value)
{
    return value <= 0.04045 ? value / 12.92 : real_pow((value + 0.055) / 1.055, 2.4);
}

#endif
