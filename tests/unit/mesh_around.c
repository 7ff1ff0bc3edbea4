/* mesh_around.c: where good corners prove, no way of the length that they ask for ends in a tetrahedron that is worse. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "mesh/proof/around.h"
#include "tests/support/random.h"

static Random chance = {29};

/* Tetrahedra of which some are bounded, by less than WAY, and some are not; slopes are 1. */
static const double WAY = 0.05, ERROR = 0.075, ORIGIN[3] = {0, 0, 0};

static void open_tets(Tets *tets, Arena *arena, double bad)
{
    *tets = (Tets){0};
    tets_new(tets, ORIGIN, 1, arena);
    for (int turn = 0; turn < 9; turn++) {
        size_t count = tets->list.count;
        for (size_t i = 0; i < count; i++)
            if (turn < 6 || random_between(&chance, 0, 1) < 0.3)
                tets_bisect(tets, i);
        tets_close(tets);
    }
    for (size_t i = 0; i < tets->list.count; i++) {
        Tet *tet       = &tets->list.items[i];
        bool lost      = random_between(&chance, 0, 1) < bad;
        tet->state     = TET_FITS;
        tet->slope     = 1;
        tet->deviation = lost ? INFINITY : (float)(WAY * random_between(&chance, 0.5, 1));
    }
}

static void weights_in(const double corners[4][3], const double p[3], double weights[4])
{
    double edges[3][3], normal[3], from[3];
    weights[0] = 1;
    for (int i = 0; i < 3; i++)
        add_scaled3(edges[i], corners[i + 1], -1, corners[0]);
    add_scaled3(from, p, -1, corners[0]);
    for (int i = 0; i < 3; i++) {
        cross3(edges[(i + 1) % 3], edges[(i + 2) % 3], normal);
        weights[i + 1] = dot3(from, normal) / dot3(edges[i], normal);
        weights[0] -= weights[i + 1];
    }
}

/* Returns the worst of all that have a point, at their boundaries too; -1: none has it. */
static double worst_deviation_at(const Tets *tets, const double p[3])
{
    double worst = -1, corners[4][3], weights[4];
    for (size_t i = 0; i < tets->list.count; i++) {
        tets_corners(tets, &tets->list.items[i], corners);
        weights_in((const double(*)[3])corners, p, weights);
        bool has = true;
        for (int k = 0; k < 4; k++)
            has = has && weights[k] >= -1e-9;
        if (has)
            worst = fmax(worst, tets->list.items[i].deviation);
    }
    return worst;
}

/* More often near to a corner than evenly. */
static void random_point_in(const double corners[4][3], double p[3])
{
    double weights[4], sum = 0;
    memset(p, 0, 3 * sizeof *p);
    for (int k = 0; k < 4; k++) {
        weights[k] = pow(random_between(&chance, 0, 1), 4);
        sum += weights[k];
    }
    for (int k = 0; k < 4; k++)
        add_scaled3(p, p, weights[k] / sum, corners[k]);
}

static bool any_way_is_lost(const Tets *tets, const double p[3])
{
    enum { WAYS = 24 };
    for (int i = 0; i < WAYS; i++) {
        double direction[3], end[3];
        random_vector(&chance, 1, direction);
        normalize3(direction);
        add_scaled3(end, p, WAY, direction);
        if (worst_deviation_at(tets, end) > WAY)
            return true;
    }
    return false;
}

/* Compares what is said of each point in a bounded tetrahedron with ways in all directions. */
static void no_way_ends_in_a_bad_one(void **context)
{
    enum { SPACES = 6, POINTS = 200 };
    int sure_count = 0, safe_count = 0, partly = 0;
    (void)context;
    for (int space = 0; space < SPACES; space++) {
        Memory  memory  = {0};
        Arena   arena   = {.memory = &memory};
        Arounds arounds = {0};
        Tets    tets;
        open_tets(&tets, &arena, space % 2 ? 0.01 : 0.04);
        arounds_find(&arounds, &tets, &arena);
        for (int i = 0; i < POINTS;) {
            const Tet *tet = &tets.list.items[random_below(&chance, (uint32_t)tets.list.count)];
            double     corners[4][3], points[4][3];
            Sure       sure;
            if (tet->deviation > WAY)
                continue;
            tets_corners(&tets, tet, corners);
            random_point_in((const double(*)[3])corners, points[0]);
            for (int k = 1; k < 4; k++)
                memcpy(points[k], points[0], sizeof points[k]);
            sure_find(&arounds, &tets, tet, ERROR, &sure);
            bool is_sure = sure.anywhere && sure_has(&sure, (const double(*)[3])points);
            bool lost    = any_way_is_lost(&tets, points[0]);
            assert_false(is_sure && lost);
            assert_true(!sure.everywhere || is_sure);
            sure_count += is_sure;
            safe_count += !lost;
            partly += is_sure && !sure.everywhere;
            i++;
        }
        arena_free(&arena);
    }
    print_message("# %d points, %d safe, %d proven, %d of them not as all of theirs\n",
                  SPACES * POINTS, safe_count, sure_count, partly);
    assert_true(partly > 50 && sure_count > safe_count / 2);
}

