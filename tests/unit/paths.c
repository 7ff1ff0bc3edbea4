/*
 * paths.c: how the work on paths is dealt out to the device is not seen in pictures: schedules,
 * crops, bands and slices do not change a bit of any plane.  All of it under the validation layers.
 * And which integrator takes them, and how often they bounce.
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
#include "tests/unit/traced_scenes.h"

/* All kinds of materials and lights, a plane, and a solid in which paths bounce, with a solid and
   with water in it. */
static Scene still = {
    .name = "glass and metal",
    .fov  = 0.7,
    .text = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }\n"
            "light sun { direction: [1, 2, 1], softness: 8deg, intensity: 2 }\n"
            "light lamp { position: [-1.5, 2.5, 1], radius: 0.3, intensity: 3 }\n"
            "light point { position: [2, 3, 0], intensity: 2 }\n"
            "material glass { color: white, transmission: 1, roughness: 0.2, absorption: [1, 0.2, "
            "2] }\n"
            "material metal { color: gold, metallic: 1, roughness: 0.3, coat: 0.5 }\n"
            "material cloth { color: navy, sheen: [0.5, 0.5, 0.6], emission: [0, 0.1, 0] }\n"
            "show sphere(0.8).move([0, 0.8, 0]).paint(glass);\n"
            "material water { color: white, transmission: 1, roughness: 0.2, ior: 1.33 }\n"
            "show sphere(0.3).move([0.7, 0.8, 0.3]).paint(water);\n"
            "show sphere(0.3).move([-0.1, 0.7, 0.3]).paint(metal);\n"
            "show box([0.9, 1.4, 0.9]).move([-1.4, 0.7, -0.6]).paint(metal);\n"
            "show torus(0.5, 0.2).move([1.3, 0.2, 0.6]).paint(cloth);\n"
            "show plane([0, 1, 0], 0);\n"};

/* A sky that is chosen by its brightness, in a scene that ends. */
static Scene daylight = {
    .name = "daylight",
    .fov  = 0.7,
    .text = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }\n"
            "light sun { direction: [1, 0.4, 1], softness: 1deg, intensity: 2 }\n"
            "sky { sun: sun, turbidity: 3 }\n"
            "material metal { color: gold, metallic: 1, roughness: 0.3,\n"
            "                 specular_roughness_anisotropy: 0.7 }\n"
            "material lamp { color: black, emission: [9, 8, 6] }\n"
            "material wax { subsurface_weight: 1, subsurface_radius: [0.2, 0.1, 0.05] }\n"
            "show sphere(0.8).move([0, 0.8, 0]).paint(metal);\n"
            "show sphere(0.3).move([-0.9, 0.3, 1]).paint(wax);\n"
            "show sphere(0.2).move([1.2, 0.4, 0.6]).paint(lamp);\n"
            "show box([9, 1, 9]).move([0, -0.5, 0]);\n"};

static KrsRenderOptions usual(void)
{
    return (KrsRenderOptions){.width            = SMALL_WIDTH,
                              .height           = SMALL_HEIGHT,
                              .samples          = 2,
                              .bounces          = 6,
                              .integrator       = KRS_INTEGRATOR_PATH,
                              .methods.schedule = KRS_SCHEDULE_PIXEL};
}

static int open_still(void **state) { return open_watched(state) || open_scene(&still) != KRS_OK; }

static int close_still(void **state)
{
    close_scene(&still);
    return close_watched(state);
}

static void schedules_are_not_seen(void **state)
{
    (void)state;
    KrsRenderOptions options = usual();
    KrsPicture      *whole   = render_scene(&still, options);
    size_t           wrong   = 0;
    for (KrsSchedule schedule = 0; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        options.methods.schedule = schedule;
        wrong += !is_part_of(&still, whole, render_scene(&still, options), words(&options));
    }
    assert_int_equal(wrong, 0);
    krs_picture_free(whole);
}

