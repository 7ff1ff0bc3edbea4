/*
 * crowds.c: joints of many parts as crowds: at random points they are what each part, lowered for
 * itself, and the rules of blends make of it.
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/base/far.h"
#include "compiler/family/family.h"
#include "compiler/graph/crowd.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/crowd.h"
#include "compiler/lower/lower.h"

#include "tests/support/random.h"

enum { PARTS = 200, POINTS = 2000 };

static Memory       memory;
static Arena        arena, scratch;
static Sources      sources;
static Diags        diags;
static Parameters   parameters;
static FrameSlopes  slopes;
static ShapeBuilder builder;
static Random       randomness;
static double       now, height; /* the time, and a parameter from 0 to 1 */
static const Span   no_place = {0, 0, 0};

static int start(void **state)
{
    (void)state;
    arena = scratch = (Arena){.memory = &memory};
    now = height = 0;
    sources      = (Sources){.arena = &arena};
    diags        = (Diags){.arena = &arena, .sources = &sources};
    parameters   = (Parameters){0};
    slopes       = (FrameSlopes){0};
    randomness   = (Random){7};
    builder      = (ShapeBuilder){.arena      = &arena,
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

/* ---- parts ---- */

static Box cube(double half) { return (Box){{{-half, half}, {-half, half}, {-half, half}}}; }

static const Shape *ball(double radius)
{
    Graph *g     = builder.graph;
    Node   point = graph_leaf(g, OP_POINT), size = graph_number(g, radius);
    Node   length = graph_op1(g, OP_length, point);
    Shape *made = primitive_new(&builder, "ball", graph_op2(g, OP_sub, length, size), cube(radius),
                                no_place);
    made->exact = true;
    return made;
}

/* A disc of a radius about a circle around y. */
static const Shape *ring(double radius, double thick)
{
    Graph *g     = builder.graph;
    Node   point = graph_leaf(g, OP_POINT);
    Node   x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Node   z        = graph_component(g, point, 2);
    Node   flat     = graph_op1(g, OP_length, graph_op2(g, OP_vec2, x, z));
    flat            = graph_op2(g, OP_sub, flat, graph_number(g, radius));
    Node   size     = graph_op1(g, OP_length, graph_op2(g, OP_vec2, flat, y));
    Node   distance = graph_op2(g, OP_sub, size, graph_number(g, thick));
    Shape *made     = primitive_new(&builder, "ring", distance, cube(radius + thick), no_place);
    made->exact     = true;
    return made;
}

static const Shape *placed(const Shape *shape, double x, double y, double z, double turn,
                           double scale)
{
    Graph *g   = builder.graph;
    Map    map = {.scale = graph_number(g, scale),
                  .rows  = {graph_vec3(g, cos(turn), sin(turn), 0),
                            graph_vec3(g, -sin(turn), cos(turn), 0), graph_vec3(g, 0, 0, 1)},
                  .shift = graph_vec3(g, x, y, z),
                  .pole  = NODE_NONE};
    return make_transform(&builder, shape, &map, no_place);
}

static double between(double low, double high) { return random_between(&randomness, low, high); }

static const Shape *painted(const Shape *shape)
{
    Graph    *g        = builder.graph;
    Material *material = arena_new(&arena, Material);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    material->name = NODE_NONE;
#include "compiler/shape/surface.def"
    double red = between(0, 1), green = between(0, 1), blue = between(0, 1);
    material->name      = "random";
    material->color     = graph_vec3(g, red, green, blue);
    material->roughness = graph_number(g, between(0, 1));
    return make_paint(&builder, shape, material, no_place);
}

static const Shape *random_part(bool paint)
{
    double       radius = between(0.1, 0.3), thick = between(0.02, 0.08);
    const Shape *shape = between(0, 1) < 0.6 ? ball(radius) : ring(radius, thick);
    double       x = between(-3, 3), y = between(-3, 3), z = between(-3, 3), turn = between(0, 6);
    shape = placed(shape, x, y, z, turn, between(0.5, 1.5));
    return paint ? painted(shape) : shape;
}

static const Shape **random_parts(uint32_t count, bool paint)
{
    const Shape **parts = arena_new_array(&arena, const Shape *, count);
    for (uint32_t i = 0; i < count; i++)
        parts[i] = random_part(paint);
    return parts;
}

/* ---- what is compared ---- */

typedef struct Seen {
    Tape       tape;
    Node       roots[ROOT_COUNT];
    NodeValue *values;
} Seen;

static Seen lower(const Shape *shape, LoweredCrowds *crowds)
{
    Graph *g = builder.graph;
    Seen   seen;
    assert_true(lower_component(g, shape, 1, crowds, &scratch, seen.roots));
    seen.tape = tape_new(g, seen.roots, ROOT_COUNT, &arena);
    return seen;
}

static void prepare(Seen *seen)
{
    Graph     *g     = builder.graph;
    NodeValue *frame = arena_new_array(&arena, NodeValue, g->parameters.count + 1);
    seen->values     = arena_new_array(&arena, NodeValue, g->count);
    frame[0].v[0]    = now;
    if (g->parameters.count > 1)
        frame[1].v[0] = height;
    tape_run_frame(&seen->tape, frame, seen->values);
}

static double look(const Seen *seen, const double p[3])
{
    static const double normal[3] = {0, 0, 1};
    tape_run_surface(&seen->tape, p, normal, 0.001, seen->values);
    return seen->values[seen->roots[ROOT_DISTANCE]].v[0];
}

/* Of what is listed at a point, and no more than that, a distance is right. */
static double clearance_at(const double p[3])
{
    double   least = HUGE_VAL, clearance;
    uint32_t count;
    Crowds  *crowds = builder.graph->crowds;
    for (size_t i = 0; i < crowds->tables.count; i++) {
        grid_find(&crowds->tables.items[i].grid, p, &count, &clearance);
        least = fmin(least, clearance);
    }
    return least;
}

static bool same_surface(const Seen *a, const Seen *b)
{
    for (int root = 0; root < ROOT_COUNT; root++)
        for (int k = 0; root != ROOT_DISTANCE && k < 3; k++)
            if (!(fabs(a->values[a->roots[root]].v[k] - b->values[b->roots[root]].v[k]) < 1e-9))
                return false;
    return true;
}

typedef struct Difference {
    double   below, above; /* where crowds are right; how much more they say than is right */
    double   color;        /* there, too */
    uint32_t right, inside, other_surfaces;
} Difference;

/* In the frame that is now. */
static Difference compare_lowered(const Shape *shape, Seen apart, Seen crowd, double side)
{
    Difference found = {0};
    prepare(&apart);
    prepare(&crowd);
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, side, p);
        double wanted = look(&apart, p), is = look(&crowd, p);
        found.above = fmax(found.above, fabs(is) - fabs(wanted));
        found.inside += wanted < 0;
        assert_true((wanted > 0) == (is > 0));
        if (fabs(wanted) * shape->slope >= clearance_at(p))
            continue;
        found.right++;
        found.below = fmax(found.below, fabs(is - wanted));
        found.other_surfaces += !same_surface(&apart, &crowd);
    }
    return found;
}

