/*
 * csg_nodes.c: distances without what their CSG nodes do not need, held against the same trees evaluated by
 * themselves: they are equal at the surface and outside of it nearby, have the same sign everywhere, and
 * are no steeper.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/rewrite/csg_nodes.h"
#include "tests/support/bench.h"

enum { TREES = 150, POINTS = 3000, MAX_PARTS = 24 };

/* How near to the surface it is the same, in longest sides of the box. */
static const double NEAR = 1.0 / 256;

typedef enum { BALL, BLOCK, POST, JOIN, CUT } Kind;

typedef struct Solid {
    Kind     kind;
    double   middle[3], size[3]; /* of a ball the radius; of a post radius and half its height */
    double   width;              /* of a blend; 0: sharp */
    bool     cubic;
    unsigned a, b;
} Solid;

typedef struct Scene {
    Solid    solids[2 * MAX_PARTS];
    unsigned count;
} Scene;

/* ---- the distance, by itself ---- */

static double distance_to_sides(const double *sides, int count)
{
    double square = 0, most = -HUGE_VAL;
    for (int k = 0; k < count; k++) {
        square += sides[k] > 0 ? sides[k] * sides[k] : 0;
        most = fmax(most, sides[k]);
    }
    return most > 0 ? sqrt(square) : most;
}

static double smooth_least(double a, double b, double width, bool cubic)
{
    double least = fmin(a, b), apart = fabs(a - b);
    if (width <= 0 || apart >= width)
        return least;
    double h = 1 - apart / width;
    return least - width * (cubic ? h * h * h / 6 : h * h / 4);
}

static double distance(const Scene *scene, unsigned which, const double p[3])
{
    const Solid *s    = &scene->solids[which];
    const double q[3] = {p[0] - s->middle[0], p[1] - s->middle[1], p[2] - s->middle[2]};
    double       sides[3];
    switch (s->kind) {
    case BALL: return sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) - s->size[0];
    case BLOCK:
        for (int k = 0; k < 3; k++)
            sides[k] = fabs(q[k]) - s->size[k];
        return distance_to_sides(sides, 3);
    case POST:
        sides[0] = sqrt(q[0] * q[0] + q[2] * q[2]) - s->size[0];
        sides[1] = fabs(q[1]) - s->size[1];
        return distance_to_sides(sides, 2);
    case JOIN:
        return smooth_least(distance(scene, s->a, p), distance(scene, s->b, p), s->width, s->cubic);
    default:
        return -smooth_least(-distance(scene, s->a, p), distance(scene, s->b, p), s->width,
                             s->cubic);
    }
}

/* ---- the same as a graph ---- */

static Node from_middle(const Bench *bench, const Solid *s)
{
    Node middle = graph_vec3(bench->graph, s->middle[0], s->middle[1], s->middle[2]);
    return graph_op2(bench->graph, OP_sub, bench->point, middle);
}

static Node less_number(Graph *g, Node a, double number)
{
    return graph_op2(g, OP_sub, a, graph_number(g, number));
}

static Node corner(Graph *g, Node outside, Node greatest)
{
    Node depth = graph_op2(g, OP_min, greatest, graph_number(g, 0));
    return graph_op2(g, OP_add, graph_op1(g, OP_length, outside), depth);
}

static Node block(const Bench *bench, const Solid *s)
{
    Graph *g       = bench->graph;
    Node   half    = graph_vec3(g, s->size[0], s->size[1], s->size[2]);
    Node   sides   = graph_op2(g, OP_sub, graph_op1(g, OP_abs, from_middle(bench, s)), half);
    Node   outside = graph_op2(g, OP_max, sides, graph_vec3(g, 0, 0, 0));
    Node   most = graph_op2(g, OP_max, graph_component(g, sides, 1), graph_component(g, sides, 2));
    return corner(g, outside, graph_op2(g, OP_max, graph_component(g, sides, 0), most));
}

