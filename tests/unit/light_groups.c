/*
 * light_groups.c: the light of each light by itself is what that light makes alone, all together are
 * the picture, and neither crops nor portions change them.
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

enum { LIGHTS = 5 };

/* Two suns, of which one is seen, two lamps and a panel, in fog; mirrors, glass and what glows. */
static Scene lit = {
    .name = "five lights",
    .fov  = 0.7,
    .text = "camera { eye: [0, 1.2, 6], target: [0, 0.7, 0], fov: 0.7 }\n"
            "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }\n"
            "light low { direction: [0.1, 0.15, -1], intensity: 0.4, softness: 8deg }\n"
            "light lamp { position: [1.5, 1.5, 1], intensity: 2, color: #ff8800, radius: 0.1 }\n"
            "light { position: [-2, 1, 2], intensity: 1, shadow: false }\n"
            "light panel { position: [0, 3, 0], size: [1, 1], intensity: 6 }\n"
            "fog { density: 0.05 }\n"
            "material glow { color: black, emission: [0, 1, 0.5] }\n"
            "material chrome { color: #ffeecc, metallic: 1, roughness: 0.05 }\n"
            "material glass { color: white, transmission: 1, roughness: 0 }\n"
            "show plane([0, 1, 0], 0);\n"
            "show sphere(0.6).move([0.6, 0.6, 0]).paint(chrome);\n"
            "show sphere(0.5).move([-0.6, 0.5, 1]).paint(glass);\n"
            "show box([0.4, 0.8, 0.4]).move([-1.3, 0.4, -0.5]);\n"
            "show sphere(0.2).move([-0.2, 0.2, 1.6]).paint(glow);\n"};

static int open_lit(void **state) { return open_watched(state) || open_scene(&lit) != KRS_OK; }

static int close_lit(void **state)
{
    close_scene(&lit);
    return close_watched(state);
}

static KrsRenderOptions usual(KrsIntegrator integrator, uint32_t samples)
{
    return (KrsRenderOptions){.width        = SMALL_WIDTH,
                              .height       = SMALL_HEIGHT,
                              .samples      = samples,
                              .bounces      = 4,
                              .integrator   = integrator,
                              .light_groups = true};
}

static KrsPicture *take_light(KrsRenderOptions options, uint32_t light)
{
    options.light        = light;
    options.light_groups = false;
    return render_scene(&lit, options);
}

/* By how much a picture and another are apart at most, in parts of the brightest pixel. */
static double apart(const KrsPicture *a, const KrsPicture *b)
{
    double most = 0, brightest = 0;
    for (size_t i = 0; i < 4 * SMALL_WIDTH * SMALL_HEIGHT; i++) {
        most      = fmax(most, fabs((double)(a->color[i] - b->color[i])));
        brightest = fmax(brightest, fabs((double)b->color[i]));
    }
    return most / brightest;
}

/* The sum of what a light is, alone; and the largest difference of a pixel from that. */
typedef struct Alone {
    double sum, alone, most;
} Alone;

static Alone compare(const KrsPicture *groups, const KrsPicture *alone, const KrsPicture *dark,
                     size_t light)
{
    Alone found = {0};
    for (size_t k = 0; k < SMALL_WIDTH * SMALL_HEIGHT; k++)
        for (size_t i = 0; i < 3; i++) {
            const double own   = (double)groups->lights[k * LIGHTS + light][i];
            const double right = (double)alone->color[4 * k + i] - (double)dark->color[4 * k + i];
            found.sum += own;
            found.alone += right;
            found.most = fmax(found.most, fabs(own - right));
        }
    return found;
}

/* What the lights leave is what things emit, and the sky. */
static bool leaves_the_rest(const KrsPicture *groups, const KrsPicture *dark, double part)
{
    double rest = 0, right = 0;
    for (size_t k = 0; k < SMALL_WIDTH * SMALL_HEIGHT; k++) {
        rest += (double)groups->color[4 * k + 1];
        right += (double)dark->color[4 * k + 1];
        for (size_t light = 0; light < LIGHTS; light++)
            rest -= (double)groups->lights[k * LIGHTS + light][1];
    }
    print_message("# the rest is %.3f, without lights %.3f\n", rest, right);
    return right > 1 && rest >= right * (1 - part);
}

