/*
 * mesh_sides.c: plates, islands and balls in tetrahedra, whose parts and holes are counted by simplices.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "mesh/contour/sides.h"

/* ---- what is solid ---- */

typedef double Solid(const double at[3]);

static double rod(const double at[3], double x, double y, double radius)
{
    return hypot(at[0] - x, at[1] - y) - radius;
}

static double ball(const double at[3], double x, double y, double z, double radius)
{
    return distance3(at, (double[3]){x, y, z}) - radius;
}

/* Its rim is at 0.7. */
static double plate(const double at[3])
{
    return max2(fabs(at[2] - 0.49) - 0.05, max2(at[0] - 0.7, fabs(at[1] - 0.49) - 0.4));
}

static double hole_at_rim(const double at[3])
{
    return max2(plate(at), -rod(at, 0.65, 0.5, 0.035));
}
static double hole_in_plate(const double at[3])
{
    return max2(plate(at), -rod(at, 0.4, 0.5, 0.045));
}
static double hole_off_rim(const double at[3])
{
    return max2(plate(at), -rod(at, 0.58, 0.5, 0.05));
}
static double wide_hole(const double at[3]) { return max2(plate(at), -rod(at, 0.5, 0.5, 0.12)); }
static double island(const double at[3])
{
    return min2(plate(at), ball(at, 0.78, 0.5, 0.49, 0.04));
}
static double large_island(const double at[3])
{
    return min2(plate(at), ball(at, 0.86, 0.5, 0.49, 0.1));
}
static double two_balls(const double at[3])
{
    return min2(ball(at, 0.3, 0.5, 0.5, 0.19), ball(at, 0.7, 0.5, 0.5, 0.18));
}

/* ---- by simplices ---- */

enum { MAX_SIMPLICES = 400000 };
typedef struct Simplex {
    uint32_t points[3];
} Simplex;

static Simplex simplices[MAX_SIMPLICES];

static int compare(const void *a, const void *b) { return memcmp(a, b, sizeof(Simplex)); }

static long count_different(size_t count)
{
    long different = 0;
    qsort(simplices, count, sizeof *simplices, compare);
    for (size_t i = 0; i < count; i++)
        different += i == 0 || compare(&simplices[i - 1], &simplices[i]) != 0;
    return different;
}

static int ascending(const void *a, const void *b)
{
    uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

/* Returns those of so many points that are inside, by all tetrahedra. */
static long count_simplices(const Tets *tets, int size)
{
    size_t count = 0;
    long   whole = 0;
    for (size_t i = 0; i < tets->list.count; i++)
        for (int chosen = 1; chosen < 16; chosen++) {
            Simplex simplex = {{0}};
            int     points = 0, inside = 0;
            for (int k = 0; k < 4; k++)
                if (chosen >> k & 1) {
                    uint32_t point = tets->list.items[i].points[k];
                    inside += point_is_inside(tets, point);
                    if (points < 3)
                        simplex.points[points] = point;
                    points++;
                }
            if (points != size || inside != size)
                continue;
            whole++;
            if (size == 4)
                continue;
            qsort(simplex.points, (size_t)size, sizeof *simplex.points, ascending);
            assert_true(count < MAX_SIMPLICES);
            simplices[count++] = simplex;
        }
    return size == 4 ? whole : count_different(count);
}

/* Parts less holes, and voids. */
static long euler_number(const Tets *tets)
{
    return count_simplices(tets, 1) - count_simplices(tets, 2) + count_simplices(tets, 3) -
           count_simplices(tets, 4);
}

static uint32_t leaders[100000];

static uint32_t leader_of(uint32_t point)
{
    while (leaders[point] != point)
        point = leaders[point] = leaders[leaders[point]];
    return point;
}

static long count_parts(const Tets *tets, bool inside)
{
    long parts = 0;
    assert_true(tets->points.count < sizeof leaders / sizeof *leaders);
    for (uint32_t i = 0; i < tets->points.count; i++) {
        leaders[i] = i;
        parts += point_is_inside(tets, i) == inside;
    }
    for (size_t i = 0; i < tets->list.count; i++)
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++) {
                uint32_t from = tets->list.items[i].points[a], to = tets->list.items[i].points[b];
                if (point_is_inside(tets, from) != inside || point_is_inside(tets, to) != inside)
                    continue;
                uint32_t first = leader_of(from), second = leader_of(to);
                parts -= first != second;
                leaders[first] = second;
            }
    return parts;
}

