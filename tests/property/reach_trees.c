/*
 * reach_trees.c: the bounds of a tree of 28 mirrors shrink to its crown, and nothing solid of its
 * scene is outside of them.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <time.h>
#include <cmocka.h>

#include "krs/krs.h"

#include "tests/property/reach_instances.h"

enum { MIRRORS = 28, TREE_STAGES = 2 * MIRRORS + 1 };

/* A branch of bench/scenes/tree.krs: where it begins, and its directions ahead and to the side. */
typedef struct Branch {
    double at[3], ahead[3], side[3];
} Branch;

/* Goes on along an arc that turns by twice `bend`; the box grows around what is passed. */
static Branch next_branch(Branch branch, int number, Box *box)
{
    const double degree = acos(-1) / 180, turn = 100 * degree;
    double       bend = (number == 0 ? 5 : 14) * degree, width = 0.075 * pow(0.75, number);
    double       reach = number == 0 ? 0.7 : pow(0.72, number), left[3], up[3];
    Branch       next  = branch;
    *box               = box_empty;
    for (int part = 0; part <= 2; part++) {
        double angle = 0.5 * bend * part, length = reach * sin(angle) / sin(bend);
        for (int i = 0; i < 3; i++)
            next.at[i] = branch.at[i] +
                         length * (cos(angle) * branch.ahead[i] + sin(angle) * branch.side[i]);
        include(box, next.at);
    }
    for (int i = 0; i < 3; i++) {
        box->axis[i].low -= width;
        box->axis[i].high += width;
        next.ahead[i] = cos(2 * bend) * branch.ahead[i] + sin(2 * bend) * branch.side[i];
        left[i]       = cos(2 * bend) * branch.side[i] - sin(2 * bend) * branch.ahead[i];
    }
    cross3(next.ahead, left, up);
    for (int i = 0; i < 3; i++)
        next.side[i] = cos(turn) * left[i] + sin(turn) * up[i];
    return next;
}

/* Kernel, mirror, kernel, ..., kernel, without bounds, from the last twig to the root. */
static void grow_tree(ReachStage stages[TREE_STAGES])
{
    const double lean = acos(-1) / 36, tilt = acos(-1) / 20;
    Branch       branch = {{0}, {-sin(lean), cos(lean), 0}, {cos(lean), sin(lean), 0}};
    for (int number = 0; number <= MIRRORS; number++) {
        ReachStage *kernel = &stages[TREE_STAGES - 1 - 2 * number];
        *kernel            = (ReachStage){.kind = REACH_KERNEL};
        if (number > 0) {
            ReachStage *mirror = kernel + 1;
            *mirror            = (ReachStage){.kind = REACH_REFLECT};
            for (int i = 0; i < 3; i++)
                mirror->normal[i] = -sin(tilt) * branch.ahead[i] - cos(tilt) * branch.side[i];
            mirror->offset = dot3(mirror->normal, branch.at);
        }
        branch = next_branch(branch, number, &kernel->kernel);
    }
}

/* A random point of a random instance; false when a mirror cut it off. */
static bool random_point(Random *random, const ReachStage stages[TREE_STAGES], double p[3])
{
    uint32_t     from = 2 * random_below(random, MIRRORS + 1);
    const Range *side = stages[from].kernel.axis;
    for (int i = 0; i < 3; i++)
        p[i] = random_between(random, side[i].low, side[i].high);
    for (uint32_t i = from + 1; i < TREE_STAGES; i += 2) {
        if (excess(&stages[i], p) > 0)
            return false;
        if (random_below(random, 2))
            reflect(&stages[i], p);
    }
    return true;
}

/* What 100,000 points of it show of a tree of 2^28 twigs, all of which must be within. */
static Box seen_of_tree(const ReachStage stages[TREE_STAGES])
{
    const ReachStage *last   = &stages[TREE_STAGES - 1];
    Random            random = {1};
    Box               seen   = box_empty;
    int               found  = 0;
    for (int i = 0; i < 100000; i++) {
        double p[3];
        if (!random_point(&random, stages, p))
            continue;
        assert_true(in_box(last->box, p) && in_ball(last->ball, p));
        include(&seen, p);
        found++;
    }
    assert_true(found > 50000);
    return seen;
}

