/*
 * lens.c: lenses, shutters and pairs of eyes show what their closed forms say of a small ball: the
 * circle of confusion, the way that something moves, the parallax.
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
#include "tests/unit/tracer_fixture.h"

enum { SIDE = 96 };
#define FOV      (40 * M_PI / 180)
#define APERTURE 0.2
#define FOCUS    8.0

/* The eye is at the origin and looks along -z; `away` is the distance of the ball. */
static const char lens_text[] =
    "param away = 4 in [1, 40]; param beside = 0 in [-9, 9]; param size = 0.02 in [0.001, 2];\n"
    "camera { eye: [0, 0, 0], target: [0, 0, -1], fov: 40deg, aperture: 0.2, focus: 8 }\n"
    "camera five { eye: [0, 0, 0], target: [0, 0, -2], fov: 40deg, aperture: 0.2,"
    "              focus: [3, 1, -8], blades: 5 }\n"
    "camera flat { eye: [0, 0, 0], target: [0, 0, -8], projection: \"orthographic\", height: 4,"
    "              aperture: 0.2 }\n"
    "camera plain { eye: [0, 0, 0], target: [0, 0, -1], fov: 40deg }\n"
    "camera moved { eye: [0, 0, 0], target: [0, 0, -1], fov: 40deg, shift: [0.25, -0.125] }\n"
    "camera blurs { eye: [0, 0, 0], target: [0, 0, -1], fov: 40deg, shutter: [0.25, 0.75] }\n"
    "camera turns { eye: [0, 0, 0], target: [0, 0, -8], fov: 40deg, eyes: 0.3 }\n"
    "camera round { eye: [0, 0, 0], target: [0, 0, -8], projection: \"panorama\", eyes: 0.4 }\n"
    "light sun { direction: [0, 0, 1], shadow: false }\n"
    "show sphere(size).move([beside + time, 0, -away]);\n";
enum { LENS, FIVE, ORTHOGRAPHIC, PLAIN, MOVED, BLURS, TURNS, ALL_AROUND };

/* What the alpha of a picture says of where the ball is, in pixels from the picture's middle. */
typedef struct Blot {
    double weight, x, y, spread; /* spread: mean square of the distance from (x, y) */
    double farthest;             /* from (x, y), of what is seen at all */
} Blot;

static Blot find_blot(const KrsPicture *picture)
{
    const int width = (int)picture->width, height = (int)picture->height;
    Blot      blot   = {0};
    double    square = 0;
    for (int k = 0; k < width * height; k++) {
        double x = k % width + 0.5 - 0.5 * width, y = 0.5 * height - k / width - 0.5;
        double alpha = (double)picture->color[4 * k + 3];
        blot.weight += alpha;
        blot.x += alpha * x;
        blot.y += alpha * y;
        square += alpha * (x * x + y * y);
    }
    assert_true(blot.weight > 0);
    blot.x /= blot.weight;
    blot.y /= blot.weight;
    blot.spread = square / blot.weight - blot.x * blot.x - blot.y * blot.y;
    for (int k = 0; k < width * height; k++)
        if (picture->color[4 * k + 3] > 0)
            blot.farthest = fmax(blot.farthest, hypot(k % width + 0.5 - 0.5 * width - blot.x,
                                                      0.5 * height - k / width - 0.5 - blot.y));
    return blot;
}

static void set(Fixture *fixture, const char *name, double value)
{
    assert_int_equal(krs_state_set(fixture->state, name, &value, 1), KRS_OK);
}

static KrsPicture *render(Fixture *fixture, size_t camera, uint32_t samples, KrsEye eye)
{
    return fixture_render(fixture, (KrsRenderOptions){.width         = SIDE,
                                                      .height        = SIDE,
                                                      .samples       = samples,
                                                      .camera        = camera,
                                                      .eye           = eye,
                                                      .frame_seconds = 0.5,
                                                      .no_occlusion  = true});
}

