/*
 * area_shadows.c: shadows of lights of some width, by many rays a pixel, held against the share of
 * the light that exact rays reach.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/oracle/shadow_truth.h"

/* What is asked for: noise as a share of that of independent rays, widths as shares of what there
   is. */
#define MAX_NOISE       0.6
#define MAX_WIDTH_ERROR 0.03

typedef struct Match {
    int    umbra, penumbra, lit; /* pixels; umbra and lit with all pixels around */
    int    wrong;                /* of umbra that are lit, of lit ones that are not */
    double noise;                /* of the penumbra, root of the mean square */
    double expected;             /* if the rays of a pixel were independent */
    double lift;                 /* where rays seem to start, in pixels above the surface */
} Match;

static Match match_area(const KrsPicture *picture, const Shot *shot, Truth *truth)
{
    Match  match   = {0};
    double squares = 0, variance = 0, along = 0, steep = 0;
    compute_truths(truth, shot, 1);
    for (int k = 0; k < truths.width * truths.height; k++) {
        double seen = seen_at(picture, k), off = seen - truths.low[k], low, high;
        double rise = truths.lifted[k] - truths.low[k];
        truths_within(k, 1, &low, &high);
        if (seen >= 0 && (high <= 0 || low >= 1)) {
            match.umbra += high <= 0;
            match.lit += low >= 1;
            match.wrong += fabs(off) > 1e-6;
        }
        if (seen < 0 || truth_high(k) <= 0 || truth_low(k) >= 1)
            continue;
        match.penumbra++;
        variance += truths.low[k] * (1 - truths.low[k]);
        squares += off * off;
        along += off * rise;
        steep += rise * rise;
    }
    match.lift     = along / steep;
    match.noise    = sqrt((squares - match.lift * along) / match.penumbra);
    match.expected = sqrt(variance / match.penumbra / shot->options.samples);
    return match;
}

static bool area_is_right(const char *name, const KrsPicture *picture, const Shot *shot,
                          Truth *truth)
{
    Match m = match_area(picture, shot, truth);
    print_message("# area, %s, %u samples: %d pixels of umbra, %d of penumbra, %d lit, %d wrong; "
                  "noise %.4f (independent rays: %.4f), lift %.2f\n",
                  name, shot->options.samples, m.umbra, m.penumbra, m.lit, m.wrong, m.noise,
                  m.expected, m.lift);
    assert_true(m.umbra > 200 && m.penumbra > 200 && m.lit > 200);
    return m.wrong == 0 && m.noise < MAX_NOISE * m.expected && fabs(m.lift) < MAX_LIFT;
}

/* Returns the place of a row at which a rising profile passes a level, in pixels. */
static double place_of_level(const double *profile, int count, double level)
{
    for (int i = 1; i < count; i++)
        if (profile[i - 1] < level && profile[i] >= level)
            return i - 1 + (level - profile[i - 1]) / (profile[i] - profile[i - 1]);
    return NAN;
}

static double width_of(const double *profile, int count)
{
    return place_of_level(profile, count, 0.9) - place_of_level(profile, count, 0.1);
}

/* Across the ledge's shadow, whose edge runs down the picture: the mean of all rows. */
static bool width_is_right(const KrsPicture *picture, const Shot *shot)
{
    double seen[MAX_PIXELS] = {0}, truth[MAX_PIXELS] = {0};
    compute_truths(share_above_edge, shot, 1);
    for (int k = 0; k < truths.width * truths.height; k++) {
        seen[k % truths.width] += fmax(0, seen_at(picture, k)) / truths.height;
        truth[k % truths.width] += truths.low[k] / truths.height;
    }
    double width = width_of(seen, truths.width), wanted = width_of(truth, truths.width);
    print_message("# area, edge: from 10 %% to 90 %% in %.2f pixels, in truth %.2f\n", width,
                  wanted);
    return fabs(width / wanted - 1) < MAX_WIDTH_ERROR;
}

static void area_shadows_are_shares_of_the_disc(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < LIGHTINGS; i++) {
        Shot edge           = edge_shot(&lightings[i], KRS_SHADOWS_AREA, 64);
        Shot ball           = ball_shot(&lightings[i], KRS_SHADOWS_AREA, 64);
        ball.options.width  = 480;
        ball.options.height = 270;
        ball.options.crop   = (KrsWindow){256, 125, 100, 40}; /* the far end of the shadow */
        KrsPicture *of_edge = shoot(&edge), *of_ball = shoot(&ball);
        print_message("# %s\n", lightings[i].name);
        wrong += !area_is_right("edge", of_edge, &edge, share_above_edge);
        wrong += !width_is_right(of_edge, &edge);
        wrong += !area_is_right("ball", of_ball, &ball, share_by_rays);
        krs_picture_free(of_edge);
        krs_picture_free(of_ball);
    }
    assert_int_equal(wrong, 0);
}

