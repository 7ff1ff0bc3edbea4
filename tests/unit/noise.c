/*
 * noise.c: samples of a pixel end when its error is small.  The error that is left is about what was
 * asked for, against pictures of many samples; what sees only sky ends first; and which pixels go on
 * depends neither on crops and slices nor on the portions in which samples are added.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/unit/traced_scenes.h"

#define NOISE 0.05
enum { COARSE_WIDTH = 44, COARSE_HEIGHT = 32 };
#define assert_near(value, expected, within) assert_true(fabsf((value) - (expected)) <= (within))

/* A ball and a box under a large lamp, before a sky that is the same everywhere. */
static Scene lit = {
    .name = "under a lamp",
    .fov  = 0.7,
    .text = "camera { eye: [3, 2, 5], target: [0, 0.9, 0], fov: 0.7 }\n"
            "sky { zenith: [0.3, 0.4, 0.5], horizon: [0.3, 0.4, 0.5], ground: [0.3, 0.4, 0.5] }\n"
            "light lamp { position: [-1.5, 3.5, 1], radius: 0.6, intensity: 12 }\n"
            "material metal { color: gold, metallic: 1, roughness: 0.3 }\n"
            "show sphere(0.8).move([0, 0.8, 0]).paint(metal);\n"
            "show box([0.9, 1.4, 0.9]).move([-1.4, 0.7, -0.6]);\n"
            "show box([6, 0.2, 6]).move([0, -0.1, 0]);\n"};

static KrsRenderOptions usual(KrsIntegrator integrator)
{
    return (KrsRenderOptions){.width      = SMALL_WIDTH,
                              .height     = SMALL_HEIGHT,
                              .samples    = 64,
                              .bounces    = 2,
                              .noise      = NOISE,
                              .integrator = integrator,
                              .shadows    = KRS_SHADOWS_SOFT};
}

static int open_lit(void **state) { return open_watched(state) || open_scene(&lit) != KRS_OK; }

static int close_lit(void **state)
{
    close_scene(&lit);
    return close_watched(state);
}

/* ---- Which pixels go on ---- */

/* Crops, and slices that end within any pass, of an integrator. */
static size_t count_seen(KrsIntegrator integrator)
{
    static const KrsWindow crops[] = {{33, 17, 41, 30}, {51, 31, 49, 39}};
    KrsRenderOptions       options = usual(integrator);
    KrsPicture            *whole   = render_scene(&lit, options);
    size_t                 wrong   = 0;
    for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
        options.crop = crops[i];
        wrong += !is_part_of(&lit, whole, render_scene(&lit, options), words(&options));
    }
    options                       = usual(integrator);
    options.methods.steps_at_once = 3;
    options.methods.schedule      = KRS_SCHEDULE_QUEUE;
    options.crop                  = (KrsWindow){40, 24, 17, 9};
    wrong += !is_part_of(&lit, whole, render_scene(&lit, options), words(&options));
    krs_picture_free(whole);
    return wrong;
}

static void crops_and_slices_are_not_seen(void **state)
{
    (void)state;
    assert_int_equal(count_seen(KRS_INTEGRATOR_DIRECT), 0);
    assert_int_equal(count_seen(KRS_INTEGRATOR_PREVIEW), 0);
}

static KrsFilm *new_film(const KrsRenderOptions *options)
{
    KrsFilm *film;
    assert_int_equal(krs_film_new(lit.rendering, options, &film), KRS_OK);
    return film;
}

static void add(KrsFilm *film, uint32_t samples)
{
    assert_int_equal(krs_film_add(film, lit.state, NULL, samples), KRS_OK);
}

