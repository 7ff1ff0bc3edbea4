/*
 * parity.c: what is called even is even: random expressions, and ones that must be seen.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/parity.h"
#include "tests/support/random.h"

static jmp_buf exhausted;
static Memory  memory = {.exhausted = &exhausted};

static Random chance = {99};

static uint32_t draw(uint32_t below) { return random_below(&chance, below); }

static double value_at(const Graph *graph, Node root, double x, double y, double z, Arena *arena)
{
    Tape       tape       = tape_new(graph, &root, 1, arena);
    NodeValue *values     = arena_new_array(arena, NodeValue, graph->count);
    NodeValue  parameters = {{0}};
    tape_run_frame(&tape, &parameters, values);
    tape_run_point(&tape, (double[]){x, y, z}, values);
    return values[root].v[0];
}

/* Returns a random FLOAT of the coordinates and constants. */
static Node random_float(Graph *g, uint32_t depth)
{
    static const Op unary[]  = {OP_neg,    OP_abs,  OP_sin,   OP_cos,
                                OP_square, OP_atan, OP_floor, OP_tanh};
    static const Op binary[] = {OP_add, OP_sub, OP_mul, OP_min, OP_max};
    if (depth == 0 || draw(6) == 0) {
        Node point = graph_leaf(g, OP_POINT);
        return draw(3) ? graph_component(g, point, draw(3)) : graph_number(g, (double)draw(5) - 2);
    }
    Node a = random_float(g, depth - 1);
    switch (draw(5)) {
    case 0: return graph_op1(g, unary[draw(sizeof unary / sizeof *unary)], a);
    case 1: {
        Node b = random_float(g, depth - 1), v = graph_op2(g, OP_vec2, a, b);
        return graph_op1(g, OP_length, v);
    }
    case 2: {
        Node b = random_float(g, depth - 1), c = random_float(g, depth - 1);
        Node less = graph_op2(g, OP_less, a, b);
        return graph_op3(g, OP_select, less, b, c);
    }
    default: {
        Node b = random_float(g, depth - 1);
        return graph_op2(g, binary[draw(sizeof binary / sizeof *binary)], a, b);
    }
    }
}

static void random_expressions_keep_their_word(void **context)
{
    (void)context;
    size_t even = 0, refuted = 0;
    for (int trial = 0; trial < 4000; trial++) {
        Arena  arena = {.memory = &memory};
        Graph *graph = graph_new(&arena);
        Node   root  = random_float(graph, 4);
        bool   said  = graph_is_even(graph, root, 0, &arena);
        even += said;
        bool differs = false;
        for (int i = 0; i < 8; i++) {
            double x = draw(1000) * 0.0037 - 1.7;
            double y = draw(1000) * 0.004 - 2, z = draw(1000) * 0.004 - 2;
            double here  = value_at(graph, root, x, y, z, &arena);
            double there = value_at(graph, root, -x, y, z, &arena);
            differs      = differs || fabs(here - there) > 1e-9 * (1 + fabs(here));
        }
        refuted += differs;
        assert_false(said && differs);
        arena_free(&arena);
    }
    /* Both answers come up often, so neither is vacuous. */
    assert_true(even > 400 && refuted > 400);
}

static void what_libraries_write_is_seen(void **context)
{
    (void)context;
    Arena  arena = {.memory = &memory};
    Graph *g     = graph_new(&arena);
    Node   point = graph_leaf(g, OP_POINT);
    Node   half = graph_vec3(g, 1, 2, 3), zero = graph_number(g, 0);
    Node   ball = graph_op1(g, OP_length, point);
    assert_true(graph_is_even(g, ball, 0, &arena));

    Node size    = graph_op1(g, OP_abs, point);
    Node excess  = graph_op2(g, OP_sub, size, half);
    Node outside = graph_op2(g, OP_max, excess, zero);
    Node box     = graph_op1(g, OP_length, outside);
    assert_true(graph_is_even(g, box, 1, &arena));

    Node lateral = graph_vec3(g, 1, 0, 0);
    Node moved   = graph_op2(g, OP_sub, point, lateral);
    Node other   = graph_op1(g, OP_length, moved);
    assert_false(graph_is_even(g, other, 0, &arena));
    assert_true(graph_is_even(g, other, 2, &arena));

    /* A quarter turn about y swaps x and z: still even in both. */
    Node r0 = graph_vec3(g, 0, 0, 1), r1 = graph_vec3(g, 0, 1, 0), r2 = graph_vec3(g, -1, 0, 0);
    Node turned      = graph_op4(g, OP_rotate, point, r0, r1, r2);
    Node long_size   = graph_op1(g, OP_abs, turned);
    Node long_excess = graph_op2(g, OP_sub, long_size, half);
    Node long_box    = graph_op1(g, OP_length, long_excess);
    assert_true(graph_is_even(g, long_box, 0, &arena));
    arena_free(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_expressions_keep_their_word),
        cmocka_unit_test(what_libraries_write_is_seen),
    };
    if (setjmp(exhausted) != 0)
        return 1;
    return cmocka_run_group_tests_name("parity", tests, NULL, NULL);
}
