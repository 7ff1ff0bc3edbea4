/*
 * structure.c: expressions of one structure, which differ in numbers only: what matches, what does not, which numbers
 * come out, and what is made of them again.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/instances/structure.h"

#include "tests/support/bench.h"

/* |point - centre| - radius. */
static Node ball(Graph *g, Node point, double x, double y, double z, double radius)
{
    Node centre = graph_vec3(g, x, y, z), size = graph_number(g, radius);
    Node offset = graph_op2(g, OP_sub, point, centre);
    Node length = graph_op1(g, OP_length, offset);
    return graph_op2(g, OP_sub, length, size);
}

static const bool wanted[2] = {true, true};

static void numbers_come_out(void **state)
{
    Bench      *b          = *state;
    Structures *structures = structures_new(b->graph, &b->arena);
    Node        first[]    = {ball(b->graph, b->point, 1, 2, 3, 4), graph_vec3(b->graph, 1, 0, 0)};
    Template   *t          = template_new(structures, first, 2, &b->arena);
    assert_int_equal(t->slot_count, 3);
    Node        second[] = {ball(b->graph, b->point, 5, 5, 5, 5), graph_vec3(b->graph, 5, 5, 5)};
    SlotContent found[3], of_first[3];
    assert_true(structure_hash(structures, second, 2) == t->hash);
    assert_true(template_match(structures, t, second, found));
    assert_true(template_match(structures, t, first, of_first));
    double sum = 0, sum_of_first = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < (int)b->graph->items[t->slots[i]].type; k++) {
            sum += found[i].numbers[k];
            sum_of_first += of_first[i].numbers[k];
        }
    assert_true(sum == 35 && sum_of_first == 11);
}

/* With its own numbers a copy is the instance itself. */
static void a_copy_is_the_instance(void **state)
{
    Bench      *b          = *state;
    Structures *structures = structures_new(b->graph, &b->arena);
    Node        first[]    = {ball(b->graph, b->point, 1, 2, 3, 4), NODE_NONE};
    Template   *t          = template_new(structures, first, 2, &b->arena);
    Node        second[]   = {ball(b->graph, b->point, 7, 8, 9, 6), NODE_NONE};
    SlotContent found[2];
    Node        slots[2], roots[2];
    assert_true(template_match(structures, t, second, found));
    for (int i = 0; i < 2; i++)
        slots[i] = graph_constant(b->graph, b->graph->items[t->slots[i]].type, found[i].numbers);
    template_copy(b->graph, t, slots, NULL, 0, wanted, roots, &b->arena);
    assert_true(roots[0] == second[0] && roots[1] == NODE_NONE);
    Node     elsewhere = graph_op1(b->graph, OP_neg, b->point);
    LeafPair pair      = {b->point, elsewhere};
    template_copy(b->graph, t, slots, &pair, 1, wanted, roots, &b->arena);
    assert_true(roots[0] == ball(b->graph, elsewhere, 7, 8, 9, 6));
    assert_true(template_needs(t, b->point, wanted, &b->arena));
    assert_false(template_needs(t, graph_leaf(b->graph, OP_NORMAL), wanted, &b->arena));
}

static bool has_same_structure(Bench *b, Node first, Node second)
{
    Structures *structures = structures_new(b->graph, &b->arena);
    Template   *t          = template_new(structures, &first, 1, &b->arena);
    SlotContent found[16];
    assert_true(t->slot_count <= 16);
    bool matches = template_match(structures, t, &second, found);
    /* A hash that misses it would hide it. */
    assert_true(!matches || structure_hash(structures, &second, 1) == t->hash);
    return matches;
}

static void structure_stays(void **state)
{
    Bench *b   = *state;
    Graph *g   = b->graph;
    Node   two = graph_number(g, 2.5), three = graph_number(g, 3.5);
    Node   sum = graph_op2(g, OP_add, b->x, two), other_sum = graph_op2(g, OP_add, b->x, three);
    assert_true(has_same_structure(b, sum, other_sum));
    assert_false(has_same_structure(b, sum, graph_op2(g, OP_sub, b->x, two)));
    assert_false(has_same_structure(b, sum, graph_op2(g, OP_add, b->y, two)));
    assert_false(has_same_structure(b, sum, b->x));
    Node power = graph_op2(g, OP_pow, sum, two), other = graph_op2(g, OP_pow, sum, three);
    assert_false(has_same_structure(b, power, other));
    assert_true(has_same_structure(b, power, graph_op2(g, OP_pow, other_sum, two)));
}

