/*
 * local.c: how fast random expressions change near a point, against their values.
 *
 * In every direction and at every way within the radius the change must be below the bound; so must
 * the change less what the gradient says be below the rest of the bound, as the rules promise for
 * each part.  And the bound must not be idle: near the point it is the length of the gradient.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/derive.h"
#include "compiler/graph/symbolic/local.h"

#include "tests/support/bench.h"

static const Box    BOX   = {{{-3, 3}, {-3, 3}, {-3, 3}}};
static const double LEAST = 0.02;

static double uniform(Bench *b) { return random_between(&b->random, 0, 1); }

/* 1 + a^2 */
static Node positive(Bench *b, Node a)
{
    Node square = graph_op1(b->graph, OP_square, a);
    return graph_op2(b->graph, OP_add, square, graph_number(b->graph, 1));
}

/* Returns what has a slope everywhere. */
static Node tame(Bench *b, int kind, Node p, Node q)
{
    Graph *g    = b->graph;
    Node   size = graph_op1(g, OP_abs, p),
         three  = graph_op3(g, OP_vec3, p, q, graph_number(b->graph, 0.3));
    switch (kind) {
    case 0: return graph_op2(g, OP_add, p, q);
    case 1: return graph_op2(g, OP_sub, p, q);
    case 2: return graph_op2(g, OP_mul, p, q);
    case 3: return graph_op1(g, OP_sin, p);
    case 4: return graph_op1(g, OP_cos, p);
    case 5: return graph_op1(g, OP_atan, p);
    case 6: return graph_op1(g, OP_tanh, p);
    case 7: return graph_op1(g, OP_exp, graph_op1(g, OP_sin, p));
    case 8: return graph_op1(g, OP_exp2, graph_op1(g, OP_tanh, p));
    case 9: return graph_op1(g, OP_sqrt, positive(b, p));
    case 10: return size;
    case 11: return graph_op2(g, OP_min, p, q);
    case 12: return graph_op2(g, OP_max, p, q);
    case 13: return graph_op3(g, OP_clamp, p, graph_number(b->graph, -0.4), q);
    case 14: return graph_op3(g, OP_mix, p, q, graph_op1(g, OP_sin, q));
    case 15: return graph_power(g, size, graph_number(b->graph, 2.5));
    case 16: return graph_power(g, size, graph_number(b->graph, 1.4));
    case 17: return graph_power(g, positive(b, p), graph_number(b->graph, -0.7));
    case 18: return graph_op1(g, OP_length, three);
    case 19: return graph_op2(g, OP_dot, three, three);
    case 20: return graph_op2(g, OP_dot, three, b->point);
    case 21: return graph_op1(g, OP_noise3, b->point);
    case 22: return graph_op1(g, OP_sinh, graph_op1(g, OP_sin, p));
    case 23: return graph_op1(g, OP_cosh, graph_op1(g, OP_sin, p));
    case 24: return graph_op2(g, OP_mul, graph_parameter(g, 0, TYPE_FLOAT), p);
    case 25:
        return graph_op3(g, OP_smoothstep, graph_number(b->graph, -0.3),
                         graph_number(b->graph, 0.4), p);
    default: return graph_op2(g, OP_div, p, graph_number(b->graph, 1.7));
    }
}

/* Returns what has poles and ends. */
static Node wild(Bench *b, int kind, Node p, Node q)
{
    Graph *g = b->graph;
    switch (kind) {
    case 0: return graph_op2(g, OP_div, q, p);
    case 1: return graph_op1(g, OP_sqrt, p);
    case 2: return graph_op1(g, OP_log, p);
    case 3: return graph_op1(g, OP_inversesqrt, p);
    case 4: return graph_power(g, p, graph_number(b->graph, 0.3));
    case 5: return graph_power(g, graph_op1(g, OP_abs, p), graph_number(b->graph, 1.2));
    default: return graph_op1(g, OP_exp, p);
    }
}

static Node expression(Bench *b, int depth)
{
    Node leaf = graph_component(b->graph, b->point, (uint32_t)(3 * uniform(b)));
    if (depth == 0)
        return graph_op2(b->graph, OP_mul, leaf, graph_number(b->graph, 0.3 + 2 * uniform(b)));
    int  other = uniform(b) < 0.5 ? depth - 1 : 0;
    Node p = expression(b, depth - 1), q = expression(b, other);
    return uniform(b) < 0.2 ? wild(b, (int)(7 * uniform(b)), p, q)
                            : tame(b, (int)(27 * uniform(b)), p, q);
}

static void random_point(Bench *b, double size, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = size * (2 * uniform(b) - 1);
}

