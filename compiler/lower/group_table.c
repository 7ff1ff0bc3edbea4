/*
 * group_table.c: the numbers in which the instances of an instance group differ, as the columns of a table.
 */
#include <math.h>
#include <string.h>

#include "compiler/lower/instance_group.h"

static uint32_t elements(const InstanceGroup *group, uint32_t slot)
{
    return components(group->template->slot_types[slot]);
}

/* A number in the table, or the node of the frame that it is. */
typedef struct Entry {
    double number;
    Node   node; /* NODE_NONE: the number is known */
} Entry;

static SlotElement *element_at(const InstanceGroup *group, uint32_t slot, uint32_t element)
{
    return &group->elements[4 * slot + element];
}

static Entry entry_at(const InstanceGroup *group, size_t instance, uint32_t slot, uint32_t element)
{
    const SlotElement *all = element_at(group, slot, element);
    return (Entry){all->numbers.count > 0 ? all->numbers.items[instance] : all->number,
                   all->nodes.count > 0 ? all->nodes.items[instance] : all->node};
}

static bool entries_equal(Entry a, Entry b) { return a.number == b.number && a.node == b.node; }

/* ---- instances ---- */

InstanceGroup group_new(Template *template, Arena *arena)
{
    InstanceGroup group = {.template  = template,
                           .distance  = NO_FUNCTION,
                           .nearest   = NO_FUNCTION,
                           .threshold = NO_FUNCTION,
                           .lists     = {{NO_FUNCTION, NO_FUNCTION}, {NO_FUNCTION, NO_FUNCTION}}};
    for (uint32_t i = 0; i < PART_ROOTS; i++)
        group.properties[i] = NO_FUNCTION;
    group.elements = arena_new_array(arena, SlotElement, 4 * (size_t) template->slot_count + 1);
    return group;
}

/* Adds an entry behind others, for which there are lists if some differ. */
static void add_entry(SlotElement *all, size_t before, Entry entry, Arena *scratch)
{
    if (before == 0) {
        all->number = entry.number;
        all->node   = entry.node;
    } else if (all->numbers.count > 0 || !entries_equal(entry, (Entry){all->number, all->node})) {
        bool of_frame = all->nodes.count > 0 || entry.node != NODE_NONE || all->node != NODE_NONE;
        while (all->numbers.count < before)
            array_push_large(scratch, &all->numbers, all->number);
        array_push_large(scratch, &all->numbers, entry.number);
        while (of_frame && all->nodes.count < before)
            array_push_large(scratch, &all->nodes, all->node);
        if (of_frame)
            array_push_large(scratch, &all->nodes, entry.node);
    }
}

void group_add(InstanceGroup *group, uint32_t part, const SlotContent *contents, Arena *scratch)
{
    for (uint32_t i = 0; i < group->template->slot_count; i++)
        for (uint32_t k = 0; k < elements(group, i); k++)
            add_entry(element_at(group, i, k), group->instances.count,
                      (Entry){contents[i].numbers[k], contents[i].nodes[k]}, scratch);
    array_push_large(scratch, &group->instances, part);
}

/* ---- columns ---- */

/* The elements of slots that have equal numbers in each instance are one column, but for what is taken from
   the point: that has a column for each axis. */
typedef struct Column {
    uint32_t slot, element;
    uint64_t hash;
    uint8_t  axis; /* of the point: 1 + its number; 0: none */
} Column;

static bool differs(const InstanceGroup *group, uint32_t slot, uint32_t element)
{
    return element_at(group, slot, element)->numbers.count > 0;
}

