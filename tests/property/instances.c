/*
 * instances.c: CSG nodes of many parts as instance groups: at random points they are what each part, lowered for
 * itself, and the rules of blends make of it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/base/far.h"
#include "compiler/graph/instances/grid_build.h"
#include "tests/property/instance_parts.h"

/* ---- sharp CSG nodes ---- */

static void unions(void **state)
{
    (void)state;
    const Shape **parts = random_parts(PARTS, true);
    assert_same(make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place), 3.5);
    assert_int_equal(builder.graph->instances->tables.count, 2); /* balls and rings */
}

static void differences(void **state)
{
    (void)state;
    const Shape **parts = random_parts(PARTS, true);
    parts[0]            = painted(ball(2.5));
    assert_same(make_csg_node(&builder, SHAPE_DIFFERENCE, parts, PARTS, blend_sharp, no_place),
                3.5);
}

/* Balls so large that all contain the centre. */
static void intersections(void **state)
{
    (void)state;
    const Shape *parts[96];
    for (int i = 0; i < 96; i++) {
        double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        parts[i] = painted(placed(ball(between(2, 2.5)), x, y, z, 0.5, 1.5));
    }
    assert_same(make_csg_node(&builder, SHAPE_INTERSECTION, parts, 96, blend_sharp, no_place), 3.5);
}

static void below_maps(void **state)
{
    (void)state;
    const Shape  **parts = random_parts(PARTS, true);
    const Shape   *all = make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    LoweredGroups *instances = lowered_groups_new(builder.graph, &arena, &arena, LEAST);
    const Shape   *moved     = placed(all, 1, 2, 3, 1, 2);
    Seen           apart = lower(moved, NULL), group = lower(moved, instances);
    prepare(&apart);
    prepare(&group);
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 6, p);
        double wanted = look(&apart, p), is = look(&group, p);
        assert_true(is <= wanted + 1e-12 && (is > 0 || fabs(is - wanted) <= 1e-12));
    }
}

/* What lies behind an offset is right as far as that needs it. */
static void below_offsets(void **state)
{
    (void)state;
    const Shape **parts = random_parts(PARTS, false);
    const Shape  *all   = make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    Node          more  = graph_number(builder.graph, 0.4);
    const Shape  *grown = make_offset(&builder, all, more, no_place);
    Seen          apart = lower(grown, NULL);
    Seen          group = lower(grown, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
    prepare(&apart);
    prepare(&group);
    int inside = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, 3.5, p);
        double wanted = look(&apart, p), is = look(&group, p);
        assert_true(is <= wanted + 1e-12 && (is > 0 || fabs(is - wanted) <= 1e-12));
        inside += is < 0;
    }
    assert_true(inside > POINTS / 10);
}

/* The same CSG node, lowered again, has the same functions. */
static void lowered_again(void **state)
{
    (void)state;
    const Shape  **parts = random_parts(PARTS, true);
    const Shape   *all = make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp, no_place);
    LoweredGroups *instances = lowered_groups_new(builder.graph, &arena, &arena, LEAST);
    Seen           first     = lower(all, instances);
    size_t functions = builder.graph->instances->functions.count, count = builder.graph->count;
    Seen   second = lower(all, instances);
    assert_int_equal(builder.graph->instances->functions.count, functions);
    assert_int_equal(builder.graph->count, count);
    for (int root = 0; root < ROOT_COUNT; root++)
        assert_int_equal(first.roots[root], second.roots[root]);
    Node guarded = lower_guarded(builder.graph, all, first.roots[0], instances, &scratch);
    assert_int_equal(guarded, first.roots[0]);
}

/* Returns how far a point is outside of the sides of a box. */
static double outside_of(Box box, const double p[3])
{
    double most = -HUGE_VAL;
    for (int k = 0; k < 3; k++)
        most = fmax(most, fmax(box.axis[k].low - p[k], p[k] - box.axis[k].high));
    return most;
}

/* Returns a CSG node of CSG nodes of a few parts.  Parts of intersections overlap: what is nowhere
   has no box. */
static const Shape *random_csg_node(int depth)
{
    static const ShapeKind kinds[]  = {SHAPE_UNION, SHAPE_UNION, SHAPE_DIFFERENCE,
                                       SHAPE_INTERSECTION};
    static const BlendKind blends[] = {BLEND_quadratic, BLEND_cubic, BLEND_exponential};
    const Shape           *parts[5];
    const uint32_t         count = 2 + (uint32_t)random_below(&randomness, 4);
    const Blend            blend = {blends[random_below(&randomness, 3)],
                                    graph_number(builder.graph, between(0.1, 0.6)), 0, NODE_NONE};
    for (uint32_t i = 0; i < count; i++)
        parts[i] = depth > 0 ? random_csg_node(depth - 1)
                             : placed(ball(between(1, 2)), between(-1, 1), between(-1, 1), 0, 1, 1);
    return make_csg_node(&builder, kinds[random_below(&randomness, 4)], parts, count,
                         random_below(&randomness, 3) ? blend : blend_sharp, no_place);
}

