/*
 * regions.c: what is needed only where a guard does not decide.
 *
 * Nodes are visited from the last to the first, users before operands: a node is in the innermost
 * region that holds all of its users, where a guard uses its rest from within its own region.
 */
#include "compiler/graph/regions.h"

#include <string.h>

static uint32_t common(const Regions *regions, uint32_t a, uint32_t b)
{
    const Region *items = regions->list.items;
    while (a != b) {
        if (items[a].depth >= items[b].depth)
            a = items[a].parent;
        else
            b = items[b].parent;
    }
    return a;
}

static void add_use(Regions *regions, Node node, uint32_t from)
{
    uint32_t *of = &regions->of[node];
    *of          = *of == NO_REGION ? from : common(regions, *of, from);
}

static uint32_t open_region(Regions *regions, Node guard, Arena *arena)
{
    uint32_t parent = regions->of[guard];
    Region   region = {guard, parent, regions->list.items[parent].depth + 1, NODE_NONE};
    array_push(arena, &regions->list, region);
    return (uint32_t)regions->list.count - 1;
}

void graph_regions(Regions *regions, const Graph *graph, const Node *roots, size_t root_count,
                   Arena *arena)
{
    enum { REST = 2 };
    Region always = {.guard = NODE_NONE, .first = NODE_NONE};
    if (!regions->of) {
        regions->of   = arena_new_array(arena, uint32_t, graph->count + 1);
        regions->body = arena_new_array(arena, uint32_t, graph->count + 1);
        regions->next = arena_new_array(arena, Node, graph->count + 1);
    }
    memset(regions->of, 0xff, graph->count * sizeof *regions->of);
    memset(regions->body, 0xff, graph->count * sizeof *regions->body);
    regions->list.count = 0;
    array_push(arena, &regions->list, always);
    for (size_t i = 0; i < root_count; i++)
        regions->of[roots[i]] = REGION_ALWAYS;
    for (Node node = (Node)graph->count; node-- > 0;) {
        const Expr *e  = &graph->items[node];
        uint32_t    of = regions->of[node];
        if (of == NO_REGION || e->time != TIME_POINT)
            continue;
        regions->next[node]           = regions->list.items[of].first;
        regions->list.items[of].first = node;
        if (e->op == OP_guard)
            regions->body[node] = open_region(regions, node, arena);
        for (int i = 0; i < e->operand_count; i++)
            add_use(regions, e->operands[i],
                    e->op == OP_guard && i == REST ? regions->body[node] : of);
    }
}