static Blot see(Fixture *fixture, size_t camera, uint32_t samples, KrsEye eye)
{
    KrsPicture *picture = render(fixture, camera, samples, eye);
    Blot        blot    = find_blot(picture);
    krs_picture_free(picture);
    return blot;
}

/* A pixel at distance 1 is this wide. */
static double pixel(void) { return 2 * tan(FOV / 2) / SIDE; }

/* ---- depth of field ---- */

/* The mean square of a disc, or of a polygon of so many corners, of radius 1. */
static double spread_of(size_t camera)
{
    return camera == FIVE ? (2 + cos(2 * M_PI / 5)) / 6 : 0.5;
}

static void balls_have_circles_of_confusion(void **state)
{
    static const double depths[] = {2, 5, 30};
    Fixture            *fixture  = *state;
    for (size_t i = 0; i < sizeof depths / sizeof depths[0]; i++)
        for (size_t camera = LENS; camera <= ORTHOGRAPHIC; camera++) {
            const bool   flat = camera == ORTHOGRAPHIC;
            const double z = depths[i], unit = flat ? 4.0 / SIDE : pixel() * z;
            const double ball = 1.5, size = ball * unit;
            /* All rays through the lens that see a point meet the picture within this circle. */
            const double circle = APERTURE * fabs(1 - z / FOCUS) / unit;
            set(fixture, "away", z);
            set(fixture, "size", size);
            const Blot   blot   = see(fixture, camera, 64, KRS_EYE_OF_BOTH);
            const double spread = circle * circle * spread_of(camera) + ball * ball / 2 + 1.0 / 6;
            assert_near(blot.spread / spread, 1, 0.08);
            assert_true(blot.farthest < circle + ball + 1.2);
            assert_true(camera == FIVE || blot.farthest > circle + ball - 1.2);
            assert_near(hypot(blot.x, blot.y), 0, 0.05 * circle + 0.1);
            /* Light is spread, not lost. */
            assert_near(blot.weight / (M_PI * ball * ball), 1, 0.12);
        }
}

static void what_is_in_focus_is_sharp(void **state)
{
    Fixture *fixture = *state;
    set(fixture, "away", FOCUS);
    set(fixture, "size", 0.5);
    for (size_t camera = LENS; camera <= FIVE; camera++) {
        Blot sharp = see(fixture, PLAIN, 16, KRS_EYE_OF_BOTH);
        Blot seen  = see(fixture, camera, 16, KRS_EYE_OF_BOTH);
        assert_near(seen.spread / sharp.spread, 1, 0.01);
        assert_near(seen.weight / sharp.weight, 1, 0.01);
    }
}

/* Planes other than colour, and pictures of one sample, come from the ray through the middle. */
static void planes_are_sharp(void **state)
{
    Fixture *fixture = *state;
    set(fixture, "away", 3);
    set(fixture, "size", 0.5);
    KrsPicture *plain = render(fixture, PLAIN, 1, KRS_EYE_OF_BOTH);
    KrsPicture *lens  = render(fixture, LENS, 8, KRS_EYE_OF_BOTH);
    KrsPicture *one   = render(fixture, LENS, 1, KRS_EYE_OF_BOTH);
    size_t      hits = 0, between = 0;
    for (size_t k = 0; k < (size_t)SIDE * SIDE; k++) {
        assert_int_equal(lens->component[k], plain->component[k]);
        assert_near(one->color[4 * k + 3], plain->color[4 * k + 3], 0);
        hits += plain->component[k];
        between += lens->color[4 * k + 3] > 0 && lens->color[4 * k + 3] < 1;
        for (int i = 0; i < 3; i++)
            assert_near(lens->position[3 * k + i], plain->position[3 * k + i], 2e-3f);
        assert_true(isinf(lens->depth[k]) ? isinf(plain->depth[k])
                                          : fabsf(lens->depth[k] - plain->depth[k]) < 2e-3f);
    }
    assert_true(hits > 500 && between > 200);
    krs_picture_free(plain);
    krs_picture_free(lens);
    krs_picture_free(one);
}

