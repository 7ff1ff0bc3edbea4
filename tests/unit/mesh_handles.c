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

/* Makes a torus; `flat`: its tube is so much thinner along the axis. */
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

/* ---- what ends ---- */

enum { RINGS = 120 };

typedef struct Spindle {
    Memory   memory;
    Arena    arena;
    Contour  contour;
    double   vertices[RINGS * ACROSS + 2][3];
    uint32_t triangles[2 * RINGS * ACROSS][3];
} Spindle;

typedef double Profile(double z);

/* It goes around the axis from -1.2 to 3.2; its ends are closed by fans. */
static void make_spindle(Spindle *spindle, Profile *profile)
{
    const double tau = 2 * acos(-1), low = -1.2, high = 3.2;
    size_t       triangles = 0;
    memset(spindle, 0, sizeof *spindle);
    spindle->arena.memory = &spindle->memory;
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < ACROSS; k++) {
            double z = low + (high - low) * (i + 0.5) / RINGS, r = profile(z);
            memcpy(spindle->vertices[i * ACROSS + k],
                   (double[3]){r * cos(tau * k / ACROSS), r * sin(tau * k / ACROSS), z},
                   sizeof spindle->vertices[0]);
        }
    spindle->vertices[RINGS * ACROSS][2]     = low;
    spindle->vertices[RINGS * ACROSS + 1][2] = high;
    for (int k = 0; k < ACROSS; k++) {
        uint32_t next = (uint32_t)((k + 1) % ACROSS), last = (RINGS - 1) * ACROSS;
        memcpy(spindle->triangles[triangles++], (uint32_t[3]){RINGS * ACROSS, next, (uint32_t)k},
               sizeof spindle->triangles[0]);
        memcpy(spindle->triangles[triangles++],
               (uint32_t[3]){RINGS * ACROSS + 1, last + (uint32_t)k, last + next},
               sizeof spindle->triangles[0]);
        for (uint32_t i = 0; i + 1 < RINGS; i++) {
            uint32_t a = i * ACROSS + (uint32_t)k, b = i * ACROSS + next;
            memcpy(spindle->triangles[triangles++], (uint32_t[3]){a, b, b + ACROSS},
                   sizeof spindle->triangles[0]);
            memcpy(spindle->triangles[triangles++], (uint32_t[3]){a, b + ACROSS, a + ACROSS},
                   sizeof spindle->triangles[0]);
        }
    }
    spindle->contour.arena           = &spindle->arena;
    spindle->contour.vertices.items  = spindle->vertices;
    spindle->contour.vertices.count  = RINGS * ACROSS + 2;
    spindle->contour.triangles.items = spindle->triangles;
    spindle->contour.triangles.count = triangles;
}

static double ball_with_needle(double z)
{
    return fmax(sqrt(fmax(0, 1.21 - z * z)), 0.1 * (3.2 - z) / 2.2 * (z > 0));
}
static double two_balls(double z)
{
    return fmax(0.08,
                fmax(sqrt(fmax(0, 1.21 - z * z)), sqrt(fmax(0, 0.36 - (z - 2.4) * (z - 2.4)))));
}

/* A needle ends, so nothing is lost with it; what joins two balls does not. */
static void rods_that_end_are_none(void **state)
{
    (void)state;
    static Spindle spindle;
    double         place[3], places[4][3];
    make_spindle(&spindle, ball_with_needle);
    assert_int_equal(handles_count(&spindle.contour, 0.4, place), 0);
    assert_int_equal(handles_find(&spindle.contour, 0.4, places, 4), 0);
    arena_free(&spindle.arena);
    make_spindle(&spindle, two_balls);
    assert_true(handles_count(&spindle.contour, 0.4, place) > 0);
    assert_true(place[2] > 0.6 && place[2] < 2.4);
    assert_int_equal(handles_find(&spindle.contour, 0.4, places, 4), 0);
    arena_free(&spindle.arena);
}

/* Around a hole, not around a tube; and what is small as a whole. */
static void places_have_a_handle_or_are_all(void **state)
{
    (void)state;
    static Ring    ring;
    static Spindle spindle;
    double         places[4][3];
    make_ring(&ring, 3, 0.5, 1);
    assert_int_equal(handles_find(&ring.contour, 2, places, 4), 0);
    assert_true(handles_find(&ring.contour, 8, places, 4) > 0);
    arena_free(&ring.arena);
    make_ring(&ring, 1, 0.8, 1);
    assert_int_equal(handles_find(&ring.contour, 0.5, places, 4), 0);
    assert_true(handles_find(&ring.contour, 1.9, places, 4) > 0);
    arena_free(&ring.arena);
    make_spindle(&spindle, two_balls);
    assert_int_equal(handles_find(&spindle.contour, 2, places, 4), 0);
    assert_true(handles_find(&spindle.contour, 5, places, 4) > 0);
    assert_true(handles_count(&spindle.contour, 5, places[0]) > 0);
    arena_free(&spindle.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_goes_around_is_found),
        cmocka_unit_test(rods_that_end_are_none),
        cmocka_unit_test(places_have_a_handle_or_are_all),
    };
    return cmocka_run_group_tests_name("handles of meshes", tests, NULL, NULL);
}
