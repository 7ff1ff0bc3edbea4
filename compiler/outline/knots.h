/*
 * knots.h: points in the plane, of which those nearer to each other than a tolerance are one.
 */
#ifndef KRS_KNOTS_H
#define KRS_KNOTS_H

#include <stdint.h>

#include "compiler/base/arena.h"

typedef struct Knot {
    double   at[2];
    uint32_t next; /* the knot before it in its cell, + 1; 0: there is none */
} Knot;

typedef struct Knots {
    Arena    *arena;
    double    tolerance;
    Knot     *items;
    size_t    count, capacity;
    uint32_t *slots; /* hash table of the cells of a grid: their last knot, + 1 */
    size_t    slot_count;
} Knots;

/* Returns the knot at a point, new if there is none. */
uint32_t knot_at(Knots *knots, const double point[2]);

#endif
