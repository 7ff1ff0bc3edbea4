/*
 * film.c: a film persists.  However samples are added, in portions, by turns with another film,
 * band by band or on a device that the host cannot look into, it shows what krs_render does at
 * once, bit by bit; and it sees by the caller's cameras.
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
#include "runtime/device/gpu.h"
#include "tests/unit/tracer_fixture.h"

enum { SAMPLES = 4 };

/* Two suns, a lamp, shadows, and a parameter. */
static const char film_text[] =
    "param height = 1 in [0.1, 3];\n"
    "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
    "camera above { eye: [1, 6, 1], target: [0, 0.5, 0], fov: 50deg }\n"
    "camera flat { eye: [-2, 3, 4], target: [0, 0.5, 0], projection: \"orthographic\", height: 3 "
    "}\n"
    "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }\n"
    "light low { direction: [2, 1, 0], intensity: 1, softness: 2deg }\n"
    "light lamp { position: [1, 3, 2], intensity: 8, softness: 0.2 }\n"
    "show sphere(1).move([0, height, 0]); show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);\n"
    "show plane([0, 1, 0], 0);\n";

static KrsFilm *new_film(Fixture *fixture, const KrsRenderOptions *options)
{
    KrsFilm *film;
    if (krs_film_new(fixture->rendering, options, &film) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    assert_int_equal(krs_film_samples(film), 0);
    return film;
}

static void add(Fixture *fixture, KrsFilm *film, const KrsCamera *camera, uint32_t samples)
{
    uint32_t before = krs_film_samples(film);
    if (krs_film_add(film, fixture->state, camera, samples) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    assert_int_equal(krs_film_samples(film), before + samples);
}

static KrsPicture *read_film(Fixture *fixture, KrsFilm *film)
{
    KrsPicture *picture;
    if (krs_film_read(film, 0, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    return picture;
}

/* Bytes that differ, of all planes that the first one has. */
static size_t difference(const KrsPicture *a, const KrsPicture *b)
{
    const size_t pixels = (size_t)a->window.width * a->window.height;
    size_t       differ = 0;
    assert_memory_equal(&a->window, &b->window, sizeof a->window);
    assert_memory_equal(a->world_to_camera, b->world_to_camera, sizeof a->world_to_camera);
    assert_memory_equal(a->world_to_ndc, b->world_to_ndc, sizeof a->world_to_ndc);
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(plane, member, type, numbers, row, first, sample, ...)      \
    for (size_t i = 0; a->member && i < pixels * numbers * sizeof(type); i++) \
        differ += ((const unsigned char *)a->member)[i] != ((const unsigned char *)b->member)[i];
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
    for (int kind = 0; a->mattes[0] && kind < KRS_MATTE_COUNT; kind++)
        differ += memcmp(a->mattes[kind], b->mattes[kind],
                         pixels * KRS_MATTE_RANKS * sizeof(KrsMatte)) != 0;
    return differ;
}

static void assert_same(KrsPicture *a, KrsPicture *b)
{
    assert_int_equal(difference(a, b), 0);
    krs_picture_free(a);
    krs_picture_free(b);
}

/* ---- Portions ---- */

static const KrsRenderOptions part = {.width   = WIDTH,
                                      .height  = HEIGHT,
                                      .crop    = {13, 9, 60, 41},
                                      .samples = SAMPLES,
                                      .seed    = 3,
                                      .mattes  = true};

/* On devices whose bands are small, or into which the host cannot look, as well. */
static const unsigned emulations[] = {0, EMULATE_CARD, EMULATE_MIN_LIMITS,
                                      EMULATE_CARD | EMULATE_MIN_LIMITS};
enum { EMULATIONS = sizeof emulations / sizeof emulations[0] };

static void portions_are_the_whole(void **state)
{
    static const uint32_t portions[][SAMPLES] = {{4}, {1, 3}, {2, 1, 1}, {1, 1, 1, 1}};
    (void)state;
    for (size_t k = 0; k < EMULATIONS; k++) {
        Fixture fixture;
        fixture_open_as(&fixture, film_text, emulations[k]);
        for (size_t i = 0; i < sizeof portions / sizeof portions[0]; i++)
            for (int reads = 0; reads < 2; reads++) { /* in between */
                KrsFilm *film = new_film(&fixture, &part);
                for (int n = 0; n < SAMPLES && portions[i][n]; n++) {
                    add(&fixture, film, NULL, portions[i][n]);
                    if (reads)
                        krs_picture_free(read_film(&fixture, film));
                }
                assert_same(read_film(&fixture, film), fixture_render(&fixture, part));
                krs_film_free(film);
            }
        fixture_close_watched(&fixture);
    }
}

/* Where buffers hold 4,096 pixels, this picture has dozens of bands. */
static void bands_are_swapped(void **state)
{
    const KrsRenderOptions large = {.width = 300, .height = 200, .samples = 3, .mattes = true};
    (void)state;
    for (size_t k = 0; k < EMULATIONS; k++) {
        Fixture fixture;
        fixture_open_as(&fixture, film_text, emulations[k]);
        KrsFilm *film = new_film(&fixture, &large);
        for (int n = 0; n < 3; n++)
            add(&fixture, film, NULL, 1);
        assert_same(read_film(&fixture, film), fixture_render(&fixture, large));
        krs_film_free(film);
        fixture_close_watched(&fixture);
    }
}

/* The buffers hold a band of one film at a time; questions do not touch it. */
static void films_take_turns(void **state)
{
    const KrsRenderOptions other = {.width = 70, .height = 90, .samples = 2, .camera = 1};
    (void)state;
    for (size_t k = 0; k < EMULATIONS; k++) {
        const double point[1][3] = {{0, 5, 0}};
        KrsHit       hit;
        Fixture      fixture;
        fixture_open_as(&fixture, film_text, emulations[k]);
        KrsFilm *a = new_film(&fixture, &part), *b = new_film(&fixture, &other);
        add(&fixture, a, NULL, 1);
        add(&fixture, b, NULL, 1);
        add(&fixture, a, NULL, 2);
        assert_int_equal(krs_device_probe(fixture.rendering, fixture.state, point, 1, &hit),
                         KRS_OK);
        assert_near(hit.distance, 3, 1e-4);
        add(&fixture, a, NULL, 1);
        krs_picture_free(fixture_render(&fixture, (KrsRenderOptions){.camera = 2}));
        add(&fixture, b, NULL, 1);
        assert_same(read_film(&fixture, a), fixture_render(&fixture, part));
        assert_same(read_film(&fixture, b), fixture_render(&fixture, other));
        krs_film_free(a);
        krs_film_free(b);
        fixture_close_watched(&fixture);
    }
}

/* Fewer samples than were planned, and more, are means all the same. */
static void samples_are_added(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .samples = 2, .no_occlusion = true};
    KrsFilm *film = new_film(fixture, &options);
    add(fixture, film, NULL, 2);
    KrsPicture *two = read_film(fixture, film);
    add(fixture, film, NULL, 6);
    KrsPicture *eight = read_film(fixture, film);
    assert_int_equal(eight->stats.rays, 8 * WIDTH * HEIGHT);
    assert_int_equal(two->stats.rays, 2 * WIDTH * HEIGHT);
    double shares[2] = {0};
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const float alpha = eight->color[4 * i + 3];
        assert_near(8 * (double)alpha, round(8 * (double)alpha), 1e-5);
        shares[0] += (double)two->color[4 * i + 3];
        shares[1] += (double)alpha;
    }
    assert_near(shares[0] / shares[1], 1, 0.01);
    krs_picture_free(two);
    krs_picture_free(eight);
    krs_film_free(film);
}

/* ---- What it is about ---- */

/* The mean of two frames blurs what moves. */
static void frames_may_differ(void **state)
{
    Fixture               *fixture    = *state;
    const double           heights[2] = {1, 1.5};
    const KrsRenderOptions options    = {.width = WIDTH, .height = HEIGHT, .samples = 2};
    KrsFilm               *film       = new_film(fixture, &options), *alone[2];
    KrsPicture            *seen[2];
    for (int n = 0; n < 2; n++) {
        assert_int_equal(krs_state_set(fixture->state, "height", &heights[n], 1), KRS_OK);
        alone[n] = new_film(fixture, &options);
        add(fixture, alone[n], NULL, 1);
        seen[n] = read_film(fixture, alone[n]);
        add(fixture, film, NULL, 1);
    }
    /* The second sample of a film has another place in its pixel, so only what is flat compares. */
    KrsPicture *blurred = read_film(fixture, film);
    assert_memory_equal(blurred->depth, seen[0]->depth, WIDTH * HEIGHT * sizeof(float));
    size_t between = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const float a = seen[0]->color[4 * i], b = seen[1]->color[4 * i];
        const float mean = blurred->color[4 * i];
        between += fabsf(mean - 0.5f * (a + b)) <= 0.02f + 0.05f * (a + b);
    }
    assert_in_range(between, WIDTH * HEIGHT * 9 / 10, WIDTH * HEIGHT);
    assert_true(memcmp(seen[0]->depth, seen[1]->depth, WIDTH * HEIGHT * sizeof(float)) != 0);
    for (int n = 0; n < 2; n++) {
        krs_picture_free(seen[n]);
        krs_film_free(alone[n]);
    }
    krs_picture_free(blurred);
    krs_film_free(film);
    assert_int_equal(krs_state_set(fixture->state, "height", &heights[0], 1), KRS_OK);
}

/* A camera that the caller gives is as good as one of the scene. */
static void cameras_are_the_callers(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT};
    KrsFilm         *film    = new_film(fixture, &options);
    KrsCamera        camera;
    for (size_t i = 0; i < krs_camera_count(fixture->scene); i++) {
        assert_int_equal(krs_state_camera(fixture->state, i, &camera), KRS_OK);
        krs_film_clear(film);
        add(fixture, film, &camera, 1);
        options.camera = i;
        assert_same(read_film(fixture, film), fixture_render(fixture, options));
    }
    assert_int_equal(krs_camera_count(fixture->scene), 3);
    assert_int_equal(krs_state_camera(fixture->state, 3, &camera), KRS_BAD_ARGUMENT);

    /* Another scene says what the caller says here; it is compiled without a panorama. */
    static const char text[]  = "camera { eye: [0.5, 0.75, 4], target: [0, 0.5, 0],"
                                "         projection: \"panorama\" }"
                                "show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);"
                                "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }";
    static const char plain[] = "show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);"
                                "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }";
    Fixture           there, here;
    fixture_open_as(&there, text, 0);
    fixture_open_as(&here, plain, 0);
    const KrsCamera round = {
        .projection = KRS_PANORAMA, .eye = {0.5, 0.75, 4}, .target = {0, 0.5, 0}, .up = {0, 1, 0}};
    options.camera      = 0;
    KrsFilm *all_around = new_film(&here, &options);
    add(&here, all_around, &round, 1);
    assert_same(read_film(&here, all_around), fixture_render(&there, options));
    krs_film_free(all_around);
    krs_film_free(film);
    fixture_close_watched(&there);
    fixture_close_watched(&here);
}

