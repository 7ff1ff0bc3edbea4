/*
 * outline.c: the body of an outline's function, its table and its grid.
 */
#include "compiler/lower/outline.h"

#include <math.h>

#include "compiler/base/far.h"
#include "compiler/graph/build.h"
#include "compiler/graph/instances/grid_build.h"

/* ---- the body ---- */

/* An instance in the body of the function. */
typedef struct Row {
    Graph   *graph;
    uint32_t table_number;
    Node     instance, point;
} Row;

static Node number_of(const Row *row, uint32_t column)
{
    return graph_row(row->graph, row->table_number, column, row->instance);
}

static Node vector_of(const Row *row, uint32_t column)
{
    Node x = number_of(row, column), y = number_of(row, column + 1);
    return graph_op2(row->graph, OP_vec2, x, y);
}

static Node unit_clamp(Graph *g, Node t)
{
    Node one = graph_number(g, 1), zero = graph_number(g, 0);
    return graph_op3(g, OP_clamp, t, zero, one);
}

/* Returns a b' - a' b. */
static Node cross_of(Graph *g, Node a, Node b)
{
    Node y = graph_component(g, b, 1), first = mul(g, graph_component(g, a, 0), y);
    Node x = graph_component(g, b, 0), second = mul(g, graph_component(g, a, 1), x);
    return sub(g, first, second);
}

/* Returns the length of `away` to the nearest point, with the sign of the side on which the
   point at hand is of the curve that goes on there.  At an end that is the side of the corner's
   bisector. */
static Node signed_length(const Row *row, Node t, Node away, Node tangent, Node side)
{
    Graph *g     = row->graph;
    Node   first = number_of(row, COLUMN_FIRST_CORNER), last = number_of(row, COLUMN_LAST_CORNER);
    Node   zero = graph_number(g, 0), one = graph_number(g, 1);
    Node   at_last  = graph_op2(g, OP_less_equal, one, t);
    Node   at_first = graph_op2(g, OP_less_equal, t, zero);
    Node   corner   = graph_op3(g, OP_select, at_last, last, zero);
    corner          = graph_op3(g, OP_select, at_first, first, corner);
    Node along      = mul(g, corner, graph_op2(g, OP_dot, tangent, away));
    Node across     = times(g, cross_of(g, tangent, away), side);
    Node inside     = graph_op2(g, OP_less, along, across);
    Node length     = graph_op1(g, OP_length, away);
    Node negative   = neg(g, length);
    length          = graph_op3(g, OP_select, inside, negative, length);
    return sub(g, length, number_of(row, COLUMN_LEAN));
}

static Node line_distance(const Row *row)
{
    Graph *g       = row->graph;
    Node   tangent = vector_of(row, COLUMN_TANGENT);
    Node   away    = sub(g, row->point, vector_of(row, COLUMN_START));
    Node   along   = graph_op2(g, OP_dot, tangent, away),
         square    = graph_op2(g, OP_dot, tangent, tangent);
    Node t         = unit_clamp(g, over(g, along, square));
    away           = sub(g, away, mul(g, tangent, t));
    return signed_length(row, t, away, tangent, graph_number(g, 1));
}

/* Returns the largest root of f3 t^3 + f2 t^2 + f1 t + f0, which is convex at t = 1, by Newton's
   method from there.  Where it falls, what is nearest is at t = 0. */
static Node largest_root(Graph *g, const Node f[4])
{
    Node t = graph_number(g, 1), slope2 = add(g, f[2], f[2]);
    Node slope3 = mul(g, f[3], graph_number(g, 3));
    for (int i = 0; i < OUTLINE_STEPS; i++) {
        Node value = add(g, times(g, f[3], t), f[2]);
        value      = add(g, times(g, value, t), f[1]);
        value      = add(g, times(g, value, t), f[0]);
        Node slope = add(g, times(g, slope3, t), slope2);
        slope      = add(g, times(g, slope, t), f[1]);
        slope      = at_least(g, slope, 1e-30);
        t          = unit_clamp(g, sub(g, t, over(g, value, slope)));
    }
    return t;
}

static Node curve_distance(const Row *row)
{
    Graph *g       = row->graph;
    Node   away    = sub(g, row->point, vector_of(row, COLUMN_START));
    Node   tangent = vector_of(row, COLUMN_TANGENT), bend = vector_of(row, COLUMN_BEND);
    Node   tangent_bend = number_of(row, COLUMN_TANGENT_BEND), f[4];
    Node   square       = graph_op2(g, OP_dot, tangent, tangent);
    f[3]                = number_of(row, COLUMN_BEND_BEND);
    f[2]                = mul(g, tangent_bend, graph_number(g, 3));
    f[1]                = graph_op2(g, OP_dot, away, bend);
    f[1]                = sub(g, add(g, square, square), f[1]);
    f[0]                = neg(g, graph_op2(g, OP_dot, away, tangent));
    Node t              = largest_root(g, f);
    /* The nearest point is there or at t = 0. */
    Node twice         = add(g, tangent, tangent);
    Node there         = sub(g, away, mul(g, add(g, twice, mul(g, bend, t)), t));
    Node before        = graph_op2(g, OP_dot, away, away);
    Node behind        = graph_op2(g, OP_dot, there, there);
    Node begins        = graph_op2(g, OP_less_equal, before, behind);
    t                  = graph_op3(g, OP_select, begins, graph_number(g, 0), t);
    Node nearest       = graph_op3(g, OP_select, begins, away, there);
    Node there_tangent = add(g, tangent, mul(g, bend, t));
    return signed_length(row, t, nearest, there_tangent, number_of(row, COLUMN_SIDE));
}

