/*
 * soft_shadows.c: shadows of lights of some width, by few rays that neighbours share: means of 5x5
 * pixels are held against the share of the light that exact rays reach.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/oracle/shadow_truth.h"
#include "tests/support/renderer.h"

#define LIFT       0.125 /* pixels above even ground, where rays start */
#define BLUR_REACH 8     /* pixels: so far from a penumbra nothing is shared */
/* Limits for means of 5x5 pixels, as shares of the light: root of the mean square in and near the penumbra for
   1 and for 4 rays a pixel, and the worst of all. */
#define MAX_OFF_1      0.025
#define MAX_OFF_4      0.015
#define MAX_OFF_AT_ALL 0.15
/* Limits for single pixels of a narrow penumbra, one ray each: root of the mean square.  It is 0.13 where means
   reach as far across the edge as along it. */
#define NARROW     (1.5 * DEGREE)
#define MAX_FRAYED 0.105
/* Around a lamp in a recess, one ray a pixel: by how many pixels the edge of light is uneven where this
   share is seen; on average over recesses, and the worst of them. */
#define DARK               0.01
#define MAX_TOOTHED        0.85
#define MAX_TOOTHED_AT_ALL 1.1

/* Returns how far the mean of 5x5 pixels is outside of what is true for it; NAN where one of them
   shows no ground in the light. */
static double mean_off(const KrsPicture *picture, int x, int y)
{
    double seen = 0, low = 0, high = 0;
    for (int i = 0; i < 25; i++) {
        int    k    = (y + i / 5 - 2) * truths.width + x + i % 5 - 2;
        double here = seen_at(picture, k);
        if (here < 0)
            return NAN;
        seen += here / 25;
        low += truth_low(k) / 25;
        high += truth_high(k) / 25;
    }
    return fmax(fmax(low - seen, seen - high), 0);
}

typedef struct SharedMatch {
    int    umbra, penumbra, lit; /* pixels; umbra and lit ones are far from the penumbra */
    int    wrong;                /* of umbra that are lit, of lit ones that are not */
    double off, worst;           /* of means: root of the mean square in the penumbra; the most */
} SharedMatch;

static SharedMatch match_shared(const KrsPicture *picture, const Shot *shot, Truth *truth)
{
    SharedMatch match   = {0};
    double      squares = 0;
    compute_truths(truth, shot, LIFT);
    for (int k = 0; k < truths.width * truths.height; k++) {
        int    x = k % truths.width, y = k / truths.width;
        double seen = seen_at(picture, k), low, high;
        if (seen < 0 || x < 2 || y < 2 || x >= truths.width - 2 || y >= truths.height - 2)
            continue;
        truths_within(k, BLUR_REACH, &low, &high);
        if (high <= 0 || low >= 1) {
            match.umbra += high <= 0;
            match.lit += low >= 1;
            match.wrong += fabs(seen - low) > 1e-6;
            continue;
        }
        double off = mean_off(picture, x, y);
        if (isnan(off))
            continue;
        match.penumbra++;
        match.worst = fmax(match.worst, off);
        squares += off * off;
    }
    match.off = sqrt(squares / match.penumbra);
    return match;
}

static bool shared_is_right(const char *name, const KrsPicture *picture, const Shot *shot,
                            Truth *truth)
{
    SharedMatch m    = match_shared(picture, shot, truth);
    double      most = shot->options.samples > 1 ? MAX_OFF_4 : MAX_OFF_1;
    print_message("# soft, %s, %u samples: %d pixels of umbra, %d of penumbra, %d lit, %d wrong; "
                  "off by %.4f, at most %.4f\n",
                  name, shot->options.samples, m.umbra, m.penumbra, m.lit, m.wrong, m.off, m.worst);
    assert_true(m.umbra > 100 && m.penumbra > 200 && m.lit > 200);
    return m.wrong == 0 && m.off < most && m.worst < MAX_OFF_AT_ALL;
}

static void soft_shadows_are_shares_of_the_disc(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2 * LIGHTINGS; i++) {
        const Lighting *lighting           = &lightings[i / 2];
        Shot            edge               = edge_shot(lighting, KRS_SHADOWS_SOFT, i % 2 ? 4 : 1);
        Shot            ball               = ball_shot(lighting, KRS_SHADOWS_SOFT, i % 2 ? 4 : 1);
        edge.options.methods.no_upsampling = ball.options.methods.no_upsampling = false;
        edge.options.crop.height                                                = 24;
        KrsPicture *of_edge = shoot(&edge), *of_ball = shoot(&ball);
        print_message("# %s\n", lighting->name);
        wrong += !shared_is_right("edge", of_edge, &edge, share_above_edge);
        wrong += !shared_is_right("ball", of_ball, &ball, share_by_rays);
        krs_picture_free(of_edge);
        krs_picture_free(of_ball);
    }
    assert_int_equal(wrong, 0);
}