/* What exceeds the limit keeps its hue, and is counted; what does not is as it was, bit by bit. */
static void bright_rays_are_clamped(void **state)
{
    Fixture          fixture;
    const double     most    = 0.4;
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT};
    size_t           count   = 0;
    (void)state;
    fixture_open_as(&fixture, landscape_text, 0); /* all of its light comes in one pass */
    KrsPicture *plain    = fixture_render(&fixture, options);
    options.max_radiance = most;
    KrsPicture *clamped  = fixture_render(&fixture, options);
    for (size_t k = 0; k < (size_t)WIDTH * HEIGHT; k++) {
        const float *from = &plain->color[4 * k], *to = &clamped->color[4 * k];
        const double bright = (double)fmaxf(fmaxf(from[0], from[1]), from[2]);
        const bool   over   = bright > most;
        count += over;
        for (int i = 0; i < 3; i++)
            assert_near((double)to[i], (over ? most / bright : 1) * (double)from[i],
                        over ? 1e-6 : 0);
        assert_true(to[3] == from[3]);
    }
    assert_in_range(count, 300, WIDTH * HEIGHT - 300);
    assert_int_equal(clamped->stats.clamped, count);
    assert_int_equal(plain->stats.clamped, 0);
    krs_picture_free(plain);
    krs_picture_free(clamped);
    fixture_close_watched(&fixture);
}

