/*
 * moving_instances.c: instance groups whose instances differ in numbers of the frame: in each frame they are what
 * each part, lowered for itself, makes of it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/graph/instances/instance_frame.h"
#include "compiler/graph/rewrite/simplify.h"
#include "tests/property/instance_parts.h"

/* In a colour that a number of the frame makes brighter. */
static const Shape *tinted(const Shape *shape, Node number)
{
    Graph    *g        = builder.graph;
    Node      bright   = graph_op2(g, OP_mul, number, number);
    Material *material = arena_new(&arena, Material);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    material->name = NODE_NONE;
#include "krs/surface.def"
    material->bump  = NODE_NONE;
    material->name  = "moving";
    material->color = graph_op3(g, OP_vec3, bright, graph_number(g, between(0, 1)), bright);
    return make_paint(&builder, shape, material, no_place);
}

/* Its place, its turn and its colour depend on the time, or on the parameter as well; some of its
   numbers are known. */
static const Shape *moving_part(bool of_parameter)
{
    Graph *g    = builder.graph;
    Node   time = graph_parameter(g, 0, TYPE_FLOAT), up = graph_parameter(g, 1, TYPE_FLOAT);
    Node   angle = graph_op2(g, OP_add, time, graph_number(g, between(0, 6)));
    Node   sine = graph_op1(g, OP_sin, angle), cosine = graph_op1(g, OP_cos, angle);
    Node   zero = graph_number(g, 0), one = graph_number(g, 1);
    Node   left = graph_op1(g, OP_neg, sine);
    Node   y    = graph_op2(g, OP_add, sine, graph_number(g, between(-2, 2)));
    double x = between(-3, 3), z = between(-3, 3);
    Map    map = {
           .scale = graph_number(g, between(0.5, 1.5)),
           .rows  = {graph_op3(g, OP_vec3, cosine, sine, zero),
                     graph_op3(g, OP_vec3, left, cosine, zero), graph_op3(g, OP_vec3, zero, zero, one)},
           .shift = graph_op3(g, OP_vec3, graph_number(g, x),
                           of_parameter ? graph_op2(g, OP_mul, y, up) : y, graph_number(g, z)),
           .pole  = NODE_NONE};
    const Shape *shape = ring(between(0.1, 0.3), between(0.02, 0.08));
    return tinted(make_transform(&builder, shape, &map, no_place), sine);
}

static const Shape *moving_union(void)
{
    const Shape  **parts = arena_new_array(&arena, const Shape *, PARTS);
    GraphParameter range = {{0}, {1}};
    array_push(&arena, &builder.graph->parameters, range);
    for (int i = 0; i < PARTS; i++)
        parts[i] = moving_part(i % 2);
    return make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
}

/* Those that the parameter raises have other operations, but not at points: all are one instance group. */
static void moving_parts(void **state)
{
    (void)state;
    const Shape   *all       = moving_union();
    LoweredGroups *instances = lowered_groups_new(builder.graph, &arena, &arena, LEAST);
    Seen           apart = lower(all, NULL), group = lower(all, instances);
    assert_int_equal(builder.graph->instances->tables.count, 1);
    assert_int_equal(builder.graph->instances->tables.items[0].rows, PARTS);
    assert_true(group.tape.count < apart.tape.count);
    for (int i = 0; i < 6; i++) {
        now    = i == 0 ? 0 : between(-20, 20);
        height = i == 0 ? 1 : between(0, 1);
        assert_right(compare_lowered(all, apart, group, 3.5));
    }
}

/* ---- grids of a frame ---- */

/* Moved as far as the time says, behind a turn that is known; or all of it is known. */
static const Shape *shifted_part(bool known)
{
    Graph *g    = builder.graph;
    double turn = between(0, 6), x = between(-3, 3), y = between(-3, 3), z = between(-3, 3);
    Node   time = known ? graph_number(g, between(-20, 20)) : graph_parameter(g, 0, TYPE_FLOAT);
    Node   sine = graph_op1(g, OP_sin, graph_op2(g, OP_add, time, graph_number(g, between(0, 6))));
    Node   up   = graph_op2(g, OP_add, graph_op2(g, OP_mul, sine, graph_number(g, 2)),
                            graph_number(g, y));
    Map    map  = {.scale = graph_number(g, between(0.5, 1.5)),
                   .rows  = {graph_vec3(g, cos(turn), sin(turn), 0),
                             graph_vec3(g, -sin(turn), cos(turn), 0), graph_vec3(g, 0, 0, 1)},
                   .shift = graph_op3(g, OP_vec3, graph_number(g, x), up, graph_number(g, z)),
                   .pole  = NODE_NONE};
    const Shape *shape = ring(between(0.1, 0.3), between(0.02, 0.08));
    return tinted(make_transform(&builder, shape, &map, no_place), sine);
}

static const Shape *union_of_all_kinds(void)
{
    const Shape  **parts = arena_new_array(&arena, const Shape *, PARTS);
    GraphParameter range = {{0}, {1}};
    array_push(&arena, &builder.graph->parameters, range);
    for (int i = 0; i < PARTS; i++)
        parts[i] = i % 3 == 0 ? moving_part(i % 2) : shifted_part(i % 3 == 1);
    return make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
}

