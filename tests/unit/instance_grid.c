/*
 * instance_grid.c: compiler/graph/instances/grid_build.c lists all boxes that are near.  The oracle measures the
 * distance to each box.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/far.h"
#include "compiler/base/vec.h"
#include "compiler/graph/instances/grid_build.h"
#include "tests/support/bench.h"
#include "tests/support/processors.h"

enum { MAX_BOXES = 4000, POINTS = 1000 };

static double box_distance(const Box *box, const double point[3])
{
    double away[3];
    for (int k = 0; k < 3; k++)
        away[k] = fmax(fmax(box->axis[k].low - point[k], point[k] - box->axis[k].high), 0);
    return hypot(hypot(away[0], away[1]), away[2]);
}

static bool is_empty(const Box *box)
{
    return box->axis[0].low > box->axis[0].high || box->axis[1].low > box->axis[1].high ||
           box->axis[2].low > box->axis[2].high;
}

/* ---- Boxes of many kinds ---- */

typedef enum Kind {
    CUBE,     /* small ones in a cube */
    TOUCHING, /* each touches the next ones */
    OVERLAPPING,
    TOWN,      /* on a plane */
    LINE,      /* on a slanted line */
    AXIS,      /* on the x axis, points */
    CLUSTERS,  /* two, far apart */
    ONE_LARGE, /* and many small ones */
    SOME_LARGE,
    EQUAL,      /* all the same */
    SAME_POINT, /* all the same, and without size */
    SOME_EMPTY,
    FAR_AWAY, /* around a point that is far from the origin */
    TINY,
    HUGE_ONES,
    KINDS
} Kind;

typedef struct Form {
    double around[3], spread[3], least, most; /* half of the sides */
} Form;

static const Form forms[KINDS] = {
    [CUBE]        = {{1, 2, 3}, {5, 5, 5}, 0.01, 0.1},
    [OVERLAPPING] = {{0}, {5, 5, 5}, 0.5, 2},
    [TOWN]        = {{10, 0.5, -3}, {60, 0.1, 60}, 0.3, 0.6},
    [LINE]        = {{0}, {0, 0, 0}, 0.1, 0.2},
    [AXIS]        = {{0}, {100, 0, 0}, 0, 0},
    [CLUSTERS]    = {{0}, {1, 1, 1}, 0.01, 0.05},
    [ONE_LARGE]   = {{0}, {10, 10, 10}, 0.05, 0.1},
    [SOME_LARGE]  = {{0}, {10, 10, 10}, 0.05, 0.1},
    [EQUAL]       = {{3, 4, 5}, {0, 0, 0}, 1, 1},
    [SAME_POINT]  = {{3, 4, 5}, {0, 0, 0}, 0, 0},
    [SOME_EMPTY]  = {{0}, {5, 5, 5}, 0.1, 0.2},
    [FAR_AWAY]    = {{1e6, -1e6, 1e6}, {50, 50, 50}, 0.1, 1},
    [TINY]        = {{0}, {1e-6, 1e-6, 1e-6}, 1e-8, 1e-7},
    [HUGE_ONES]   = {{0}, {1e6, 1e6, 1e6}, 1e3, 1e5},
};

static void box_around(Box *box, const double center[3], double half)
{
    for (int k = 0; k < 3; k++)
        box->axis[k] = (Range){center[k] - half, center[k] + half};
}

static void make_box(Random *random, Kind kind, uint32_t i, uint32_t count, Box *box)
{
    const Form *form = &forms[kind];
    double      center[3], half = random_between(random, form->least, form->most);
    uint32_t    side = (uint32_t)ceil(cbrt(count));
    for (int k = 0; k < 3; k++)
        center[k] = form->around[k] + random_between(random, -1, 1) * form->spread[k];
    if (kind == LINE)
        for (int k = 0; k < 3; k++)
            center[k] = (k + 1) * (double)i;
    if (kind == CLUSTERS && i % 2)
        center[1] += 1000;
    if ((kind == ONE_LARGE && i == count / 2) || (kind == SOME_LARGE && i % 16 == 0))
        half = random_between(random, 5, 20);
    if (kind == TOUCHING) {
        double corner[3] = {i % side, (uint32_t)(i / side % side), (uint32_t)(i / side / side)};
        memcpy(center, corner, sizeof center);
        half = 0.5;
    }
    box_around(box, center, half);
    if (kind == SOME_EMPTY && i % 3 == 0)
        box->axis[i % 3 % 3] = (Range){HUGE_VAL, -HUGE_VAL};
}

