/*
 * mesh_handles.c: rings and balls, on which what is near to a vertex is a disc, or goes around.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/contour/handles.h"

enum { AROUND = 60, ACROSS = 24 };

typedef struct Ring {
    Memory   memory;
    Arena    arena;
    Contour  contour;
    double   vertices[AROUND * ACROSS][3];
    uint32_t triangles[2 * AROUND * ACROSS][3];
} Ring;

static uint32_t at(int i, int k)
{
    return (uint32_t)((i + AROUND) % AROUND * ACROSS + (k + ACROSS) % ACROSS);
}

/* A torus; `flat`: its tube is so much thinner along the axis. */
static void make_ring(Ring *ring, double major, double minor, double flat)
{
    const double tau = 2 * acos(-1);
    memset(ring, 0, sizeof *ring);
    ring->arena.memory = &ring->memory;
    for (int i = 0; i < AROUND; i++)
        for (int k = 0; k < ACROSS; k++) {
            double  turn = tau * i / AROUND, tilt = tau * k / ACROSS;
            double  away           = major + minor * cos(tilt);
            double *vertex         = ring->vertices[at(i, k)];
            uint32_t(*triangle)[3] = &ring->triangles[2 * at(i, k)];
            vertex[0]              = away * cos(turn);
            vertex[1]              = away * sin(turn);
            vertex[2]              = flat * minor * sin(tilt);
            memcpy(triangle[0], (uint32_t[3]){at(i, k), at(i + 1, k), at(i + 1, k + 1)},
                   sizeof triangle[0]);
            memcpy(triangle[1], (uint32_t[3]){at(i, k), at(i + 1, k + 1), at(i, k + 1)},
                   sizeof triangle[1]);
        }
    ring->contour.arena           = &ring->arena;
    ring->contour.vertices.items  = ring->vertices;
    ring->contour.vertices.count  = AROUND * ACROSS;
    ring->contour.triangles.items = ring->triangles;
    ring->contour.triangles.count = 2 * AROUND * ACROSS;
}

/* Around the tube, or through the hole.  A flat tube is as wide as it is, however thin. */
static void what_goes_around_is_found(void **state)
{
    (void)state;
    static const struct {
        double major, minor, flat, radius;
        bool   found;
    } cases[] = {
        {3, 0.5, 1, 0.6, false},  {3, 0.5, 1, 0.95, false},  {3, 0.5, 1, 1.2, true},
        {3, 0.5, 1, 2, true},     {1, 0.8, 1, 0.3, false},   {1, 0.8, 1, 0.5, true},
        {3, 1, 0.05, 0.5, false}, {3, 1, 0.05, 0.95, false}, {3, 1, 0.05, 1.6, true},
    };
    static Ring ring;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double place[3];
        make_ring(&ring, cases[i].major, cases[i].minor, cases[i].flat);
        size_t found = handles_count(&ring.contour, cases[i].radius, place);
        if ((found > 0) != cases[i].found)
            fail_msg("case %zu: %zu places", i, found);
        if (found > 0)
            assert_true(fabs(hypot(place[0], place[1]) - cases[i].major) <= cases[i].minor + 1e-9);
        arena_free(&ring.arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_goes_around_is_found),
    };
    return cmocka_run_group_tests_name("handles of meshes", tests, NULL, NULL);
}
