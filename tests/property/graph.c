/*
 * graph.c: the graph keeps meaning.
 *
 * Equal expressions are one node; folding, tapes, substitution and simplification give what a
 * plain recursive evaluator gives, on graphs made at random from every operation there is.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/facts.h"
#include "compiler/print/module.h"

#include "tests/support/bench.h"

static uint32_t components(GraphType type) { return type <= TYPE_VEC4 ? (uint32_t)type : 1; }

/* ---- the evaluator that everything is held against ---- */

typedef struct Place {
    double    point[3];
    NodeValue parameters[2];
} Place;

static NodeValue evaluate(const Graph *graph, Node node, const Place *place)
{
    const Expr *e     = &graph->items[node];
    NodeValue   value = {{0}}, operands[MAX_OPERANDS] = {0};
    GraphType   types[MAX_OPERANDS] = {0};
    switch ((Op)e->op) {
    case OP_CONSTANT: memcpy(value.v, e->number, sizeof value.v); return value;
    case OP_PARAMETER: return place->parameters[e->index];
    case OP_POINT: memcpy(value.v, place->point, sizeof place->point); return value;
    case OP_INSTANCE: return (NodeValue){{1}};
    case OP_LEVEL:
    case OP_UV:
    case OP_NORMAL:
    case OP_FOOTPRINT: return value;
    default:
        for (int i = 0; i < e->operand_count; i++) {
            types[i]    = graph->items[e->operands[i]].type;
            operands[i] = evaluate(graph, e->operands[i], place);
        }
        return op_evaluate(e->op, e->type, e->index, types, operands);
    }
}

static Place random_place(Bench *b)
{
    double first = random_between(&b->random, 0, 10), second = random_between(&b->random, -2, 2);
    Place  place = {.parameters = {{{first}}, {{second}}}};
    for (int i = 0; i < 3; i++)
        place.point[i] = random_between(&b->random, -2, 2);
    return place;
}

/* ---- graphs at random ---- */

typedef struct Garden {
    Node     nodes[64];
    uint32_t count;
} Garden;

/* A node of this type among those made so far, or a new constant. */
static Node pick(Bench *b, const Garden *garden, GraphType type)
{
    static const double numbers[] = {0, 1, -1, 2, 0.5, 3, -2.5, 0.1};
    for (int attempt = 0; attempt < 12; attempt++) {
        Node node = garden->nodes[random_below(&b->random, garden->count)];
        if (b->graph->items[node].type == type)
            return node;
    }
    double values[4];
    bool   counts = type == TYPE_BOOL || type == TYPE_UINT;
    for (int i = 0; i < 4; i++)
        values[i] = numbers[random_below(&b->random, counts ? 2 : 8)];
    if (random_below(&b->random, 2))
        values[1] = values[2] = values[3] = values[0];
    return graph_constant(b->graph, type, values);
}

static GraphType random_type(Bench *b) { return (GraphType)(1 + random_below(&b->random, 6)); }

/* A random operation on random operands that it is defined for. */
static Node grow(Bench *b, const Garden *garden)
{
    for (;;) {
        Op        op = (Op)(OP_COMPONENT + random_below(&b->random, OP_COUNT - OP_COMPONENT));
        GraphType types[MAX_OPERANDS];
        Node      operands[MAX_OPERANDS];
        GraphType usual = random_type(b);
        for (uint32_t count = 1; count <= MAX_OPERANDS; count++) {
            for (uint32_t i = 0; i < count; i++)
                types[i] = random_below(&b->random, 3) ? usual : random_type(b);
            if (!graph_op_type(op, types, count))
                continue;
            for (uint32_t i = 0; i < count; i++)
                operands[i] = pick(b, garden, types[i]);
            if (op == OP_COMPONENT)
                return graph_component(b->graph, operands[0], random_below(&b->random, types[0]));
            return graph_op(b->graph, op, operands);
        }
    }
}

