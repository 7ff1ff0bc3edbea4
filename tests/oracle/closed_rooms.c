/*
 * closed_rooms.c: the light of closed rooms, for pictures and rooms of all sizes.
 *
 * Where all walls emit E and reflect the part a of light, each place sends E + a E + a^2 E + ... into
 * all directions: so many terms as paths have surfaces.  What lets light through, mirrors it or
 * scatters it below its surface, and absorbs nothing, is not seen in there.  So paths that leak out of
 * the room are light that is missing.
 *
 * In a ball with a lamp of intensity I in its middle all places send the same, too: a I / (pi r^2) of
 * the lamp, and with what walls send to each other that divided by 1 - a.  There the insides of walls
 * are dark, and a path that meets the surface again that it leaves is light that is missing.
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

/* Rooms about 3 wide are scaled and moved; the camera is near the middle. */
#define ROOM                                                                                \
    "param size = 1 in [1e-5, 1e5]; param place = [0, 0, 0]; param power = 0 in [0, 9];\n"  \
    "param part = 1 in [0, 1]; param glow = 1 in [0, 9];\n"                                 \
    "camera { eye: place + size * [0.3, 0.1, 0.2], target: place + size * [1, 0.3, 0.5],\n" \
    "         fov: 60deg }\n"                                                               \
    "sky { zenith: black, horizon: black, ground: black }\n"                                \
    "light lamp { position: place, intensity: power * size * size }\n"                      \
    "material wall { color: [part, part, part], specular: 0, emission: [glow, glow, glow] }\n"
#define SHOW(shape, material) "show (" shape ").scale(size).move(place).paint(" material ");\n"
#define BOX                   SHOW("box([5, 5, 5]) - box([3, 2.4, 3.6])", "wall")
#define RADIUS                1.9
#define BALL                  ROOM SHOW("box([5, 5, 5]) - sphere(1.9)", "wall")

/* Rooms of walls alone, whose paths may have few surfaces. */
static const char *const bare[] = {
    ROOM BOX,
    BALL,
    ROOM SHOW("box([5, 5, 5]) - cylinder(1.5, 2.6)", "wall"),
    ROOM SHOW("box([5, 5, 5]) - (box([3, 2.4, 3]) | sphere(1.4).move([1, 0.6, 0.4]))"
              " | cylinder(0.2, 4).rotate([1, 0, 2], 30deg).move([-1, 0, -1])",
              "wall"),
    ROOM SHOW("box([6, 6, 6]) - union(sphere(1.5), box([4, 1, 1]), blend: 0.3)", "wall"),
    /* Thin walls, each a component. */
    ROOM SHOW("box([3, 0.02, 3]).move([0, -1.2, 0])", "wall")
        SHOW("box([3, 0.02, 3]).move([0, 1.2, 0])", "wall")
            SHOW("box([0.02, 2.42, 3]).move([1.5, 0, 0])", "wall")
                SHOW("box([0.02, 2.42, 3]).move([-1.5, 0, 0])", "wall")
                    SHOW("box([3.02, 2.42, 0.02]).move([0, 0, 1.5])", "wall")
                        SHOW("box([3.02, 2.42, 0.02]).move([0, 0, -1.5])", "wall"),
};

/* Rooms whose distance is a bound, has roots along rays, or a slope that varies. */
static const char *const curved[] = {
    ROOM SHOW("box([5, 5, 5]) - algebraic(x^8 + y^8 + z^8 == 20)", "wall"),
    ROOM SHOW("box([6, 6, 6]) - algebraic((x^2 + y^2 / 2)^3 + z^6 + x * z^3 / 4 == 6)", "wall"),
    ROOM SHOW("algebraic(x^4 + y^4 + z^4 == 10) - algebraic(x^4 + y^4 + z^4 == 9.8)", "wall"),
    ROOM SHOW("box([5, 5, 5]) - field(x^2 + y^2 + z^2 - 3 + 0.3 * sin(3 * x) * cos(3 * y))"
              ".within(box([4.6, 4.6, 4.6]))",
              "wall"),
    ROOM SHOW("box([7, 7, 7]) - julia(c: [-0.2, 0.6, 0.2, 0.1], power: 2, iterations: 4).scale(2)",
              "wall"),
    ROOM SHOW("box([6, 6, 6]) - box([2, 3, 2.4]).round(0.3).twist([0, 1, 0], 0.5)", "wall"),
};