static uint64_t sum_of_steps(const KrsPicture *picture)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < (size_t)picture->window.width * picture->window.height; i++)
        sum += picture->steps[i];
    return sum;
}

/* Depths that are nearer than everything leave the plate, those a little farther all.  Rays march no
   farther: to half of the way they need fewer steps. */
static void check_limits(Fixture *fixture, size_t camera)
{
    enum { ACROSS = 60, DOWN = 40, PIXELS = ACROSS * DOWN, SCALES = 3 };
    static float     depth[PIXELS], plate[PIXELS][4];
    const float      scales[SCALES] = {0.5f, 0.999f, 1.001f}, behind[4] = {1, 0.5f, 0.25f, 0.5f};
    uint64_t         steps[SCALES];
    KrsRenderOptions options = {.width = ACROSS, .height = DOWN, .camera = camera, .samples = 1};
    KrsPicture      *plain   = fixture_render(fixture, options);
    options.depth            = depth;
    options.plate            = (const float(*)[4])plate;
    options.catcher          = KRS_CATCHER_NONE; /* plates.c has shadows */
    options.crop             = (KrsWindow){3, 5, 50, 30};
    for (int scale = 0; scale < SCALES; scale++) {
        for (int i = 0; i < PIXELS; i++) {
            depth[i] = scales[scale] * plain->depth[i];
            memcpy(plate[i], behind, sizeof behind);
        }
        KrsPicture *seen = fixture_render(fixture, options);
        steps[scale]     = sum_of_steps(seen);
        for (int i = 0; i < 50 * 30; i++) {
            const int  from = (i / 50 + 5) * ACROSS + i % 50 + 3;
            const bool hit  = scales[scale] > 1 && isfinite(plain->depth[from]);
            assert_int_equal(seen->component[i], hit ? plain->component[from] : 0);
            assert_true(seen->depth[i] == (hit ? plain->depth[from] : depth[from]));
            for (int c = hit ? 3 : 0; c < 4; c++)
                assert_true(seen->color[4 * i + c] == (hit ? 1 : behind[c]));
        }
        krs_picture_free(seen);
    }
    assert_true(4 * steps[0] < 3 * steps[2] && steps[1] <= steps[2]);
    krs_picture_free(plain);
}

