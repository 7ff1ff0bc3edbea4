/*
 * zeros.c: boxes around the zeros of polynomials, against the values of these.
 *
 * Outside of the box a polynomial must have the sign that is promised, near the box and very far
 * away, wherever it is looked at; and boxes of surfaces whose extent is known must be there, and
 * hardly larger.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/zeros.h"

#include "tests/support/bench.h"

static double uniform(Bench *b) { return random_between(&b->random, 0, 1); }

static Node power(Bench *b, Node p, int n)
{
    return n == 1 ? p : mul(b->graph, power(b, p, n - 1), p);
}

/* Returns a sum of products of few factors, of degree `degree` at most, most often with even powers
   that keep it bounded. */
static Node random_polynomial(Bench *b, int degree)
{
    Node axes[3] = {b->x, b->y, b->z},
         sum     = graph_number(b->graph, random_between(&b->random, -3, 3));
    bool bounded = uniform(b) < 0.7;
    for (int i = 0; bounded && i < 3; i++) {
        Node even = power(b, axes[i], degree - degree % 2);
        sum = add(b->graph, sum, mul(b->graph, graph_number(b->graph, 0.2 + uniform(b)), even));
    }
    for (int term = 0; term < 5; term++) {
        Node product = graph_number(b->graph, random_between(&b->random, -1, 1));
        for (int left = (int)(degree * uniform(b)); left > 0; left--) {
            Node shift = graph_number(b->graph, random_between(&b->random, -2, 2));
            product    = mul(b->graph, product, add(b->graph, axes[(int)(3 * uniform(b))], shift));
        }
        sum = add(b->graph, sum, product);
    }
    return sum;
}

static double value_at(const Tape *tape, Node root, NodeValue *values, const double point[3])
{
    tape_run_point(tape, point, values);
    return values[root].v[0];
}

/* A point outside of the box: near, or up to a million times as far away. */
static bool draw_outside(Bench *b, Box box, double point[3])
{
    double size = 10, far = size * pow(10, 7 * uniform(b) - 1);
    bool   outside = false;
    for (int i = 0; i < 3; i++) {
        Range  side  = box.axis[i];
        double low   = isfinite(side.low) ? side.low : -size;
        double high  = isfinite(side.high) ? side.high : size;
        double grown = uniform(b) < 0.5 ? far : 0.01 * size * uniform(b);
        point[i]     = low - grown + (high - low + 2 * grown) * uniform(b);
        outside      = outside || point[i] < side.low || point[i] > side.high;
    }
    return outside;
}

static void signs_are_kept(void **state)
{
    Bench *b       = *state;
    int    bounded = 0, asked = 0;
    for (int i = 0; i < 120; i++) {
        int        degree = 2 + (int)(11 * uniform(b));
        Node       root   = random_polynomial(b, degree);
        Arena      arena  = {.memory = b->arena.memory};
        ZeroBox    found  = graph_zero_box(b->graph, root, &arena);
        Tape       tape   = tape_new(b->graph, &root, 1, &arena);
        NodeValue *values = arena_new_array(&arena, NodeValue, b->graph->count), time = {{0}};
        tape_run_frame(&tape, &time, values);
        bounded += found.sign != 0;
        for (int k = 0; k < 300 && found.sign != 0; k++) {
            double point[3];
            if (!draw_outside(b, found.box, point))
                continue;
            asked++;
            double value = value_at(&tape, root, values, point);
            if (isfinite(value))
                assert_true(found.sign > 0 ? value > 0 : value < 0);
        }
        arena_free(&arena);
    }
    assert_true(bounded > 50 && asked > 4000);
}

/* The box reaches from -high to high, and no more than `slack` times as far. */
static void assert_reach(Bench *b, Node polynomial, int sign, double slack, double x, double y,
                         double z)
{
    Arena   arena   = {.memory = b->arena.memory};
    ZeroBox found   = graph_zero_box(b->graph, polynomial, &arena);
    double  high[3] = {x, y, z};
    assert_int_equal(found.sign, sign);
    for (int i = 0; i < 3; i++) {
        assert_true(found.box.axis[i].high >= high[i] && found.box.axis[i].low <= -high[i]);
        assert_true(isinf(high[i]) || (found.box.axis[i].high <= slack * high[i] &&
                                       found.box.axis[i].low >= -slack * high[i]));
    }
    arena_free(&arena);
}

static void known_extents_are_found(void **state)
{
    Bench *b  = *state;
    Node   x2 = power(b, b->x, 2), y2 = power(b, b->y, 2), z2 = power(b, b->z, 2);
    Node   square = add(b->graph, add(b->graph, x2, y2), z2), one = graph_number(b->graph, 1);
    assert_reach(b, sub(b->graph, square, one), 1, 1.1, 1, 1, 1);
    assert_reach(b, sub(b->graph, one, square), -1, 1.1, 1, 1, 1);
    assert_reach(b, sub(b->graph, add(b->graph, x2, z2), one), 1, 1.1, 1, INFINITY, 1);
    /* A double torus, whose leading form is x^8: the extents of its curve, and 0.1 in z. */
    Node curve = sub(b->graph, mul(b->graph, x2, sub(b->graph, one, x2)), y2);
    Node torus = sub(b->graph, add(b->graph, power(b, curve, 2), z2), graph_number(b->graph, 0.01));
    assert_reach(b, torus, 1, 1.2, 1.0448, 0.5917, 0.1);
    /* A ring of radii 1 and 0.25. */
    Node ring = power(b, add(b->graph, square, graph_number(b->graph, 1 - 0.0625)), 2);
    ring = sub(b->graph, ring, mul(b->graph, graph_number(b->graph, 4), add(b->graph, x2, z2)));
    assert_reach(b, ring, 1, 6, 1.25, 0.25, 1.25);
    /* A cone has no ends. */
    assert_reach(b, sub(b->graph, add(b->graph, x2, y2), z2), 0, 1, INFINITY, INFINITY, INFINITY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(signs_are_kept, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(known_extents_are_found, bench_start, bench_stop),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("zeros", tests, NULL, NULL);
}