/* More rays make less noise. */
static void area_shadows_converge(void **state)
{
    (void)state;
    double noise[2];
    for (int i = 0; i < 2; i++) {
        Shot        shot    = edge_shot(&lightings[1], KRS_SHADOWS_AREA, i ? 256 : 16);
        KrsPicture *picture = shoot(&shot);
        noise[i]            = match_area(picture, &shot, share_above_edge).noise;
        krs_picture_free(picture);
    }
    print_message("# area: noise of 16 rays %.4f, of 256 %.4f\n", noise[0], noise[1]);
    assert_true(noise[1] < noise[0] / 4);
}

/* Returns how much pixels differ that see the same: those above each other, along the ledge's
   shadow.  Root of the mean square in the penumbra, and what single rays would have. */
static double noise_of_columns(const KrsPicture *picture, double *expected)
{
    int    width = (int)picture->window.width, height = (int)picture->window.height, columns = 0;
    double squares = 0, variance = 0;
    for (int x = 0; x < width; x++) {
        double sum = 0, square = 0;
        for (int y = 0; y < height; y++) {
            double seen = seen_at(picture, y * width + x);
            sum += seen / height;
            square += seen * seen / height;
        }
        if (sum < 0.02 || sum > 0.98)
            continue;
        columns++;
        squares += square - sum * sum;
        variance += sum * (1 - sum);
    }
    assert_true(columns > 0);
    *expected = sqrt(variance / columns);
    return sqrt(squares / columns);
}

/* Returns the noise of pixels almost as wide as the penumbra, as a share of that of 256 independent rays. */
static double narrow_noise(double degrees, uint32_t samples)
{
    Shot        shot    = {LEDGE,
                           {-1, 1.3, 0},
                           degrees * DEGREE,
                           0,
                           {.width   = 72,
                            .height  = 40,
                            .crop    = {24, 0, 36, 40},
                            .samples = samples,
                            .shadows = KRS_SHADOWS_AREA},
                           0};
    KrsPicture *picture = shoot(&shot);
    double      expected, noise = noise_of_columns(picture, &expected);
    krs_picture_free(picture);
    print_message("# area, edge, %g degrees, large pixels, %u samples: noise %.4f (256 independent "
                  "rays: %.4f)\n",
                  degrees, samples, noise, expected / 16);
    return noise / (expected / 16);
}

/* Where a penumbra is as narrow as pixels, places in a pixel and on the light both matter, and
   must have nothing to do with each other. */
static void narrow_penumbras_converge(void **state)
{
    (void)state;
    static const double angles[] = {1.5, 3, 8};
    size_t              wrong    = 0;
    for (int i = 0; i < 3; i++) {
        double of_few = narrow_noise(angles[i], 16), of_many = narrow_noise(angles[i], 256);
        wrong += !(of_many < MAX_NOISE);
        assert_false(of_few < MAX_NOISE); /* so much would be found */
    }
    assert_int_equal(wrong, 0);
}

/* Pictures of different seeds are about different rays, to the light as well: their mean is as
   good as a picture of as many. */
static void seeds_move_the_rays_to_the_light(void **state)
{
    (void)state;
    enum { SEEDS = 16 };
    Shot        shot    = edge_shot(&lightings[1], KRS_SHADOWS_AREA, 16);
    KrsPicture *sum     = shoot(&shot);
    size_t      numbers = 4 * (size_t)shot.options.crop.width * shot.options.crop.height;
    double      one     = match_area(sum, &shot, share_above_edge).noise;
    for (shot.options.seed = 1; shot.options.seed < SEEDS; shot.options.seed++) {
        KrsPicture *picture = shoot(&shot);
        for (size_t i = 0; i < numbers; i++)
            sum->color[i] += picture->color[i];
        krs_picture_free(picture);
    }
    double all = match_area(sum, &shot, share_above_edge).noise;
    krs_picture_free(sum);
    print_message("# area: noise of 16 rays %.4f, of the mean of %d seeds %.4f\n", one, SEEDS, all);
    assert_true(all < one / 2.5);
}

static void wrong_area_shadows_are_found(void **state)
{
    (void)state;
    Shot        edge = edge_shot(&lightings[1], KRS_SHADOWS_AREA, 64), wrong = edge;
    KrsPicture *picture = shoot(&edge);
    assert_true(area_is_right("edge", picture, &edge, share_above_edge));
    wrong.wide = 1.1 * edge.wide; /* the light as large as it is not */
    assert_false(width_is_right(picture, &wrong));
    wrong.wide = 1.5 * edge.wide;
    assert_false(area_is_right("edge, PLANTED size", picture, &wrong, share_above_edge));
    wrong = edge;
    wrong.light.x *= 1.03; /* the edge three pixels off */
    assert_false(area_is_right("edge, PLANTED place", picture, &wrong, share_above_edge));
    picture->color[4 * (picture->window.width - 1)] = 0; /* a speck of dust */
    assert_false(area_is_right("edge, PLANTED speck", picture, &edge, share_above_edge));
    krs_picture_free(picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_shadows_are_shares_of_the_disc),
        cmocka_unit_test(area_shadows_converge),
        cmocka_unit_test(narrow_penumbras_converge),
        cmocka_unit_test(seeds_move_the_rays_to_the_light),
        cmocka_unit_test(wrong_area_shadows_are_found),
    };
    return run_shadow_tests("area shadows", tests, sizeof tests / sizeof tests[0]);
}
