/*
 * drivers.c: what kinds of devices the host tells apart is not seen.
 *
 * The device is taken for a graphics card, and for one whose buffers are no longer than any
 * device's may be: pictures and answers must be those of the device as it is, bit by bit, under the
 * validation layers.  Shaders that read buffers are other programs than those that read texels, and
 * a compiler orders sums as it likes: there light may differ in the last places, and nothing else.
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
#include "krs/vulkan.h"
#include "runtime/device/gpu.h"
#include "runtime/tracer/renderer.h"
#include "tests/support/device.h"

static char validation_message[2048]; /* the last */

static void note_validation_message(void *user, const char *message)
{
    (void)user;
    snprintf(validation_message, sizeof validation_message, "%s", message);
}

/* ---- A scene on a device ---- */

typedef struct Fixture {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Fixture;

static Fixture open_fixture(const char *text, unsigned emulation)
{
    KrsRendererOptions options = {.device             = tested_device(),
                                  .validation         = true,
                                  .validation_message = note_validation_message,
                                  .early_outs         = KRS_EARLY_OUTS_OFF};
    Fixture            fixture;
    KrsStatus          status = renderer_new_emulating(&options, emulation, &fixture.renderer);
    if (status != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture.renderer));
    if (krs_compile_text(text, strlen(text), "scene.krs", NULL, &fixture.scene) != KRS_OK)
        fail_msg("does not compile: %s", text);
    assert_int_equal(krs_state_new(fixture.scene, &fixture.state), KRS_OK);
    assert_int_equal(
        krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &fixture.rendering),
        KRS_OK);
    return fixture;
}

static void close_fixture(Fixture *fixture)
{
    if (krs_renderer_validation_messages(fixture->renderer) != 0)
        fail_msg("the validation layers complain: %s", validation_message);
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
    krs_renderer_free(fixture->renderer);
}

