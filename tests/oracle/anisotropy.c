/*
 * anisotropy.c: surfaces that are brushed: what they mirror, held against GGX with two widths in double
 * precision, and their tangents, held against maps that are followed by hand.
 *
 * The reference knows the density of microfacets and Smith's masking by two widths (Heitz 2014, eqs. 85
 * and 87), and integrates over all normals; the renderer's table is made of means over visible ones.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/tracer/albedos.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

#define DEGREE (M_PI / 180)

static double square(double x) { return x * x; }

/* ---- GGX with two widths ---- */

typedef struct Widths {
    double along, across;
} Widths;

/* As OpenPBR has them: their ratio is 1 - anisotropy, and their mean square roughness^4. */
static Widths widths_of(double roughness, double anisotropy)
{
    const double ratio = fmax(1 - anisotropy, 1e-9),
                 along = square(roughness) / sqrt((1 + square(ratio)) / 2);
    return (Widths){fmax(along, 1e-3), fmax(along * ratio, 1e-3)};
}

static double hidden(Vec direction, Widths w)
{
    const double slopes = square(w.along * direction.x) + square(w.across * direction.y);
    return (sqrt(1 + slopes / square(direction.z)) - 1) / 2;
}

static double density(Vec normal, Widths w)
{
    const double all = square(normal.x / w.along) + square(normal.y / w.across) + square(normal.z);
    return 1 / (M_PI * w.along * w.across * square(all));
}

/* Adds the part of light that a microfacet mirrors into all directions, over the probability of
   its normal: density times cosine. */
static void add_facet(Vec eye, Vec normal, Widths w, double weight, double sums[2])
{
    const double facing = vec_dot(eye, normal);
    const Vec    light  = vec_sub(vec_scale(2 * facing, normal), eye);
    if (facing <= 0 || light.z <= 0)
        return;
    const double seen = 1 / (1 + hidden(eye, w) + hidden(light, w));
    sums[0] += weight * seen * facing / (eye.z * normal.z);
    sums[1] += weight * seen * facing / (eye.z * normal.z) * pow(1 - facing, 5);
}

/* What microfacets reflect that mirror all, and the part by Schlick's factor. */
static void reflect_all(Vec eye, Widths w, int points, double sums[2])
{
    sums[0] = sums[1] = 0;
    for (int i = 0; i < 2 * points; i++)
        for (int k = 0; k < points; k++) {
            const double turn = M_PI * (i + 0.5) / points, part = (k + 0.5) / points;
            /* The share of normals that are steeper is part^6: steep ones count much, seen flatly. */
            const double steeper = pow(part, 6), tangent = sqrt((1 - steeper) / steeper);
            const Vec    slope = {w.along * tangent * cos(turn), w.across * tangent * sin(turn), 1};
            add_facet(eye, vec_unit(slope), w, 6 * pow(part, 5) / (2 * square(points)), sums);
        }
}

/* ---- The table ---- */

#define RIGHT 3e-3 /* what may be wrong in the table, of 1 */

static size_t compare_cell(int anisotropy, int roughness, int column)
{
    const double cosine = fmin(fmax(square(column / (WIDE_COSINES - 1.0)), 1e-3), 0.999999);
    const Widths w      = widths_of(roughness / (WIDE_ROUGHNESSES - 1.0),
                                    anisotropy / (WIDE_ANISOTROPIES - 1.0));
    const int    number = (anisotropy * (int)WIDE_ROUGHNESSES + roughness) * (int)WIDE_COSINES +
                       column;
    const uint16_t *shares = wide_albedos[number];
    size_t          wrong  = 0;
    for (int i = 0; i < WIDE_AZIMUTHS; i++) {
        const double sine = sqrt(1 - square(cosine)), along = sqrt(i / 3.0);
        double       right[2];
        reflect_all(vec(sine * along, sine * sqrt(1 - square(along)), cosine), w, 72, right);
        for (int k = 0; k < 2; k++)
            if (!(fabs(shares[WIDE_AZIMUTHS * k + i] / 1000.0 - right[k]) <= RIGHT)) {
                print_message("# cosine %.3f, azimuth %d, roughness %d, anisotropy %d: %.4f "
                              "instead of %.4f\n",
                              cosine, i, roughness, anisotropy,
                              shares[WIDE_AZIMUTHS * k + i] / 1000.0, right[k]);
                wrong++;
            }
    }
    return wrong;
}