static void assert_right(Difference found)
{
    assert_true(found.right > POINTS / 20);
    assert_true(found.inside > 0);
    assert_true(found.below <= 1e-12);
    assert_true(found.above <= 1e-12);
    assert_int_equal(found.other_surfaces, 0);
}

static void assert_same(const Shape *shape, double side)
{
    LoweredCrowds *crowds = lowered_crowds_new(builder.graph, &arena);
    Seen           apart = lower(shape, NULL), crowd = lower(shape, crowds);
    assert_true(builder.graph->crowds->tables.count > 0);
    assert_right(compare_lowered(shape, apart, crowd, side));
}

/* ---- sharp joints ---- */

static void unions(void **state)
{
    (void)state;
    const Shape **parts = random_parts(PARTS, true);
    assert_same(make_joint(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place), 3.5);
    assert_int_equal(builder.graph->crowds->tables.count, 2); /* balls and rings */
}

static void differences(void **state)
{
    (void)state;
    const Shape **parts = random_parts(PARTS, true);
    parts[0]            = painted(ball(2.5));
    assert_same(make_joint(&builder, SHAPE_DIFFERENCE, parts, PARTS, blend_sharp, no_place), 3.5);
}

/* Balls so large that all contain the centre. */
static void intersections(void **state)
{
    (void)state;
    const Shape *parts[32];
    for (int i = 0; i < 32; i++) {
        double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        parts[i] = painted(placed(ball(between(2, 2.5)), x, y, z, 0.5, 1.5));
    }
    assert_same(make_joint(&builder, SHAPE_INTERSECTION, parts, 32, blend_sharp, no_place), 3.5);
}

static void below_maps(void **state)
{
    (void)state;
    const Shape  **parts  = random_parts(PARTS, true);
    const Shape   *all    = make_joint(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    LoweredCrowds *crowds = lowered_crowds_new(builder.graph, &arena);
    const Shape   *moved  = placed(all, 1, 2, 3, 1, 2);
    Seen           apart = lower(moved, NULL), crowd = lower(moved, crowds);
    prepare(&apart);
    prepare(&crowd);
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 6, p);
        double wanted = look(&apart, p), is = look(&crowd, p);
        assert_true(is <= wanted + 1e-12 && (is > 0 || fabs(is - wanted) <= 1e-12));
    }
}

