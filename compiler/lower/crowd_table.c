/*
 * crowd_table.c: the numbers in which the members of a crowd differ, as the columns of a table.
 */
#include <string.h>

#include "compiler/lower/crowd_group.h"

static uint32_t elements(const Graph *graph, Node slot)
{
    GraphType type = (GraphType)graph->items[slot].type;
    return type <= TYPE_VEC4 ? (uint32_t)type : 1;
}

/* A number in the table, or the node of the frame that it is. */
typedef struct Entry {
    double number;
    Node   node; /* NODE_NONE: the number is known */
} Entry;

static Entry entry_at(const CrowdGroup *group, size_t member, uint32_t slot, uint32_t element)
{
    const SlotContent *content =
        &group->contents.items[member * group->template->slot_count + slot];
    return (Entry){content->numbers[element], content->nodes[element]};
}

static bool entries_equal(Entry a, Entry b) { return a.number == b.number && a.node == b.node; }

/* ---- columns ---- */

/* The elements of slots that have equal numbers in each member are one column. */
typedef struct Column {
    uint32_t slot, element;
    uint64_t hash;
} Column;

static bool differs(const CrowdGroup *group, uint32_t slot, uint32_t element)
{
    Entry first = entry_at(group, 0, slot, element);
    for (size_t i = 1; i < group->members.count; i++)
        if (!entries_equal(entry_at(group, i, slot, element), first))
            return true;
    return false;
}

static uint64_t column_hash(const CrowdGroup *group, uint32_t slot, uint32_t element)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < group->members.count; i++) {
        Entry    entry = entry_at(group, i, slot, element);
        uint64_t bits;
        memcpy(&bits, &entry.number, sizeof bits);
        hash = (hash ^ bits ^ entry.node) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

static bool columns_equal(const CrowdGroup *group, const Column *a, const Column *b)
{
    if (a->hash != b->hash)
        return false;
    for (size_t i = 0; i < group->members.count; i++)
        if (!entries_equal(entry_at(group, i, a->slot, a->element),
                           entry_at(group, i, b->slot, b->element)))
            return false;
    return true;
}

/* The column with these numbers, new if there is none; NO_COLUMN: there are too many. */
static uint32_t add_column(CrowdGroup *group, uint32_t slot, uint32_t element)
{
    Column column = {slot, element, column_hash(group, slot, element)};
    for (uint32_t i = 0; i < group->column_count; i++)
        if (columns_equal(group, &group->sources[i], &column))
            return i;
    if (group->column_count == MOST_TABLE_COLUMNS)
        return NO_COLUMN;
    group->sources[group->column_count] = column;
    return group->column_count++;
}

bool group_find_columns(CrowdGroup *group, const GroupJoin *join)
{
    Arena   *arena      = graph_crowds(join->graph)->arena;
    uint32_t slots      = group->template->slot_count;
    group->varies       = arena_new_array(arena, bool, slots + 1);
    group->columns      = arena_new_array(arena, uint32_t, 4 * (size_t)slots + 1);
    group->sources      = arena_new_array(join->scratch, Column, MOST_TABLE_COLUMNS);
    group->column_count = 0;
    for (uint32_t i = 0; i < slots; i++)
        for (uint32_t k = 0; k < elements(join->graph, group->template->slots[i]); k++) {
            uint32_t *column = &group->columns[4 * i + k];
            *column          = NO_COLUMN;
            if (!differs(group, i, k))
                continue;
            group->varies[i] = true;
            *column          = add_column(group, i, k);
            if (*column == NO_COLUMN)
                return false;
        }
    return true;
}

/* ---- the table ---- */

static bool is_of_frame(const CrowdGroup *group, const Column *column)
{
    for (size_t i = 0; i < group->members.count; i++)
        if (entry_at(group, i, column->slot, column->element).node != NODE_NONE)
            return true;
    return false;
}

static void fill_known(const CrowdGroup *group, Crowd *table, uint32_t column)
{
    const Column *source = &group->sources[column];
    for (uint32_t i = 0; i < table->rows; i++)
        table->numbers[(size_t)i * table->columns + column] =
            entry_at(group, i, source->slot, source->element).number;
}

/* Some members may have known numbers there. */
static void fill_of_frame(const CrowdGroup *group, Graph *graph, Crowd *table, uint32_t column)
{
    Crowds       *crowds = graph->crowds;
    const Column *source = &group->sources[column];
    if (!table->frame_columns) {
        table->frame_columns = arena_new_array(crowds->arena, uint32_t, table->columns);
        for (uint32_t k = 0; k < table->columns; k++)
            table->frame_columns[k] = KNOWN_COLUMN;
    }
    table->frame_columns[column] = (uint32_t)crowds->frame_numbers.count;
    for (uint32_t i = 0; i < table->rows; i++) {
        Entry entry = entry_at(group, i, source->slot, source->element);
        Node  node  = entry.node == NODE_NONE ? graph_number(graph, entry.number) : entry.node;
        array_push(crowds->arena, &crowds->frame_numbers, node);
    }
}

void group_make_table(CrowdGroup *group, const GroupJoin *join, const Box *boxes, double reach,
                      double margin, Crowd table)
{
    Crowds  *crowds = graph_crowds(join->graph);
    uint32_t rows = (uint32_t)group->members.count, columns = group->column_count;
    table.rows    = rows;
    table.columns = columns;
    table.numbers = arena_new_array(crowds->arena, double, (size_t)rows *columns + 1);
    for (uint32_t k = 0; k < columns; k++)
        if (is_of_frame(group, &group->sources[k]))
            fill_of_frame(group, join->graph, &table, k);
        else
            fill_known(group, &table, k);
    Box *own = arena_new_array(join->scratch, Box, rows);
    for (uint32_t i = 0; i < rows; i++)
        own[i] = boxes[group->members.items[i]];
    uint32_t texels = (uint32_t)row_texels(&table);
    grid_build(&table.grid, own, rows, reach, margin, texels > 0 ? texels : 1, crowds->arena,
               join->scratch);
    group->crowd = (uint32_t)crowds->tables.count;
    array_push(crowds->arena, &crowds->tables, table);
}

/* ---- slots ---- */

/* What varies is read, the rest is as in the first member. */
static Node slot_element(const CrowdGroup *group, Graph *graph, Node member, uint32_t slot,
                         uint32_t element)
{
    uint32_t column = group->columns[4 * slot + element];
    return column == NO_COLUMN ? graph_component(graph, group->template->slots[slot], element)
                               : graph_row(graph, group->crowd, column, member);
}

static Node slot_node(const CrowdGroup *group, Graph *graph, Node member, uint32_t slot)
{
    static const Op vectors[] = {OP_vec2, OP_vec3, OP_vec4};
    Node            first     = group->template->slots[slot], parts[4];
    GraphType       type      = (GraphType)graph->items[first].type;
    if (!group->varies[slot])
        return first;
    for (uint32_t i = 0; i < elements(graph, first); i++)
        parts[i] = slot_element(group, graph, member, slot, i);
    if (type == TYPE_UINT)
        return graph_op1(graph, OP_to_uint, parts[0]);
    return type == TYPE_FLOAT ? parts[0] : graph_op(graph, vectors[type - TYPE_VEC2], parts);
}

void group_slots(const CrowdGroup *group, Graph *graph, Node member, Node *slots)
{
    for (uint32_t i = 0; i < group->template->slot_count; i++)
        slots[i] = group->varies[i] && member == NODE_NONE ? NODE_NONE
                                                           : slot_node(group, graph, member, i);
}
