/*
 * media.c: solids and water inside of glass, held against closed forms: how large a ball in a ball
 * of glass appears, what stacks of glass and water let through, and which of two media counts where
 * both are.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

#define DEGREE (M_PI / 180)

static const KrsRenderOptions paths = {.width      = 96,
                                       .height     = 96,
                                       .samples    = 1,
                                       .bounces    = 14,
                                       .aovs       = KRS_AOV_COLOR,
                                       .integrator = KRS_INTEGRATOR_PATH};

/* What a boundary reflects of light that meets it with this sine, by its index of refraction. */
static double fresnel(double sine, double index)
{
    double beyond = sine / index, cosine = sqrt(1 - sine * sine);
    if (beyond >= 1)
        return 1;
    double through = sqrt(1 - beyond * beyond);
    double across  = (cosine - index * through) / (cosine + index * through);
    double along   = (index * cosine - through) / (index * cosine + through);
    return 0.5 * (across * across + along * along);
}

/* ---- A ball in a ball of glass ---- */

/* The inner ball emits 1 and all else is black.  `touches` moves it to the wall. */
static const char ball_in_glass[] =
    "param index = 1.5 in [1, 4]; param radius = 0.4 in [0.1, 1]; param loss = 0 in [0, 9];\n"
    "camera { eye: [0, 0, 9], projection: \"orthographic\", height: 2.2 }\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "material glass { color: white, transmission: 1, roughness: 0, ior: index,\n"
    "                 absorption: [loss, loss, loss] }\n"
    "material ember { color: black, specular: 0, emission: [1, 1, 1] }\n"
    "show sphere(radius).paint(ember);\n"
    "show sphere(1).paint(glass);\n";

/* A ray at the offset h comes as near to the middle as h / index, so the ball appears that many
   times as large.  Rays that enter elsewhere never meet it.  The mean is over the outer ball. */
static double seen_of_ball(double radius, double index, double loss)
{
    enum { RINGS = 4000 };
    double seen = fmin(index * radius, 1), sum = 0;
    for (int i = 0; i < RINGS; i++) {
        double h = seen * (i + 0.5) / RINGS, nearest = h / index;
        double length = sqrt(1 - nearest * nearest) - sqrt(radius * radius - nearest * nearest);
        sum += (1 - fresnel(h, index)) * exp(-loss * length) * 2 * M_PI * h * seen / RINGS;
    }
    return sum / M_PI;
}

static void balls_are_seen_in_glass(void **state)
{
    (void)state;
    static const struct {
        double radius, index, loss;
    } balls[] = {{0.4, 1.5, 0}, {0.4, 1.5, 1}, {0.25, 2.4, 0}, {0.6, 1.33, 0.5}, {0.8, 1.5, 0}};
    PathFixture fixture = path_fixture_open(ball_in_glass);
    size_t      wrong   = 0;
    for (size_t i = 0; i < sizeof balls / sizeof *balls; i++) {
        const double radius = balls[i].radius, index = balls[i].index, loss = balls[i].loss;
        char         name[100];
        snprintf(name, sizeof name, "a ball of radius %g in glass of %g, %g", radius, index, loss);
        path_fixture_set(&fixture, "radius", radius);
        path_fixture_set(&fixture, "index", index);
        path_fixture_set(&fixture, "loss", loss);
        Estimate found = path_fixture_estimate(&fixture, paths, everywhere, 6);
        wrong += !must_be_near(found, seen_of_ball(radius, index, loss), 0.004, name);
        if (radius * index < 1) /* else the outer ball is full of it */
            assert_false(is_near(found, seen_of_ball(1.02 * radius, index, loss), 0.004));
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- Stacks of layers ---- */

/* Layers are boxes one above the other, from y = 0 upwards.  The camera looks up at a sky of 1. */
#define STACK                                                                    \
    "param angle = 0 in [0, 1.5]; param overlap = 0 in [-1, 1];\n"               \
    "camera { eye: [-5 * sin(angle), -5 * cos(angle), 0], up: [0, 0, 1],\n"      \
    "         projection: \"orthographic\", height: 0.5 }\n"                     \
    "sky { zenith: white, horizon: white, ground: black }\n"                     \
    "light none { direction: [0, 1, 0], color: black }\n"                        \
    "material glass { color: white, transmission: 1, roughness: 0, ior: 1.6,\n"  \
    "                 absorption: [0.5, 0.5, 0.5] }\n"                           \
    "material water { color: white, transmission: 1, roughness: 0, ior: 1.33,\n" \
    "                 absorption: [1.5, 1.5, 1.5] }\n"                           \
    "material ice { color: white, transmission: 1, roughness: 0, ior: 1.31,\n"   \
    "               absorption: [3, 3, 3] }\n"                                   \
    "def layer(low, high) = box([60, high - low, 60]).move([0, 0.5 * (low + high), 0]);\n"
#define GLASS "show layer(0, 0.3).paint(glass); show layer(0.8, 1).paint(glass);\n"
#define ICE   "show layer(0.4, 0.65).paint(ice);\n"
#define WATER "show layer(0.3 - overlap, 0.8 + overlap).paint(water);\n"

typedef struct Layer {
    double thickness, index, loss;
} Layer;

enum { LAYERS = 5 }; /* at most: what is behind the last is air */

/* What a stack reflects and lets through, of light from either side. */
typedef struct Stack {
    double back[2], through;
} Stack;

static Stack join(Stack a, Stack b)
{
    double between = 1 - a.back[1] * b.back[0];
    Stack  both    = {{a.back[0] + a.through * a.through * b.back[0] / between,
                       b.back[1] + b.through * b.through * a.back[1] / between},
                      a.through * b.through / between};
    return both;
}

/* Light that bounces between boundaries any number of times, by adding one after the other. */
static double let_through(const Layer layers[LAYERS], double angle)
{
    Stack  all  = {{0, 0}, 1};
    double here = 1;
    for (int i = 0; i <= LAYERS; i++) {
        double beyond = i < LAYERS && layers[i].index > 0 ? layers[i].index : 1;
        double back   = fresnel(sin(angle) / here, beyond / here);
        all           = join(all, (Stack){{back, back}, 1 - back});
        here          = beyond;
        if (i == LAYERS)
            break;
        double cosine = sqrt(1 - sin(angle) * sin(angle) / (beyond * beyond));
        all = join(all, (Stack){{0, 0}, exp(-layers[i].loss * layers[i].thickness / cosine)});
    }
    return all.through;
}

static bool is_stack(const char *text, double overlap, const Layer layers[LAYERS], const char *what)
{
    static const double angles[] = {0, 40 * DEGREE, 65 * DEGREE};
    PathFixture         fixture  = path_fixture_open(text);
    size_t              wrong    = 0;
    path_fixture_set(&fixture, "overlap", overlap);
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        char name[120];
        snprintf(name, sizeof name, "%s at %.0f degrees", what, angles[k] / DEGREE);
        path_fixture_set(&fixture, "angle", angles[k]);
        Estimate found = path_fixture_estimate(&fixture, paths, everywhere, 6);
        wrong += !must_be_near(found, let_through(layers, angles[k]), 0.004, name);
    }
    path_fixture_close(&fixture);
    return wrong == 0;
}

/* Where water and glass overlap by 0.1, what is shown last counts.  In a gap there is air. */
static const Layer glass_counts[LAYERS] = {{0.3, 1.6, 0.5}, {0.5, 1.33, 1.5}, {0.2, 1.6, 0.5}},
                   water_counts[LAYERS] = {{0.2, 1.6, 0.5}, {0.7, 1.33, 1.5}, {0.1, 1.6, 0.5}},
                   hollow[LAYERS]       = {{0.3, 1.6, 0.5}, {0.5, 1, 0}, {0.2, 1.6, 0.5}},
                   with_ice[LAYERS]     = {{0.3, 1.6, 0.5},
                                           {0.1, 1.33, 1.5},
                                           {0.25, 1.31, 3},
                                           {0.15, 1.33, 1.5},
                                           {0.2, 1.6, 0.5}};

static void water_stands_in_glass(void **state)
{
    (void)state;
    assert_true(is_stack(STACK WATER GLASS, 0, glass_counts, "water that touches glass"));
    assert_true(is_stack(STACK GLASS WATER, 0, glass_counts, "glass that touches water"));
}

static void what_is_shown_last_counts(void **state)
{
    (void)state;
    /* What the wrong one would let through is far from this. */
    assert_true(fabs(let_through(glass_counts, 0) - let_through(water_counts, 0)) > 0.05);
    assert_true(is_stack(STACK WATER GLASS, 0.1, glass_counts, "glass over water"));
    assert_true(is_stack(STACK GLASS WATER, 0.1, water_counts, "water over glass"));
}

/* Ice swims in water that touches glass: three media, one in the other. */
static void ice_is_in_water_in_glass(void **state)
{
    (void)state;
    assert_true(fabs(let_through(with_ice, 0) - let_through(glass_counts, 0)) > 0.05);
    assert_true(is_stack(STACK WATER ICE GLASS, 0, with_ice, "ice in water in glass"));
    assert_true(is_stack(STACK GLASS WATER ICE, 0, with_ice, "the same, the glass first"));
    assert_true(is_stack(STACK ICE WATER GLASS, 0, glass_counts, "water over ice hides it"));
}

static void hollows_are_empty(void **state)
{
    (void)state;
    assert_true(is_stack(STACK GLASS, 0, hollow, "two panes"));
    assert_true(is_stack(STACK "show (layer(0, 1) - layer(0.3, 0.8)).paint(glass);", 0, hollow,
                         "a pane with a hollow"));
}

/* ---- Solids that touch glass ---- */

/* A board that emits 1 touches the upper side of a pane, or is partly in it. */
static void solids_touch_glass(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(
        STACK "param depth = 0 in [0, 1];\n"
              "material ember { color: black, specular: 0, emission: [1, 1, 1] }\n"
              "show layer(0, 1).paint(glass); show layer(1 - depth, 2).paint(ember);\n");
    size_t wrong = 0;
    for (int i = 0; i < 3; i++) {
        const double depth = 0.2 * i, angle = 0.3 * i, sine = sin(angle);
        char         name[100];
        snprintf(name, sizeof name, "a board %g deep in glass", depth);
        path_fixture_set(&fixture, "angle", angle);
        path_fixture_set(&fixture, "depth", depth);
        Estimate found  = path_fixture_estimate(&fixture, paths, everywhere, 6);
        double   cosine = sqrt(1 - sine * sine / (1.6 * 1.6));
        double   right  = (1 - fresnel(sine, 1.6)) * exp(-0.5 * (1 - depth) / cosine);
        wrong += !must_be_near(found, right, 0.004, name);
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- A camera in glass ---- */

/* The camera is in the middle of a pane of thickness 1, and looks up through its upper side.  What
   that mirrors comes back from the lower side. */
static void cameras_look_out_of_glass(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(
        "param angle = 0 in [0, 1.5];\n"
        "camera { eye: [0, 0, 0], target: [sin(angle), cos(angle), 0], up: [0, 0, 1],\n"
        "         projection: \"orthographic\", height: 0.2 }\n"
        "sky { zenith: white, horizon: white, ground: black }\n"
        "light none { direction: [0, 1, 0], color: black }\n"
        "material glass { color: white, transmission: 1, roughness: 0, ior: 1.5,\n"
        "                 absorption: [0.5, 0.5, 0.5] }\n"
        "show box([60, 1, 60]).paint(glass);\n");
    size_t wrong = 0;
    for (int i = 0; i < 3; i++) {
        const double angle = 0.3 * i, kept = exp(-0.5 / cos(angle));
        const double back = fresnel(sin(angle), 1 / 1.5);
        char         name[100];
        snprintf(name, sizeof name, "out of glass at %g", angle);
        path_fixture_set(&fixture, "angle", angle);
        Estimate found = path_fixture_estimate(&fixture, paths, everywhere, 6);
        double   right = (1 - back) * sqrt(kept) / (1 - back * back * kept * kept);
        wrong += !must_be_near(found, right, 0.004, name);
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- Light through glass, in previews ---- */

/* A pane hangs over the floor, or beside it.  The camera is below it. */
static const char below_a_pane[] =
    "param angle = 0 in [0, 1.5]; param beside = 0 in [0, 100];\n"
    "camera { eye: [0, 1, 0.5], target: [0, 0, 0], projection: \"orthographic\", height: 0.1 }\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light sun { direction: [sin(angle), cos(angle), 0], intensity: 2 }\n"
    "material glass { color: [0.8, 0.8, 0.8], transmission: 1, roughness: 0, ior: 1.5,\n"
    "                 absorption: [0.7, 0.7, 0.7] }\n"
    "show plane([0, 1, 0], 0);\n"
    "show box([60, 0.5, 60]).move([beside, 3, 0]).paint(glass);\n";

static double look_below_pane(PathFixture *fixture, double beside)
{
    KrsRenderOptions preview = {.width      = 32,
                                .height     = 32,
                                .samples    = 1,
                                .aovs       = KRS_AOV_COLOR,
                                .integrator = KRS_INTEGRATOR_PREVIEW};
    path_fixture_set(fixture, "beside", beside);
    KrsPicture *picture = path_fixture_render(fixture, &preview);
    double      mean    = mean_of_region(picture, everywhere, 1);
    krs_picture_free(picture);
    return mean;
}

static void previews_light_through_glass(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(below_a_pane);
    size_t      wrong   = 0;
    for (int i = 0; i < 3; i++) {
        const double angle = 0.4 * i, head_on = (1.5 - 1) / (1.5 + 1);
        const double kept = 0.8 * pow(1 - head_on * head_on, 2) * exp(-0.7 * 0.5 / cos(angle));
        path_fixture_set(&fixture, "angle", angle);
        double found = look_below_pane(&fixture, 0) / look_below_pane(&fixture, 100);
        if (fabs(found - kept) > 0.003 * kept) {
            print_message("# light at %g through glass: %.5f instead of %.5f\n", angle, found,
                          kept);
            wrong++;
        }
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_are_seen_in_glass),   cmocka_unit_test(water_stands_in_glass),
        cmocka_unit_test(what_is_shown_last_counts), cmocka_unit_test(ice_is_in_water_in_glass),
        cmocka_unit_test(hollows_are_empty),         cmocka_unit_test(solids_touch_glass),
        cmocka_unit_test(cameras_look_out_of_glass), cmocka_unit_test(previews_light_through_glass),
    };
    return cmocka_run_group_tests_name("media", tests, renderer_open, renderer_close);
}
