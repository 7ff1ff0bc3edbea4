/*
 * slope.c: slopes of whole expressions over boxes, refined by cutting.
 *
 * A gyroid's largest gradient is known, so bounds can be held against it from both sides; boxes
 * without end, parameters and blame are tried on small expressions.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/evaluate.h"

#include "tests/support/bench.h"

#define ENDLESS             \
    {                       \
        -HUGE_VAL, HUGE_VAL \
    }
static const Box everywhere = {{ENDLESS, ENDLESS, ENDLESS}};
static const Box around     = {{{-2, 2}, {-2, 2}, {-2, 2}}};

static Node sine_times_cosine(Bench *b, Node s, Node c)
{
    Node sine   = graph_op1(b->graph, OP_sin, s);
    Node cosine = graph_op1(b->graph, OP_cos, c);
    return graph_op2(b->graph, OP_mul, sine, cosine);
}

/* sin x cos y + sin y cos z + sin z cos x, whose gradient is longest, sqrt 3, at its flat
   points (such as the origin). */
static Node gyroid(Bench *b)
{
    Node first  = sine_times_cosine(b, b->x, b->y);
    Node second = sine_times_cosine(b, b->y, b->z);
    Node third  = sine_times_cosine(b, b->z, b->x);
    Node sum    = graph_op2(b->graph, OP_add, first, second);
    return graph_op2(b->graph, OP_add, sum, third);
}

static double slope_over(Bench *b, Node root, Box box, uint32_t cells)
{
    return graph_slope(b->graph, root, box, NULL, cells, NULL, &b->arena);
}

static void gyroid_bounds_shrink_with_cells(void **state)
{
    Bench *b    = *state;
    Node   root = gyroid(b);
    double pi = acos(-1), last = 3.4642;
    Box    box = {{{-pi, pi}, {-pi, pi}, {-pi, pi}}};
    for (uint32_t cells = 1; cells <= 4096; cells *= 8) {
        double slope = slope_over(b, root, box, cells);
        assert_true(slope >= 1.7320);
        assert_true(slope <= last);
        last = slope;
    }
    assert_true(last < 2.5); /* math.md, section 4, has 2.06 for the uniform 8^4 */
    assert_true(slope_over(b, root, everywhere, 1) <= 3.4642);
}

static void distances_have_slope_one(void **state)
{
    Bench *b   = *state;
    Graph *g   = b->graph;
    Node   one = graph_number(g, 1), length = graph_op1(g, OP_length, b->point);
    Node   sphere = graph_op2(g, OP_sub, length, one);
    assert_true(slope_over(b, sphere, everywhere, 1) == 1);
    assert_true(slope_over(b, sphere, around, 64) == 1);

    Node size = graph_op1(g, OP_abs, b->point), half = graph_vec3(g, 1, 2, 3);
    Node excess = graph_op2(g, OP_sub, size, half), zero = graph_number(g, 0);
    Node outside  = graph_op2(g, OP_max, excess, zero);
    Node distance = graph_op1(g, OP_length, outside);
    assert_true(slope_over(b, distance, everywhere, 1) <= 1.0000001);
}

static void products_are_unbounded_only_without_a_box(void **state)
{
    Bench *b      = *state;
    Node   square = graph_op2(b->graph, OP_mul, b->x, b->x);
    double slope  = slope_over(b, square, around, 1);
    assert_true(slope >= 4 && slope <= 4.0000001);
    assert_true(slope_over(b, square, everywhere, 64) == HUGE_VAL);
}

static void cutting_finds_what_a_whole_box_hides(void **state)
{
    Bench *b  = *state;
    Graph *g  = b->graph;
    Node   up = graph_op2(g, OP_mul, b->x, b->x), down = graph_op1(g, OP_neg, up);
    Node   cube = graph_op2(g, OP_mul, up, b->x), mixed = graph_op2(g, OP_mul, down, b->y);
    Node   sum   = graph_op2(g, OP_add, cube, mixed);
    double whole = slope_over(b, sum, around, 1), cut = slope_over(b, sum, around, 512);
    double truth = hypot(3 * 4 + 2 * 2 * 2, 4); /* at (2, -2) */
    assert_true(cut >= truth && cut <= whole);
    assert_true(cut < 1.05 * truth);
}

static void jumps_are_found_on_the_seam_of_parts(void **state)
{
    Bench *b    = *state;
    Node   step = graph_op1(b->graph, OP_floor, b->x);
    assert_true(slope_over(b, step, around, 64) == HUGE_VAL);
    Box inside = {{{0.25, 0.75}, {-1, 1}, {-1, 1}}};
    assert_true(slope_over(b, step, inside, 1) == 0);
}

static void parameters_count_with_their_range_or_value(void **state)
{
    Bench         *b     = *state;
    Graph         *g     = b->graph;
    GraphParameter range = {{-1}, {3}};
    array_push(g->arena, &g->parameters, range);
    Node parameter = graph_parameter(g, 1, TYPE_FLOAT);
    Node product   = graph_op2(g, OP_mul, parameter, b->x);
    assert_true(slope_over(b, product, everywhere, 1) == 3);
    const double values[2][4] = {{0}, {0.5}};
    assert_true(graph_slope(g, product, everywhere, values, 1, NULL, &b->arena) == 0.5);

    Node  shifted = graph_op2(g, OP_add, parameter, parameter);
    Range doubled = graph_frame_range(g, shifted, 0, &b->arena);
    assert_true(doubled.low == -2 && doubled.high == 6);
}

/* A turn about an axis, both of the frame, and what it does to a vector: ranges of the values alone,
   which have rules of their own, are those of the values with their gradients. */