static KrsPicture *render(const Fixture *fixture, const KrsRenderOptions *options)
{
    KrsPicture *picture;
    if (krs_render(fixture->rendering, fixture->state, options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    return picture;
}

/* ---- Pictures ---- */

static size_t differing_bytes(const void *a, const void *b, size_t bytes)
{
    const unsigned char *left = a, *right = b;
    size_t               differ = 0;
    for (size_t i = 0; i < bytes; i++)
        differ += left[i] != right[i];
    return differ;
}

/* Numbers that differ by more than roundings.  Fits of openness lose some bits by cancellation. */
static size_t differing_numbers(const float *a, const float *b, size_t count)
{
    const float roundings = 4096 * 0x1p-24f;
    size_t      differ    = 0;
    for (size_t i = 0; i < count; i++)
        differ += !(fabsf(a[i] - b[i]) <= roundings * fmaxf(fabsf(a[i]), fabsf(b[i])));
    return differ;
}

/* Bytes of all planes but colour, and of the counts, that differ.  Bands share the beams of tiles that both
   have a part of, so counts depend on the bands of a large picture.  `counts_vary`: and on who marches. */
static size_t difference_but_color(const KrsPicture *a, const KrsPicture *b, bool counts_vary)
{
    size_t pixels      = (size_t)a->window.width * a->window.height;
    bool   is_one_band = pixels < 1 << 16 && !counts_vary;
    return differing_bytes(a->depth, b->depth, pixels * sizeof(float)) +
           differing_bytes(a->position, b->position, pixels * 3 * sizeof(float)) +
           differing_bytes(a->normal, b->normal, pixels * 3 * sizeof(float)) +
           differing_bytes(a->albedo, b->albedo, pixels * 3 * sizeof(float)) +
           differing_bytes(a->component, b->component, pixels * sizeof(uint32_t)) +
           differing_bytes(a->level, b->level, pixels * sizeof(uint32_t)) +
           differing_bytes(a->instance, b->instance, pixels * sizeof(uint32_t)) +
           differing_bytes(a->steps, b->steps, pixels * sizeof(uint32_t)) +
           (is_one_band && a->stats.evaluations != b->stats.evaluations) +
           (a->stats.max_evaluations_per_ray != b->stats.max_evaluations_per_ray) +
           (a->stats.unresolved != b->stats.unresolved);
}

static size_t difference(const KrsPicture *a, const KrsPicture *b)
{
    size_t pixels = (size_t)a->window.width * a->window.height;
    return difference_but_color(a, b, false) +
           differing_bytes(a->color, b->color, pixels * 4 * sizeof(float));
}

static size_t difference_of_shaders(const KrsPicture *a, const KrsPicture *b, bool counts_vary)
{
    size_t pixels = (size_t)a->window.width * a->window.height;
    return difference_but_color(a, b, counts_vary) +
           differing_numbers(a->color, b->color, 4 * pixels);
}

typedef struct Case {
    const char      *name, *text;
    KrsRenderOptions options;
} Case;

/* Each as a card has it, so that the schedule is the same. */
static const Case cases[] = {
    {"five lights",
     "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
     "light sun { direction: [1, 2, 1], softness: 4deg }"
     "light a { position: [2, 3, 0], intensity: 4 }"
     "light b { position: [-2, 3, 0], intensity: 4, color: #ff0000 }"
     "light c { direction: [-1, 1, 0.3], intensity: 0.4 }"
     "light d { position: [0, 4, 2], intensity: 4, color: #0000ff }"
     "show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);",
     {.width = 150, .height = 93, .methods.schedule = KRS_SCHEDULE_QUEUE}},
    {"several bands",
     "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
     "show torus(1.2, 0.3).move([0, 1, 0]); show box([0.7, 0.7, 0.7]);",
     {.width = 1100, .height = 500, .methods.schedule = KRS_SCHEDULE_QUEUE}},
    {"four samples of 12 mirrors",
     "camera { eye: [2, 6, 22], fov: 0.6 }"
     "show krs { kernel sphere(0.45); for i in 0..12 {"
     "reflect plane(random_direction(i), 0.4 + 0.22 * i); } };",
     {.width = 131, .height = 70, .samples = 4, .methods.schedule = KRS_SCHEDULE_QUEUE}},
    {"area shadows",
     "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
     "show sphere(1).move([0, 1, 0]) - box([0.8, 0.8, 4]); show plane([0, 1, 0], 0);",
     {.width            = 97,
      .height           = 61,
      .samples          = 2,
      .shadows          = KRS_SHADOWS_AREA,
      .methods.schedule = KRS_SCHEDULE_PIXEL}},
    {"a panorama",
     "camera { eye: [0.1, 0.2, 0.3], projection: \"panorama\" }"
     "show box([4, 3, 5]) - sphere(0.8).move([1.5, 0, 0.2]);",
     {.width = 120, .height = 60, .methods.schedule = KRS_SCHEDULE_REFILL}},
    {"paths",
     "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
     "light sun { direction: [1, 2, 1], softness: 8deg, intensity: 2 }"
     "light lamp { position: [-1.5, 2.5, 1], radius: 0.3, intensity: 3 }"
     "material glass { color: white, transmission: 1, roughness: 0.2, absorption: [1, 0.2, 2] }"
     "show sphere(0.8).move([0, 0.8, 0]).paint(glass); show plane([0, 1, 0], 0);"
     "show torus(0.5, 0.2).move([1.3, 0.2, 0.6]);",
     {.width            = 70,
      .height           = 50,
      .samples          = 2,
      .bounces          = 5,
      .integrator       = KRS_INTEGRATOR_PATH,
      .methods.schedule = KRS_SCHEDULE_QUEUE}},
    {"few steps",
     "camera { eye: [3, 4, 7], fov: 0.6 }"
     "show torus(0.5, 0.15).repeat([1.4, 0.9, 1.4], [5, 3, 5]);",
     {.width = 160, .height = 100, .methods.max_steps = 9, .methods.schedule = KRS_SCHEDULE_QUEUE}},
    {"a polynomial",
     "camera { eye: [3, 2, 3], fov: 0.6 }"
     "show algebraic(x ^ 4 + y ^ 4 + z ^ 4 == 1).within(sphere(1.5));",
     {.width = 100, .height = 70, .methods.schedule = KRS_SCHEDULE_QUEUE}},
    /* Rays that take more steps than a chain has. */
    {"the shortest slices",
     "camera { eye: [3, 4, 7], fov: 0.6 }"
     "show torus(0.5, 0.15).repeat([1.4, 0.9, 1.4], [5, 3, 5]);",
     {.width                 = 60,
      .height                = 50,
      .methods.steps_at_once = 1,
      .slice_ms              = 1e-3,
      .methods.trace         = KRS_TRACE_PLAIN,
      .methods.no_beams      = true,
      .methods.schedule      = KRS_SCHEDULE_QUEUE}},
    /* More groups than the first slice has, and rays with more steps than a chain. */
    {"a chain that stops at once",
     "camera { eye: [2, 6, 22], fov: 0.6 }"
     "show krs { kernel sphere(0.45); for i in 0..12 {"
     "reflect plane(random_direction(i), 0.4 + 0.22 * i); } };",
     {.width                 = 400,
      .height                = 300,
      .methods.steps_at_once = 1,
      .slice_ms              = 1e6,
      .methods.trace         = KRS_TRACE_PLAIN,
      .methods.no_beams      = true,
      .methods.schedule      = KRS_SCHEDULE_QUEUE}},
    /* What later dispatches of a chain clear must be there when the host goes on before them. */
    {"chains of several lights that stop",
     "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
     "light { direction: [-1, 2, 1], intensity: 3, softness: 1deg }"
     "light { direction: [2, 1, 0], softness: 2deg } light { position: [1, 3, 2], intensity: 8 }"
     "show sphere(1).move([0, 1, 0]); show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);"
     "show plane([0, 1, 0], 0);",
     {.width            = 200,
      .height           = 130,
      .samples          = 4,
      .slice_ms         = 1e-3,
      .methods.schedule = KRS_SCHEDULE_QUEUE}},
    {"components by themselves",
     "def tree(seed) = krs { kernel capsule([0, 0, 0], [0, 0.3, 0], 0.04).move([0, 0.4, 0]);"
     "    for i in 0..6 { reflect plane(random_direction(seed + i), 0.12 * i + 0.05);"
     "        kernel capsule([0, 0, 0], [0.1 * i, 0.3, 0], 0.05 + 0.01 * i); } };"
     "let bushes = [tree(1), tree(20), tree(40), tree(60)];"
     "show bushes[0].move([-4.5, 0, 0]); show bushes[1].move([-1.5, 0, 1.5]);"
     "show bushes[2].move([1.5, 0, 3]); show bushes[3].move([4.5, 0, 4.5]);"
     "show plane([0, 1, 0], -1); camera { eye: [3, 3, 14], target: [0, 0, 0], fov: 0.6 }",
     {.width              = 90,
      .height             = 60,
      .methods.schedule   = KRS_SCHEDULE_QUEUE,
      .methods.components = KRS_COMPONENTS_APART}},
    {"rays by lanes",
     "show box([1, 1.4, 0.8]) - sphere(0.7).move([0.4, 0.3, 0.4]); show plane([0, 1, 0], -0.8);",
     {.width = 90, .height = 60, .methods.executor = KRS_EXECUTOR_LANES}},
    {"mirrors by lanes",
     "material mirror { metallic: 1, roughness: 0 } show box([1, 1.4, 0.8]).paint(mirror); show "
     "sphere(0.5).move([1, 0, 0.6]).paint(mirror); show plane([0, 1, 0], -0.8); light sun { "
     "direction: "
     "[1, 2, 1] }",
     {.width = 90, .height = 60, .methods.executor = KRS_EXECUTOR_LANES}},
};

/* Where few texels are read, shaders march what lanes do otherwise: rays of mirrors. */
static bool by_lanes(const Case *test)
{
    return test->options.methods.executor == KRS_EXECUTOR_LANES;
}

/* Renders a case as the device is, and as it is taken for. */
static size_t compare(const Case *test, unsigned emulation)
{
    Fixture plain = open_fixture(test->text, 0), emulating = open_fixture(test->text, emulation);
    KrsPicture *a = render(&plain, &test->options), *b = render(&emulating, &test->options);
    size_t differ = emulation & EMULATE_MIN_LIMITS ? difference_of_shaders(a, b, by_lanes(test))
                                                   : difference(a, b);
    if (differ > 0)
        print_message("# %s: %zu bytes differ\n", test->name, differ);
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&plain);
    close_fixture(&emulating);
    return differ;
}

static void compare_all(unsigned emulation)
{
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (!(by_lanes(&cases[i]) &&
              emulation & EMULATE_CARD)) /* lanes share no memory with a card */
            wrong += compare(&cases[i], emulation) > 0;
    }
    assert_int_equal(wrong, 0);
}

