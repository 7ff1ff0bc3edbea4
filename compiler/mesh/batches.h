/*
 * batches.h: what is computed of many things of a contour, by where they are.
 *
 * Those that are near to each other are a group, and the scene is pruned to the box of each group.
 */
#ifndef KRS_MESH_BATCHES_H
#define KRS_MESH_BATCHES_H

#include "compiler/mesh/contour.h"

/* What is done: `find` for up to MOST_FIELD_POINTS of them, which have a box around each that holds all points where it asks the
   field; it asks `questions` times for each. */
typedef struct Batches {
    void (*box)(const Contour *contour, size_t number, double low[3], double high[3]);
    void (*find)(const Contour *contour, const MeshField *field, const uint32_t *numbers,
                 size_t count);
    size_t questions;
    bool (*is_known)(const Contour *contour, size_t number); /* it is left out; NULL: none */
} Batches;

/* Numbers `first` to end - 1. */
void contour_batches(Contour *contour, const Batches *batches, size_t first, size_t end);

#endif
