/*
 * Tone curves, the sRGB transfer function and dithering keep the properties that their formulas
 * promise.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/base/srgb.h"
#include "runtime/display/display.h"

#define assert_near(value, expected, within) assert_true(fabs((value) - (expected)) <= (within))

/* Returns the definition of sRGB, backwards. */
static double srgb_decode(double shown)
{
    return shown <= 0.04045 ? shown / 12.92 : pow((shown + 0.055) / 1.055, 2.4);
}

static void srgb_is_its_definition(void **state)
{
    (void)state;
    assert_near(srgb_of_linear(0), 0, 0);
    assert_near(srgb_of_linear(1), 1, 0);
    assert_near(srgb_decode(srgb_of_linear(4)), 4, 1e-12); /* as exports write it */
    assert_near(srgb_of_linear(0.5), 0.735356983052449, 1e-12);
    for (int i = 0; i <= 1000; i++)
        assert_near(srgb_decode(srgb_of_linear(i / 1000.0)), i / 1000.0, 1e-7);
}

static double grey(ToneMap map, double value)
{
    double out[3];
    tone_map_apply(map, (double[]){value, value, value}, out);
    assert_near(out[0], out[1], 1e-4);
    assert_near(out[1], out[2], 1e-4);
    return out[1];
}

static void curves_rise_within_the_unit(void **state)
{
    (void)state;
    for (int map = 0; map < TONE_MAP_COUNT; map++) {
        double before = -1;
        for (double value = 0; value < 1e6; value = value * 1.05 + 1e-3) {
            double shown = grey((ToneMap)map, value);
            assert_true(shown >= 0 && shown <= 1);
            assert_true(shown >= before);
            before = shown;
        }
        assert_true(before > 0.95); /* white is reached */
    }
}

static void curves_survive_what_is_no_colour(void **state)
{
    (void)state;
    const double odd[] = {NAN, INFINITY, -INFINITY, -1, 1e300, 0};
    for (int map = 0; map < TONE_MAP_COUNT; map++)
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) {
                double out[3];
                tone_map_apply((ToneMap)map, (double[]){odd[i], odd[j], 0.5}, out);
                for (int k = 0; k < 3; k++)
                    assert_true(out[k] >= 0 && out[k] <= 1);
            }
}

static void neutral_is_its_definition(void **state)
{
    (void)state;
    /* Below its shoulder a colour only loses the 4 % of a dielectric's reflection. */
    for (int i = 10; i < 80; i++)
        assert_near(grey(TONE_NEUTRAL, i / 100.0), i / 100.0 - 0.04, 1e-12);
    assert_near(grey(TONE_NEUTRAL, 0.04), 6.25 * 0.04 * 0.04, 1e-12);
    /* On the shoulder a grey is 1 - d^2 / (peak + d - s) with s = 0.76 and d = 0.24. */
    assert_near(grey(TONE_NEUTRAL, 2.04), 1 - 0.24 * 0.24 / (2 + 0.24 - 0.76), 1e-12);
    /* A bright saturated colour turns towards white but keeps its order. */
    double out[3];
    tone_map_apply(TONE_NEUTRAL, (double[]){8, 1, 0.2}, out);
    assert_true(out[0] > out[1] && out[1] > out[2] && out[2] > 0.2);
}

static void aces_is_its_definition(void **state)
{
    (void)state;
    /* For a grey the matrices (rows of sum 1, nearly) drop out: the rational curve is left. */
    for (double v = 0.05; v < 10; v *= 1.5) {
        double above = v * (v + 0.0245786) - 0.000090537;
        double below = v * (0.983729 * v + 0.4329510) + 0.238081;
        assert_near(grey(TONE_ACES, v), fmin(above / below, 1), 2e-4);
    }
}

/* Returns the sigmoid of AgX as its author defines it: a line of slope 2 through (10 / 16.5, 1 /
   2), bent by powers at both ends so that it meets (0, 0) and (1, 1). */
static double agx_sigmoid(double x)
{
    const double pivot = 10 / 16.5, slope = 2, power = x < pivot ? 3 : 3.25;
    const double room  = x < pivot ? pivot : 1 - pivot;
    const double scale = pow(pow(slope * room, -power) * (pow(slope * room / 0.5, power) - 1),
                             -1 / power);
    const double term  = slope * fabs(x - pivot) / scale;
    return 0.5 + (x < pivot ? -1 : 1) * scale * term / pow(1 + pow(term, power), 1 / power);
}