static void the_table_is_right(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int number = 0; number < (int)WIDE_ALBEDO_ROWS; number += 13)
        wrong += compare_cell(number / (int)(WIDE_COSINES * WIDE_ROUGHNESSES),
                              number / (int)WIDE_COSINES % (int)WIDE_ROUGHNESSES,
                              number % (int)WIDE_COSINES);
    assert_int_equal(wrong, 0);
}

/* ---- A plate below a lamp ---- */

static const char plate[] =
    "param rough = 0.5 in [0, 1]; param brushed = 0 in [0, 1]; param turn = 0 in [-9, 9];\n"
    "param eye = [0, 1, 0]; param lamp = [0, 1, 0];\n"
    "camera { eye: 5 * eye, up: [0.3, 0, 1], projection: \"orthographic\", height: 0.5 }\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light one { direction: lamp, intensity: 1, shadow: false }\n"
    "material m { color: white, metallic: 1, roughness: rough,\n"
    "             specular_roughness_anisotropy: brushed, tangent: [cos(turn), 0, sin(turn)] }\n"
    "show box([90, 1, 90]).paint(m).move([0, -0.5, 0]);\n";

static PathFixture fixture;

static int open_plate(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(plate);
    return 0;
}

static int close_plate(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

static double look_at_plate(KrsIntegrator integrator)
{
    KrsPicture  *picture = path_fixture_render(&fixture,
                                               &(KrsRenderOptions){.width        = 8,
                                                                   .height       = 8,
                                                                   .samples      = 1,
                                                                   .no_occlusion = true,
                                                                   .aovs         = KRS_AOV_COLOR,
                                                                   .integrator   = integrator});
    const double mean    = mean_of_region(picture, everywhere, 1);
    krs_picture_free(picture);
    return mean;
}

/* Returns a unit vector so far from the plate's normal, at an angle about it; in the renderer y is
   up. */
static Vec aim(double tilt, double angle)
{
    return vec(sin(tilt) * cos(angle), sin(tilt) * sin(angle), cos(tilt));
}

static void set_direction(const char *name, Vec direction)
{
    path_fixture_set_all(&fixture, name, direction.x, direction.z, direction.y);
}

/* Returns the plate's radiance, of a metal that mirrors all: what bounces once, and in proportion
   to that what bounces more, so that nothing is lost. */
static double radiance_of(Vec eye, Vec light, double turn, Widths w)
{
    const Vec along = vec(cos(turn), sin(turn), 0), across = vec(-sin(turn), cos(turn), 0);
    const Vec to_eye   = vec(vec_dot(eye, along), vec_dot(eye, across), eye.z);
    const Vec to_light = vec(vec_dot(light, along), vec_dot(light, across), light.z);
    double    all[2];
    reflect_all(to_eye, w, 96, all);
    const double once = density(vec_unit(vec_add(to_eye, to_light)), w) /
                        (4 * to_eye.z * (1 + hidden(to_eye, w) + hidden(to_light, w)));
    return once / all[0];
}

/* Angles of the eye and of the lamp to the normal and about it, and that of the tangent. */
static const double settings[][5] = {
    {0, 0, 25, 0, 0},     {0, 0, 25, 90, 0},     {40, 10, 35, 170, 0},   {40, 10, 35, 170, 90},
    {60, 80, 50, 250, 0}, {60, 80, 50, 250, 45}, {60, 80, 20, 300, -30}, {20, 200, 65, 40, 110}};
static const double brushed[] = {0, 0.5, 0.8, 0.95};

/* Between rows of the table some of the light that bounces more than once is lost or appears. */
#define MAX_WRONG 0.01

static void lamps_are_mirrored_by_both_widths(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        for (size_t k = 0; k < sizeof brushed / sizeof *brushed; k++) {
            const double *s   = settings[i];
            const double  eye = s[0] * DEGREE, roughness = i % 2 ? 0.5 : 0.7;
            const Vec     to_eye = aim(eye, s[1] * DEGREE),
                      to_light   = aim(s[2] * DEGREE, s[3] * DEGREE);
            path_fixture_set(&fixture, "rough", roughness);
            path_fixture_set(&fixture, "brushed", brushed[k]);
            path_fixture_set(&fixture, "turn", s[4] * DEGREE);
            set_direction("eye", to_eye);
            set_direction("lamp", to_light);
            const double right = radiance_of(to_eye, to_light, s[4] * DEGREE,
                                             widths_of(roughness, brushed[k]));
            for (int j = 0; j < 2; j++) {
                const double found = look_at_plate(j ? KRS_INTEGRATOR_DIRECT
                                                     : KRS_INTEGRATOR_PREVIEW);
                if (!(fabs(found - right) <= MAX_WRONG * right + 1e-5)) {
                    print_message("# setting %zu, anisotropy %.2f, integrator %d: %.5f instead of "
                                  "%.5f\n",
                                  i, brushed[k], j, found, right);
                    wrong++;
                }
            }
        }
    assert_int_equal(wrong, 0);
}

/* From above, by a lamp at so many widths from the mirror's direction: its light is the same for both
   directions, but for what is hidden.  So a highlight is as much longer as one width is larger. */
static void a_highlight_is_as_long_as_its_widths_say(void **state)
{
    (void)state;
    const Widths w = widths_of(0.5, 0.75);
    double       found[2];
    path_fixture_set(&fixture, "rough", 0.5);
    path_fixture_set(&fixture, "brushed", 0.75);
    path_fixture_set(&fixture, "turn", 0);
    set_direction("eye", vec(0, 0, 1));
    for (int k = 0; k < 2; k++) {
        const double tilt  = atan(k ? w.across : w.along);
        const Vec    light = aim(2 * tilt, k ? M_PI / 2 : 0);
        set_direction("lamp", light);
        found[k] = look_at_plate(KRS_INTEGRATOR_PREVIEW) * (1 + hidden(light, w)) *
                   pow(cos(tilt), 4);
    }
    assert_true(fabs(w.along / w.across - 4) < 1e-9);
    assert_true(fabs(found[0] / found[1] - 1) < 0.002);
}

/* ---- Balls in a furnace, and a sun that is found either way ---- */

#define IRRADIANCE 3.0
#define BALL       866.0254 /* looks as large as the sun from a distance of 1000 */
#define NO_BALL    2

static const char furnace[] =
    "param rough = 0.5 in [0, 1]; param brushed = 0 in [0, 1]; param metal = 0 in [0, 1];\n"
    "param glass = 0 in [0, 1]; param lacquer = 0 in [0, 1]; param shade = [1, 1, 1];\n"
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2 }\n"
    "param day = 1 in [0, 1]; param bright = 0 in [0, 100]; param size = 2 in [2, 900];\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light sun { direction: [0.6, 0.64, 0.48], intensity: bright, softness: 120deg }\n"
    "material lamp { color: black, specular: 0, emission: 1.2732395 }\n"
    "show sphere(size).move([600, 640, 480]).paint(lamp);\n"
    "material m { color: shade, roughness: rough, metallic: metal, transmission: glass,\n"
    "             coat: lacquer, coat_roughness: 0.3, specular_roughness_anisotropy: brushed }\n"
    "show sphere(1).paint(m);\n";