/* One function in all is as the distance itself; of several only the distance to the surface tells. */
static void functions_are_told_apart(void **context)
{
    Memory  memory  = {0};
    Arena   arena   = {.memory = &memory};
    Arounds arounds = {0};
    Tets    tets;
    Sure    sure;
    (void)context;
    open_tets(&tets, &arena, 0);
    for (int mixed = 0; mixed < 2; mixed++) {
        for (size_t i = 0; i < tets.list.count; i++) {
            tets.list.items[i].steep     = 1;
            tets.list.items[i].slope     = 0.5F;
            tets.list.items[i].origin    = mixed ? 1 + (uint32_t)i % 2 : 1;
            tets.list.items[i].deviation = (float)(0.4 * ERROR);
        }
        arounds_find(&arounds, &tets, &arena);
        for (size_t i = 0; i < tets.list.count; i++) {
            sure_find(&arounds, &tets, &tets.list.items[i], ERROR, &sure);
            assert_int_equal(sure.everywhere, !mixed);
        }
    }
    arena_free(&arena);
}

/* A path, and what is wrong around its end, must leave room before a part that faces the surface. */
static void paths_end_before_facing_parts(void **context)
{
    static const double ROOMS[] = {1.15, 1.25}; /* path and distance are 0.8 and 0.4 */
    Memory              memory  = {0};
    Arena               arena   = {.memory = &memory};
    Arounds             arounds = {0};
    Tets                tets;
    Sure                sure;
    (void)context;
    open_tets(&tets, &arena, 0);
    for (int roomy = 0; roomy < 2; roomy++) {
        for (size_t i = 0; i < tets.list.count; i++) {
            tets.list.items[i].steep     = 1;
            tets.list.items[i].slope     = 0.5F;
            tets.list.items[i].deviation = (float)(0.2 * ERROR);
            tets.list.items[i].room      = (float)(ROOMS[roomy] * ERROR);
        }
        arounds_find(&arounds, &tets, &arena);
        for (size_t i = 0; i < tets.list.count; i++) {
            sure_find(&arounds, &tets, &tets.list.items[i], ERROR, &sure);
            assert_int_equal(sure.anywhere, roomy);
        }
    }
    arena_free(&arena);
}

/* Returns a growth along the first axis, of one piece with this derivative there. */
static Growth growth_of(double least, double most)
{
    Growth      growth = {.direction = {1, 0, 0}};
    const Range by[3]  = {{least, most}, {-0.1, 0.1}, {-0.1, 0.1}};
    growth_add(&growth, by, 1);
    return growth;
}

/* Of several functions all must grow along the path of one: as far as to the largest value on the wrong side. */
static void functions_grow_along_paths(void **context)
{
    Memory  memory  = {0};
    Arena   arena   = {.memory = &memory};
    Arounds arounds = {0};
    Tets    tets;
    Sure    sure;
    (void)context;
    open_tets(&tets, &arena, 0);
    for (int slow = 0; slow < 2; slow++) {
        Growth growths[2]     = {growth_of(0.5, 0.9), growth_of(slow ? 0.3 : 0.45, 0.7)};
        arounds.growths.items = growths;
        for (size_t i = 0; i < tets.list.count; i++) {
            tets.list.items[i].steep     = 1;
            tets.list.items[i].slope     = 0.5F;
            tets.list.items[i].origin    = 1 + (uint32_t)i % 2;
            tets.list.items[i].growth    = 1 + (uint32_t)i % 2;
            tets.list.items[i].deviation = (float)(0.4 * ERROR);
        }
        arounds_find(&arounds, &tets, &arena);
        for (size_t i = 0; i < tets.list.count; i++) {
            sure_find(&arounds, &tets, &tets.list.items[i], ERROR, &sure);
            assert_int_equal(sure.everywhere, !slow);
        }
    }
    arena_free(&arena);
}

/* No derivatives in the ranges grow less, of pieces as many as are kept and more. */
static void growths_hold(void **context)
{
    (void)context;
    for (int turn = 0; turn < 2000; turn++) {
        Growth growth = {.count = 0};
        Range  by[MAX_GROWING + 2][3];
        float  direction[3];
        double least = INFINITY;
        int    count = 1 + turn % (MAX_GROWING + 2);
        for (int k = 0; k < 3; k++)
            direction[k] = (float)random_between(&chance, -1, 1);
        for (int i = 0; i < count; i++) {
            double sign = i % 2 ? 1 : -1, sum = 0;
            for (int k = 0; k < 3; k++) {
                double low = random_between(&chance, -1, 1);
                by[i][k]   = (Range){low, low + random_between(&chance, 0, 0.3)};
                sum += fmin(sign * by[i][k].low * direction[k],
                            sign * by[i][k].high * direction[k]);
            }
            growth_add(&growth, by[i], sign);
            least = fmin(least, sum);
        }
        double found = growth_along(&growth, direction);
        assert_true(found <= least + 1e-12);
        assert_true(count > MAX_GROWING || found >= least - 1e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_way_ends_in_a_bad_one),
        cmocka_unit_test(functions_are_told_apart),
        cmocka_unit_test(functions_grow_along_paths),
        cmocka_unit_test(paths_end_before_facing_parts),
        cmocka_unit_test(growths_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