static Garden random_garden(Bench *b, uint32_t count)
{
    Garden garden                = {0};
    Node   point                 = graph_leaf(b->graph, OP_POINT);
    garden.nodes[garden.count++] = point;
    for (uint32_t i = 0; i < 3; i++)
        garden.nodes[garden.count++] = graph_component(b->graph, point, i);
    garden.nodes[garden.count++] = graph_parameter(b->graph, 0, TYPE_FLOAT);
    garden.nodes[garden.count++] = graph_parameter(b->graph, 1, TYPE_FLOAT);
    garden.nodes[garden.count++] = graph_leaf(b->graph, OP_INSTANCE);
    while (garden.count < count)
        garden.nodes[garden.count++] = grow(b, &garden);
    return garden;
}

/* ---- comparing values ---- */

static double value_apart(GraphType type, const NodeValue *a, const NodeValue *b)
{
    double apart = 0;
    for (uint32_t i = 0; i < components(type); i++)
        apart = fmax(apart, fabs(a->v[i] - b->v[i]));
    return apart;
}

static double value_size(GraphType type, const NodeValue *a)
{
    double size = 0;
    for (uint32_t i = 0; i < components(type); i++)
        size = isfinite(a->v[i]) ? fmax(size, fabs(a->v[i])) : HUGE_VAL;
    return size;
}

static bool values_same(GraphType type, const NodeValue *a, const NodeValue *b)
{
    for (uint32_t i = 0; i < components(type); i++)
        if (a->v[i] != b->v[i] && !(isnan(a->v[i]) && isnan(b->v[i])))
            return false;
    return true;
}

/* ---- nodes ---- */

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
    NodeValue value = evaluate(b->graph, sum, &place);
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
            double value = evaluate(g, power, &place).v[0];
            assert_true(fabs(value - pow(a, n)) <= 1e-14 * pow(a, n) * fmax(1, fabs(n)));
        }
    }
    Place negative = {.point = {-2}};
    Node  three = graph_number(g, 3), cube = graph_power(g, x, three);
    assert_true(evaluate(g, cube, &negative).v[0] == -8);
}

/* ---- passes on random graphs ---- */

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
                NodeValue expected = evaluate(b->graph, roots[i], &place);
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
            NodeValue    expected = evaluate(b->graph, root, &place);
            Substitution with     = substitute_point(at);
            with.instance         = one;
            Node      fixed       = graph_substitute(b->graph, root, with, &b->arena);
            Expr      e           = b->graph->items[fixed];
            NodeValue value       = evaluate(b->graph, fixed, &place);
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
        NodeValue expected = evaluate(b->graph, root, &far);
        NodeValue value    = evaluate(b->graph, moved, &place);
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

/* How much a value changes when what goes in is off by a few roundings: where that is much, a
   rule that gathers constants may show as much. */