/* In portions, and by turns with another film, which takes the buffers. */
static void portions_are_the_whole(void **state)
{
    (void)state;
    static const uint32_t portions[] = {3, 14, 1, 21, 25};
    KrsRenderOptions      options = usual(KRS_INTEGRATOR_DIRECT), others = {.samples = 1};
    options.crop   = (KrsWindow){30, 10, 50, 50};
    options.mattes = true;
    others.width = others.height = 32;
    KrsPicture *whole            = render_scene(&lit, options), *picture;
    KrsFilm    *film = new_film(&options), *other = new_film(&others);
    for (size_t i = 0; i < sizeof portions / sizeof portions[0]; i++) {
        add(film, portions[i]);
        if (i % 2 == 1)
            add(other, 1);
    }
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        assert_memory_equal(whole->mattes[kind], picture->mattes[kind],
                            sizeof(KrsMatte) * KRS_MATTE_RANKS * 50 * 50);
    assert_true(is_part_of(&lit, whole, picture, "portions"));
    krs_picture_free(whole);
    krs_film_free(film);
    krs_film_free(other);
}

/* All rays of a pixel are in its mattes, and no more. */
static void mattes_count_the_samples(void **state)
{
    (void)state;
    KrsRenderOptions options = usual(KRS_INTEGRATOR_DIRECT);
    options.mattes           = true;
    KrsPicture *picture      = render_scene(&lit, options);
    for (size_t k = 0; k < (size_t)SMALL_WIDTH * SMALL_HEIGHT; k++) {
        uint32_t rays = 0;
        for (size_t rank = 0; rank < KRS_MATTE_RANKS; rank++)
            rays += picture->mattes[KRS_MATTE_COMPONENTS][KRS_MATTE_RANKS * k + rank].rays;
        assert_near((float)rays / (float)picture->pixel_samples[k], picture->color[4 * k + 3],
                    1e-5f);
    }
    krs_picture_free(picture);
}

/* ---- How noisy they are ---- */

static double square(double x) { return x * x; }

/* Returns the square of a pixel's error, relative as krs/vulkan.h says. */
static double error_of(const float *color, const float *truth)
{
    double squares = 0, mean = 0;
    for (int i = 0; i < 3; i++) {
        squares += square((double)color[i] - (double)truth[i]) / 3;
        mean += (double)truth[i] / 3;
    }
    return squares / square(mean + KRS_DEFAULT_NOISE_FLOOR);
}

typedef struct Errors {
    double true_squares, estimated_squares;
    size_t pixels, at_least, samples;
} Errors;

static Errors find_errors(const KrsPicture *picture, const KrsPicture *truth)
{
    Errors errors = {0};
    for (size_t k = 0; k < (size_t)picture->width * picture->height; k++) {
        const uint32_t samples = picture->pixel_samples[k];
        errors.samples += samples;
        errors.at_least += samples == KRS_MIN_NOISY_SAMPLES;
        if (samples == picture->samples)
            continue; /* it may not have reached the bound */
        errors.true_squares += error_of(&picture->color[4 * k], &truth->color[4 * k]);
        errors.estimated_squares += square((double)picture->noise[k]);
        errors.pixels++;
    }
    return errors;
}

/* Where samples have ended the error is below the bound, but not by far, and it is as estimated.
   Most pixels of a preview are less noisy after the least samples. */
static void check_errors(KrsIntegrator integrator, double least)
{
    KrsRenderOptions options = usual(integrator);
    options.width            = COARSE_WIDTH;
    options.height           = COARSE_HEIGHT;
    options.samples          = 256;
    KrsPicture *picture      = render_scene(&lit, options);
    options.noise            = 0;
    options.seed             = 5;
    options.samples          = 384;
    KrsPicture  *truth       = render_scene(&lit, options);
    const Errors errors      = find_errors(picture, truth);
    const double made        = sqrt(errors.true_squares / (double)errors.pixels),
                 estimated   = sqrt(errors.estimated_squares / (double)errors.pixels);
    print_message("true error %.4f, estimated %.4f, %.1f samples a pixel, %zu ended early\n", made,
                  estimated, (double)errors.samples / (COARSE_WIDTH * COARSE_HEIGHT),
                  errors.pixels);
    assert_true(made < NOISE && made > least * NOISE);
    assert_true(made < 1.5 * estimated && made > 0.5 * estimated);
    assert_true(errors.pixels > COARSE_WIDTH * COARSE_HEIGHT * 3 / 4);
    assert_true(errors.samples < COARSE_WIDTH * COARSE_HEIGHT * 256 / 2);
    assert_int_equal(picture->stats.rays, errors.samples);
    krs_picture_free(picture);
    krs_picture_free(truth);
}