/* Returns how far pixels in and beside the penumbra are from the truth: root of the mean square. */
static double find_fraying(const KrsPicture *picture, const Shot *shot, int *count)
{
    double squares = 0, low, high;
    *count         = 0;
    compute_truths(share_by_rays, shot, LIFT);
    for (int k = 0; k < truths.width * truths.height; k++) {
        double seen = seen_at(picture, k);
        truths_within(k, 1, &low, &high);
        if (seen < 0 || low < 0 || low == high)
            continue;
        double off = fmax(fmax(truth_low(k) - seen, seen - truth_high(k)), 0);
        squares += off * off;
        ++*count;
    }
    return sqrt(squares / *count);
}

/* A penumbra of a few pixels is an even ramp, though each of its pixels has a single ray. */
static void edges_of_narrow_shadows_are_not_frayed(void **state)
{
    (void)state;
    Shot ball                          = ball_shot(&lightings[0], KRS_SHADOWS_SOFT, 1);
    ball.wide                          = NARROW;
    ball.options.methods.no_upsampling = false;
    int         count;
    KrsPicture *picture = shoot(&ball);
    double      frayed  = find_fraying(picture, &ball, &count);
    print_message("# narrow: %d pixels, off by %.4f\n", count, frayed);
    assert_true(count > 300);
    assert_true(frayed < MAX_FRAYED);
    krs_picture_free(picture);
}

/* However far below the true distance a bound is. */
static void soft_shadows_of_bounds_are_the_same(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2 * (FIXTURES - BOUNDS); i++) {
        const Lighting *lighting           = &lightings[i / (FIXTURES - BOUNDS)];
        Shot            ball               = ball_shot(lighting, KRS_SHADOWS_SOFT, 1);
        ball.fixture                       = (FixtureKind)(BOUNDS + i % (FIXTURES - BOUNDS));
        ball.options.methods.no_upsampling = false;
        KrsPicture    *picture             = shoot(&ball);
        const Fixture *fixture             = &fixtures[ball.fixture];
        print_message("# %s, %s / %g\n", lighting->name, fixture->ball ? fixture->ball : "distance",
                      fmax(fixture->slope, 1));
        wrong += !shared_is_right("ball", picture, &ball, share_by_rays);
        krs_picture_free(picture);
    }
    assert_int_equal(wrong, 0);
}

static void wrong_soft_shadows_are_found(void **state)
{
    (void)state;
    Shot ball                          = ball_shot(&lightings[1], KRS_SHADOWS_SOFT, 4), wrong;
    ball.options.methods.no_upsampling = false;
    KrsPicture *picture                = shoot(&ball);
    assert_true(shared_is_right("ball", picture, &ball, share_by_rays));
    wrong      = ball;
    wrong.wide = 1.5 * ball.wide;
    assert_false(shared_is_right("ball, PLANTED larger light", picture, &wrong, share_by_rays));
    wrong.wide = 0.7 * ball.wide;
    assert_false(shared_is_right("ball, PLANTED smaller light", picture, &wrong, share_by_rays));
    for (int k = 0; k < truths.width * truths.height; k++) /* a ring */
        if (seen_at(picture, k) > 0.5 && seen_at(picture, k) < 0.7)
            picture->color[4 * k] -= 0.2F * picture->color[4 * k + 1];
    assert_false(shared_is_right("ball, PLANTED ring", picture, &ball, share_by_rays));
    krs_picture_free(picture);
}

/* ---- A lamp in a recess of the ceiling ---- */

/* In truth the lamp is a disc, across the way to it.  The lower edge of the recess hides it. */
typedef struct Recess {
    double ceiling, wall;      /* its height, and how far off the wall is */
    double radius, lamp, wide; /* of the recess; the lamp's height and radius */
} Recess;

enum { RECESSES = 8, RECESS_WIDTH = 160, RECESS_HEIGHT = 80 };

/* Where the wall has half of the light, below the lamp. */
static double edge_on_wall(const Recess *recess)
{
    return recess->lamp - (recess->lamp - recess->ceiling) * recess->wall / recess->radius;
}