static double sensitivity(const Graph *graph, Node root, const Place *place)
{
    GraphType type  = graph->items[root].type;
    NodeValue value = evaluate(graph, root, place);
    double    most  = 0;
    for (int i = 0; i < 8; i++) {
        Place  near   = *place;
        double factor = 1 + (i % 2 ? 1 : -1) * 1e-13;
        for (int j = 0; j < 3; j++)
            near.point[j] *= i / 2 == j || i / 2 == 3 ? factor : 1;
        near.parameters[0].v[0] *= i / 2 == 3 ? factor : 1;
        near.parameters[1].v[0] *= i / 2 == 3 ? factor : 1;
        NodeValue other = evaluate(graph, root, &near);
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
            NodeValue expected = evaluate(b->graph, root, &place);
            NodeValue value    = evaluate(simple, simple_root, &place);
            double    size     = value_size(type, &expected);
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

/* Finite, half infinite or infinite, always with the square from -2 to 2 in part. */
static Box random_box(Bench *b)
{
    Box box;
    for (int i = 0; i < 3; i++) {
        double middle = random_between(&b->random, -2, 2);
        double half   = random_below(&b->random, 3) ? random_between(&b->random, 0, 0.5) : 2;
        box.axis[i]   = (Range){random_below(&b->random, 6) ? middle - half : -HUGE_VAL,
                              random_below(&b->random, 6) ? middle + half : HUGE_VAL};
    }
    return box;
}

static Place place_in_box(Bench *b, Box box)
{
    Place place = random_place(b);
    for (int i = 0; i < 3; i++) {
        Range  a       = box.axis[i];
        double low     = a.low > -HUGE_VAL ? a.low : fmin(a.high, 2) - 4;
        double high    = a.high < HUGE_VAL ? a.high : fmax(a.low, -2) + 4;
        place.point[i] = random_between(&b->random, low, high);
    }
    return place;
}

static bool fact_makes_sense(const Fact *fact, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++) {
        if (!(fact->value[i].low <= fact->value[i].high))
            return false;
        for (int j = 0; j < 3; j++)
            if (!(fact->gradient[i][j].low <= fact->gradient[i][j].high))
                return false;
    }
    return fact->slope >= 0;
}

/* Whether a jump is so near that rounding has decided what the value is: floor(a - a). */
static bool is_at_a_jump(const Graph *graph, const Expr *e, const NodeValue *values)
{
    static const double AWAY = 1e-12;
    GraphType           types[MAX_OPERANDS];
    NodeValue           above[MAX_OPERANDS], below[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++) {
        types[i] = graph->items[e->operands[i]].type;
        above[i] = below[i] = values[e->operands[i]];
        for (uint32_t k = 0; types[i] <= TYPE_VEC4 && k < components(types[i]); k++) {
            double distance = AWAY * fmax(1, fabs(above[i].v[k])) * (i ? -1 : 1);
            above[i].v[k] += distance;
            below[i].v[k] -= distance;
        }
    }
    NodeValue high = op_evaluate(e->op, e->type, e->index, types, above);
    NodeValue low  = op_evaluate(e->op, e->type, e->index, types, below);
    return value_apart(e->type, &high, &low) > 0.5;
}

/* Facts are about what is defined, not about what min or sign make of the root of -1; and what
   is far from 0 has rounded more than a range could tell. */
static bool is_defined(const Graph *graph, Node node, const NodeValue *values, const bool *defined)
{
    const Expr *e       = &graph->items[node];
    bool        integer = e->type == TYPE_UINT;
    if (!(value_size(e->type, &values[node]) <= (integer ? UINT32_MAX : 1e6)))
        return false;
    if (e->op == OP_turn || e->op == OP_fold || e->op == OP_cell || e->op == OP_cell_polar)
        return false; /* need orthonormal rows or a unit vector, or hold piece by piece: ops.c */
    for (int i = 0; i < e->operand_count; i++)
        if (!defined[e->operands[i]])
            return false;
    bool jumps = e->op == OP_floor || e->op == OP_round || e->op == OP_fract || e->op == OP_mod ||
                 e->op == OP_sign || e->op == OP_step;
    return !jumps || !is_at_a_jump(graph, e, values);
}

static bool fact_holds(const Fact *fact, GraphType type, const NodeValue *value)
{
    double slack = 1e-9 * fmax(1, value_size(type, value));
    for (uint32_t i = 0; i < components(type); i++)
        if (value->v[i] < fact->value[i].low - slack || value->v[i] > fact->value[i].high + slack)
            return false;
    return true;
}

/* Between two places where the value is defined. */
static bool slope_holds(const Fact *fact, GraphType type, const Place places[2], const NodeValue *a,
                        const NodeValue *b)
{
    double moved = 0, changed = 0, scale = fmax(value_size(type, a), value_size(type, b));
    for (int j = 0; j < 3; j++)
        moved = hypot(moved, places[0].point[j] - places[1].point[j]);
    for (uint32_t i = 0; i < components(type); i++)
        changed = hypot(changed, a->v[i] - b->v[i]);
    return fact->slope == HUGE_VAL ||
           changed <= fact->slope * moved * (1 + 1e-9) + 1e-9 * fmax(1, scale);
}

static void facts_hold_over_any_box(void **state)
{
    Bench *b = *state;
    for (int turn = 0; turn < 2000; turn++) {
        arena_free(&b->arena);
        b->graph             = graph_new(&b->arena);
        Garden     garden    = random_garden(b, 50);
        Box        box       = random_box(b);
        Fact      *facts     = graph_facts(b->graph, box, NULL, &b->arena);
        Place      places[2] = {place_in_box(b, box), place_in_box(b, box)};
        Tape       tape      = tape_new(b->graph, garden.nodes, garden.count, &b->arena);
        NodeValue *values[2];
        bool      *defined[2];
        for (int k = 0; k < 2; k++) {
            values[k]  = arena_new_array(&b->arena, NodeValue, b->graph->count);
            defined[k] = arena_new_array(&b->arena, bool, b->graph->count);
            tape_run_frame(&tape, places[0].parameters, values[k]);
            tape_run_point(&tape, places[k].point, values[k]);
        }
        for (size_t i = 0; i < tape.count; i++) {
            Node        node = tape.nodes[i];
            GraphType   type = b->graph->items[node].type;
            const char *what = NULL;
            for (int k = 0; k < 2; k++) {
                defined[k][node] = is_defined(b->graph, node, values[k], defined[k]);
                if (defined[k][node] && !fact_holds(&facts[node], type, &values[k][node]))
                    what = "range";
            }
            if (!fact_makes_sense(&facts[node], components(type)))
                what = "sense";
            if (defined[0][node] && defined[1][node] &&
                !slope_holds(&facts[node], type, places, &values[0][node], &values[1][node]))
                what = "slope";
            if (what)
                fail_msg("graph %d, node %u (%s): no %s", turn, (unsigned)node,
                         graph_op_name(b->graph->items[node].op), what);
        }
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
    Node   still  = graph_op4(g, OP_turn, point, ex, ey, ez);
    Node   turned = graph_op4(g, OP_turn, point, ey, ez, ex);
    assert_string_equal(simplified(b, still), "%0 vec3 point = point\nroot %0\n");
    assert_non_null(strstr(simplified(b, turned), "turn"));

    Node   less = graph_op2(g, OP_less, x, y), opposite = graph_op1(g, OP_not, less);
    Node   choice = graph_op3(g, OP_select, opposite, y, z), simple_choice = choice;
    Graph *simple = graph_simplify(g, &simple_choice, 1, &b->arena);
    Place  place = {.point = {1, 2, 3}}, swapped = {.point = {2, 1, 3}};
    assert_true(evaluate(simple, simple_choice, &place).v[0] == 3);
    assert_true(evaluate(simple, simple_choice, &swapped).v[0] == 1);
    assert_null(strstr(simplified(b, choice), "not"));

    Node zyx = graph_op3(g, OP_vec3, z, y, x), xy = graph_op2(g, OP_vec2, x, y);
    assert_non_null(strstr(simplified(b, zyx), "vec3 point = vec3"));
    assert_non_null(strstr(simplified(b, xy), "vec2 point = vec2"));
}

/* What the text of an operation calls is printed for some type of its first operand, with all that
   it calls before it. */
static bool helper_is_there(Bench *b, Op op, const char *call)
{
    size_t length = strcspn(call, "(") + 1; /* "krs_pow(" */
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
    assert_non_null(strstr(of_three->bytes, "vec3 krs_pow(vec3 a, vec3 b)\n"));
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
        TEST(simplification_keeps_values),
        TEST(simplification_is_done_at_once),
        TEST(facts_hold_over_any_box),
        TEST(rules_do_what_they_say),
        TEST(rules_leave_what_they_do_not_mean),
        TEST(every_row_can_be_emitted),
    };
    return cmocka_run_group_tests_name("graph", tests, NULL, NULL);
}
