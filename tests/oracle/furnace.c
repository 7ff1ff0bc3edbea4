/*
 * furnace.c: a ball of many materials, below a sky and a sun.
 *
 * In a white furnace, where light comes from all sides alike, a ball that absorbs nothing is not
 * seen: each of its pixels has the light of the sky.  Light that is lost, or appears, between
 * microfacets, below a coat or sheen, or as glass and body are mixed, shows at once.
 *
 * A sun is found by rays that happen to meet it, and by choosing points of it; how much each of
 * both counts depends on the probability of each direction.  A far ball that emits is found by
 * rays alone.  Where probabilities are wrong, the same light differs.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

/* The sun, and the radius at distance 1000 of a ball that looks as large.  The ball emits what the
   sun's disc does: its irradiance over pi sin(60deg)^2. */
#define IRRADIANCE 3.0
#define BALL       866.0254
#define NO_BALL    0.5 /* rays that just miss a smaller one are lost in roundings */

static const char furnace[] =
    "param rough = 0.5 in [0, 1]; param metal = 0 in [0, 1]; param glass = 0 in [0, 1];\n"
    "param lacquer = 0 in [0, 1]; param lacquer_rough = 0 in [0, 1];\n"
    "param fuzz = 0 in [0, 1]; param fuzz_rough = 0.5 in [0, 1];\n"
    "param film = 0 in [0, 1]; param thick = 0.4 in [0, 9];\n"
    "param index = 1.5 in [1, 4]; param mirrors = 1 in [0, 1]; param shade = [1, 1, 1];\n"
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2 }\n"
    "param day = 1 in [0, 1]; param bright = 0 in [0, 100]; param size = 0.5 in [0.5, 900];\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "param width = 120deg in [0deg, 120deg];\n"
    "light sun { direction: [0.6, 0.64, 0.48], intensity: bright, softness: width }\n"
    "material lamp { color: black, specular: 0, emission: 1.2732395 }\n"
    "show sphere(size).move([600, 640, 480]).paint(lamp);\n"
    "material m { color: shade, roughness: rough, metallic: metal, transmission: glass,\n"
    "             coat: lacquer, coat_roughness: lacquer_rough, sheen: [fuzz, fuzz, fuzz],\n"
    "             sheen_roughness: fuzz_rough, ior: index, specular: mirrors,\n"
    "             thin_film_weight: film, thin_film_thickness: thick }\n"
    "show sphere(1).paint(m);\n";

enum { MAX_NUMBERS = 8 };

/* A white material: numbers of the scene's parameters. */
typedef struct White {
    const char *name;
    struct {
        const char *parameter;
        double      number;
    } numbers[MAX_NUMBERS];
} White;

static const White whites[] = {
    {"a metal", {{"metal", 1}}},
    {"half a metal", {{"metal", 0.5}}},
    {"a dielectric", {{"metal", 0}}},
    {"a dense dielectric", {{"index", 2.5}}},
    {"Lambert's", {{"mirrors", 0}}},
    {"glass", {{"glass", 1}}},
    {"dense glass", {{"glass", 1}, {"index", 2.5}}},
    {"half glass", {{"glass", 0.5}}},
    {"half a metal, half glass", {{"metal", 0.5}, {"glass", 1}}},
    {"coated", {{"lacquer", 1}}},
    {"roughly coated", {{"lacquer", 1}, {"lacquer_rough", 0.7}}},
    {"a coated metal", {{"lacquer", 1}, {"metal", 1}, {"lacquer_rough", 0.3}}},
    {"coated glass", {{"lacquer", 1}, {"glass", 1}, {"lacquer_rough", 0.5}}},
    {"cloth", {{"fuzz", 1}, {"fuzz_rough", 0.5}}},
    {"smooth cloth", {{"fuzz", 1}, {"fuzz_rough", 0}}},
    {"rough cloth", {{"fuzz", 1}, {"fuzz_rough", 1}}},
    {"half cloth", {{"fuzz", 0.5}, {"fuzz_rough", 0.8}}},
    {"cloth of metal and glass",
     {{"metal", 0.5}, {"glass", 1}, {"fuzz", 0.7}, {"fuzz_rough", 0.3}}},
    {"cloth of some glass", {{"glass", 0.5}, {"fuzz", 0.4}, {"fuzz_rough", 0}}},
    {"a film on a dielectric", {{"film", 1}, {"index", 2}}},
    {"a thick film on a metal", {{"film", 1}, {"metal", 1}, {"thick", 3}}},
    {"a bubble", {{"film", 1}, {"glass", 1}, {"index", 1.2}}},
    {"all at once",
     {{"metal", 0.3},
      {"glass", 0.4},
      {"film", 0.5},
      {"lacquer", 0.6},
      {"lacquer_rough", 0.4},
      {"fuzz", 0.5},
      {"fuzz_rough", 0.7}}},
};
enum { WHITES = sizeof whites / sizeof *whites };

