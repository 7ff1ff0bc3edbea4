/*
 * rendering.c: what callers of a renderer rely on: progress and interruption, counts, planes,
 * refusals, memory that runs out, lights and materials.
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

#include "compiler/passes/compile.h"
#include "tests/support/device.h"
#include "tests/support/scarce.h"
#include "tests/unit/tracer_fixture.h"

/* ---- Progress ---- */

static bool stop_later(void *user, double done)
{
    int *left = user;
    assert_true(done >= 0 && done <= 1 + 1e-9);
    return --*left > 0;
}

static void interruption_is_heard(void **state)
{
    Fixture    *fixture = *state;
    KrsPicture *picture;
    for (int calls = 1; calls < 6; calls++) {
        int              left    = calls;
        KrsRenderOptions options = {
            .width = WIDTH, .height = HEIGHT, .progress = stop_later, .user = &left};
        assert_int_equal(krs_render(fixture->rendering, fixture->state, &options, &picture),
                         KRS_INTERRUPTED);
        assert_null(picture);
        assert_int_equal(left, 0);
    }
    krs_picture_free(fixture_render(fixture, (KrsRenderOptions){0})); /* and nothing is broken */
}

static bool never_back(void *user, double done)
{
    double *before = user;
    assert_true(done >= *before - 1e-12);
    *before = done;
    return true;
}

static void progress_goes_forwards(void **state)
{
    (void)state;
    Fixture fixture = {0};
    double  done    = 0;
    fixture_open(&fixture, landscape_text, NULL);
    krs_picture_free(fixture_render(&fixture, (KrsRenderOptions){.methods.steps_at_once = 10,
                                                                 .samples               = 3,
                                                                 .progress = never_back,
                                                                 .user     = &done}));
    assert_near(done, 1, 1e-9);
    fixture_close(&fixture);
}

typedef struct Compiling {
    int    calls, most; /* the last one interrupts; 0: none does */
    double done;
} Compiling;

static bool hear_compiling(void *user, double done)
{
    Compiling *compiling = user;
    assert_true(done >= 0 && done <= 1);
    compiling->done = done;
    return ++compiling->calls != compiling->most;
}

/* Wherever compiling is interrupted, the renderer goes on as if nothing had been. */
static void compiling_is_interrupted(void **state)
{
    Fixture                 *fixture   = *state;
    Compiling                compiling = {0};
    const KrsRendererOptions options   = {
          .device = tested_device(), .progress = hear_compiling, .progress_user = &compiling};
    const KrsRenderOptions small = {.width = WIDTH, .height = HEIGHT};
    KrsRenderer           *renderer;
    KrsRendering          *rendering;
    KrsPicture            *picture, *meant = fixture_render(fixture, (KrsRenderOptions){0});
    assert_int_equal(krs_renderer_new(&options, &renderer), KRS_OK);
    for (int most = 1;; most += 2) {
        compiling        = (Compiling){.most = most};
        KrsStatus status = krs_rendering_new(renderer, fixture->scene, KRS_FOR_PICTURES,
                                             &rendering);
        if (status == KRS_OK)
            break;
        assert_int_equal(status, KRS_INTERRUPTED);
        assert_int_equal(compiling.calls, most);
        assert_null(rendering);
    }
    assert_true(compiling.calls > 2 && compiling.done == 1);
    assert_int_equal(krs_render(rendering, fixture->state, &small, &picture), KRS_OK);
    assert_memory_equal(picture->color, meant->color,
                        (size_t)WIDTH * HEIGHT * 4 * sizeof *picture->color);
    krs_picture_free(picture);
    krs_picture_free(meant);
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
}

/* A renderer that makes shaders ahead may be freed while it does so, and makes the same picture. */
static void shaders_are_made_ahead(void **state)
{
    Fixture                 *fixture = *state;
    const KrsRendererOptions options = {.device = tested_device(), .prewarm = true};
    const KrsRenderOptions   small   = {.width = WIDTH, .height = HEIGHT};
    KrsRenderer             *renderer;
    KrsRendering            *rendering;
    KrsPicture              *picture, *meant = fixture_render(fixture, (KrsRenderOptions){0});
    assert_int_equal(krs_renderer_new(&options, &renderer), KRS_OK);
    krs_renderer_free(renderer);
    for (int purpose = 0; purpose < 2; purpose++) {
        assert_int_equal(krs_renderer_new(&options, &renderer), KRS_OK);
        assert_int_equal(krs_rendering_new(renderer, fixture->scene,
                                           purpose ? KRS_FOR_PICTURES : KRS_FOR_QUESTIONS,
                                           &rendering),
                         KRS_OK);
        assert_int_equal(krs_render(rendering, fixture->state, &small, &picture), KRS_OK);
        assert_memory_equal(picture->color, meant->color,
                            (size_t)WIDTH * HEIGHT * 4 * sizeof *picture->color);
        krs_picture_free(picture);
        krs_rendering_free(rendering);
        krs_renderer_free(renderer);
    }
    krs_picture_free(meant);
}

