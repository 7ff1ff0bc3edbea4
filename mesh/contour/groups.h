/*
 * groups.h: sorts the numbers of items by their locations into groups of neighbours.
 *
 * Threads take one group after the other, and prune the scene once for each.
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
/* Adds an item; the coordinates `at` are from 0 to 1. */
void groups_add(Groups *groups, uint32_t number, const double at[3]);
/* Makes groups of what was added. */
void groups_finish(Groups *groups);

#endif
