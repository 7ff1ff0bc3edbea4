/*
 * pixel_filters.c: pictures of edges are what the integral of the pixel filter says; the first ray
 * goes through the middle of the pixel with each filter, and beams do not lose what filters see
 * beside their tiles.
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

enum { ACROSS = 24, DOWN = 12, SAMPLES = 128 };

/* Pictures of 24 x 12 units, a pixel for each: a wall that ends at x = 0.3, and another whose edge is
   slanted; its normal is (3, 4) / 5. */
static const char edges_text[] =
    "camera { eye: [0, 0, 9], target: [0, 0, 0], projection: \"orthographic\", height: 12 }\n"
    "camera slanted { eye: [100, 0, 9], target: [100, 0, 0], projection: \"orthographic\", "
    "height: 12 }\n"
    "light sun { direction: [0, 0, 1], shadow: false }\n"
    "show box([60, 60, 1]).move([-29.7, 0, 0]);\n"
    "show box([60, 60, 1]).move([-29.8, 0, 0]).rotate([0, 0, 1], 53.130102354156deg)"
    ".within(box([30, 30, 5])).move([100, 0, 0]);\n";

/* Returns the weight of a place, in pixels from the middle; not normalized. */
static double weight(KrsPixelFilter filter, double x)
{
    const double t = 2 * M_PI * (x + 1.5) / 3;
    switch (filter) {
    case KRS_PIXEL_FILTER_GAUSSIAN:
        return fabs(x) < 1.5 ? exp(-2 * x * x) - exp(-2 * 1.5 * 1.5) : 0;
    case KRS_PIXEL_FILTER_BLACKMAN_HARRIS:
        return fabs(x) < 1.5
                   ? 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2 * t) - 0.01168 * cos(3 * t)
                   : 0;
    default: return fabs(x) < 0.5 ? 1 : 0;
    }
}

/* Returns the part of the filter's weight where a x + b y < offset, by brute force. */
static double part_below(KrsPixelFilter filter, double a, double b, double offset)
{
    const double step  = 0.02;
    double       below = 0, all = 0;
    for (double y = -1.5 + step / 2; y < 1.5; y += step)
        for (double x = -1.5 + step / 2; x < 1.5; x += step) {
            double w = weight(filter, x) * weight(filter, y);
            all += w;
            below += a * x + b * y < offset ? w : 0;
        }
    return below / all;
}

static KrsPicture *render(Fixture *fixture, KrsPixelFilter filter, size_t camera, uint32_t samples)
{
    return fixture_render(fixture, (KrsRenderOptions){.width        = ACROSS,
                                                      .height       = DOWN,
                                                      .samples      = samples,
                                                      .camera       = camera,
                                                      .no_occlusion = true,
                                                      .pixel_filter = filter,
                                                      .aovs = KRS_AOV_COLOR | KRS_AOV_POSITION});
}

static void edges_are_the_integral(void **state)
{
    static const double normals[2][2] = {{1, 0}, {0.6, 0.8}}, offsets[2] = {0.3, 0.2};
    Fixture            *fixture = *state;
    for (KrsPixelFilter filter = KRS_PIXEL_FILTER_BOX; filter < KRS_PIXEL_FILTER_COUNT; filter++)
        for (size_t camera = 0; camera < 2; camera++) {
            const double *n       = normals[camera];
            KrsPicture   *picture = render(fixture, filter, camera, SAMPLES);
            size_t        soft    = 0;
            for (int row = 2; row < DOWN - 2; row++)
                for (int column = 2; column < ACROSS - 2; column++) {
                    const double x = column + 0.5 - 0.5 * ACROSS, y = 0.5 * DOWN - row - 0.5;
                    const double rest = offsets[camera] - n[0] * x - n[1] * y;
                    const float  seen = picture->color[4 * (row * ACROSS + column) + 3];
                    if (fabs(rest) > 3)
                        assert_near((double)seen, rest > 0 ? 1 : 0, 1e-6);
                    else
                        assert_near((double)seen, part_below(filter, n[0], n[1], rest), 0.03);
                    soft += seen > 0.001f && seen < 0.999f;
                }
            assert_true(soft >= 8);
            krs_picture_free(picture);
        }
}