static KrsPicture *take_recess(const Recess *recess)
{
    SceneText    text = {0};
    const double edge = edge_on_wall(recess);
    for (int i = 0; i < 2; i++)
        scene_write(&text, "light %s { position: [0, %.9g, 0], radius: %.9g, color: %s%s }\n",
                    i ? "green" : "red", recess->lamp, recess->wide, i ? "[0, 1, 0]" : "[1, 0, 0]",
                    i ? ", shadow: false" : "");
    scene_write(&text,
                "sky { zenith: black, horizon: black, ground: black }\n"
                "material chalk { color: white, specular: 0 }\n"
                "show plane([1, 0, 0], -%.9g).paint(chalk);\n"
                "show (box([40, 1, 40]).move([0, %.9g, 0]) - cylinder(%.9g, 4).move([0, %.9g, 0]))"
                ".paint(chalk);\n"
                "camera { eye: [0, %.9g, 0], target: [-1, %.9g, 0], "
                "projection: \"orthographic\", height: 1.2 }\n",
                recess->wall, recess->ceiling + 0.5, recess->radius, recess->ceiling, edge, edge);
    return picture_of(text.bytes, &(KrsRenderOptions){.width             = RECESS_WIDTH,
                                                      .height            = RECESS_HEIGHT,
                                                      .methods.no_filter = true});
}

static double lamp_seen(const Recess *recess, Vec place)
{
    enum { RINGS = 20, SPOKES = 40 };
    const Vec middle = vec(0, recess->lamp, 0), axis = vec_unit(vec_sub(middle, place));
    const Vec side = vec_unit(vec_cross(axis, vec(0, 1, 0))), up = vec_cross(axis, side);
    int       seen = 0;
    for (int i = 0; i < RINGS * SPOKES; i++) {
        double far  = recess->wide * sqrt((i / SPOKES + 0.5) / RINGS);
        double turn = 2 * M_PI * (i % SPOKES + 0.5 * (i / SPOKES % 2)) / SPOKES;
        Vec    on   = vec_add(middle,
                              vec_add(vec_scale(far * cos(turn), side), vec_scale(far * sin(turn), up)));
        Vec    way  = vec_sub(on, place);
        Vec    at   = vec_add(place, vec_scale((recess->ceiling - place.y) / way.y, way));
        seen += hypot(at.x, at.z) < recess->radius;
    }
    return (double)seen / (RINGS * SPOKES);
}

/* Where the light of a column falls to DARK, counted up from its foot: by what pixels see, or in truth. */
static double edge_of_column(const double *seen, int x)
{
    double last = 1;
    for (int y = RECESS_HEIGHT - 1; y >= 0; y--) {
        double here = seen[y * RECESS_WIDTH + x];
        if (here <= DARK)
            return RECESS_HEIGHT - 1 - y - (DARK - here) / (last - here);
        last = here;
    }
    return NAN;
}

/* By how much the dark edge is uneven: root of the mean square, in pixels. */
static double find_teeth(const KrsPicture *picture, const Recess *recess)
{
    static double seen[RECESS_WIDTH * RECESS_HEIGHT], truth[RECESS_WIDTH * RECESS_HEIGHT];
    double        sum = 0, squares = 0;
    for (int k = 0; k < RECESS_WIDTH * RECESS_HEIGHT; k++) {
        const float *color = picture->color + 4 * k, *at = picture->position + 3 * k;
        seen[k]  = (double)color[0] / (double)color[1];
        truth[k] = lamp_seen(recess, vec((double)at[0], (double)at[1], (double)at[2]));
    }
    for (int x = 0; x < RECESS_WIDTH; x++) {
        double off = edge_of_column(seen, x) - edge_of_column(truth, x);
        sum += off / RECESS_WIDTH;
        squares += off * off / RECESS_WIDTH;
    }
    return sqrt(squares - sum * sum);
}

static void light_around_lamps_has_no_teeth(void **state)
{
    (void)state;
    Random random = {3};
    double mean = 0, worst = 0;
    for (int i = 0; i < RECESSES; i++) {
        Recess      recess  = {.ceiling = 2,
                               .wall    = random_between(&random, 1.5, 2.5),
                               .radius  = random_between(&random, 0.25, 0.5),
                               .lamp    = random_between(&random, 2.08, 2.2),
                               .wide    = random_between(&random, 0.02, 0.06)};
        KrsPicture *picture = take_recess(&recess);
        double      teeth   = find_teeth(picture, &recess);
        print_message("# recess %.3f, lamp %.3f in %.3f: teeth of %.3f pixels\n", recess.radius,
                      recess.wide, recess.lamp - recess.ceiling, teeth);
        worst = fmax(worst, teeth);
        mean += teeth / RECESSES;
        krs_picture_free(picture);
    }
    print_message("# teeth of %.3f pixels, at most %.3f\n", mean, worst);
    assert_true(mean < MAX_TOOTHED && worst < MAX_TOOTHED_AT_ALL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soft_shadows_are_shares_of_the_disc),
        cmocka_unit_test(edges_of_narrow_shadows_are_not_frayed),
        cmocka_unit_test(soft_shadows_of_bounds_are_the_same),
        cmocka_unit_test(light_around_lamps_has_no_teeth),
        cmocka_unit_test(wrong_soft_shadows_are_found),
    };
    return run_shadow_tests("soft shadows", tests, sizeof tests / sizeof tests[0]);
}
