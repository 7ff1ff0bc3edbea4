/*
 * hard_shadows.c: shadows of lights that are points, held against single exact rays, and light on
 * what casts them.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/oracle/shadow_truth.h"
#include "tests/support/renderer.h"

#define MAX_ASYMMETRY 0.03 /* of means of 20x20 pixels */

enum { WIDTH = 320, HEIGHT = 180 };

static double open_or_not(const Shot *shot, Vec point)
{
    Disc disc = disc_from(shot, point);
    return !is_hidden(shot, point, vec_scale(disc.remote, disc.axis), disc.endless);
}

typedef struct HardMatch {
    int dark, lit, edge; /* pixels; at an edge where pixels around differ */
    int off, wrong;      /* not as the truth: at an edge, and elsewhere */
} HardMatch;

/* Marks pixels that are not as all around them, for rays that start up to `lift` above the
   surface. */
static void mark_edges(const Shot *shot, double lift, bool *edge)
{
    compute_truths(open_or_not, shot, lift);
    for (int k = 0; k < truths.width * truths.height; k++) {
        int    x = k % truths.width, y = k / truths.width;
        double low, high;
        truths_within(k, 1, &low, &high);
        edge[k] = edge[k] || low != high || x == 0 || y == 0 || x == truths.width - 1 ||
                  y == truths.height - 1;
    }
}

/* `lift`: shadows of a low sun move by as much as that makes. */
static HardMatch match_hard(const KrsPicture *picture, const Shot *shot, double lift)
{
    HardMatch match            = {0};
    bool      edge[MAX_PIXELS] = {false};
    for (int i = 2; i > 0 && lift > 0; i--)
        mark_edges(shot, 0.5 * lift * i, edge);
    mark_edges(shot, 0, edge);
    for (int k = 0; k < truths.width * truths.height; k++) {
        double seen = seen_at(picture, k);
        bool   same = fabs(seen - truths.low[k]) < 1e-6;
        if (seen < 0)
            continue;
        match.edge += edge[k];
        match.dark += seen < 0.5;
        match.lit += seen > 0.5;
        match.off += edge[k] && !same;
        match.wrong += (!edge[k] && !same) || fabs(seen - round(seen)) > 1e-6;
    }
    return match;
}

static bool hard_is_right(const char *name, const KrsPicture *picture, const Shot *shot,
                          double lift)
{
    HardMatch m = match_hard(picture, shot, lift);
    print_message("# hard, %s, lift up to %g: %d pixels dark, %d lit, %d at edges, of which %d are "
                  "not as rays say; %d elsewhere\n",
                  name, lift, m.dark, m.lit, m.edge, m.off, m.wrong);
    assert_true(m.dark > 200 && m.lit > 200);
    return m.wrong == 0;
}

static const struct HardCase {
    const char *name;
    FixtureKind fixture;
    Vec         light;
    double      lift; /* below 45 degrees it matters */
} hard_cases[] = {
    {"ledge", LEDGE, {-1, 1.3, 0.4}, 0},
    {"balls", BALLS, {-1, 1.4, -0.6}, 0},
    {"ball, lamp", BALL_LAMP, {-3, 5.5, -1.6}, 0},
    {"twigs", TWIGS, {-0.6, 1.4, 0.3}, 0},
    {"balls, sun at 20 degrees", BALLS, {-1, 0.4, -0.4}, MAX_LIFT},
    {"twigs, sun at 20 degrees", TWIGS, {-1, 0.37, 0.2}, MAX_LIFT},
};

enum { HARD_CASES = sizeof hard_cases / sizeof hard_cases[0] };

static Shot hard_shot(const struct HardCase *hard, int camera)
{
    return (Shot){hard->fixture,
                  hard->light,
                  0,
                  0.04,
                  {.width                 = WIDTH,
                   .height                = HEIGHT,
                   .crop                  = {0, 0, WIDTH, HEIGHT},
                   .camera                = (size_t)camera,
                   .methods.no_upsampling = true},
                  0};
}

static void hard_shadows_end_where_rays_say(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2 * HARD_CASES; i++) {
        Shot        shot    = hard_shot(&hard_cases[i / 2], i % 2);
        KrsPicture *picture = shoot(&shot);
        print_message("# %s\n", i % 2 == FROM_ABOVE ? "from above" : "from the side");
        wrong += !hard_is_right(hard_cases[i / 2].name, picture, &shot, hard_cases[i / 2].lift);
        krs_picture_free(picture);
    }
    assert_int_equal(wrong, 0);
}

static void wrong_hard_shadows_are_found(void **state)
{
    (void)state;
    Shot        ball = hard_shot(&hard_cases[1], FROM_ABOVE), wrong = ball;
    KrsPicture *picture = shoot(&ball);
    assert_true(hard_is_right("balls", picture, &ball, 0));
    wrong.light.x *= 1.06; /* three pixels */
    assert_false(hard_is_right("balls, PLANTED place", picture, &wrong, 0));
    picture->color[4 * (20 * WIDTH + 20)] = 0;
    assert_false(hard_is_right("balls, PLANTED speck", picture, &ball, 0));
    krs_picture_free(picture);
}