static void agx_is_its_definition(void **state)
{
    (void)state;
    /* A grey goes through the matrices as it is.  The fit is within 0.006 of the sigmoid. */
    for (double v = 1e-3; v < 20; v *= 1.3) {
        double x = (log2(v) + 12.47393) / 16.499999;
        assert_near(pow(grey(TONE_AGX, v), 1 / 2.2), fmin(agx_sigmoid(x), 1), 0.0065);
    }
    assert_near(agx_sigmoid(0), 0, 1e-12);
    assert_near(agx_sigmoid(1), 1, 1e-12);
}

/* What other programs show: the curves as three.js r170 and the specification of Khronos have them,
   computed by a script of their own. */
static void curves_are_those_of_others(void **state)
{
    (void)state;
    static const double colors[][3] = {{0.18, 0.18, 0.18}, {1, 1, 1},    {0.8, 0.1, 0.05},
                                       {0.02, 0.3, 4},     {20, 5, 0.5}, {0.05, 0.6, 0.1}};
    static const struct {
        ToneMap map;
        double  shown[6][3];
    } known[] = {
        {TONE_AGX,
         {{0.21455, 0.2145, 0.2145},
          {0.59023, 0.59014, 0.5901},
          {0.60762, 0.17716, 0.11252},
          {0.28081, 0.50596, 0.9864},
          {1, 0.90588, 0.77171},
          {0.18, 0.45732, 0.16849}}},
        {TONE_NEUTRAL,
         {{0.14, 0.14, 0.14},
          {0.86909, 0.86909, 0.86909},
          {0.7655, 0.06563, 0.01564},
          {0.30555, 0.35323, 0.98336},
          {0.99704, 0.80214, 0.74367},
          {0.01562, 0.56562, 0.06563}}},
        {TONE_ACES,
         {{0.10559, 0.10559, 0.10559},
          {0.61912, 0.61912, 0.61911},
          {0.57238, 0.05164, 0.02339},
          {0.16214, 0.24371, 0.93879},
          {1, 0.94292, 0.74775},
          {0.04221, 0.43522, 0.06998}}},
    };
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        for (int c = 0; c < 6; c++) {
            double out[3];
            tone_map_apply(known[k].map, colors[c], out);
            for (int i = 0; i < 3; i++) /* they round the matrices to four digits */
                assert_near(out[i], known[k].shown[c][i], known[k].map == TONE_AGX ? 3e-4 : 1e-5);
        }
}

/* ---- white balance ---- */

static void balance(WhiteBalance by, const double rgb[3], double out[3])
{
    const ColorMatrix matrix = white_balance_matrix(by);
    for (int i = 0; i < 3; i++)
        out[i] = matrix.m[i][0] * rgb[0] + matrix.m[i][1] * rgb[1] + matrix.m[i][2] * rgb[2];
}

/* x, y of black bodies (CIE 1931), as tables have them; 2856 kelvins are illuminant A. */
static const double black_bodies[][3] = {{2000, 0.52669, 0.41331}, {2500, 0.47701, 0.41368},
                                         {2856, 0.44757, 0.40745}, {3000, 0.43693, 0.40407},
                                         {4000, 0.38045, 0.37675}, {5000, 0.34510, 0.35161},
                                         {6500, 0.31352, 0.32363}, {10000, 0.28063, 0.28828}};

/* Finds the linear Rec.709 colour of light of that x and y. */
static void color_of(const double xy[2], double rgb[3])
{
    static const double rgb_of_xyz[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                            {-0.9692660, 1.8760108, 0.0415560},
                                            {0.0556434, -0.2040259, 1.0572252}};
    const double        xyz[3]           = {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]};
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb_of_xyz[i][0] * xyz[0] + rgb_of_xyz[i][1] * xyz[1] + rgb_of_xyz[i][2] * xyz[2];
}

static void balanced_light_is_white(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof black_bodies / sizeof black_bodies[0]; i++) {
        const double *row = black_bodies[i];
        double        light[3], out[3], before[3];
        color_of(&row[1], light);
        balance((WhiteBalance){row[0], 0}, light, out);
        for (int k = 0; k < 3; k++) /* the locus is known within 0.0004 */
            assert_near(out[k], 1, 0.008);
        balance((WhiteBalance){1.1 * row[0], 0}, light,
                before); /* too cold a white leaves it warm */
        assert_true(before[0] / before[2] > 1.02);
    }
}

