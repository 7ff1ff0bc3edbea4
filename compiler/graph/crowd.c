/*
 * crowd.c: the tables and functions of crowds, and the nodes that name them.
 */
#include "compiler/graph/crowd.h"

#include <assert.h>
#include <string.h>

Crowds *graph_crowds(Graph *graph)
{
    if (!graph->crowds) {
        graph->crowds        = arena_new(graph->arena, Crowds);
        graph->crowds->arena = graph->arena;
    }
    return graph->crowds;
}

uint32_t graph_add_crowd_function(Graph *graph, CrowdFunction function, const Node *bodies)
{
    Crowds *crowds = graph_crowds(graph);
    assert(function.crowd < crowds->tables.count);
    assert(function.state_count > 0 && function.state_count <= MOST_CROWD_STATES);
    function.first_body = (uint32_t)crowds->bodies.count;
    for (uint32_t i = 0; i < function.state_count; i++) {
        assert(graph->items[bodies[i]].type == function.states[i].type);
        array_push(crowds->arena, &crowds->bodies, bodies[i]);
    }
    if (function.joins)
        array_push(crowds->arena, &crowds->bodies, bodies[function.state_count]);
    array_push(crowds->arena, &crowds->functions, function);
    return (uint32_t)crowds->functions.count - 1;
}

/* ---- copies ---- */

static void *copy_items(Arena *arena, const void *items, size_t count, size_t size)
{
    void *copy = arena_alloc(arena, count, size);
    if (count)
        memcpy(copy, items, count * size);
    return copy;
}

#define COPY_ITEMS(arena, items, count) copy_items(arena, items, count, sizeof *(items))

Node *roots_with_bodies(const Graph *graph, const Node *roots, size_t root_count, size_t *count,
                        Arena *arena)
{
    const Crowds *crowds  = graph->crowds;
    size_t        bodies  = crowds ? crowds->bodies.count : 0;
    size_t        numbers = crowds ? crowds->frame_numbers.count : 0;
    *count                = root_count + bodies + numbers;
    Node *all             = arena_new_array(arena, Node, *count + 1);
    for (size_t i = 0; i < root_count; i++)
        all[i] = roots[i];
    for (size_t i = 0; i < bodies; i++)
        all[root_count + i] = crowds->bodies.items[i];
    for (size_t i = 0; i < numbers; i++)
        all[root_count + bodies + i] = crowds->frame_numbers.items[i];
    return all;
}

/* The copy has tables and functions in common; whoever adds some grows it first, since it is full.
   `nodes` are bodies, then frame numbers. */
static Crowds *crowds_with_nodes(const Crowds *crowds, const Node *nodes, Arena *arena)
{
    Crowds *copy                 = arena_new(arena, Crowds);
    *copy                        = *crowds;
    copy->arena                  = arena;
    copy->tables.capacity        = copy->tables.count;
    copy->functions.capacity     = copy->functions.count;
    copy->bodies.capacity        = copy->bodies.count;
    copy->bodies.items           = COPY_ITEMS(arena, nodes, copy->bodies.count);
    copy->frame_numbers.capacity = copy->frame_numbers.count;
    copy->frame_numbers.items    = COPY_ITEMS(arena, nodes + copy->bodies.count,
                                              copy->frame_numbers.count);
    return copy;
}

void hand_on_crowds(Graph *to, const Graph *from, const Node *all, Node *roots, size_t root_count)
{
    for (size_t i = 0; i < root_count; i++)
        roots[i] = all[i];
    to->textures = from->textures;
    if (from->crowds)
        to->crowds = crowds_with_nodes(from->crowds, all + root_count, to->arena);
}

static void keep_grid(Grid *grid, Arena *arena)
{
    size_t cells    = (size_t)grid->cells[0] * grid->cells[1] * grid->cells[2];
    grid->members   = COPY_ITEMS(arena, grid->members, grid->first[cells]);
    grid->first     = COPY_ITEMS(arena, grid->first, cells + 1);
    grid->clearance = COPY_ITEMS(arena, grid->clearance, cells);
    if (grid->tails) {
        grid->tails   = COPY_ITEMS(arena, grid->tails, grid->first[cells]);
        grid->middles = COPY_ITEMS(arena, grid->middles, cells);
    }
}

