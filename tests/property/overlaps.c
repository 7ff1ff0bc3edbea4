/*
 * overlaps.c: how many boxes have a point in common, against all points where the most can be; and the slopes
 * of blends that follow, against differences of distances.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "compiler/shape/box.h"
#include "compiler/shape/overlap.h"
#include "tests/property/instance_parts.h"

enum { BOXES = 30, TRIALS = 40 };

static Box random_box(double most)
{
    Box box;
    for (int k = 0; k < 3; k++) {
        double low  = between(-3, 3);
        box.axis[k] = (Range){low, low + between(0, most)};
    }
    return box;
}

static uint32_t boxes_around(const Box *boxes, const double p[3], double grown)
{
    uint32_t count = 0;
    for (int i = 0; i < BOXES; i++) {
        bool around = !box_is_empty(boxes[i]);
        for (int k = 0; k < 3; k++)
            around = around && boxes[i].axis[k].low - grown <= p[k] &&
                     p[k] <= boxes[i].axis[k].high + grown;
        count += around;
    }
    return count;
}

/* The most are around a point with the low sides of some boxes. */
static uint32_t brute_overlap(const Box *boxes, double grown)
{
    uint32_t most = 0;
    for (int i = 0; i < BOXES * BOXES * BOXES; i++) {
        const double p[3] = {boxes[i % BOXES].axis[0].low - grown,
                             boxes[i / BOXES % BOXES].axis[1].low - grown,
                             boxes[i / BOXES / BOXES].axis[2].low - grown};
        uint32_t     here = boxes_around(boxes, p, grown);
        most              = here > most ? here : most;
    }
    return most;
}

static void overlaps(void **state)
{
    Box boxes[BOXES];
    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        double grown = trial % 2 ? 0.3 : 0;
        for (int i = 0; i < BOXES; i++)
            boxes[i] = i % 10 == 9 ? box_empty : random_box(trial % 3 ? 1 : 4);
        if (trial % 5 == 0)
            boxes[0] = box_infinite;
        uint32_t found = max_overlap(boxes, BOXES, grown, &scratch);
        uint32_t exact = brute_overlap(boxes, grown);
        assert_true(found >= exact && found <= exact);
    }
}

/* Many boxes take little time, and few are found. */
static void many_overlaps(void **state)
{
    enum { MANY_BOXES = 100000 };
    Box *boxes = arena_new_array(&arena, Box, MANY_BOXES);
    (void)state;
    for (int i = 0; i < MANY_BOXES; i++)
        boxes[i] = random_box(0.1);
    uint32_t found = max_overlap(boxes, MANY_BOXES, 0, &scratch);
    assert_true(found >= 3 && found <= 25);
}

/* ---- slopes of blends ---- */

static const Shape *blended(ShapeKind kind, BlendKind blend, double width)
{
    const Shape *parts[PARTS];
    for (int i = 0; i < PARTS; i++) {
        double x = between(-2, 2), y = between(-2, 2), z = between(-2, 2);
        parts[i] = placed(ball(between(0.1, 0.3)), x, y, z, 0.5, 1.25);
    }
    if (kind == SHAPE_DIFFERENCE)
        parts[0] = ball(1.7);
    Blend how = {blend, graph_number(builder.graph, width), 0, NODE_NONE};
    return make_csg_node(&builder, kind, parts, PARTS, how, no_place);
}

/* Returns the steepest line between two points near each other. */
static double steepest(const Seen *seen)
{
    double most = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3], by[3], q[3], here, gradient[3];
        random_vector(&randomness, 2, p);
        here = look(seen, p);
        for (int k = 0; k < 3; k++) {
            for (int n = 0; n < 3; n++)
                by[n] = p[n] + 1e-5 * (n == k);
            gradient[k] = (look(seen, by) - here) / 1e-5;
        }
        for (int k = 0; k < 3; k++)
            q[k] = p[k] + 1e-4 * gradient[k] / fmax(length3(gradient), 1e-9);
        most = fmax(most, (look(seen, q) - here) / 1e-4);
    }
    return most;
}

/* Balls whose boxes do not meet: far away their distances grow in nearly the same direction. */
static const Shape *fan(ShapeKind kind, BlendKind blend)
{
    const Shape *parts[] = {ball(1.7), placed(ball(0.1), 2, 0.25, 0, 0, 1),
                            placed(ball(0.1), 2, 0, 0, 0, 1), placed(ball(0.1), 2, -0.25, 0, 0, 1)};
    uint32_t     first   = kind == SHAPE_UNION;
    Blend        how     = {blend, graph_number(builder.graph, 0.8), 0, NODE_NONE};
    return make_csg_node(&builder, kind, parts + first, 4 - first, how, no_place);
}

/* They would be too small without what a blend reaches, or without the inside of what tools cut. */
static void slopes_of_fans(void **state)
{
    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        const Shape *shape = fan(trial & 2 ? SHAPE_DIFFERENCE : SHAPE_UNION,
                                 trial % 2 ? BLEND_circular : BLEND_chamfer);
        Seen seen = lower(shape, NULL);
        prepare(&seen);
        double most = steepest(&seen);
        assert_true(most > 0.6 && most <= 1 + 1e-6);
    }
}

static void slopes_of_blends(void **state)
{
    for (int trial = 0; trial < 8; trial++) {
        const BlendKind blend = trial % 2 ? BLEND_circular : BLEND_chamfer;
        ShapeKind       kind  = trial & 2 ? SHAPE_DIFFERENCE : SHAPE_UNION;
        const Shape    *shape = blended(kind, blend, trial & 4 ? 0.3 : 0.1);
        Seen group = lower(shape, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
        Seen apart = lower(shape, NULL);
        assert_true(shape->slope > 1.4 && shape->slope < 0.7 * sqrt(PARTS));
        prepare(&group);
        prepare(&apart);
        double most = fmax(steepest(&group), steepest(&apart));
        assert_true(most > 0.3 && most <= 1 + 1e-6);
        finish(state);
        start(state);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, start, finish)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(overlaps), TEST(many_overlaps), TEST(slopes_of_fans),
                                       TEST(slopes_of_blends)};
    return cmocka_run_group_tests_name("overlaps", tests, NULL, NULL);
}
