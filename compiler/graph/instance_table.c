/*
 * instance_table.c: the tables and functions of instance groups, and the nodes that name them.
 */
#include "compiler/graph/instance_table.h"

#include <assert.h>
#include <string.h>

Instances *graph_instances(Graph *graph)
{
    if (!graph->instances) {
        graph->instances        = arena_new(graph->arena, Instances);
        graph->instances->arena = graph->arena;
    }
    return graph->instances;
}

uint32_t graph_add_instance_function(Graph *graph, InstanceFunction function, const Node *bodies)
{
    Instances *instances = graph_instances(graph);
    assert(function.table_number < instances->tables.count);
    assert(function.state_count > 0 && function.state_count <= MAX_INSTANCE_STATES);
    function.first_body = (uint32_t)instances->bodies.count;
    for (uint32_t i = 0; i < function.state_count; i++) {
        assert(graph->items[bodies[i]].type == function.states[i].type);
        array_push(instances->arena, &instances->bodies, bodies[i]);
    }
    if (function.joins)
        array_push(instances->arena, &instances->bodies, bodies[function.state_count]);
    array_push(instances->arena, &instances->functions, function);
    return (uint32_t)instances->functions.count - 1;
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
    const Instances *instances = graph->instances;
    size_t           bodies    = instances ? instances->bodies.count : 0;
    size_t           numbers   = instances ? instances->frame_numbers.count : 0;
    *count                     = root_count + bodies + numbers;
    Node *all                  = arena_new_array(arena, Node, *count + 1);
    for (size_t i = 0; i < root_count; i++)
        all[i] = roots[i];
    for (size_t i = 0; i < bodies; i++)
        all[root_count + i] = instances->bodies.items[i];
    for (size_t i = 0; i < numbers; i++)
        all[root_count + bodies + i] = instances->frame_numbers.items[i];
    return all;
}

/* The copy has tables and functions in common; whoever adds some grows it first, since it is full.
   `nodes` are bodies, then frame numbers. */
static Instances *instances_with_nodes(const Instances *instances, const Node *nodes, Arena *arena)
{
    Instances *copy              = arena_new(arena, Instances);
    *copy                        = *instances;
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

void hand_on_instances(Graph *to, const Graph *from, const Node *all, Node *roots,
                       size_t root_count)
{
    for (size_t i = 0; i < root_count; i++)
        roots[i] = all[i];
    to->textures = from->textures;
    if (from->instances)
        to->instances = instances_with_nodes(from->instances, all + root_count, to->arena);
}

static void keep_grid(Grid *grid, Arena *arena)
{
    size_t cells    = grid_cell_count(grid);
    grid->instances = COPY_ITEMS(arena, grid->instances, grid->first[cells]);
    grid->first     = COPY_ITEMS(arena, grid->first, cells + 1);
    grid->clearance = COPY_ITEMS(arena, grid->clearance, cells);
    if (grid->tails) {
        grid->tails   = COPY_ITEMS(arena, grid->tails, grid->first[cells]);
        grid->middles = COPY_ITEMS(arena, grid->middles, cells);
    }
}

static void keep_table(InstanceTable *table, Arena *arena)
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

void instances_keep(Instances *instances, Arena *arena)
{
    instances->arena        = arena;
    instances->tables.items = COPY_ITEMS(arena, instances->tables.items, instances->tables.count);
    instances->functions.items = COPY_ITEMS(arena, instances->functions.items,
                                            instances->functions.count);
    instances->bodies.items = COPY_ITEMS(arena, instances->bodies.items, instances->bodies.count);
    instances->frame_numbers.items    = COPY_ITEMS(arena, instances->frame_numbers.items,
                                                   instances->frame_numbers.count);
    instances->tables.capacity        = instances->tables.count;
    instances->functions.capacity     = instances->functions.count;
    instances->bodies.capacity        = instances->bodies.count;
    instances->frame_numbers.capacity = instances->frame_numbers.count;
    for (size_t i = 0; i < instances->tables.count; i++)
        keep_table(&instances->tables.items[i], arena);
}

bool instances_vary(const Instances *instances)
{
    for (size_t i = 0; instances && i < instances->tables.count; i++)
        if (instances->tables.items[i].frame_columns || instances->tables.items[i].places)
            return true;
    return false;
}

bool relocates_along(const InstanceTable *table, int axis)
{
    for (uint32_t c = 0; c < table->columns; c++)
        if (table->axes[c] == axis + 1)
            return table->relocates;
    return false;
}

const Node *column_nodes(const Instances *instances, const InstanceTable *table, uint32_t column)
{
    assert(column < table->columns);
    if (!table->frame_columns || table->frame_columns[column] == KNOWN_COLUMN)
        return NULL;
    return instances->frame_numbers.items + table->frame_columns[column];
}

const Node *row_nodes(const Graph *graph, const Expr *row, uint32_t *count)
{
    const uint32_t       id    = (uint32_t)graph->items[row->operands[0]].number[0];
    const InstanceTable *table = &graph->instances->tables.items[row_table(id)];
    const Node          *nodes = column_nodes(graph->instances, table, row_column(id));
    *count                     = nodes ? table->rows : 0;
    return nodes;
}

/* ---- nodes ---- */

Node graph_instance_leaf(Graph *graph, Op op, uint32_t table_number)
{
    assert(is_of_instances(op) && op != OP_STATE);
    return graph_leaf_of(graph, op, table_number);
}

Node graph_state(Graph *graph, GraphType type, uint32_t function, uint32_t state)
{
    assert(state < MAX_INSTANCE_STATES);
    return graph_indexed_leaf(graph, OP_STATE, type, function * MAX_INSTANCE_STATES + state);
}

Node graph_row(Graph *graph, uint32_t table_number, uint32_t column, Node instance)
{
    assert(column < MAX_TABLE_COLUMNS);
    Node id = graph_uint(graph, table_number * MAX_TABLE_COLUMNS + column);
    return graph_op2(graph, OP_row, id, instance);
}

Node graph_instance_call(Graph *graph, Op op, uint32_t function, Node point)
{
    Node number = graph_uint(graph, function);
    return graph_op2(graph, op, number, point);
}

Node graph_instance_surface(Graph *graph, Op op, uint32_t function, Node point, Node normal,
                            Node footprint, Node threshold)
{
    Node number = graph_uint(graph, function);
    Node pixel  = graph_op2(graph, OP_vec2, footprint, threshold);
    return graph_op4(graph, op, number, point, normal, pixel);
}