static void make_boxes(Random *random, Kind kind, Box *boxes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        make_box(random, kind, i, count, &boxes[i]);
}

/* ---- The checker ---- */

typedef struct Case {
    const Box *boxes;
    uint32_t   count;
    double     reach, margin; /* as grid_build had them */
} Case;

static uint32_t count_present(const Case *of)
{
    uint32_t present = 0;
    for (uint32_t i = 0; i < of->count; i++)
        present += !is_empty(&of->boxes[i]);
    return present;
}

/* How a list is wrong at a point, or NULL. */
static const char *list_is_wrong(const Grid *grid, const Case *of, const double point[3])
{
    uint32_t        count, next = 0;
    double          clearance;
    const uint32_t *list     = grid_find(grid, point, &count, &clearance);
    double          rounding = 1e-14 * (largest3(point) + of->reach);
    for (uint32_t i = 0; i < of->count; i++) {
        if (next < count && list[next] == i) {
            if (is_empty(&of->boxes[i]))
                return "an empty box is listed";
            next++;
        } else if (!is_empty(&of->boxes[i]) &&
                   box_distance(&of->boxes[i], point) + rounding < clearance + of->reach)
            return "a box that is not listed is too near";
    }
    if (next != count)
        return "a list is not ascending";
    if (!(clearance > 0))
        return "a clearance is not above 0";
    if (count < count_present(of) && clearance < of->margin)
        return "a clearance is less than the margin";
    return NULL;
}

/* How the instances near a point are wrong, or NULL; they are asked for in two parts. */
static const char *near_is_wrong(const Grid *grid, const Case *of, const double point[3],
                                 double radius)
{
    double rounding = 1e-14 * (largest3(point) + of->reach + radius);
    bool   all      = grid_is_within(grid, point, radius);
    for (uint32_t part = 0; part < 2; part++) {
        uint32_t      half = of->count / 2;
        NearInstances near = {.first = part * half, .count = part ? of->count - half : half};
        grid_near(grid, point, radius, 0, &near);
        for (uint32_t i = 0; i < near.count; i++) {
            const Box *box = &of->boxes[near.first + i];
            bool       is  = near.bits[i / 64] >> i % 64 & 1;
            if (is && is_empty(box))
                return "an empty box is near";
            if (!is && !is_empty(box) &&
                (all || box_distance(box, point) + rounding < radius + of->reach))
                return "a near box is left out";
        }
    }
    return NULL;
}

static const char *totals_are_wrong(const Grid *grid, const Case *of)
{
    size_t   cells = (size_t)grid->cells[0] * grid->cells[1] * grid->cells[2];
    uint32_t most  = 0;
    for (size_t c = 0; c < cells; c++)
        most = (uint32_t)fmax(most, grid->first[c + 1] - grid->first[c]);
    if (most != grid->max_listed)
        return "the longest list has another length";
    double few = fmin(18.0 * of->count, 1.1e6);
    if (cells > fmin(fmax(6.0 * of->count, few) + 9000, 70.0 * of->count))
        return "there are too many cells";
    if (grid->first[cells] > fmax(8.0 * of->count, fmin(1024.0 * of->count, 1 << 23)) + 4096)
        return "there are too many entries";
    return NULL;
}

/* Chooses a point in the grid, close to a box, at the border of a cell, or around the grid. */
static void choose_point(Random *random, const Grid *grid, const Case *of, double point[3])
{
    const Box *box = &of->boxes[random_below(random, (int)of->count)];
    int        way = random_below(random, 4);
    for (int k = 0; k < 3; k++) {
        double side   = isfinite(grid->size) ? grid->cells[k] * grid->size : 10;
        double inside = random_between(random, 0, 1) * side;
        double near   = random_between(random, box->axis[k].low, box->axis[k].high) - grid->low[k] +
                      random_between(random, -1, 1) * (side / grid->cells[k] + of->reach);
        double border = floor(inside / grid->size) * (side / grid->cells[k]) *
                        (1 + random_below(random, 2) * 1e-15);
        double around   = random_between(random, -0.2, 1.2) * side;
        double of_way[] = {inside, isfinite(near) ? near : inside, border, around};
        point[k]        = grid->low[k] + of_way[way];
    }
}