static void keep_table(Crowd *table, Arena *arena)
{
    bool same = table->cells.first == table->grid.first;
    if (table->arena == arena)
        return;
    table->arena   = arena;
    table->numbers = COPY_ITEMS(arena, table->numbers, (size_t)table->rows * table->columns);
    if (table->bounds)
        table->bounds = COPY_ITEMS(arena, table->bounds, table->rows);
    if (table->boxes)
        table->boxes = COPY_ITEMS(arena, table->boxes, table->rows);
    if (table->places)
        table->places = COPY_ITEMS(arena, table->places, table->rows);
    if (table->arcs)
        table->arcs = COPY_ITEMS(arena, table->arcs, table->rows);
    if (table->frame_columns)
        table->frame_columns = COPY_ITEMS(arena, table->frame_columns, table->columns);
    keep_grid(&table->grid, arena);
    if (same)
        table->cells = table->grid;
    else
        keep_grid(&table->cells, arena);
}

void crowds_keep(Crowds *crowds, Arena *arena)
{
    crowds->arena           = arena;
    crowds->tables.items    = COPY_ITEMS(arena, crowds->tables.items, crowds->tables.count);
    crowds->functions.items = COPY_ITEMS(arena, crowds->functions.items, crowds->functions.count);
    crowds->bodies.items    = COPY_ITEMS(arena, crowds->bodies.items, crowds->bodies.count);
    crowds->frame_numbers.items    = COPY_ITEMS(arena, crowds->frame_numbers.items,
                                                crowds->frame_numbers.count);
    crowds->tables.capacity        = crowds->tables.count;
    crowds->functions.capacity     = crowds->functions.count;
    crowds->bodies.capacity        = crowds->bodies.count;
    crowds->frame_numbers.capacity = crowds->frame_numbers.count;
    for (size_t i = 0; i < crowds->tables.count; i++)
        keep_table(&crowds->tables.items[i], arena);
}

bool crowds_vary(const Crowds *crowds)
{
    for (size_t i = 0; crowds && i < crowds->tables.count; i++)
        if (crowds->tables.items[i].frame_columns || crowds->tables.items[i].places)
            return true;
    return false;
}

bool relocates_along(const Crowd *table, int axis)
{
    for (uint32_t c = 0; c < table->columns; c++)
        if (table->axes[c] == axis + 1)
            return table->relocates;
    return false;
}

const Node *column_nodes(const Crowds *crowds, const Crowd *table, uint32_t column)
{
    assert(column < table->columns);
    if (!table->frame_columns || table->frame_columns[column] == KNOWN_COLUMN)
        return NULL;
    return crowds->frame_numbers.items + table->frame_columns[column];
}

/* ---- nodes ---- */

Node graph_crowd_leaf(Graph *graph, Op op, uint32_t crowd)
{
    static const GraphType types[OP_COUNT] = {[OP_CROWD_POINT]     = TYPE_VEC3,
                                              [OP_CROWD_NORMAL]    = TYPE_VEC3,
                                              [OP_CROWD_FOOTPRINT] = TYPE_FLOAT,
                                              [OP_CROWD_THRESHOLD] = TYPE_FLOAT,
                                              [OP_MEMBER]          = TYPE_UINT};
    assert(types[op] != 0);
    return graph_indexed_leaf(graph, op, types[op], crowd);
}

Node graph_state(Graph *graph, GraphType type, uint32_t function, uint32_t state)
{
    assert(state < MOST_CROWD_STATES);
    return graph_indexed_leaf(graph, OP_STATE, type, function * MOST_CROWD_STATES + state);
}

Node graph_row(Graph *graph, uint32_t crowd, uint32_t column, Node member)
{
    assert(column < MOST_TABLE_COLUMNS);
    Node id = graph_uint(graph, crowd * MOST_TABLE_COLUMNS + column);
    return graph_op2(graph, OP_row, id, member);
}

Node graph_crowd(Graph *graph, Op op, uint32_t function, Node point)
{
    Node number = graph_uint(graph, function);
    return graph_op2(graph, op, number, point);
}

Node graph_crowd_surface(Graph *graph, Op op, uint32_t function, Node point, Node normal,
                         Node footprint, Node threshold)
{
    Node number = graph_uint(graph, function);
    Node pixel  = graph_op2(graph, OP_vec2, footprint, threshold);
    return graph_op4(graph, op, number, point, normal, pixel);
}
