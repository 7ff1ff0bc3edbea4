/*
 * instance_frame.c: where instances are in a frame, and grids for that.
 */
#include "compiler/graph/instances/instance_frame.h"

#include <math.h>
#include <string.h>

#include "compiler/graph/instances/grid_build.h"

bool instances_move(const Instances *instances)
{
    for (size_t i = 0; instances && i < instances->tables.count; i++)
        if (instances->tables.items[i].places)
            return true;
    return false;
}

Instances *instances_for_frames(const Instances *instances, Arena *arena)
{
    if (!instances)
        return NULL;
    const size_t count    = instances->tables.count;
    Instances   *copy     = arena_new(arena, Instances);
    *copy                 = *instances;
    copy->tables.items    = arena_new_array(arena, InstanceTable, count + 1);
    copy->tables.capacity = count;
    memcpy(copy->tables.items, instances->tables.items, count * sizeof *copy->tables.items);
    return copy;
}

/* ---- boxes ---- */

static Box shifted(const Box *box, const double shift[3])
{
    Box result;
    for (int k = 0; k < 3; k++)
        result.axis[k] = (Range){box->axis[k].low + shift[k], box->axis[k].high + shift[k]};
    return result;
}

/* Returns the box of a mapped box.  No side of an endless box is a number, and then a grid is one
   cell. */
Box box_under_map(const Box *box, const NodeValue *const map[5])
{
    const double scale = map[0]->v[0];
    Box          result;
    for (int i = 0; i < 3; i++) {
        const double *row    = map[1 + i]->v;
        double        middle = 0, half = 0;
        for (int k = 0; k < 3; k++) {
            const Range axis = box->axis[k];
            middle += row[k] * 0.5 * (axis.low + axis.high);
            half += fabs(row[k]) * 0.5 * (axis.high - axis.low);
        }
        middle         = scale * middle + map[4]->v[i];
        half           = scale * half;
        result.axis[i] = (Range){middle - half, middle + half};
    }
    return result;
}

static Box box_in_frame(const InstancePlace *place, const Node *nodes, const NodeValue *values)
{
    const NodeValue *map[5];
    if (place->kind == PLACE_FIXED || grid_box_is_empty(&place->box))
        return place->box;
    for (uint32_t k = 0; k < place_nodes(place->kind); k++)
        map[k] = &values[nodes[k]];
    return place->kind == PLACE_SHIFT ? shifted(&place->box, map[0]->v)
                                      : box_under_map(&place->box, map);
}

/* ---- grids ---- */

static void enter_frame(const Instances *instances, InstanceTable *table, const NodeValue *values,
                        Arena *arena, Arena *scratch)
{
    const Node *nodes = instances->frame_numbers.items + table->first_place;
    Box        *boxes = arena_new_array(scratch, Box, table->rows);
    for (uint32_t i = 0; i < table->rows; i++) {
        boxes[i] = box_in_frame(&table->places[i], nodes, values);
        nodes += place_nodes(table->places[i].kind);
    }
    grid_build_within(&table->grid, boxes, table->rows, table->reach, table->margin,
                      grid_limits_of_frame(table->rows), arena, scratch);
    table->cells = table->grid;
}

void instances_enter_frame(Instances *instances, const NodeValue *values, Arena *arena,
                           Arena *scratch)
{
    for (size_t i = 0; i < instances->tables.count; i++)
        if (instances->tables.items[i].places)
            enter_frame(instances, &instances->tables.items[i], values, arena, scratch);
}