/* How a grid is wrong, or NULL. */
static const char *grid_is_wrong(const Grid *grid, const Case *of, Random *random)
{
    const char *wrong  = totals_are_wrong(grid, of);
    int         points = of->count < MAX_BOXES ? POINTS : POINTS / 5;
    for (int i = 0; i < points && !wrong; i++) {
        double point[3];
        choose_point(random, grid, of, point);
        wrong = list_is_wrong(grid, of, point);
        /* A cell that single precision may find. */
        float find[3] = {(float)point[0], (float)point[1], (float)point[2]};
        for (int k = 0; k < 3; k++)
            point[k] = find[k];
        if (!wrong)
            wrong = list_is_wrong(grid, of, point);
        double side = isfinite(grid->size) ? grid->size : 1;
        if (!wrong && i % 4 == 0)
            wrong = near_is_wrong(grid, of, point, side * random_between(random, 0, i % 10));
    }
    return wrong;
}

/* ---- Tests ---- */

static void all_kinds(void **state)
{
    Bench         *bench = *state;
    static Box     boxes[MAX_BOXES];
    const uint32_t counts[] = {1, 2, 5, 40, 700, MAX_BOXES};
    for (Kind kind = 0; kind < KINDS; kind++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
            for (int way = 0; way < 4; way++) {
                double scale = forms[kind].spread[0] + forms[kind].most + 1e-9;
                Case   of = {boxes, counts[c], way & 1 ? scale / 20 : 0, way & 2 ? scale / 30 : 0};
                Grid   grid;
                make_boxes(&bench->random, kind, boxes, of.count);
                grid_build(&grid, boxes, of.count, of.reach, of.margin, 1, &bench->arena,
                           &bench->arena);
                const char *wrong = grid_is_wrong(&grid, &of, &bench->random);
                if (wrong)
                    fail_msg("kind %d, %u boxes, reach %g, margin %g: %s", kind, of.count, of.reach,
                             of.margin, wrong);
            }
}

/* As shaders find cells: all in single precision. */
static bool single_precision_is_right(const Grid *grid, const Case *of, const float point[3])
{
    size_t cell = 0;
    for (int k = 2; k >= 0; k--) {
        float along = floorf((point[k] - (float)grid->low[k]) * (float)(1 / grid->size));
        if (!(along >= 0 && along < (float)grid->cells[k]))
            return true;
        cell = cell * grid->cells[k] + (size_t)along;
    }
    const double at[3] = {point[0], point[1], point[2]};
    uint32_t     next  = grid->first[cell];
    for (uint32_t i = 0; i < of->count; i++)
        if (next < grid->first[cell + 1] && grid->instances[next] == i)
            next++;
        else if (box_distance(&of->boxes[i], at) * (1 + 1e-14) < grid->clearance[cell] + of->reach)
            return false;
    return next == grid->first[cell + 1];
}

static void shaders_find_cells(void **state)
{
    Bench     *bench   = *state;
    const Kind kinds[] = {CUBE, TOWN, LINE, AXIS, FAR_AWAY, TINY, HUGE_ONES};
    static Box boxes[MAX_BOXES];
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        Case of = {boxes, MAX_BOXES, 0, 0};
        Grid grid;
        make_boxes(&bench->random, kinds[i], boxes, of.count);
        grid_build(&grid, boxes, of.count, 0, 0, 1, &bench->arena, &bench->arena);
        for (int k = 0; k < 3; k++)
            assert_true((float)grid.low[k] == grid.low[k]);
        for (int n = 0; n < POINTS; n++) {
            double point[3];
            choose_point(&bench->random, &grid, &of, point);
            float single[3] = {(float)point[0], (float)point[1], (float)point[2]};
            if (!single_precision_is_right(&grid, &of, single))
                fail_msg("kind %d: wrong at [%.9g, %.9g, %.9g]", kinds[i], single[0], single[1],
                         single[2]);
        }
    }
}