static void values_of_the_frame_have_the_same_ranges(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    for (int turn = 0; turn < 500; turn++) {
        GraphParameter range = {{0}, {0}};
        for (int i = 0; i < 4; i++) {
            range.low[i]  = random_between(&b->random, -2, 2);
            range.high[i] = range.low[i] + (turn % 3 ? random_between(&b->random, 0, 2) : 0);
        }
        array_push(g->arena, &g->parameters, range);
        const uint32_t slot  = (uint32_t)g->parameters.count - 1;
        Node           axis  = graph_parameter(g, slot, TYPE_VEC3);
        Node           whole = graph_parameter(g, slot, TYPE_VEC4);
        Node           angle = graph_component(g, whole, 3);
        Node           unit  = graph_op1(g, OP_normalize, axis);
        Node           arm   = graph_vec3(g, turn % 5 - 2, 1, turn % 2);
        Node           moved = graph_op2(g, OP_scale, graph_op2(g, OP_cross, arm, unit), angle);
        Node           sum   = graph_op2(g, OP_add, moved, graph_op2(g, OP_scale, unit, angle));
        const Fact    *facts = graph_facts(g, everywhere, NULL, &b->arena);
        for (uint32_t i = 0; i < 3; i++) {
            Range found = graph_frame_range(g, sum, i, &b->arena);
            assert_true(found.low == facts[sum].value[i].low);
            assert_true(found.high == facts[sum].value[i].high);
        }
    }
}

/* One task, run for several values, gives what each would have got by itself. */
static void tasks_follow_their_parameters(void **state)
{
    Bench    *b    = *state;
    Graph    *g    = b->graph;
    Node      time = graph_parameter(g, 0, TYPE_FLOAT);
    Node      wave = graph_op1(g, OP_sin, graph_op2(g, OP_mul, time, b->x));
    Node      root = graph_op2(g, OP_add, graph_op2(g, OP_mul, wave, b->y), b->z);
    SlopeTask task = slope_task(g, root, around, 64, &b->arena);
    void     *room = arena_alloc(&b->arena, slope_task_size(&task), 1);
    for (int i = -20; i <= 20; i++) {
        const double values[1][4] = {{0.3 * i}};
        double       size = fabs(values[0][0]), slope = slope_task_run(&task, values, room, NULL);
        assert_true(slope == graph_slope(g, root, around, values, 64, NULL, &b->arena));
        assert_true(slope >= hypot(2 * size, 1)); /* at [0, 2, 0] */
        assert_true(slope <= 1.1 * (2 * size + 2));
    }
    /* Quotients by 0 have no slope, those of 0 neither. */
    Node         none          = graph_op2(g, OP_div, graph_op2(g, OP_mul, b->x, time), time);
    const double at_zero[1][4] = {{0}}, at_one[1][4] = {{1}};
    assert_true(graph_slope(g, none, around, at_zero, 1, NULL, &b->arena) == HUGE_VAL);
    assert_true(graph_slope(g, none, around, at_one, 1, NULL, &b->arena) == 1);
}

static void blame_goes_to_the_unbounded_operand(void **state)
{
    Bench *b    = *state;
    Graph *g    = b->graph;
    Node   root = graph_op1(g, OP_sqrt, b->x), harmless = graph_op1(g, OP_sin, b->y);
    Node   sum   = graph_op2(g, OP_add, harmless, root);
    Node   blame = NODE_NONE;
    assert_true(graph_slope(g, sum, around, NULL, 8, &blame, &b->arena) == HUGE_VAL);
    assert_int_equal(blame, root);

    Node ten = graph_number(g, 10), steep = graph_op2(g, OP_mul, b->x, ten);
    Node gentle = graph_op1(g, OP_sin, steep), both = graph_op2(g, OP_add, gentle, b->y);
    graph_slope(g, both, around, NULL, 8, &blame, &b->arena);
    assert_int_equal(blame, steep);
}

/* Every node of the gyroid keeps its facts at points of the box. */
static void facts_of_a_graph_hold(void **state)
{
    Bench     *b      = *state;
    Node       root   = gyroid(b);
    Fact      *facts  = graph_facts(b->graph, around, NULL, &b->arena);
    Tape       tape   = tape_new(b->graph, &root, 1, &b->arena);
    NodeValue *values = arena_new_array(&b->arena, NodeValue, b->graph->count);
    NodeValue  time   = {{0}};
    tape_run_frame(&tape, &time, values);
    for (int i = 0; i < 1000; i++) {
        double p[3] = {fmod(i * 0.7548, 4) - 2, fmod(i * 0.5698, 4) - 2, fmod(i * 0.3141, 4) - 2};
        tape_run_point(&tape, p, values);
        for (size_t k = 0; k < tape.count; k++) {
            Node node = tape.nodes[k];
            assert_true(facts[node].value[0].low <= values[node].v[0]);
            assert_true(facts[node].value[0].high >= values[node].v[0]);
        }
    }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_start, bench_stop)
    const struct CMUnitTest tests[] = {
        TEST(gyroid_bounds_shrink_with_cells),
        TEST(distances_have_slope_one),
        TEST(products_are_unbounded_only_without_a_box),
        TEST(cutting_finds_what_a_whole_box_hides),
        TEST(jumps_are_found_on_the_seam_of_parts),
        TEST(parameters_count_with_their_range_or_value),
        TEST(values_of_the_frame_have_the_same_ranges),
        TEST(tasks_follow_their_parameters),
        TEST(blame_goes_to_the_unbounded_operand),
        TEST(facts_of_a_graph_hold),
    };
    return cmocka_run_group_tests_name("slopes", tests, NULL, NULL);
}
