/*
 * direct_glass.c: direct light and glass, held against closed forms: what is seen through it, and what
 * light comes through it to a floor.
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

/* A slab from y = 1 to 1 + thick lies over a white dull floor, whose sky is black but for `day`.  One
   camera looks down at the floor from below the slab, the other from above it. */
static const char scene[] =
    "param loss = 0 in [0, 9]; param index = 1.5 in [1, 4]; param tint = 1 in [0, 1];\n"
    "param thick = 0.5 in [0.1, 1]; param day = 0 in [0, 1]; param sunny = 0 in [0, 9];\n"
    "param lit = 0 in [0, 99]; param wide = 0 in [0, 1]; param glow = 0 in [0, 1]; param shade = 1 "
    "in [0, 1];\n"
    "camera { eye: [0, 0.9, 0], target: [0, 0, 0], up: [0, 0, 1],\n"
    "         projection: \"orthographic\", height: 0.1 }\n"
    "camera above { eye: [0, 5, 0], target: [0, 0, 0], up: [0, 0, 1],\n"
    "               projection: \"orthographic\", height: 0.1 }\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light sun { direction: [0.6, 0.8, 0], intensity: sunny }\n"
    "light lamp { position: [0, 4, 0], intensity: lit, softness: wide }\n"
    "material glass { color: [tint, tint, tint], transmission: 1, roughness: 0, ior: index,\n"
    "                 absorption: [loss, loss, loss] }\n"
    "material chalk { color: [shade, shade, shade], specular: 0, emission: [glow, glow, glow] }\n"
    "show box([60, thick, 60]).move([0, 1 + thick / 2, 0]).paint(glass);\n"
    "show box([60, 1, 60]).move([0, -0.5, 0]).paint(chalk);\n";

static const KrsRenderOptions direct = {.width      = 24,
                                        .height     = 24,
                                        .samples    = 4,
                                        .aovs       = KRS_AOV_COLOR,
                                        .integrator = KRS_INTEGRATOR_DIRECT};

static PathFixture fixture;

static int open_slab(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(scene);
    return 0;
}

static int close_slab(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

typedef struct Slab {
    double index, loss, tint, thick;
} Slab;

static const Slab slabs[] = {{1.5, 0, 1, 0.5}, {1.5, 1.2, 1, 0.5}, {2.2, 0.4, 0.7, 0.9}};
enum { SLABS = sizeof slabs / sizeof *slabs };

static void set_slab(const Slab *slab)
{
    path_fixture_set(&fixture, "index", slab->index);
    path_fixture_set(&fixture, "loss", slab->loss);
    path_fixture_set(&fixture, "tint", slab->tint);
    path_fixture_set(&fixture, "thick", slab->thick);
}

/* Returns what is left of light that goes straight through: each boundary mirrors some, and the
   colour counts once. */
static double left_of(const Slab *slab, double cosine)
{
    const double mirrored = pow((slab->index - 1) / (slab->index + 1), 2);
    return slab->tint * pow(1 - mirrored, 2) * exp(-slab->loss * slab->thick / cosine);
}

#define SUN_COSINE 0.8 /* with its normal */

/* Returns the light of the floor in a sun of 3 through the slab. */
static double sunlit(const Slab *slab) { return 3 * SUN_COSINE / M_PI * left_of(slab, SUN_COSINE); }

/* Returns the same of all ways from boundary to boundary, and of a colour that counts at each that
   is gone through. */
static double seen_through(const Slab *slab)
{
    const double mirrored = pow((slab->index - 1) / (slab->index + 1), 2);
    const double kept = exp(-slab->loss * slab->thick), inner = mirrored * kept;
    return pow(slab->tint * (1 - mirrored), 2) * kept / (1 - inner * inner);
}

/* A sun, a point, and a lamp that is as a point: it is symmetric about the floor's middle. */
static void light_comes_through_glass(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (size_t i = 0; i < SLABS; i++) {
        set_slab(&slabs[i]);
        path_fixture_set(&fixture, "sunny", 3);
        wrong += !must_be_near(path_fixture_estimate(&fixture, direct, everywhere, 4),
                               sunlit(&slabs[i]), 0.002, "a sun");
        path_fixture_set(&fixture, "sunny", 0);
        path_fixture_set(&fixture, "lit", 50);
        for (int k = 0; k < 2; k++) {
            path_fixture_set(&fixture, "wide", 0.05 * k);
            wrong += !must_be_near(path_fixture_estimate(&fixture, direct, everywhere, 4),
                                   50 / (16 * M_PI) * left_of(&slabs[i], 1), 0.004,
                                   k == 0 ? "a point" : "a lamp");
        }
        path_fixture_set(&fixture, "lit", 0);
    }
    assert_int_equal(wrong, 0);
}

/* What shines behind glass, and what is lit there. */
static void glass_shows_what_is_behind(void **state)
{
    (void)state;
    KrsRenderOptions from_above = direct;
    size_t           wrong      = 0;
    from_above.camera           = 1;
    from_above.samples          = 64;
    for (size_t i = 0; i < SLABS; i++) {
        set_slab(&slabs[i]);
        path_fixture_set(&fixture, "glow", 1);
        path_fixture_set(&fixture, "shade", 0);
        wrong += !must_be_near(path_fixture_estimate(&fixture, from_above, everywhere, 4),
                               seen_through(&slabs[i]), 0.002, "what shines");
        path_fixture_set(&fixture, "glow", 0);
        path_fixture_set(&fixture, "shade", 1);
        path_fixture_set(&fixture, "sunny", 3);
        wrong += !must_be_near(path_fixture_estimate(&fixture, from_above, everywhere, 4),
                               sunlit(&slabs[i]) * seen_through(&slabs[i]), 0.002, "what is lit");
        path_fixture_set(&fixture, "sunny", 0);
    }
    assert_int_equal(wrong, 0);
}

/* Returns what a boundary mirrors of light at this angle. */
static double fresnel(double angle, double index)
{
    const double beyond = asin(sin(angle) / index), in = cos(angle), out = cos(beyond);
    return 0.5 * (pow((in - index * out) / (in + index * out), 2) +
                  pow((index * in - out) / (index * in + out), 2));
}

/* What a slab that absorbs nothing lets through of an even sky, by Simpson's rule.  Rays find that, from
   the floor or through the slab; light that the floor has reflected is not direct. */
static void the_sky_comes_through_glass(void **state)
{
    (void)state;
    enum { PARTS = 2000 };
    KrsRenderOptions all = direct;
    double           sum = 0;
    for (int i = 0; i <= PARTS; i++) {
        const double angle = 0.5 * M_PI * i / PARTS, mirrored = fresnel(angle, slabs[0].index);
        const double weight = i == 0 || i == PARTS ? 1 : i % 2 ? 4 : 2;
        sum += weight / 3 * (1 - mirrored) / (1 + mirrored) * sin(2 * angle);
    }
    sum *= 0.5 * M_PI / PARTS;
    set_slab(&slabs[0]);
    path_fixture_set(&fixture, "day", 1);
    all.samples    = 64;
    Estimate found = path_fixture_estimate(&fixture, all, everywhere, 6);
    path_fixture_set(&fixture, "day", 0);
    assert_true(must_be_near(found, sum, 0.003, "an even sky"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_comes_through_glass),
        cmocka_unit_test(glass_shows_what_is_behind),
        cmocka_unit_test(the_sky_comes_through_glass),
    };
    return cmocka_run_group_tests_name("direct_glass", tests, open_slab, close_slab);
}
