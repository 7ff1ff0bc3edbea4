/*
 * groups.h: numbers of things in the order of where they are, in groups of neighbours.
 *
 * Threads take groups as they come, and prune the scene once for each.
 */
#ifndef KRS_MESH_GROUPS_H
#define KRS_MESH_GROUPS_H

#include "compiler/base/arena.h"

#include <stdint.h>

enum { GROUP_CELLS = 32, LARGEST_GROUP = 256 }; /* cells along a side of the cube */

typedef struct Group {
    uint32_t first, count; /* in `order` */
} Group;

typedef struct Groups {
    Arena *arena;
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } numbers, cells, order;
    struct {
        Group *items;
        size_t count, capacity;
    } list;
    uint32_t begins[GROUP_CELLS * GROUP_CELLS * GROUP_CELLS + 1];
} Groups;

void groups_clear(Groups *groups);
/* `at` is from 0 to 1. */
void groups_add(Groups *groups, uint32_t number, const double at[3]);
/* Puts what was added in order. */
void groups_finish(Groups *groups);

#endif