static void crops_are_not_seen(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {
        {33, 17, 41, 30}, {1, 2, 7, 5}, {51, 31, 49, 39}, {0, 69, 100, 1}, {99, 0, 1, 70}};
    KrsRenderOptions options = usual();
    size_t           wrong   = 0;
    for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        options.methods.schedule = schedule;
        options.crop             = (KrsWindow){0};
        KrsPicture *whole        = render_scene(&still, options);
        for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
            options.crop = crops[i];
            wrong += !is_part_of(&still, whole, render_scene(&still, options), words(&options));
        }
        krs_picture_free(whole);
    }
    assert_int_equal(wrong, 0);
}

static void crops_and_slices_of_daylight_are_not_seen(void **state)
{
    (void)state;
    assert_int_equal(open_scene(&daylight), KRS_OK);
    KrsRenderOptions options      = usual();
    KrsPicture      *whole        = render_scene(&daylight, options);
    options.crop                  = (KrsWindow){33, 17, 41, 30};
    options.methods.steps_at_once = 64;
    options.methods.schedule      = KRS_SCHEDULE_REFILL;
    bool same = is_part_of(&daylight, whole, render_scene(&daylight, options), words(&options));
    krs_picture_free(whole);
    close_scene(&daylight);
    assert_true(same);
}

static void slices_are_not_seen(void **state)
{
    (void)state;
    static const struct {
        uint32_t  steps_at_once;
        double    slice_ms;
        KrsWindow crop; /* the shortest slices take long */
    } slices[]   = {{3, 1e6, {0}}, {8192, 1e6, {0}}, {512, 1e-3, {40, 30, 20, 20}}};
    size_t wrong = 0;
    for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        KrsRenderOptions options = usual();
        options.methods.schedule = schedule;
        KrsPicture *whole        = render_scene(&still, options);
        for (size_t i = 0; i < sizeof slices / sizeof slices[0]; i++) {
            options.methods.steps_at_once = slices[i].steps_at_once;
            options.slice_ms              = slices[i].slice_ms;
            options.crop                  = slices[i].crop;
            wrong += !is_part_of(&still, whole, render_scene(&still, options), words(&options));
        }
        krs_picture_free(whole);
    }
    assert_int_equal(wrong, 0);
}

/* A picture too large for one band, and parts of it that are in other bands when alone. */
static void bands_are_not_seen(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {{0, 400, 1000, 30}, {3, 500, 900, 9}, {490, 0, 13, 600}};
    KrsRenderOptions       options = {
              .width = 1000, .height = 600, .bounces = 2, .integrator = KRS_INTEGRATOR_PATH};
    KrsPicture *whole = render_scene(&still, options);
    size_t      wrong = 0;
    for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
        options.crop = crops[i];
        wrong += !is_part_of(&still, whole, render_scene(&still, options), words(&options));
    }
    krs_picture_free(whole);
    assert_int_equal(wrong, 0);
}

/* The comparison of planes sees a single bit. */
static void a_flipped_bit_is_found(void **state)
{
    (void)state;
    KrsRenderOptions options = usual();
    KrsPicture      *whole   = render_scene(&still, options), *part;
    uint32_t         bits;
    options.crop = (KrsWindow){40, 30, 20, 20};
    part         = render_scene(&still, options);
    memcpy(&bits, &part->color[4 * 210], sizeof bits);
    bits ^= 1;
    memcpy(&part->color[4 * 210], &bits, sizeof bits);
    assert_false(is_part_of(&still, whole, part, "a planted fault"));
    krs_picture_free(whole);
}

/* ---- Films ---- */

static KrsFilm *new_film(const KrsRenderOptions *options)
{
    KrsFilm *film;
    assert_int_equal(krs_film_new(still.rendering, options, &film), KRS_OK);
    return film;
}

static KrsPicture *read_and_free(KrsFilm *film)
{
    KrsPicture *picture;
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    krs_film_free(film);
    return picture;
}