/* ---- Counts, planes and refusals ---- */

static void exhausted_rays_are_counted(void **state)
{
    Fixture    *fixture  = *state;
    KrsPicture *picture  = fixture_render(fixture, (KrsRenderOptions){.methods.max_steps = 3});
    size_t      creeping = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        assert_true(picture->steps[i] <= 3 + 3); /* a ray that is there may finish */
        creeping += picture->steps[i] >= 3;
    }
    assert_in_range(picture->stats.unresolved, 1, creeping);
    krs_picture_free(picture);
}

static void wrong_use_is_refused(void **state)
{
    Fixture               *fixture = *state;
    const KrsRenderOptions wrong[] = {
        {.width = 16385, .height = 10},
        {.width = 10, .height = 10, .crop = {0, 0, 11, 10}},
        {.width = 10, .height = 10, .crop = {5, 10, 1, 1}},
        {.width = 10, .height = 10, .crop = {0xffffffff, 0, 2, 1}},
        {.samples = 65537},
        {.camera = 99},
        {.error = -1},
        {.error = NAN},
        {.slice_ms = -1},
        {.methods.steps_at_once = 8193},
        {.methods.trace = KRS_TRACE_COUNT},
        {.methods.trace = KRS_TRACE_TAYLOR},    /* the scene was not compiled for that */
        {.methods.trace = KRS_TRACE_PREDICTED}, /* or for that */
        {.methods.schedule = KRS_SCHEDULE_COUNT},
        {.shadows = KRS_SHADOWS_COUNT},
        {.caustics = KRS_CAUSTICS_COUNT},
        {.caustics = KRS_CAUSTICS_PHOTONS}, /* previews have none */
        {.methods.starts = KRS_STARTS_COUNT},
        {.methods.reserved = {1}},
        {.catcher = KRS_CATCHER_COUNT},
        {.catcher = KRS_CATCHER_SHADOWS}, /* on what? */
        {.methods.even_hits = KRS_MAX_EVEN_HITS + 1},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        KrsPicture *picture;
        assert_int_equal(krs_render(fixture->rendering, fixture->state, &wrong[i], &picture),
                         KRS_BAD_ARGUMENT);
        assert_null(picture);
        assert_true(strlen(krs_renderer_message(fixture->renderer)) > 10);
    }
}

static void only_wanted_planes_are_held(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = {.aovs = KRS_AOV_DEPTH | KRS_AOV_IDS};
    KrsPicture      *picture = fixture_render(fixture, options);
    assert_non_null(picture->depth);
    assert_non_null(picture->instance);
    assert_null(picture->color);
    assert_null(picture->normal);
    assert_null(picture->steps);
    krs_picture_free(picture);
}

/* What is not asked for is not made, and what is comes out the same. */
static void planes_do_not_hang_on_others(void **state)
{
    Fixture         *fixture = *state;
    const size_t     pixels  = (size_t)WIDTH * HEIGHT;
    KrsRenderOptions options = {.samples = 3, .aovs = KRS_AOV_ALL};
    KrsPicture      *whole   = fixture_render(fixture, options);
    for (int bit = 0; KRS_AOV_ALL >> bit; bit++) {
        /* What this leaves in memory is not to be taken for what has not been made. */
        krs_picture_free(fixture_render(fixture, (KrsRenderOptions){.camera = ROUND}));
        options.aovs     = 1u << bit;
        KrsPicture *part = fixture_render(fixture, options);
        const struct {
            const void *part, *whole;
            size_t      numbers;
        } planes[] = {
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(plane, member, type, numbers, row, first, sample, ...) \
    {part->member, whole->member, numbers},
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
        };
        size_t held = 0;
        for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
            held += planes[i].part != NULL;
            if (planes[i].part)
                assert_memory_equal(planes[i].part, planes[i].whole,
                                    pixels * planes[i].numbers * 4);
        }
        assert_true(held > 0);
        assert_int_equal(part->stats.evaluations, whole->stats.evaluations);
        krs_picture_free(part);
    }
    krs_picture_free(whole);
}

/* The steps of the first rays are among what the statistics count. */
static void evaluations_are_counted(void **state)
{
    KrsPicture *picture = fixture_render(*state, (KrsRenderOptions){.methods.no_beams = true});
    uint64_t    sum     = 0;
    uint32_t    most    = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        sum += picture->steps[i];
        most = picture->steps[i] > most ? picture->steps[i] : most;
    }
    assert_int_equal(picture->stats.evaluations, sum);
    assert_int_equal(picture->stats.max_evaluations_per_ray, most);
    krs_picture_free(picture);
}

