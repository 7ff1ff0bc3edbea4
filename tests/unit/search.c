/*
 * search.c: the search for points that refute a distance: of distances made by hand, one wrong in
 * each way, what is wrong in one small place is found; what is true is not refuted.
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/refute/search.h"

#include "tests/support/bench.h"

static const Box around_ball = {{{-1, 1}, {-1, 1}, {-1, 1}}};

/* Returns the distance to the unit ball. */
static Node ball(Bench *b)
{
    Node point = graph_leaf(b->graph, OP_POINT), one = graph_number(b->graph, 1);
    Node distance = graph_op1(b->graph, OP_length, point);
    return graph_op2(b->graph, OP_sub, distance, one);
}

/* Returns the distance from a place near the ball's surface. */
static Node from_spot(Bench *b)
{
    Node point = graph_leaf(b->graph, OP_POINT), spot = graph_vec3(b->graph, 0.36, 0.48, 0.82);
    Node offset = graph_op2(b->graph, OP_sub, point, spot);
    return graph_op1(b->graph, OP_length, offset);
}

static Search search(Bench *b, Node distance, Box box, bool steep, uint64_t operations)
{
    NodeValue parameters[1] = {{{0}}};
    Search    s;
    assert_true(search_new(&s, b->graph, distance, distance, box, &b->arena));
    s.steep  = steep;
    s.random = 1;
    assert_true(search_start(&s, parameters));
    search_run(&s, operations);
    return s;
}

static void what_is_true_stays(void **state)
{
    for (int steep = 0; steep < 2; steep++) {
        Search s = search(*state, ball(*state), around_ball, steep, 5000000);
        assert_false(search_refuted(&s));
        assert_true(s.worst.ratio > 0.999); /* and has been tried hard */
    }
}

static void a_thousandth_too_much_is_found(void **state)
{
    Bench *b      = *state;
    Node   factor = graph_number(b->graph, 1.001);
    Node   longer = graph_op2(b->graph, OP_mul, ball(b), factor);
    for (int steep = 0; steep < 2; steep++) {
        Search s = search(b, longer, around_ball, steep, 5000000);
        assert_true(search_refuted(&s));
        assert_int_equal(s.worst.fault, steep ? FAULT_STEEP : FAULT_LONG);
        assert_float_equal(s.worst.ratio, 1.001, 1e-5);
    }
}

/* The jump has a volume of 10^-7 of the box: random points do not meet it. */
static void a_small_jump_is_found(void **state)
{
    Bench *b     = *state;
    Node   small = graph_number(b->graph, 0.004), high = graph_number(b->graph, 0.5);
    Node   near = graph_op2(b->graph, OP_less, from_spot(b), small);
    Node   jump = graph_op3(b->graph, OP_select, near, high, ball(b));
    Search s    = search(b, jump, around_ball, true, 2000000);
    assert_true(search_refuted(&s));
    assert_true(s.worst.ratio > 1000);
    double off = hypot(hypot(s.worst.p[0] - 0.36, s.worst.p[1] - 0.48), s.worst.p[2] - 0.82);
    assert_true(off < 0.01);
}

/* 0.01 exp(-(away / 0.005)^2): without any branch. */
static void a_small_spike_is_found(void **state)
{
    Bench *b     = *state;
    Node   width = graph_number(b->graph, -1 / (0.005 * 0.005));
    Node   high  = graph_number(b->graph, 0.01);
    Node   power = graph_op2(b->graph, OP_mul, graph_op1(b->graph, OP_square, from_spot(b)), width);
    Node   spike = graph_op2(b->graph, OP_mul, graph_op1(b->graph, OP_exp, power), high);
    Node   bad   = graph_op2(b->graph, OP_add, ball(b), spike);
    Search s     = search(b, bad, around_ball, true, 2000000);
    assert_true(search_refuted(&s));
    assert_true(s.worst.ratio > 2);
}

static void what_is_outside_of_the_box_is_found(void **state)
{
    Box    low = {{{-1, 1}, {-1, 1}, {-1, 0.99}}};
    Search s   = search(*state, ball(*state), low, true, 1000000);
    assert_true(search_refuted(&s));
    assert_int_equal(s.worst.fault, FAULT_OUTSIDE);
    assert_true(s.worst.p[2] > 0.99 && s.worst.at_p < 0);
}

static void what_is_not_a_number_is_found(void **state)
{
    Bench *b    = *state;
    Node   room = graph_op2(b->graph, OP_sub, from_spot(b), graph_number(b->graph, 0.001));
    Node   root = graph_op1(b->graph, OP_sqrt, room); /* of what is negative in a small ball */
    Node   bad  = graph_op2(b->graph, OP_min, ball(b), root);
    bad         = graph_op2(b->graph, OP_add, bad,
                            graph_op2(b->graph, OP_mul, root, graph_number(b->graph, 1e-9)));
    Search s    = search(b, bad, around_ball, true, 2000000);
    assert_true(search_refuted(&s));
    assert_int_equal(s.worst.fault, FAULT_NAN);
}

/* A step beside the distance that tells sides: too long by a fifth behind a place, or for rays of
   some directions only. */
static void steps_are_searched_beside_distances(void **state)
{
    Bench    *b             = *state;
    NodeValue parameters[1] = {{{0}}};
    for (int aimed = 0; aimed < 2; aimed++)
        for (int wrong = 0; wrong < 2; wrong++) {
            Search s;
            Node   side = ball(b), of = graph_leaf(b->graph, aimed ? OP_DIRECTION : OP_POINT);
            Node   x     = graph_component(b->graph, of, 0);
            Node   limit = graph_number(b->graph, aimed ? 0.9 : 1.1);
            Node   there = graph_op2(b->graph, OP_less, limit, x);
            Node   more  = graph_number(b->graph, wrong ? 1.2 : 0.9);
            Node   less  = graph_number(b->graph, 0.8);
            Node   part  = graph_op3(b->graph, OP_select, there, more, less);
            Node   step  = graph_op2(b->graph, OP_mul, side, part);
            assert_true(search_new(&s, b->graph, step, side, around_ball, &b->arena));
            s.random = 1;
            s.aimed  = aimed;
            assert_true(search_start(&s, parameters));
            search_run(&s, 3000000);
            assert_int_equal(search_refuted(&s), wrong);
            if (wrong)
                assert_true(s.worst.fault == FAULT_LONG && fabs(s.worst.ratio - 1.2) < 0.01);
        }
}

int main(void)
{
#define BENCH(test) cmocka_unit_test_setup_teardown(test, bench_start, bench_stop)
    const struct CMUnitTest tests[] = {
        BENCH(what_is_true_stays),
        BENCH(steps_are_searched_beside_distances),
        BENCH(a_thousandth_too_much_is_found),
        BENCH(a_small_jump_is_found),
        BENCH(a_small_spike_is_found),
        BENCH(what_is_outside_of_the_box_is_found),
        BENCH(what_is_not_a_number_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