/* What they join by blends may count on it that operands are so far away. */
static void csg_nodes_keep_to_their_boxes(void **state)
{
    (void)state;
    size_t outside = 0;
    for (int i = 0; i < 60; i++) {
        const Shape *csg_node = random_csg_node(i % 3);
        Seen         seen     = lower(csg_node, NULL);
        prepare(&seen);
        for (int k = 0; k < POINTS; k++) {
            double p[3];
            random_vector(&randomness, 5, p);
            const double apart = outside_of(csg_node->box, p);
            if (!(apart > 0))
                continue;
            assert_true(isfinite(apart));
            assert_true(look(&seen, p) >= apart - 1e-9);
            outside++;
        }
    }
    assert_true(outside > 20 * POINTS);
}

/* The text of many parts is as long as that of a few. */
static void many_parts_need_few_nodes(void **state)
{
    (void)state;
    size_t made[2];
    for (int more = 0; more < 2; more++) {
        uint32_t      count  = more ? 3000 : 300;
        const Shape **parts  = random_parts(count, true);
        const Shape  *all    = make_csg_node(&builder, SHAPE_UNION, parts, count, blend_sharp,
                                             no_place);
        size_t        before = builder.graph->count;
        lower(all, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
        made[more] = builder.graph->count - before;
    }
    assert_true(made[0] > 0 && made[1] < 2 * made[0]);
}

/* ---- blends ---- */

enum { CHAIN = 72 };

/* Balls in a row: each changes how the next ones join.  They are alike, so they are one instance group. */
static const Shape *chain(BlendKind kind, double width, double step)
{
    const Shape *parts[CHAIN];
    Graph       *g = builder.graph;
    for (int i = 0; i < CHAIN; i++)
        parts[i] = painted(placed(ball(between(0.08, 0.1)), (i - CHAIN / 2) * step,
                                  between(-0.1, 0.1), between(-0.1, 0.1), 0.5, 1.25));
    Blend blend = {kind, graph_number(g, width), 0,
                   kind == BLEND_stairs ? graph_number(g, 3) : NODE_NONE};
    return make_csg_node(&builder, SHAPE_UNION, parts, CHAIN, blend, no_place);
}

static double joined(Blend blend, double a, double b)
{
    const GraphType types[MAX_OPERANDS]    = {TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT};
    NodeValue       operands[MAX_OPERANDS] = {{{a}}, {{b}}};
    operands[2].v[0]                       = builder.graph->items[blend.width].number[0];
    operands[3].v[0] = blend.steps == NODE_NONE ? 0 : builder.graph->items[blend.steps].number[0];
    return op_evaluate(blend_info[blend.kind].op, TYPE_FLOAT, 0, types, operands).v[0];
}

static int compare_distances(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

/* Returns what those that share the result make of a threshold: the most counts. */
static double at_threshold(Blend blend, const double *d, int count, double threshold)
{
    double sum = threshold;
    for (int i = 0; i < count; i++)
        sum += joined(blend, 2 * (d[i] - threshold), 0) / 2;
    return sum;
}

static double shared(Blend blend, const double *d, int count)
{
    double width = builder.graph->items[blend.width].number[0];
    double low = d[0] - width, high = d[0] + width;
    for (int i = 0; i < 150; i++) {
        double left = low + (high - low) * 0.382, right = low + (high - low) * 0.618;
        if (at_threshold(blend, d, count, left) < at_threshold(blend, d, count, right))
            low = left;
        else
            high = right;
    }
    return at_threshold(blend, d, count, 0.5 * (low + high));
}

/* By the definition of each kind (blends.def); the distances are sorted. */
static double blended(Blend blend, double *d, int count)
{
    qsort(d, (size_t)count, sizeof *d, compare_distances);
    double result = d[0];
    switch (blend_many(blend.kind).way) {
    case MANY_SHARE: return shared(blend, d, count < 8 ? count : 8);
    case MANY_PAIRS:
        for (int i = 0; i < count; i++)
            for (int j = i + 1; j < count && j < i + 3; j++)
                result = fmin(result, joined(blend, d[i], d[j]));
        return result;
    default:
        for (int i = 1; i < count; i++)
            result = joined(blend, result, d[i]);
        return result;
    }
}

/* The threshold of quadratic shares, by halving. */
static double threshold_of(const double *d, int count, double width)
{
    double low = -3, high = 6;
    for (int i = 0; i < 100; i++) {
        double middle = 0.5 * (low + high), sum = 0;
        for (int k = 0; k < count; k++)
            sum += fmin(fmax((middle - d[k]) / width, 0), 1);
        *(sum < 1 ? &low : &high) = middle;
    }
    return low;
}

/* Returns the distances of all parts at a point, blended; and their colours. */
static double blended_parts(const Shape *shape, const Seen *parts, const double p[3],
                            NodeValue *color)
{
    double d[CHAIN], sorted[CHAIN], width = builder.graph->items[shape->blend.width].number[0];
    for (uint32_t i = 0; i < shape->child_count; i++)
        d[i] = sorted[i] = look(&parts[i], p);
    double result    = blended(shape->blend, sorted, (int)shape->child_count);
    double threshold = threshold_of(sorted, shape->child_count < 8 ? (int)shape->child_count : 8,
                                    width);
    double shares    = 0;
    for (uint32_t i = 0; i < shape->child_count; i++) {
        const NodeValue *own   = &parts[i].values[parts[i].roots[ROOT_color]];
        double           share = fmin(fmax((threshold - d[i]) / width, 0), 1);
        shares += share;
        for (int k = 0; k < 3; k++)
            color->v[k] += own->v[k] * share;
    }
    for (int k = 0; k < 3; k++)
        color->v[k] /= shares;
    return result / shape->slope;
}

static Difference compare_parts(const Shape *shape, const Seen *parts, const Seen *group)
{
    Difference found = {0};
    for (int i = 0; i < POINTS; i++) {
        double p[3], unit[3];
        random_vector(&randomness, 1, unit);
        for (int k = 0; k < 3; k++)
            p[k] = unit[k] * (k ? 0.5 : 2);
        NodeValue color  = {{0}};
        double    wanted = blended_parts(shape, parts, p, &color), is = look(group, p);
        found.above = fmax(found.above, is - wanted);
        found.inside += wanted < 0;
        if (wanted * shape->slope >= clearance_at(p))
            continue;
        found.right++;
        found.below = fmax(found.below, fabs(is - wanted));
        for (int k = 0; k < 3; k++)
            found.color = fmax(found.color,
                               fabs(group->values[group->roots[ROOT_color]].v[k] - color.v[k]));
    }
    return found;
}

static Difference compare_blend(const Shape *shape, bool without_reach)
{
    static Seen parts[CHAIN];
    Seen        group     = lower(shape, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
    Instances  *instances = builder.graph->instances;
    assert_int_equal(instances->tables.count, 1);
    for (uint32_t i = 0; i < shape->child_count; i++)
        parts[i] = lower(shape->children[i], NULL);
    for (uint32_t i = 0; i < shape->child_count; i++)
        prepare(&parts[i]);
    prepare(&group);
    Box boxes[CHAIN];
    for (uint32_t i = 0; i < CHAIN; i++)
        boxes[i] = shape->children[i]->box;
    InstanceTable *table = &instances->tables.items[0];
    if (without_reach) {
        grid_build(&table->grid, boxes, CHAIN, 0, 0, 1, &arena, &scratch);
        table->cells = table->grid;
    }
    return compare_parts(shape, parts, &group);
}

/* Returns how wrong a blend may be: a ten-thousandth of a width where something is left out. */
static double allowed(BlendKind kind, double width)
{
    return blend_fades(kind) ? 1e-4 * width : 1e-9;
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

/* Where one of two operands is the reach above the result it changes that by less than a ten-thousandth; a
   fifth less is too little. */
static void reach_of_two(void **state)
{
    (void)state;
    for (BlendKind kind = BLEND_quadratic; kind <= BLEND_chamfer; kind++) {
        Blend  blend = {kind, graph_number(builder.graph, 1), 1, NODE_NONE};
        double reach = blend_reach(kind, 2), beyond = 0, within = 0;
        for (int i = 0; i < 100 * POINTS; i++) {
            double a = between(0, 3), b = a + between(-1, 12), result = joined(blend, a, b);
            double above = b - result, changed = fabs(result - a);
            if (result < 0)
                continue;
            if (above >= reach)
                beyond = fmax(beyond, changed);
            else if (above >= 0.8 * reach)
                within = fmax(within, changed);
        }
        assert_true(beyond <= 1e-4);
        assert_true(within > 1e-4 || kind == BLEND_chamfer); /* it reaches less far for two */
    }
}

/* ---- refined grids ---- */

enum { MANY = 400 };

/* Balls that meet, or do not, or are within others. */
static const Shape *cloud(BlendKind kind, double width, bool paint)
{
    const Shape *parts[MANY];
    Graph       *g = builder.graph;
    for (int i = 0; i < MANY; i++) {
        double x = between(-3, 3), y = between(-3, 3), z = between(-3, 3);
        parts[i] = placed(ball(between(0.1, 0.4)), x, y, z, 0.5, 1.25);
        parts[i] = paint ? painted(parts[i]) : parts[i];
    }
    Blend blend = {kind, graph_number(g, width), width,
                   kind == BLEND_stairs ? graph_number(g, 3) : NODE_NONE};
    return make_csg_node(&builder, SHAPE_UNION, parts, MANY, blend, no_place);
}

static double mean_length(const Grid *grid)
{
    size_t cells = grid_cell_count(grid);
    return (double)grid->first[cells] / (double)cells;
}

/* As shaders have it: a bound everywhere, and right where it is less than the clearance. */
static void compare_cells(const Shape *shape, const Seen *parts, const Seen *group, double most)
{
    int right = 0;
    for (int n = 0; n < POINTS; n++) {
        double p[3], d[MANY];
        random_vector(&randomness, n % 8 ? 3 : 5, p);
        double clearance = clearance_at(p);
        for (int i = 0; i < MANY; i++)
            d[i] = look(&parts[i], p);
        double wanted = blended(shape->blend, d, MANY), is = look(group, p);
        assert_true(is <= wanted + most);
        assert_true(wanted >= clearance - most || fabs(is - wanted) <= most);
        right += wanted < clearance && wanted > 0;
    }
    assert_true(right > POINTS / 20);
}

static void refined_blends(void **state)
{
    static Seen parts[MANY];
    for (BlendKind kind = 0; kind < BLEND_COUNT; kind++)
        for (int wide = 0; wide < 2 && blend_info[kind].slope == 1; wide++) {
            bool         fades = blend_fades(kind); /* further, where parts look the same */
            double       width = fades ? (wide ? 0.15 : 0.02) : wide ? 0.5 : 0.1;
            const Shape *shape = cloud(kind, width, !fades || !wide);
            Seen group = lower(shape, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
            const InstanceTable *table = &builder.graph->instances->tables.items[0];
            assert_true(table->cells.size < table->grid.size);
            assert_true(mean_length(&table->cells) < (fades && wide ? 0.25 : 0.05) * MANY);
            group.tape.by_cells = true;
            for (int i = 0; i < MANY; i++)
                parts[i] = lower(shape->children[i], NULL);
            for (int i = 0; i < MANY; i++)
                prepare(&parts[i]);
            prepare(&group);
            compare_cells(shape, parts, &group, allowed(kind, width));
            finish(state);
            start(state);
        }
}

/* ---- blends of two instance groups ---- */

enum { EACH = 100 };

static const Shape *balls_and_rings(BlendKind kind)
{
    const Shape *parts[2 * EACH];
    Graph       *g = builder.graph;
    for (int i = 0; i < 2 * EACH; i++) {
        double x = between(-3, 3), y = between(-3, 3), z = between(-3, 3);
        parts[i] = painted(placed(i < EACH ? ball(0.2) : ring(0.2, 0.1), x, y, z, 0.5, 1.25));
    }
    Blend blend = {kind, graph_number(g, 0.25), 0.25,
                   kind == BLEND_stairs ? graph_number(g, 3) : NODE_NONE};
    return make_csg_node(&builder, SHAPE_UNION, parts, 2 * EACH, blend, no_place);
}

/* At points near the surface they agree; returns how many there are. */
static int compare_instances(const Shape *shape, const Seen *parts, const Seen *instances)
{
    Blend  blend = shape->blend;
    double most  = allowed(blend.kind, 0.25);
    int    near  = 0;
    for (int n = 0; n < POINTS; n++) {
        double p[3], d[2 * EACH];
        random_vector(&randomness, 3, p);
        for (int i = 0; i < 2 * EACH; i++)
            d[i] = look(&parts[i], p);
        double wanted = blended(blend, d, 2 * EACH), is = look(instances, p) * shape->slope;
        assert_true(is <= wanted + most);
        if (fabs(wanted) > 0.02)
            continue;
        near++;
        assert_true(is >= wanted - most);
    }
    return near;
}

/* As shaders have them: each must be right farther away than its surface. */
static void blends_of_instances(void **state)
{
    static Seen parts[2 * EACH];
    for (BlendKind kind = 0; kind < BLEND_COUNT; kind++) {
        const Shape *shape = balls_and_rings(kind);
        Seen instances     = lower(shape, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
        assert_int_equal(builder.graph->instances->tables.count, 2);
        instances.tape.by_cells = true;
        for (int i = 0; i < 2 * EACH; i++)
            parts[i] = lower(shape->children[i], NULL);
        for (int i = 0; i < 2 * EACH; i++)
            prepare(&parts[i]);
        prepare(&instances);
        assert_true(compare_instances(shape, parts, &instances) > POINTS / 100);
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
        TEST(csg_nodes_keep_to_their_boxes),
        TEST(blends),
        TEST(reach_is_needed),
        TEST(reach_of_two),
        TEST(refined_blends),
        TEST(blends_of_instances),
    };
    return cmocka_run_group_tests_name("instance groups", tests, NULL, NULL);
}
