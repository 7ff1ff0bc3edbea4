/* mesh_collapse.c: edges are collapsed as far as rules permit, and the mesh stays closed and keeps its handles. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "mesh/common/crossing.h"
#include "mesh/simplify/blocks.h"
#include "mesh/simplify/fans.h"
#include "tests/support/random.h"
#include "tests/support/triangles.h"

enum { AROUND = 24, COUNT = AROUND * AROUND, TRIANGLES = 2 * COUNT };

/* A torus. */
typedef struct Ring {
    Memory   memory;
    Arena    arena;
    double   vertices[COUNT][3];
    uint32_t triangles[TRIANGLES][3], whole[TRIANGLES][3];
    bool     kept[TRIANGLES];
    size_t   asked, most; /* triangles are good until so many were asked for */
    Random   random;
    double   chance; /* that one is good */
    uint32_t below[COUNT];
    double   off[TRIANGLES], missed[TRIANGLES];
    double   error;
    double   apart; /* before anything is left out; above the error: each triangle is asked for */
} Ring;

static uint32_t at(int u, int v) { return (uint32_t)(u % AROUND * AROUND + v % AROUND); }

static Ring *ring_new(void)
{
    Ring *ring = calloc(1, sizeof *ring);
    assert_non_null(ring);
    ring->arena.memory = &ring->memory;
    ring->most         = SIZE_MAX;
    ring->chance       = 1;
    ring->error        = 1e9;
    ring->apart        = 1e10;
    memset(ring->below, 0xff, sizeof ring->below);
    for (int u = 0; u < AROUND; u++)
        for (int v = 0; v < AROUND; v++) {
            double a = u * 6.283185307179586 / AROUND, b = v * 6.283185307179586 / AROUND,
                   reach                = 1 + 0.4 * cos(b);
            ring->vertices[at(u, v)][0] = reach * cos(a);
            ring->vertices[at(u, v)][1] = reach * sin(a);
            ring->vertices[at(u, v)][2] = 0.4 * sin(b);
            uint32_t corners[2][3]      = {{at(u, v), at(u + 1, v), at(u + 1, v + 1)},
                                           {at(u, v), at(u + 1, v + 1), at(u, v + 1)}};
            memcpy(ring->triangles[2 * at(u, v)], corners, sizeof corners);
        }
    memcpy(ring->whole, ring->triangles, sizeof ring->whole);
    return ring;
}

static void ring_free(Ring *ring)
{
    arena_free(&ring->arena);
    free(ring);
}

static bool may_be(void *user, const uint32_t triangle[3], double *distance)
{
    Ring *ring = user;
    *distance  = ring->error;
    assert_true(triangle[0] != triangle[1] && triangle[1] != triangle[2] &&
                triangle[2] != triangle[0]);
    return ring->asked++ < ring->most && random_between(&ring->random, 0, 1) < ring->chance;
}

static bool goes_on(void *user, double part)
{
    (void)user;
    return part <= 1;
}

static size_t collapse(Ring *ring)
{
    CollapseRules rules = {.kept      = ring->kept,
                           .below     = ring->below,
                           .error     = ring->error,
                           .off       = ring->off,
                           .missed    = ring->missed,
                           .is_good   = may_be,
                           .is_wanted = goes_on,
                           .user      = ring};
    for (size_t i = 0; i < TRIANGLES; i++)
        ring->off[i] = ring->missed[i] = ring->apart;
    size_t left      = collapse_edges((const double(*)[3])ring->vertices, COUNT, ring->triangles,
                                      TRIANGLES, &rules, &ring->arena),
           used      = 0;
    bool uses[COUNT] = {false};
    assert_int_equal(count_open_sides((const uint32_t(*)[3])ring->triangles, left), 0);
    for (size_t i = 0; i < 3 * left; i++)
        uses[ring->triangles[i / 3][i % 3]] = true;
    for (size_t i = 0; i < COUNT; i++)
        used += uses[i];
    assert_int_equal(2 * used, left); /* the Euler number is 0 */
    return left;
}

