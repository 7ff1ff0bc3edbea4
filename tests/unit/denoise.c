/*
 * denoise.c: pictures whose truth is known come nearer to it, and get nothing that is not there.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "denoise/denoise.h"
#include "tests/support/random.h"

enum { WIDTH = 90, HEIGHT = 70, PIXELS = WIDTH * HEIGHT };

/* A picture, and what it would be without noise. */
typedef struct Sample {
    float color[PIXELS][3], truth[PIXELS][3], deviation[PIXELS];
    float normal[PIXELS][3], albedo[PIXELS][3], position[PIXELS][3];
    float result[PIXELS][3];
} Sample;

static Sample sample;

static Random random_numbers = {7};

/* Returns a number of a normal distribution, nearly. */
static float draw(void)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += random_between(&random_numbers, 0, 1);
    return (float)sum;
}

/* Makes a plane that faces the camera, of a color. */
static void begin(float color)
{
    for (size_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            sample.truth[i][k]    = color;
            sample.normal[i][k]   = k == 2;
            sample.albedo[i][k]   = 0.5f;
            sample.position[i][k] = k == 0 ? (float)(i % WIDTH) : k == 1 ? (float)(i / WIDTH) : 0;
        }
}

static void add_noise(float deviation)
{
    for (size_t i = 0; i < PIXELS; i++) {
        sample.deviation[i] = deviation;
        for (int k = 0; k < 3; k++)
            sample.color[i][k] = sample.truth[i][k] + deviation * draw();
    }
}

static DenoisePlane plane(const float *first, size_t stride)
{
    return (DenoisePlane){first, stride};
}

static DenoisePicture picture(void)
{
    DenoisePicture all = {
        .width = WIDTH, .height = HEIGHT, .deviation = plane(sample.deviation, 1)};
    for (size_t k = 0; k < 3; k++) {
        all.color[k]    = plane(sample.color[0] + k, 3);
        all.normal[k]   = plane(sample.normal[0] + k, 3);
        all.albedo[k]   = plane(sample.albedo[0] + k, 3);
        all.position[k] = plane(sample.position[0] + k, 3);
    }
    return all;
}

static void run(const DenoisePicture *what)
{
    assert_int_equal(denoise(what, NULL, NULL, sample.result), KRS_OK);
}

/* Returns the mean squared error of colours. */
static double error_of(const float (*colors)[3])
{
    double sum = 0;
    for (size_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double off = (double)colors[i][k] - (double)sample.truth[i][k];
            sum += off * off;
        }
    return sum / (3 * PIXELS);
}

static double mean_of(const float (*colors)[3])
{
    double sum = 0;
    for (size_t i = 0; i < PIXELS; i++)
        sum += ((double)colors[i][0] + (double)colors[i][1] + (double)colors[i][2]) / 3;
    return sum / PIXELS;
}

static void test_constant_stays(void **state)
{
    (void)state;
    begin(0.4f);
    add_noise(0.05f);
    DenoisePicture what = picture();
    run(&what);
    assert_true(error_of((const float(*)[3])sample.result) < 0.03 * 0.05 * 0.05);
    assert_true(fabs(mean_of((const float(*)[3])sample.result) - 0.4) < 0.001);
}

static void test_guides_draw_no_edge(void **state)
{
    (void)state;
    begin(0.4f);
    for (size_t i = 0; i < PIXELS; i++)
        if (i % WIDTH >= WIDTH / 2) {
            sample.normal[i][0] = 1;
            sample.normal[i][2] = 0;
            sample.albedo[i][0] = 0.9f;
        }
    add_noise(0.05f);
    DenoisePicture what = picture();
    run(&what);
    double sides[2] = {0};
    for (size_t i = 0; i < PIXELS; i++)
        if (i % WIDTH >= WIDTH / 2 - 5 && i % WIDTH < WIDTH / 2 + 5)
            sides[i % WIDTH >= WIDTH / 2] += (double)sample.result[i][0] / (5 * HEIGHT);
    assert_true(fabs(sides[0] - sides[1]) < 0.01);
    assert_true(error_of((const float(*)[3])sample.result) < 0.05 * 0.05 * 0.05);
}

/* An edge that guides have, too, stays sharp although noise is as large as it. */
static void test_edges_stay(void **state)
{
    (void)state;
    begin(0.4f);
    for (size_t i = 0; i < PIXELS; i++)
        if (i % WIDTH >= WIDTH / 2) {
            sample.albedo[i][0] = 0.9f;
            for (int k = 0; k < 3; k++)
                sample.truth[i][k] = 0.55f;
        }
    add_noise(0.1f);
    DenoisePicture what = picture();
    run(&what);
    const double with = error_of((const float(*)[3])sample.result);
    assert_true(with < 0.05 * 0.1 * 0.1);
    for (int k = 0; k < 3; k++) /* the planted fault: guides that do not know of it */
        what.albedo[k] = plane(sample.normal[0] + 2, 3);
    run(&what);
    assert_true(error_of((const float(*)[3])sample.result) > 1.5 * with);
}