static Node post(const Bench *bench, const Solid *s)
{
    Graph *g = bench->graph;
    Node   q = from_middle(bench, s), zero = graph_number(g, 0);
    Node   across[2] = {graph_component(g, q, 0), graph_component(g, q, 2)};
    Node round = less_number(g, graph_op1(g, OP_length, graph_op(g, OP_vec2, across)), s->size[0]);
    Node flat  = less_number(g, graph_op1(g, OP_abs, graph_component(g, q, 1)), s->size[1]);
    Node outside[2] = {graph_op2(g, OP_max, round, zero), graph_op2(g, OP_max, flat, zero)};
    return corner(g, graph_op(g, OP_vec2, outside), graph_op2(g, OP_max, round, flat));
}

static Node make_graph(const Bench *bench, const Scene *scene, unsigned which)
{
    Graph       *g = bench->graph;
    const Solid *s = &scene->solids[which];
    if (s->kind == BALL)
        return less_number(g, graph_op1(g, OP_length, from_middle(bench, s)), s->size[0]);
    if (s->kind == BLOCK || s->kind == POST)
        return s->kind == BLOCK ? block(bench, s) : post(bench, s);
    Node a = make_graph(bench, scene, s->a), b = make_graph(bench, scene, s->b);
    a          = s->kind == CUT ? graph_op1(g, OP_neg, a) : a;
    Op   blend = s->cubic ? OP_smin_cubic : OP_smin_quadratic;
    Node both  = s->width > 0 ? graph_op3(g, blend, a, b, graph_number(g, s->width))
                              : graph_op2(g, OP_min, a, b);
    return s->kind == CUT ? graph_op1(g, OP_neg, both) : both;
}

/* ---- random solids ---- */

static unsigned add(Scene *scene, Solid solid)
{
    scene->solids[scene->count] = solid;
    return scene->count++;
}

static double between(Bench *bench, double low, double high)
{
    return random_between(&bench->random, low, high);
}

/* A tool goes through the plates, or ends somewhere. */
static unsigned random_part(Bench *bench, Scene *scene, bool tool)
{
    Solid s = {.kind   = (Kind)random_below(&bench->random, 3),
               .middle = {between(bench, -1.6, 1.6), between(bench, -0.4, 0.4),
                          between(bench, -1.6, 1.6)}};
    for (int k = 0; k < 3; k++)
        s.size[k] = between(bench, 0.08, tool ? 0.3 : 0.5);
    if (s.kind == POST)
        s.size[1] = tool && random_below(&bench->random, 2) ? 2 : between(bench, 0.1, 0.6);
    else if (s.kind == BLOCK && tool && random_below(&bench->random, 2))
        s.size[1] = 2;
    return add(scene, s);
}

static unsigned join(Bench *bench, Scene *scene, Kind kind, double width, unsigned a, unsigned b)
{
    return add(scene, (Solid){.kind  = kind,
                              .width = width,
                              .cubic = random_below(&bench->random, 2),
                              .a     = a,
                              .b     = b});
}

static unsigned random_union(Bench *bench, Scene *scene, unsigned count, bool tool, double width)
{
    if (count == 1)
        return random_part(bench, scene, tool);
    unsigned a = random_union(bench, scene, count / 2, tool, width);
    unsigned b = random_union(bench, scene, count - count / 2, tool, width);
    return join(bench, scene, JOIN, width, a, b);
}

static unsigned random_scene(Bench *bench, Scene *scene)
{
    double wide    = random_below(&bench->random, 4) ? between(bench, 0.02, 0.3) : 0;
    double thin    = random_below(&bench->random, 4) ? between(bench, 0.01, 0.08) : 0;
    scene->count   = 0;
    unsigned plate = add(scene, (Solid){.kind = BLOCK, .size = {1.8, 0.15, 1.8}});
    unsigned parts = random_union(bench, scene, 1 + random_below(&bench->random, 9), false, wide);
    unsigned tools = random_union(bench, scene, 1 + random_below(&bench->random, 9), true, thin);
    return join(bench, scene, CUT, thin, join(bench, scene, JOIN, wide, plate, parts), tools);
}