/* A number of the text is its value. */
static void numbers_of_the_text(void **state)
{
    Bench *b   = *state;
    Graph *g   = b->graph;
    double one = 1, two = 2;
    Node   first  = graph_parameterised(g, TYPE_FLOAT, &one, 1);
    Node   second = graph_parameterised(g, TYPE_FLOAT, &two, 2);
    second        = graph_op1(g, OP_sin, second);
    Node of_first = graph_op2(g, OP_mul, b->x, first);
    assert_true(has_same_structure(b, of_first, graph_op2(g, OP_mul, b->x, second)));
}

/* What depends on a parameter comes out as nodes, by elements; what is known of it, as numbers. */
static void numbers_of_the_state(void **state)
{
    Bench      *b    = *state;
    Graph      *g    = b->graph;
    Node        time = graph_parameter(g, 0, TYPE_FLOAT), two = graph_number(g, 2);
    Node        later      = graph_op2(g, OP_add, time, two);
    Node        centre     = graph_op3(g, OP_vec3, two, later, time);
    Node        first      = graph_op2(g, OP_sub, b->point, graph_vec3(g, 1, 2, 3));
    Node        second     = graph_op2(g, OP_sub, b->point, centre);
    Structures *structures = structures_new(g, &b->arena);
    Template   *t          = template_new(structures, &first, 1, &b->arena);
    SlotContent found;
    assert_int_equal(t->slot_count, 1);
    assert_true(template_match(structures, t, &second, &found));
    assert_true(found.nodes[0] == NODE_NONE && found.numbers[0] == 2);
    assert_true(found.nodes[1] == later && found.nodes[2] == time);
    assert_true(has_same_structure(b, second, first) && has_same_structure(b, first, second));
    Node power = graph_op2(g, OP_pow, b->x, time), other = graph_op2(g, OP_pow, b->x, later);
    assert_false(has_same_structure(b, power, other));
    assert_true(has_same_structure(b, power, power));
}

/* A detached template finds the same numbers when its nodes are gone and others stand there. */
static void a_detached_template_needs_no_nodes(void **state)
{
    Bench      *b          = *state;
    Graph      *g          = b->graph;
    Structures *structures = structures_new(g, &b->arena);
    SlotContent found[3];
    GraphMark   mark  = graph_mark(g);
    Node        count = graph_uint(g, 7), other;
    Node        roots[2];
    roots[0]    = ball(g, b->point, 1, 2, 3, 4);
    roots[1]    = graph_op2(g, OP_pow, b->x, graph_number(g, 3.5));
    Template *t = template_new(structures, roots, 2, &b->arena);
    assert_true(template_detach(structures, t, mark.count, &b->arena));
    graph_release(g, mark);
    structures_forget(structures, mark.count);
    other    = graph_number(g, 11); /* where another node stood */
    roots[1] = graph_op2(g, OP_pow, b->x, graph_number(g, 3.5));
    roots[0] = ball(g, b->point, 5, 6, 7, 8);
    assert_true(other <= count);
    assert_true(structure_hash(structures, roots, 2) == t->hash);
    assert_true(template_match(structures, t, roots, found));
    double sum = 0;
    for (uint32_t i = 0; i < t->slot_count; i++)
        for (uint32_t k = 0; k < (uint32_t)t->slot_types[i]; k++)
            sum += found[i].numbers[k];
    assert_true(sum == 5 + 6 + 7 + 8);
    roots[1] = graph_op2(g, OP_pow, b->x, graph_number(g, 2.5)); /* exponents are structure */
    assert_false(template_match(structures, t, roots, found));
}

