/*
 * subsurface.c: light that goes on below a surface, held against random walks in double precision, and
 * against the profile of Christensen and Burley (2015) in closed form.
 *
 * The reference walks from event to event, in a half-space or a slab: it knows no distances, no balls
 * in which light diffuses, and one colour at a time.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

static double square(double x) { return x * x; }

/* ---- Random walks ---- */

/* Returns what is left of light at an event in a medium whose half-space has an albedo: that of van
   de Hulst, inverted by bisection. */
static double kept_of(double albedo)
{
    double low = 0, high = 1; /* of the root of what is lost */
    for (int i = 0; i < 60; i++) {
        const double s = (low + high) / 2, found = (1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s);
        *(found > albedo ? &low : &high) = s;
    }
    return 1 - square(low);
}

typedef struct Exit {
    double x, y; /* where it leaves, in mean free paths from where it has entered */
    int    side; /* 1: where it has entered, -1: on the other, 0: it has been absorbed */
} Exit;

/* A walk in a slab, `thick` mean free paths thick, until light is absorbed or leaves. */
static Exit walk(double thick, double kept, Random *random)
{
    double rise = -sqrt(random_between(random, 0, 1)), x = 0, y = 0, z = 0;
    for (;;) {
        const double turn   = random_between(random, 0, 2 * M_PI);
        const double length = -log(random_between(random, 1e-300, 1));
        const double ring = sqrt(1 - square(rise)), next = z + length * rise;
        const double part = next > 0        ? z / (z - next)
                            : next < -thick ? (z + thick) / (z - next)
                                            : 1;
        x += part * length * ring * cos(turn);
        y += part * length * ring * sin(turn);
        if (part < 1 || next > 0)
            return (Exit){x, y, next > 0 ? 1 : -1};
        if (random_between(random, 0, 1) > kept)
            return (Exit){0, 0, 0};
        z    = next;
        rise = random_between(random, -1, 1);
    }
}

enum { WALKS = 60000, PLACES = 7 };
#define HALF_SPACE 1e30

/* Places beside the edge of a shadow, in mean free paths; and how much light leaves there, of that which
   enters where there is none. */
static const double places[PLACES] = {-4, -2, -0.8, 0.1, 0.8, 2, 4};

typedef struct Spread {
    double at[PLACES], all;
} Spread;

static Spread spread_of_walks(double albedo)
{
    const double kept   = kept_of(albedo);
    Random       random = {11};
    Spread       spread = {.all = 0};
    for (int i = 0; i < WALKS; i++) {
        const Exit exit = walk(HALF_SPACE, kept, &random);
        spread.all += (double)(exit.side != 0) / WALKS;
        for (int k = 0; k < PLACES; k++)
            spread.at[k] += (double)(exit.side != 0 && exit.x > -places[k]) / WALKS;
    }
    return spread;
}

/* Returns the same by the closed form: albedo (e^(-r/d) + e^(-r/3d)) / (8 pi d r), for light that
   enters a dull surface. */
static Spread spread_of_profile(double albedo)
{
    enum { RADII = 4000, ANGLES = 200 };
    const double d      = 1 / (1.9 - albedo + 3.5 * square(albedo - 0.8));
    Spread       spread = {.all = albedo};
    for (int i = 0; i < RADII; i++) {
        const double r    = 60 * d * (i + 0.5) / RADII,
                     ring = 60 * d / RADII * albedo * (exp(-r / d) + exp(-r / (3 * d))) / (4 * d);
        for (int j = 0; j < ANGLES; j++)
            for (int k = 0; k < PLACES; k++)
                spread.at[k] += r * cos(2 * M_PI * (j + 0.5) / ANGLES) > -places[k] ? ring / ANGLES
                                                                                    : 0;
    }
    return spread;
}

/* ---- A slab of wax, half of it in the shadow ---- */

/* The camera is below what casts the shadow.  The lamp below is seen through the slab alone. */
static const char slab[] =
    "param shade = [0.8, 0.8, 0.8]; param radius = [1, 1, 1]; param thick = 500 in [0.1, 500];\n"
    "param above = 1 in [0, 9]; param below = 0 in [0, 9]; param day = 0 in [0, 1];\n"
    "camera { eye: [0, 5, 0], up: [0, 0, 1], projection: \"orthographic\", height: 0.2 }\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: black }\n"
    "light sun { direction: [0, 1, 0], intensity: above }\n"
    "light moon { direction: [0, -1, 0], intensity: below }\n"
    "param hidden = 0 in [-400, 400];\n"
    "material black_body { color: black, specular: 0 }\n"
    "material wax { specular: 0, subsurface_weight: 1, subsurface_color: shade,\n"
    "               subsurface_radius: radius }\n"
    "show box([400, 1, 400]).move([200 + hidden, 20, 0]).paint(black_body);\n"
    "show box([900, thick, 900]).move([0, -thick / 2, 0]).paint(wax);\n";