static void portions_are_the_whole(void **state)
{
    (void)state;
    KrsRenderOptions options = usual();
    options.samples          = 3;
    KrsPicture *whole        = render_scene(&still, options);
    KrsFilm    *film         = new_film(&options);
    assert_int_equal(krs_film_add(film, still.state, NULL, 1), KRS_OK);
    assert_int_equal(krs_film_add(film, still.state, NULL, 2), KRS_OK);
    assert_true(is_part_of(&still, whole, read_and_free(film), "two portions"));
    krs_picture_free(whole);
}

/* Rays of a list that are those of a camera that looks along z; its rays are rounded otherwise, so
   paths that meet an edge differ. */
static void rays_of_lists_show_the_same(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    static double    origins[SIDE * SIDE][3], directions[SIDE * SIDE][3];
    const KrsCamera  camera  = {.projection = KRS_ORTHOGRAPHIC,
                                .eye        = {0, 1, 8},
                                .target     = {0, 1, 0},
                                .up         = {0, 1, 0},
                                .height     = 3};
    KrsRenderOptions options = {
        .width = SIDE, .height = SIDE, .samples = 1, .integrator = KRS_INTEGRATOR_PATH};
    for (int k = 0; k < SIDE * SIDE; k++) {
        origins[k][0]    = 3 * ((k % SIDE + 0.5) / SIDE - 0.5);
        origins[k][1]    = 1 - 3 * ((k / SIDE + 0.5) / SIDE - 0.5);
        origins[k][2]    = 8;
        directions[k][2] = -1;
    }
    const KrsRays rays = {.origins    = (const double(*)[3])origins,
                          .directions = (const double(*)[3])directions,
                          .width      = 3.0 / SIDE};
    KrsFilm      *seen = new_film(&options), *listed = new_film(&options);
    assert_int_equal(krs_film_add(seen, still.state, &camera, 1), KRS_OK);
    assert_int_equal(krs_film_add_rays(listed, still.state, &rays), KRS_OK);
    KrsPicture *a = read_and_free(seen), *b = read_and_free(listed);
    size_t      differ = 0;
    for (size_t k = 0; k < SIDE * SIDE; k++)
        differ += fabsf(a->color[4 * k] - b->color[4 * k]) > 1e-3f;
    assert_in_range(differ, 0, SIDE * SIDE / 25);
    krs_picture_free(a);
    krs_picture_free(b);
}

/* ---- Interruption, and what is no number ---- */

static bool count_down(void *user, double done)
{
    int *left = user;
    assert_true(done >= 0 && done <= 1 + 1e-9);
    return --*left >= 0;
}

/* Wherever it is interrupted, the next picture is whole. */
static void interruption_is_heard(void **state)
{
    (void)state;
    KrsRenderOptions options = usual();
    KrsPicture      *whole   = render_scene(&still, options), *picture;
    int              left;
    options.progress = count_down;
    options.user     = &left;
    for (int calls = 0; calls < 40; calls += 5) {
        left = calls;
        assert_int_equal(krs_render(still.rendering, still.state, &options, &picture),
                         KRS_INTERRUPTED);
        assert_null(picture);
    }
    left = 1 << 30;
    assert_true(is_part_of(&still, whole, render_scene(&still, options), "an interruption"));
    krs_picture_free(whole);
}