/* A leaf of the frame that is no number cannot be found again without its node. */
static void what_cannot_be_detached(void **state)
{
    Bench      *b          = *state;
    Graph      *g          = b->graph;
    Structures *structures = structures_new(g, &b->arena);
    size_t      first      = g->count;
    Node        time       = graph_parameter(g, 0, TYPE_FLOAT);
    Node        late       = graph_op2(g, OP_less, graph_number(g, 3), time);
    Node        root       = graph_op3(g, OP_select, late, b->x, graph_op1(g, OP_neg, b->x));
    Template   *t          = template_new(structures, &root, 1, &b->arena);
    assert_false(template_detach(structures, t, first, &b->arena));
}

/* One node of the template that would have two images. */
static void shared_nodes_stay_shared(void **state)
{
    Bench *b      = *state;
    Graph *g      = b->graph;
    Node   a      = graph_op2(g, OP_add, b->x, graph_number(g, 3));
    Node   c      = graph_op2(g, OP_add, b->x, graph_number(g, 4));
    Node   shared = graph_op2(g, OP_mul, a, a), apart = graph_op2(g, OP_mul, a, c);
    assert_false(has_same_structure(b, shared, apart));
    assert_true(has_same_structure(b, apart, shared));
}

/* What is dropped leaves the graph as it was, also when its table grew meanwhile. */
static void dropped_nodes_leave_nothing(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    for (int many = 1; many < 3000; many = 3 * many + 1) {
        Node      kept  = ball(g, b->point, many, 0, 0, 1);
        size_t    count = g->count;
        GraphMark mark  = graph_mark(g);
        for (int i = 0; i < many; i++)
            ball(g, b->point, many, i, -1, 0.125);
        assert_true(g->count > count);
        graph_release(g, mark);
        assert_int_equal(g->count, count);
        assert_int_equal(ball(g, b->point, many, 0, 0, 1), kept);
        assert_int_equal(g->count, count);
        Node made = ball(g, b->point, many, 0.5, -1, 0.125);
        assert_true(made >= count && made == ball(g, b->point, many, 0.5, -1, 0.125));
    }
    graph_validate(g, "release");
}

/* What is to stay of what is dropped does, in a place of its own. */
static void some_nodes_stay(void **state)
{
    Bench    *b     = *state;
    Graph    *g     = b->graph;
    size_t    count = g->count;
    Node      half  = graph_number(g, 0.5);
    GraphMark mark  = graph_mark(g);
    ball(g, b->point, 1, 2, 3, 4);
    Node kept[] = {half, graph_op1(g, OP_sin, graph_op2(g, OP_add, b->x, graph_number(g, 9)))};
    ball(g, b->point, 5, 6, 7, 8);
    graph_release_but(g, mark, kept, 2, &b->arena);
    assert_int_equal(kept[0], half);
    assert_int_equal(g->count, count + 4); /* 0.5, 9, the sum and its sine */
    assert_int_equal(kept[1], graph_op1(g, OP_sin, graph_op2(g, OP_add, b->x, graph_number(g, 9))));
    assert_int_equal(g->count, count + 4);
    graph_validate(g, "release");
}

/* A place that a dropped instance gave to a node of the compiler goes with it. */
static void dropped_places_go(void **state)
{
    Bench    *b    = *state;
    Graph    *g    = b->graph;
    Node      half = graph_number(g, 0.5);
    GraphMark mark = graph_mark(g);
    g->here        = (Span){1, 2, 3};
    assert_int_equal(graph_number(g, 0.5), half);
    assert_int_equal(g->items[half].span.source, 1);
    graph_release(g, mark);
    assert_int_equal(g->items[half].span.source, 0);
    g->here = (Span){0};
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_start, bench_stop)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(numbers_come_out),        TEST(a_copy_is_the_instance),
        TEST(structure_stays),         TEST(numbers_of_the_text),
        TEST(numbers_of_the_state),    TEST(shared_nodes_stay_shared),
        TEST(some_nodes_stay),         TEST(dropped_nodes_leave_nothing),
        TEST(dropped_places_go),       TEST(a_detached_template_needs_no_nodes),
        TEST(what_cannot_be_detached),
    };
    return cmocka_run_group_tests_name("alike", tests, NULL, NULL);
}
