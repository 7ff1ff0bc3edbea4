/*
 * emissive.c: shapes that emit light, and are small or far: paths find them by going towards them.
 *
 * They light a small part of a floor.  How much is known in closed form: by balls, which send
 * pi L (r / d)^2 cos, and by a rectangle.  Where paths found them by chance alone, a few pictures
 * would say nothing of it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

/* The camera sees a small part of the floor around the origin, which may be far from that of
   coordinates.  Only a shape that is asked for emits light. */
static const char floor_text[] =
    "param far = 0 in [0, 1e6]; param tiny = 0 in [0, 99]; param at = [0.4, 2.2, 0.3];\n"
    "param lamps = 0 in [0, 99]; param images = 0 in [0, 99]; param panel = 0 in [0, 99];\n"
    "param bulb = 0 in [0, 99]; param day = 0 in [0, 9]; param late = 0 in [0, 99];\n"
    "camera { eye: [far + 4, 3, 0], target: [far, 0, 0], up: [0, 0, 1],\n"
    "         projection: \"orthographic\", height: 0.05 }\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "material paint { color: white, specular: 0 }\n"
    "material a { color: black, specular: 0, emission: [tiny, tiny, tiny] }\n"
    "material b { color: black, specular: 0, emission: [lamps, lamps, lamps] }\n"
    "material c { color: black, specular: 0, emission: [images, images, images] }\n"
    "let half = if x < far then panel else 0;\n"
    "material d { color: black, specular: 0, emission: [half, half, half] }\n"
    "material e { color: black, specular: 0, emission: [bulb, bulb, bulb] }\n"
    "material f { color: black, specular: 0, emission: [late, late, late] }\n"
    "material glass { color: white, transmission: 1, roughness: 0 }\n"
    "show plane([0, 1, 0], 0).paint(paint);\n"
    "show sphere(0.02).move(at + [far, 0, 0]).paint(a);\n"
    "for i in 0..24 {\n"
    "    show sphere(0.03 + 0.001 * i).move([far + 2 * cos(i * 15deg), 1 + 0.1 * i,\n"
    "                                        2 * sin(i * 15deg)]).paint(b);\n"
    "}\n"
    "show krs { kernel sphere(0.05).move([-0.9, 2, -0.6]); reflect plane([1, 0, 0], 0);\n"
    "           reflect plane([0, 0, 1], 0); }.move([far, 0, 0]).paint(c);\n"
    "show box([2, 0.02, 1.2]).move([far, 2.51, 0]).paint(d);\n"
    "show sphere(0.2).move([far - 1.5, 1, 0]).paint(glass);\n"
    "show sphere(0.02).move([far - 1.5, 1, 0]).paint(e);\n"
    "show sphere(0.02).move([far, 1.5, time]).paint(f);\n";

static PathFixture fixture;

static int open_floor(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(floor_text);
    return 0;
}

