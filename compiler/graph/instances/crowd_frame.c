/*
 * crowd_frame.c: where members are in a frame, and grids for that.
 */
#include "compiler/graph/instances/crowd_frame.h"

#include <math.h>
#include <string.h>

#include "compiler/graph/instances/grid_build.h"

bool crowds_move(const Crowds *crowds)
{
    for (size_t i = 0; crowds && i < crowds->tables.count; i++)
        if (crowds->tables.items[i].places)
            return true;
    return false;
}

Crowds *crowds_for_frames(const Crowds *crowds, Arena *arena)
{
    if (!crowds)
        return NULL;
    const size_t count    = crowds->tables.count;
    Crowds      *copy     = arena_new(arena, Crowds);
    *copy                 = *crowds;
    copy->tables.items    = arena_new_array(arena, Crowd, count + 1);
    copy->tables.capacity = count;
    memcpy(copy->tables.items, crowds->tables.items, count * sizeof *copy->tables.items);
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

/* Of an endless box no side is a number, and then a grid is one cell. */
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

static Box box_in_frame(const MemberPlace *place, const Node *nodes, const NodeValue *values)
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

static void enter_frame(const Crowds *crowds, Crowd *table, const NodeValue *values, Arena *arena,
                        Arena *scratch)
{
    const Node *nodes = crowds->frame_numbers.items + table->first_place;
    Box        *boxes = arena_new_array(scratch, Box, table->rows);
    for (uint32_t i = 0; i < table->rows; i++) {
        boxes[i] = box_in_frame(&table->places[i], nodes, values);
        nodes += place_nodes(table->places[i].kind);
    }
    grid_build_within(&table->grid, boxes, table->rows, table->reach, table->margin,
                      grid_limits_of_frame(table->rows), arena, scratch);
    table->cells = table->grid;
}

void crowds_enter_frame(Crowds *crowds, const NodeValue *values, Arena *arena, Arena *scratch)
{
    for (size_t i = 0; i < crowds->tables.count; i++)
        if (crowds->tables.items[i].places)
            enter_frame(crowds, &crowds->tables.items[i], values, arena, scratch);
}