static PathFixture fixture;

static int open_slab(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(slab);
    return 0;
}

static int close_slab(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

/* What is seen of each colour, and its error. */
typedef struct Seen {
    Estimate colors[3];
} Seen;

static Seen look(int pictures)
{
    Seen seen = {.colors = {{0}}};
    for (int i = 0; i < pictures; i++) {
        KrsPicture *picture = path_fixture_render(
            &fixture, &(KrsRenderOptions){.width      = 32,
                                          .height     = 32,
                                          .samples    = 4,
                                          .seed       = (uint64_t)i + 1,
                                          .aovs       = KRS_AOV_COLOR,
                                          .integrator = KRS_INTEGRATOR_DIRECT});
        for (int k = 0; k < 3; k++)
            estimate_add(&seen.colors[k], mean_of_region(picture, everywhere, k));
        krs_picture_free(picture);
    }
    return seen;
}

/* The part of light, beside noise, that may be wrong: formulas of albedos, and where light diffuses. */
#define MAX_WRONG 0.012

static Estimate times(Estimate estimate, double by)
{
    estimate.mean *= by;
    estimate.error *= by;
    return estimate;
}

/* Each colour has its own albedo and its own mean free path. */
static const double albedos[3] = {0.95, 0.8, 0.4}, radii[3] = {2, 1, 0.5};

static void set_wax(void)
{
    path_fixture_set_all(&fixture, "shade", albedos[0], albedos[1], albedos[2]);
    path_fixture_set_all(&fixture, "radius", radii[0], radii[1], radii[2]);
}

/* The shadow's edge is moved, and with it the place beside it that is seen. */
static void light_spreads_below_a_shadow(void **state)
{
    (void)state;
    size_t wrong = 0;
    set_wax();
    for (int color = 0; color < 3; color++) {
        const Spread walks = spread_of_walks(albedos[color]);
        const Spread form  = spread_of_profile(albedos[color]);
        for (int k = 0; k < PLACES; k++) {
            char name[100];
            path_fixture_set(&fixture, "hidden", places[k] * radii[color]);
            Estimate found = times(look(4).colors[color], M_PI);
            snprintf(name, sizeof name, "color %d at %g mean free paths", color, places[k]);
            const double noise = sqrt(walks.at[k] * (1 - walks.at[k]) / WALKS);
            found.error        = hypot(found.error, noise);
            wrong += !must_be_near(found, walks.at[k], MAX_WRONG, name);
            /* The profile is a fit, off by a few hundredths of all light. */
            if (!(fabs(found.mean - form.at[k]) <= 0.04 * form.all + SIGMAS * found.error)) {
                print_message("# %s: %.4f instead of %.4f by the closed form\n", name, found.mean,
                              form.at[k]);
                wrong++;
            }
        }
    }
    path_fixture_set(&fixture, "hidden", 0);
    assert_int_equal(wrong, 0);
}

static void a_shadow_is_told_from_one_that_is_sharper(void **state)
{
    (void)state;
    const Spread walks = spread_of_walks(0.8);
    set_wax();
    path_fixture_set_all(&fixture, "radius", 2, 0.8, 0.5);
    path_fixture_set(&fixture, "hidden", -2);
    assert_false(is_near(times(look(4).colors[1], M_PI), walks.at[1], MAX_WRONG));
    path_fixture_set(&fixture, "hidden", 0);
}

/* Below a sky of one colour. */
static void half_spaces_have_their_color(void **state)
{
    (void)state;
    size_t wrong = 0;
    set_wax();
    path_fixture_set(&fixture, "day", 1);
    path_fixture_set(&fixture, "above", 0);
    path_fixture_set(&fixture, "hidden", 400);
    const Seen seen = look(8);
    for (int color = 0; color < 3; color++)
        wrong += !must_be_near(seen.colors[color], albedos[color], MAX_WRONG, "the albedo");
    path_fixture_set(&fixture, "day", 0);
    path_fixture_set(&fixture, "above", 1);
    path_fixture_set(&fixture, "hidden", 0);
    assert_int_equal(wrong, 0);
}

static double let_through(double thick, double albedo)
{
    const double kept   = kept_of(albedo);
    Random       random = {12};
    int          count  = 0;
    for (int i = 0; i < WALKS; i++)
        count += walk(thick, kept, &random).side < 0;
    return (double)count / WALKS;
}

/* From below a plate is lit, from above it is seen. */
static void thin_plates_let_light_through(void **state)
{
    (void)state;
    static const double thicknesses[] = {0.3, 2, 8, 40};
    size_t              wrong         = 0;
    path_fixture_set(&fixture, "above", 0);
    path_fixture_set(&fixture, "below", 1);
    path_fixture_set_all(&fixture, "radius", 1, 1, 1);
    path_fixture_set_all(&fixture, "shade", 0.99, 0.8, 0.4);
    for (int i = 0; i < 4; i++) {
        char name[100];
        path_fixture_set(&fixture, "thick", thicknesses[i]);
        const Seen   seen     = look(8);
        const double shades[] = {0.99, 0.8, 0.4};
        for (int color = 0; color < 3; color++) {
            const double right = let_through(thicknesses[i], shades[color]);
            Estimate     found = times(seen.colors[color], M_PI);
            found.error        = hypot(found.error, sqrt(right * (1 - right) / WALKS));
            snprintf(name, sizeof name, "color %d through %g mean free paths", color,
                     thicknesses[i]);
            wrong += !must_be_near(found, right, 0.02, name);
        }
    }
    path_fixture_set(&fixture, "thick", 500);
    path_fixture_set(&fixture, "above", 1);
    path_fixture_set(&fixture, "below", 0);
    assert_int_equal(wrong, 0);
}

/* ---- White things in a furnace ---- */

#define IRRADIANCE 3.0
#define BALL       866.0254 /* looks as large as the sun from a distance of 1000 */
#define NO_BALL    2

static const char furnace[] =
    "param radius = [0.1, 0.1, 0.1]; param shade = [1, 1, 1]; param much = 1 in [0, 1];\n"
    "param metal = 0 in [0, 1]; param lacquer = 0 in [0, 1]; param mirrors = 1 in [0, 1];\n"
    "param rough = 0.4 in [0, 1];\n"
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2.2 }\n"
    "param day = 1 in [0, 1]; param bright = 0 in [0, 100]; param size = 2 in [2, 900];\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light sun { direction: [0.6, 0.64, 0.48], intensity: bright, softness: 120deg }\n"
    "material lamp { color: black, specular: 0, emission: 1.2732395 }\n"
    "show sphere(size).move([600, 640, 480]).paint(lamp);\n"
    "material m { color: white, roughness: rough, metallic: metal, coat: lacquer, specular: "
    "mirrors,\n"
    "             subsurface_weight: much, subsurface_color: shade, subsurface_radius: radius }\n"
    "show union(sphere(0.7), box([0.2, 2, 0.05]).move([0.7, 0, 0]), blend: 0.1).paint(m);\n";

