/*
 * enhanced.c: methods of "Enhanced Sphere Tracing" (Keinert et al. 2014) that can be asked for.
 *
 * Hits that are evened out lie nearer to the surface, by distances in double precision, and what is
 * hit stays the same.  Paths that start by the distance at the hit bring the light that a slab of
 * glass lets through, in closed form.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

/* ---- hits that are evened out ---- */

static const char bumpy[] = "camera { eye: [0, 2.6, 4], target: [0, 0.1, 0], fov: 40deg }\n"
                            "show union(torus(1.3, 0.35), sphere(0.8), blend: 0.4)\n"
                            "    .displace(0.05 * sin(9 * x) * sin(9 * y) * sin(9 * z));\n"
                            "show box([5, 0.2, 5]).rotate([0, 0, 1], 5deg).move([0, -0.8, 0]);\n";

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

static KrsPicture *find_hits(const PathFixture *fixture, uint32_t iterations)
{
    const KrsRenderOptions options = {.width             = WIDTH,
                                      .height            = HEIGHT,
                                      .samples           = 1,
                                      .error             = 4,
                                      .aovs              = KRS_AOV_POSITION | KRS_AOV_DEPTH,
                                      .methods.even_hits = iterations};
    return path_fixture_render(fixture, &options);
}

static double distance_of_hit(const PathFixture *fixture, const KrsPicture *picture, size_t pixel)
{
    const float *at = &picture->position[3 * pixel];
    return fabs(product_distance(&fixture->product, (Vec){at[0], at[1], at[2]}));
}

/* Positions have rounding, and so have distances of the device. */
#define ROUNDED 3e-6

static void even_hits_are_nearer(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(bumpy);
    KrsPicture *usual = find_hits(&fixture, 0), *even = find_hits(&fixture, 3);
    double      sums[2] = {0};
    int         hits    = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        assert_int_equal(isfinite(usual->depth[i]), isfinite(even->depth[i]));
        if (!isfinite(usual->depth[i]))
            continue;
        double before = distance_of_hit(&fixture, usual, i),
               after  = distance_of_hit(&fixture, even, i);
        assert_true(after <= before + ROUNDED);
        sums[0] += before;
        sums[1] += after;
        hits++;
    }
    krs_picture_free(usual);
    krs_picture_free(even);
    path_fixture_close(&fixture);
    assert_in_range(hits, PIXELS / 10, PIXELS - 1);
    assert_true(sums[0] / hits > 2 * ROUNDED); /* else there is nothing to show */
    assert_true(sums[1] < 0.5 * sums[0]);
}

/* ---- paths that start by the distance ---- */

/* The camera looks up through a slab of glass at a sky of 1; the ground is black. */
static const char slab[] =
    "camera { eye: [0, -5, 0], up: [0, 0, 1], projection: \"orthographic\", height: 1 }\n"
    "sky { zenith: [1, 1, 1], horizon: [1, 1, 1], ground: black }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "material glass { color: [1, 1, 1], transmission: 1, roughness: 0, absorption: [0.7, 0.7, 0.7] "
    "}\n"
    "show box([60, 1, 60]).paint(glass);\n";

static void starts_bring_all_light(void **state)
{
    (void)state;
    const double mirrored = 0.04, kept = exp(-0.7);
    const double expected = (1 - mirrored) * (1 - mirrored) * kept /
                            (1 - mirrored * mirrored * kept * kept);
    PathFixture      fixture = path_fixture_open(slab);
    KrsRenderOptions options = {.width          = 64,
                                .height         = 64,
                                .samples        = 1,
                                .bounces        = 12,
                                .aovs           = KRS_AOV_COLOR,
                                .integrator     = KRS_INTEGRATOR_PATH,
                                .methods.starts = KRS_STARTS_DISTANCE};
    Estimate         found   = path_fixture_estimate(&fixture, options, everywhere, 6);
    path_fixture_close(&fixture);
    assert_true(must_be_near(found, expected, 0.002, "the slab"));
    assert_false(is_near(found, 1.1 * expected, 0.002));
}

/* A ball of white glass in an even sky cannot be seen, wherever its rays start. */
static void glass_loses_nothing(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(
        "camera { eye: [0, 0, 6], fov: 24deg }\n"
        "sky { zenith: [1, 1, 1], horizon: [1, 1, 1], ground: [1, 1, 1] }\n"
        "light none { direction: [0, 1, 0], color: black }\n"
        "material glass { color: [1, 1, 1], transmission: 1, roughness: 0 }\n"
        "show (sphere(1) & dodecahedron(1.15)).paint(glass);\n");
    KrsRenderOptions options = {.width          = 64,
                                .height         = 64,
                                .samples        = 4,
                                .bounces        = 200,
                                .aovs           = KRS_AOV_COLOR,
                                .integrator     = KRS_INTEGRATOR_PATH,
                                .methods.starts = KRS_STARTS_DISTANCE};
    Estimate         found   = path_fixture_estimate(&fixture, options, everywhere, 4);
    path_fixture_close(&fixture);
    assert_true(must_be_near(found, 1, 0.003, "white glass"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_hits_are_nearer),
        cmocka_unit_test(starts_bring_all_light),
        cmocka_unit_test(glass_loses_nothing),
    };
    return cmocka_run_group_tests_name("enhanced", tests, renderer_open, renderer_close);
}