static void few_are_left(void **state)
{
    (void)state;
    Ring *ring = ring_new();
    assert_true(collapse(ring) < TRIANGLES / 10);
    ring_free(ring);
}

static void nothing_changes_that_may_not(void **state)
{
    (void)state;
    Ring *ring = ring_new();
    ring->most = 0;
    assert_int_equal(collapse(ring), TRIANGLES);
    assert_memory_equal(ring->triangles, ring->whole, sizeof ring->whole);
    assert_true(ring->asked > COUNT);
    ring_free(ring);
}

/* Half of the ring: its vertices are all there. */
static void what_is_kept_stays(void **state)
{
    (void)state;
    Ring *ring        = ring_new();
    bool  used[COUNT] = {false};
    for (size_t i = 0; i < TRIANGLES / 2; i++)
        ring->kept[i] = true;
    size_t left = collapse(ring);
    assert_true(left > TRIANGLES / 2 && left < 3 * TRIANGLES / 4);
    for (size_t i = 0; i < 3 * left; i++)
        used[ring->triangles[i / 3][i % 3]] = true;
    for (size_t i = 0; i < 3 * (TRIANGLES / 2); i++)
        assert_true(used[ring->whole[i / 3][i % 3]]);
    ring_free(ring);
}

/* All vertices are within the error of the triangles that are left, by the nearest of all. */
static void vertices_are_near(void **state)
{
    (void)state;
    size_t last = 0;
    for (double error = 0.3; error > 0.005; error /= 3) {
        Ring *ring  = ring_new();
        ring->error = error;
        ring->apart = 10 * error;
        size_t left = collapse(ring);
        for (size_t i = 0; i < COUNT; i++) {
            double least = INFINITY;
            for (size_t k = 0; k < left; k++) {
                double corners[3][3];
                for (int c = 0; c < 3; c++)
                    memcpy(corners[c], ring->vertices[ring->triangles[k][c]], sizeof corners[c]);
                least = fmin(least,
                             distance_to_triangle((const double(*)[3])corners, ring->vertices[i]));
            }
            assert_true(least <= error * (1 + 1e-9));
        }
        assert_true(left > last && left < TRIANGLES);
        last = left;
        ring_free(ring);
    }
}

/* How far points of some triangles are from others, at most. */
static double max_apart(const double (*vertices)[3], const uint32_t (*from)[3], size_t from_count,
                        const uint32_t (*to)[3], size_t to_count)
{
    enum { STEPS = 12 };
    double most = 0;
    for (size_t i = 0; i < from_count; i++)
        for (int a = 0; a <= STEPS; a++)
            for (int b = 0; a + b <= STEPS; b++) {
                double point[3], least = INFINITY;
                for (int k = 0; k < 3; k++)
                    point[k] = (a * vertices[from[i][0]][k] + b * vertices[from[i][1]][k] +
                                (STEPS - a - b) * vertices[from[i][2]][k]) /
                               STEPS;
                for (size_t n = 0; n < to_count; n++) {
                    double corners[3][3];
                    for (int c = 0; c < 3; c++)
                        memcpy(corners[c], vertices[to[n][c]], sizeof corners[c]);
                    least = fmin(least, distance_to_triangle((const double(*)[3])corners, point));
                }
                most = fmax(most, least);
            }
    return most;
}