/* Tells whether statistics list a shader; they are to list those without a scene as well. */
static bool is_listed(const KrsRendering *rendering, const char *name)
{
    KrsShaderStats shaders[64];
    const size_t   count = krs_rendering_shaders(rendering, shaders, 64);
    for (size_t i = 0; i < count && i < 64; i++)
        if (strcmp(shaders[i].name, name) == 0)
            return true;
    return false;
}

static void depths_end_rays(void **state)
{
    (void)state;
    for (size_t k = 0; k < EMULATIONS; k += EMULATIONS - 1) {
        Fixture fixture;
        fixture_open_as(&fixture, film_text, emulations[k]);
        for (size_t camera = 0; camera < 3; camera++)
            check_limits(&fixture, camera);
        assert_true(is_listed(fixture.rendering, "limit.comp"));
        assert_true(is_listed(fixture.rendering, "shade.comp"));
        assert_false(is_listed(fixture.rendering, "aim.comp"));
        fixture_close_watched(&fixture);
    }
}

/* ---- What is refused ---- */

static bool stop(void *user, double done)
{
    (void)done;
    return --*(int *)user > 0;
}

static void failures_leave_it_empty(void **state)
{
    Fixture         *fixture = *state;
    int              left    = 1000000;
    KrsRenderOptions options = part;
    KrsPicture      *picture;
    options.progress = stop;
    options.user     = &left;
    KrsFilm *film    = new_film(fixture, &options);
    add(fixture, film, NULL, 2);
    left = 3;
    assert_int_equal(krs_film_add(film, fixture->state, NULL, 1), KRS_INTERRUPTED);
    assert_int_equal(krs_film_samples(film), 0);
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_BAD_ARGUMENT);
    assert_null(picture);
    left = 1000000;
    add(fixture, film, NULL, SAMPLES); /* and it is as good as new */
    assert_same(read_film(fixture, film), fixture_render(fixture, part));
    krs_film_free(film);
}

