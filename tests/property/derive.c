/*
 * derive.c: derivatives against differences of values.
 *
 * Each operation that works component by component, and each rule for the others, is put on
 * expressions of the point and derived; at random points the derivative must agree with central
 * differences.  Near kinks and poles two differences of different width disagree with each other;
 * such points prove nothing and are left out, but most must remain.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/derive.h"

#include "tests/support/bench.h"

static double uniform(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static double value_at(Bench *b, Node node, const double point[3])
{
    Tape       tape   = tape_new(b->graph, &node, 1, &b->arena);
    NodeValue *values = arena_new_array(&b->arena, NodeValue, b->graph->count);
    NodeValue  time   = {{0.3, 0, 0, 0}};
    tape_run_frame(&tape, &time, values);
    tape_run_point(&tape, point, values);
    return values[node].v[0];
}

static double difference(Bench *b, Node node, const double point[3], int axis, double step)
{
    double before[3] = {point[0], point[1], point[2]}, after[3] = {point[0], point[1], point[2]};
    before[axis] -= step;
    after[axis] += step;
    return (value_at(b, node, after) - value_at(b, node, before)) / (2 * step);
}

/* Checks the derivatives of a FLOAT; returns how many of the points told something. */
static int check_derivatives(Bench *b, const char *name, Node root)
{
    Node     partial[3], blame = NODE_NONE;
    uint32_t seed = 7;
    int      told = 0;
    if (graph_derive(b->graph, root, partial, &blame, &b->arena) == DERIVED_NOT)
        fail_msg("%s: no derivative of %s", name, graph_op_name(b->graph->items[blame].op));
    for (int i = 0; i < 60; i++) {
        double point[3];
        for (int k = 0; k < 3; k++)
            point[k] = 3 * uniform(&seed) - 1.5;
        for (int axis = 0; axis < 3; axis++) {
            double coarse = difference(b, root, point, axis, 2e-5);
            double fine   = difference(b, root, point, axis, 1e-5);
            double exact  = value_at(b, partial[axis], point);
            double slack  = 1e-6 * (1 + fabs(fine));
            if (!isfinite(coarse) || !isfinite(fine) || fabs(coarse - fine) > slack)
                continue;
            told++;
            if (!(fabs(exact - fine) <= 20 * slack))
                fail_msg("%s by axis %d at [%g, %g, %g]: %.9g, differences say %.9g", name, axis,
                         point[0], point[1], point[2], exact, fine);
        }
    }
    return told;
}

/* Three expressions with values of all signs, for operands a, b, c. */
static void mixed_operands(Bench *b, Node operands[3])
{
    Graph *g    = b->graph;
    Node   half = graph_number(g, 0.5);
    Node   sine = graph_op1(g, OP_sin, b->x), part = graph_op2(g, OP_mul, b->y, half);
    operands[0] = graph_op2(g, OP_add, sine, part);
    operands[1] = graph_op2(g, OP_sub, graph_op2(g, OP_mul, b->y, b->z), half);
    operands[2] = graph_op2(g, OP_add, graph_op1(g, OP_square, b->z), b->x);
}

/* The same with values between 0 and 1, in order: for domains and edges. */
static void small_operands(Bench *b, Node operands[3])
{
    static const double low[3] = {0.31, 1.12, 0.62};
    mixed_operands(b, operands);
    for (int i = 0; i < 3; i++) {
        Node waves  = graph_op1(b->graph, OP_sin, operands[i]);
        Node scaled = graph_op2(b->graph, OP_mul, waves, graph_number(b->graph, 0.3));
        operands[i] = graph_op2(b->graph, OP_add, scaled, graph_number(b->graph, low[i]));
    }
}

static void componentwise_rows_derive(void **state)
{
    static const struct {
        Op          op;
        int         arity;
        const char *name;
    } rows[] = {
#define MAP(name, arity, ...) {OP_##name, arity, #name},
#include "compiler/graph/ops.def"
    };
    Bench *b = *state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Node operands[3];
        int  told = 0;
        mixed_operands(b, operands);
        told += check_derivatives(b, rows[i].name, graph_op(b->graph, rows[i].op, operands));
        small_operands(b, operands);
        told += check_derivatives(b, rows[i].name, graph_op(b->graph, rows[i].op, operands));
        if (told < 150)
            fail_msg("%s: only %d points told something", rows[i].name, told);
    }
}

