/*
 * volumes.c: media that scatter light, held against closed forms, quadrature, and random paths that share no
 * code with the renderer.
 *
 * A slab lets through what Beer's law says, and sends what its emission says.  Where nothing is absorbed, and
 * light comes from all sides alike, nobody sees a medium.  Light that is scattered once is an integral.  Media
 * that differ from place to place are walked through here in small steps, without any bound of their density.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/splitmix.h"
#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

static const KrsRenderOptions paths = {.width      = 64,
                                       .height     = 64,
                                       .samples    = 4,
                                       .bounces    = 2,
                                       .aovs       = KRS_AOV_COLOR,
                                       .integrator = KRS_INTEGRATOR_PATH};

/* Returns the mean green of all pixels, whatever they show, by pictures of different seeds. */
static Estimate look(const PathFixture *fixture, KrsRenderOptions options)
{
    enum { PICTURES = 6 };
    Estimate estimate = {0};
    for (int i = 0; i < PICTURES; i++) {
        options.seed        = (uint64_t)i + 1;
        KrsPicture *picture = path_fixture_render(fixture, &options);
        double      sum     = 0;
        for (size_t k = 0; k < (size_t)picture->width * picture->height; k++)
            sum += (double)picture->color[4 * k + 1];
        estimate_add(&estimate, sum / ((double)picture->width * picture->height));
        krs_picture_free(picture);
    }
    return estimate;
}

static Estimate look_with_bounces(const PathFixture *fixture, uint32_t bounces)
{
    KrsRenderOptions options = paths;
    options.bounces          = bounces;
    return look(fixture, options);
}

/* ---- Slabs ---- */

/* The camera looks up through a slab, at a sky of `day`. */
#define SLAB                                                                                \
    "param angle = 0 in [0, 1.5]; param thick = 1 in [0, 9]; param dense = 1 in [0, 20];\n" \
    "param day = 1 in [0, 1]; param bright = 0 in [0, 9]; param g = 0 in [-0.9, 0.9];\n"    \
    "param sent = 0 in [0, 9]; param part = 0 in [0, 1]; param loss = 0 in [0, 9];\n"       \
    "camera { eye: [-5 * sin(angle), -5 * cos(angle), 0], up: [0, 0, 1],\n"                 \
    "         projection: \"orthographic\", height: 0.5 }\n"                                \
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"  \
    "light sun { direction: [0.6, 0.8, 0], intensity: bright }\n"                           \
    "show sphere(1).move([0, -90, 0]);\n"
#define FILL                                                                                 \
    "medium { within: box([80, thick, 80]), density: dense, scatter: part, anisotropy: g,\n" \
    "         emission: sent }\n"