static void short_texel_buffers_are_not_seen(void **context)
{
    (void)context;
    compare_all(EMULATE_MIN_LIMITS);
}

static void a_card_is_not_seen(void **context)
{
    (void)context;
    compare_all(EMULATE_CARD);
    assert_int_equal(compare(&cases[0], EMULATE_CARD | EMULATE_MIN_LIMITS), 0);
}

/* The comparison sees one bit. */
static void a_flipped_bit_is_found(void **context)
{
    (void)context;
    Fixture     fixture = open_fixture(cases[0].text, 0);
    KrsPicture *a = render(&fixture, &cases[0].options), *b = render(&fixture, &cases[0].options);
    assert_int_equal(difference(a, b), 0);
    b->steps[150 * 93 - 1] ^= 1;
    assert_int_equal(difference(a, b), 1);
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&fixture);
}

/* ---- Submissions ---- */

/* What the host waits for: two times to clear, rays, light, and the results. */
enum { SUBMISSIONS_OF_CARD = 5 };

static void a_card_is_seldom_waited_for(void **context)
{
    (void)context;
    Fixture          fixture = open_fixture(cases[0].text, EMULATE_CARD);
    KrsRenderOptions options = cases[0].options;
    options.slice_ms         = 1e6; /* a slice is all of it */
    for (int i = 0; i < 2; i++) {
        KrsPicture *picture = render(&fixture, &options);
        assert_in_range(picture->stats.submissions, 1, SUBMISSIONS_OF_CARD);
        krs_picture_free(picture);
    }
    close_fixture(&fixture);
}