static void daylight_stays(void **state)
{
    (void)state;
    const double color[3] = {0.2, 0.5, 0.7};
    double       out[3], green[3];
    balance((WhiteBalance){6504, 9.6}, color, out);
    for (int i = 0; i < 3; i++)
        assert_near(out[i], color[i], 2e-3);
    balance((WhiteBalance){6504, 40}, color, green);
    assert_true(green[1] / green[0] < 0.98 * color[1] / color[0]); /* the light was greener */
    assert_true(green[1] / green[2] < 0.98 * color[1] / color[2]);
    balance((WhiteBalance){0, 0}, color, out);
    assert_memory_equal(out, color, sizeof out);
}

static void names_are_found(void **state)
{
    (void)state;
    static const char *const names[] = {
#define KRS_TONE_MAP(id, name, about) #name,
#include "krs/choices.def"
    };
    ToneMap map;
    for (int i = 0; i < TONE_MAP_COUNT; i++) {
        assert_true(tone_map_find(names[i], &map));
        assert_int_equal(map, i);
    }
    assert_false(tone_map_find("neutra", &map));
    assert_false(tone_map_find("", &map));
}

enum { SIDE = 64 };

/* A picture of one colour at a place of a larger one. */
typedef struct Flat {
    float      color[SIDE * SIDE * 4];
    KrsPicture picture;
    uint8_t    rgb[SIDE * SIDE * 3];
} Flat;

static void flat_develop(Flat *flat, double value, KrsWindow window, DisplayOptions options)
{
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 4; i++)
        flat->color[i] = i % 4 == 3 ? 1 : (float)value;
    flat->picture = (KrsPicture){
        .width = 256, .height = 256, .window = window, .color = flat->color};
    display_to_srgb8(&flat->picture, &options, 3, flat->rgb);
}

static void dithering_keeps_the_mean(void **state)
{
    (void)state;
    static Flat flat;
    for (int level = 0; level < 40; level++) {
        double exact = 3.3 + level * 6.17; /* of 255 */
        flat_develop(&flat, srgb_decode(exact / 255), (KrsWindow){0, 0, SIDE, SIDE},
                     (DisplayOptions){.tone_map = TONE_NONE});
        double sum = 0;
        for (size_t i = 0; i < sizeof flat.rgb; i++) {
            assert_true(flat.rgb[i] == floor(exact) || flat.rgb[i] == ceil(exact));
            sum += flat.rgb[i];
        }
        assert_near(sum / sizeof flat.rgb, exact, 0.02);
    }
}

static void black_and_white_are_clean(void **state)
{
    (void)state;
    static Flat flat;
    for (int map = 0; map < TONE_MAP_COUNT; map++) {
        flat_develop(&flat, 0, (KrsWindow){0, 0, SIDE, SIDE},
                     (DisplayOptions){.tone_map = (ToneMap)map});
        for (size_t i = 0; i < sizeof flat.rgb; i++)
            assert_int_equal(flat.rgb[i], 0);
    }
    flat_develop(&flat, 1, (KrsWindow){0, 0, SIDE, SIDE}, (DisplayOptions){.tone_map = TONE_NONE});
    for (size_t i = 0; i < sizeof flat.rgb; i++)
        assert_int_equal(flat.rgb[i], 255);
}

static void dithering_hangs_on_the_place_in_the_whole(void **state)
{
    (void)state;
    static Flat    whole, part;
    DisplayOptions options = {.tone_map = TONE_NEUTRAL};
    flat_develop(&whole, 0.3, (KrsWindow){100, 50, SIDE, SIDE}, options);
    flat_develop(&part, 0.3, (KrsWindow){110, 57, 20, 10}, options);
    for (size_t y = 0; y < 10; y++)
        assert_memory_equal(&part.rgb[3 * 20 * y], &whole.rgb[3 * (SIDE * (y + 7) + 10)], 3 * 20);
}

static void a_stop_is_a_doubling(void **state)
{
    (void)state;
    static Flat brighter, doubled;
    KrsWindow   window = {0, 0, SIDE, SIDE};
    flat_develop(&brighter, 0.125, window, (DisplayOptions){.tone_map = TONE_ACES, .exposure = 1});
    flat_develop(&doubled, 0.25, window, (DisplayOptions){.tone_map = TONE_ACES});
    assert_memory_equal(brighter.rgb, doubled.rgb, sizeof doubled.rgb);
    flat_develop(&doubled, 0.125, window, (DisplayOptions){.tone_map = TONE_ACES});
    assert_memory_not_equal(brighter.rgb, doubled.rgb, sizeof doubled.rgb);
}