/* A film adds up to the same picture, whatever the portions. */
static void portions_are_the_whole(void **state)
{
    static const size_t cameras[] = {LENS, BLURS};
    Fixture            *fixture   = *state;
    for (size_t i = 0; i < 2; i++) {
        const KrsRenderOptions options = {.width         = SIDE,
                                          .height        = SIDE,
                                          .samples       = 5,
                                          .camera        = cameras[i],
                                          .frame_seconds = 0.5};
        KrsFilm               *film;
        KrsPicture            *whole = fixture_render(fixture, options), *parts;
        assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_OK);
        assert_int_equal(krs_film_add(film, fixture->state, NULL, 2), KRS_OK);
        assert_int_equal(krs_film_add(film, fixture->state, NULL, 3), KRS_OK);
        assert_int_equal(krs_film_read(film, 0, &parts), KRS_OK);
        assert_memory_equal(whole->color, parts->color, 16 * SIDE * SIDE);
        assert_memory_equal(whole->depth, parts->depth, 4 * SIDE * SIDE);
        krs_film_free(film);
        krs_picture_free(whole);
        krs_picture_free(parts);
    }
}

/* ---- shift ---- */

static void shifts_move_the_picture(void **state)
{
    Fixture *fixture = *state;
    set(fixture, "away", 5);
    set(fixture, "size", 0.6);
    KrsPicture *plain = render(fixture, PLAIN, 1, KRS_EYE_OF_BOTH);
    KrsPicture *moved = render(fixture, MOVED, 1, KRS_EYE_OF_BOTH);
    size_t      hits  = 0;
    for (int row = 12; row < SIDE; row++) /* moved down by an eighth, and right by a quarter */
        for (int column = SIDE / 4; column < SIDE; column++) {
            size_t from = (size_t)row * SIDE + column, to = from - 12 * SIDE - SIDE / 4;
            assert_int_equal(moved->component[to], plain->component[from]);
            hits += moved->component[to] != 0;
            for (int i = 0; i < 3; i++)
                assert_near(moved->position[3 * to + i], plain->position[3 * from + i], 2e-3f);
        }
    assert_true(hits > 100);
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++) {
            const size_t k      = (size_t)row * SIDE + column;
            const float *p      = &moved->position[3 * k];
            double       ndc[4] = {0}, x = (2 * column + 1.0) / SIDE - 1;
            double       y       = 1 - (2 * row + 1.0) / SIDE;
            const float  from[4] = {p[0], p[1], p[2], 1};
            for (int c = 0; c < 4; c++)
                for (int r = 0; r < 4; r++)
                    ndc[c] += (double)from[r] * (double)moved->world_to_ndc[r][c];
            if (moved->component[k]) {
                assert_near(ndc[0] / ndc[3], x, 1e-3);
                assert_near(ndc[1] / ndc[3], y, 1e-3);
            }
        }
    krs_picture_free(plain);
    krs_picture_free(moved);
}