static void vector_rules_derive(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   o[3], q;
    mixed_operands(b, o);
    q         = graph_op(g, OP_vec3, o);
    Node axis = graph_vec3(g, 0.6, 0, 0.8), number = graph_op2(g, OP_add, o[1], b->x);
    Node rows[] = {graph_vec3(g, 0, 1, 0), graph_vec3(g, -1, 0, 0), graph_vec3(g, 0, 0, 1)};
    Node less   = graph_op2(g, OP_less, o[0], o[1]);
    Node made[] = {
        graph_op2(g, OP_dot, q, b->point),
        graph_op1(g, OP_length, q),
        graph_component(g, graph_op2(g, OP_cross, q, b->point), 1),
        graph_component(g, graph_op1(g, OP_normalize, q), 2),
        graph_component(g, graph_op2(g, OP_scale, q, number), 0),
        graph_component(g, graph_op4(g, OP_rotate, q, rows[0], rows[1], rows[2]), 0),
        graph_component(g, graph_op4(g, OP_rotate, b->point, q, rows[1], b->point), 0),
        graph_component(g, graph_op4(g, OP_rotate, b->point, q, rows[1], b->point), 2),
        graph_op1(g, OP_length, graph_op3(g, OP_fold, q, axis, graph_number(g, 0.1))),
        graph_op3(g, OP_select, less, o[2], graph_op2(g, OP_mul, o[0], o[2])),
        graph_op1(g, OP_length, graph_op2(g, OP_vec2, o[0], o[2])),
        graph_op1(g, OP_length, graph_op1(g, OP_splat3, o[0])),
        graph_op1(g, OP_length, graph_op2(g, OP_max, graph_op1(g, OP_abs, q), b->point)),
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        char name[16];
        snprintf(name, sizeof name, "rule %zu", i);
        assert_true(check_derivatives(b, name, made[i]) > 150);
    }
}

/* Blends, at points where both count, on steps and cuts, and where the width is nothing. */
static void blends_derive(void **state)
{
    static const struct {
        Op          op;
        const char *name;
    } rows[] = {
        {OP_blend_weight, "weight"},
#define BLEND(name, ...) {OP_smin_##name, #name},
#include "compiler/graph/blends.def"
    };
    Bench *b = *state;
    Graph *g = b->graph;
    Node   o[4];
    mixed_operands(b, o);
    o[3] = graph_number(g, 3); /* steps, of those that have some */
    for (double width = 0; width < 3; width += 0.8) {
        o[2] = graph_number(g, width);
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
            assert_true(check_derivatives(b, rows[i].name, graph_op(g, rows[i].op, o)) > 150);
    }
}

/* Blends of more than two, which share the result. */
static void shares_derive(void **state)
{
    static const struct {
        Op          of_four, of_eight;
        const char *name;
    } rows[] = {
#define BLEND_SHARES(name, ...) {OP_smin4_##name, OP_smin8_##name, #name},
#include "compiler/graph/blends.def"
    };
    Bench *b = *state;
    Graph *g = b->graph;
    Node   o[4], half = graph_number(g, 0.5);
    mixed_operands(b, o);
    o[3]      = graph_component(g, b->point, 0);
    Node four = graph_op(g, OP_vec4, o), more = graph_op2(g, OP_mul, four, half);
    for (double width = 0; width < 3; width += 0.8)
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            Node k = graph_number(g, width);
            assert_true(check_derivatives(b, rows[i].name, graph_op2(g, rows[i].of_four, four, k)) >
                        150);
            assert_true(check_derivatives(b, rows[i].name,
                                          graph_op3(g, rows[i].of_eight, four, more, k)) > 150);
        }
}

static void sectors_derive(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   o[3];
    mixed_operands(b, o);
    Node q = graph_op(g, OP_vec3, o);
    for (double count = 0; count < 9; count += 4) {
        Node cell = graph_op2(g, OP_cell_polar, q, graph_number(g, count));
        for (uint32_t i = 0; i < 3; i++)
            assert_true(check_derivatives(b, "sector", graph_component(g, cell, i)) > 150);
    }
}

static void assert_near(double value, double expected, double slack)
{
    if (!(fabs(value - expected) <= slack))
        fail_msg("%.9g instead of %.9g", value, expected);
}