typedef struct Brushed {
    const char *name;
    double      metal, glass, lacquer, brushed;
} Brushed;

static const Brushed materials[] = {
    {"a brushed metal", 1, 0, 0, 0.6},         {"a much brushed metal", 1, 0, 0, 0.95},
    {"a brushed dielectric", 0, 0, 0, 0.8},    {"brushed glass", 0, 1, 0, 0.8},
    {"a brushed metal, coated", 1, 0, 1, 0.7}, {"half a metal", 0.5, 0.5, 0, 0.9}};
enum { MATERIALS = sizeof materials / sizeof *materials };

static void paint(const PathFixture *balls, Brushed material, double roughness)
{
    PathFixture ball = *balls;
    path_fixture_set(&ball, "rough", roughness);
    path_fixture_set(&ball, "metal", material.metal);
    path_fixture_set(&ball, "glass", material.glass);
    path_fixture_set(&ball, "lacquer", material.lacquer);
    path_fixture_set(&ball, "brushed", material.brushed);
}

static Estimate look_at_ball(const PathFixture *balls, bool glass)
{
    return path_fixture_estimate(balls,
                                 (KrsRenderOptions){.width      = 64,
                                                    .height     = 64,
                                                    .samples    = 1,
                                                    .bounces    = glass ? 48 : 2,
                                                    .aovs       = KRS_AOV_COLOR,
                                                    .integrator = KRS_INTEGRATOR_PATH},
                                 everywhere, 6);
}