static void trees_shrink_to_their_crowns(void **context)
{
    (void)context;
    ReachStage loose[TREE_STAGES], tight[TREE_STAGES];
    grow_tree(loose);
    grow_tree(tight);
    clock_t start = clock();
    for (uint32_t i = 0; i < TREE_STAGES; i++) {
        bound_loosely(&loose[i], i > 0 ? &loose[i - 1] : NULL, true);
        bound_loosely(&tight[i], i > 0 ? &tight[i - 1] : NULL, true);
        if (tight[i].kind == REACH_REFLECT)
            reach_tighten(tight, i + 1);
    }
    /* It takes about a millisecond; 2^28 instances one by one would take minutes. */
    assert_true(clock() - start < CLOCKS_PER_SEC);

    double wide = diagonal(loose[TREE_STAGES - 1].box), far = 0;
    Box    box = tight[TREE_STAGES - 1].box, seen = seen_of_tree(tight);
    for (int i = 0; i < 3; i++) {
        far = fmax(far, box.axis[i].high - seen.axis[i].high);
        far = fmax(far, seen.axis[i].low - box.axis[i].low);
    }
    print_message("# tree of %d mirrors: diagonal %.3f, when loose %.3f; "
                  "at most %.3f beyond what is seen\n",
                  MIRRORS, diagonal(box), wide, far);
    assert_true(diagonal(box) < 0.6 * wide);
    assert_true(far < LOOSE * diagonal(seen));
}

/* ---- a scene ---- */

/* Goes from one point to another until it is inside of a solid; false when it never is.  Nothing
   solid may be met outside of the box. */
static bool walk(KrsState *state, Box box, const double from[3], const double to[3], double p[3])
{
    double offset[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, distance, t = 0;
    double length = sqrt(dot3(offset, offset));
    while (t < 2 * length) {
        for (int i = 0; i < 3; i++)
            p[i] = from[i] + offset[i] * t / length;
        krs_distance(state, (const double(*)[3])p, 1, &distance);
        assert_true(distance > 0 || in_box(box, p));
        if (distance <= 0)
            return true;
        t += fmax(distance, 1e-4);
    }
    return false;
}

/* Random points around the box, of up to `far` diagonals. */
static void random_outside(Random *random, Box box, double far, double p[3])
{
    do
        for (int i = 0; i < 3; i++) {
            double more = far * diagonal(box);
            p[i]        = random_between(random, box.axis[i].low - more, box.axis[i].high + more);
        }
    while (in_box(box, p));
}

/* What 2,000 walks from around a box into it meet. */
static Box seen_of_scene(KrsState *state, Box box)
{
    Box    seen   = box_empty;
    Random random = {3};
    for (int i = 0; i < 2000; i++) {
        double from[3], to[3], p[3];
        random_outside(&random, box, 0.2, from);
        for (int k = 0; k < 3; k++)
            to[k] = random_between(&random, box.axis[k].low, box.axis[k].high);
        if (walk(state, box, from, to, p))
            include(&seen, p);
    }
    return seen;
}

/* Distances know nothing of the box, so they can refute it: what is shown may neither stick out
   nor, since the walks come close to every side, leave much of the box empty. */
static void nothing_solid_is_outside_of_reported_bounds(void **context)
{
    (void)context;
    KrsScene    *scene;
    KrsState    *state;
    KrsComponent tree;
    assert_int_equal(krs_compile_file("bench/scenes/tree28.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_component_count(scene), 1);
    assert_int_equal(krs_component(scene, 0, &tree), KRS_OK);
    Box box = {
        {{tree.low[0], tree.high[0]}, {tree.low[1], tree.high[1]}, {tree.low[2], tree.high[2]}}};
    Random random = {4};
    for (int i = 0; i < 10000; i++) {
        double p[3], distance;
        random_outside(&random, box, i % 2 == 0 ? 0.01 : 0.5, p);
        krs_distance(state, (const double(*)[3])p, 1, &distance);
        assert_true(distance > 0);
    }
    Box seen = seen_of_scene(state, box);
    for (int i = 0; i < 3; i++) {
        assert_true(box.axis[i].high - seen.axis[i].high < 0.05 * diagonal(box));
        assert_true(seen.axis[i].low - box.axis[i].low < 0.05 * diagonal(box));
    }
    krs_state_free(state);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_shrink_to_their_crowns),
        cmocka_unit_test(nothing_solid_is_outside_of_reported_bounds),
    };
    return cmocka_run_group_tests_name("reach of trees", tests, NULL, NULL);
}