/* Returns what is nearer to 0. */
static Node nearer(Graph *g, Node state, Node distance)
{
    Node size = graph_op1(g, OP_abs, distance), least = graph_op1(g, OP_abs, state);
    Node less = graph_op2(g, OP_less, size, least);
    return graph_op3(g, OP_select, less, distance, state);
}

static uint32_t add_function(Graph *g, const OutlineShape *shape, uint32_t table_number)
{
    uint32_t id    = (uint32_t)graph_instances(g)->functions.count;
    Node     state = graph_state(g, TYPE_FLOAT, id, 0);
    Node     point = graph_instance_leaf(g, OP_INSTANCE_POINT, table_number);
    Node     x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Row      row  = {g, table_number, graph_instance_leaf(g, OP_INSTANCE_ROW, table_number),
                     graph_op2(g, OP_vec2, x, y)};
    Node     body = shape->instances.columns == LINE_COLUMNS ? line_distance(&row)
                                                             : curve_distance(&row);
    body          = nearer(g, state, body);
    InstanceFunction function = {.table_number = table_number,
                                 .type         = TYPE_FLOAT,
                                 .clear        = true,
                                 .either       = true,
                                 .slope        = 1,
                                 .states       = {{TYPE_FLOAT, {NOWHERE}}},
                                 .state_count  = 1};
    return graph_add_instance_function(g, function, &body);
}

/* ---- the table ---- */

static double distance_to_piece(const void *instances, uint32_t instance, const double point[2])
{
    const OutlineInstances *all = instances;
    return fabs(piece_distance(&all->pieces[instance], point));
}

/* Returns the box around the control points. */
static Box box_of(const Curve *curve)
{
    Box box = {{{0, 0}, {0, 0}, {0, 0}}};
    for (int k = 0; k < 2; k++) {
        double low = fmin(curve->from[k], curve->to[k]), high = fmax(curve->from[k], curve->to[k]);
        box.axis[k] = (Range){fmin(low, curve->via[k]), fmax(high, curve->via[k])};
    }
    return box;
}

static InstanceArc arc_of(const Curve *curve)
{
    InstanceArc arc;
    for (int k = 0; k < 2; k++) {
        double from = curve->from[k], to = curve->to[k], via = curve->via[k];
        arc.start[k]   = from;
        arc.tangent[k] = curve->straight ? 0.5 * (to - from) : via - from;
        arc.bend[k]    = curve->straight ? 0 : from - 2 * via + to;
    }
    return arc;
}

/* Sets the sign of clearances in cells that no instance is in. */
static void mark_inside(Grid *grid, const Outline *outline, Arena *scratch)
{
    const uint32_t *count  = grid->cells;
    double          low[2] = {grid->low[0] + 0.5 * grid->size, grid->low[1] + 0.5 * grid->size};
    size_t          cells  = (size_t)count[0] * count[1];
    bool           *inside = arena_new_array(scratch, bool, cells);
    if (isinf(grid->size))
        return;
    outline_fill(outline, low, grid->size, count, inside, scratch);
    for (size_t i = 0; i < cells; i++)
        if (inside[i] && (double)grid->clearance[i] < 0.5 * NOWHERE)
            grid->clearance[i] = -grid->clearance[i];
}

static uint32_t add_table(Graph *g, const OutlineShape *shape, double margin, Arena *scratch)
{
    const OutlineInstances *instances = &shape->instances;
    Instances              *groups    = graph_instances(g);
    InstanceTable           table     = {.rows    = instances->count,
                                         .columns = instances->columns,
                                         .numbers = instances->numbers,
                                         .boxes = arena_new_array(groups->arena, Box, instances->count),
                                         .arcs = arena_new_array(groups->arena, InstanceArc, instances->count),
                                         .stretch = 1,
                                         .span    = shape->span};
    for (uint32_t i = 0; i < instances->count; i++) {
        table.boxes[i] = box_of(&instances->pieces[i].curve);
        table.arcs[i]  = arc_of(&instances->pieces[i].curve);
    }
    GridInstances near = {distance_to_piece, instances};
    grid_build_flat(&table.grid, table.boxes, table.rows, margin, (uint32_t)row_texels(&table),
                    near, groups->arena, scratch);
    mark_inside(&table.grid, &shape->outline, scratch);
    table.cells = table.grid;
    array_push(groups->arena, &groups->tables, table);
    return (uint32_t)groups->tables.count - 1;
}

Node outline_distance(Graph *graph, OutlineShape *shape, double margin, Node point, bool *is_new,
                      Arena *scratch)
{
    size_t i = 0;
    while (i < shape->functions.count && shape->functions.items[i].margin != margin)
        i++;
    *is_new = i == shape->functions.count;
    if (*is_new) {
        uint32_t        table_number = add_table(graph, shape, margin, scratch);
        OutlineFunction function     = {margin, add_function(graph, shape, table_number)};
        array_push(graph->arena, &shape->functions, function);
    }
    return graph_instance_call(graph, OP_instance_distance, shape->functions.items[i].function,
                               point);
}