/* The preview guesses the sky's light, but all of it. */
static Estimate preview_ball(const PathFixture *balls)
{
    static const Region middle = {0.3, 0.3, 0.7, 0.7};
    return path_fixture_estimate(balls,
                                 (KrsRenderOptions){.width        = 64,
                                                    .height       = 64,
                                                    .samples      = 1,
                                                    .no_occlusion = true,
                                                    .aovs         = KRS_AOV_COLOR,
                                                    .integrator   = KRS_INTEGRATOR_PREVIEW},
                                 middle, 1);
}

static size_t compare_furnace(PathFixture *balls)
{
    size_t wrong = 0;
    for (int i = 0; i < MATERIALS; i++)
        for (int k = 0; k <= 3; k++) {
            const bool glass = materials[i].glass > 0;
            char       name[100];
            snprintf(name, sizeof name, "%s, roughness %.2f", materials[i].name, k / 3.0);
            paint(balls, materials[i], k / 3.0);
            wrong += !must_be_near(look_at_ball(balls, glass), 1, 0.01, name);
            wrong += !glass && !must_be_near(preview_ball(balls), 1, 0.01, name);
        }
    paint(balls, materials[0], 0.5);
    path_fixture_set_all(balls, "shade", 0.95, 0.95, 0.95);
    assert_false(is_near(look_at_ball(balls, false), 1, 0.01));
    path_fixture_set_all(balls, "shade", 1, 1, 1);
    return wrong;
}

/* By points that are chosen on it, and by rays that happen to meet it. */
static size_t compare_suns(PathFixture *balls)
{
    size_t wrong = 0;
    path_fixture_set(balls, "day", 0);
    for (int i = 0; i < MATERIALS; i++) {
        const bool glass = materials[i].glass > 0;
        paint(balls, materials[i], 0.5);
        path_fixture_set(balls, "bright", IRRADIANCE);
        const Estimate chosen = look_at_ball(balls, glass);
        path_fixture_set(balls, "bright", 0);
        path_fixture_set(balls, "size", BALL);
        const Estimate met = look_at_ball(balls, glass);
        path_fixture_set(balls, "size", NO_BALL);
        const Estimate both = {.mean = chosen.mean, .error = hypot(chosen.error, met.error)};
        wrong += !must_be_near(both, met.mean, 0.01, materials[i].name);
    }
    return wrong;
}

static void no_light_is_lost(void **state)
{
    (void)state;
    PathFixture balls = path_fixture_open(furnace);
    size_t      wrong = compare_furnace(&balls);
    wrong += compare_suns(&balls);
    path_fixture_close(&balls);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_is_right),
        cmocka_unit_test(lamps_are_mirrored_by_both_widths),
        cmocka_unit_test(a_highlight_is_as_long_as_its_widths_say),
        cmocka_unit_test(no_light_is_lost),
    };
    return cmocka_run_group_tests_name("anisotropy", tests, open_plate, close_plate);
}
