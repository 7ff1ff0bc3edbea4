/*
 * shape.c: shapes made by their builder, without the language, against closed forms.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/family/family.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/lower.h"
#include "tests/support/random.h"

enum { POINTS = 300 };

static jmp_buf      exhausted;
static Memory       memory = {.exhausted = &exhausted};
static Arena        arena, scratch;
static Sources      sources;
static Diags        diags;
static Parameters   parameters;
static StateSlopes  slopes;
static ShapeBuilder builder;
static Random       randomness = {29};

/* Where shapes stand that no text made. */
static const Span NOWHERE = {0, 0, 0};

static int start(void **state)
{
    (void)state;
    arena = scratch = (Arena){.memory = &memory};
    sources         = (Sources){.arena = &arena};
    diags           = (Diags){.arena = &arena, .sources = &sources};
    parameters      = (Parameters){0};
    slopes          = (StateSlopes){0};
    builder         = (ShapeBuilder){.arena      = &arena,
                                     .scratch    = &scratch,
                                     .diags      = &diags,
                                     .graph      = graph_new(&arena),
                                     .parameters = &parameters,
                                     .slopes     = &slopes};
    return 0;
}

static int finish(void **state)
{
    (void)state;
    arena_free(&arena);
    arena_free(&scratch);
    return 0;
}

/* ---- what is compared ---- */

/* The distance of a shape, ready to be evaluated. */
typedef struct Distance {
    Tape       tape;
    Node       distance;
    NodeValue *values;
} Distance;

static Distance lower(const Shape *shape)
{
    Graph *graph = builder.graph;
    Node   roots[ROOT_COUNT];
    assert_true(lower_component(graph, shape, 1, NULL, &scratch, roots, NULL));
    Distance   lowered = {.tape     = tape_new(graph, roots, 1, &scratch),
                          .distance = roots[ROOT_DISTANCE],
                          .values   = arena_new_array(&scratch, NodeValue, graph->count)};
    NodeValue *frame   = arena_new_array(&scratch, NodeValue, graph->parameters.count + 1);
    tape_run_frame(&lowered.tape, frame, lowered.values);
    return lowered;
}

static double distance_at(const Distance *lowered, const double p[3])
{
    tape_run_point(&lowered->tape, p, lowered->values);
    return lowered->values[lowered->distance].v[0];
}

/* Points that are inside lie in the box of the shape. */
static void assert_in_box(const Shape *shape, const double p[3], double distance)
{
    for (int i = 0; distance < 0 && i < 3; i++)
        assert_true(p[i] >= shape->box.axis[i].low && p[i] <= shape->box.axis[i].high);
}

/* The distance at random points is the one of a closed form. */
static void assert_distance(const Shape *shape, double (*wanted)(const double p[3]))
{
    assert_non_null(shape);
    Distance lowered = lower(shape);
    int      inside  = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, i % 2 ? 1 : 4, p);
        double distance = distance_at(&lowered, p);
        assert_float_equal(distance, wanted(p), 1e-12);
        assert_in_box(shape, p, distance);
        inside += distance < 0;
    }
    assert_in_range(inside, 1, POINTS - 1);
}

/* ---- primitives ---- */

static Node point(void) { return graph_leaf(builder.graph, OP_POINT); }

static Box cube_around(double half) { return (Box){{{-half, half}, {-half, half}, {-half, half}}}; }

static const Shape *exact(const char *name, Node distance, Box box)
{
    Shape *primitive = primitive_new(&builder, name, distance, box, NOWHERE);
    primitive->exact = true;
    claim_slope(&builder, primitive, 1);
    return primitive;
}

static const Shape *make_sphere(double radius)
{
    Graph *g    = builder.graph;
    Node   size = graph_op1(g, OP_length, point());
    return exact("sphere", graph_op2(g, OP_sub, size, graph_number(g, radius)),
                 cube_around(radius));
}

static const double SIDES[3] = {0.6, 0.3, 0.45}; /* half */