/* The matrices alone are enough to find each pixel's ray, as a compositor does. */
static void matrices_rebuild_the_camera(void **state)
{
    static const size_t cameras[] = {PLAIN, MOVED, ORTHOGRAPHIC};
    Fixture            *fixture   = *state;
    set(fixture, "away", 5);
    set(fixture, "beside", 0.3);
    set(fixture, "size", 0.7);
    for (size_t i = 0; i < 3; i++) {
        KrsPicture *picture = render(fixture, cameras[i], 1, KRS_EYE_OF_BOTH);
        const float(*c)[4]  = (const float(*)[4])picture->world_to_camera;
        const float(*n)[4]  = (const float(*)[4])picture->world_to_ndc;
        const bool flat     = cameras[i] == ORTHOGRAPHIC;
        double     eye[3], scale[2] = {0}, shift[2] = {0};
        size_t     hits = 0;
        for (int k = 0; k < 3; k++) { /* the axes are the columns */
            eye[k] = 0;
            for (int a = 0; a < 3; a++)
                eye[k] -= (double)c[3][a] * (double)c[k][a];
            assert_near(eye[k], 0, 1e-6);
            for (int a = 0; a < 2; a++) {
                scale[a] += (double)n[k][a] * (double)c[k][a];
                shift[a] += (double)n[k][a] * (double)c[k][2];
            }
        }
        for (int k = 0; k < SIDE * SIDE; k++) {
            const float *p     = &picture->position[(size_t)3 * (size_t)k];
            const double x     = (2 * (k % SIDE) + 1.0) / SIDE - 1;
            const double y     = 1 - (2 * (k / SIDE) + 1.0) / SIDE;
            const double u[3]  = {(x - shift[0]) / scale[0], (y - shift[1]) / scale[1], 1};
            double       to[3] = {0}; /* the hit in camera space, over its depth */
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++)
                    to[a] += ((double)p[b] - eye[b]) * (double)c[b][a];
            if (picture->component[k] == 0)
                continue;
            hits++;
            assert_near(to[0], u[0] * (flat ? 1 : to[2]), 2e-3);
            assert_near(to[1], u[1] * (flat ? 1 : to[2]), 2e-3);
            assert_near(to[2], (double)picture->depth[k], 1e-4);
        }
        assert_true(hits > 100);
        krs_picture_free(picture);
    }
    set(fixture, "beside", 0);
}

static void beams_of_shifted_pictures_lose_nothing(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = {
        .width = SIDE, .height = SIDE, .camera = MOVED, .no_occlusion = true};
    set(fixture, "away", 30);
    for (double size = 0.01; size < 1; size *= 2) {
        set(fixture, "size", size);
        options.methods.no_beams = false;
        KrsPicture *with         = fixture_render(fixture, options);
        options.methods.no_beams = true;
        KrsPicture *without      = fixture_render(fixture, options);
        assert_memory_equal(with->component, without->component, 4 * SIDE * SIDE);
        krs_picture_free(with);
        krs_picture_free(without);
    }
}

/* ---- shutter ---- */

/* The ball moves by 1 unit in a second.  Frames are half a second apart, and the shutter is open
   from a quarter of that to three quarters: while the ball is 0.125 to 0.375 to the right. */
static void what_moves_is_drawn_out(void **state)
{
    Fixture     *fixture = *state;
    const double z = 4, unit = pixel() * z, size = 0.05 / unit, way = 0.25 / unit;
    set(fixture, "away", z);
    set(fixture, "size", 0.05);
    const Blot still = see(fixture, PLAIN, 64, KRS_EYE_OF_BOTH);
    const Blot blot  = see(fixture, BLURS, 64, KRS_EYE_OF_BOTH);
    assert_near(still.x, 0, 0.05);
    assert_near(blot.x, 0.25 / unit, 0.1);
    assert_near(blot.spread / (way * way / 12 + size * size / 2 + 1.0 / 6), 1, 0.03);
    assert_near(blot.weight / still.weight, 1, 0.02);
    assert_near(krs_state_time(fixture->state), 0, 0);
    /* The planes are those of the middle. */
    set(fixture, "beside", 0.25);
    KrsPicture *middle = render(fixture, PLAIN, 1, KRS_EYE_OF_BOTH);
    set(fixture, "beside", 0);
    KrsPicture *moving = render(fixture, BLURS, 16, KRS_EYE_OF_BOTH);
    assert_memory_equal(middle->component, moving->component, 4 * SIDE * SIDE);
    krs_picture_free(middle);
    krs_picture_free(moving);
}

/* ---- two eyes ---- */

static void eyes_see_the_parallax(void **state)
{
    static const double depths[] = {4, 8, 16};
    Fixture            *fixture  = *state;
    for (size_t i = 0; i < 3; i++) {
        const double z = depths[i];
        set(fixture, "size", 0.1);
        set(fixture, "away", z);
        const Blot left  = see(fixture, TURNS, 16, KRS_EYE_ON_LEFT);
        const Blot right = see(fixture, TURNS, 16, KRS_EYE_ON_RIGHT);
        assert_near(left.x - right.x, 0.3 * (1 / z - 1 / 8.0) / pixel(), 0.1);
        assert_near(left.x + right.x, 0, 0.25);
        /* A panorama has each eye 0.2 from the middle, across the way that it looks. */
        set(fixture, "size", 0.7);
        const Blot west = see(fixture, ALL_AROUND, 64, KRS_EYE_ON_LEFT);
        const Blot east = see(fixture, ALL_AROUND, 64, KRS_EYE_ON_RIGHT);
        assert_near(west.x - east.x, 2 * asin(0.2 / z) / (2 * M_PI) * SIDE, 0.15);
    }
}

