/*
 * upsampling.c: what saves rays to lights and to the sky is not seen: upsampling, neighbours that
 * share what their rays find, and pictures of a part.
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
#include "compiler/base/srgb.h"
#include "runtime/display/display.h"
#include "tests/oracle/shadow_fixture.h"

#define MAX_OFF_SHARED 0.03 /* of means of 5x5 pixels of colours, root of the mean square */
/* Shares of the subpixels that may be off by more than 1 and by more than 4 of 255. */
#define MAX_OVER_1 1e-3
#define MAX_OVER_4 2e-4

enum { WIDTH = 320, HEIGHT = 180 };

/* How much of a picture is not as another, in steps of 1 of 255 of sRGB. */
typedef struct Difference {
    double most, over_1, over_4; /* shares of the subpixels */
} Difference;

static void to_screen(const KrsImage *image, const float color[4], double out[3])
{
    ToneMap curve = TONE_NEUTRAL;
    double  light[3];
    assert_true(!image->tone_map || tone_map_find(image->tone_map, &curve));
    for (int i = 0; i < 3; i++)
        light[i] = (double)color[i] * exp2(image->exposure);
    tone_map_apply(curve, light, out);
    for (int i = 0; i < 3; i++)
        out[i] = 255 * srgb_of_linear(out[i]);
}

static Difference compare_pictures(const KrsImage *image, const KrsPicture *a, const KrsPicture *b)
{
    Difference   difference = {0};
    const double each       = 1.0 / (3 * WIDTH * HEIGHT);
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        double here[3], there[3];
        to_screen(image, a->color + 4 * k, here);
        to_screen(image, b->color + 4 * k, there);
        for (int i = 0; i < 3; i++) {
            double off      = fabs(here[i] - there[i]);
            difference.most = fmax(difference.most, off);
            difference.over_1 += off > 1 ? each : 0;
            difference.over_4 += off > 4 ? each : 0;
        }
    }
    return difference;
}

static bool is_unseen(Difference difference)
{
    return difference.over_1 <= MAX_OVER_1 && difference.over_4 <= MAX_OVER_4;
}

/* A picture with upsampling, and one without. */
static void take_both(KrsRendering *rendering, KrsState *state, KrsPicture *pictures[2])
{
    for (int i = 0; i < 2; i++)
        pictures[i] = take_picture(
            rendering, state,
            (KrsRenderOptions){
                .width = WIDTH, .height = HEIGHT, .samples = 1, .methods.no_upsampling = i});
}

static bool upsampling_is_unseen(const char *name, KrsState *state, KrsPicture *pictures[2])
{
    KrsView view;
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);
    Difference d = compare_pictures(&view.image, pictures[0], pictures[1]);
    print_message("# upsampling, %s: off by %.1f of 255 at most, %.3f %% by more than 1, %.3f %% "
                  "by more than 4\n",
                  name, d.most, 100 * d.over_1, 100 * d.over_4);
    return is_unseen(d);
}

/* ---- Neighbours that share ---- */

/* The mean of pictures of one ray each to lights and sky, through the pixels' centres, of which
   neighbours know nothing. */
static KrsPicture *take_reference(KrsRendering *rendering, KrsState *state)
{
    enum { SEEDS = 16 };
    const size_t     numbers = 4 * (size_t)WIDTH * HEIGHT;
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .methods.no_upsampling = true};
    KrsPicture *sum = take_picture(rendering, state, options);
    for (options.seed = 1; options.seed < SEEDS; options.seed++) {
        KrsPicture *picture = take_picture(rendering, state, options);
        for (size_t i = 0; i < numbers; i++)
            sum->color[i] += picture->color[i];
        krs_picture_free(picture);
    }
    for (size_t i = 0; i < numbers; i++)
        sum->color[i] /= SEEDS;
    return sum;
}

/* How far means of 5x5 pixels are apart, as a share of the mean colour, root of the mean square. */
static double means_apart(const KrsPicture *a, const KrsPicture *b)
{
    double squares = 0, sum = 0;
    for (int y = 2; y < HEIGHT - 2; y++)
        for (int x = 2; x < WIDTH - 2; x++)
            for (int c = 0; c < 3; c++) {
                double mean = 0;
                for (int i = 0; i < 25; i++) {
                    int k = 4 * ((y + i / 5 - 2) * WIDTH + x + i % 5 - 2) + c;
                    mean += ((double)a->color[k] - (double)b->color[k]) / 25;
                }
                squares += mean * mean;
                sum += (double)b->color[4 * (y * WIDTH + x) + c];
            }
    double count = 3.0 * (WIDTH - 4) * (HEIGHT - 4);
    return sqrt(squares / count) / (sum / count);
}