/* A box with something white in it. */
static const char *const furnished[] = {
    ROOM "material glass { transmission: 1, roughness: 0.1, color: white }\n" BOX SHOW(
        "sphere(0.5).move([1, 0.2, 0.6])", "glass"),
    ROOM "material mirror { metallic: 1, roughness: 0, color: white }\n" BOX SHOW(
        "sphere(0.5).move([1, 0.2, 0.6])", "mirror"),
    ROOM
    "material wax { specular: 0, color: white, subsurface_weight: 1, subsurface_color: white,\n"
    "  subsurface_radius: size * [0.1, 0.1, 0.1] }\n" BOX SHOW("sphere(0.5).move([1, 0.2, 0.6])",
                                                               "wax"),
};
#define COUNT(list) (sizeof(list) / sizeof *(list))

/* The side of a picture, of which 64 pixels are rendered at most; what a room is scaled by, and where
   it is along a line. */
typedef struct View {
    unsigned side;
    double   size, place;
} View;
static const View views[] = {{8, 1, 0},      {2000, 1, 0}, {8, 1e-3, 0},   {8, 1, 7},
                             {2000, 1e4, 0}, {8, 1e4, 0},  {64, 0.01, 0.1}};
#define MOST 64u

/* The sides of previews; the first is what others are compared with. */
static const unsigned sides[] = {256, 8, 16, 40};

/* Light that may be lost or appear, beside noise. */
#define MAX_LOST 0.005

static KrsRenderOptions options_of(PathFixture *fixture, const View *view, uint32_t bounces)
{
    const unsigned side = view->side < MOST ? view->side : MOST, corner = (view->side - side) / 2;
    path_fixture_set(fixture, "size", view->size);
    path_fixture_set_all(fixture, "place", view->place, 2 * view->place, -3 * view->place);
    return (KrsRenderOptions){.width      = view->side,
                              .height     = view->side,
                              .crop       = {corner, corner, side, side},
                              .samples    = side < MOST ? 16 : 2,
                              .bounces    = bounces,
                              .aovs       = KRS_AOV_COLOR,
                              .integrator = KRS_INTEGRATOR_PATH};
}

static bool is_right(PathFixture *fixture, const View *view, uint32_t bounces, double expected,
                     const char *what, size_t number)
{
    char name[100];
    snprintf(name, sizeof name, "%s %zu, %u pixels, size %g, at %g", what, number, view->side,
             view->size, view->place);
    Estimate found = path_fixture_estimate(fixture, options_of(fixture, view, bounces), everywhere,
                                           3);
    return must_be_near(found, expected, MAX_LOST, name);
}