/* ---- tests ---- */

static void make_tets(Tets *tets, Solid *solid, Arena *arena)
{
    tets_new(tets, (double[3]){0, 0, 0}, 1, arena);
    for (bool any = true; any; tets_close(tets)) {
        any = false;
        for (size_t i = 0, count = tets->list.count; i < count; i++)
            if (tets_longest_edge(tets, &tets->list.items[i]) > 0.06) {
                tets_bisect(tets, i);
                any = true;
            }
    }
    tets_forget_fresh(tets);
    for (uint32_t i = 0; i < tets->points.count; i++) {
        double at[3];
        tets_position(tets, i, at);
        tets->points.items[i].distance = solid(at);
    }
}

/* Only points that are near and not deep have gone to the other side, and tetrahedra that have one are looked at again. */
static void check_moved(const Tets *tets, const double center[3], double radius, double deep)
{
    for (uint32_t i = 0; i < tets->points.count; i++) {
        double at[3];
        tets_position(tets, i, at);
        if (tets->points.items[i].moved)
            assert_true(distance3(at, center) <= radius &&
                        fabs(tets->points.items[i].distance) <= deep);
    }
    size_t fresh = 0;
    for (size_t i = 0; i < tets->list.count; i++) {
        fresh += tets->list.items[i].fresh;
        if (tets_is_moved(tets, &tets->list.items[i]))
            assert_true(tets->list.items[i].fresh && tets->list.items[i].state == TET_UNPROVEN);
    }
    assert_int_equal(tets->fresh.count, fresh);
    for (size_t i = 0; i < fresh; i++)
        assert_true(tets->list.items[tets->fresh.items[i]].fresh);
}

/* What is shallow at an edge loses its hole where tetrahedra are small, and an island goes.  Holes in what is as thin on all sides, what is deep and what
   would join parts stay. */
static void handles_at_edges_go(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        Solid      *solid;
        double      center[3], radius, deep;
        long        parts, euler; /* afterwards, of what was 1 and 0, or 2 and 2 */
        bool        goes;
    } cases[] = {
        {"a hole at a rim", hole_at_rim, {0.65, 0.5, 0.5}, 0.18, 0.06, 1, 1, true},
        {"one whose rim is deep", hole_off_rim, {0.58, 0.5, 0.5}, 0.18, 0.01, 1, 0, false},
        {"a hole in a plate", hole_in_plate, {0.4, 0.5, 0.5}, 0.18, 0.06, 1, 0, false},
        {"a wide hole", wide_hole, {0.5, 0.5, 0.5}, 0.18, 0.06, 1, 0, false},
        {"an island", island, {0.77, 0.5, 0.5}, 0.18, 0.06, 1, 1, true},
        {"an island in large tetrahedra", island, {0.78, 0.5, 0.49}, 0.1, 0.06, 1, 1, true},
        {"a hole in such", hole_at_rim, {0.65, 0.5, 0.5}, 0.1, 0.06, 1, 0, false},
        {"a large one", large_island, {0.8, 0.5, 0.5}, 0.18, 0.06, 2, 2, false},
        {"two balls", two_balls, {0.5, 0.5, 0.5}, 0.18, 0.06, 2, 2, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Memory  memory  = {0};
        Arena   arena   = {.memory = &memory};
        Tets    tets    = {0};
        Contour contour = {.arena = &arena, .tets = &tets};
        make_tets(&tets, cases[i].solid, &arena);
        memset(&tets.fresh, 0, sizeof tets.fresh); /* it has to grow */
        long parts = count_parts(&tets, true), euler = euler_number(&tets);
        if (count_parts(&tets, false) != 1 || (parts == 1 && euler != 0) || parts > 2)
            fail_msg("%s: %ld parts, Euler number %ld to begin with", cases[i].name, parts, euler);
        bool goes = sides_tidy(&contour, cases[i].center, cases[i].radius, cases[i].deep);
        check_moved(&tets, cases[i].center, cases[i].radius, cases[i].deep);
        parts = count_parts(&tets, true);
        euler = euler_number(&tets);
        if (goes != cases[i].goes || parts != cases[i].parts || euler != cases[i].euler ||
            count_parts(&tets, false) != 1)
            fail_msg("%s: %d, %ld parts, Euler number %ld", cases[i].name, goes, parts, euler);
        arena_free(&arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(handles_at_edges_go)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