/* What has no noise is not changed: a picture of noise that is said to be none. */
static void test_without_noise(void **state)
{
    (void)state;
    begin(0.4f);
    add_noise(0.1f);
    memset(sample.deviation, 0, sizeof sample.deviation);
    DenoisePicture what = picture();
    run(&what);
    for (size_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(sample.result[i][k] - sample.color[i][k]) < 1e-4f);
}

/* Noise that is not told is found. */
static void test_unknown_noise(void **state)
{
    (void)state;
    begin(0.4f);
    add_noise(0.05f);
    DenoisePicture what = picture();
    what.deviation      = plane(NULL, 0);
    run(&what);
    assert_true(error_of((const float(*)[3])sample.result) < 0.1 * 0.05 * 0.05);
}

static void test_bad_numbers(void **state)
{
    (void)state;
    static const float bad[] = {NAN, INFINITY, -INFINITY, 1e30f};
    begin(0.4f);
    add_noise(0.02f);
    for (size_t i = 0; i < 40; i++) {
        const size_t at                          = i * 157 % PIXELS;
        sample.color[at][i % 3]                  = bad[i % 4];
        sample.normal[(at + 11) % PIXELS][i % 3] = bad[i % 4];
        sample.albedo[(at + 17) % PIXELS][i % 3] = bad[i % 4];
        sample.position[(at + 23) % PIXELS][0]   = bad[i % 4];
        sample.deviation[(at + 31) % PIXELS]     = bad[i % 4];
    }
    DenoisePicture what = picture();
    run(&what);
    for (size_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(sample.result[i][k] - 0.4f) < 0.1f);
    for (size_t i = 0; i < PIXELS; i++)
        sample.color[i][0] = NAN;
    run(&what);
    for (size_t i = 0; i < PIXELS; i++)
        assert_true(isfinite(sample.result[i][0]));
}

/* Pictures of any size, one pixel as well, and colours alone. */
static void test_sizes(void **state)
{
    (void)state;
    static const size_t sizes[][2] = {{1, 1}, {1, 70}, {90, 1}, {2, 3}, {64, 64}, {65, 1}, {5, 67}};
    begin(0.4f);
    add_noise(0.05f);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        DenoisePicture what = picture(), plain = {0};
        what.width = sizes[i][0], what.height = sizes[i][1];
        plain.width = what.width, plain.height = what.height;
        memcpy(plain.color, what.color, sizeof plain.color);
        run(&what);
        for (size_t k = 0; k < what.width * what.height; k++)
            assert_true(fabsf(sample.result[k][1] - 0.4f) < 0.25f);
        run(&plain);
        for (size_t k = 0; k < what.width * what.height; k++)
            assert_true(fabsf(sample.result[k][1] - 0.4f) < 0.25f);
    }
}

/* A pixel depends on those around it alone: no edge is seen between tiles. */
static void test_tiles(void **state)
{
    (void)state;
    static float whole[PIXELS][3];
    const size_t cut = 5;
    begin(0.4f);
    add_noise(0.05f);
    DenoisePicture what = picture();
    run(&what);
    memcpy(whole, sample.result, sizeof whole);
    const size_t first = cut * WIDTH;
    what.height -= cut;
    what.deviation.samples += first;
    for (int k = 0; k < 3; k++) {
        what.color[k].samples += 3 * first;
        what.normal[k].samples += 3 * first;
        what.albedo[k].samples += 3 * first;
        what.position[k].samples += 3 * first;
    }
    run(&what);
    for (size_t i = 30 * WIDTH; i < PIXELS; i++) /* far from the cut, where tiles begin elsewhere */
        assert_memory_equal(whole[i], sample.result[i - first], sizeof whole[i]);
}

static bool refuse(void *user, double fraction)
{
    (void)user, (void)fraction;
    return false;
}

static void test_cancelled(void **state)
{
    (void)state;
    begin(0.4f);
    add_noise(0.05f);
    DenoisePicture what = picture();
    assert_int_equal(denoise(&what, refuse, NULL, sample.result), KRS_INTERRUPTED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant_stays), cmocka_unit_test(test_guides_draw_no_edge),
        cmocka_unit_test(test_edges_stay),     cmocka_unit_test(test_without_noise),
        cmocka_unit_test(test_unknown_noise),  cmocka_unit_test(test_bad_numbers),
        cmocka_unit_test(test_sizes),          cmocka_unit_test(test_tiles),
        cmocka_unit_test(test_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
