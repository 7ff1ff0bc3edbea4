/*
 * rebase.c: expressions of a point relative to an origin against the same expressions of the point.
 *
 * In double precision both are the same number, whatever the origin.  What the pass is for shows
 * when all numbers are rounded to single precision after each operation: near a far origin the
 * values then stay right to a small part of the offset from there.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "compiler/graph/rewrite/rebase.h"
#include "compiler/graph/evaluate.h"

typedef struct Bench {
    Memory   memory;
    Arena    arena;
    Graph   *graph;
    Node     point, rebase_origin;
    uint32_t seed;
} Bench;

static jmp_buf out_of_memory;

static int bench_start(void **state)
{
    static Bench bench;
    bench                   = (Bench){.memory = {.exhausted = &out_of_memory}, .seed = 5};
    bench.arena             = (Arena){.memory = &bench.memory};
    bench.graph             = graph_new(&bench.arena);
    bench.point             = graph_leaf(bench.graph, OP_POINT);
    GraphParameter anywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    array_push(&bench.arena, &bench.graph->parameters, anywhere);
    bench.rebase_origin = graph_parameter(bench.graph, 1, TYPE_VEC3);
    *state              = &bench;
    return 0;
}

static int bench_stop(void **state)
{
    arena_free(&((Bench *)*state)->arena);
    return 0;
}

static double uniform(Bench *b)
{
    b->seed = b->seed * 1664525u + 1013904223u;
    return 2 * ((b->seed >> 8) / 16777216.0) - 1;
}

/* `single`: what depends on the point, and what is handed to it, has seven digits. */
static double evaluate(Bench *b, Node root, const double point[3], const double rebase_origin[3],
                       bool single)
{
    const Graph *g          = b->graph;
    Tape         tape       = tape_new(g, &root, 1, &b->arena);
    NodeValue   *values     = arena_new_array(&b->arena, NodeValue, g->count);
    NodeValue parameters[2] = {{{0.4}}, {{rebase_origin[0], rebase_origin[1], rebase_origin[2]}}};
    tape_run_frame(&tape, parameters, values);
    for (size_t i = 0; i < tape.count; i++) {
        Node        n = tape.nodes[i];
        const Expr *e = &g->items[n];
        GraphType   types[MAX_OPERANDS];
        NodeValue   operands[MAX_OPERANDS];
        for (int k = 0; k < e->operand_count; k++) {
            types[k]    = g->items[e->operands[k]].type;
            operands[k] = values[e->operands[k]];
        }
        if (e->op == OP_POINT)
            values[n] = (NodeValue){{point[0], point[1], point[2]}};
        else if (e->time == TIME_POINT)
            values[n] = op_evaluate(e->op, e->type, e->index, types, operands);
        bool handed = e->time == TIME_POINT || e->op == OP_precise || e->time == TIME_COMPILE;
        for (int k = 0; single && handed && k < 4; k++)
            values[n].v[k] = (float)values[n].v[k];
    }
    return values[root].v[0];
}

static Node vector(Bench *b, double size)
{
    return graph_vec3(b->graph, size * uniform(b), size * uniform(b), size * uniform(b));
}