/* A picture whose neighbours share, against the reference of the same scene, or a scene with its
   light from elsewhere. */
static bool sharing_is_unseen(const char *name, KrsRendering *rendering, KrsState *state)
{
    KrsPicture *reference = take_reference(rendering, state);
    KrsPicture *picture   = take_picture(
          rendering, state, (KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .samples = 1});
    double apart = means_apart(picture, reference);
    print_message("# %s, neighbours share: means off by %.4f of the mean\n", name, apart);
    for (int k = 0; k < WIDTH * HEIGHT / 8; k++) /* a planted fault: an eighth is darker */
        for (int i = 0; i < 3; i++)
            picture->color[4 * (k + WIDTH * HEIGHT / 2) + i] *= 0.85F;
    double planted = means_apart(picture, reference);
    assert_false(planted < MAX_OFF_SHARED);
    krs_picture_free(reference);
    krs_picture_free(picture);
    return apart < MAX_OFF_SHARED;
}

static bool example_is_unharmed(const char *path)
{
    Product       product = {0};
    KrsRendering *rendering;
    assert_int_equal(krs_compile_file(path, NULL, &product.scene), KRS_OK);
    assert_int_equal(krs_state_new(product.scene, &product.state), KRS_OK);
    open_rendering(&product, &rendering);
    bool unseen = sharing_is_unseen(path, rendering, product.state);
    krs_rendering_free(rendering);
    product_free(&product);
    return unseen;
}

/* Barth's sextic from near and far: nodes, creases, and hits by power series. */
static void sharing_does_not_change_algebraic_surfaces(void **context)
{
    (void)context;
    static const double angles[] = {40, 10};
    size_t              wrong    = 0;
    for (int i = 0; i < 2; i++) {
        SceneText     text = {0};
        KrsRendering *rendering;
        scene_write(&text,
                    "let g = (1 + sqrt(5)) / 2;\n"
                    "show algebraic((1 + 2 * g) * (x^2 + y^2 + z^2 - 1)^2 ==\n"
                    "    4 * (g^2 * x^2 - y^2) * (g^2 * y^2 - z^2) * (g^2 * z^2 - x^2))\n"
                    "    .within(sphere(1.8));\n"
                    "camera { eye: [0, 2, 5], target: [0, -0.7, 0], fov: %gdeg }\n",
                    angles[i]);
        Product product = product_compile(text.bytes);
        open_rendering(&product, &rendering);
        wrong += !sharing_is_unseen("a sextic", rendering, product.state);
        krs_rendering_free(rendering);
        product_free(&product);
    }
    assert_int_equal(wrong, 0);
}

static void sharing_does_not_change_examples(void **context)
{
    (void)context;
    static const char *const paths[] = {"examples/02-gear.krs", "examples/06-temple.krs"};
    size_t                   wrong   = 0;
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++)
        wrong += !example_is_unharmed(paths[i]);
    assert_int_equal(wrong, 0);
}

/* ---- Thin shadows ---- */

/* Pixels in shadow of the second picture, and how many of them are lit in the first. */
static size_t count_holes(KrsPicture *const pictures[2], size_t *dark)
{
    size_t holes = 0;
    *dark        = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        double first = seen_at(pictures[0], k), second = seen_at(pictures[1], k);
        if (second < 0 || second >= 0.5)
            continue;
        (*dark)++;
        holes += first >= 0.5;
    }
    return holes;
}

static void upsampling_keeps_thin_shadows(void **context)
{
    (void)context;
    static const double widths[] = {1, 2, 4}; /* pixels */
    size_t              wrong    = 0;
    for (int i = 0; i < 3; i++) {
        char        name[40];
        KrsPicture *pictures[2];
        Fixture    *fixture = use_fixture(TWIGS);
        size_t      dark, holes;
        Shot        shot = {TWIGS,
                            {-0.5, 1.4, -0.4},
                            0,
                            0.5 * widths[i] * fixture->high / HEIGHT,
                            {.width = WIDTH, .height = HEIGHT},
                            0};
        set_lighting(&shot);
        take_both(fixture->rendering, fixture->product.state, pictures);
        snprintf(name, sizeof name, "shadows %g pixels wide", widths[i]);
        wrong += !upsampling_is_unseen(name, fixture->product.state, pictures);
        holes = count_holes(pictures, &dark);
        print_message("# upsampling: %zu pixels in shadow, %zu of them lit\n", dark, holes);
        assert_true(dark > 300);
        wrong += holes > 0;
        krs_picture_free(pictures[0]);
        krs_picture_free(pictures[1]);
    }
    assert_int_equal(wrong, 0);
}