/* Properties that are infinite, or no numbers, give light all the same. */
static void materials_give_numbers(void **state)
{
    (void)state;
    Scene strange = {
        .name = "strange materials",
        .text = "param k = 0;\n"
                "material m { color: [1 / (k * x), (k * x) / (k * y), sqrt(-x * x)],\n"
                "    roughness: (k * z) / (k * x), metallic: sqrt(x), ior: 1 / (k * y),\n"
                "    transmission: log(y), absorption: x / k, coat: 1 / (k * z),\n"
                "    coat_roughness: sqrt(y), sheen: x / k, sheen_roughness: log(x),\n"
                "    specular: 1 / (k * x), specular_roughness_anisotropy: log(y),\n"
                "    tangent: [sqrt(x), 1 / (k * y), x], subsurface_weight: sqrt(z),\n"
                "    subsurface_color: log(x), subsurface_radius: 1 / (k * x) }\n"
                "material n { emission: [exp(1000 * y), sqrt(x), 1 / (k * x)] }\n"
                "camera { eye: [0, 1, 6] }\n"
                "light lamp { position: [2, 3, 2], radius: 0.5 }\n"
                "show sphere(1).paint(m);\n"
                "show sphere(0.5).paint(n).move([2, 0, 0]);\n"
                "show plane([0, 1, 0], -1);\n"};
    assert_int_equal(open_scene(&strange), KRS_OK);
    KrsPicture *picture = render_scene(&strange, usual());
    size_t      wrong   = 0;
    for (size_t i = 0; i < (size_t)4 * SMALL_WIDTH * SMALL_HEIGHT; i++)
        wrong += !(picture->color[i] >= 0 && picture->color[i] < 3e38f);
    assert_int_equal(wrong, 0);
    krs_picture_free(picture);
    close_scene(&strange);
}

/* ---- Updates ---- */

/* A rendering that is taken over to another scene shows what a new one does. */
static void updates_are_followed(void **state)
{
    (void)state;
    static const char form[] = "camera { eye: [0, 1, 6] }\n"
                               "light lamp { position: [2, 3, 2], radius: 0.5, intensity: 5 }\n"
                               "material m { color: %s, transmission: %g, roughness: 0.1 }\n"
                               "show sphere(1).paint(m); show plane([0, 1, 0], -1);\n";
    char              texts[2][400];
    snprintf(texts[0], sizeof texts[0], form, "white", 1.0);
    snprintf(texts[1], sizeof texts[1], form, "tomato", 0.0);
    Scene before = {.name = "before", .text = texts[0]},
          after  = {.name = "after", .text = texts[1]};
    assert_int_equal(open_scene(&before), KRS_OK);
    assert_int_equal(open_scene(&after), KRS_OK);
    krs_picture_free(render_scene(&before, usual()));
    assert_int_equal(krs_rendering_update(before.rendering, after.scene), KRS_OK);
    KrsPicture *fresh   = render_scene(&after, usual());
    Scene       updated = {.name = "updated", .rendering = before.rendering, .state = after.state};
    assert_true(is_part_of(&after, fresh, render_scene(&updated, usual()), "an update"));
    krs_picture_free(fresh);
    close_scene(&before);
    close_scene(&after);
}

/* ---- Choices ---- */

static bool is_same(const Scene *scene, KrsRenderOptions a, KrsRenderOptions b)
{
    KrsPicture *left = render_scene(scene, a);
    bool        same = is_part_of(scene, left, render_scene(scene, b), "a choice");
    krs_picture_free(left);
    return same;
}

/* Nothing that is asked for is preview; what a scene says holds where the caller says nothing. */
static void integrators_are_chosen(void **state)
{
    (void)state;
    Scene            path    = {.name = "by the scene",
                                .text = "image { integrator: \"path\", samples: 2 }\n"
                                                      "camera { eye: [0, 1, 4] }\n"
                                                      "show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);"};
    KrsRenderOptions nothing = {.width = 40, .height = 30, .samples = 2}, options = nothing;
    assert_int_equal(open_scene(&path), KRS_OK);
    for (KrsIntegrator i = 1; i < KRS_INTEGRATOR_COUNT; i++) {
        options.integrator = i;
        assert_int_equal(is_same(&still, nothing, options), i == KRS_INTEGRATOR_PREVIEW);
        assert_int_equal(is_same(&path, nothing, options), i == KRS_INTEGRATOR_PATH);
    }
    close_scene(&path);
}