/* Rays of previews are the same however many lights there are; those of paths choose others, and so do those of `direct`,
   which go through glass or are mirrored by it by chance. */
static void lights_are_what_they_make_alone(void **state)
{
    (void)state;
    static const struct {
        KrsIntegrator integrator;
        uint32_t      samples;
        double        pixel, mean; /* permitted differences */
    } trials[]   = {{KRS_INTEGRATOR_PREVIEW, 1, 1e-4, 1e-5},
                    {KRS_INTEGRATOR_PREVIEW, 3, 1e-4, 1e-5},
                    {KRS_INTEGRATOR_DIRECT, 64, INFINITY, 0.1},
                    {KRS_INTEGRATOR_PATH, 64, INFINITY, 0.1}};
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        const KrsRenderOptions options = usual(trials[i].integrator, trials[i].samples);
        KrsPicture *groups = render_scene(&lit, options), *whole = take_light(options, 0);
        KrsPicture *dark = take_light(options, KRS_NO_LIGHT);
        assert_int_equal(groups->light_count, LIGHTS);
        assert_null(whole->lights);
        wrong += !(apart(groups, whole) < 1e-5);
        wrong += !leaves_the_rest(groups, dark, trials[i].mean);
        for (uint32_t light = 0; light < LIGHTS; light++) {
            KrsPicture *alone = take_light(options, light + 1);
            const Alone found = compare(groups, alone, dark, light);
            print_message("# %s, light %u: %.3f, alone %.3f, pixels off by %.6f\n",
                          krs_integrator_names[trials[i].integrator], light, found.sum, found.alone,
                          found.most);
            wrong += !(found.most < trials[i].pixel);
            wrong += !(fabs(found.sum - found.alone) <= trials[i].mean * found.alone);
            wrong += !(found.alone > 1);
            krs_picture_free(alone);
        }
        krs_picture_free(groups);
        krs_picture_free(whole);
        krs_picture_free(dark);
    }
    assert_int_equal(wrong, 0);
}

/* In portions and a crop, and by turns with another film, which takes the buffers. */
static void portions_and_crops_are_the_whole(void **state)
{
    (void)state;
    KrsRenderOptions options = usual(KRS_INTEGRATOR_DIRECT, 5), others = {.samples = 1};
    KrsPicture      *whole = render_scene(&lit, options), *picture;
    KrsFilm         *film, *other;
    options.crop = (KrsWindow){30, 10, 50, 43};
    others.width = others.height = 32;
    assert_int_equal(krs_film_new(lit.rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_new(lit.rendering, &others, &other), KRS_OK);
    for (uint32_t portion = 1; portion < 4; portion++) {
        assert_int_equal(krs_film_add(film, lit.state, NULL, portion == 3 ? 2 : portion), KRS_OK);
        assert_int_equal(krs_film_add(other, lit.state, NULL, 1), KRS_OK);
    }
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    for (size_t y = 0; y < 43; y++)
        assert_memory_equal(picture->lights[y * 50 * LIGHTS],
                            whole->lights[((10 + y) * SMALL_WIDTH + 30) * LIGHTS],
                            50 * LIGHTS * sizeof *picture->lights);
    assert_true(is_part_of(&lit, whole, picture, "portions"));
    krs_picture_free(whole);
    krs_film_free(film);
    krs_film_free(other);
}

static void what_does_not_add_up_is_refused(void **state)
{
    (void)state;
    KrsRenderOptions clamped = usual(KRS_INTEGRATOR_PREVIEW, 1), noisy = clamped;
    KrsPicture      *picture;
    clamped.max_radiance = 1;
    noisy.noise          = 0.1;
    assert_int_equal(krs_render(lit.rendering, lit.state, &clamped, &picture), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_render(lit.rendering, lit.state, &noisy, &picture), KRS_BAD_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(lights_are_what_they_make_alone, hear_layers),
        cmocka_unit_test_teardown(portions_and_crops_are_the_whole, hear_layers),
        cmocka_unit_test_teardown(what_does_not_add_up_is_refused, hear_layers),
    };
    spirv_start();
    int failed = cmocka_run_group_tests_name("light groups", tests, open_lit, close_lit);
    spirv_stop();
    return failed;
}
