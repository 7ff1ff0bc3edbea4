/*
 * surroundings.c: fog, and the studio of scenes that have neither lights nor a sky.
 *
 * What fog lets through is computed here: its density, summed up in small steps along each ray.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/renderer.h"

enum { WIDTH = 48, HEIGHT = 32, STEPS = 4000 };
#define EYE_HEIGHT 1.5
#define BEYOND     400.0 /* the fog behind it counts no more: in these scenes it is that dense or low */
#define TOLERANCE  1e-4

/* A floor, a ball and nothing behind them; all light is emitted. */
#define SCENE                                                                              \
    "camera { eye: [0, 1.5, 6], target: [0, 1.2, 0], fov: 50deg }\n"                       \
    "light dark { direction: [0, 1, 0], intensity: 0, shadow: false }\n"                   \
    "sky { zenith: [0.2, 0.3, 0.8], horizon: [0.9, 0.6, 0.3], ground: [0.1, 0.2, 0.1] }\n" \
    "material lamp { color: [0, 0, 0], emission: [0.9, 0.5, 0.2], roughness: 1 }\n"        \
    "show sphere(1).move([0, 1, 0]).paint(lamp);\n"                                        \
    "show plane([0, 1, 0], -0.3).paint(lamp);\n"

typedef struct Fog {
    const char *text;
    double      color[3], density, height, base; /* height 0: the same everywhere */
} Fog;

static double density_at(const Fog *fog, double height)
{
    return fog->density * (fog->height > 0 ? exp(-(height - fog->base) / fog->height) : 1);
}

/* What is left of light after a length t of a ray, by the midpoint rule. */
static double left_after(const Fog *fog, double from, double rise, double t)
{
    double depth = 0;
    for (int i = 0; i < STEPS; i++)
        depth += density_at(fog, from + rise * t * (i + 0.5) / STEPS) * t / STEPS;
    return exp(-depth);
}

/* Returns the unit direction of a pixel's ray, as the camera's properties say. */
static double rise_of_pixel(uint32_t x, uint32_t y)
{
    double target[3] = {0, -0.3, -6}, length = hypot(6, 0.3), half = tan(25 * M_PI / 180);
    double right     = half * WIDTH / HEIGHT * (2 * (x + 0.5) / WIDTH - 1);
    double up        = half * (1 - 2 * (y + 0.5) / HEIGHT);
    double forward_y = target[1] / length, up_y = 6 / length;
    return (forward_y + up * up_y) / sqrt(1 + right * right + up * up);
}

static double worst_of(const Fog *fog, const Fog *supposed)
{
    char             text[1024];
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .no_occlusion = true};
    KrsPicture *clear = picture_of(SCENE, &options);
    snprintf(text, sizeof text, SCENE "%s", fog->text);
    KrsPicture *foggy = picture_of(text, &options);
    double      worst = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *point = foggy->position + 3 * i;
        bool         hit   = foggy->component[i] > 0;
        double       t = hit ? hypot(hypot(point[0], point[1] - EYE_HEIGHT), point[2] - 6) : BEYOND;
        double left    = left_after(supposed, EYE_HEIGHT, rise_of_pixel(i % WIDTH, i / WIDTH), t);
        for (int k = 0; k < 3; k++) {
            double want = clear->color[4 * i + k] * left + supposed->color[k] * (1 - left);
            worst       = fmax(worst, fabs(foggy->color[4 * i + k] - want));
        }
    }
    krs_picture_free(clear);
    krs_picture_free(foggy);
    return worst;
}

static const Fog fogs[] = {
    {"", {0, 0, 0}, 0, 0, 0},
    {"fog { color: [0.5, 0.6, 0.7], density: 0.1 }", {0.5, 0.6, 0.7}, 0.1, 0, 0},
    {"fog { color: [0.5, 0.6, 0.7], density: 0.3, height: 0.5 }", {0.5, 0.6, 0.7}, 0.3, 0.5, 0},
    {"fog { color: [1, 0, 0], density: 0.2, height: 2, base: 1 }", {1, 0, 0}, 0.2, 2, 1}};

static void fog_takes_light_by_its_density(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof fogs / sizeof *fogs; i++) {
        double worst = worst_of(&fogs[i], &fogs[i]);
        printf("# %s: %g\n", fogs[i].text, worst);
        assert_true(worst < TOLERANCE);
    }
    Fog other    = fogs[2]; /* the comparison finds a fog that is a little higher */
    other.height = 0.55;
    assert_true(worst_of(&fogs[2], &other) > TOLERANCE);
}

/* ---- The studio ---- */

static size_t shown_in_studio(const char *text, bool studio, const char **last)
{
    static char  name[32];
    KrsOptions   options = {.studio = studio};
    KrsScene    *scene;
    KrsComponent component = {0};
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &scene), KRS_OK);
    size_t count = krs_component_count(scene);
    assert_int_equal(krs_component(scene, count - 1, &component), KRS_OK);
    snprintf(name, sizeof name, "%s", component.name);
    krs_scene_free(scene);
    *last = name;
    return count;
}

static void bounded_scenes_get_a_floor(void **state)
{
    static const struct {
        const char *text;
        bool        floor;
    } scenes[] = {{"show sphere(1);", true},
                  {"show sphere(1); camera { eye: [0, 2, 5] }", true},
                  {"show sphere(1); camera { eye: [0, -2, 5] }", false},
                  {"show sphere(1); light { direction: [0, 1, 0] }", false},
                  {"show sphere(1); sky { zenith: #000000 }", false},
                  {"show sphere(1); show plane([0, 1, 0], -1);", false}};
    const char *last;
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        size_t alone = shown_in_studio(scenes[i].text, false, &last);
        assert_string_not_equal(last, "floor");
        assert_int_equal(shown_in_studio(scenes[i].text, true, &last), alone + scenes[i].floor);
        assert_int_equal(strcmp(last, "floor") == 0, scenes[i].floor);
    }
}

/* Rays of a level orthographic picture begin above the floor, however high the picture is. */
static void level_views_begin_above_the_floor(void **state)
{
    static const struct {
        const char *camera;
        bool        above;
    } cameras[] = {
        {"camera { eye: [0, 0, 20], projection: \"orthographic\", height: 4 }", true},
        {"camera { eye: [0, 5, 20], target: [0, 5, 0], projection: \"orthographic\", height: 40 }",
         true},
        {"camera { eye: [0, 3, 20], projection: \"orthographic\", height: 4 }", false},
        {"camera { eye: [0, 0, 20] }", false}};
    const KrsOptions options = {.studio = true};
    (void)state;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        char         text[160];
        KrsScene    *scene;
        KrsState    *values;
        const double lowest[][3] = {{0, i == 1 ? -15 : -2, 20}};
        double       distance;
        snprintf(text, sizeof text, "show sphere(1); %s", cameras[i].camera);
        assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &scene),
                         KRS_OK);
        assert_int_equal(krs_state_new(scene, &values), KRS_OK);
        assert_int_equal(krs_distance(values, lowest, 1, &distance), KRS_OK);
        assert_int_equal(distance > 0, cameras[i].above);
        krs_state_free(values);
        krs_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(fog_takes_light_by_its_density),
                                       cmocka_unit_test(bounded_scenes_get_a_floor),
                                       cmocka_unit_test(level_views_begin_above_the_floor)};
    return cmocka_run_group_tests_name("surroundings", tests, renderer_open, renderer_close);
}