static double mean_list(const Grid *grid)
{
    size_t cells = grid_cell_count(grid);
    return grid->first[cells] / (double)cells;
}

/* At how many points lists of cells, and all else that may be nearest, make distances too large. */
static int count_missed(const Seen *apart, const Seen *group, bool by_cells)
{
    Seen cells          = *group;
    int  missed         = 0;
    cells.tape.by_cells = by_cells;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 3.5, p);
        missed += look(&cells, p) > look(apart, p) + 1e-12;
    }
    return missed;
}

/* The grids of the frame that is now. */
static void enter_frame_now(Instances *instances)
{
    Graph *g  = builder.graph;
    Tape tape = tape_new(g, instances->frame_numbers.items, instances->frame_numbers.count, &arena);
    NodeValue *values = arena_new_array(&arena, NodeValue, g->count);
    tape_run_frame(&tape, (NodeValue[]){{{now}}, {{height}}}, values);
    instances_enter_frame(instances, values, &arena, &scratch);
}

/* Lists of a frame are shorter than those for all frames, and miss nobody in it; those of another frame
   do. */
static void frames_have_grids(void **state)
{
    (void)state;
    Graph       *g      = builder.graph;
    const Shape *all    = union_of_all_kinds();
    Seen         apart  = lower(all, NULL);
    Seen         group  = lower(all, lowered_groups_new(g, &arena, &arena, LEAST));
    Instances   *always = g->instances;
    const size_t tables = always->tables.count;
    int          others = 0;
    assert_true(tables > 0 && instances_move(always));
    g->instances = instances_for_frames(always, &arena);
    for (int i = 0; i < 6; i++) {
        if (i > 0) {
            prepare(&apart);
            prepare(&group);
            others += count_missed(&apart, &group, true) + count_missed(&apart, &group, false);
        }
        now    = between(-20, 20);
        height = between(0, 1);
        enter_frame_now(g->instances);
        prepare(&apart);
        prepare(&group);
        assert_right(compare_lowered(all, apart, group, 3.5));
        assert_int_equal(count_missed(&apart, &group, true), 0);
        for (size_t t = 0; t < tables; t++)
            assert_true(!always->tables.items[t].places ||
                        mean_list(&g->instances->tables.items[t].cells) <
                            0.7 * mean_list(&always->tables.items[t].cells));
        now += 1.5;
    }
    assert_true(others > POINTS / 20);
}

/* A pass that makes a graph takes the frame's numbers along. */
static void moving_parts_are_simplified(void **state)
{
    (void)state;
    const Shape *all   = moving_union();
    Seen         apart = lower(all, NULL);
    Seen         group = lower(all, lowered_groups_new(builder.graph, &arena, &arena, LEAST)),
         simple        = group;
    Graph *before      = builder.graph;
    Graph *after       = graph_simplify(before, simple.roots, ROOT_COUNT, &arena);
    simple.tape        = tape_new(after, simple.roots, ROOT_COUNT, &arena);
    now                = 2.5;
    height             = 0.75;
    prepare(&apart);
    builder.graph = after;
    prepare(&simple);
    int near = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 3.5, p);
        double wanted = look(&apart, p), is = look(&simple, p);
        assert_true(is <= wanted + 1e-12);
        near += wanted * all->slope < clearance_at(p);
        assert_true(wanted * all->slope >= clearance_at(p) || fabs(is - wanted) <= 1e-12);
    }
    assert_true(near > POINTS / 20);
}

/* An infinite number of the frame is found, and is told from those before. */
static void infinite_numbers_are_found(void **state)
{
    (void)state;
    const Shape *parts[PARTS];
    Graph       *g    = builder.graph;
    Node         time = graph_parameter(g, 0, TYPE_FLOAT);
    for (int i = 0; i < PARTS; i++) {
        Node after = graph_op2(g, OP_sub, time, graph_number(g, i));
        Node zero  = graph_number(g, 0);
        Map  map   = {.scale = graph_number(g, 1),
                      .rows = {graph_vec3(g, 1, 0, 0), graph_vec3(g, 0, 1, 0), graph_vec3(g, 0, 0, 1)},
                      .shift = graph_op3(g, OP_vec3, zero,
                                         graph_op2(g, OP_div, graph_number(g, 1), after), zero),
                      .pole  = NODE_NONE};
        parts[i]   = make_transform(&builder, ball(0.2), &map, no_place);
    }
    const Shape *all   = make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    Seen         group = lower(all, lowered_groups_new(g, &arena, &arena, LEAST));
    assert_int_equal(g->instances->tables.count, 1);
    now = 0.5;
    prepare(&group);
    assert_true(tape_frame_infinite(&group.tape, group.values) == NODE_NONE);
    now = 7;
    prepare(&group);
    Node found = tape_frame_infinite(&group.tape, group.values);
    assert_true(found != NODE_NONE && !isfinite(group.values[found].v[0]));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, start, finish)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(moving_parts),
        TEST(frames_have_grids),
        TEST(moving_parts_are_simplified),
        TEST(infinite_numbers_are_found),
    };
    return cmocka_run_group_tests_name("moving instance groups", tests, NULL, NULL);
}