static Estimate look_at_wax(const PathFixture *furnace_fixture, int bounces)
{
    return path_fixture_estimate(furnace_fixture,
                                 (KrsRenderOptions){.width      = 64,
                                                    .height     = 64,
                                                    .samples    = 1,
                                                    .bounces    = (uint32_t)bounces,
                                                    .aovs       = KRS_AOV_COLOR,
                                                    .integrator = KRS_INTEGRATOR_PATH},
                                 everywhere, 6);
}

static const struct {
    const char *name;
    double      radius[3], much, metal, lacquer, mirrors;
} whites[] = {
    {"dense", {0.001, 0.001, 0.001}, 1, 0, 0, 1},  {"marble", {0.02, 0.01, 0.005}, 1, 0, 0, 1},
    {"wax", {0.2, 0.1, 0.05}, 1, 0, 0, 0},         {"thin", {5, 2, 1}, 1, 0, 0, 1},
    {"half of it", {0.1, 0.1, 0.1}, 0.5, 0, 0, 1}, {"half a metal", {0.1, 0.1, 0.1}, 1, 0.5, 0, 1},
    {"lacquered", {0.1, 0.1, 0.1}, 1, 0, 1, 1},    {"of one colour", {0.1, 0, 0}, 1, 0, 0, 1},
};
enum { WHITES = sizeof whites / sizeof *whites };

