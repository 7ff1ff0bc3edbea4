/*
 * coverage.c: pictures show as much of thin things as there is of them.
 *
 * Twigs from a tenth of a pixel to three pixels wide are rendered with the default options, and
 * every ray through the centre of a pixel is cast again in closed form: hits that the picture
 * misses and hits that are none may both occur, but must cancel out to a percent.  Where the rays
 * are not the same, with several samples a pixel, mean coverages are compared.  A scene inflated
 * by as much as the usual stop of sphere tracing permits must fail by far.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/oracle/twigs.h"

/* What is asked for, and what a test must be able to see. */
#define MAX_NET_ERROR 0.01  /* of the coverage */
#define MAX_NOISE     0.003 /* one standard error, as a share of the coverage */
#define MAX_OFF       0.001 /* the share of hits whose depth is off by more than is permitted */
#define PLANTED_ERROR 0.1   /* a fault shows at least this much */

/* ---- Ray by ray ---- */

typedef struct Verdict {
    size_t hits;          /* that there are */
    size_t missed, extra; /* hits that are not seen, and those that are none */
    size_t common, off;   /* hits seen, and those at a depth that is off by too much */
} Verdict;

/* Component 1 are the twigs, 2 is the wall. */
static Verdict compare_rays(const KrsPicture *picture, const double *enter, const Lens *lens,
                            double error)
{
    Verdict verdict = {0};
    for (int k = 0; k < lens->width * lens->height; k++) {
        bool there = enter[k] < HUGE_VAL, seen = picture->component[k] == 1;
        verdict.hits += there;
        verdict.missed += there && !seen;
        verdict.extra += seen && !there;
        if (!there || !seen)
            continue;
        Line   ray     = lens_ray(lens, k % lens->width + 0.5, k / lens->width + 0.5);
        double stretch = vec_dot(ray.direction, lens->forward), depth = picture->depth[k];
        double pixels = (depth / stretch - enter[k]) / lens_pixel(lens, depth);
        verdict.common++;
        verdict.off += !(fabs(pixels) <= error);
    }
    return verdict;
}

static double net_error(const Verdict *verdict)
{
    return ((double)verdict->extra - (double)verdict->missed) / (double)verdict->hits;
}

/* Returns the standard error of the net error if whether a ray hits were decided by lot wherever
   the picture and the truth disagree. */
static double net_noise(const Verdict *verdict)
{
    return sqrt((double)(verdict->extra + verdict->missed)) / (double)verdict->hits;
}

static void print_shot(const Shot *shot)
{
    static const char *const names[SCENES] = {"thicket",    "heap", "thicket, wall",
                                              "heap, wall", "tree", "thicket, error in scene"};
    print_message("# %s, %s, %g pixels wide, error %g%s: ", names[shot->kind],
                  shot->camera == FLAT ? "orthographic" : "perspective", shot->wide,
                  twigs_error(shot),
                  shot->grown > 0 ? ", GROWN"
                  : shot->uncut   ? ", UNCUT"
                                  : "");
}

static Verdict judge_shot(const Shot *shot)
{
    Lens        lens    = twigs_lens(shot, WIDTH, HEIGHT);
    double     *enter   = twigs_truth(shot, &lens, 0.5, 0.5);
    KrsPicture *picture = twigs_render(shot, &lens, 1);
    Verdict     verdict = compare_rays(picture, enter, &lens, twigs_error(shot));
    krs_picture_free(picture);
    free(enter);
    print_shot(shot);
    print_message("%zu hits, missed %.2f %%, too many %.2f %%, net %+.2f %% (noise up to %.2f %%), "
                  "depth off %.3f %%\n",
                  verdict.hits, 100.0 * (double)verdict.missed / (double)verdict.hits,
                  100.0 * (double)verdict.extra / (double)verdict.hits, 100 * net_error(&verdict),
                  100 * net_noise(&verdict),
                  100.0 * (double)verdict.off / fmax(1, (double)verdict.common));
    assert_true(verdict.hits >= 2000);
    return verdict;
}

/* Returns how many depths may be off: the permitted share, and those of rays that meet something
   else than they should.  Of the hits that are none as large a share is before another hit as of
   all rays, and so it is behind the hits that are missed; neither is counted as such. */
static double max_off(const Verdict *verdict)
{
    double hits = (double)verdict->hits, others = (double)(verdict->extra + verdict->missed);
    return MAX_OFF * (double)verdict->common + others * hits / (PIXELS - hits);
}

/* Tells whether a shot keeps what is promised; all shots of a test are looked at before it fails. */
static bool shot_is_right(Shot shot)
{
    Verdict verdict = judge_shot(&shot);
    return fabs(net_error(&verdict)) < MAX_NET_ERROR && net_noise(&verdict) < MAX_NOISE &&
           (double)verdict.off <= max_off(&verdict);
}

/* Every width with the default error, from both cameras, and with other errors. */
static size_t wrong_shots(SceneKind kind, const double *widths, size_t width_count)
{
    static const double errors[] = {0, 0.5, 0.1};
    size_t              wrong    = 0;
    for (size_t i = 0; i < width_count; i++) {
        for (size_t k = 0; k < sizeof errors / sizeof errors[0]; k++)
            wrong += !shot_is_right((Shot){.kind = kind, .wide = widths[i], .error = errors[k]});
        wrong += !shot_is_right((Shot){.kind = kind, .wide = widths[i], .camera = FLAT});
    }
    return wrong;
}

static const double THIN[] = {0.1, 0.3}, WIDE[] = {1, 3};

