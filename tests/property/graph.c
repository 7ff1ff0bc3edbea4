/*
 * graph.c: the graph keeps meaning.
 *
 * Equal expressions are one node; folding, tapes and substitution give what a plain recursive
 * evaluator gives, on graphs made at random from every operation there is.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/print/printer.h"

#include "tests/property/garden.h"

static void equal_expressions_are_one_node(void **state)
{
    Bench *b     = *state;
    Garden first = random_garden(b, 60);
    size_t count = b->graph->count;
    b->random    = (Random){0};
    Garden again = random_garden(b, 60);
    assert_memory_equal(first.nodes, again.nodes, sizeof first.nodes);
    assert_int_equal(b->graph->count, count);

    Node x = graph_component(b->graph, first.nodes[0], 0);
    Node y = graph_component(b->graph, first.nodes[0], 1);
    assert_int_not_equal(x, y);
    Node less = graph_op2(b->graph, OP_sub, x, y), more = graph_op2(b->graph, OP_sub, y, x);
    assert_int_not_equal(less, more);
    Node minus = graph_number(b->graph, -0.0), zero = graph_number(b->graph, 0);
    assert_int_equal(minus, zero);
    Node truth = graph_bool(b->graph, false), none = graph_uint(b->graph, 0);
    assert_int_not_equal(truth, zero);
    assert_int_not_equal(none, zero);
}

static void numbers_are_spread_over_vectors(void **state)
{
    Bench *b     = *state;
    Node   point = graph_leaf(b->graph, OP_POINT), x = graph_component(b->graph, point, 0);
    Node   sum = graph_op2(b->graph, OP_add, x, point);
    assert_int_equal(b->graph->items[sum].type, TYPE_VEC3);
    Place     place = {.point = {1, 2, 3}};
    NodeValue value = evaluate_plainly(b->graph, sum, &place);
    assert_true(value.v[0] == 2 && value.v[1] == 3 && value.v[2] == 4);
    GraphType wrong[] = {TYPE_VEC2, TYPE_VEC3}, truth[] = {TYPE_BOOL, TYPE_FLOAT};
    assert_int_equal(graph_op_type(OP_add, wrong, 2), 0);
    assert_int_equal(graph_op_type(OP_add, truth, 2), 0);
    assert_int_equal(graph_op_type(OP_add, wrong, 1), 0);
    assert_int_equal(graph_op_type(OP_dot, wrong, 2), 0);
}

static void binding_time_is_the_latest_of_operands(void **state)
{
    Bench *b    = *state;
    Graph *g    = b->graph;
    Node   time = graph_parameter(g, 0, TYPE_FLOAT), two = graph_number(g, 2);
    Node   twice = graph_op2(g, OP_mul, time, two), four = graph_op2(g, OP_mul, two, two);
    Node   level = graph_leaf(g, OP_LEVEL), late = graph_op2(g, OP_add, twice, level);
    assert_int_equal(g->items[four].time, TIME_COMPILE);
    assert_int_equal(g->items[twice].time, TIME_FRAME);
    assert_int_equal(g->items[late].time, TIME_POINT);
}

static void constants_are_folded_when_finite(void **state)
{
    Bench *b   = *state;
    Graph *g   = b->graph;
    Node   two = graph_number(g, 2), zero = graph_number(g, 0);
    Node   endless = graph_op2(g, OP_div, two, zero);
    assert_false(graph_is_constant(g, endless));
    Node root = graph_op1(g, OP_sqrt, two);
    assert_true(graph_is_constant(g, root));
    assert_true(g->items[root].number[0] == sqrt(2));
    Node vector = graph_vec3(g, 3, 4, 0), length = graph_op1(g, OP_length, vector);
    assert_true(graph_is_constant(g, length) && g->items[length].number[0] == 5);
}

static void spans_are_those_of_the_author(void **state)
{
    Bench *b     = *state;
    Graph *g     = b->graph;
    Node   point = graph_leaf(g, OP_POINT), length = graph_op1(g, OP_length, point);
    assert_int_equal(g->items[length].span.source, 0);
    g->here = (Span){1, 10, 20};
    assert_int_equal(graph_op1(g, OP_length, point), length);
    g->here = (Span){1, 30, 40};
    assert_int_equal(graph_op1(g, OP_length, point), length);
    assert_int_equal(g->items[length].span.start, 10);
}

static void powers_are_products(void **state)
{
    Bench              *b     = *state;
    Graph              *g     = b->graph;
    Node                point = graph_leaf(g, OP_POINT), x = graph_component(g, point, 0);
    static const double exponents[] = {1, 2, 3, 7, 10, 63, -1, -2, -5, 0.5, -0.5, 0, 2.5, 65};
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        double n        = exponents[i];
        Node   exponent = graph_number(g, n), power = graph_power(g, x, exponent);
        bool   by_pow = g->items[power].op == OP_pow;
        assert_int_equal(by_pow, n == 2.5 || n == 65);
        for (double a = 0.5; a < 2; a += 0.25) {
            Place  place = {.point = {a}};
            double value = evaluate_plainly(g, power, &place).v[0];
            assert_true(fabs(value - pow(a, n)) <= 1e-14 * pow(a, n) * fmax(1, fabs(n)));
        }
    }
    Place negative = {.point = {-2}};
    Node  three = graph_number(g, 3), cube = graph_power(g, x, three);
    assert_true(evaluate_plainly(g, cube, &negative).v[0] == -8);
}

static void tapes_give_what_recursion_gives(void **state)
{
    Bench *b = *state;
    for (int turn = 0; turn < 200; turn++) {
        b->graph      = graph_new(&b->arena);
        Garden garden = random_garden(b, 60);
        Node   roots[3];
        for (int i = 0; i < 3; i++)
            roots[i] = garden.nodes[garden.count - 1 - random_below(&b->random, 20)];
        graph_validate(b->graph, "random_garden");
        Tape       tape   = tape_new(b->graph, roots, 3, &b->arena);
        NodeValue *values = arena_new_array(&b->arena, NodeValue, b->graph->count);
        Place      place  = random_place(b);
        tape_run_frame(&tape, place.parameters, values);
        for (int axis = 0; axis < 3; axis++) {
            place.point[axis] = random_between(&b->random, -2, 2);
            tape_run_point(&tape, place.point, values);
            for (int i = 0; i < 3; i++) {
                GraphType type     = b->graph->items[roots[i]].type;
                NodeValue expected = evaluate_plainly(b->graph, roots[i], &place);
                assert_true(values_same(type, &expected, &values[roots[i]]));
            }
        }
    }
}

static void folding_gives_what_evaluation_gives(void **state)
{
    Bench *b      = *state;
    size_t folded = 0;
    for (int turn = 0; turn < 200; turn++) {
        b->graph      = graph_new(&b->arena);
        Garden garden = random_garden(b, 60);
        Place  place  = random_place(b);
        Node   at     = graph_vec3(b->graph, place.point[0], place.point[1], place.point[2]);
        for (uint32_t i = 0; i < garden.count; i++) {
            Node         root = garden.nodes[i], one = graph_uint(b->graph, 1);
            NodeValue    expected = evaluate_plainly(b->graph, root, &place);
            Substitution with     = substitute_point(at);
            with.instance         = one;
            Node      fixed       = graph_substitute(b->graph, root, with, &b->arena);
            Expr      e           = b->graph->items[fixed];
            NodeValue value       = evaluate_plainly(b->graph, fixed, &place);
            assert_true(values_same(e.type, &expected, &value));
            assert_int_not_equal(e.time, TIME_POINT);
            folded += e.op == OP_CONSTANT;
        }
        graph_validate(b->graph, "graph_substitute");
    }
    assert_true(folded > 3000);
}

static void substitution_moves_the_point(void **state)
{
    Bench *b = *state;
    for (int turn = 0; turn < 100; turn++) {
        b->graph      = graph_new(&b->arena);
        Garden garden = random_garden(b, 60);
        Node   point = garden.nodes[0], twice = graph_op2(b->graph, OP_add, point, point);
        Node   root  = garden.nodes[garden.count - 1];
        Node   moved = graph_substitute(b->graph, root, substitute_point(twice), &b->arena);
        Place  place = random_place(b), far = place;
        for (int i = 0; i < 3; i++)
            far.point[i] *= 2;
        NodeValue expected = evaluate_plainly(b->graph, root, &far);
        NodeValue value    = evaluate_plainly(b->graph, moved, &place);
        assert_true(values_same(b->graph->items[root].type, &expected, &value));
    }
    Node         instance = graph_leaf(b->graph, OP_INSTANCE), seven = graph_uint(b->graph, 7);
    Node         unit = graph_op1(b->graph, OP_id_unit, instance);
    Substitution with = substitute_point(NODE_NONE);
    Node         kept = graph_substitute(b->graph, unit, with, &b->arena);
    with.instance     = seven;
    Node known        = graph_substitute(b->graph, unit, with, &b->arena);
    assert_true(graph_is_constant(b->graph, known));
    assert_int_equal(kept, unit);
}

/* Operands may stand thousands of nodes before the root, a few or many of them. */
static void substitution_finds_what_is_far(void **state)
{
    Bench *b = *state;
    for (int turn = 0; turn < 100; turn++) {
        b->graph    = graph_new(&b->arena);
        Node  point = graph_leaf(b->graph, OP_POINT), sum = graph_number(b->graph, 0);
        Node  twice = graph_op2(b->graph, OP_add, point, point);
        Place place = random_place(b), far = place;
        for (uint32_t part = 1 + random_below(&b->random, 30); part > 0; part--) {
            Garden garden = random_garden(b, 20);
            Node   last   = garden.nodes[garden.count - 1 - random_below(&b->random, 5)];
            for (uint32_t i = random_below(&b->random, 300); i > 0; i--)
                graph_number(b->graph, part + i / 512.0);
            if (b->graph->items[last].type == TYPE_FLOAT)
                sum = graph_op2(b->graph, OP_add, sum, last);
            sum = graph_op2(b->graph, OP_add, sum, graph_component(b->graph, point, part % 3));
        }
        Node moved = graph_substitute(b->graph, sum, substitute_point(twice), &b->arena);
        for (int i = 0; i < 3; i++)
            far.point[i] *= 2;
        NodeValue expected = evaluate_plainly(b->graph, sum, &far);
        NodeValue value    = evaluate_plainly(b->graph, moved, &place);
        assert_true(values_same(TYPE_FLOAT, &expected, &value));
        graph_validate(b->graph, "graph_substitute");
    }
}

