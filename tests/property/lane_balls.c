/*
 * lane_balls.c: ranges that know how fast steps change hold what is found in the box, and what is pruned by them is
 * the same there; along a chain of mirrors and turns they are narrow where those of boxes are wide; and
 * what is told to be undecided has no second derivatives.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/lanes/lanes.h"

#include "tests/property/garden.h"

enum { GRAPHS = 1200, POINTS = 45, NODES = 60, LEVELS = 9 };

typedef struct Made {
    Tape       tape;
    NodeValue *values;
    LaneTape   lanes;
    LaneWork   work;
} Made;

static void make(Bench *b, Made *made, Node root, const NodeValue *parameters)
{
    made->tape   = tape_new(b->graph, &root, 1, &b->arena);
    made->values = arena_new_array(&b->arena, NodeValue, b->graph->count);
    tape_run_frame(&made->tape, parameters, made->values);
    made->lanes         = lane_tape_new_steep(&made->tape, &root, 1, false, 0, &b->arena);
    made->lanes.scalars = arena_new_array(&b->arena, double, made->lanes.scalar_count + 1);
    lane_tape_scalars(&made->lanes, made->values, made->lanes.scalars);
    made->work = lane_work_in(arena_alloc(&b->arena, lane_work_bytes(&made->lanes), 1),
                              made->values);
}

static void make_random(Bench *b, Made *made)
{
    b->graph      = graph_new(&b->arena);
    Garden garden = random_garden(b, NODES);
    Place  place  = random_place(b);
    make(b, made, garden.nodes[garden.count - 1 - random_below(&b->random, 20)], place.parameters);
}

static Box random_box(Bench *b, double least)
{
    Box    box;
    double half = pow(2, -random_between(&b->random, least, 6));
    for (int k = 0; k < 3; k++) {
        double middle = random_between(&b->random, -2, 2);
        box.axis[k]   = (Range){middle - half, middle + half};
    }
    return box;
}

static Box half_of(Box box)
{
    for (int k = 0; k < 3; k++)
        box.axis[k].high = box.axis[k].low / 2 + box.axis[k].high / 2;
    return box;
}

typedef struct Tally {
    size_t outside, different, narrower, steps, left;
} Tally;

/* Ranges and a pruned tape of one box, looked at in the points of another one. */
static void try_box(Bench *b, const Made *made, Box known, Box looked, Tally *tally)
{
    double     points[POINTS][3];
    size_t     outputs = made->lanes.output_count;
    double    *whole   = arena_new_array(&b->arena, double, POINTS *outputs), *pruned;
    LaneRanges ranges  = lane_ranges_new(&made->lanes, &b->arena);
    Range      plain   = lane_ranges_run(&made->lanes, &ranges, known);
    Range      closer  = lane_ranges_run_closer(&made->lanes, &ranges, known);
    LaneTape   shorter = lane_prune(&made->lanes, &ranges, outputs, &b->arena);
    pruned             = arena_new_array(&b->arena, double, POINTS *outputs);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = random_between(&b->random, looked.axis[k].low, looked.axis[k].high);
    LanePoints all = {.points = (const double(*)[3])points, .count = POINTS};
    lane_run(&made->lanes, &made->work, LANE_DOUBLE, all, 0, outputs, whole);
    lane_run(&shorter, &made->work, LANE_DOUBLE, all, 0, outputs, pruned);
    for (size_t i = 0; i < POINTS * outputs; i++) {
        Range range = lane_ranges_output(&made->lanes, &ranges, i % outputs);
        tally->outside += !isnan(whole[i]) && !(range.low <= whole[i] && whole[i] <= range.high);
        tally->different += memcmp(&whole[i], &pruned[i], sizeof *whole) != 0 &&
                            !(isnan(whole[i]) && isnan(pruned[i]));
    }
    tally->narrower += closer.high - closer.low < 0.9 * (plain.high - plain.low);
    tally->steps += made->lanes.count;
    tally->left += shorter.count;
}