static const char *const parameters[] = {"rough",         "metal", "glass",      "lacquer",
                                         "lacquer_rough", "fuzz",  "fuzz_rough", "index",
                                         "mirrors",       "film",  "thick"};

static PathFixture fixture;

static int open_furnace(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(furnace);
    return 0;
}

static int close_furnace(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

static void paint(const White *white, double roughness)
{
    static const double usual[] = {0, 0, 0, 0, 0, 0, 0.5, 1.5, 1, 0, 0.4};
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        path_fixture_set(&fixture, parameters[i], usual[i]);
    path_fixture_set(&fixture, "rough", roughness);
    for (size_t i = 0; i < MAX_NUMBERS && white->numbers[i].parameter; i++)
        path_fixture_set(&fixture, white->numbers[i].parameter, white->numbers[i].number);
}

/* The part of the light that may be lost or appear, beside noise. */
#define MAX_LOST          0.002
#define MAX_LOST_OF_METAL 5e-4

/* Only glass lets paths go on within the ball. */
static bool has_glass(const White *white)
{
    bool found = false;
    for (size_t i = 0; i < MAX_NUMBERS && white->numbers[i].parameter; i++)
        found = found || strcmp(white->numbers[i].parameter, "glass") == 0;
    return found;
}

static Estimate look_at(const White *white, uint32_t samples)
{
    return path_fixture_estimate(&fixture,
                                 (KrsRenderOptions){.width      = 64,
                                                    .height     = 64,
                                                    .samples    = samples,
                                                    .bounces    = has_glass(white) ? 64 : 2,
                                                    .aovs       = KRS_AOV_COLOR,
                                                    .integrator = KRS_INTEGRATOR_PATH},
                                 everywhere, 6);
}

static Estimate look(const White *white) { return look_at(white, 1); }

static Estimate look_long(const White *white) { return look_at(white, 16); }

static void white_is_not_seen(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (size_t i = 0; i < WHITES; i++)
        for (int k = 0; k <= 3; k++) {
            const double roughness = k / 3.0;
            char         name[100];
            snprintf(name, sizeof name, "%s, roughness %.2f", whites[i].name, roughness);
            paint(&whites[i], roughness);
            wrong += !must_be_near(look(&whites[i]), 1, MAX_LOST, name);
        }
    assert_int_equal(wrong, 0);
}

/* Metals send all on at once, so there is little noise in which light could hide. */
static void metals_lose_nothing(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int k = 0; k <= 20; k++) {
        char name[100];
        snprintf(name, sizeof name, "a long look at a metal, roughness %.2f", k / 20.0);
        paint(&whites[0], k / 20.0);
        Estimate found = look_long(&whites[0]);
        print_message("# %s: %.5f +- %.5f\n", name, found.mean, found.error);
        wrong += !must_be_near(found, 1, MAX_LOST_OF_METAL, name);
    }
    assert_int_equal(wrong, 0);
}

/* Five hundredths that are absorbed are more than what may be wrong. */
static void gray_is_seen(void **state)
{
    (void)state;
    for (size_t i = 0; i < WHITES; i++) {
        paint(&whites[i], 0);
        path_fixture_set_all(&fixture, "shade", 0.95, 0.95, 0.95);
        if (is_near(look(&whites[i]), 1, MAX_LOST))
            fail_msg("%s is taken for white", whites[i].name);
        path_fixture_set_all(&fixture, "shade", 1, 1, 1);
    }
}

/* ---- A sun, and a ball that looks the same ---- */

/* Returns what is seen by one of them: a parameter has a number instead of the usual one. */
static Estimate look_by(const White *white, const char *parameter, double number, double usual)
{
    path_fixture_set(&fixture, parameter, number);
    Estimate found = look(white);
    path_fixture_set(&fixture, parameter, usual);
    return found;
}

/* Tells whether a sun and the ball look the same, and a sun would not that is too bright by a tenth; by
   three tenths where glass makes more noise. */
