/*
 * montecarlo.h: the light of a room, by rays to points of its light chosen at random, in double
 * precision.
 *
 * Rays are marched by the room's own bounds and end where they are inside, to 1e-9.  Light is that
 * of a white surface of roughness 1: Lambert below a GGX coat (docs/language.md, Looks).  A light
 * that has a size is seen as a disc across the direction to its middle; what is seen of it is the
 * share of the disc, and all of it shines as its middle does.
 */
#ifndef ORACLE_MONTECARLO_H
#define ORACLE_MONTECARLO_H

#include "tests/oracle/exact.h"
#include "tests/oracle/rooms.h"

/* A room, lit. */
typedef struct Setting {
    const Room *room;
    double      numbers[ROOM_NUMBERS];
    Vec         light; /* towards it, or its place */
    double      wide;  /* its angle in radians, or its radius */
} Setting;

/* What a ray of the picture finds. */
typedef struct Seen {
    bool   hit;
    Vec    point, normal;
    double light;   /* without shadows; that of a light of intensity 1 */
    double visible; /* the part of the light that is seen */
} Seen;

/* Chooses a setting at random. */
Setting setting_choose(const Room *room, Random *random);

/* With `rays` to points of the light, which divide its disc evenly, turned at random. */
Seen see(const Setting *setting, Line ray, int rays, Random *random);

/* Returns how open a place is whose normal is this: the part of the hemisphere, by the cosine, in
   which there is nothing; of directions that fall, up to this reach. */
double openness(const Setting *setting, Vec point, Vec normal, double reach, int rays,
                Random *random);

#endif
