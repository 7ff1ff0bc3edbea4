/*
 * flat_shifts.h: finds shifts by which the numbers of half-spaces grow as much as they must.
 */
#ifndef KRS_MESH_FLAT_SHIFTS_H
#define KRS_MESH_FLAT_SHIFTS_H

#include "compiler/field/field.h"
#include "mesh/flat/flat_planes.h"

/* A half-space, or its complement, seen from a box. */
typedef struct FlatGrowth {
    double    normal[3]; /* outwards */
    double    low, high; /* its values in the box */
    FlatSlack slack;
    double    need; /* how much it must grow */
} FlatGrowth;

/* The shortest shift by which some numbers grow as much as they must, and some exactly so: normals
   of the latter are in the span of `normals`, which are orthonormal. */
typedef struct FlatShift {
    double along[3], normals[3][3];
    int    count;
} FlatShift;

typedef struct FlatGrowths {
    FlatGrowth list[MAX_FLATS];
    size_t     count;
    FlatShift  level; /* of length 0; keeps what must not change */
} FlatGrowths;

/* Returns the growth of a half-space, for a sign of 1, or of its complement, for -1. */
FlatGrowth flat_growth(const FlatPieces *pieces, size_t plane, int sign, const Box *box);

/* Demands that a plane does not change, which is exact and has the solid on both sides. */
void flat_growths_level(FlatGrowths *growths, const double normal[3]);

/* Tells whether there is a shift that is no longer than `most`. */
bool flat_has_shift(const FlatGrowths *growths, double most);

#endif
