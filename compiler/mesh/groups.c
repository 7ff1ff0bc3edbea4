/* groups.c: things are sorted by the cell that they are in. */
#include "compiler/mesh/groups.h"

#include <math.h>
#include <string.h>

enum { ALL_CELLS = GROUP_CELLS * GROUP_CELLS * GROUP_CELLS };

void groups_clear(Groups *groups)
{
    groups->numbers.count = groups->cells.count = groups->order.count = groups->list.count = 0;
}

void groups_add(Groups *groups, uint32_t number, const double at[3])
{
    uint32_t cell = 0;
    for (int k = 0; k < 3; k++)
        cell = cell * GROUP_CELLS + (uint32_t)fmin(fmax(at[k] * GROUP_CELLS, 0), GROUP_CELLS - 1);
    array_push_large(groups->arena, &groups->numbers, number);
    array_push_large(groups->arena, &groups->cells, cell);
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
    uint32_t *begins = groups->begins;
    memset(begins, 0, sizeof groups->begins);
    for (size_t i = 0; i < count; i++) {
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