static void errors_are_as_asked_for(void **state)
{
    (void)state;
    check_errors(KRS_INTEGRATOR_DIRECT, 0.3);
    check_errors(KRS_INTEGRATOR_PATH, 0.3);
    check_errors(KRS_INTEGRATOR_PREVIEW, 0.1);
}

/* The sky is the same everywhere; the box and the ball are far below the upper rows. */
static void sky_ends_first(void **state)
{
    (void)state;
    KrsRenderOptions options = usual(KRS_INTEGRATOR_DIRECT);
    options.crop             = (KrsWindow){0, 0, SMALL_WIDTH, 8};
    KrsPicture *picture      = render_scene(&lit, options);
    for (size_t k = 0; k < (size_t)SMALL_WIDTH * 8; k++) {
        assert_int_equal(picture->pixel_samples[k], KRS_MIN_NOISY_SAMPLES);
        assert_near(picture->noise[k], 0.0f, 1e-6f);
        assert_near(picture->color[4 * k + 2], 0.5f, 1e-5f);
    }
    krs_picture_free(picture);
}

/* Without a bound the plane has estimates, and no sample ends. */
static void estimates_alone_end_nothing(void **state)
{
    (void)state;
    KrsRenderOptions options = usual(KRS_INTEGRATOR_DIRECT);
    options.noise            = 0;
    options.aovs             = KRS_AOV_COLOR | KRS_AOV_NOISE;
    KrsPicture *estimated    = render_scene(&lit, options);
    options.aovs             = KRS_AOV_COLOR;
    KrsPicture *plain        = render_scene(&lit, options);
    assert_memory_equal(estimated->color, plain->color,
                        sizeof(float) * 4 * SMALL_WIDTH * SMALL_HEIGHT);
    size_t noisy = 0;
    for (size_t k = 0; k < (size_t)SMALL_WIDTH * SMALL_HEIGHT; k++) {
        assert_int_equal(estimated->pixel_samples[k], 64);
        noisy += estimated->noise[k] > (float)NOISE;
    }
    assert_in_range(noisy, 50, 3000);
    krs_picture_free(estimated);
    krs_picture_free(plain);
}

/* What the scene says holds where the caller says nothing; its exposure moves the floor. */
static void scenes_may_ask_for_it(void **state)
{
    (void)state;
    Scene                  scene   = {.name = "by the scene",
                                      .text = "image { noise: 0.1, exposure: 2, samples: 32 }\n"
                                                                 "camera { eye: [0, 1, 4] } show sphere(1).move([0, 1, 0]);"};
    const KrsRenderOptions nothing = {.width = 40, .height = 30};
    KrsRenderOptions       same = nothing, wrong = nothing;
    assert_int_equal(open_scene(&scene), KRS_OK);
    KrsPicture *picture = render_scene(&scene, nothing);
    same.noise          = 0.1;
    same.noise_floor    = KRS_DEFAULT_NOISE_FLOOR / 4;
    same.samples        = 32;
    assert_int_equal(picture->pixel_samples[0], KRS_MIN_NOISY_SAMPLES);
    assert_true(is_part_of(&scene, picture, render_scene(&scene, same), "the scene's noise"));
    krs_picture_free(picture);
    wrong.noise = -1;
    assert_int_equal(krs_render(scene.rendering, scene.state, &wrong, &picture), KRS_BAD_ARGUMENT);
    close_scene(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(crops_and_slices_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(portions_are_the_whole, hear_layers),
        cmocka_unit_test_teardown(mattes_count_the_samples, hear_layers),
        cmocka_unit_test_teardown(errors_are_as_asked_for, hear_layers),
        cmocka_unit_test_teardown(sky_ends_first, hear_layers),
        cmocka_unit_test_teardown(estimates_alone_end_nothing, hear_layers),
        cmocka_unit_test_teardown(scenes_may_ask_for_it, hear_layers),
    };
    spirv_start(); /* held for all, so that the shader compiler is not started anew */
    int failed = cmocka_run_group_tests_name("noise", tests, open_lit, close_lit);
    spirv_stop();
    return failed;
}
