/*
 * paths.c: integrators that follow paths, held against closed forms: what glass lets through and
 * absorbs, where it bends light to, and how much light sources send to a floor.
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

#define DEGREE (M_PI / 180)

/* ---- A slab of glass ---- */

/* The camera looks up through a slab from y = -1/2 to 1/2, at a sky of 1; the ground is black.  A
   board that emits 1 fills the half of the plane y = BOARD with x < `edge`. */
#define BOARD 3.0
#define HIGH  1.0 /* the picture */
static const char slab[] =
    "param angle = 0 in [0, 1.5]; param index = 1.5 in [1, 4]; param loss = 0 in [0, 9];\n"
    "param edge = -100 in [-100, 9]; param day = 1 in [0, 1];\n"
    "camera { eye: [-5 * sin(angle), -5 * cos(angle), 0], up: [0, 0, 1],\n"
    "         projection: \"orthographic\", height: 1 }\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: black }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "material glass { color: [1, 1, 1], transmission: 1, roughness: 0, ior: index,\n"
    "                 absorption: [loss, loss, loss] }\n"
    "material board { color: black, specular: 0, emission: [1, 1, 1] }\n"
    "show box([60, 1, 60]).paint(glass);\n"
    "show box([60, 1, 60]).move([edge - 30, 3.5, 0]).paint(board);\n";

static const KrsRenderOptions through = {.width      = 96,
                                         .height     = 96,
                                         .samples    = 1,
                                         .bounces    = 12,
                                         .aovs       = KRS_AOV_COLOR,
                                         .integrator = KRS_INTEGRATOR_PATH};

/* What a boundary reflects of light that meets it at this angle, by its index of refraction. */
static double fresnel(double angle, double index, double *beyond)
{
    *beyond       = asin(sin(angle) / index);
    double across = (cos(angle) - index * cos(*beyond)) / (cos(angle) + index * cos(*beyond));
    double along  = (index * cos(angle) - cos(*beyond)) / (index * cos(angle) + cos(*beyond));
    return 0.5 * (across * across + along * along);
}

/* Returns what a slab of thickness 1 lets through: each way through it leaves `kept`. */
static double let_through(double angle, double index, double loss)
{
    double beyond, mirrored = fresnel(angle, index, &beyond), kept = exp(-loss / cos(beyond));
    return (1 - mirrored) * (1 - mirrored) * kept / (1 - mirrored * mirrored * kept * kept);
}

static Estimate look_through(PathFixture *fixture, double angle, double index, double loss)
{
    path_fixture_set(fixture, "angle", angle);
    path_fixture_set(fixture, "index", index);
    path_fixture_set(fixture, "loss", loss);
    return path_fixture_estimate(fixture, through, everywhere, 6);
}

/* What refracts less counts as this. */
#define MIN_INDEX 1.001

static const double angles[] = {0, 25 * DEGREE, 45 * DEGREE, 60 * DEGREE, 70 * DEGREE};
enum { ANGLES = sizeof angles / sizeof *angles };

static void slabs_let_light_through(void **state)
{
    (void)state;
    static const struct {
        double index, loss;
    } slabs[] = {{MIN_INDEX, 0}, {1.5, 0}, {2.4, 0}, {MIN_INDEX, 0.7}, {MIN_INDEX, 3}, {1.5, 1.5}};
    PathFixture fixture = path_fixture_open(slab);
    size_t      wrong   = 0;
    for (size_t i = 0; i < sizeof slabs / sizeof *slabs; i++)
        for (size_t k = 0; k < ANGLES; k++) {
            char     name[100];
            Estimate found = look_through(&fixture, angles[k], slabs[i].index, slabs[i].loss);
            double   right = let_through(angles[k], slabs[i].index, slabs[i].loss);
            snprintf(name, sizeof name, "at %.0f degrees, index %g, absorption %g",
                     angles[k] / DEGREE, slabs[i].index, slabs[i].loss);
            wrong += !must_be_near(found, right, 0.002, name);
            assert_false(is_near(
                found, let_through(angles[k], slabs[i].index + 0.1, slabs[i].loss + 0.1), 0.002));
        }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* Returns the part of the picture that the board fills, seen through a slab of this index, or
   through none: rays that are mirrored within the slab 2 k times leave it farther to the side. */
static double seen_of_board(double angle, double index, double edge)
{
    double beyond, mirrored = fresnel(angle, index, &beyond), sum = 0;
    double weight = (1 - mirrored) * (1 - mirrored);
    for (int k = 0; k < 20; k++, weight *= mirrored * mirrored) {
        /* Where the ray through the middle of the picture enters, and meets the board's plane. */
        double enters = -tan(angle) * 0.5;
        double meets  = enters + (1 + 2 * k) * tan(beyond) + (BOARD - 0.5) * tan(angle);
        double right  = (edge - meets) * cos(angle); /* of the edge, from the middle */
        sum += weight * fmin(fmax(right / HIGH + 0.5, 0), 1);
    }
    return sum;
}

/* The edge is near where the middle of the picture would see it without the slab. */
static void slabs_displace_what_is_behind(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(slab);
    size_t      wrong   = 0;
    path_fixture_set(&fixture, "day", 0);
    for (size_t k = 0; k < ANGLES; k++) {
        double edge = BOARD * tan(angles[k]) - 0.2;
        char   name[100];
        path_fixture_set(&fixture, "edge", edge);
        Estimate found = look_through(&fixture, angles[k], 1.5, 0);
        double   right = seen_of_board(angles[k], 1.5, edge);
        snprintf(name, sizeof name, "an edge at %.0f degrees", angles[k] / DEGREE);
        wrong += !must_be_near(found, right, 0.004, name);
        if (k > 0) /* a ray that meets the slab head on is not bent */
            assert_false(is_near(found, seen_of_board(angles[k], 1.3, edge), 0.004));
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- A half-space of glass ---- */

/* Water without a bottom mirrors the sky by Fresnel's part; below it is dark.  The stone tempts the
   march to end where the rest of the scene does. */
static const char water[] =
    "param angle = 0 in [0, 1.5];\n"
    "camera { eye: [5 * sin(angle), 5 * cos(angle), 0], up: [0, 0, 1],\n"
    "         projection: \"orthographic\", height: 0.5 }\n"
    "sky { zenith: [1, 1, 1], horizon: [1, 1, 1], ground: black }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "material water { color: [1, 1, 1], transmission: 1, roughness: 0, ior: 1.33 }\n"
    "show plane([0, 1, 0], 0).paint(water);\n"
    "show sphere(0.2).move([0, 0.3, 3]);\n";

static void water_mirrors_the_sky(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(water);
    size_t      wrong   = 0;
    for (size_t k = 0; k < ANGLES; k++) {
        double beyond;
        char   name[100];
        snprintf(name, sizeof name, "water at %.0f degrees", angles[k] / DEGREE);
        path_fixture_set(&fixture, "angle", angles[k]);
        Estimate found = path_fixture_estimate(&fixture, through, everywhere, 6);
        wrong += !must_be_near(found, fresnel(angles[k], 1.33, &beyond), 0.002, name);
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- Lights over a floor ---- */

/* The camera looks at a small part of the floor around the origin, from the height that is given as
   an angle from the zenith.  Lights that are not asked for are black. */
static const char lit_floor[] =
    "param angle = 1.05 in [0, 1.5]; param shade = [1, 1, 1]; param rough = 0.5 in [0, 1];\n"
    "param metal = 0 in [0, 1]; param mirrors = 0 in [0, 1];\n"
    "param toward = [0, 1, 0]; param wide = 0 in [0, 2]; param bright = 0 in [0, 99];\n"
    "param at = [0, 3, 0]; param radius = 0 in [0, 2]; param power = 0 in [0, 99];\n"
    "param ball = [0, -9, 0]; param size = 0.1 in [0.1, 2];\n"
    "camera { eye: [5 * sin(angle), 5 * cos(angle), 0], up: [0, 0, 1],\n"
    "         projection: \"orthographic\", height: 0.05 }\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light sun { direction: toward, softness: wide, intensity: bright }\n"
    "param haze = 0 in [0, 1]; fog { color: black, density: haze }\n"
    "param panel = 0 in [0, 99];\n"
    "light rectangle { position: at, target: [0, 0, 0], size: [1.2, 0.8], intensity: panel }\n"
    "light lamp { position: at, radius: radius, intensity: power }\n"
    "material m { color: shade, roughness: rough, metallic: metal, specular: mirrors }\n"
    "material glowing { color: black, specular: 0, emission: [2, 2, 2] }\n"
    "show plane([0, 1, 0], 0).paint(m);\n"
    "show sphere(size).move(ball).paint(glowing);\n";

static const KrsRenderOptions onto_floor = {.width      = 32,
                                            .height     = 32,
                                            .samples    = 16,
                                            .aovs       = KRS_AOV_COLOR,
                                            .integrator = KRS_INTEGRATOR_DIRECT};

static Estimate look_at_floor(const PathFixture *fixture)
{
    return path_fixture_estimate(fixture, onto_floor, everywhere, 6);
}

/* Tells whether that is what is expected, but for a part of it; a tenth more would not be. */
static bool is_right(Estimate found, double expected, double part, const char *what)
{
    if (is_near(found, 1.1 * expected, part))
        fail_msg("%s: a tenth too much is not seen", what);
    return must_be_near(found, expected, part, what);
}

static void set_direction(PathFixture *fixture, const char *name, double angle, double length)
{
    path_fixture_set_all(fixture, name, -length * sin(angle), length * cos(angle), 0);
}

/* A body that is diffuse alone reflects color / pi of the irradiance.  Without a size there is no
   noise. */
static bool sun_without_a_size(PathFixture *fixture, double angle)
{
    char name[100];
    snprintf(name, sizeof name, "a sun at %.0f degrees", angle / DEGREE);
    set_direction(fixture, "toward", angle, 1);
    path_fixture_set(fixture, "bright", 3);
    path_fixture_set_all(fixture, "shade", 0.7, 0.7, 0.7);
    Estimate found = look_at_floor(fixture);
    path_fixture_set(fixture, "bright", 0);
    path_fixture_set_all(fixture, "shade", 1, 1, 1);
    return is_right(found, 0.7 * 3 * cos(angle) / M_PI, 1e-5, name);
}

/* The irradiance below a ball does not depend on its size: that of the whole light in its middle. */
static bool lamp_with_a_radius(PathFixture *fixture, double angle, double radius)
{
    const double distance = 2, irradiance = 5 * cos(angle) / (distance * distance);
    char         name[100];
    snprintf(name, sizeof name, "a lamp at %.0f degrees, radius %g", angle / DEGREE, radius);
    set_direction(fixture, "at", angle, distance);
    path_fixture_set(fixture, "radius", radius);
    path_fixture_set(fixture, "power", 5);
    Estimate found = look_at_floor(fixture);
    path_fixture_set(fixture, "power", 0);
    return is_right(found, irradiance / M_PI, 0.003, name);
}

/* A ball of radiance L sends pi L (r / d)^2 cos. */
static bool ball_that_emits(PathFixture *fixture, double angle, double radius)
{
    const double distance = 2, share = radius * radius / (distance * distance);
    char         name[100];
    snprintf(name, sizeof name, "a ball at %.0f degrees, radius %g", angle / DEGREE, radius);
    set_direction(fixture, "ball", angle, distance);
    path_fixture_set(fixture, "size", radius);
    Estimate found = look_at_floor(fixture);
    set_direction(fixture, "ball", M_PI, 9);
    return is_right(found, 2 * share * cos(angle), 0.003, name);
}

/* A smooth metal shows the disc of the sun, whose radiance is E / (pi sin^2). */
static bool mirrored_sun(PathFixture *fixture, double angle, double wide)
{
    char         name[100];
    const double sine = sin(0.5 * wide);
    snprintf(name, sizeof name, "a mirrored sun at %.0f degrees, %.0f wide", angle / DEGREE,
             wide / DEGREE);
    path_fixture_set(fixture, "angle", angle);
    path_fixture_set(fixture, "metal", 1);
    path_fixture_set(fixture, "rough", 0);
    set_direction(fixture, "toward", angle, 1);
    path_fixture_set(fixture, "wide", wide);
    path_fixture_set(fixture, "bright", 3);
    Estimate found = look_at_floor(fixture);
    path_fixture_set(fixture, "bright", 0);
    path_fixture_set(fixture, "metal", 0);
    path_fixture_set(fixture, "angle", 1.05);
    return is_right(found, 3 / (M_PI * sine * sine), 0.003, name);
}

/* A rectangle's radiance is its light over its area, also in a mirror. */
static bool mirrored_rectangle(PathFixture *fixture, double angle)
{
    char name[100];
    snprintf(name, sizeof name, "a mirrored rectangle at %.0f degrees", angle / DEGREE);
    path_fixture_set(fixture, "angle", angle);
    path_fixture_set(fixture, "metal", 1);
    path_fixture_set(fixture, "rough", 0);
    set_direction(fixture, "at", angle, 2);
    path_fixture_set(fixture, "panel", 5);
    Estimate found = look_at_floor(fixture);
    path_fixture_set(fixture, "panel", 0);
    path_fixture_set(fixture, "metal", 0);
    path_fixture_set(fixture, "angle", 1.05);
    return is_right(found, 5 / (1.2 * 0.8), 0.003, name);
}

/* Several lights together are their sum; also one that the floor is within, as a ball of light
   around the lamp's middle. */
static bool lights_together(PathFixture *fixture)
{
    const double sun = 3 * cos(0.5), around = 5 / 0.25 / M_PI;
    set_direction(fixture, "toward", 0.5, 1);
    path_fixture_set(fixture, "wide", 0.3);
    set_direction(fixture, "at", 0, 0.5);
    path_fixture_set(fixture, "radius", 0.8);
    path_fixture_set(fixture, "power", 5);
    Estimate lamp = look_at_floor(fixture);
    path_fixture_set(fixture, "bright", 3);
    Estimate both = look_at_floor(fixture);
    path_fixture_set(fixture, "power", 0);
    path_fixture_set(fixture, "bright", 0);
    return is_right(lamp, around, 0.01, "a lamp around the floor") &&
           is_right(both, around + sun / M_PI, 0.01, "a sun, and a lamp around the floor");
}

/* Fog hides what is behind it from the eye, and does not dim lights; whichever way a light is
   found. */
static bool lights_in_fog(PathFixture *fixture)
{
    const double density = 0.1;
    path_fixture_set(fixture, "haze", density);
    path_fixture_set(fixture, "power", 5);
    path_fixture_set(fixture, "radius", 1.2);
    set_direction(fixture, "at", 0.4, 2);
    Estimate found = look_at_floor(fixture);
    path_fixture_set(fixture, "power", 0);
    path_fixture_set(fixture, "haze", 0);
    return is_right(found, exp(-5 * density) * 5 * cos(0.4) / 4 / M_PI, 0.003, "a lamp in fog");
}

static void lights_light_a_floor(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(lit_floor);
    size_t      wrong   = 0;
    for (size_t k = 0; k < ANGLES; k++)
        wrong += !sun_without_a_size(&fixture, angles[k]);
    for (size_t k = 0; k < 3; k++) {
        wrong += !lamp_with_a_radius(&fixture, angles[k], 0);
        wrong += !lamp_with_a_radius(&fixture, angles[k], 0.2);
        wrong += !lamp_with_a_radius(&fixture, angles[k], 1.2);
        wrong += !ball_that_emits(&fixture, angles[k], 0.7);
        wrong += !ball_that_emits(&fixture, angles[k], 1.2);
        wrong += !mirrored_sun(&fixture, angles[k], 10 * DEGREE);
        wrong += !mirrored_sun(&fixture, angles[k], 40 * DEGREE);
        wrong += !mirrored_rectangle(&fixture, angles[k]);
    }
    wrong += !lights_together(&fixture);
    wrong += !lights_in_fog(&fixture);
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- Lights of all kinds together ---- */

static const char lit_ball[] =
    "param sun = 0 in [0, 9]; param lamp = 0 in [0, 9]; param panel = 0 in [0, 9];\n"
    "param beam = 0 in [0, 9]; param point = 0 in [0, 9];\n"
    "camera { eye: [3, 3, 5], target: [0, 0.5, 0], fov: 35deg }\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light a { direction: [1, 2, 1], softness: 20deg, intensity: sun }\n"
    "light b { position: [-1.5, 2, 1], radius: 0.6, intensity: 3 * lamp }\n"
    "light c { position: [1.5, 2, 1], target: [0, 0, 0], size: [1, 0.6], intensity: 3 * panel }\n"
    "light d { position: [0, 3, 2], target: [0, 0, 0], angle: 40deg, radius: 0.3,\n"
    "          intensity: 9 * beam }\n"
    "light e { position: [0, 3, -2], intensity: 3 * point, color: tomato }\n"
    "material m { color: [1, 1, 1], roughness: 0.4, metallic: 1 }\n"
    "show sphere(0.6).move([0, 0.6, 0]).paint(m);\n"
    "show plane([0, 1, 0], 0);\n";

static Estimate look_at_ball(const PathFixture *fixture)
{
    const KrsRenderOptions options = {.width      = 64,
                                      .height     = 48,
                                      .samples    = 4,
                                      .bounces    = 3,
                                      .aovs       = KRS_AOV_COLOR,
                                      .integrator = KRS_INTEGRATOR_PATH};
    return path_fixture_estimate(fixture, options, everywhere, 6);
}

/* A path chooses one light at each surface.  Together they must be their sum, as each is found by
   other chances alone than among others. */
static void lights_add_up(void **state)
{
    (void)state;
    static const char *const lights[] = {"sun", "lamp", "panel", "beam", "point"};
    enum { LIGHTS = sizeof lights / sizeof *lights };
    PathFixture fixture = path_fixture_open(lit_ball);
    Estimate    sum     = {0}, all;
    for (int i = 0; i < LIGHTS; i++) {
        path_fixture_set(&fixture, lights[i], 1);
        Estimate own = look_at_ball(&fixture);
        path_fixture_set(&fixture, lights[i], 0);
        sum.mean += own.mean;
        sum.error = hypot(sum.error, own.error);
    }
    for (int i = 0; i < LIGHTS; i++)
        path_fixture_set(&fixture, lights[i], 1);
    all       = look_at_ball(&fixture);
    all.error = hypot(all.error, sum.error);
    path_fixture_close(&fixture);
    assert_true(must_be_near(all, sum.mean, 0.003, "all lights"));
    assert_false(is_near(all, 1.05 * sum.mean, 0.003));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slabs_let_light_through), cmocka_unit_test(slabs_displace_what_is_behind),
        cmocka_unit_test(water_mirrors_the_sky),   cmocka_unit_test(lights_light_a_floor),
        cmocka_unit_test(lights_add_up),
    };
    return cmocka_run_group_tests_name("paths", tests, renderer_open, renderer_close);
}