static bool is_found_either_way(const White *white)
{
    const double too_much = has_glass(white) ? 1.3 : 1.1;
    Estimate     chosen   = look_by(white, "bright", IRRADIANCE, 0);
    Estimate     met      = look_by(white, "size", BALL, NO_BALL);
    Estimate     both     = {.mean = chosen.mean, .error = hypot(chosen.error, met.error)};
    Estimate     brighter = {.mean  = too_much * chosen.mean,
                             .error = hypot(too_much * chosen.error, met.error)};
    if (is_near(brighter, met.mean, MAX_LOST))
        fail_msg("%s: a sun that is too bright is not seen", white->name);
    return must_be_near(both, met.mean, MAX_LOST, white->name);
}

static void light_is_found_either_way(void **state)
{
    (void)state;
    size_t wrong = 0;
    path_fixture_set(&fixture, "day", 0);
    for (size_t i = 0; i < WHITES; i++) {
        paint(&whites[i], 0.5);
        wrong += !is_found_either_way(&whites[i]);
    }
    path_fixture_set(&fixture, "day", 1);
    assert_int_equal(wrong, 0);
}

/* ---- Light that bounces nowhere ---- */

/* A ball that no light goes through has no place that sees another one. */
static void nothing_bounces_from_a_ball(void **state)
{
    (void)state;
    path_fixture_set(&fixture, "bright", IRRADIANCE);
    for (size_t i = 0; i < WHITES; i++) {
        KrsRenderOptions options = {.width = 40, .height = 40, .samples = 3};
        KrsPicture      *pictures[2];
        paint(&whites[i], 0.4);
        for (int k = 0; k < 2; k++) {
            options.integrator = k ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_DIRECT;
            pictures[k]        = path_fixture_render(&fixture, &options);
        }
        bool same = memcmp(pictures[0]->color, pictures[1]->color, 40 * 40 * 4 * sizeof(float)) ==
                    0;
        if (same == has_glass(&whites[i]))
            fail_msg("%s: direct and path are%s the same", whites[i].name, same ? "" : " not");
        krs_picture_free(pictures[0]);
        krs_picture_free(pictures[1]);
    }
    path_fixture_set(&fixture, "bright", 0);
}

/* ---- Previews ---- */

#define PREVIEW_OPTIONS                                                                       \
    (KrsRenderOptions)                                                                        \
    {                                                                                         \
        .width = 64, .height = 64, .samples = 1, .no_occlusion = true, .aovs = KRS_AOV_COLOR, \
        .integrator = KRS_INTEGRATOR_PREVIEW                                                  \
    }

/* Where normals do not differ much within a pixel. */
static const Region middle = {0.3, 0.3, 0.7, 0.7};

/* What previews say that each layer sends back of the sky adds up to all of it. */
static void previews_lose_no_sky(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (size_t i = 0; i < WHITES; i++)
        for (int k = 0; k <= 3 && !has_glass(&whites[i]); k++) {
            char name[100];
            snprintf(name, sizeof name, "preview of %s, roughness %.2f", whites[i].name, k / 3.0);
            paint(&whites[i], k / 3.0);
            Estimate white = path_fixture_estimate(&fixture, PREVIEW_OPTIONS, middle, 1);
            wrong += !must_be_near(white, 1, MAX_LOST, name);
        }
    assert_int_equal(wrong, 0);
}

/* Returns one light without a size: neither integrator chooses anything, so there is no noise. */
static size_t compare_lamp(const White *white)
{
    KrsRenderOptions options = PREVIEW_OPTIONS;
    KrsPicture      *preview = path_fixture_render(&fixture, &options);
    size_t           wrong   = 0;
    options.integrator       = KRS_INTEGRATOR_DIRECT;
    KrsPicture *direct       = path_fixture_render(&fixture, &options);
    for (unsigned i = 0; i < 4 * 64 * 64; i++) {
        const unsigned x = i / 4 % 64, y = i / 256;
        const double   a = preview->color[i], b = direct->color[i];
        bool           inside = x > 19 && x < 45 && y > 19 && y < 45;
        wrong += inside && !(fabs(a - b) <= 1e-4 + 2e-3 * b);
    }
    if (wrong)
        print_message("# %s: preview and direct differ in %zu numbers\n", white->name, wrong);
    krs_picture_free(preview);
    krs_picture_free(direct);
    return wrong;
}