/* Around all parts, and what blends add. */
static Box box_around(void) { return (Box){{{-2.4, 2.4}, {-1.3, 1.3}, {-2.4, 2.4}}}; }

/* ---- what holds of it ---- */

typedef struct Looked {
    const Graph *graph;
    Tape         tape;
    Node         root;
    NodeValue   *values;
} Looked;

static Looked prepare(Bench *bench, Node root)
{
    Looked    looked = {bench->graph, tape_new(bench->graph, &root, 1, &bench->arena), root,
                        arena_new_array(&bench->arena, NodeValue, bench->graph->count)};
    NodeValue time   = {{0}};
    tape_run_frame(&looked.tape, &time, looked.values);
    return looked;
}

static double look(const Looked *looked, const double p[3])
{
    tape_run_point(&looked->tape, p, looked->values);
    return looked->values[looked->root].v[0];
}

/* Half of the points are led to the surface. */
static void random_place(Bench *bench, const Scene *scene, unsigned whole, bool near, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = between(bench, -3, 3);
    for (int i = 0; near && i < 12; i++) {
        double at = distance(scene, whole, p), slope[3], square = 0;
        for (int k = 0; k < 3; k++) {
            double q[3] = {p[0], p[1], p[2]};
            q[k] += 1e-6;
            slope[k] = (distance(scene, whole, q) - at) / 1e-6;
            square += slope[k] * slope[k];
        }
        for (int k = 0; k < 3; k++)
            p[k] -= at * slope[k] / fmax(square, 0.1);
    }
    for (int k = 0; near && k < 3; k++)
        p[k] += between(bench, -0.02, 0.02);
}

static void check(Bench *bench, const Scene *scene, unsigned whole, const Looked *looked)
{
    const double near    = NEAR * 2;
    double       last[3] = {0}, before = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_place(bench, scene, whole, i % 2, p);
        double wanted = distance(scene, whole, p), is = look(looked, p);
        if (fabs(wanted) < near) /* inside, sides of tools are as near as their edges */
            assert_true(wanted >= 0 ? fabs(is - wanted) < 1e-12 : is > wanted - 1e-12);
        if (fabs(wanted) > 1e-12)
            assert_true((is > 0) == (wanted > 0));
        if (i > 0) {
            double x = p[0] - last[0], y = p[1] - last[1], z = p[2] - last[2];
            assert_true(fabs(is - before) <= sqrt(x * x + y * y + z * z) + 1e-12);
        }
        for (int k = 0; k < 3; k++)
            last[k] = p[k];
        before = is;
    }
}

static size_t count_of(const Looked *looked, Op op)
{
    size_t count = 0;
    for (size_t i = 0; i < looked->tape.count; i++)
        count += looked->graph->items[looked->tape.nodes[i]].op == op;
    return count;
}

static size_t blends_of(const Looked *looked)
{
    return count_of(looked, OP_smin_quadratic) + count_of(looked, OP_smin_cubic);
}

static void same_surface(void **state)
{
    Bench *bench  = *state;
    size_t blends = 0, left = 0, lengths = 0, lengths_left = 0;
    Scene  scene;
    for (int i = 0; i < TREES; i++) {
        unsigned whole  = random_scene(bench, &scene);
        Node     root   = make_graph(bench, &scene, whole);
        Node     pruned = csg_nodes_prune(bench->graph, root, box_around(), &bench->arena);
        Looked   old = prepare(bench, root), new = prepare(bench, pruned);
        blends += blends_of(&old), left += blends_of(&new);
        lengths += count_of(&old, OP_length), lengths_left += count_of(&new, OP_length);
        check(bench, &scene, whole, &new);
    }
    print_message("%zu of %zu blends, %zu of %zu lengths are needed\n", left, blends, lengths_left,
                  lengths);
    assert_true(4 * left < 3 * blends);
    assert_true(20 * lengths_left < 19 * lengths);
}