/* What lies behind an offset is right as far as that needs it. */
static void below_offsets(void **state)
{
    (void)state;
    const Shape **parts = random_parts(PARTS, false);
    const Shape  *all   = make_joint(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    Node          more  = graph_number(builder.graph, 0.4);
    const Shape  *grown = make_offset(&builder, all, more, no_place);
    Seen          apart = lower(grown, NULL);
    Seen          crowd = lower(grown, lowered_crowds_new(builder.graph, &arena));
    prepare(&apart);
    prepare(&crowd);
    int inside = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 3.5, p);
        double wanted = look(&apart, p), is = look(&crowd, p);
        assert_true(is <= wanted + 1e-12 && (is > 0 || fabs(is - wanted) <= 1e-12));
        inside += is < 0;
    }
    assert_true(inside > POINTS / 10);
}

/* The same joint, lowered again, has the same functions. */
static void lowered_again(void **state)
{
    (void)state;
    const Shape  **parts  = random_parts(PARTS, true);
    const Shape   *all    = make_joint(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    LoweredCrowds *crowds = lowered_crowds_new(builder.graph, &arena);
    Seen           first  = lower(all, crowds);
    size_t         functions = builder.graph->crowds->functions.count, count = builder.graph->count;
    Seen           second = lower(all, crowds);
    assert_int_equal(builder.graph->crowds->functions.count, functions);
    assert_int_equal(builder.graph->count, count);
    for (int root = 0; root < ROOT_COUNT; root++)
        assert_int_equal(first.roots[root], second.roots[root]);
    Node guarded = lower_guarded(builder.graph, all, first.roots[0], crowds, &scratch);
    assert_int_equal(guarded, first.roots[0]);
}

/* The text of many parts is as long as that of a few. */
static void many_parts_need_few_nodes(void **state)
{
    (void)state;
    size_t made[2];
    for (int more = 0; more < 2; more++) {
        uint32_t      count = more ? 3000 : 300;
        const Shape **parts = random_parts(count, true);
        const Shape  *all = make_joint(&builder, SHAPE_UNION, parts, count, blend_sharp, no_place);
        size_t        before = builder.graph->count;
        lower(all, lowered_crowds_new(builder.graph, &arena));
        made[more] = builder.graph->count - before;
    }
    assert_true(made[0] > 0 && made[1] < 2 * made[0]);
}

/* ---- numbers of the frame ---- */

/* Its place, its turn and its colour depend on the time, or on the parameter as well; some of its
   numbers are known. */
static const Shape *moving_part(bool of_parameter)
{
    Graph *g    = builder.graph;
    Node   time = graph_parameter(g, 0, TYPE_FLOAT), up = graph_parameter(g, 1, TYPE_FLOAT);
    Node   angle = graph_op2(g, OP_add, time, graph_number(g, between(0, 6)));
    Node   sine = graph_op1(g, OP_sin, angle), cosine = graph_op1(g, OP_cos, angle);
    Node   zero = graph_number(g, 0), one = graph_number(g, 1);
    Node   left = graph_op1(g, OP_neg, sine);
    Node   y    = graph_op2(g, OP_add, sine, graph_number(g, between(-2, 2)));
    double x = between(-3, 3), z = between(-3, 3);
    Map    map = {
           .scale = graph_number(g, between(0.5, 1.5)),
           .rows  = {graph_op3(g, OP_vec3, cosine, sine, zero),
                     graph_op3(g, OP_vec3, left, cosine, zero), graph_op3(g, OP_vec3, zero, zero, one)},
           .shift = graph_op3(g, OP_vec3, graph_number(g, x),
                           of_parameter ? graph_op2(g, OP_mul, y, up) : y, graph_number(g, z)),
           .pole  = NODE_NONE};
    Node      bright   = graph_op2(g, OP_mul, sine, sine);
    Material *material = arena_new(&arena, Material);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    material->name = NODE_NONE;
#include "compiler/shape/surface.def"
    material->name     = "moving";
    material->color    = graph_op3(g, OP_vec3, bright, graph_number(g, between(0, 1)), bright);
    const Shape *shape = ring(between(0.1, 0.3), between(0.02, 0.08));
    return make_paint(&builder, make_transform(&builder, shape, &map, no_place), material,
                      no_place);
}

static const Shape *moving_union(void)
{
    const Shape  **parts = arena_new_array(&arena, const Shape *, PARTS);
    GraphParameter range = {{0}, {1}};
    array_push(&arena, &builder.graph->parameters, range);
    for (int i = 0; i < PARTS; i++)
        parts[i] = moving_part(i % 2);
    return make_joint(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
}

/* Those that the parameter raises have other operations, but not at points: all are one crowd. */
static void moving_parts(void **state)
{
    (void)state;
    const Shape   *all    = moving_union();
    LoweredCrowds *crowds = lowered_crowds_new(builder.graph, &arena);
    Seen           apart = lower(all, NULL), crowd = lower(all, crowds);
    assert_int_equal(builder.graph->crowds->tables.count, 1);
    assert_int_equal(builder.graph->crowds->tables.items[0].rows, PARTS);
    assert_true(crowd.tape.count < apart.tape.count);
    for (int i = 0; i < 6; i++) {
        now    = i == 0 ? 0 : between(-20, 20);
        height = i == 0 ? 1 : between(0, 1);
        assert_right(compare_lowered(all, apart, crowd, 3.5));
    }
}

/* A pass that makes a graph takes the frame's numbers along. */
static void moving_parts_are_simplified(void **state)
{
    (void)state;
    const Shape *all   = moving_union();
    Seen         apart = lower(all, NULL);
    Seen         crowd = lower(all, lowered_crowds_new(builder.graph, &arena)), simple = crowd;
    Graph       *before = builder.graph;
    Graph       *after  = graph_simplify(before, simple.roots, ROOT_COUNT, &arena);
    simple.tape         = tape_new(after, simple.roots, ROOT_COUNT, &arena);
    now                 = 2.5;
    height              = 0.75;
    prepare(&apart);
    builder.graph = after;
    prepare(&simple);
    int near = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 3.5, p);
        double wanted = look(&apart, p), is = look(&simple, p);
        assert_true(is <= wanted + 1e-12);
        near += wanted * all->slope < clearance_at(p);
        assert_true(wanted * all->slope >= clearance_at(p) || fabs(is - wanted) <= 1e-12);
    }
    assert_true(near > POINTS / 20);
}