static const Shape *make_box(void)
{
    Graph *g       = builder.graph;
    Node   sides   = graph_constant(g, TYPE_VEC3, SIDES);
    Node   excess  = graph_op2(g, OP_sub, graph_op1(g, OP_abs, point()), sides);
    Node   outside = graph_op1(g, OP_length, graph_op2(g, OP_max, excess, graph_number(g, 0)));
    Node   most    = graph_component(g, excess, 0);
    for (uint32_t i = 1; i < 3; i++)
        most = graph_op2(g, OP_max, most, graph_component(g, excess, i));
    Node inside = graph_op2(g, OP_min, most, graph_number(g, 0));
    Box  box;
    for (int i = 0; i < 3; i++)
        box.axis[i] = (Range){-SIDES[i], SIDES[i]};
    return exact("box", graph_op2(g, OP_add, outside, inside), box);
}

static const Shape *moved(const Shape *shape, double x, double y, double z)
{
    Node shift = graph_vec3(builder.graph, x, y, z);
    return make_transform(&builder, shape, map_translation(&builder, shift), NOWHERE);
}

static double sphere_at(const double p[3], double x, double y, double z, double radius)
{
    return hypot(hypot(p[0] - x, p[1] - y), p[2] - z) - radius;
}

static double box_at(const double p[3])
{
    double outside = 0, most = -INFINITY;
    for (int i = 0; i < 3; i++) {
        double excess = fabs(p[i]) - SIDES[i];
        outside       = hypot(outside, fmax(excess, 0));
        most          = fmax(most, excess);
    }
    return outside + fmin(most, 0);
}

static double unit_sphere(const double p[3]) { return sphere_at(p, 0, 0, 0, 1); }

static void a_sphere(void **state)
{
    (void)state;
    const Shape *sphere = make_sphere(1);
    assert_distance(sphere, unit_sphere);
    assert_true(sphere->exact);
    assert_true(sphere->slope == 1);
}

/* ---- shapes of shapes ---- */

static const double ANGLE = 0.7;

/* Turned about z, forward by an angle. */
static void turned(const double p[3], double angle, double q[3])
{
    q[0] = cos(angle) * p[0] - sin(angle) * p[1];
    q[1] = sin(angle) * p[0] + cos(angle) * p[1];
    q[2] = p[2];
}

static double turned_box(const double p[3])
{
    double q[3];
    turned(p, -ANGLE, q);
    return box_at(q);
}

static void a_box_that_is_turned(void **state)
{
    (void)state;
    Graph     *g    = builder.graph;
    const Map *turn = map_rotation(&builder, graph_vec3(g, 0, 0, 1), graph_number(g, ANGLE));
    assert_distance(make_transform(&builder, make_box(), turn, NOWHERE), turned_box);
}

static const double WIDTH = 0.5;

static double blended(const double p[3])
{
    double a = sphere_at(p, 0, 0, 0, 1), b = sphere_at(p, 1.2, 0, 0, 0.7);
    double h = fmax(1 - fabs(a - b) / WIDTH, 0);
    return fmin(a, b) - WIDTH * h * h / 4;
}

static void a_union_that_is_smooth(void **state)
{
    (void)state;
    const Shape *parts[] = {make_sphere(1), moved(make_sphere(0.7), 1.2, 0, 0)};
    Blend        blend   = {BLEND_quadratic, graph_number(builder.graph, WIDTH), 0, NODE_NONE};
    assert_distance(make_csg_node(&builder, SHAPE_UNION, parts, 2, blend, NOWHERE), blended);
}

static double four_spheres(const double p[3])
{
    double least = INFINITY;
    for (int i = 0; i < 4; i++)
        least = fmin(least, sphere_at(p, i & 1 ? -1 : 1, i & 2 ? -0.8 : 0.8, 0.2, 0.4));
    return least;
}

static void a_sequence(void **state)
{
    (void)state;
    Graph        *g        = builder.graph;
    const Shape  *kernel   = moved(make_sphere(0.4), 1, 0.8, 0.2);
    SequenceStage stages[] = {{.kind = SEQUENCE_KERNEL, .kernel = 0},
                              {.kind = SEQUENCE_REFLECT},
                              {.kind = SEQUENCE_REFLECT}};
    stages[1].normal       = graph_vec3(g, -1, 0, 0);
    stages[2].normal       = graph_vec3(g, 0, -1, 0);
    stages[1].offset = stages[2].offset = graph_number(g, 0);
    const Shape *sequence               = make_krs(&builder, stages, 3, &kernel, 1, NOWHERE);
    assert_distance(sequence, four_spheres);
    assert_int_equal(sequence->levels, 2);
    assert_true(sequence->instances == 4);
}

