/*
 * flat_ways.h: ways on which the numbers of half-spaces grow as much as they must.
 */
#ifndef KRS_MESH_FLAT_WAYS_H
#define KRS_MESH_FLAT_WAYS_H

#include "compiler/field/field.h"
#include "mesh/flat/flat_planes.h"

/* A half-space, or its complement, from the places of a box. */
typedef struct FlatGrowth {
    double    normal[3]; /* outwards */
    double    low, high; /* its values in the box */
    FlatSlack slack;
    double    need; /* how much it must grow */
} FlatGrowth;

/* The shortest way on which some half-spaces grow as much as they must, and some exactly so: these have normals within the
   span of those here, which are at right angles to each other. */
typedef struct FlatWay {
    double along[3], normals[3][3];
    int    count;
} FlatWay;

typedef struct FlatGrowths {
    FlatGrowth list[MAX_FLATS];
    size_t     count;
    FlatWay    level; /* of length 0; what must not change at all does not */
} FlatGrowths;

/* A half-space by a sign of 1, its complement by -1. */
FlatGrowth flat_growth(const FlatPieces *pieces, size_t plane, int sign, const Box *box);

/* What is exact and has the solid on both sides must not change at all. */
void flat_growths_level(FlatGrowths *growths, const double normal[3]);

/* Tells whether there is one, no longer than that. */
bool flat_has_way(const FlatGrowths *growths, double most);

#endif