static uint64_t column_hash(const InstanceGroup *group, uint32_t slot, uint32_t element)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < group->instances.count; i++) {
        Entry    entry = entry_at(group, i, slot, element);
        uint64_t bits;
        memcpy(&bits, &entry.number, sizeof bits);
        hash = (hash ^ bits ^ entry.node) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

static bool columns_equal(const InstanceGroup *group, const Column *a, const Column *b)
{
    if (a->hash != b->hash || a->axis != b->axis)
        return false;
    for (size_t i = 0; i < group->instances.count; i++)
        if (!entries_equal(entry_at(group, i, a->slot, a->element),
                           entry_at(group, i, b->slot, b->element)))
            return false;
    return true;
}

/* Returns the column with these numbers, new if there is none; NO_COLUMN: there are too many. */
static uint32_t add_column(InstanceGroup *group, uint32_t slot, uint32_t element, uint8_t axis)
{
    Column column = {slot, element, column_hash(group, slot, element), axis};
    for (uint32_t i = 0; i < group->column_count; i++)
        if (columns_equal(group, &group->sources[i], &column))
            return i;
    if (group->column_count == MAX_TABLE_COLUMNS)
        return NO_COLUMN;
    group->sources[group->column_count] = column;
    return group->column_count++;
}

/* Tells whether an operand is a place that is taken from the point. */
static bool is_place(const TemplateNode *node, uint32_t operand, Node point)
{
    return node->op == OP_sub && operand == 1 && node->uses[1].kind == USE_SLOT &&
           node->uses[0].kind == USE_SAME && node->uses[0].index == point;
}

static bool is_node(const TemplateUse *use, Node node)
{
    return use->kind == USE_SAME && use->index == node;
}

/* Marks slots that have places.  False: the point is used in another way as well. */
static bool find_places(const Template *template, Node point, bool *places)
{
    for (uint32_t i = 0; i < template->root_count; i++)
        if (is_node(&template->roots[i], point))
            return false;
    for (uint32_t i = 0; i < template->node_count; i++) {
        const TemplateNode *node = &template->nodes[i];
        for (uint32_t k = 0; k < MAX_OPERANDS; k++) {
            if (is_node(&node->uses[k], point) && !(k == 0 && is_place(node, 1, point)))
                return false;
            if (is_place(node, k, point))
                places[node->uses[k].index] = true;
        }
    }
    return true;
}

/* A number that all instances have is left where it is, if the rounding of points that are so far away is that of
   points near the origin. */
static const double NEAR = 4;

static bool is_far(const InstanceGroup *group, uint32_t slot, uint32_t element)
{
    const SlotElement *all = element_at(group, slot, element);
    return differs(group, slot, element) || all->node != NODE_NONE || fabs(all->number) > NEAR;
}

/* Sets axis[slot][element] of places: 1 + the number of the axis, where that needs columns. */
static bool find_axes(const InstanceGroup *group, const GroupJoin *join, uint8_t (*axis)[4])
{
    const uint32_t slots  = group->template->slot_count;
    bool          *places = arena_new_array(join->scratch, bool, slots + 1), far[3] = {false};
    if (!find_places(group->template, join->leaves.point, places))
        return false;
    for (uint32_t i = 0; i < slots; i++)
        for (uint32_t k = 0; places[i] && k < 3; k++)
            far[k] = far[k] || is_far(group, i, k);
    for (uint32_t i = 0; i < slots; i++)
        for (uint8_t k = 0; places[i] && k < 3; k++)
            axis[i][k] = far[k] ? k + 1 : 0;
    return far[0] || far[1] || far[2];
}

bool group_find_columns(InstanceGroup *group, const GroupJoin *join)
{
    Arena   *arena      = graph_instances(join->graph)->arena;
    uint32_t slots      = group->template->slot_count;
    group->varies       = arena_new_array(arena, bool, slots + 1);
    group->columns      = arena_new_array(arena, uint32_t, 4 * (size_t)slots + 1);
    group->sources      = arena_new_array(join->scratch, Column, MAX_TABLE_COLUMNS);
    group->column_count = 0;
    uint8_t(*axis)[4]   = arena_alloc(join->scratch, (size_t)slots + 1, sizeof *axis);
    memset(axis, 0, (slots + 1) * sizeof *axis);
    group->relocates = find_axes(group, join, axis);
    for (uint32_t i = 0; i < slots; i++)
        for (uint32_t k = 0; k < elements(group, i); k++) {
            uint32_t *column = &group->columns[4 * i + k];
            *column          = NO_COLUMN;
            if (!differs(group, i, k) && !axis[i][k])
                continue;
            group->varies[i] = true;
            *column          = add_column(group, i, k, axis[i][k]);
            if (*column == NO_COLUMN)
                return false;
        }
    return true;
}

/* ---- the table ---- */

static bool is_of_frame(const InstanceGroup *group, const Column *column)
{
    const SlotElement *all = element_at(group, column->slot, column->element);
    return all->nodes.count > 0 || all->node != NODE_NONE;
}

static void fill_known(const InstanceGroup *group, InstanceTable *table, uint32_t column)
{
    const Column *source = &group->sources[column];
    for (uint32_t i = 0; i < table->rows; i++)
        table->numbers[(size_t)i * table->columns + column] =
            entry_at(group, i, source->slot, source->element).number;
}

/* Fills a column of the frame, in which some instances may have known numbers. */
static void fill_of_frame(const InstanceGroup *group, Graph *graph, InstanceTable *table,
                          uint32_t column)
{
    Instances    *groups = graph->instances;
    const Column *source = &group->sources[column];
    if (!table->frame_columns) {
        table->frame_columns = arena_new_array(table->arena, uint32_t, table->columns);
        for (uint32_t k = 0; k < table->columns; k++)
            table->frame_columns[k] = KNOWN_COLUMN;
    }
    table->frame_columns[column] = (uint32_t)groups->frame_numbers.count;
    for (uint32_t i = 0; i < table->rows; i++) {
        Entry entry = entry_at(group, i, source->slot, source->element);
        Node  node  = entry.node == NODE_NONE ? graph_number(graph, entry.number) : entry.node;
        array_push(groups->arena, &groups->frame_numbers, node);
    }
}

static double widest_of(const Box *boxes, uint32_t count)
{
    double widest = 0;
    for (uint32_t i = 0; i < count; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++) {
            double side = boxes[i].axis[k].high - boxes[i].axis[k].low;
            square += side * side;
        }
        widest = max2(widest, sqrt(square));
    }
    return widest;
}