/* ---- Crops ---- */

/* Tells whether a picture of a part has the colours of the whole, bit by bit. */
static bool is_part_of(const KrsPicture *whole, const KrsPicture *part)
{
    const KrsWindow w = part->window;
    for (uint32_t y = 0; y < w.height; y++)
        if (memcmp(whole->color + 4 * ((w.y + y) * whole->width + w.x),
                   part->color + 4 * (y * w.width), 4 * w.width * sizeof *part->color) != 0)
            return false;
    return true;
}

static const Shot cropped_shots[] = {
    {TWIGS, {-0.5, 1.4, -0.4}, DEGREE, 0.02, {.width = WIDTH, .height = HEIGHT}, 0},
    {BALLS, {-1, 1.4, -0.6}, 10 * DEGREE, 0, {.width = WIDTH, .height = HEIGHT}, 0},
    {BALLS,
     {-1, 1.4, -0.6},
     10 * DEGREE,
     0,
     {.width = WIDTH, .height = HEIGHT, .samples = 4, .shadows = KRS_SHADOWS_AREA},
     0},
    {BALL_LAMP,
     {-3, 5.5, -1.6},
     0.4,
     0,
     {.width = WIDTH, .height = HEIGHT, .samples = 4, .shadows = KRS_SHADOWS_AREA},
     0},
};

static void crops_are_parts_of_the_picture(void **context)
{
    (void)context;
    static const KrsWindow crops[] = {{133, 77, 101, 60},
                                      {161, 82, 7, 5},
                                      {0, 99, 320, 1},
                                      {187, 0, 1, 180},
                                      {203, 103, 117, 77}};
    for (size_t i = 0; i < sizeof cropped_shots / sizeof cropped_shots[0]; i++) {
        Shot        shot  = cropped_shots[i];
        KrsPicture *whole = shoot(&shot);
        for (size_t k = 0; k < sizeof crops / sizeof crops[0]; k++) {
            shot.options.crop = crops[k];
            KrsPicture *part  = shoot(&shot);
            assert_true(is_part_of(whole, part));
            part->color[4 * (crops[k].width * crops[k].height - 1)] += 1e-6F; /* a planted fault */
            assert_false(is_part_of(whole, part));
            krs_picture_free(part);
        }
        krs_picture_free(whole);
    }
}

/* ---- Planted faults ---- */

/* Both what is seen of a few pixels, and holes in shadows. */
static void wrong_pixels_are_found(void **context)
{
    (void)context;
    enum { FEW = 40 };
    Shot        shot  = cropped_shots[1];
    KrsImage    image = {.tone_map = "none"};
    size_t      dark;
    KrsPicture *pictures[2] = {shoot(&shot), shoot(&shot)};
    assert_true(is_unseen(compare_pictures(&image, pictures[0], pictures[1])));
    assert_int_equal(count_holes(pictures, &dark), 0);
    assert_true(dark > FEW);
    for (int k = WIDTH * HEIGHT - 1, left = FEW; left > 0; k--)
        if (seen_at(pictures[1], k) >= 0 && seen_at(pictures[1], k) < 0.5) {
            pictures[0]->color[4 * k] = pictures[0]->color[4 * k + 1];
            left--;
        }
    assert_false(is_unseen(compare_pictures(&image, pictures[0], pictures[1])));
    assert_int_equal(count_holes(pictures, &dark), FEW);
    krs_picture_free(pictures[0]);
    krs_picture_free(pictures[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sharing_does_not_change_algebraic_surfaces),
        cmocka_unit_test(sharing_does_not_change_examples),
        cmocka_unit_test(upsampling_keeps_thin_shadows),
        cmocka_unit_test(crops_are_parts_of_the_picture),
        cmocka_unit_test(wrong_pixels_are_found),
    };
    return run_shadow_tests("upsampling", tests, sizeof tests / sizeof tests[0]);
}