static void rooms_lose_no_light(void **state)
{
    (void)state;
    enum { BOUNCES = 3 };
    size_t wrong = 0;
    for (size_t i = 0; i < COUNT(bare); i++) {
        PathFixture fixture = path_fixture_open(bare[i]);
        for (size_t k = 0; k < COUNT(views); k++)
            wrong += !is_right(&fixture, &views[k], BOUNCES, 1 + BOUNCES, "bare room", i);
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* Paths of few surfaces have less noise, since none of them ends early. */
static void curved_rooms_lose_no_light(void **state)
{
    (void)state;
    static const View some[] = {{8, 1, 0}, {2000, 1e4, 0}, {64, 1e-3, 0.1}};
    enum { BOUNCES = 2, PATHS = 4096 };
    size_t wrong = 0;
    for (size_t i = 0; i < COUNT(curved); i++) {
        PathFixture fixture = path_fixture_open(curved[i]);
        for (size_t k = 0; k < COUNT(some); k++) {
            KrsRenderOptions options = options_of(&fixture, &some[k], BOUNCES);
            char             name[60];
            snprintf(name, sizeof name, "curved room %zu, %u pixels", i, some[k].side);
            options.samples = PATHS / (options.crop.width * options.crop.height);
            wrong += !must_be_near(path_fixture_estimate(&fixture, options, everywhere, 3),
                                   1 + BOUNCES, MAX_LOST, name);
        }
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* Walls that are a 400th of the room's width: hits are on the side that is met. */
static void thin_walls_lose_no_light(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(ROOM SHOW("sphere(1.9).shell(0.01)", "wall"));
    View        view    = {64, 1, 0};
    assert_true(is_right(&fixture, &view, 2, 3, "thin walls", 0));
    view.place = 7;
    assert_true(is_right(&fixture, &view, 2, 3, "thin walls", 1));
    path_fixture_close(&fixture);
}

/* Long rays are followed by short ones, below a thin ceiling above which all is open. */
static void low_rooms_lose_no_light(void **state)
{
    (void)state;
    const View  view    = {64, 1, 0};
    PathFixture fixture = path_fixture_open(
        ROOM "camera along { eye: [0.3, 0.1, 0.2], target: [1, 0.1, 0.3], fov: 4deg }\n" SHOW(
            "box([5, 5, 5]) - box([3, 0.02, 3]).move([0, 0.1, 0])"
            " - box([6, 5, 6]).move([0, 2.615, 0])",
            "wall"));
    KrsRenderOptions options = options_of(&fixture, &view, 3);
    options.camera           = 1;
    assert_true(must_be_near(path_fixture_estimate(&fixture, options, everywhere, 3), 4, MAX_LOST,
                             "low room"));
    path_fixture_close(&fixture);
}

static void white_furniture_is_not_seen(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (size_t i = 0; i < COUNT(furnished); i++) {
        PathFixture fixture = path_fixture_open(furnished[i]);
        path_fixture_set(&fixture, "part", 0.5);
        for (size_t k = 0; k < COUNT(views); k += 2)
            wrong += !is_right(&fixture, &views[k], 24, 2, "furnished room", i);
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* Where walls reflect less than half, most paths end early; dark ones seldom ask for the lamp. */
static void lamps_light_balls_evenly(void **state)
{
    (void)state;
    static const double parts[] = {0.7, 0.25, 0.04};
    const double        power   = 4;
    size_t              wrong   = 0;
    PathFixture         fixture = path_fixture_open(BALL);
    path_fixture_set(&fixture, "glow", 0);
    path_fixture_set(&fixture, "power", power);
    for (size_t i = 0; i < COUNT(parts); i++) {
        path_fixture_set(&fixture, "part", parts[i]);
        for (size_t k = 0; k < COUNT(views); k += 2)
            wrong += !is_right(&fixture, &views[k], 30,
                               parts[i] * power / (M_PI * RADIUS * RADIUS) / (1 - parts[i]), "ball",
                               k);
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* The start of a ray at a surface is where most distances may go. */
static void rays_leave_surfaces_by_few_distances(void **state)
{
    (void)state;
    PathFixture      fixture = path_fixture_open(BALL);
    const View       view    = {360, 1, 0};
    KrsRenderOptions options = options_of(&fixture, &view, 10);
    path_fixture_set(&fixture, "part", 0.9);
    KrsPicture *picture = path_fixture_render(&fixture, &options);
    print_message("# %.1f distances a path\n", picture->stats.evaluations_per_ray);
    assert_true(picture->stats.evaluations_per_ray < 100);
    krs_picture_free(picture);
    path_fixture_close(&fixture);
}

/* A lamp sends as much to walls in previews of all sizes. */
static void previews_of_all_sizes_are_alike(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (size_t i = 0; i < COUNT(bare); i++) {
        PathFixture fixture = path_fixture_open(bare[i]);
        double      lit     = 0;
        path_fixture_set(&fixture, "glow", 0);
        path_fixture_set(&fixture, "power", 4);
        for (size_t k = 0; k < COUNT(sides); k++) {
            KrsRenderOptions options = {
                .width = sides[k], .height = sides[k], .aovs = KRS_AOV_COLOR};
            Estimate light = path_fixture_estimate(&fixture, options, everywhere, 1);
            lit            = k ? lit : light.mean;
            print_message("# preview of bare room %zu, %u pixels: %.4f\n", i, sides[k], light.mean);
            wrong += !(fabs(light.mean / lit - 1) < 0.02);
        }
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rooms_lose_no_light),
        cmocka_unit_test(curved_rooms_lose_no_light),
        cmocka_unit_test(thin_walls_lose_no_light),
        cmocka_unit_test(low_rooms_lose_no_light),
        cmocka_unit_test(white_furniture_is_not_seen),
        cmocka_unit_test(lamps_light_balls_evenly),
        cmocka_unit_test(rays_leave_surfaces_by_few_distances),
        cmocka_unit_test(previews_of_all_sizes_are_alike),
    };
    return cmocka_run_group_tests_name("closed_rooms", tests, renderer_open, renderer_close);
}