static void outside_is_the_distance_to_inner(void **state)
{
    Bench     *bench = *state;
    static Box boxes[500];
    Case       of = {boxes, 500, 0.3, 0.25};
    Grid       grid;
    make_boxes(&bench->random, CUBE, boxes, of.count);
    grid_build(&grid, boxes, of.count, of.reach, of.margin, 1, &bench->arena, &bench->arena);
    for (int k = 0; k < 3; k++) {
        Range  inner = ANYTHING;
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (uint32_t i = 0; i < of.count; i++) {
            low  = fmin(low, boxes[i].axis[k].low);
            high = fmax(high, boxes[i].axis[k].high);
        }
        inner = (Range){low - of.reach, high + of.reach};
        assert_true(grid.inner.axis[k].low == inner.low && grid.inner.axis[k].high == inner.high);
    }
    int outside = 0;
    for (int i = 0; i < POINTS; i++) {
        double   point[3], clearance;
        uint32_t count;
        bool     in = true;
        random_vector(&bench->random, 12, point);
        for (int k = 0; k < 3; k++)
            in = in && point[k] >= grid.low[k] &&
                 point[k] < grid.low[k] + grid.cells[k] * grid.size;
        if (in)
            continue;
        outside++;
        grid_find(&grid, point, &count, &clearance);
        assert_int_equal(count, 0);
        assert_true(fabs(clearance - box_distance(&grid.inner, point)) < 1e-12);
        assert_true(clearance >= of.margin);
    }
    assert_true(outside > POINTS / 10);
}

/* Clearances grow with the distance, so that rays cross empty space in long steps. */
static void empty_space_is_crossed_in_long_steps(void **state)
{
    Bench       *bench = *state;
    static Box   boxes[1000];
    const double half = 0.01;
    Grid         grid;
    for (uint32_t i = 0; i < 1000; i++) {
        const double center[3] = {i < 500 ? -10 : 10, (i / 25) % 20, i % 25};
        box_around(&boxes[i], center, half);
    }
    grid_build(&grid, boxes, 1000, 0, 0, 1, &bench->arena, &bench->arena);
    for (double x = -9; x < 9; x += 0.1) {
        const double point[3] = {x, 10, 12};
        double       nearest  = HUGE_VAL, clearance;
        uint32_t     count;
        for (uint32_t i = 0; i < 1000; i++)
            nearest = fmin(nearest, box_distance(&boxes[i], point));
        grid_find(&grid, point, &count, &clearance);
        if (clearance < nearest - 2.5 * sqrt(3) * grid.size)
            fail_msg("at x = %g the clearance is %g, and the distance %g", x, clearance, nearest);
    }
}

static void infinite_boxes_have_one_cell(void **state)
{
    Bench       *bench = *state;
    static Box   boxes[4];
    const double point[3] = {1e9, -3, 0};
    double       clearance;
    uint32_t     count;
    Grid         grid;
    make_boxes(&bench->random, CUBE, boxes, 4);
    boxes[1].axis[2].high = HUGE_VAL;
    boxes[2].axis[0]      = (Range){1, -1};
    grid_build(&grid, boxes, 4, 0, 0, 1, &bench->arena, &bench->arena);
    const uint32_t *list = grid_find(&grid, point, &count, &clearance);
    assert_int_equal(count, 3);
    assert_true(list[0] == 0 && list[1] == 1 && list[2] == 3);
    assert_true(clearance >= 0.9 * NOWHERE && grid.size == HUGE_VAL && grid.max_listed == 3);

    for (int i = 0; i < 4; i++)
        boxes[i].axis[1] = (Range){1, -1};
    grid_build(&grid, boxes, 4, 0, 0, 1, &bench->arena, &bench->arena);
    grid_find(&grid, point, &count, &clearance);
    assert_true(count == 0 && clearance >= 0.9 * NOWHERE);
}

/* A grid that is built for less than what the case says must be found out. */
static void the_checker_can_fail(void **state)
{
    Bench     *bench = *state;
    static Box boxes[700];
    Grid       grid;
    Case       of = {boxes, 700, 0.5, 0.4};
    make_boxes(&bench->random, CUBE, boxes, of.count);
    grid_build(&grid, boxes, of.count, of.reach, 0.01, 1, &bench->arena, &bench->arena);
    assert_non_null(grid_is_wrong(&grid, &of, &bench->random));
    grid_build(&grid, boxes, of.count, 0, of.margin, 1, &bench->arena, &bench->arena);
    assert_non_null(grid_is_wrong(&grid, &of, &bench->random));

    of.margin = 0;
    grid_build(&grid, boxes, of.count, of.reach, 0, 1, &bench->arena, &bench->arena);
    assert_null(grid_is_wrong(&grid, &of, &bench->random));
    for (size_t c = 0; c < (size_t)grid.cells[0] * grid.cells[1] * grid.cells[2]; c++)
        grid.clearance[c] *= 1.5f;
    assert_non_null(grid_is_wrong(&grid, &of, &bench->random));
}