/* Returns what is left of a scene; the same holds of it. */
static Looked pruned(Bench *bench, const Scene *scene, unsigned whole, Box box)
{
    Node   root   = make_graph(bench, scene, whole);
    Looked looked = prepare(bench, csg_nodes_prune(bench->graph, root, box, &bench->arena));
    check(bench, scene, whole, &looked);
    return looked;
}

/* A sliver between two tools that only their blend removes would stand alone: there is no surface near,
   so nothing is needed for that. */
static void no_sliver_appears(void **state)
{
    Bench   *bench = *state;
    Scene    scene = {.count = 0};
    unsigned plate = add(&scene, (Solid){.kind = BLOCK, .size = {1, 0.15, 1}});
    unsigned left  = add(&scene, (Solid){.kind = BLOCK, .middle = {-1.1}, .size = {1, 2, 2}});
    unsigned right = add(&scene, (Solid){.kind = BLOCK, .middle = {1.1}, .size = {1, 2, 2}});
    unsigned tools = add(&scene, (Solid){.kind = JOIN, .width = 1, .a = left, .b = right});
    unsigned whole = add(&scene, (Solid){.kind = CUT, .a = plate, .b = tools});
    pruned(bench, &scene, whole, (Box){{{-1, 1}, {-0.15, 0.15}, {-1, 1}}});
}

/* Two solids bulge towards each other though their distances are nowhere alike at the surface. */
static void blends_reach_across_gaps(void **state)
{
    Bench   *bench  = *state;
    Scene    scene  = {.count = 0};
    unsigned plate  = add(&scene, (Solid){.kind = BLOCK, .middle = {0, -1.5}, .size = {3, 0.5, 3}});
    unsigned ball   = add(&scene, (Solid){.kind = BALL, .middle = {0, 1}, .size = {0.5}});
    unsigned whole  = add(&scene, (Solid){.kind = JOIN, .width = 2, .a = plate, .b = ball});
    Looked   looked = pruned(bench, &scene, whole, (Box){{{-3.5, 3.5}, {-2.5, 2}, {-3.5, 3.5}}});
    assert_int_equal(blends_of(&looked), 1);
}

/* A tool beside and above a plate cuts it by the blend alone; its lower end is nearer than its side
   everywhere, but both count. */
static void corners_are_round(void **state)
{
    Bench   *bench  = *state;
    Scene    scene  = {.count = 0};
    Solid    beside = {.kind = BLOCK, .middle = {2.3, 0.95}, .size = {0.5, 0.5, 2}};
    unsigned plate  = add(&scene, (Solid){.kind = BLOCK, .size = {1, 0.15, 1}});
    unsigned whole  = add(&scene,
                          (Solid){.kind = CUT, .width = 1.2, .a = plate, .b = add(&scene, beside)});
    pruned(bench, &scene, whole, (Box){{{-1, 1}, {-0.15, 0.15}, {-1, 1}}});
}

/* What the frame moves may be anywhere. */
static void parameters_are_left_alone(void **state)
{
    Bench   *bench = *state;
    Graph   *g     = bench->graph;
    Scene    scene;
    unsigned whole = random_scene(bench, &scene);
    Node     root  = make_graph(bench, &scene, whole);
    Node     moved = graph_op2(g, OP_add, root, graph_parameter(g, 0, TYPE_FLOAT));
    assert_int_equal(csg_nodes_prune(g, moved, box_around(), &bench->arena), moved);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(same_surface, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(no_sliver_appears, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(blends_reach_across_gaps, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(corners_are_round, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(parameters_are_left_alone, bench_start, bench_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