/* A vertex in the middle of a polygon, not all in a plane, which goes to one of its corners. */
static void distances_of_fans_are_enough(void **state)
{
    enum { MOST = 9, FANS = 300 };
    (void)state;
    Random random = {7};
    size_t known  = 0;
    for (int turn = 0; turn < FANS; turn++) {
        double   vertices[MOST + 1][3], turned = random_between(&random, 0, 6), high = 0.15;
        uint32_t old[MOST][3], new[MOST][3], star[MOST];
        size_t   count = 4 + (size_t)random_between(&random, 0, 5.99), left = 0;
        for (uint32_t i = 0; i < count; i++) {
            double angle = 6.283185307179586 * i / (double)count,
                   reach = random_between(&random, 0.7, 1.3);
            double x = reach * cos(angle), y = reach * sin(angle),
                   z        = random_between(&random, -high, high);
            double place[3] = {x * cos(turned) - z * sin(turned), y,
                               x * sin(turned) + z * cos(turned)};
            memcpy(vertices[i], place, sizeof place);
            uint32_t corners[3] = {(uint32_t)count, i, (uint32_t)((i + 1) % count)};
            memcpy(old[i], corners, sizeof corners);
            star[i] = i;
            if (i == 0 || i + 1 == count)
                continue;
            corners[0] = 0;
            memcpy(new[left++], corners, sizeof corners);
        }
        random_vector(&random, 0.2, vertices[count]);
        double found = fan_distance((const double(*)[3])vertices, (const uint32_t(*)[3])old, star,
                                    count, (uint32_t)count, 0);
        if (isinf(found))
            continue;
        double least = fmax(max_apart((const double(*)[3])vertices, (const uint32_t(*)[3])old,
                                      count, (const uint32_t(*)[3]) new, left),
                            max_apart((const double(*)[3])vertices, (const uint32_t(*)[3]) new,
                                      left, (const uint32_t(*)[3])old, count));
        known++;
        if (found < least || found > 2 * least + 0.01)
            fail_msg("fan %d: points are %g apart, and %g was found", turn, least, found);
    }
    assert_true(known > FANS / 3);
}

/* Nothing is permitted by asking: what is left out is near by the sum of all moves. */
static void small_moves_need_no_questions(void **state)
{
    (void)state;
    for (double error = 0.1; error > 0.03; error /= 2) {
        Ring *ring                 = ring_new();
        ring->most                 = 0;
        ring->error                = error;
        ring->apart                = 0;
        size_t left                = collapse(ring);
        const double(*vertices)[3] = (const double(*)[3])ring->vertices;
        const uint32_t(*now)[3]    = (const uint32_t(*)[3])ring->triangles,
              (*before)[3]         = (const uint32_t(*)[3])ring->whole;
        assert_true(left < TRIANGLES * 2 / 3);
        assert_true(max_apart(vertices, now, left, before, TRIANGLES) <= error);
        assert_true(max_apart(vertices, before, TRIANGLES, now, left) <= error);
        print_message("# %zu of %d triangles within %g\n", left, TRIANGLES, error);
        ring_free(ring);
    }
}

static void rules_by_chance_leave_it_closed(void **state)
{
    (void)state;
    for (uint64_t turn = 0; turn < 60; turn++) {
        Ring *ring   = ring_new();
        ring->random = (Random){turn};
        ring->chance = 0.3 + 0.01 * (double)turn;
        for (size_t i = 0; i < COUNT; i++)
            for (int k = 0; k < 3; k++)
                ring->vertices[i][k] += random_between(&ring->random, -0.05, 0.05);
        assert_true(collapse(ring) <= TRIANGLES);
        ring_free(ring);
    }
}

/* A torus of several blocks, its triangles along rings of 200. */
enum { LONG = 200, MANY = LONG * LONG };
typedef struct Large {
    double   vertices[MANY][3], off[2 * MANY], missed[2 * MANY];
    uint32_t triangles[2 * MANY][3], order[2 * MANY], left[2 * MANY][3], below[MANY];
} Large;

static Large *large_new(void)
{
    Large *large = calloc(1, sizeof *large);
    assert_non_null(large);
    for (uint32_t i = 0; i < MANY; i++) {
        uint32_t u = i / LONG, v = i % LONG, next = (u + 1) % LONG, across = (v + 1) % LONG;
        double   a = u * 6.283185307179586 / LONG, b = v * 6.283185307179586 / LONG,
               reach           = 1 + 0.4 * cos(b);
        double   place[3]      = {reach * cos(a), reach * sin(a), 0.4 * sin(b)};
        uint32_t corners[2][3] = {{i, next * LONG + v, next * LONG + across},
                                  {i, next * LONG + across, u * LONG + across}};
        memcpy(large->vertices[i], place, sizeof place);
        memcpy(large->triangles[2 * (size_t)i], corners, sizeof corners);
        large->order[2 * i]     = 2 * i;
        large->order[2 * i + 1] = 2 * i + 1;
    }
    return large;
}

