/*
 * rooms.h: scenes for the oracle of light, each as a text of krs and as what is inside of it.
 *
 * A room has up to four numbers, which its text knows as parameters `a` to `d`, so that it is
 * compiled once and lit many times.
 */
#ifndef ORACLE_ROOMS_H
#define ORACLE_ROOMS_H

#include "tests/oracle/brute.h"

enum { ROOM_NUMBERS = 4 };

typedef struct Range {
    double low, high;
} Range;

typedef struct Room {
    const char *name, *text;
    /* Negative inside of the solids, and never farther from 0 than the surface is away. */
    double (*bound)(Vec p, const double numbers[ROOM_NUMBERS]);
    Range  numbers[ROOM_NUMBERS];
    Vec    eye, target;
    double fov;  /* vertical, in degrees */
    bool   lamp; /* its light has a place, else it is a sun, to which these are directions */
    Vec    light_low, light_high;
    Range  wide; /* radius of a lamp; angular diameter of a sun, in degrees */
} Room;

enum { ROOMS = 18 };
extern const Room rooms[ROOMS];

#endif