static void wrong_use_is_refused(void **state)
{
    Fixture               *fixture = *state;
    const KrsRenderOptions depths  = {.width = 20, .height = 10, .aovs = KRS_AOV_DEPTH};
    const KrsRenderOptions wrong[] = {{.width = 16385}, {.integrator = KRS_INTEGRATOR_COUNT}};
    KrsFilm               *film;
    KrsPicture            *picture;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_equal(krs_film_new(fixture->rendering, &wrong[i], &film), KRS_BAD_ARGUMENT);
        assert_null(film);
    }
    film = new_film(fixture, &depths);
    assert_int_equal(krs_film_add(film, fixture->state, NULL, 0), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_film_add(film, fixture->state, NULL, KRS_MAX_SAMPLES + 1),
                     KRS_BAD_ARGUMENT);
    add(fixture, film, NULL, 1);
    assert_int_equal(krs_film_add(film, fixture->state, NULL, KRS_MAX_SAMPLES), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_film_add(film, fixture->state, &(KrsCamera){.fov = 1}, 1),
                     KRS_BAD_ARGUMENT); /* its eye is at its target */
    assert_int_equal(krs_film_samples(film), 1);
    assert_int_equal(krs_film_read(film, KRS_AOV_NORMAL, &picture), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    assert_non_null(picture->depth);
    assert_null(picture->color);
    krs_picture_free(picture);
    krs_film_free(film);
    krs_film_free(NULL);
}

/* Some planes of many. */
static void planes_are_chosen_when_read(void **state)
{
    Fixture    *fixture = *state;
    KrsFilm    *film    = new_film(fixture, &part);
    KrsPicture *some;
    add(fixture, film, NULL, SAMPLES);
    assert_int_equal(krs_film_read(film, KRS_AOV_NORMAL | KRS_AOV_COLOR, &some), KRS_OK);
    assert_non_null(some->normal);
    assert_non_null(some->color);
    assert_null(some->depth);
    assert_same(some, fixture_render(fixture, part));
    krs_film_free(film);
}

static int set_up(void **state)
{
    static Fixture fixture;
    fixture_open_as(&fixture, film_text, 0);
    *state = &fixture;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(portions_are_the_whole),
        cmocka_unit_test(bands_are_swapped),
        cmocka_unit_test(films_take_turns),
        cmocka_unit_test_setup_teardown(samples_are_added, set_up, fixture_tear_down),
        cmocka_unit_test_setup_teardown(frames_may_differ, set_up, fixture_tear_down),
        cmocka_unit_test_setup_teardown(cameras_are_the_callers, set_up, fixture_tear_down),
        cmocka_unit_test(bright_rays_are_clamped),
        cmocka_unit_test(depths_end_rays),
        cmocka_unit_test_setup_teardown(failures_leave_it_empty, set_up, fixture_tear_down),
        cmocka_unit_test_setup_teardown(wrong_use_is_refused, set_up, fixture_tear_down),
        cmocka_unit_test_setup_teardown(planes_are_chosen_when_read, set_up, fixture_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