static void paint(PathFixture *s, int i)
{
    path_fixture_set_all(s, "radius", whites[i].radius[0], whites[i].radius[1],
                         whites[i].radius[2]);
    path_fixture_set(s, "much", whites[i].much);
    path_fixture_set(s, "metal", whites[i].metal);
    path_fixture_set(s, "lacquer", whites[i].lacquer);
    path_fixture_set(s, "mirrors", whites[i].mirrors);
    path_fixture_set(s, "rough", i % 4 / 3.0);
}

static size_t compare_suns(PathFixture *s)
{
    size_t wrong = 0;
    path_fixture_set(s, "day", 0);
    for (int i = 0; i < WHITES; i += 2) {
        paint(s, i);
        path_fixture_set(s, "bright", IRRADIANCE);
        const Estimate chosen = look_at_wax(s, 4);
        path_fixture_set(s, "bright", 0);
        path_fixture_set(s, "size", BALL);
        const Estimate met = look_at_wax(s, 4);
        path_fixture_set(s, "size", NO_BALL);
        const Estimate both = {.mean = chosen.mean, .error = hypot(chosen.error, met.error)};
        wrong += !must_be_near(both, met.mean, 0.01, whites[i].name);
    }
    path_fixture_set(s, "day", 1);
    return wrong;
}

static void white_is_not_seen(void **state)
{
    (void)state;
    size_t      wrong = 0;
    PathFixture s     = path_fixture_open(furnace);
    for (int i = 0; i < WHITES; i++) {
        paint(&s, i);
        wrong += !must_be_near(look_at_wax(&s, 20), 1, 0.01, whites[i].name);
    }
    path_fixture_set_all(&s, "shade", 0.9, 0.9, 0.9);
    assert_false(is_near(look_at_wax(&s, 20), 1, 0.01));
    path_fixture_set_all(&s, "shade", 1, 1, 1);
    wrong += compare_suns(&s);
    path_fixture_close(&s);
    assert_int_equal(wrong, 0);
}

/* ---- Previews ---- */

/* In previews light leaves where it has entered: wax that is white looks like a white body. */
static KrsPicture *preview_wax(PathFixture *s, double much)
{
    path_fixture_set(s, "much", much);
    return path_fixture_render(s, &(KrsRenderOptions){.width      = 32,
                                                      .height     = 32,
                                                      .samples    = 1,
                                                      .aovs       = KRS_AOV_COLOR,
                                                      .integrator = KRS_INTEGRATOR_PREVIEW});
}

/* How many numbers differ, of a lamp's light alone; `sum`: of this light. */
static size_t compare_previews(PathFixture *s, double *sum)
{
    KrsPicture *wax = preview_wax(s, 1), *body = preview_wax(s, 0);
    size_t      wrong = 0;
    for (size_t i = 0; i < (size_t)4 * 32 * 32; i++) {
        wrong += !(fabs(wax->color[i] - body->color[i]) <= 1e-5 + 1e-4 * body->color[i]);
        *sum += i % 4 < 3 ? body->color[i] : 0;
    }
    krs_picture_free(wax);
    krs_picture_free(body);
    return wrong;
}

static void previews_light_wax_as_a_body(void **state)
{
    (void)state;
    size_t      wrong = 0;
    PathFixture s     = path_fixture_open(furnace);
    path_fixture_set(&s, "day", 0);
    path_fixture_set(&s, "bright", IRRADIANCE);
    for (int i = 0; i < WHITES; i++) {
        double sum = 0;
        paint(&s, i);
        const size_t differ = compare_previews(&s, &sum);
        if (differ)
            print_message("# %s: %zu numbers differ\n", whites[i].name, differ);
        wrong += differ;
        assert_true(sum > 100);
    }
    path_fixture_close(&s);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_spreads_below_a_shadow),
        cmocka_unit_test(a_shadow_is_told_from_one_that_is_sharper),
        cmocka_unit_test(half_spaces_have_their_color),
        cmocka_unit_test(thin_plates_let_light_through),
        cmocka_unit_test(white_is_not_seen),
        cmocka_unit_test(previews_light_wax_as_a_body),
    };
    return cmocka_run_group_tests_name("subsurface", tests, open_slab, close_slab);
}
