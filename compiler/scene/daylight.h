/*
 * daylight.h: the clear sky by day and at dusk, from where the sun is and how hazy the air is.
 */
#ifndef KRS_DAYLIGHT_H
#define KRS_DAYLIGHT_H

#include <stdbool.h>

/* The size of its picture of all directions (compiler/shape/sky_map.h), in whose middle the sun is,
   or the place of the horizon that is below or above it. */
enum { DAYLIGHT_WIDTH = 256, DAYLIGHT_HEIGHT = 512 };

typedef struct Daylight {
    double rise;      /* sine of the sun's height above the horizon */
    double turbidity; /* optical thickness of hazy air, in that of pure air: 1 is pure air */
    double ground[3]; /* albedo of what is below the horizon */
} Daylight;

/* Finds the part of the sun's light that reaches the ground. */
void daylight_sun(const Daylight *light, double part[3]);
/* Computes the radiance of the sky, without the sun, that brings the irradiance 1 to the top of the
   air.  False: there is no memory. */
bool daylight_sky(const Daylight *light, float (*texels)[3]);

#endif
