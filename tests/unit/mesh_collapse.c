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
#include "compiler/mesh/collapse.h"
#include "compiler/mesh/crossing.h"
#include "tests/support/random.h"

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
    double   error;
} Ring;

static uint32_t at(int u, int v) { return (uint32_t)(u % AROUND * AROUND + v % AROUND); }

static Ring *ring_new(void)
{
    Ring *ring = calloc(1, sizeof *ring);
    assert_non_null(ring);
    ring->arena.memory = &ring->memory;
    ring->most         = SIZE_MAX;
    ring->chance       = 1;
    ring->error        = INFINITY;
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

static bool may_be(void *user, const uint32_t triangle[3])
{
    Ring *ring = user;
    assert_true(triangle[0] != triangle[1] && triangle[1] != triangle[2] &&
                triangle[2] != triangle[0]);
    return ring->asked++ < ring->most && random_between(&ring->random, 0, 1) < ring->chance;
}

static void count_report(void *user, uint32_t triangle)
{
    (void)triangle;
    (*(size_t *)user)++;
}

static size_t collapse(Ring *ring)
{
    CollapseRules rules = {ring->kept, ring->below, ring->error, may_be, ring};
    size_t        left  = collapse_edges((const double(*)[3])ring->vertices, COUNT, ring->triangles,
                                         TRIANGLES, &rules, &ring->arena),
           open = 0, used = 0;
    TriangleEdges edges = sort_edges((const uint32_t(*)[3])ring->triangles, left, &ring->arena);
    report_open(&edges, count_report, &open);
    assert_int_equal(open, 0);
    for (size_t i = 0; i < edges.vertex_count; i++)
        used += edges.begins[i + 1] > edges.begins[i];
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
        size_t left = collapse(ring);
        for (size_t i = 0; i < COUNT; i++) {
            double least = INFINITY;
            for (size_t k = 0; k < left; k++) {
                double corners[3][3], nearest[3];
                for (int c = 0; c < 3; c++)
                    memcpy(corners[c], ring->vertices[ring->triangles[k][c]], sizeof corners[c]);
                triangle_nearest((const double(*)[3])corners, ring->vertices[i], nearest);
                least = fmin(least, distance3(nearest, ring->vertices[i]));
            }
            assert_true(least <= error * (1 + 1e-9));
        }
        assert_true(left > last && left < TRIANGLES);
        last = left;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_are_left),
        cmocka_unit_test(nothing_changes_that_may_not),
        cmocka_unit_test(what_is_kept_stays),
        cmocka_unit_test(vertices_are_near),
        cmocka_unit_test(rules_by_chance_leave_it_closed),
    };
    return cmocka_run_group_tests_name("collapsed edges", tests, NULL, NULL);
}