/* ---- Light ---- */

/* A ball over a floor: without occlusion no pixel is darker, and some below it are lighter. */
static void occlusion_can_be_left_out(void **state)
{
    (void)state;
    Fixture fixture = {0};
    fixture_open(&fixture, landscape_text, NULL);
    KrsPicture *with    = fixture_render(&fixture, (KrsRenderOptions){0});
    KrsPicture *without = fixture_render(&fixture, (KrsRenderOptions){.no_occlusion = true});
    size_t      lighter = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        assert_true(without->color[4 * i] >= with->color[4 * i] - 1e-5f);
        lighter += without->color[4 * i] > 1.1f * with->color[4 * i];
    }
    assert_true(lighter > 50);
    assert_true(without->stats.phase_ms[KRS_PHASE_OCCLUSION] == 0);
    krs_picture_free(with);
    krs_picture_free(without);
    fixture_close(&fixture);
}

/* A light that casts no shadows is the same where the shadowing one is not in the way: on a ball
   alone, which is convex. */
static void shadows_that_are_not_cast_are_not_missed(void **state)
{
    static const char form[] = "camera { eye: [3, 2, 5], fov: 30deg }\n"
                               "light sun { direction: [-1, 2, 1], softness: 0deg, shadow: %s }\n"
                               "show sphere(1);\n";
    (void)state;
    KrsPicture *pictures[2];
    Fixture     fixtures[2] = {0};
    for (int i = 0; i < 2; i++) {
        char text[256];
        snprintf(text, sizeof text, form, i ? "true" : "false");
        fixture_open(&fixtures[i], text, NULL);
        pictures[i] = fixture_render(&fixtures[i], (KrsRenderOptions){0});
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 4; i++)
        assert_near(pictures[0]->color[i], pictures[1]->color[i], 0.01);
    assert_true(pictures[0]->stats.phase_ms[KRS_PHASE_SHADOWS] == 0);
    for (int i = 0; i < 2; i++) {
        krs_picture_free(pictures[i]);
        fixture_close(&fixtures[i]);
    }
}

/* The sky is the sum of what each light adds to it, for the first sample as for others; a light
   without a size, or with a place, adds nothing. */
static void every_sun_is_in_the_sky(void **state)
{
    static const char text[] =
        "param one = 0 in [0, 9]; param two = 0 in [0, 9]; param three = 0 in [0, 9];\n"
        "camera { eye: [3, 2, 5], target: [0, 2.5, 0], fov: 70deg }\n"
        "light point { position: [0, 3, 0], intensity: 5 }\n"
        "light a { direction: [-3, 0.9, -5], intensity: one, softness: 6deg }\n"
        "light sharp { direction: [-1, 2, -5], intensity: 5, softness: 0deg }\n"
        "light b { direction: [-5, 2, -5], intensity: two, softness: 4deg }\n"
        "light c { direction: [-4, 2, -8], intensity: three, softness: 5deg }\n"
        "show sphere(1);\n";
    static const char *const names[] = {"one", "two", "three"};
    enum { NONE, ALL = 4, PICTURES };
    (void)state;
    Fixture     fixture = {0};
    KrsPicture *pictures[PICTURES];
    fixture_open(&fixture, text, NULL);
    for (int i = 0; i < PICTURES; i++) {
        for (int sun = 0; sun < 3; sun++) {
            double intensity = i == ALL || i == sun + 1 ? 2 + sun : 0;
            assert_int_equal(krs_state_set(fixture.state, names[sun], &intensity, 1), KRS_OK);
        }
        pictures[i] = fixture_render(&fixture,
                                     (KrsRenderOptions){.samples = 2, .no_occlusion = true});
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 4; i++) {
        double sum = -2 * (double)pictures[NONE]->color[i];
        for (int sun = 1; sun <= 3; sun++)
            sum += pictures[sun]->color[i];
        if (pictures[NONE]->color[i / 4 * 4 + 3] == 0)
            assert_near(pictures[ALL]->color[i], sum, 1e-5 * (1 + fabs(sum)));
    }
    for (int i = 1; i <= 3; i++) {
        double brightest = 0;
        for (size_t k = 0; k < (size_t)WIDTH * HEIGHT; k++)
            brightest = fmax(brightest, pictures[i]->color[4 * k] - pictures[NONE]->color[4 * k]);
        assert_near(brightest, 2.15 * (1 + i), 0.1 * (1 + i)); /* disc and glow: 2, and 0.15 */
    }
    for (int i = 0; i < PICTURES; i++)
        krs_picture_free(pictures[i]);
    fixture_close(&fixture);
}

/* ---- Memory ---- */