/* What blocks leave is closed, has the handle, and is near: a vertex that went to the triangle that it is said to. */
static void blocks_meet_at_their_borders(void **state)
{
    const double  error  = 0.01;
    Memory        memory = {0};
    Arena         arena  = {.memory = &memory};
    Large        *large  = large_new();
    CollapseRules rules  = {.below     = large->below,
                            .error     = error,
                            .off       = large->off,
                            .missed    = large->missed,
                            .is_wanted = goes_on};
    const double(*at)[3] = (const double(*)[3])large->vertices;
    bool  *uses          = calloc(MANY, sizeof *uses);
    size_t used = 0, gone = 0;
    (void)state;
    size_t left = collapse_blocks(at, MANY, (const uint32_t(*)[3])large->triangles, 2 * MANY,
                                  large->order, &rules, large->left, &arena);
    assert_true(left > 100 && left < 2 * MANY / 3);
    assert_int_equal(count_open_sides((const uint32_t(*)[3])large->left, left), 0);
    for (size_t i = 0; i < 3 * left; i++)
        uses[large->left[i / 3][i % 3]] = true;
    for (uint32_t i = 0; i < MANY; i++) {
        used += uses[i];
        assert_int_equal(large->below[i] == UINT32_MAX, uses[i]);
        if (uses[i])
            continue;
        double corners[3][3];
        gone++;
        assert_true(large->below[i] < left);
        for (int c = 0; c < 3; c++)
            memcpy(corners[c], at[large->left[large->below[i]][c]], sizeof corners[c]);
        assert_true(distance_to_triangle((const double(*)[3])corners, at[i]) <= error * (1 + 1e-9));
    }
    for (size_t i = 0; i < left; i++)
        assert_true(large->off[i] <= error && large->missed[i] <= error);
    assert_int_equal(2 * used, left); /* the Euler number is 0 */
    print_message("# %zu of %d triangles, %zu vertices gone\n", left, 2 * MANY, gone);
    arena_free(&arena);
    free(uses);
    free(large);
}

/* Two tetrahedra, with a corner in common and apart. */
static void sheets_that_meet_in_a_vertex_are_told(void **state)
{
    static const uint32_t met[8][3]   = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                                         {0, 5, 4}, {0, 4, 6}, {0, 6, 5}, {4, 5, 6}},
                          apart[8][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                                         {7, 5, 4}, {7, 4, 6}, {7, 6, 5}, {4, 5, 6}};
    Memory memory                     = {0};
    Arena  arena                      = {.memory = &memory};
    (void)state;
    TriangleEdges met_edges   = sort_edges(met, 8, &arena),
                  apart_edges = sort_edges(apart, 8, &arena);
    for (uint32_t i = 0; i < 7; i++)
        assert_int_equal(is_one_ring(&met_edges, met, i), i != 0);
    for (uint32_t i = 0; i < 8; i++)
        assert_true(is_one_ring(&apart_edges, apart, i));
    arena_free(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_are_left),
        cmocka_unit_test(nothing_changes_that_may_not),
        cmocka_unit_test(what_is_kept_stays),
        cmocka_unit_test(vertices_are_near),
        cmocka_unit_test(distances_of_fans_are_enough),
        cmocka_unit_test(small_moves_need_no_questions),
        cmocka_unit_test(rules_by_chance_leave_it_closed),
        cmocka_unit_test(blocks_meet_at_their_borders),
        cmocka_unit_test(sheets_that_meet_in_a_vertex_are_told),
    };
    return cmocka_run_group_tests_name("collapsed edges", tests, NULL, NULL);
}
