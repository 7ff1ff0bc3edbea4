/*
 * series.c: power series of random polynomials, against their values.
 *
 * Along a line the series must give the value at every t; in a ball it must bound the change of
 * the value in every direction, and its first order must be what differences say.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/series.h"

#include "tests/support/bench.h"

static double uniform(Bench *b) { return random_between(&b->random, 0, 1); }

static double evaluate(Bench *b, Node node, const double point[3])
{
    Arena      arena  = {.memory = b->arena.memory}; /* megabytes, thousands of times */
    Tape       tape   = tape_new(b->graph, &node, 1, &arena);
    NodeValue *values = arena_new_array(&arena, NodeValue, b->graph->count);
    NodeValue  time   = {{0.7, 0, 0, 0}};
    tape_run_frame(&tape, &time, values);
    tape_run_point(&tape, point, values);
    double value = values[node].v[0];
    arena_free(&arena);
    return value;
}

/* Returns a random polynomial with all the operations that polynomials have. */
static Node polynomial(Bench *b, int depth)
{
    Graph *g    = b->graph;
    int    kind = (int)(uniform(b) * (depth > 0 ? 9 : 2));
    if (kind == 0)
        return graph_number(g, 2 * uniform(b) - 1);
    if (kind == 1)
        return graph_component(g, b->point, (uint32_t)(3 * uniform(b)));
    Node p = polynomial(b, depth - 1), q = polynomial(b, depth - 1);
    switch (kind) {
    case 2: return graph_op2(g, OP_add, p, q);
    case 3: return graph_op2(g, OP_sub, p, q);
    case 4: return graph_op2(g, OP_mul, p, q);
    case 5: return graph_op1(g, OP_square, p);
    case 6: return graph_op1(g, OP_neg, graph_op2(g, OP_div, p, graph_number(g, 1.7)));
    case 7: {
        Node shift = graph_vec3(g, uniform(b), uniform(b), uniform(b));
        Node moved = graph_op2(g, OP_sub, b->point, shift);
        return graph_op2(g, OP_sub, graph_op2(g, OP_dot, moved, moved), p);
    }
    default: {
        Node v      = graph_op3(g, OP_vec3, p, q, graph_number(g, 0.4));
        Node cross  = graph_op2(g, OP_cross, v, b->point);
        Node rows[] = {graph_vec3(g, 0, 1, 0), graph_vec3(g, 0, 0, 1), graph_vec3(g, 1, 0, 0)};
        Node turned = graph_op4(g, OP_rotate, cross, rows[0], rows[1], rows[2]);
        Node time   = graph_parameter(g, 0, TYPE_FLOAT);
        return graph_component(g, graph_op2(g, OP_scale, turned, time), 1);
    }
    }
}

/* Returns one that is not too high a polynomial; its series. */
static Node some_polynomial(Bench *b, Series *ball)
{
    for (;;) {
        SeriesFault fault;
        Node        root = polynomial(b, 4);
        if (graph_ball_series(b->graph, root, b->point, ball, &fault, &b->arena))
            return root;
        assert_true(fault.degree > MAX_DEGREE);
    }
}

static void random_point(Bench *b, double size, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = size * (2 * uniform(b) - 1);
}

static double series_at(Bench *b, const Series *series, const double point[3], double t)
{
    double sum = 0;
    for (uint32_t k = series->degree + 1; k-- > 0;)
        sum = sum * t + evaluate(b, series->c[k], point);
    return sum;
}

static void line_series_are_the_polynomial(void **state)
{
    Bench *b = *state;
    for (int i = 0; i < 150; i++) {
        Series      ball, line;
        SeriesFault fault;
        double      ray_direction[3], start[3], point[3];
        Node        root = some_polynomial(b, &ball);
        random_point(b, 1, ray_direction);
        Node direction = graph_vec3(b->graph, ray_direction[0], ray_direction[1], ray_direction[2]);
        assert_true(
            graph_line_series(b->graph, root, b->point, direction, &line, &fault, &b->arena));
        for (int k = 0; k < 5; k++) {
            double t = 4 * uniform(b) - 2;
            random_point(b, 1, start);
            for (int a = 0; a < 3; a++)
                point[a] = start[a] + t * ray_direction[a];
            double exact = evaluate(b, root, point), sum = series_at(b, &line, start, t);
            assert_true(fabs(sum - exact) <= 1e-6 * (1 + fabs(exact)));
        }
    }
}