/* Moves, turns, mirrors, copies, and at the end the distance to a ball or a box. */
static Node chain(Bench *b, double reach)
{
    Graph *g     = b->graph;
    Node   p     = b->point;
    int    steps = 1 + (int)(6 * fabs(uniform(b)));
    for (int i = 0; i < steps; i++) {
        Node normal = graph_op1(g, OP_normalize, vector(b, 1));
        Node rows[] = {graph_vec3(g, 0, 0, 1), graph_vec3(g, 1, 0, 0), graph_vec3(g, 0, 1, 0)};
        switch ((int)(3.5 + 3.5 * uniform(b))) {
        case 0: p = graph_op2(g, OP_sub, p, vector(b, reach)); break;
        case 1: p = graph_op4(g, OP_rotate, p, rows[0], rows[1], rows[2]); break;
        case 2: p = graph_op2(g, OP_scale, p, graph_number(g, 0.5)); break;
        case 3:
        case 4: p = graph_op3(g, OP_fold, p, normal, graph_number(g, reach * uniform(b))); break;
        case 5: {
            Node x = graph_component(g, p, 0), period = graph_number(g, 3);
            Node cell = graph_op1(g, OP_round, graph_op2(g, OP_div, x, period));
            Node low = graph_number(g, -1e6), high = graph_number(g, 4e6);
            cell = graph_op3(g, OP_clamp, cell, low, high);
            x    = graph_op2(g, OP_sub, x, graph_op2(g, OP_mul, cell, period));
            p    = graph_op3(g, OP_vec3, x, graph_component(g, p, 1), graph_component(g, p, 2));
            break;
        }
        default: {
            Node y      = graph_component(g, p, 1);
            Node behind = graph_op2(g, OP_less, y, graph_number(g, reach * uniform(b)));
            Node front  = graph_op3(g, OP_front, p, normal, graph_number(g, reach));
            Node both   = graph_op2(g, OP_and, behind, front);
            p           = graph_op3(g, OP_select, both, graph_op1(g, OP_neg, p), p);
        }
        }
    }
    Node box = graph_op2(g, OP_sub, graph_op1(g, OP_abs, p), graph_vec3(g, 1, 2, 0.5));
    return uniform(b) < 0 ? graph_op1(g, OP_length, p)
                          : graph_op1(g, OP_length, graph_op2(g, OP_max, box, graph_number(g, 0)));
}

static void values_are_the_same(void **state)
{
    Bench *b = *state;
    for (int i = 0; i < 400; i++) {
        Node plain = chain(b, 5), near = plain;
        graph_rebase(b->graph, &near, 1, b->rebase_origin, &b->arena);
        graph_validate(b->graph, "rebase");
        for (int k = 0; k < 5; k++) {
            double rebase_origin[3], direction[3], point[3], none[3] = {0};
            for (int a = 0; a < 3; a++) {
                rebase_origin[a] = 20 * uniform(b);
                direction[a]     = 5 * uniform(b);
                point[a]         = rebase_origin[a] + direction[a];
            }
            double there = evaluate(b, plain, point, none, false);
            double here  = evaluate(b, near, direction, rebase_origin, false);
            assert_true(fabs(there - here) <= 1e-9 * (1 + fabs(there)));
        }
    }
}

/* Along a row of cells that goes far: in single precision the plain expression is lost there. */
static void single_precision_is_enough(void **state)
{
    Bench *b           = *state;
    Graph *g           = b->graph;
    double worst_plain = 0, worst_near = 0;
    Node   p = b->point;
    for (int i = 20; i-- > 0;)
        p = graph_op3(g, OP_fold, p, graph_vec3(g, 0.6, 0, 0.8), graph_number(g, exp2(i)));
    Node moved = graph_op2(g, OP_sub, p, graph_vec3(g, 0.2, 0.1, 0.3));
    Node plain = graph_op1(g, OP_length, moved), near = plain;
    graph_rebase(g, &near, 1, b->rebase_origin, &b->arena);
    for (int k = 0; k < 200; k++) {
        double rebase_origin[3], direction[3], point[3], none[3] = {0},
                                                         far = 4e5 * fabs(uniform(b));
        for (int a = 0; a < 3; a++) {
            rebase_origin[a] = a == 0 ? 0.6 * far : a == 1 ? 0.5 : 0.8 * far;
            direction[a]     = uniform(b);
            point[a]         = rebase_origin[a] + direction[a];
        }
        double truth = evaluate(b, plain, point, none, false);
        worst_plain  = fmax(worst_plain, fabs(evaluate(b, plain, point, none, true) - truth));
        worst_near   = fmax(worst_near,
                            fabs(evaluate(b, near, direction, rebase_origin, true) - truth));
    }
    assert_true(worst_near < 2e-5);
    assert_true(worst_plain > 5e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(values_are_the_same, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(single_precision_is_enough, bench_start, bench_stop),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
