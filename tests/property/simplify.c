/*
 * simplify.c: simplification keeps values, on graphs made at random, and its rules do what they
 * say.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/rewrite/simplify.h"

#include "tests/property/garden.h"

/* Returns how much a value changes when what goes in is off by a few roundings: where that is much,
   a rule that gathers constants may show as much. */
static double sensitivity(const Graph *graph, Node root, const Place *place)
{
    GraphType type  = graph->items[root].type;
    NodeValue value = evaluate_plainly(graph, root, place);
    double    most  = 0;
    for (int i = 0; i < 8; i++) {
        Place  near   = *place;
        double factor = 1 + (i % 2 ? 1 : -1) * 1e-13;
        for (int j = 0; j < 3; j++)
            near.point[j] *= i / 2 == j || i / 2 == 3 ? factor : 1;
        near.parameters[0].v[0] *= i / 2 == 3 ? factor : 1;
        near.parameters[1].v[0] *= i / 2 == 3 ? factor : 1;
        NodeValue other = evaluate_plainly(graph, root, &near);
        most            = fmax(most, value_apart(type, &value, &other));
    }
    return most;
}

static void simplification_keeps_values(void **state)
{
    Bench *b      = *state;
    size_t before = 0, after = 0, compared = 0, exact = 0;
    for (int turn = 0; turn < 2000; turn++) {
        arena_free(&b->arena);
        b->graph           = graph_new(&b->arena);
        Garden garden      = random_garden(b, 50);
        Node   root        = garden.nodes[garden.count - 1 - random_below(&b->random, 15)];
        Node   simple_root = root;
        Graph *simple      = graph_simplify(b->graph, &simple_root, 1, &b->arena);
        graph_validate(simple, "graph_simplify");
        GraphType type = b->graph->items[root].type;
        assert_int_equal(simple->items[simple_root].type, type);
        before += tape_new(b->graph, &root, 1, &b->arena).count;
        after += simple->count;
        for (int i = 0; i < 5; i++) {
            Place     place    = random_place(b);
            NodeValue expected = evaluate_plainly(b->graph, root, &place);
            NodeValue value    = evaluate_plainly(simple, simple_root, &place);
            double    size     = value_magnitude(type, &expected);
            if (size == HUGE_VAL)
                continue;
            double slack = 1e-12 * size + 1e-15 + 4 * sensitivity(b->graph, root, &place);
            if (!(value_apart(type, &expected, &value) <= slack))
                fail_msg("graph %d: %.17g became %.17g", turn, expected.v[0], value.v[0]);
            compared++;
            exact += values_same(type, &expected, &value);
        }
    }
    assert_true(compared > 6000 && exact > 9 * compared / 10);
    assert_true(after < before);
}

static void simplification_is_done_at_once(void **state)
{
    Bench *b = *state;
    for (int turn = 0; turn < 300; turn++) {
        b->graph      = graph_new(&b->arena);
        Garden garden = random_garden(b, 50);
        Node   root   = garden.nodes[garden.count - 1];
        Graph *once   = graph_simplify(b->graph, &root, 1, &b->arena);
        Node   again  = root;
        Graph *twice  = graph_simplify(once, &again, 1, &b->arena);
        assert_int_equal(once->count, twice->count);
        assert_int_equal(once->parameters.count, b->graph->parameters.count);
    }
}

/* What `root` simplifies to, printed. */
static const char *simplified(Bench *b, Node root)
{
    Text   text   = {.arena = &b->arena};
    Graph *simple = graph_simplify(b->graph, &root, 1, &b->arena);
    graph_print(simple, NULL, &root, 1, &text);
    return text.bytes;
}

