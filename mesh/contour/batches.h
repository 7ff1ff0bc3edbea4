/*
 * batches.h: computes something for each of many items, by groups of neighbours.
 *
 * Items near to each other are a group, and the scene is pruned to the box of each group.
 */
#ifndef KRS_MESH_BATCHES_H
#define KRS_MESH_BATCHES_H

#include "compiler/field/field.h"
#include "mesh/contour/groups.h"

/* The task: `find` takes up to MAX_FIELD_POINTS items.  For each it evaluates the field `questions`
   times, no farther than `margin` from the item's box. */
typedef struct Batches {
    void (*box)(const void *user, size_t number, double low[3], double high[3]);
    void (*find)(const void *user, const MeshField *field, const uint32_t *numbers, size_t count);
    bool (*is_known)(const void *user, size_t number); /* it is left out; NULL: none is */
    size_t questions;
} Batches;

/* The means of the task: fields for each part of run_in_parallel, the cube that has all boxes, and
   room for groups. */
typedef struct BatchContext {
    MeshField *fields;
    double     origin[3], side, margin;
    Groups    *groups;
} BatchContext;

/* Computes items `first` to end - 1. */
void batches_find(const BatchContext *context, const Batches *batches, const void *user,
                  size_t first, size_t end);

#endif