static KrsStatus render_with(Scarce *scarce, Fixture *fixture)
{
    KrsRenderer       *renderer;
    KrsRendering      *rendering = NULL;
    KrsPicture        *picture   = NULL;
    KrsRenderOptions   small     = {.width = 16, .height = 16};
    KrsRendererOptions options = {.device = tested_device(), .allocator = scarce_allocator(scarce)};
    KrsStatus          status  = krs_renderer_new(&options, &renderer);
    if (status == KRS_OK)
        status = krs_rendering_new(renderer, fixture->scene, KRS_FOR_PICTURES, &rendering);
    if (status == KRS_OK)
        status = krs_render(rendering, fixture->state, &small, &picture);
    if (status != KRS_OK)
        assert_non_null(strstr(krs_renderer_message(renderer), "memory"));
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
    assert_int_equal(scarce->held, 0);
    return status;
}

static void memory_that_runs_out_is_reported(void **state)
{
    Fixture  *fixture     = *state;
    int       allocations = 0;
    KrsStatus status;
    do {
        Scarce scarce = {.failing = ++allocations, .lasting = true};
        status        = render_with(&scarce, fixture);
        assert_true(status == KRS_OK || status == KRS_OUT_OF_MEMORY);
    } while (status != KRS_OK && allocations < 100);
    assert_int_equal(status, KRS_OK);
    assert_true(allocations > 8);
}

/* ---- Materials ---- */

/* A material that divides by 0 somewhere, or takes the root of what is negative, gives numbers all
   the same: what is none is 0, what is too much the most that there is. */
static void materials_give_numbers(void **state)
{
    static const char *const materials[] = {
        "color: [1 / (k * x), (k * x) / (k * y), sqrt(-x * x)], roughness: (k * z) / (k * x)",
        "color: log(x), metallic: sqrt(-y * y), emission: 1 / (k * x)",
        "color: red, emission: [x / k, sqrt(x), exp(1000 * y)]",
        "color: [1e30, -1e30, 0.5] * x / k, roughness: 1 / max(k, 0), emission: 1e38",
    };
    (void)state;
    for (size_t m = 0; m < sizeof materials / sizeof *materials; m++) {
        Fixture fixture = {0};
        char    text[400];
        snprintf(text, sizeof text, "param k = 0; material m { %s } show sphere(1).paint(m);",
                 materials[m]);
        fixture_open(&fixture, text, NULL);
        KrsPicture *picture = fixture_render(&fixture, (KrsRenderOptions){.samples = 5});
        size_t      wrong = 0, pixels = (size_t)WIDTH * HEIGHT;
        for (size_t i = 0; i < 4 * pixels; i++)
            wrong += !(picture->color[i] >= 0 && picture->color[i] < 1e38f);
        for (size_t i = 0; i < 3 * pixels; i++)
            wrong += !(picture->albedo[i] >= 0 && picture->albedo[i] <= 1) +
                     !(fabsf(picture->normal[i]) <= 1.001f);
        if (wrong > 0)
            print_message("%zu wrong: %s\n", wrong, materials[m]);
        assert_int_equal(wrong, 0);
        krs_picture_free(picture);
        double places[3][3] = {{1, 0, 0}, {-0.6, 0.8, 0}, {0, 0, 1}};
        KrsHit hits[3];
        assert_int_equal(krs_probe(fixture.state, (const double(*)[3])places, 3, hits), KRS_OK);
        for (int i = 0; i < 9; i++)
            assert_true(hits[i / 3].color[i % 3] >= 0 && hits[i / 3].color[i % 3] <= 1 &&
                        hits[i / 3].roughness >= 0 && hits[i / 3].roughness <= 1);
        fixture_close(&fixture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(interruption_is_heard, fixture_set_up, fixture_tear_down),
        cmocka_unit_test(progress_goes_forwards),
        cmocka_unit_test_setup_teardown(compiling_is_interrupted, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(shaders_are_made_ahead, fixture_set_up, fixture_tear_down),
        cmocka_unit_test(materials_give_numbers),
        cmocka_unit_test_setup_teardown(exhausted_rays_are_counted, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(wrong_use_is_refused, fixture_set_up, fixture_tear_down),
        cmocka_unit_test_setup_teardown(only_wanted_planes_are_held, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(planes_do_not_hang_on_others, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(evaluations_are_counted, fixture_set_up, fixture_tear_down),
        cmocka_unit_test(occlusion_can_be_left_out),
        cmocka_unit_test(shadows_that_are_not_cast_are_not_missed),
        cmocka_unit_test(every_sun_is_in_the_sky),
        cmocka_unit_test_setup_teardown(memory_that_runs_out_is_reported, fixture_set_up,
                                        fixture_tear_down),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    spirv_stop();
    return failed;
}
