/*
 * batches.h: what is computed of many things that are somewhere in a scene.
 *
 * Those that are near to each other are a group, and the scene is pruned to the box of each group.
 */
#ifndef KRS_MESH_BATCHES_H
#define KRS_MESH_BATCHES_H

#include "compiler/field/field.h"
#include "mesh/contour/groups.h"

/* What is done: `find` for up to MAX_FIELD_POINTS of them, which have a box around each that holds all points
   where it asks the field, but for `margin`; it asks `questions` times for each. */
typedef struct Batches {
    void (*box)(const void *user, size_t number, double low[3], double high[3]);
    void (*find)(const void *user, const MeshField *field, const uint32_t *numbers, size_t count);
    bool (*is_known)(const void *user, size_t number); /* it is left out; NULL: none */
    size_t questions;
} Batches;

/* Where it is done: fields for each part of run_in_parallel, the cube that has all boxes, and room for groups. */
typedef struct BatchPlace {
    MeshField *fields;
    double     origin[3], side, margin;
    Groups    *groups;
} BatchPlace;

/* Numbers `first` to end - 1. */
void batches_find(const BatchPlace *place, const Batches *batches, const void *user, size_t first,
                  size_t end);

#endif