static int close_floor(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

static Estimate look(KrsIntegrator integrator)
{
    const KrsRenderOptions options = {.width      = 32,
                                      .height     = 32,
                                      .samples    = 16,
                                      .bounces    = 5,
                                      .aovs       = KRS_AOV_COLOR,
                                      .integrator = integrator};
    return path_fixture_estimate(&fixture, options, everywhere, 6);
}

/* What a floor that faces y gets from a ball of radiance 1, over pi. */
static double sent_by_ball(double x, double y, double z, double radius)
{
    const double square = x * x + y * y + z * z;
    return radius * radius / square * (y / sqrt(square));
}

/* The noise of pictures that find light by chance is a hundred times as much. */
#define MAX_NOISE 0.018
#define MAX_WRONG 0.004

/* Tells whether a floor is lit as it should be, and pictures would tell if it were not. */
static bool is_right(KrsIntegrator integrator, double expected, const char *what)
{
    const Estimate found = look(integrator);
    if (!(found.error <= MAX_NOISE * expected))
        print_message("# %s: noise of %.4f\n", what, found.error / expected);
    return must_be_near(found, expected, MAX_WRONG, what) && found.error <= MAX_NOISE * expected;
}

static bool is_lit_by(const char *parameter, double radiance, double expected, const char *what)
{
    path_fixture_set(&fixture, parameter, radiance);
    const bool right = is_right(KRS_INTEGRATOR_PATH, radiance * expected, what);
    path_fixture_set(&fixture, parameter, 0);
    return right;
}

/* ---- Shapes of many kinds ---- */

static double sent_by_lamps(void)
{
    double sum = 0;
    for (int i = 0; i < 24; i++)
        sum += sent_by_ball(2 * cos(i * M_PI / 12), 1 + 0.1 * i, 2 * sin(i * M_PI / 12),
                            0.03 + 0.001 * i);
    return sum;
}

/* What a floor gets from a rectangle above it, with a corner straight above, over pi. */
static double sent_by_corner(double a, double b, double height)
{
    const double x = a / height, y = b / height, u = sqrt(1 + x * x), v = sqrt(1 + y * y);
    return (x / u * atan(y / u) + y / v * atan(x / v)) / (2 * M_PI);
}

static void small_shapes_light_a_floor(void **state)
{
    (void)state;
    size_t wrong = 0;
    wrong += !is_lit_by("tiny", 50, sent_by_ball(0.4, 2.2, 0.3, 0.02), "a ball");
    wrong += !is_lit_by("lamps", 20, sent_by_lamps(), "many lamps");
    wrong += !is_lit_by("images", 20, 4 * sent_by_ball(0.9, 2, 0.6, 0.05), "images of a lamp");
    wrong += !is_lit_by("panel", 3, 2 * sent_by_corner(1, 0.6, 2.5), "half a panel");
    assert_int_equal(wrong, 0);
}

/* The ball looks larger by the index of refraction, as long as it is small beside the glass.  What
   glass mirrors goes back to the ball. */
static void light_comes_through_glass(void **state)
{
    (void)state;
    const double expected = 0.96 * sent_by_ball(1.5, 1, 0, 0.03);
    path_fixture_set(&fixture, "bulb", 50);
    const Estimate found = look(KRS_INTEGRATOR_PATH);
    path_fixture_set(&fixture, "bulb", 0);
    assert_true(must_be_near(found, 50 * expected, 0.01, "a ball in glass"));
    assert_true(found.error < 2 * MAX_NOISE * found.mean);
}

/* ---- Frames ---- */

/* Nothing bounds the places that a ball may have. */
static void a_ball_may_be_anywhere(void **state)
{
    (void)state;
    size_t wrong = 0;
    path_fixture_set_all(&fixture, "at", -1, 1.5, 2);
    wrong += !is_lit_by("tiny", 50, sent_by_ball(-1, 1.5, 2, 0.02), "a ball elsewhere");
    path_fixture_set_all(&fixture, "at", 0.4, 2.2, 0.3);
    assert_int_equal(krs_state_set_time(fixture.product.state, 2.5), KRS_OK);
    wrong += !is_lit_by("late", 50, sent_by_ball(0, 1.5, 2.5, 0.02), "a ball at another time");
    assert_int_equal(krs_state_set_time(fixture.product.state, 0), KRS_OK);
    assert_int_equal(wrong, 0);
}

/* There coordinates are too coarse for the floor, so points are relative to the camera. */
static void balls_may_be_far_away(void **state)
{
    (void)state;
    size_t wrong = 0;
    path_fixture_set(&fixture, "far", 4e5);
    wrong += !is_lit_by("tiny", 50, sent_by_ball(0.4, 2.2, 0.3, 0.02), "a ball far away");
    path_fixture_set(&fixture, "far", 0);
    assert_int_equal(wrong, 0);
}

/* They end at the first bounce, which is where the light is. */
static void paths_of_one_bounce_find_it(void **state)
{
    (void)state;
    path_fixture_set(&fixture, "tiny", 50);
    const bool right = is_right(KRS_INTEGRATOR_DIRECT, 50 * sent_by_ball(0.4, 2.2, 0.3, 0.02),
                                "a ball by direct light");
    path_fixture_set(&fixture, "tiny", 0);
    assert_true(right);
}

/* The light of the sky is found by directions of the floor's own choice, as ever. */
static void the_sky_stays_as_it_is(void **state)
{
    (void)state;
    path_fixture_set(&fixture, "day", 1);
    path_fixture_set(&fixture, "tiny", 1);
    const Estimate dim = look(KRS_INTEGRATOR_DIRECT);
    path_fixture_set(&fixture, "tiny", 0);
    const Estimate none = look(KRS_INTEGRATOR_DIRECT);
    path_fixture_set(&fixture, "day", 0);
    assert_true(must_be_near(dim, none.mean, 0.002, "the sky beside a dim ball"));
    assert_true(dim.error < 1.2 * none.error + 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_shapes_light_a_floor),  cmocka_unit_test(light_comes_through_glass),
        cmocka_unit_test(a_ball_may_be_anywhere),      cmocka_unit_test(balls_may_be_far_away),
        cmocka_unit_test(paths_of_one_bounce_find_it), cmocka_unit_test(the_sky_stays_as_it_is),
    };
    return cmocka_run_group_tests_name("emissive", tests, open_floor, close_floor);
}
