/*
 * facts.c: ranges, gradients and slopes of expressions hold over any box, on graphs made at random.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/evaluate.h"

#include "tests/property/garden.h"

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

/* Tells whether a jump is so near that rounding has decided what the value is: floor(a - a). */
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
    if (!(value_magnitude(e->type, &values[node]) <= (integer ? UINT32_MAX : 1e6)))
        return false;
    if (e->op == OP_rotate || e->op == OP_fold || e->op == OP_cell || e->op == OP_cell_polar)
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
    double slack = 1e-9 * fmax(1, value_magnitude(type, value));
    for (uint32_t i = 0; i < components(type); i++)
        if (value->v[i] < fact->value[i].low - slack || value->v[i] > fact->value[i].high + slack)
            return false;
    return true;
}

/* Between two places where the value is defined. */
static bool slope_holds(const Fact *fact, GraphType type, const Place places[2], const NodeValue *a,
                        const NodeValue *b)
{
    double moved = 0, changed = 0, scale = fmax(value_magnitude(type, a), value_magnitude(type, b));
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

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_start, bench_stop)
    const struct CMUnitTest tests[] = {
        TEST(facts_hold_over_any_box),
    };
    return cmocka_run_group_tests_name("facts", tests, NULL, NULL);
}
