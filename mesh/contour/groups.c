/* groups.c: sorts items by their cells. */
#include "mesh/contour/groups.h"

#include <math.h>
#include <string.h>

#include "compiler/base/minmax.h"

enum { ALL_CELLS = GROUP_CELLS * GROUP_CELLS * GROUP_CELLS };

void groups_clear(Groups *groups)
{
    groups->numbers.count = groups->cells.count = groups->order.count = groups->list.count = 0;
}

void groups_add(Groups *groups, uint32_t number, const double at[3])
{
    uint32_t cell = 0;
    for (int k = 0; k < 3; k++)
        cell = cell * GROUP_CELLS + (uint32_t)min2(max2(at[k] * GROUP_CELLS, 0), GROUP_CELLS - 1);
    array_push_large(groups->arena, &groups->numbers, number);
    array_push_large(groups->arena, &groups->cells, cell);
}

/* Returns how often eight cells are joined to one, so that each has many items: pruning for a group
   costs as much as the whole scene. */
static uint32_t find_joinings(size_t count)
{
    static const size_t THINGS   = 64; /* of each square, were all on one side of the cube */
    uint32_t            joinings = 0;
    for (size_t cells = GROUP_CELLS; cells > 4 && cells * cells / 4 * THINGS >= count; cells /= 2)
        joinings++;
    return joinings;
}

static uint32_t joined(uint32_t cell, uint32_t joinings)
{
    uint32_t z = cell % GROUP_CELLS, y = cell / GROUP_CELLS % GROUP_CELLS,
             x = cell / (GROUP_CELLS * GROUP_CELLS);
    return ((x >> joinings) * GROUP_CELLS + (y >> joinings)) * GROUP_CELLS + (z >> joinings);
}

static void add_groups(Groups *groups, uint32_t first, uint32_t end)
{
    while (first < end) {
        uint32_t count = end - first < LARGEST_GROUP ? end - first : LARGEST_GROUP;
        Group    group = {first, count};
        array_push_large(groups->arena, &groups->list, group);
        first += count;
    }
}

void groups_finish(Groups *groups)
{
    size_t    count  = groups->numbers.count;
    uint32_t *begins = groups->begins, joinings = find_joinings(count);
    memset(begins, 0, sizeof groups->begins);
    for (size_t i = 0; i < count; i++) {
        groups->cells.items[i] = joined(groups->cells.items[i], joinings);
        begins[groups->cells.items[i] + 1]++;
        array_push_large(groups->arena, &groups->order, 0);
    }
    for (int i = 0; i < ALL_CELLS; i++)
        begins[i + 1] += begins[i];
    for (int i = 0; i < ALL_CELLS; i++)
        add_groups(groups, begins[i], begins[i + 1]);
    for (size_t i = 0; i < count; i++)
        groups->order.items[begins[groups->cells.items[i]]++] = groups->numbers.items[i];
}
