/*
 * instance_scene.c: functions of instance groups of spheres with random numbers, and the same as plain loops.
 */
#include "tests/unit/instance_scene.h"

#include <math.h>
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/graph/build.h"
#include "compiler/graph/instances/grid_build.h"

/* ---- tables ---- */

static uint32_t add_table(Bench *b, InstanceTable table, const Box *boxes, double reach)
{
    Instances *instances = graph_instances(b->graph);
    Arena      scratch   = {.memory = &b->memory};
    table.stretch        = 1;
    grid_build(&table.grid, boxes, table.rows, reach, 0, 1, &b->arena, &scratch);
    table.cells = table.grid;
    arena_free(&scratch);
    array_push(&b->arena, &instances->tables, table);
    return (uint32_t)instances->tables.count - 1;
}

Box box_around(const double centre[3], double reach)
{
    Box box;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){centre[k] - reach, centre[k] + reach};
    return box;
}

static uint32_t add_spheres(Bench *b, double size, double reach)
{
    InstanceTable table = {.rows = SPHERES, .columns = COLUMNS};
    Box          *boxes = arena_new_array(&b->arena, Box, SPHERES);
    table.numbers       = arena_new_array(&b->arena, double, SPHERES *COLUMNS);
    for (uint32_t i = 0; i < SPHERES; i++) {
        double *row = table.numbers + (size_t)i * COLUMNS;
        random_vector(&b->random, size, row);
        row[RADIUS] = random_between(&b->random, 0.02, 0.1) * size;
        row[SHADE]  = i + 1;
        boxes[i]    = box_around(row, row[RADIUS] * TIME);
    }
    return add_table(b, table, boxes, reach);
}

/* ---- functions ---- */

static Node column(Graph *g, uint32_t group, uint32_t index)
{
    return graph_row(g, group, index, graph_instance_leaf(g, OP_INSTANCE_ROW, group));
}

static Node centre_of(Graph *g, uint32_t group)
{
    Node x = column(g, group, 0), y = column(g, group, 1), z = column(g, group, 2);
    return graph_op3(g, OP_vec3, x, y, z);
}

static Node from_centre(Graph *g, uint32_t group)
{
    Node point = graph_instance_leaf(g, OP_INSTANCE_POINT, group);
    return sub(g, point, centre_of(g, group));
}

static Node sphere_distance(Graph *g, uint32_t group)
{
    Node length = graph_op1(g, OP_length, from_centre(g, group));
    Node radius = mul(g, column(g, group, RADIUS), graph_parameter(g, 0, TYPE_FLOAT));
    return sub(g, length, radius);
}

static InstanceFunction distance_function(uint32_t group)
{
    return (InstanceFunction){.table_number = group,
                              .type         = TYPE_FLOAT,
                              .clear        = true,
                              .states       = {{TYPE_FLOAT, {NOWHERE}}},
                              .state_count  = 1};
}

/* Returns the number of the function that is made next. */
static uint32_t next_function(Graph *g) { return (uint32_t)graph_instances(g)->functions.count; }

static uint32_t add_sharp(Graph *g, uint32_t group)
{
    Node state = graph_state(g, TYPE_FLOAT, next_function(g), 0);
    Node body  = graph_op2(g, OP_min, state, sphere_distance(g, group));
    return graph_add_instance_function(g, distance_function(group), &body);
}

static uint32_t add_smooth(Graph *g, uint32_t group)
{
    Node state = graph_state(g, TYPE_FLOAT, next_function(g), 0), width = graph_number(g, WIDTH);
    Node body = graph_op3(g, OP_smin_quadratic, state, sphere_distance(g, group), width);
    return graph_add_instance_function(g, distance_function(group), &body);
}

/* Returns the number of the nearest instance: both states change at once. */
static uint32_t add_nearest(Graph *g, uint32_t group)
{
    uint32_t         id       = next_function(g);
    InstanceFunction function = {.table_number = group,
                                 .type         = TYPE_UINT,
                                 .states       = {{TYPE_UINT, {0}}, {TYPE_FLOAT, {NOWHERE}}},
                                 .state_count  = 2,
                                 .distance     = 1};
    Node instance = graph_state(g, TYPE_UINT, id, 0), least = graph_state(g, TYPE_FLOAT, id, 1);
    Node here     = graph_instance_leaf(g, OP_INSTANCE_ROW, group),
         distance = sphere_distance(g, group);
    Node nearer   = graph_op2(g, OP_less, distance, least);
    Node bodies[] = {graph_op3(g, OP_select, nearer, here, instance),
                     graph_op2(g, OP_min, least, distance)};
    return graph_add_instance_function(g, function, bodies);
}

/* Each instance halves the vector, after it has added something to it: the order counts. */
static uint32_t add_lean(Graph *g, uint32_t group)
{
    InstanceFunction function = {.table_number = group,
                                 .type         = TYPE_VEC3,
                                 .states       = {{TYPE_VEC3, {0.5, 1, 2}}},
                                 .state_count  = 1,
                                 .distance     = NO_DISTANCE};
    Node state = graph_state(g, TYPE_VEC3, next_function(g), 0), half = graph_number(g, 0.5);
    Node normal = graph_instance_leaf(g, OP_INSTANCE_NORMAL, group);
    Node size   = graph_instance_leaf(g, OP_INSTANCE_FOOTPRINT, group);
    Node away   = mul(g, add(g, from_centre(g, group), normal), size);
    Node body   = mul(g, add(g, state, away), half);
    return graph_add_instance_function(g, function, &body);
}

