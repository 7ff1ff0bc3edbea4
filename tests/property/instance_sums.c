/*
 * instance_sums.c: exponential blends of instance groups, which add up powers, for all widths that a frame may have.  The
 * oracle is the definition.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/property/instance_parts.h"

/* Returns the result of an exponential blend, by its definition. */
static double log_of_sum(const double *distances, int count, double width)
{
    double least = HUGE_VAL, sum = 0;
    for (int i = 0; i < count; i++)
        least = fmin(least, distances[i]);
    for (int i = 0; i < count && width > 0; i++)
        sum += exp((least - distances[i]) / width);
    return width > 0 ? least - width * log(sum) : least;
}

/* Returns a quarter of them in one place; joined with the width that the parameter is. */
static const Shape *balls_of_any_width(void)
{
    const Shape   *parts[PARTS];
    GraphParameter range = {{0}, {1}};
    array_push(&arena, &builder.graph->parameters, range);
    for (int i = 0; i < PARTS; i++)
        parts[i] = i % 4 > 0 ? placed(ball(0.2), between(-3, 3), between(-3, 3), 0, 0, 1)
                             : placed(ball(0.2), 1, 2, 0, 0, 1);
    Node width = graph_parameter(builder.graph, 1, TYPE_FLOAT);
    return make_csg_node(&builder, SHAPE_UNION, parts, PARTS,
                         (Blend){BLEND_exponential, width, 1, NODE_NONE}, no_place);
}

/* In the frame that is now. */
static void compare_at(const double p[3], const Seen *parts, const Seen *group)
{
    double each[PARTS];
    for (int i = 0; i < PARTS; i++)
        each[i] = look(&parts[i], p);
    double wanted = log_of_sum(each, PARTS, height);
    assert_true(fabs(look(group, p) - wanted) <= 1e-12 + 1e-4 * height);
}

static void widths_of_frames(void **state)
{
    (void)state;
    static const double widths[] = {0.3, 1, 1e-3, 1e-9, 0, 0.05};
    static Seen         parts[PARTS];
    const Shape        *all = balls_of_any_width();
    Seen group              = lower(all, lowered_groups_new(builder.graph, &arena, &arena, LEAST));
    assert_true(builder.graph->instances->functions.items[0].sums);
    for (int i = 0; i < PARTS; i++)
        parts[i] = lower(all->children[i], NULL);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        height = widths[w];
        prepare(&group);
        for (int i = 0; i < PARTS; i++)
            prepare(&parts[i]);
        for (int n = 0; n < POINTS / 10; n++) {
            double p[3];
            random_vector(&randomness, 4, p);
            compare_at(p, parts, &group);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(widths_of_frames, start, finish),
    };
    return cmocka_run_group_tests_name("sums of instance groups", tests, NULL, NULL);
}