/* Pixels of solids that no other solid hides from the light, and how many of them are dark. */
static int count_dark_sides(const KrsPicture *picture, const Shot *shot, int *open)
{
    Shot others = *shot;
    int  dark   = 0;
    *open       = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *at = picture->position + 3 * k, *color = picture->color + 4 * k;
        if (picture->component[k] < 2 || color[1] < 0.01F)
            continue; /* grazing light cannot be told from shadow */
        others.without = (int)picture->component[k] - 1; /* component 1 is the ground */
        bool lit       = open_or_not(&others, vec((double)at[0], (double)at[1], (double)at[2])) > 0;
        *open += lit;
        dark += lit && color[0] != color[1];
    }
    return dark;
}

/* Convex solids have no shadow on their own lit side. */
static void lit_sides_are_lit(void **state)
{
    (void)state;
    Shot        shot    = hard_shot(&hard_cases[1], FROM_THE_SIDE);
    KrsPicture *picture = shoot(&shot);
    int         open, dark = count_dark_sides(picture, &shot, &open), last = WIDTH * HEIGHT;
    print_message("# hard, balls themselves: %d pixels open to the light, %d dark\n", open, dark);
    assert_true(open > 500);
    assert_int_equal(dark, 0);
    while (picture->component[--last] < 2 || picture->color[4 * last + 1] < 0.1F)
        ;
    picture->color[4 * last] = 0; /* a planted fault */
    assert_int_equal(count_dark_sides(picture, &shot, &open), 1);
    krs_picture_free(picture);
}

/* The same where the distance is a bound, and so small a part of the true one at the tips of a long
   ball that a ray which starts there seems to touch it. */
static void lit_sides_of_bounds_are_lit(void **state)
{
    (void)state;
    KrsPicture *picture = picture_of(
        "light red { direction: [1, 0.4, 0.5], color: [1, 0, 0] }\n"
        "light green { direction: [1, 0.4, 0.5], color: [0, 1, 0], shadow: false }\n"
        "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
        "image { tone_map: \"none\" }\n"
        "material white { color: [1, 1, 1], roughness: 1 }\n"
        "camera { eye: [9, 4, 6], target: [2, 0, 0], fov: 30deg }\n"
        "show sphere(1).scale([5, 1, 1]).paint(white);",
        &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT});
    int open = 0, dark = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *color = picture->color + 4 * k;
        if (picture->component[k] != 1 || color[1] < 0.01F)
            continue;
        open++;
        dark += color[0] < 0.999F * color[1];
    }
    print_message("# hard, a long ball: %d pixels open to the light, %d dark\n", open, dark);
    assert_true(open > 2000);
    assert_int_equal(dark, 0);
    krs_picture_free(picture);
}

/* The mean of 20x20 pixels from there on, of one colour. */
static double mean_of_block(const KrsPicture *picture, int x, int y, int channel)
{
    double sum = 0;
    for (int k = 0; k < 400; k++)
        sum += (double)picture->color[4 * ((y + k / 20) * WIDTH + x + k % 20) + channel];
    return sum / 400;
}

/* The greatest difference of means between a picture and its mirror image. */
static double asymmetry(const KrsPicture *picture)
{
    double most = 0;
    for (int y = 0; y < HEIGHT; y += 20)
        for (int x = 0; x < WIDTH; x += 20)
            for (int i = 0; i < 3; i++)
                most = fmax(most, fabs(mean_of_block(picture, x, y, i) -
                                       mean_of_block(picture, WIDTH - 20 - x, y, i)));
    return most;
}

static void symmetric_scenes_have_symmetric_pictures(void **state)
{
    (void)state;
    static const char text[] =
        "sky { zenith: [0.5, 0.5, 0.5], horizon: [0.7, 0.7, 0.7], ground: [0.3, 0.3, 0.3] }\n"
        "light sun { direction: [0, 1, -0.7], softness: 5deg }\n"
        "camera { eye: [0, 4, 8], target: [0, 0.5, 0], fov: 40deg }\n"
        "show plane([0, 1, 0], 0);\n"
        "show box([0.4, 1.6, 3]).move([0, 0.8, 0]);\n"
        "show sphere(0.6).move([1.2, 0.6, 0.3]) | sphere(0.6).move([-1.2, 0.6, 0.3]);\n";
    for (int plain = 0; plain < 2; plain++) {
        KrsPicture *picture = picture_of(
            text,
            &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .methods.no_upsampling = plain});
        double most = asymmetry(picture);
        print_message("# symmetry: off by %.2g%s\n", most, plain ? "" : " with upsampling");
        assert_true(most < MAX_ASYMMETRY);
        picture->color[4 * (HEIGHT / 2 * WIDTH + 20)] += 800 * MAX_ASYMMETRY; /* a planted fault */
        assert_false(asymmetry(picture) < MAX_ASYMMETRY);
        krs_picture_free(picture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_shadows_end_where_rays_say),
        cmocka_unit_test(lit_sides_are_lit),
        cmocka_unit_test(lit_sides_of_bounds_are_lit),
        cmocka_unit_test(symmetric_scenes_have_symmetric_pictures),
        cmocka_unit_test(wrong_hard_shadows_are_found),
    };
    return run_shadow_tests("hard shadows", tests, sizeof tests / sizeof tests[0]);
}