static void ball_series_bound_the_change(void **state)
{
    Bench *b = *state;
    for (int i = 0; i < 150; i++) {
        Series ball;
        Node   root = some_polynomial(b, &ball);
        for (int k = 0; k < 12; k++) {
            double centre[3], direction[3], point[3], r = exp(4 * uniform(b) - 3);
            random_point(b, 1.5, centre);
            random_point(b, 1, direction);
            double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                                 direction[2] * direction[2]);
            for (int a = 0; a < 3; a++)
                point[a] = centre[a] + r * direction[a] / length;
            double value = evaluate(b, root, centre);
            assert_true(fabs(evaluate(b, ball.c[0], centre) - value) <= 1e-9 * (1 + fabs(value)));
            double most   = series_at(b, &ball, centre, r) - value;
            double change = fabs(evaluate(b, root, point) - value);
            assert_true(change <= most * (1 + 1e-6) + 1e-9);
        }
    }
}

static void first_order_is_the_gradient(void **state)
{
    Bench *b = *state;
    for (int i = 0; i < 100; i++) {
        Series ball;
        double point[3], squares = 0;
        Node   root = some_polynomial(b, &ball);
        if (ball.degree == 0)
            continue;
        random_point(b, 1, point);
        for (int axis = 0; axis < 3; axis++) {
            double before[3] = {point[0], point[1], point[2]};
            double after[3]  = {point[0], point[1], point[2]};
            before[axis] -= 1e-5;
            after[axis] += 1e-5;
            double slope = (evaluate(b, root, after) - evaluate(b, root, before)) / 2e-5;
            squares += slope * slope;
        }
        double gradient = evaluate(b, ball.c[1], point);
        assert_true(fabs(gradient - sqrt(squares)) <= 1e-4 * (1 + gradient));
    }
}

/* (x^2 + y^2 + z^2)^2: the second order of the ball inside is 1, not 3. */
static void quadrics_are_sharp(void **state)
{
    Bench      *b = *state;
    Graph      *g = b->graph;
    Series      ball;
    SeriesFault fault;
    Node        sum      = graph_number(g, -1);
    double      point[3] = {0.3, 0.4, 1.2};
    for (uint32_t i = 0; i < 3; i++)
        sum = graph_op2(g, OP_add, sum, graph_op1(g, OP_square, graph_component(g, b->point, i)));
    assert_true(graph_ball_series(g, sum, b->point, &ball, &fault, &b->arena));
    assert_int_equal(ball.degree, 2);
    assert_true(fabs(evaluate(b, ball.c[1], point) - 2 * 1.3) < 1e-12);
    assert_true(fabs(evaluate(b, ball.c[2], point) - 1) < 1e-6);
    Node square = graph_op1(g, OP_square, sum);
    assert_true(graph_ball_series(g, square, b->point, &ball, &fault, &b->arena));
    assert_int_equal(ball.degree, 4);
    assert_true(fabs(evaluate(b, ball.c[4], point) - 1) < 1e-6);
}

static void other_operations_are_blamed(void **state)
{
    Bench      *b = *state;
    Graph      *g = b->graph;
    Series      series;
    SeriesFault fault;
    Node        x    = graph_component(g, b->point, 0);
    Node        sine = graph_op1(g, OP_sin, x);
    Node        sum  = graph_op2(g, OP_add, graph_op1(g, OP_square, x), sine);
    assert_false(graph_ball_series(g, sum, b->point, &series, &fault, &b->arena));
    assert_int_equal(fault.blame, sine);
    assert_int_equal(fault.degree, 0);
    Node power = graph_power(g, x, graph_number(g, 25));
    assert_false(graph_line_series(g, power, b->point, b->point, &series, &fault, &b->arena));
    assert_int_equal(fault.degree, 25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(line_series_are_the_polynomial, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(ball_series_bound_the_change, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(first_order_is_the_gradient, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(quadrics_are_sharp, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(other_operations_are_blamed, bench_start, bench_stop),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