/* Where lengths are 0, and where the lesser of two is chosen, no 0 / 0 comes out. */
static void derivatives_of_boxes_are_numbers(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   partial[3], zero = graph_number(g, 0);
    Node   size    = graph_op1(g, OP_abs, b->point);
    Node   excess  = graph_op2(g, OP_sub, size, graph_vec3(g, 1, 2, 3));
    Node   outside = graph_op1(g, OP_length, graph_op2(g, OP_max, excess, zero));
    Node   across = graph_component(g, excess, 0), up = graph_component(g, excess, 1);
    Node   most = graph_op2(g, OP_max, across, up);
    most        = graph_op2(g, OP_max, most, graph_component(g, excess, 2));
    Node box    = graph_op2(g, OP_add, outside, graph_op2(g, OP_min, most, zero));
    assert_int_equal(graph_derive(g, box, partial, NULL, &b->arena), DERIVED_BETWEEN);
    const double inside[3] = {0.9, 0.5, -0.3}, face[3] = {1, 0.5, -0.3}, out[3] = {4, 6, 3.5};
    for (int i = 0; i < 3; i++) {
        assert_near(value_at(b, partial[i], inside), i == 0, 1e-12);
        assert_near(value_at(b, partial[i], face), i == 0, 1e-12);
        assert_near(value_at(b, partial[i], out), (double[]){3, 4, 0.5}[i] / sqrt(25.25), 1e-12);
    }
}

/* f / |grad f| with the divisor still: on the surface the gradient is a unit vector. */
static void what_is_still_has_no_derivative(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   gradient, of_share;
    Node   f = graph_op2(g, OP_sub, graph_op2(g, OP_mul, b->x, b->y), b->z);
    assert_int_equal(graph_gradient(g, f, &gradient, NULL, &b->arena), DERIVED_SMOOTH);
    Node steep = graph_op1(g, OP_length, gradient);
    Node share = graph_op2(g, OP_div, f, steep);
    assert_int_equal(graph_gradient_of(g, share, &steep, 1, &of_share, NULL, &b->arena),
                     DERIVED_SMOOTH);
    const double point[3] = {1.3, -0.4, 0.9}, size = sqrt(0.16 + 1.69 + 1);
    for (uint32_t i = 0; i < 3; i++)
        assert_near(value_at(b, graph_component(g, of_share, i), point),
                    (double[]){-0.4, 1.3, -1}[i] / size, 1e-12);
}

static void smooth_ones_derive_twice(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   o[3], partial[3];
    mixed_operands(b, o);
    Node quotient = graph_op2(
        g, OP_div, o[0], graph_op2(g, OP_add, graph_op1(g, OP_square, o[1]), graph_number(g, 1)));
    Node root = graph_op2(g, OP_mul, quotient, graph_op1(g, OP_exp, o[2]));
    assert_int_equal(graph_derive(g, root, partial, NULL, &b->arena), DERIVED_SMOOTH);
    for (int i = 0; i < 3; i++)
        assert_true(check_derivatives(b, "second derivative", partial[i]) > 150);
}

static void kinks_and_gaps_are_told(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   partial[3], blame = NODE_NONE;
    Node   kink = graph_op1(g, OP_abs, b->x);
    assert_int_equal(graph_derive(g, kink, partial, NULL, &b->arena), DERIVED_BETWEEN);
    Node hills = graph_op1(g, OP_noise3, b->point);
    Node sum   = graph_op2(g, OP_add, hills, b->z);
    assert_int_equal(graph_derive(g, sum, partial, &blame, &b->arena), DERIVED_NOT);
    assert_int_equal(blame, hills);
    Node width = graph_op3(g, OP_smin_cubic, b->x, b->y, b->z);
    assert_int_equal(graph_derive(g, width, partial, &blame, &b->arena), DERIVED_NOT);
    Node constant = graph_number(g, 4);
    assert_int_equal(graph_derive(g, constant, partial, NULL, &b->arena), DERIVED_SMOOTH);
    assert_int_equal(partial[0], graph_number(g, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(componentwise_rows_derive, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(vector_rules_derive, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(blends_derive, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(shares_derive, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(sectors_derive, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(derivatives_of_boxes_are_numbers, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(what_is_still_has_no_derivative, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(smooth_ones_derive_twice, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(kinks_and_gaps_are_told, bench_start, bench_stop),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