/* Says stop at the call that `user` has counted down to. */
static bool count_down(void *user, double done)
{
    int *left = user;
    (void)done;
    return --*left >= 0;
}

/* Wherever it is interrupted, and the next picture is whole. */
static void a_card_is_interrupted(void **context)
{
    (void)context;
    Fixture          fixture     = open_fixture(cases[0].text, EMULATE_CARD);
    KrsRenderOptions options     = cases[0].options;
    KrsPicture      *whole       = render(&fixture, &options);
    int              interrupted = 0, left;
    options.progress             = count_down;
    options.user                 = &left;
    for (int calls = 0; calls < 20; calls++) {
        KrsPicture *picture;
        left             = calls;
        KrsStatus status = krs_render(fixture.rendering, fixture.state, &options, &picture);
        if (status == KRS_OK)
            assert_int_equal(difference(whole, picture), 0);
        else
            assert_int_equal(status, KRS_INTERRUPTED);
        interrupted += status != KRS_OK;
        krs_picture_free(picture);
    }
    assert_in_range(interrupted, 1, 19);
    krs_picture_free(whole);
    close_fixture(&fixture);
}

/* ---- Questions ---- */

enum { RAYS = 300 };

static void ask(unsigned emulation, KrsHit hits[RAYS])
{
    static double origins[RAYS][3], directions[RAYS][3];
    Fixture       fixture = open_fixture(cases[0].text, emulation);
    for (int i = 0; i < RAYS; i++) {
        origins[i][0]    = 4;
        origins[i][1]    = 3;
        directions[i][0] = -1;
        directions[i][1] = 0.004 * (i % 20) - 0.6;
        directions[i][2] = 0.004 * (i / 20) - 0.03;
    }
    assert_int_equal(krs_device_raycast(fixture.rendering, fixture.state,
                                        (const double(*)[3])origins, (const double(*)[3])directions,
                                        RAYS, 100, 1e-4, hits),
                     KRS_OK);
    close_fixture(&fixture);
}

static void answers_are_the_same(void **context)
{
    (void)context;
    static KrsHit plain[RAYS], others[RAYS];
    size_t        hits = 0;
    ask(0, plain);
    for (int i = 0; i < RAYS; i++)
        hits += plain[i].hit;
    assert_true(hits > RAYS / 4);
    for (unsigned emulation = 1; emulation < 4; emulation++) {
        ask(emulation, others);
        assert_memory_equal(plain, others, sizeof plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_texel_buffers_are_not_seen),
        cmocka_unit_test(a_card_is_not_seen),
        cmocka_unit_test(a_flipped_bit_is_found),
        cmocka_unit_test(a_card_is_seldom_waited_for),
        cmocka_unit_test(a_card_is_interrupted),
        cmocka_unit_test(answers_are_the_same),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests_name("drivers", tests, NULL, NULL);
    spirv_stop();
    return failed;
}