static void slabs_absorb_and_send(void **state)
{
    (void)state;
    static const struct {
        double angle, thick, dense, sent;
    } slabs[] = {{0, 1, 1, 0}, {0, 0.5, 3, 0}, {1, 1, 1, 0}, {0.5, 2, 0.3, 2}, {0, 1, 9, 3}};
    PathFixture      fixture = path_fixture_open(SLAB FILL);
    KrsRenderOptions options = paths;
    size_t           wrong   = 0;
    options.samples          = 16;
    for (size_t i = 0; i < sizeof slabs / sizeof *slabs; i++) {
        const double left = exp(-slabs[i].dense * slabs[i].thick / cos(slabs[i].angle));
        char         name[100];
        snprintf(name, sizeof name, "slab %zu", i);
        path_fixture_set(&fixture, "angle", slabs[i].angle);
        path_fixture_set(&fixture, "thick", slabs[i].thick);
        path_fixture_set(&fixture, "dense", slabs[i].dense);
        path_fixture_set(&fixture, "sent", slabs[i].sent);
        Estimate found    = look(&fixture, options);
        double   expected = left + slabs[i].sent * (1 - left);
        wrong += !must_be_near(found, expected, 0.002, name);
        assert_false(is_near(found, 1.05 * expected, 0.002));
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* Returns how much light is scattered by an angle with this cosine (Henyey and Greenstein 1941). */
static double phase(double g, double cosine)
{
    return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* Light that comes from the sun, and is scattered once on the way to the eye, which is below. */
static double scattered_once(double thick, double dense, double part, double g, double irradiance)
{
    enum { STEPS = 4000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double t = (i + 0.5) * thick / STEPS; /* from below; sunlight comes from above */
        sum += exp(-dense * t) * exp(-dense * (thick - t) / 0.8) * thick / STEPS;
    }
    return irradiance * dense * part * phase(g, 0.8) * sum;
}

static void slabs_scatter_once(void **state)
{
    (void)state;
    static const struct {
        double thick, dense, part, g;
    } slabs[]           = {{1, 0.5, 1, 0}, {1, 2, 0.5, 0.5}, {0.5, 3, 1, -0.6}};
    PathFixture fixture = path_fixture_open(SLAB FILL);
    KrsLight    sun;
    size_t      wrong = 0;
    path_fixture_set(&fixture, "day", 0);
    path_fixture_set(&fixture, "bright", 3);
    assert_int_equal(krs_state_light(fixture.product.state, 0, &sun), KRS_OK);
    for (size_t i = 0; i < sizeof slabs / sizeof *slabs; i++) {
        char name[100];
        snprintf(name, sizeof name, "light scattered once by slab %zu", i);
        path_fixture_set(&fixture, "thick", slabs[i].thick);
        path_fixture_set(&fixture, "dense", slabs[i].dense);
        path_fixture_set(&fixture, "part", slabs[i].part);
        path_fixture_set(&fixture, "g", slabs[i].g);
        const double expected = scattered_once(slabs[i].thick, slabs[i].dense, slabs[i].part,
                                               slabs[i].g, sun.color[1]);
        wrong += !must_be_near(look_with_bounces(&fixture, 1), expected, 0.003, name);
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- Lamps ---- */

/* Mist around a lamp: below the plane of the lamp the camera looks past it, at this distance.  A ball shades
   what is behind it. */
static const char lamps[] =
    "param past = 0.3 in [0, 3]; param size = 0 in [0, 1]; param g = 0 in [-0.9, 0.9];\n"
    "param other = 0 in [0, 9]; param dense = 0.5 in [0, 9]; param spot = 0 in [0, 9];\n"
    "camera { eye: [past, 0, 6], target: [past, 0, 0], projection: \"orthographic\", height: 0.01 "
    "}\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light lamp { position: [0, 0, 0], intensity: 2, radius: size }\n"
    "light third { position: [past, 1.5, -0.5], target: [past, 0, 0.5], intensity: spot, angle: "
    "40deg, edge: 0 }\n"
    "light second { position: [0, 2, 0], intensity: other }\n"
    "medium { within: box([8, 8, 4]), density: dense, anisotropy: g, scatter: 0.7 }\n"
    "show sphere(1).move([0, -90, 0]);\n";

/* Returns the light of a lamp at a height that a ray past it gets, scattered once.  Light of a ball comes
   from the side of it that is near: two thirds of the radius before the middle, on average. */
static double scattered_past(double past, double height, double dense, double g, double radius)
{
    enum { STEPS = 100000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double z   = 2 - 4 * (i + 0.5) / STEPS; /* where the ray is, which goes to -z */
        const double way = sqrt(past * past + height * height + z * z);
        sum += exp(-dense * (2 - z + way - 2 * radius / 3)) * phase(g, z / way) / (way * way) * 4 /
               STEPS;
    }
    return 0.7 * dense * sum;
}

/* Returns the same of a spot that shines across the ray from (past, 1.5, -0.5) to (past, 0, 0.5), within 20
   degrees of that. */
static double scattered_from_spot(double dense, double g)
{
    enum { STEPS = 100000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double z = 2 - 4 * (i + 0.5) / STEPS, way = hypot(1.5, z + 0.5);
        const double cosine = (1.5 * 1.5 + (z + 0.5)) / (way * hypot(1.5, 1));
        if (cosine > cos(20 * M_PI / 180))
            sum += exp(-dense * (2 - z + way)) * phase(g, (z + 0.5) / way) / (way * way) * 4 /
                   STEPS;
    }
    return 0.7 * dense * sum;
}

static void lamps_shine_through_mist(void **state)
{
    (void)state;
    static const struct {
        double past, dense, g, other, size, spot;
    } rows[] = {{0.3, 0.05, 0, 0, 0, 0}, {2, 0.3, 0.4, 0, 0, 9},     {0.05, 1, 0.6, 0, 0, 0},
                {1, 4, -0.5, 3, 0, 0},   {0.5, 0.5, 0.3, 0, 0.1, 0}, {0.3, 3, 0.8, 1, 0.02, 0}};
    PathFixture      fixture = path_fixture_open(lamps);
    KrsRenderOptions options = paths;
    KrsLight         lamp, second, third;
    size_t           wrong = 0;
    options.bounces        = 1;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char name[100];
        snprintf(name, sizeof name, "lamp %zu", i);
        path_fixture_set(&fixture, "past", rows[i].past);
        path_fixture_set(&fixture, "dense", rows[i].dense);
        path_fixture_set(&fixture, "g", rows[i].g);
        path_fixture_set(&fixture, "other", rows[i].other);
        path_fixture_set(&fixture, "size", rows[i].size);
        path_fixture_set(&fixture, "spot", rows[i].spot);
        assert_int_equal(krs_state_light(fixture.product.state, 0, &lamp), KRS_OK);
        assert_int_equal(krs_state_light(fixture.product.state, 1, &third), KRS_OK);
        assert_int_equal(krs_state_light(fixture.product.state, 2, &second), KRS_OK);
        const double expected = lamp.color[1] * scattered_past(rows[i].past, 0, rows[i].dense,
                                                               rows[i].g, rows[i].size) +
                                second.color[1] *
                                    scattered_past(rows[i].past, 2, rows[i].dense, rows[i].g, 0) +
                                third.color[1] * scattered_from_spot(rows[i].dense, rows[i].g);
        Estimate found = look(&fixture, options);
        wrong += !must_be_near(found, expected, rows[i].size > 0 ? 0.012 : 0.003, name);
        assert_true(found.error < 0.02 * expected); /* by chance alone it is many times that */
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- Glass ---- */

/* Glass without an index of its own reflects next to nothing.  What counts of a medium and glass in one place
   is what stands later; the glass absorbs in both cases. */
#define PANE                                                                 \
    "material pane { color: white, transmission: 1, roughness: 0, ior: 1,\n" \
    "                absorption: [loss, loss, loss] }\n"                     \
    "show box([80, thick, 80]).paint(pane);\n"

static void glass_has_what_stands_behind_it(void **state)
{
    (void)state;
    static const char *const texts[]  = {SLAB PANE FILL, SLAB FILL PANE};
    const double             dense[2] = {1.5, 0};
    size_t                   wrong    = 0;
    for (size_t i = 0; i < 2; i++) {
        PathFixture fixture = path_fixture_open(texts[i]);
        path_fixture_set(&fixture, "dense", 1.5);
        path_fixture_set(&fixture, "loss", 0.7);
        wrong += !must_be_near(look_with_bounces(&fixture, 4), exp(-0.7 - dense[i]), 0.004,
                               i ? "glass in a medium" : "a medium in glass");
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* ---- Furnaces ---- */

static void media_that_absorb_nothing_are_not_seen(void **state)
{
    (void)state;
#define WHITE                                                              \
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2 }\n" \
    "sky { zenith: white, horizon: white, ground: white }\n"               \
    "light none { direction: [0, 1, 0], color: black }\n"
    static const struct {
        const char *name, *text;
    } furnaces[] = {
        {"a ball of mist", WHITE "medium { within: sphere(1), density: 3, anisotropy: 0.6 }\n"
                                 "show sphere(1).move([0, -90, 0]);\n"},
        {"a cloud with a white ball in it",
         WHITE "medium { within: sphere(1), density: 6 * max(fbm(3 * p, 4) + 0.2, 0) }\n"
               "material chalk { color: white, specular: 0 }\n"
               "show sphere(0.4).paint(chalk);\n"},
        {"mist in mist, which add up",
         WHITE "medium { within: sphere(1), density: 1, anisotropy: -0.4 }\n"
               "medium { within: box([1, 1, 1]), density: 5, anisotropy: 0.8 }\n"
               "show sphere(1).move([0, -90, 0]);\n"},
        {"mist in glass",
         WHITE "material glass { color: white, transmission: 1, roughness: 0, ior: 1.3 }\n"
               "show sphere(0.9).paint(glass);\n"
               "medium { within: sphere(0.8), density: 3 }\n"},
    };
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof furnaces / sizeof *furnaces; i++) {
        PathFixture fixture = path_fixture_open(furnaces[i].text);
        wrong += !must_be_near(look_with_bounces(&fixture, 400), 1, 0.002, furnaces[i].name);
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* ---- Media that differ from place to place ---- */

static const char waves[] =
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2 }\n"
    "sky { zenith: white, horizon: [0.2, 0.2, 0.2], ground: black }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "medium { within: sphere(1), scatter: 0.9,\n"
    "         density: 5 * max(sin(4 * x) * sin(5 * y + 1) + cos(3 * z), 0) }\n"
    "show sphere(1).move([0, -90, 0]);\n";

static double density_of_waves(const double p[3])
{
    const double inside = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < 1;
    return inside ? 5 * fmax(sin(4 * p[0]) * sin(5 * p[1] + 1) + cos(3 * p[2]), 0) : 0;
}

static double sky_of_waves(double rise)
{
    const double left = 1 - fmax(rise, 0), above = 1 + (0.2 - 1) * left * left * left;
    const double low = fmin(fmax(-rise / 0.25, 0), 1), ground = low * low * (3 - 2 * low);
    return above * (1 - ground);
}

/* Follows a path in small steps, up to where the way has as much of the medium as a random number says. */
static double follow(uint64_t *seed, int bounces)
{
    const double step = 0.01;
    double       p[3] = {2 * splitmix_unit(seed) - 1, 2 * splitmix_unit(seed) - 1, 1};
    double       d[3] = {0, 0, -1}, weight = 1;
    for (int bounce = 0; bounce <= bounces; bounce++) {
        double depth = -log(1 - splitmix_unit(seed)), way = 0, middle[3];
        for (; way < 4 && depth > 0; way += step) {
            for (int k = 0; k < 3; k++)
                middle[k] = p[k] + (way + 0.5 * step) * d[k];
            depth -= step * density_of_waves(middle);
        }
        if (depth > 0)
            return weight * sky_of_waves(d[1]);
        for (int k = 0; k < 3; k++)
            p[k] = middle[k];
        const double z = 2 * splitmix_unit(seed) - 1, turn = 2 * M_PI * splitmix_unit(seed);
        d[0] = sqrt(1 - z * z) * cos(turn);
        d[1] = sqrt(1 - z * z) * sin(turn);
        d[2] = z;
        weight *= 0.9;
    }
    return 0;
}

static void waves_are_as_walks_in_small_steps(void **state)
{
    (void)state;
    enum { WALKS = 60000, PARTS = 6, BOUNCES = 30 };
    PathFixture fixture = path_fixture_open(waves);
    Estimate    found = look_with_bounces(&fixture, BOUNCES), expected = {0};
    uint64_t    seed = 7;
    for (int part = 0; part < PARTS; part++) {
        double sum = 0;
        for (int i = 0; i < WALKS / PARTS; i++)
            sum += follow(&seed, BOUNCES);
        estimate_add(&expected, sum / (WALKS / PARTS));
    }
    found.error = hypot(found.error, expected.error);
    assert_true(must_be_near(found, expected.mean, 0.002, "waves"));
    path_fixture_close(&fixture);
}

/* ---- Bounds ---- */

/* Looks for a point where a density is beyond the bounds of its cell, as shaders find the cell.  Returns
   whether there is one. */
static bool find_counterexample(KrsState *state, const KrsVolume *volume, const float (*bounds)[2],
                                double point[3])
{
    enum { POINTS = 100000 };
    uint64_t seed = 3;
    for (int i = 0; i < POINTS; i++) {
        size_t at = 0;
        for (int k = 2; k >= 0; k--) {
            const double place = splitmix_unit(&seed);
            point[k]           = volume->low[k] + place * (volume->high[k] - volume->low[k]);
            at                 = at * volume->cells[k] + (size_t)(place * volume->cells[k]);
        }
        const double density = krs_state_density(state, 0, point);
        if (density < (double)bounds[at][0] || density > (double)bounds[at][1])
            return true;
    }
    return false;
}

static void densities_are_within_their_bounds(void **state)
{
    (void)state;
    static const char *const densities[] = {
        "5 * max(sin(4 * x) * sin(5 * y + 1) + cos(3 * z), 0)",
        "many * max(fbm(3 * p, 5) + 0.1, 0)",
        "if x > 0.1 then exp(2 * y) else smoothstep(0, 1, z)",
        "max(noise(6 * p) * noise(2 * p + 4), 0) * 40",
        "3",
    };
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof densities / sizeof *densities; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "param many = 2 in [0, 90]; show sphere(1);\n"
                 "medium { within: ellipsoid([1, 0.5, 2]), density: %s }\n",
                 densities[i]);
        Product   product = product_compile(text);
        KrsVolume volume  = krs_scene_volume(product.scene, 0);
        size_t    cells   = (size_t)volume.cells[0] * volume.cells[1] * volume.cells[2];
        float(*bounds)[2] = calloc(cells, sizeof *bounds);
        double point[3], sum = 0;
        assert_true(cells > 4000 && cells <= KRS_MAX_VOLUME_CELLS);
        assert_int_equal(krs_state_volume(product.state, 0, bounds), KRS_OK);
        if (find_counterexample(product.state, &volume, (const float(*)[2])bounds, point)) {
            print_message("# `%s` is beyond its bounds at [%g, %g, %g]\n", densities[i], point[0],
                          point[1], point[2]);
            wrong++;
        }
        for (size_t k = 0; k < cells; k++) {
            sum += (double)bounds[k][1];
            bounds[k][1] *= 0.2f;
        }
        assert_true(sum / (double)cells < 60); /* those of the ellipsoid are of some use */
        assert_true(find_counterexample(product.state, &volume, (const float(*)[2])bounds, point));
        free(bounds);
        product_free(&product);
    }
    assert_int_equal(wrong, 0);
}

/* ---- Parts of pictures ---- */

static void crops_are_parts_of_pictures(void **state)
{
    (void)state;
    PathFixture      fixture = path_fixture_open(waves);
    KrsRenderOptions whole = paths, part = paths;
    whole.bounces = part.bounces = 6;
    part.crop                    = (KrsWindow){19, 7, 30, 41};
    part.methods.steps_at_once   = 16;
    KrsPicture *a                = path_fixture_render(&fixture, &whole),
               *b                = path_fixture_render(&fixture, &part);
    for (uint32_t y = 0; y < part.crop.height; y++)
        assert_memory_equal(b->color + (size_t)4 * y * part.crop.width,
                            a->color + 4 * ((size_t)(part.crop.y + y) * a->width + part.crop.x),
                            4 * part.crop.width * sizeof *a->color);
    krs_picture_free(a);
    krs_picture_free(b);
    path_fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slabs_absorb_and_send),
        cmocka_unit_test(slabs_scatter_once),
        cmocka_unit_test(lamps_shine_through_mist),
        cmocka_unit_test(glass_has_what_stands_behind_it),
        cmocka_unit_test(media_that_absorb_nothing_are_not_seen),
        cmocka_unit_test(waves_are_as_walks_in_small_steps),
        cmocka_unit_test(densities_are_within_their_bounds),
        cmocka_unit_test(crops_are_parts_of_pictures),
    };
    return cmocka_run_group_tests_name("volumes", tests, renderer_open, renderer_close);
}