/* Boxes that overlap have as many entries as are allowed: fewer where an entry is longer. */
static void long_entries_are_fewer(void **state)
{
    Bench         *bench   = *state;
    const uint32_t count   = 8000;
    double         allowed = 1 << 23;
    Box           *boxes   = arena_new_array(&bench->arena, Box, count);
    for (uint32_t i = 0; i < count; i++)
        box_around(&boxes[i], (double[3]){i % 20, i / 20 % 20, i / 400}, 3);
    for (uint32_t texels = 2; texels <= 16; texels += 7) {
        Arena scratch = {.memory = &bench->memory};
        Grid  grid;
        grid_build(&grid, boxes, count, 0, 0, texels, &scratch, &scratch);
        double entries = grid.first[(size_t)grid.cells[0] * grid.cells[1] * grid.cells[2]];
        arena_free(&scratch);
        if (entries * texels > allowed + 4096 * texels || entries * texels < allowed / 3)
            fail_msg("%g entries of %u texels", entries, texels);
    }
}

static bool grids_are_equal(const Grid *a, const Grid *b)
{
    size_t cells = (size_t)a->cells[0] * a->cells[1] * a->cells[2];
    return memcmp(a->cells, b->cells, sizeof a->cells) == 0 &&
           memcmp(a->first, b->first, (cells + 1) * sizeof *a->first) == 0 &&
           memcmp(a->clearance, b->clearance, cells * sizeof *a->clearance) == 0 &&
           memcmp(a->instances, b->instances, a->first[cells] * sizeof *a->instances) == 0;
}

/* One processor builds the same grid as all together. */
static void processors_share_the_work(void **state)
{
    Bench     *bench = *state;
    static Box boxes[MAX_BOXES];
    cpu_set_t  all;
    for (Kind kind = 0; kind < KINDS; kind++) {
        Grid alone, together;
        make_boxes(&bench->random, kind, boxes, MAX_BOXES);
        assert_int_equal(use_one_processor(&all), 0);
        grid_build(&alone, boxes, MAX_BOXES, 0.1, 0.2, 1, &bench->arena, &bench->arena);
        assert_int_equal(use_processors(&all), 0);
        grid_build(&together, boxes, MAX_BOXES, 0.1, 0.2, 1, &bench->arena, &bench->arena);
        assert_true(grids_are_equal(&alone, &together));
        together.clearance[0] *= 2;
        assert_false(grids_are_equal(&alone, &together));
    }
}

/* ---- Numbers to look at ---- */

/* Lists stay short, however many there are, unless boxes overlap. */
static void lists_of_many(void **state)
{
    Bench         *bench = *state;
    const uint32_t count = 100000;
    const struct {
        const char *name;
        Kind        kind;
        uint32_t    longest;
    } many[] = {
        {"cube", CUBE, 60},   {"touching", TOUCHING, 30},      {"town", TOWN, 60},
        {"line", LINE, 1500}, {"points of an axis", AXIS, 60}, {"one large", ONE_LARGE, 100}};
    Box *boxes = arena_new_array(&bench->arena, Box, count);
    for (size_t i = 0; i < sizeof many / sizeof *many; i++) {
        Arena scratch = {.memory = &bench->memory};
        Grid  grid;
        make_boxes(&bench->random, many[i].kind, boxes, count);
        grid_build(&grid, boxes, count, 0, 0, 1, &bench->arena, &scratch);
        arena_free(&scratch);
        size_t cells = (size_t)grid.cells[0] * grid.cells[1] * grid.cells[2];
        printf("# %s: %u x %u x %u cells, %.1f entries each, %u longest\n", many[i].name,
               grid.cells[0], grid.cells[1], grid.cells[2], (double)grid.first[cells] / count,
               grid.max_listed);
        assert_true(grid.max_listed <= many[i].longest);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_kinds, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(shaders_find_cells, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(outside_is_the_distance_to_inner, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(empty_space_is_crossed_in_long_steps, bench_start,
                                        bench_stop),
        cmocka_unit_test_setup_teardown(infinite_boxes_have_one_cell, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(the_checker_can_fail, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(long_entries_are_fewer, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(processors_share_the_work, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(lists_of_many, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("grids of instance groups", tests, NULL, NULL);
}