/* Copies of an instance group, each at another place. */
static uint32_t add_copies(Bench *b, uint32_t inner, double inner_size)
{
    Graph        *g     = b->graph;
    InstanceTable table = {.rows = PLACES, .columns = 3};
    Box          *boxes = arena_new_array(&b->arena, Box, PLACES);
    table.numbers       = arena_new_array(&b->arena, double, PLACES * 3);
    for (uint32_t i = 0; i < PLACES; i++) {
        random_vector(&b->random, 5, table.numbers + (size_t)3 * i);
        boxes[i] = box_around(table.numbers + (size_t)3 * i, 1.2 * inner_size);
    }
    uint32_t group = add_table(b, table, boxes, 0);
    Node     state = graph_state(g, TYPE_FLOAT, next_function(g), 0);
    Node     there = graph_instance_call(g, OP_instance_distance, inner, from_centre(g, group));
    Node     body  = graph_op2(g, OP_min, state, there);
    return graph_add_instance_function(g, distance_function(group), &body);
}

/* ---- the same as plain loops ---- */

const InstanceTable *table_of(const Graph *g, uint32_t function)
{
    return &g->instances->tables.items[g->instances->functions.items[function].table_number];
}

const double *row_of(const InstanceTable *table, uint32_t i)
{
    return table->numbers + (size_t)i * table->columns;
}

static double away(const double *a, const double *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(sum);
}

static double sphere_at(const InstanceTable *table, uint32_t i, const double p[3])
{
    const double *row = row_of(table, i);
    return away(p, row) - row[RADIUS] * TIME;
}

static double blend(double a, double b)
{
    double h = fmax(WIDTH - fabs(a - b), 0) / WIDTH;
    return fmin(a, b) - h * h * WIDTH / 4;
}

double clearance_at(const InstanceTable *table, const double p[3])
{
    uint32_t count;
    double   clearance;
    grid_find(&table->grid, p, &count, &clearance);
    return clearance;
}

double all_spheres(const InstanceTable *table, const double p[3], bool smooth, bool by_cells)
{
    double least = NOWHERE;
    for (uint32_t i = 0; i < table->rows; i++) {
        double d = sphere_at(table, i, p);
        least    = smooth ? blend(least, d) : fmin(least, d);
    }
    return by_cells ? fmin(least, clearance_at(table, p)) : least;
}

uint32_t nearest_sphere(const InstanceTable *table, const double p[3])
{
    uint32_t nearest = 0;
    for (uint32_t i = 1; i < table->rows; i++)
        if (sphere_at(table, i, p) < sphere_at(table, nearest, p))
            nearest = i;
    return nearest;
}

double all_copies(const InstanceTable *outer, const InstanceTable *inner, const double p[3],
                  bool by_cells)
{
    double          least = NOWHERE, clearance;
    uint32_t        count;
    const uint32_t *list = grid_find(&outer->grid, p, &count, &clearance);
    for (uint32_t i = 0; i < (by_cells ? count : outer->rows); i++) {
        const double *centre = row_of(outer, by_cells ? list[i] : i);
        const double  q[3]   = {p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]};
        least                = fmin(least, all_spheres(inner, q, false, by_cells));
    }
    return by_cells ? fmin(least, clearance) : least;
}

void lean_there(const InstanceTable *table, const double p[3], const double normal[3], double size,
                double lean[3])
{
    static const double first[3] = {0.5, 1, 2};
    uint32_t            count;
    double              clearance;
    const uint32_t     *list = grid_find(&table->grid, p, &count, &clearance);
    memcpy(lean, first, sizeof first);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            lean[k] = (lean[k] + (p[k] - row_of(table, list[i])[k] + normal[k]) * size) / 2;
}

/* ---- one scene of all of them ---- */

Many make_many(Bench *b)
{
    Graph   *g     = b->graph;
    Many     many  = {.graph = g};
    uint32_t small = add_spheres(b, 1, 0), plain = add_spheres(b, 5, 0);
    uint32_t mixed   = add_spheres(b, 5, 4 * WIDTH);
    many.inner       = add_sharp(g, small);
    many.sharp       = add_sharp(g, plain);
    many.smooth      = add_smooth(g, mixed);
    many.nested      = add_copies(b, many.inner, 1);
    uint32_t nearest = add_nearest(g, plain), lean = add_lean(g, plain);
    Node     instance = graph_instance_call(g, OP_instance_index, nearest, b->point);
    Node     normal = graph_leaf(g, OP_NORMAL), footprint = graph_leaf(g, OP_FOOTPRINT);
    many.roots[SHARP]  = graph_instance_call(g, OP_instance_distance, many.sharp, b->point);
    many.roots[SMOOTH] = graph_instance_call(g, OP_instance_distance, many.smooth, b->point);
    many.roots[NESTED] = graph_instance_call(g, OP_instance_distance, many.nested, b->point);
    many.roots[SHADED] = graph_row(g, plain, SHADE, instance);
    many.roots[LEAN]   = graph_instance_surface(g, OP_instance_vector, lean, b->point, normal,
                                                footprint, graph_number(g, 0));
    return many;
}