/* Returns the byte by the definitions, the noise by floor. */
static uint8_t defined_byte(const float color[3], DisplayOptions options, int channel, double x,
                            double y)
{
    double light[3], shown[3];
    double gained[3];
    for (int i = 0; i < 3; i++)
        light[i] = gained[i] = pow(2, options.exposure) * color[i];
    if (options.white_balance.kelvins > 0)
        balance(options.white_balance, gained, light);
    tone_map_apply(options.tone_map, light, shown);
    double noise = 0.06711056 * (x + 47 * channel) + 0.00583715 * (y + 17 * channel);
    noise        = 52.9829189 * (noise - floor(noise));
    return (uint8_t)floor(255 * srgb_of_linear(shown[channel]) + noise - floor(noise));
}

static void bytes_are_as_defined(void **state)
{
    (void)state;
    enum { WIDTH = 157, HEIGHT = 41, COUNT = 4 * WIDTH * HEIGHT };
    static const float  odd[]   = {NAN, INFINITY, -1, 1e-42f, 1e30f, 0, 1, 0.08f, 0.76f, 0.8f};
    static const double stops[] = {0, 1.3, -3, 140};
    static float        color[COUNT];
    static uint8_t      rgb[COUNT];
    uint32_t            chance = 7;
    for (int kind = 0; kind < 4 * TONE_MAP_COUNT; kind++) {
        DisplayOptions options = {(ToneMap)(kind % TONE_MAP_COUNT),
                                  stops[kind / TONE_MAP_COUNT],
                                  {kind % 3 == 2 ? 3200 : 0, kind % 5}};
        for (int i = 0; i < COUNT; i++) {
            chance       = chance * 1664525 + 1013904223;
            double part  = (chance >> 8) / 16777216.0;
            double light = exp(12 * part - 9) / pow(2, options.exposure);
            color[i]     = chance % 256 < 16 ? odd[(chance >> 8) % 10] : (float)light;
        }
        display_to_srgb8(&(KrsPicture){.width  = 2000,
                                       .height = 2000,
                                       .window = {911, 1204, WIDTH, HEIGHT},
                                       .color  = color},
                         &options, 3, rgb);
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            for (int i = 0; i < 3; i++)
                assert_int_equal(rgb[3 * k + i], defined_byte(&color[4 * k], options, i,
                                                              911 + k % WIDTH, 1204 + k / WIDTH));
    }
}

/* The image block decides; the fourth byte is full. */
static void pictures_are_shown_as_the_scene_says(void **state)
{
    (void)state;
    static const char text[] = "show sphere(1); image { exposure: 1, tone_map: \"aces\" }";
    float             color[4 * 6];
    uint8_t           meant[3 * 6], rgb[3 * 6], rgba[4 * 6];
    KrsScene         *scene;
    const KrsPicture  picture = {.width = 3, .height = 2, .window = {0, 0, 3, 2}, .color = color};
    for (int i = 0; i < 4 * 6; i++)
        color[i] = (float)(i % 7) / 8;
    assert_int_equal(krs_compile_text(text, sizeof text - 1, "a", NULL, &scene), KRS_OK);
    display_to_srgb8(&picture, &(DisplayOptions){TONE_ACES, 1.5, {0, 0}}, 3, meant);
    assert_int_equal(krs_picture_to_srgb8(&picture, scene, 0.5, 3, rgb), KRS_OK);
    assert_int_equal(krs_picture_to_srgb8(&picture, scene, 0.5, 4, rgba), KRS_OK);
    assert_memory_equal(rgb, meant, sizeof meant);
    for (int i = 0; i < 4 * 6; i++)
        assert_int_equal(rgba[i], i % 4 == 3 ? 255 : meant[3 * (i / 4) + i % 4]);
    assert_int_equal(krs_picture_to_srgb8(&picture, scene, 0, 2, rgba), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_picture_to_srgb8(&(KrsPicture){0}, scene, 0, 3, rgb), KRS_BAD_ARGUMENT);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_is_its_definition),
        cmocka_unit_test(curves_rise_within_the_unit),
        cmocka_unit_test(curves_survive_what_is_no_colour),
        cmocka_unit_test(neutral_is_its_definition),
        cmocka_unit_test(aces_is_its_definition),
        cmocka_unit_test(agx_is_its_definition),
        cmocka_unit_test(curves_are_those_of_others),
        cmocka_unit_test(balanced_light_is_white),
        cmocka_unit_test(daylight_stays),
        cmocka_unit_test(names_are_found),
        cmocka_unit_test(dithering_keeps_the_mean),
        cmocka_unit_test(black_and_white_are_clean),
        cmocka_unit_test(dithering_hangs_on_the_place_in_the_whole),
        cmocka_unit_test(a_stop_is_a_doubling),
        cmocka_unit_test(bytes_are_as_defined),
        cmocka_unit_test(pictures_are_shown_as_the_scene_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