/* What the text of an operation calls is printed for some type of its first operand, with all that
   it calls before it. */
static bool helper_is_there(Bench *b, Op op, const char *call)
{
    size_t length = strcspn(call, "("); /* "krs_pow" */
    for (GraphType type = TYPE_FLOAT; type <= TYPE_UINT; type++) {
        Text text = {.arena = &b->arena};
        if (!module_print_helpers(&glsl_printer, op, type, 2, &text))
            continue;
        char *name = arena_copy_text(&b->arena, call, length);
        return strstr(text.bytes, name) != NULL;
    }
    return false;
}

static void every_row_can_be_emitted(void **state)
{
    Bench *b = *state;
    for (Op op = OP_COMPONENT + 1; op < OP_COUNT; op++) {
        const char *glsl = op_glsl(op);
        if (op_has_traits(op, READS_TABLES) || op_has_traits(op, OF_HOST)) {
            /* functions of the module: print/instances.c; or none is needed */
            assert_null(glsl);
            continue;
        }
        assert_non_null(glsl);
        assert_non_null(strstr(glsl, "$a"));
        const char *semicolon = strchr(glsl, ';'); /* behind the statement that sets $t */
        assert_int_equal(semicolon != NULL, strstr(glsl, "$t") != NULL);
        if (semicolon) {
            assert_int_equal(strncmp(glsl, "float $t = ", 11), 0);
            assert_non_null(strstr(semicolon, "$t"));
            assert_null(strchr(semicolon + 1, ';'));
        }
        const char *call = strstr(glsl, "krs_");
        if (call)
            assert_true(helper_is_there(b, op, call));
    }
    assert_null(strstr(op_glsl(OP_smin_quadratic), "krs_")); /* thousands of calls are slow */
    Text spread = {.arena = &b->arena}, *of_three = &spread;
    assert_true(module_print_helpers(&glsl_printer, OP_pow, TYPE_VEC3, 2, of_three));
    assert_non_null(strstr(of_three->bytes, "float krs_pow(float a, float b)\n"));
    assert_non_null(strstr(of_three->bytes, "vec3 krs_pow_vec3(vec3 a, vec3 b)\n"));
    assert_null(strstr(of_three->bytes, "vec2"));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_start, bench_stop)
    const struct CMUnitTest tests[] = {
        TEST(equal_expressions_are_one_node),
        TEST(numbers_are_spread_over_vectors),
        TEST(binding_time_is_the_latest_of_operands),
        TEST(constants_are_folded_when_finite),
        TEST(spans_are_those_of_the_author),
        TEST(powers_are_products),
        TEST(tapes_give_what_recursion_gives),
        TEST(folding_gives_what_evaluation_gives),
        TEST(substitution_moves_the_point),
        TEST(substitution_finds_what_is_far),
        TEST(every_row_can_be_emitted),
    };
    return cmocka_run_group_tests_name("graph", tests, NULL, NULL);
}
