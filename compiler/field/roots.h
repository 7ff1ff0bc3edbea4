/*
 * roots.h: where the sign changes on edges, found for many at once.
 */
#ifndef KRS_FIELD_ROOTS_H
#define KRS_FIELD_ROOTS_H

#include "compiler/field/field.h"

/* A search for the place on an edge where the sign changes; values at the ends. */
typedef struct RootSearch {
    double from[3], along[3], length;
    double low, high, at_low, at_high, middle;
    int    side;
    bool   done;
} RootSearch;

/* Finds up to MAX_FIELD_POINTS roots, until they are between `low` and `high` that are so near to
   each other. */
void find_roots(const MeshField *field, RootSearch *searches, size_t count, double enough);

#endif