/* Layers show a lamp in previews as they do on paths. */
static void previews_show_a_lamp_as_paths_do(void **state)
{
    (void)state;
    size_t wrong = 0;
    path_fixture_set(&fixture, "day", 0);
    path_fixture_set(&fixture, "width", 0);
    path_fixture_set(&fixture, "bright", IRRADIANCE);
    for (size_t i = 0; i < WHITES; i++)
        for (int k = 1; k <= 2 && !has_glass(&whites[i]); k++) {
            paint(&whites[i], k / 3.0);
            path_fixture_set_all(&fixture, "shade", 0.9, 0.5, 0.2);
            wrong += compare_lamp(&whites[i]);
        }
    path_fixture_set_all(&fixture, "shade", 1, 1, 1);
    path_fixture_set(&fixture, "bright", 0);
    path_fixture_set(&fixture, "width", 2.0943951);
    path_fixture_set(&fixture, "day", 1);
    assert_int_equal(wrong, 0);
}

/* ---- A material that has no layers ---- */

/* Such ones have shaders of their own. */
static const char unlayered[] =
    "param rough = 0.5 in [0, 1]; param metal = 0 in [0, 1]; param shade = [1, 1, 1];\n"
    "param day = 1 in [0, 1]; param bright = 0 in [0, 100];\n"
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2 }\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light sun { direction: [0.6, 0.64, 0.48], intensity: bright }\n"
    "material m { color: shade, roughness: rough, metallic: metal }\n"
    "show sphere(1).paint(m);\n";

/* Returns the largest part of the light in a pixel by which preview and direct differ: the preview
   has a fit in place of the table. */
static double max_different(const PathFixture *plain)
{
    KrsRenderOptions options = PREVIEW_OPTIONS;
    double           most    = 0;
    KrsPicture      *preview = path_fixture_render(plain, &options);
    options.integrator       = KRS_INTEGRATOR_DIRECT;
    KrsPicture *direct       = path_fixture_render(plain, &options);
    for (unsigned y = 4; y < 60; y++)
        for (unsigned x = 4; x < 60; x++) {
            const float *a = &preview->color[4 * (64 * y + x)],
                        *b = &direct->color[4 * (64 * y + x)];
            bool inside    = hypot(x - 31.5, y - 31.5) < 27;
            for (int k = 0; k < 3 && inside && b[k] > 0.02F; k++)
                most = fmax(most, fabs(a[k] / (double)b[k] - 1));
        }
    krs_picture_free(preview);
    krs_picture_free(direct);
    return most;
}

static void unlayered_previews_lose_nothing(void **state)
{
    (void)state;
    PathFixture plain = path_fixture_open(unlayered);
    size_t      wrong = 0;
    for (int i = 0; i < 16; i++) {
        const double rough = i / 4 / 3.0, metal = i % 4 / 3.0;
        char         name[100];
        snprintf(name, sizeof name, "preview of metal %.2f, roughness %.2f", metal, rough);
        path_fixture_set(&plain, "rough", rough);
        path_fixture_set(&plain, "metal", metal);
        Estimate white = path_fixture_estimate(&plain, PREVIEW_OPTIONS, everywhere, 1);
        wrong += !must_be_near(white, 1, 0.001, name);
        if (i < 4)
            continue; /* a lamp in a mirror is a point */
        path_fixture_set(&plain, "day", 0);
        path_fixture_set(&plain, "bright", IRRADIANCE);
        path_fixture_set_all(&plain, "shade", 0.9, 0.5, 0.2);
        const double most = max_different(&plain);
        print_message("# %s: %.3f of a pixel's light\n", name, most);
        wrong += !(most < 0.08);
        path_fixture_set_all(&plain, "shade", 1, 1, 1);
        path_fixture_set(&plain, "bright", 0);
        path_fixture_set(&plain, "day", 1);
    }
    path_fixture_close(&plain);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_is_not_seen),
        cmocka_unit_test(metals_lose_nothing),
        cmocka_unit_test(gray_is_seen),
        cmocka_unit_test(light_is_found_either_way),
        cmocka_unit_test(nothing_bounces_from_a_ball),
        cmocka_unit_test(previews_lose_no_sky),
        cmocka_unit_test(previews_show_a_lamp_as_paths_do),
        cmocka_unit_test(unlayered_previews_lose_nothing),
    };
    return cmocka_run_group_tests_name("furnace", tests, open_furnace, close_furnace);
}