static void rules_do_what_they_say(void **state)
{
    Bench      *b     = *state;
    Graph      *g     = b->graph;
    Node        point = graph_leaf(g, OP_POINT), x = graph_component(g, point, 0);
    Node        y = graph_component(g, point, 1), z = graph_component(g, point, 2);
    Node        zero = graph_number(g, 0), one = graph_number(g, 1), two = graph_number(g, 2);
    const char *only_x     = "%0 vec3 point = point\n%1 float point = component %0 0\nroot %1\n";
    const char *only_point = "%0 vec3 point = point\nroot %0\n";
    const char *nothing    = "%0 float constant = 0\nroot %0\n";

    Node minus = graph_op1(g, OP_neg, x), back = graph_op1(g, OP_neg, minus);
    assert_string_equal(simplified(b, graph_op2(g, OP_add, x, zero)), only_x);
    assert_string_equal(simplified(b, graph_op2(g, OP_mul, one, x)), only_x);
    assert_string_equal(simplified(b, back), only_x);
    assert_string_equal(simplified(b, graph_op2(g, OP_min, x, back)), only_x);
    assert_string_equal(simplified(b, graph_op2(g, OP_mul, x, zero)), nothing);
    assert_string_equal(simplified(b, graph_op2(g, OP_add, x, minus)), nothing);

    Node more = graph_op2(g, OP_add, x, two), less = graph_op2(g, OP_sub, more, two);
    assert_string_equal(simplified(b, less), only_x);
    Node rebuilt = graph_op3(g, OP_vec3, x, y, z);
    assert_string_equal(simplified(b, rebuilt), only_point);
    Node built = graph_op3(g, OP_vec3, y, x, z);
    assert_string_equal(simplified(b, graph_component(g, built, 1)), only_x);

    Node truth = graph_op2(g, OP_less, x, y), yes = graph_bool(g, true);
    assert_string_equal(simplified(b, graph_op3(g, OP_select, truth, x, x)), only_x);
    assert_string_equal(simplified(b, graph_op3(g, OP_select, yes, x, y)), only_x);

    Node inverse = graph_op2(g, OP_div, one, x), not_zero = graph_op2(g, OP_mul, inverse, zero);
    assert_non_null(strstr(simplified(b, not_zero), "mul"));
    Node none = graph_op2(g, OP_sub, inverse, inverse), scaled = graph_op1(g, OP_splat3, inverse);
    scaled = graph_op2(g, OP_scale, scaled, zero);
    assert_non_null(strstr(simplified(b, none), "sub"));
    assert_non_null(strstr(simplified(b, scaled), "scale"));

    Node xx = graph_op2(g, OP_mul, x, x), yy = graph_op2(g, OP_mul, y, y);
    Node zz  = graph_op2(g, OP_mul, z, z);
    Node sum = graph_op2(g, OP_add, xx, yy), all = graph_op2(g, OP_add, sum, zz);
    assert_string_equal(simplified(b, graph_op1(g, OP_sqrt, all)),
                        "%0 vec3 point = point\n%1 float point = length %0\nroot %1\n");
}

static void rules_leave_what_they_do_not_mean(void **state)
{
    Bench *b     = *state;
    Graph *g     = b->graph;
    Node   point = graph_leaf(g, OP_POINT), x = graph_component(g, point, 0);
    Node   y = graph_component(g, point, 1), z = graph_component(g, point, 2);
    Node   ex = graph_vec3(g, 1, 0, 0), ey = graph_vec3(g, 0, 1, 0), ez = graph_vec3(g, 0, 0, 1);
    Node   still  = graph_op4(g, OP_rotate, point, ex, ey, ez);
    Node   turned = graph_op4(g, OP_rotate, point, ey, ez, ex);
    assert_string_equal(simplified(b, still), "%0 vec3 point = point\nroot %0\n");
    assert_non_null(strstr(simplified(b, turned), "rotate"));

    Node   less = graph_op2(g, OP_less, x, y), opposite = graph_op1(g, OP_not, less);
    Node   choice = graph_op3(g, OP_select, opposite, y, z), simple_choice = choice;
    Graph *simple = graph_simplify(g, &simple_choice, 1, &b->arena);
    Place  place = {.point = {1, 2, 3}}, swapped = {.point = {2, 1, 3}};
    assert_true(evaluate_plainly(simple, simple_choice, &place).v[0] == 3);
    assert_true(evaluate_plainly(simple, simple_choice, &swapped).v[0] == 1);
    assert_null(strstr(simplified(b, choice), "not"));

    Node zyx = graph_op3(g, OP_vec3, z, y, x), xy = graph_op2(g, OP_vec2, x, y);
    assert_non_null(strstr(simplified(b, zyx), "vec3 point = vec3"));
    assert_non_null(strstr(simplified(b, xy), "vec2 point = vec2"));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_start, bench_stop)
    const struct CMUnitTest tests[] = {
        TEST(simplification_keeps_values),
        TEST(simplification_is_done_at_once),
        TEST(rules_do_what_they_say),
        TEST(rules_leave_what_they_do_not_mean),
    };
    return cmocka_run_group_tests_name("simplification", tests, NULL, NULL);
}