static void thin_twigs_are_covered(void **state)
{
    (void)state;
    assert_int_equal(wrong_shots(THICKET, THIN, 2), 0);
}

static void wide_twigs_are_covered(void **state)
{
    (void)state;
    assert_int_equal(wrong_shots(HEAP, WIDE, 2), 0);
}

static void twigs_before_a_wall_are_covered(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int camera = 0; camera < CAMERAS; camera++)
        for (int i = 0; i < 2; i++) {
            wrong += !shot_is_right(
                (Shot){.kind = WALLED_THICKET, .wide = THIN[i], .camera = camera});
            wrong += !shot_is_right((Shot){.kind = WALLED_HEAP, .wide = WIDE[i], .camera = camera});
        }
    assert_int_equal(wrong, 0);
}

static void a_tree_is_covered(void **state)
{
    (void)state;
    assert_int_equal(wrong_shots(TREE, (const double[]){0.2, 0.6}, 2), 0);
}

/* What the scene asks for is what the caller may ask for. */
static void the_error_of_a_scene_counts(void **state)
{
    (void)state;
    Shot        rough = {.kind = ROUGH, .wide = 0.3};
    Shot        asked = {.kind = THICKET, .wide = 0.3, .error = ROUGH_ERROR};
    Lens        lens  = twigs_lens(&rough, WIDTH, HEIGHT);
    KrsPicture *a = twigs_render(&rough, &lens, 1), *b = twigs_render(&asked, &lens, 1);
    assert_memory_equal(a->depth, b->depth, PIXELS * sizeof *a->depth);
    assert_memory_equal(a->steps, b->steps, PIXELS * sizeof *a->steps);
    krs_picture_free(a);
    krs_picture_free(b);
    assert_true(shot_is_right(rough));
}

/* A scene that is as much too thick as the stop at a quarter of a pixel makes it. */
static void inflation_is_found(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        Verdict thin = judge_shot(
            &(Shot){.kind = THICKET, .wide = THIN[i], .grown = DEFAULT_ERROR});
        Verdict wide = judge_shot(
            &(Shot){.kind = HEAP, .wide = WIDE[i], .grown = DEFAULT_ERROR, .camera = FLAT});
        assert_true(net_error(&thin) > PLANTED_ERROR);
        assert_true(net_error(&wide) > PLANTED_ERROR);
    }
}

/* What the mirrors of the tree cut away is much of it. */
static void branches_beyond_mirrors_are_found(void **state)
{
    (void)state;
    Verdict verdict = judge_shot(&(Shot){.kind = TREE, .wide = 0.6, .uncut = true});
    assert_true(net_error(&verdict) < -PLANTED_ERROR);
}

/* ---- Several samples ---- */

/* The mean coverage of a picture, and how much it varies between pictures of one ray a pixel. */
typedef struct Coverage {
    double mean, spread;
} Coverage;

/* By rays through 8 x 8 places of each pixel. */
static Coverage true_coverage(const Shot *shot, const Lens *lens)
{
    enum { SIDE = 8 };
    double sum = 0, squares = 0;
    for (int place = 0; place < SIDE * SIDE; place++) {
        double *enter = twigs_truth(shot, lens, (place % SIDE + 0.5) / SIDE,
                                    (place / SIDE + 0.5) / SIDE);
        double  share = 0;
        for (int k = 0; k < lens->width * lens->height; k++)
            share += enter[k] < HUGE_VAL;
        free(enter);
        share /= lens->width * lens->height;
        sum += share;
        squares += share * share;
    }
    double mean = sum / (SIDE * SIDE);
    return (Coverage){mean, sqrt(fmax(squares / (SIDE * SIDE) - mean * mean, 0))};
}

static bool samples_are_right(Shot shot, uint32_t samples)
{
    Lens        lens    = twigs_lens(&shot, WIDTH / 2, HEIGHT / 2);
    Coverage    truth   = true_coverage(&shot, &lens);
    KrsPicture *picture = twigs_render(&shot, &lens, samples);
    double      mean = 0, noise = truth.spread / sqrt(samples) / truth.mean;
    for (int k = 0; k < lens.width * lens.height; k++)
        mean += (double)picture->color[4 * k + 3] / (lens.width * lens.height);
    krs_picture_free(picture);
    print_shot(&shot);
    print_message("%u samples, coverage %.5f instead of %.5f, %+.2f %% (noise %.2f %%)\n", samples,
                  mean, truth.mean, 100 * (mean / truth.mean - 1), 100 * noise);
    return fabs(mean / truth.mean - 1) < MAX_NET_ERROR && noise < MAX_NOISE;
}

static void samples_converge_on_the_coverage(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2; i++) {
        wrong += !samples_are_right((Shot){.kind = THICKET, .wide = THIN[i]}, 16);
        wrong += !samples_are_right((Shot){.kind = HEAP, .wide = WIDE[i]}, 16);
    }
    wrong += !samples_are_right((Shot){.kind = THICKET, .wide = THIN[0], .camera = FLAT}, 64);
    wrong += !samples_are_right((Shot){.kind = TREE, .wide = 0.3}, 16);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thin_twigs_are_covered),
        cmocka_unit_test(wide_twigs_are_covered),
        cmocka_unit_test(twigs_before_a_wall_are_covered),
        cmocka_unit_test(a_tree_is_covered),
        cmocka_unit_test(the_error_of_a_scene_counts),
        cmocka_unit_test(samples_converge_on_the_coverage),
        cmocka_unit_test(inflation_is_found),
        cmocka_unit_test(branches_beyond_mirrors_are_found),
    };
    return run_twig_tests("coverage", tests, sizeof tests / sizeof tests[0]);
}