static void one_ray_is_in_the_middle(void **state)
{
    Fixture    *fixture = *state;
    KrsPicture *box     = render(fixture, KRS_PIXEL_FILTER_BOX, 1, 1);
    for (KrsPixelFilter filter = KRS_PIXEL_FILTER_BOX; filter < KRS_PIXEL_FILTER_COUNT; filter++) {
        KrsPicture *one = render(fixture, filter, 1, 1), *many = render(fixture, filter, 1, 8);
        assert_memory_equal(one->color, box->color, 16 * ACROSS * DOWN);
        assert_memory_equal(many->position, box->position, 12 * ACROSS * DOWN);
        krs_picture_free(one);
        krs_picture_free(many);
    }
    krs_picture_free(box);
}

/* A thin needle lies across the picture, just behind the corners of tiles of 4 x 4 pixels, where
   filters see beside the tile.  Beams must not lose it: the pictures without them are the truth.
   The tori are out of the picture; they make the distance so dear that quarters have beams. */
static void beams_see_beside_their_tiles(void **state)
{
    static const char text[] =
        "camera { eye: [0, 0, 9], projection: \"orthographic\", height: 128 }\n"
        "light sun { direction: [0, 0, 1], shadow: false }\n"
        "show box([400, 0.2, 0.2]).rotate([0, 0, 1], -45deg).move([0, 1, 0])"
        " | union([torus(1 + 0.1 * i, 0.2 + 0.01 * i * i).rotate([1, i, 0], i).move([90, 9 * i, 0])"
        " for i in 0..9]);\n";
    Fixture fixture = {0};
    (void)state;
    fixture_open(&fixture, text, NULL);
    KrsRenderOptions options = {.width        = 128,
                                .height       = 128,
                                .samples      = 96,
                                .no_occlusion = true,
                                .pixel_filter = KRS_PIXEL_FILTER_GAUSSIAN};
    KrsPicture      *with    = fixture_render(&fixture, options);
    options.methods.no_beams = true;
    KrsPicture *without      = fixture_render(&fixture, options);
    size_t      differ = 0, seen = 0;
    for (size_t i = 3; i < (size_t)4 * 128 * 128; i += 4) {
        differ += fabsf(with->color[i] - without->color[i]) > 1e-6f;
        seen += without->color[i] > 0;
    }
    assert_int_equal(differ, 0);
    assert_in_range(seen, 300, 1500);
    krs_picture_free(with);
    krs_picture_free(without);
    fixture_close(&fixture);
}

/* The scene asks by its name, and the caller's choice is stronger. */
static void scenes_choose(void **state)
{
    Fixture *fixture = *state, soft = {0};
    char     text[sizeof edges_text + 80];
    for (KrsPixelFilter filter = KRS_PIXEL_FILTER_GAUSSIAN; filter < KRS_PIXEL_FILTER_COUNT;
         filter++) {
        snprintf(text, sizeof text, "image { pixel_filter: \"%s\" }\n%s",
                 krs_pixel_filter_names[filter], edges_text);
        fixture_open(&soft, text, NULL);
        KrsPicture *mine  = render(fixture, filter, 1, 5);
        KrsPicture *asked = render(&soft, KRS_PIXEL_FILTER_DEFAULT, 1, 5);
        assert_memory_equal(mine->color, asked->color, 16 * ACROSS * DOWN);
        krs_picture_free(asked);
        krs_picture_free(mine);
        mine  = render(fixture, KRS_PIXEL_FILTER_BOX, 1, 5);
        asked = render(&soft, KRS_PIXEL_FILTER_BOX, 1, 5);
        assert_memory_equal(mine->color, asked->color, 16 * ACROSS * DOWN);
        krs_picture_free(asked);
        krs_picture_free(mine);
        fixture_close(&soft);
    }
}

static int set_up(void **state)
{
    static Fixture fixture;
    fixture_open(&fixture, edges_text, NULL);
    *state = &fixture;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_are_the_integral),
        cmocka_unit_test(one_ray_is_in_the_middle),
        cmocka_unit_test(beams_see_beside_their_tiles),
        cmocka_unit_test(scenes_choose),
    };
    return cmocka_run_group_tests(tests, set_up, fixture_tear_down);
}