static void pictures_are_joined(void **state)
{
    Fixture    *fixture = *state;
    KrsPicture *eyes[2], *joined, *small;
    set(fixture, "away", 4);
    set(fixture, "size", 0.5);
    eyes[0] = render(fixture, TURNS, 2, KRS_EYE_ON_LEFT);
    eyes[1] = render(fixture, TURNS, 2, KRS_EYE_ON_RIGHT);
    for (int below = 0; below < 2; below++) {
        assert_int_equal(krs_picture_join(eyes[0], eyes[1], below, &joined), KRS_OK);
        assert_int_equal(joined->width, below ? SIDE : 2 * SIDE);
        assert_int_equal(joined->height, below ? 2 * SIDE : SIDE);
        assert_int_equal(joined->stats.rays, 2 * eyes[0]->stats.rays);
        for (size_t k = 0; k < (size_t)2 * SIDE * SIDE; k++) {
            const size_t      x = k % joined->width, y = k / joined->width;
            const size_t      from = y % SIDE * SIDE + x % SIDE;
            const KrsPicture *eye  = eyes[x >= SIDE || y >= SIDE];
            assert_memory_equal(&joined->color[4 * k], &eye->color[4 * from], 16);
            assert_memory_equal(&joined->normal[3 * k], &eye->normal[3 * from], 12);
            assert_int_equal(joined->component[k], eye->component[from]);
        }
        krs_picture_free(joined);
    }
    small = fixture_render(fixture, (KrsRenderOptions){.width = SIDE, .height = 8});
    assert_int_equal(krs_picture_join(eyes[0], small, false, &joined), KRS_BAD_ARGUMENT);
    assert_null(joined);
    krs_picture_free(small);
    krs_picture_free(eyes[0]);
    krs_picture_free(eyes[1]);
}

/* ---- what is refused ---- */

static void wrong_lenses_are_refused(void **state)
{
    Fixture         *fixture = *state;
    KrsCamera        good    = {.fov = 1, .target = {0, 0, -1}, .up = {0, 1, 0}};
    KrsCamera        wrong[] = {good, good, good};
    KrsRenderOptions options = {.width = 20, .height = 10};
    KrsFilm         *film;
    wrong[0].aperture = -1;
    wrong[1].focus    = -3;
    wrong[2].shift[1] = INFINITY;
    assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(krs_film_add(film, fixture->state, &wrong[i], 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_film_add(film, fixture->state, &good, 1), KRS_OK);
    krs_film_free(film);
    options.light = 2; /* there is one */
    assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add(film, fixture->state, &good, 1), KRS_BAD_ARGUMENT);
    krs_film_free(film);
}

static int set_up(void **state)
{
    static Fixture fixture;
    fixture_open(&fixture, lens_text, NULL);
    *state = &fixture;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_have_circles_of_confusion),
        cmocka_unit_test(what_is_in_focus_is_sharp),
        cmocka_unit_test(planes_are_sharp),
        cmocka_unit_test(portions_are_the_whole),
        cmocka_unit_test(shifts_move_the_picture),
        cmocka_unit_test(matrices_rebuild_the_camera),
        cmocka_unit_test(beams_of_shifted_pictures_lose_nothing),
        cmocka_unit_test(what_moves_is_drawn_out),
        cmocka_unit_test(eyes_see_the_parallax),
        cmocka_unit_test(pictures_are_joined),
        cmocka_unit_test(wrong_lenses_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, fixture_tear_down);
}