/* An infinite number of the frame is found, and is told from those before. */
static void infinite_numbers_are_found(void **state)
{
    (void)state;
    const Shape *parts[PARTS];
    Graph       *g    = builder.graph;
    Node         time = graph_parameter(g, 0, TYPE_FLOAT);
    for (int i = 0; i < PARTS; i++) {
        Node after = graph_op2(g, OP_sub, time, graph_number(g, i));
        Node zero  = graph_number(g, 0);
        Map  map   = {.scale = graph_number(g, 1),
                      .rows = {graph_vec3(g, 1, 0, 0), graph_vec3(g, 0, 1, 0), graph_vec3(g, 0, 0, 1)},
                      .shift = graph_op3(g, OP_vec3, zero,
                                         graph_op2(g, OP_div, graph_number(g, 1), after), zero),
                      .pole  = NODE_NONE};
        parts[i]   = make_transform(&builder, ball(0.2), &map, no_place);
    }
    const Shape *all   = make_joint(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    Seen         crowd = lower(all, lowered_crowds_new(g, &arena));
    assert_int_equal(g->crowds->tables.count, 1);
    now = 0.5;
    prepare(&crowd);
    assert_true(tape_frame_infinite(&crowd.tape, crowd.values) == NODE_NONE);
    now = 7;
    prepare(&crowd);
    Node found = tape_frame_infinite(&crowd.tape, crowd.values);
    assert_true(found != NODE_NONE && !isfinite(crowd.values[found].v[0]));
}

/* ---- blends ---- */

enum { CHAIN = 60 };

/* Balls in a row: each changes how the next ones join.  They are alike, so they are one crowd. */
static const Shape *chain(BlendKind kind, double width, double step)
{
    const Shape *parts[CHAIN];
    Graph       *g = builder.graph;
    for (int i = 0; i < CHAIN; i++)
        parts[i] = painted(placed(ball(between(0.08, 0.1)), (i - CHAIN / 2) * step,
                                  between(-0.1, 0.1), between(-0.1, 0.1), 0.5, 1.25));
    Blend blend = {kind, graph_number(g, width), 0,
                   kind == BLEND_stairs ? graph_number(g, 3) : NODE_NONE};
    return make_joint(&builder, SHAPE_UNION, parts, CHAIN, blend, no_place);
}

/* The distances of all parts at a point, joined in their order; and their colours. */
static double joined_in_order(const Shape *shape, const Seen *parts, const double p[3],
                              NodeValue *color)
{
    const GraphType types[MAX_OPERANDS]    = {TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT};
    Blend           blend                  = shape->blend;
    NodeValue       operands[MAX_OPERANDS] = {{{NOWHERE}}};
    operands[2].v[0]                       = builder.graph->items[blend.width].number[0];
    operands[3].v[0] = blend.steps == NODE_NONE ? 0 : builder.graph->items[blend.steps].number[0];
    for (uint32_t i = 0; i < shape->child_count; i++) {
        operands[1].v[0]        = look(&parts[i], p);
        double           weight = op_evaluate(OP_blend_weight, TYPE_FLOAT, 0, types, operands).v[0];
        const NodeValue *own    = &parts[i].values[parts[i].roots[ROOT_color]];
        for (int k = 0; k < 3; k++)
            color->v[k] = own->v[k] * (1 - weight) + color->v[k] * weight;
        operands[0] = op_evaluate(blend_info[blend.kind].op, TYPE_FLOAT, 0, types, operands);
    }
    return operands[0].v[0] / shape->slope;
}

static Difference compare_in_order(const Shape *shape, const Seen *parts, const Seen *crowd)
{
    Difference found = {0};
    for (int i = 0; i < POINTS; i++) {
        double p[3], unit[3];
        random_vector(&randomness, 1, unit);
        for (int k = 0; k < 3; k++)
            p[k] = unit[k] * (k ? 0.5 : 2);
        NodeValue color  = {{0}};
        double    wanted = joined_in_order(shape, parts, p, &color), is = look(crowd, p);
        found.above = fmax(found.above, is - wanted);
        found.inside += wanted < 0;
        if (wanted * shape->slope >= clearance_at(p))
            continue;
        found.right++;
        found.below = fmax(found.below, fabs(is - wanted));
        for (int k = 0; k < 3; k++)
            found.color = fmax(found.color,
                               fabs(crowd->values[crowd->roots[ROOT_color]].v[k] - color.v[k]));
    }
    return found;
}

static Difference compare_blend(const Shape *shape, bool without_reach)
{
    static Seen parts[CHAIN];
    Seen        crowd  = lower(shape, lowered_crowds_new(builder.graph, &arena));
    Crowds     *crowds = builder.graph->crowds;
    assert_int_equal(crowds->tables.count, 1);
    for (uint32_t i = 0; i < shape->child_count; i++)
        parts[i] = lower(shape->children[i], NULL);
    for (uint32_t i = 0; i < shape->child_count; i++)
        prepare(&parts[i]);
    prepare(&crowd);
    Box boxes[CHAIN];
    for (uint32_t i = 0; i < CHAIN; i++)
        boxes[i] = shape->children[i]->box;
    if (without_reach)
        grid_build(&crowds->tables.items[0].grid, boxes, CHAIN, 0, 0, &arena, &scratch);
    return compare_in_order(shape, parts, &crowd);
}

/* How wrong a blend may be: a ten-thousandth of a width where its reach is not exact. */
static double allowed(BlendKind kind, double width)
{
    bool exact = kind == BLEND_circular || kind == BLEND_chamfer || kind == BLEND_stairs;
    return exact ? 1e-12 : 1e-4 * width;
}

static void blends(void **state)
{
    for (BlendKind kind = 0; kind < BLEND_COUNT; kind++)
        for (int trial = 0; trial < 6; trial++) {
            double       width = trial % 3 == 0 ? 0.05 : trial % 3 == 1 ? 0.1 : 0.3;
            const Shape *shape = chain(kind, width, trial < 3 ? 0.07 : 0.15);
            Difference   found = compare_blend(shape, false);
            assert_true(found.right > POINTS / 20 && found.inside > 0);
            assert_true(found.below <= allowed(kind, width));
            assert_true(found.above <= allowed(kind, width));
            assert_true(found.color <= 1e-3);
            finish(state);
            start(state);
        }
}

/* Without its reach each blend is wrong somewhere, and that shows. */
static void reach_is_needed(void **state)
{
    for (BlendKind kind = 0; kind < BLEND_COUNT; kind++) {
        Difference found = compare_blend(chain(kind, 0.3, 0.15), true);
        assert_true(found.above > 1e-3 * 0.3);
        finish(state);
        start(state);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, start, finish)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(unions),
        TEST(differences),
        TEST(intersections),
        TEST(below_maps),
        TEST(below_offsets),
        TEST(lowered_again),
        TEST(many_parts_need_few_nodes),
        TEST(moving_parts),
        TEST(moving_parts_are_simplified),
        TEST(infinite_numbers_are_found),
        TEST(blends),
        TEST(reach_is_needed),
    };
    return cmocka_run_group_tests_name("crowds", tests, NULL, NULL);
}