void group_make_table(InstanceGroup *group, const GroupJoin *join, const Box *boxes, double reach,
                      double margin, InstanceTable table)
{
    Instances *groups = graph_instances(join->graph);
    uint32_t   rows = (uint32_t)group->instances.count, columns = group->column_count;
    table.arena     = join->tables;
    table.rows      = rows;
    table.columns   = columns;
    table.numbers   = arena_new_array(table.arena, double, (size_t)rows *columns + 1);
    table.relocates = group->relocates;
    for (uint32_t k = 0; k < columns; k++)
        table.axes[k] = group->sources[k].axis;
    for (uint32_t k = 0; k < columns; k++)
        if (is_of_frame(group, &group->sources[k]))
            fill_of_frame(group, join->graph, &table, k);
        else
            fill_known(group, &table, k);
    Box *own = arena_new_array(join->scratch, Box, rows);
    for (uint32_t i = 0; i < rows; i++)
        own[i] = boxes[group->instances.items[i]];
    if (!join->complement) {
        table.bounds = arena_new_array(table.arena, Box, rows);
        memcpy(table.bounds, own, rows * sizeof *own);
        table.widest = widest_of(own, rows);
    }
    group_make_cells(group, join, own, reach, margin, &table);
    group->table_number = (uint32_t)groups->tables.count;
    array_push(groups->arena, &groups->tables, table);
}

/* ---- slots ---- */

/* The expressions in the place of a column. */
typedef struct ColumnReader {
    Node (*read)(const struct ColumnReader *reader, Graph *graph, uint32_t column);
    uint32_t table_number, first;
    Node     instance;
} ColumnReader;

static Node read_row(const ColumnReader *reader, Graph *graph, uint32_t column)
{
    return graph_row(graph, reader->table_number, column, reader->instance);
}

static Node read_parameter(const ColumnReader *reader, Graph *graph, uint32_t column)
{
    return graph_parameter(graph, reader->first + column, TYPE_FLOAT);
}

/* Returns an element of a slot: it is read if it varies, and else that of the first instance. */
static Node slot_element(const InstanceGroup *group, Graph *graph, const ColumnReader *reader,
                         uint32_t slot, uint32_t element)
{
    uint32_t column = group->columns[4 * slot + element];
    return column == NO_COLUMN ? graph_component(graph, group->template->slots[slot], element)
                               : reader->read(reader, graph, column);
}

static Node slot_node(const InstanceGroup *group, Graph *graph, const ColumnReader *reader,
                      uint32_t slot)
{
    static const Op vectors[] = {OP_vec2, OP_vec3, OP_vec4};
    Node            first     = group->template->slots[slot], parts[4];
    GraphType       type      = (GraphType)graph->items[first].type;
    if (!group->varies[slot])
        return first;
    for (uint32_t i = 0; i < elements(group, slot); i++)
        parts[i] = slot_element(group, graph, reader, slot, i);
    if (type == TYPE_UINT)
        return graph_op1(graph, OP_to_uint, parts[0]);
    return type == TYPE_FLOAT ? parts[0] : graph_op(graph, vectors[type - TYPE_VEC2], parts);
}

void group_slots(const InstanceGroup *group, Graph *graph, Node instance, Node *slots)
{
    ColumnReader reader = {
        .read = read_row, .table_number = group->table_number, .instance = instance};
    for (uint32_t i = 0; i < group->template->slot_count; i++)
        slots[i] = group->varies[i] && instance == NODE_NONE ? NODE_NONE
                                                             : slot_node(group, graph, &reader, i);
}

void group_slots_of_parameters(const InstanceGroup *group, Graph *graph, uint32_t first,
                               Node *slots)
{
    ColumnReader reader = {.read = read_parameter, .first = first};
    for (uint32_t i = 0; i < group->template->slot_count; i++)
        slots[i] = slot_node(group, graph, &reader, i);
}