/* What is seen first does not depend on how light is found, but for the colour.  Hits of `preview` may be as far from
   the surface as is permitted, others are as near as rounding lets them be. */
static void other_planes_are_the_same(void **state)
{
    (void)state;
    enum { SMALL_PIXELS = SMALL_WIDTH * SMALL_HEIGHT };
    const double     permitted = 0.01; /* a part of the depth: less than half of a pixel */
    KrsRenderOptions options   = usual();
    KrsPicture      *whole     = render_scene(&still, options);
    options.integrator         = KRS_INTEGRATOR_PREVIEW;
    KrsPicture *preview        = render_scene(&still, options);
    assert_memory_equal(preview->component, whole->component, sizeof(uint32_t) * SMALL_PIXELS);
    assert_memory_equal(preview->level, whole->level, sizeof(uint32_t) * SMALL_PIXELS);
    assert_memory_equal(preview->instance, whole->instance, sizeof(uint32_t) * SMALL_PIXELS);
    for (int i = 0; i < SMALL_PIXELS; i++)
        if (preview->component[i] != 0)
            assert_true(fabs((double)preview->depth[i] / (double)whole->depth[i] - 1) < permitted);
    krs_picture_free(preview);

    options.integrator = KRS_INTEGRATOR_DIRECT;
    KrsPicture *direct = render_scene(&still, options);
    memcpy(direct->color, whole->color, sizeof(float) * 4 * SMALL_PIXELS);
    assert_true(is_part_of(&still, whole, direct, "direct"));
    krs_picture_free(whole);
}

/* Ten are the default.  `direct` counts none: it goes through glass, which one bounce does not. */
static void bounces_are_counted(void **state)
{
    (void)state;
    KrsRenderOptions options = {.width      = 60,
                                .height     = 40,
                                .samples    = 2,
                                .integrator = KRS_INTEGRATOR_PATH},
                     other   = options;
    other.bounces            = KRS_DEFAULT_BOUNCES;
    assert_true(is_same(&still, options, other));
    other.bounces = 2;
    assert_false(is_same(&still, options, other));
    options.integrator = KRS_INTEGRATOR_DIRECT;
    assert_false(is_same(&still, options, other));
    other         = options;
    other.bounces = 2;
    assert_true(is_same(&still, options, other));
}

static void wrong_choices_are_refused(void **state)
{
    (void)state;
    const KrsRenderOptions wrong[] = {{.integrator = KRS_INTEGRATOR_COUNT},
                                      {.bounces = KRS_MAX_BOUNCES + 1}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        KrsPicture *picture;
        assert_int_equal(krs_render(still.rendering, still.state, &wrong[i], &picture),
                         KRS_BAD_ARGUMENT);
        assert_null(picture);
        assert_true(strlen(krs_renderer_message(watched_renderer)) > 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(schedules_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(crops_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(crops_and_slices_of_daylight_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(slices_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(bands_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(a_flipped_bit_is_found, hear_layers),
        cmocka_unit_test_teardown(portions_are_the_whole, hear_layers),
        cmocka_unit_test_teardown(rays_of_lists_show_the_same, hear_layers),
        cmocka_unit_test_teardown(interruption_is_heard, hear_layers),
        cmocka_unit_test_teardown(materials_give_numbers, hear_layers),
        cmocka_unit_test_teardown(updates_are_followed, hear_layers),
        cmocka_unit_test_teardown(integrators_are_chosen, hear_layers),
        cmocka_unit_test_teardown(other_planes_are_the_same, hear_layers),
        cmocka_unit_test_teardown(bounces_are_counted, hear_layers),
        cmocka_unit_test_teardown(wrong_choices_are_refused, hear_layers),
    };
    spirv_start(); /* held for all, so that the shader compiler is not started anew */
    int failed = cmocka_run_group_tests_name("paths", tests, open_still, close_still);
    spirv_stop();
    return failed;
}