/* Returns a random way from a point; its length is at most `radius`. */
static double go(Bench *b, const double from[3], double radius, double to[3])
{
    double direction[3], length, r = radius * sqrt(uniform(b));
    do {
        random_point(b, 1, direction);
        length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                      direction[2] * direction[2]);
    } while (!(length <= 1 && length > 0.01));
    for (int k = 0; k < 3; k++)
        to[k] = from[k] + r * direction[k] / length;
    return r;
}

typedef struct Counts {
    int tried, wrong, close;
} Counts;

/* What is known at a point. */
typedef struct Known {
    double value, radius, first, second, gradient[3];
} Known;

/* From `known` at `from` to `value` at `to`; the rest of a bound is what is beyond its gradient. */
static void count_change(const Known *known, const double from[3], const double to[3], double value,
                         double r, bool derived, Counts *counts)
{
    double along = 0, steep = 0, most = known->first * r + known->second * r * r;
    double slack = 1e-9 * (1 + fabs(known->value) + most), change = value - known->value;
    for (int k = 0; derived && k < 3; k++) {
        along += known->gradient[k] * (to[k] - from[k]);
        steep = hypot(steep, known->gradient[k]);
    }
    if (!isfinite(known->value) || !isfinite(most) || !isfinite(along))
        return;
    counts->tried++;
    counts->wrong += !(fabs(change) <= most + slack);
    counts->wrong += !(fabs(change - along) <= most - steep * r + slack + 1e-9 * steep);
    counts->close += fabs(change) >= 0.5 * most;
}

static void try_expression(Bench *b, Node root, Counts *counts)
{
    LocalBound bound;
    Node       gradient = b->point;
    if (!graph_local_bound(b->graph, root, BOX, LEAST, &bound, &b->arena))
        return;
    bool       derived = graph_gradient(b->graph, root, &gradient, NULL, &b->arena) != DERIVED_NOT;
    Node       roots[] = {root, bound.radius, bound.first, bound.second, gradient};
    Tape       tape    = tape_new(b->graph, roots, 5, &b->arena);
    NodeValue *values  = arena_new_array(&b->arena, NodeValue, b->graph->count);
    NodeValue  time    = {{0.7, 0, 0, 0}};
    tape_run_frame(&tape, &time, values);
    for (int k = 0; k < 12; k++) {
        double from[3], to[3];
        random_point(b, 1.5, from);
        tape_run_point(&tape, from, values);
        const double *g     = values[gradient].v;
        Known         known = {values[root].v[0],
                               values[bound.radius].v[0],
                               values[bound.first].v[0],
                               values[bound.second].v[0],
                               {g[0], g[1], g[2]}};
        double        r     = go(b, from, fmin(known.radius, 1), to);
        tape_run_point(&tape, to, values);
        count_change(&known, from, to, values[root].v[0], r, derived, counts);
    }
}

static void changes_are_bounded(void **state)
{
    Bench *b      = *state;
    Counts counts = {0};
    for (int i = 0; i < 2500; i++) {
        try_expression(b, expression(b, 1 + i % 3), &counts);
        arena_free(&b->arena); /* the next begins with an empty graph */
        b->graph = graph_new(&b->arena);
        b->point = graph_leaf(b->graph, OP_POINT);
    }
    if (counts.wrong > 0 || counts.tried < 12000 || counts.close < counts.tried / 10)
        fail_msg("of %d changes %d are larger than the bound, %d at least half of it", counts.tried,
                 counts.wrong, counts.close);
}

/* Where there is a gradient, the bound of a small ball is its length. */
static void near_the_point_it_is_the_gradient(void **state)
{
    Bench *b = *state;
    Graph *g = b->graph;
    Node   x = graph_component(g, b->point, 0), y = graph_component(g, b->point, 1);
    Node   two = graph_number(g, 2);
    Node   f   = graph_op1(g, OP_exp, graph_op1(g, OP_sin, graph_op2(g, OP_mul, x, two)));
    f          = graph_op2(g, OP_mul, f, graph_op1(g, OP_sqrt, positive(b, y)));
    LocalBound bound;
    assert_true(graph_local_bound(g, f, BOX, LEAST, &bound, &b->arena));
    Tape       tape   = tape_new(g, (Node[]){bound.first}, 1, &b->arena);
    NodeValue *values = arena_new_array(&b->arena, NodeValue, g->count);
    tape_run_frame(&tape, &(NodeValue){{0}}, values);
    for (int k = 0; k < 50; k++) {
        double p[3];
        random_point(b, 2, p);
        tape_run_point(&tape, p, values);
        double bump = exp(sin(2 * p[0])), root = sqrt(1 + p[1] * p[1]);
        double steep = hypot(bump * 2 * cos(2 * p[0]) * root, bump * p[1] / root);
        assert_true(fabs(values[bound.first].v[0] - steep) <= 1e-9 * (1 + steep));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(changes_are_bounded, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(near_the_point_it_is_the_gradient, bench_start, bench_stop),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