static void ranges_by_balls_hold(void **state)
{
    Bench *b     = *state;
    Tally  tally = {0}, less = {0};
    for (int turn = 0; turn < GRAPHS; turn++) {
        Made made;
        Box  box = random_box(b, 0);
        make_random(b, &made);
        try_box(b, &made, box, box, &tally);
        if (tally.outside + tally.different > 0)
            fail_msg("graph %d: %zu outside, %zu different", turn, tally.outside, tally.different);
        try_box(b, &made, half_of(box), box, &less);
    }
    assert_true(less.outside > 100); /* too small a box is seen */
}

/* ---- trees ---- */

static Node vector(Graph *g, double x, double y, double z)
{
    Node parts[3] = {graph_number(g, x), graph_number(g, y), graph_number(g, z)};
    return graph_op(g, OP_vec3, parts);
}

/* A ball on each level, and between two of them a mirror, a step and a turn. */
static Node tree_node(Graph *g)
{
    double c = cos(0.5), s = sin(0.5), c2 = cos(1.2), s2 = sin(1.2);
    Node   q = graph_leaf(g, OP_POINT), least = graph_number(g, 1e3);
    for (int level = 0; level < LEVELS; level++) {
        Node turn[4] = {graph_op2(g, OP_sub, q, vector(g, 0, 0.4, 0)), vector(g, c2, 0, s2),
                        vector(g, -s2 * s, c, c2 * s), vector(g, -s2 * c, -s, c2 * c)};
        Node ball    = graph_op2(g, OP_sub, graph_op1(g, OP_length, q), graph_number(g, 0.1));
        least        = graph_op2(g, OP_min, least, ball);
        q            = graph_op(g, OP_rotate, turn);
        q            = graph_op3(g, OP_fold, q, vector(g, 1, 0, 0), graph_number(g, 0));
    }
    return least;
}

static void boxes_do_not_grow_along_a_tree(void **state)
{
    Bench *b     = *state;
    Tally  tally = {0};
    size_t plain = 0;
    b->graph     = graph_new(&b->arena);
    Made made;
    make(b, &made, tree_node(b->graph), NULL);
    for (int turn = 0; turn < 200; turn++) {
        Box        box    = random_box(b, 4);
        LaneRanges ranges = lane_ranges_new(&made.lanes, &b->arena);
        lane_ranges_run(&made.lanes, &ranges, box);
        plain += lane_prune(&made.lanes, &ranges, 1, &b->arena).count;
        try_box(b, &made, box, box, &tally);
    }
    print_message("# of %zu steps %zu are left, %zu by boxes alone\n", tally.steps, tally.left,
                  plain);
    assert_int_equal(tally.outside + tally.different, 0);
    assert_true((double)tally.left < 0.8 * (double)plain);
    assert_true(tally.narrower > 100);
}

/* ---- what is undecided ---- */

static void what_is_undecided_has_no_second_derivatives(void **state)
{
    Bench *b         = *state;
    size_t undecided = 0;
    for (int turn = 0; turn < GRAPHS; turn++) {
        Made        made;
        Box         box = random_box(b, 0);
        LaneSlope   slope;
        LaneHessian hessian;
        if (turn % 4 == 0) {
            b->graph = graph_new(&b->arena);
            make(b, &made, tree_node(b->graph), NULL);
        } else
            make_random(b, &made);
        LaneRanges   ranges   = lane_ranges_new(&made.lanes, &b->arena);
        LaneSlope   *slopes   = lane_slopes_new(&made.lanes, &b->arena);
        LaneHessian *hessians = lane_hessians_new(&made.lanes, &b->arena);
        lane_ranges_run(&made.lanes, &ranges, box);
        lane_slopes_run(&made.lanes, &ranges, slopes, &slope);
        bool known = lane_hessians_run(&made.lanes, &ranges, slopes, hessians, &hessian);
        if (lane_is_undecided(&made.lanes, &ranges)) {
            undecided++;
            if (known && !hessian.flat)
                fail_msg("graph %d has second derivatives", turn);
        }
    }
    print_message("# %zu of %d are undecided\n", undecided, GRAPHS);
    assert_true(undecided > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(ranges_by_balls_hold, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(boxes_do_not_grow_along_a_tree, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(what_is_undecided_has_no_second_derivatives, bench_start,
                                        bench_stop),
    };
    return cmocka_run_group_tests_name("lane_balls", tests, NULL, NULL);
}