static const double RATE = 0.9;

/* Where the twist is undone, the distance of the box over the norm of a shear by rate * radius. */
static void a_twist(void **state)
{
    (void)state;
    Graph          *g     = builder.graph;
    DeformArguments asked = {
        .name = "twist", .axis = graph_vec3(g, 0, 1, 0), .numbers = {graph_number(g, RATE)}};
    const Shape *twist = make_twist(&builder, make_box(), &asked);
    assert_non_null(twist);
    Distance lowered = lower(twist);
    double   radius = hypot(SIDES[0], SIDES[2]), shear = RATE * radius;
    double   norm   = 0.5 * (shear + sqrt(shear * shear + 4));
    int      inside = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3], angle, r = radius * sqrt(random_between(&randomness, 0, 1));
        angle    = random_between(&randomness, 0, 2 * M_PI);
        p[0]     = r * cos(angle);
        p[1]     = random_between(&randomness, -SIDES[1], SIDES[1]);
        p[2]     = r * sin(angle);
        double c = cos(RATE * p[1]), s = sin(RATE * p[1]);
        double q[3] = {c * p[0] - s * p[2], p[1], s * p[0] + c * p[2]};
        double at   = distance_at(&lowered, p);
        assert_float_equal(at, box_at(q) / norm, 1e-12);
        assert_in_box(twist, p, at);
        inside += at < 0;
    }
    assert_in_range(inside, 1, POINTS - 1);
}

/* ---- slopes, and what cannot be made ---- */

static void a_slope_that_is_derived(void **state)
{
    (void)state;
    Graph *g     = builder.graph;
    Node   steep = graph_op2(g, OP_mul, graph_component(g, point(), 0), graph_number(g, 3));
    Shape *shape = primitive_new(&builder, "wall", steep, box_infinite, NOWHERE);
    Blame  blame;
    assert_true(derive_slope(&builder, shape, NOWHERE, &blame));
    assert_float_equal(shape->derived, 3, 1e-12);
    Distance lowered = lower(shape);
    double   p[3]    = {0.25, 1, -2};
    assert_float_equal(distance_at(&lowered, p), 0.25, 1e-12);
}

static void something_endless_cannot_be_inverted(void **state)
{
    (void)state;
    Graph     *g      = builder.graph;
    Node       x      = graph_component(g, point(), 0);
    const Map *invert = map_inversion(&builder, graph_vec3(g, 0, 0, 0), graph_number(g, 1));
    assert_null(make_transform(&builder, exact("wall", x, box_infinite), invert, NOWHERE));
    assert_int_equal(diags.errors, 1);
    assert_int_equal(diags.items[0]->code, DIAG_ENDLESS_INVERTED);
}

static void a_plane_figure_cannot_be_twisted(void **state)
{
    (void)state;
    Graph          *g      = builder.graph;
    Shape          *figure = primitive_new(&builder, "disc", point(), cube_around(1), NOWHERE);
    DeformArguments asked  = {
         .name = "twist", .axis = graph_vec3(g, 0, 1, 0), .numbers = {graph_number(g, RATE)}};
    figure->figure = true;
    assert_null(make_twist(&builder, figure, &asked));
    assert_int_equal(diags.errors, 1);
    assert_int_equal(diags.items[0]->code, DIAG_TYPE_MISMATCH);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, start, finish)
    const struct CMUnitTest tests[] = {
        TEST(a_sphere),
        TEST(a_box_that_is_turned),
        TEST(a_union_that_is_smooth),
        TEST(a_sequence),
        TEST(a_twist),
        TEST(a_slope_that_is_derived),
        TEST(something_endless_cannot_be_inverted),
        TEST(a_plane_figure_cannot_be_twisted),
    };
    return cmocka_run_group_tests_name("shapes without the language", tests, NULL, NULL);
}
