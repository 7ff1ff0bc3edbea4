/*
 * state_floor.c: the floor of a scene without surroundings, and the camera of one without cameras, at
 * the values that parameters have in a state: where they are if these are numbers of the text.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "krs/camera.h"

enum { MAX_TEXT = 1024 };

typedef struct Opened {
    KrsScene *scene;
    KrsState *state;
} Opened;

static Opened open_scene(const char *head, const char *text, uint32_t specialize)
{
    KrsOptions options = {.studio = true, .pictures = true, .specialize = specialize};
    char       whole[MAX_TEXT];
    Opened     opened;
    snprintf(whole, sizeof whole, "%s%s", head, text);
    if (krs_compile_text(whole, strlen(whole), "scene.krs", &options, &opened.scene) != KRS_OK)
        fail_msg("%s is refused", whole);
    assert_int_equal(krs_state_new(opened.scene, &opened.state), KRS_OK);
    return opened;
}

static void close_scene(Opened opened)
{
    krs_state_free(opened.state);
    krs_scene_free(opened.scene);
}

/* Where a ray from above meets it, far from everything else. */
static double floor_height(Opened opened)
{
    const double origin[1][3] = {{1e4, 1e3, 0}}, down[1][3] = {{0, -1, 0}};
    KrsComponent component;
    KrsHit       hit;
    assert_int_equal(krs_component(opened.scene, krs_component_count(opened.scene) - 1, &component),
                     KRS_OK);
    assert_string_equal(component.name, "floor");
    assert_int_equal(krs_raycast(opened.state, origin, down, 1, 1e5, 0, &hit), KRS_OK);
    assert_true(hit.hit);
    return hit.point[1];
}

static void set_height(Opened opened, double height)
{
    assert_int_equal(krs_state_set(opened.state, "h", &height, 1), KRS_OK);
}

/* Scenes of all kinds of shapes whose box has a rule, with a parameter h from 0.5 to 4. */
static const char *const scenes[] = {
    "show box([1, h, 1]);",
    "show sphere(h);",
    "show sphere(1).move([0, h, 0]);",
    "show box([1, 2, 3]).rotate([0, 0, 1], h);",
    "show box([1, 2, 3]).scale(h);",
    "show box([1, 1, 1]).scale([1, h, 2]);",
    "show box([1, 1, 1]).move([0, h, 0]) | sphere(1) | cylinder(1, h);",
    "show union([sphere(1), box([1, h, 1])], blend: 0.3 * h);",
    "show box([3, 3, 3]) & sphere(0.8).move([0, 0.3 * h, 0]);",
    "show box([1, h, 1]) - sphere(0.4);",
    "show xor(box([1, h, 1]), sphere(1));",
    "show if h > 2 then box([1, 5, 1]) else sphere(1);",
    "show box([1, 1, 1]).offset(0.2 * h);",
    "show box([1, 1, 1]).round(0.1 * h);",
    "show box([1, 1, 1]).shell(0.2 * h);",
    "show box([1, 1, 1]).elongate([0, h, 0]);",
    "show circle(1).extrude(h);",
    "show circle(0.4).move([1, h]).revolve();",
    "show sphere(0.2).repeat([h, h, h], [3, 3, 3]);",
    "show sphere(h).move([3, 0, 0]).repeat_polar(5);",
    "show box([1, 1, 1]).move([-2, h, 0]).mirror(plane([1, 0, 0], 0));",
    "show union([box([1, h * (i + 1), 1]).move([2 * i, 0, 0]) for i in 0..5]);",
    "for i in 0..5 { show sphere(0.1 * h).move([i, h * i - 2, 0]); }",
    "show sphere(1).move([3, 1, 0]); show box([1, h, 1]).paint(#ff0000);",
    "show krs { kernel cylinder(0.1, 1); for i in 0..5 {"
    "  reflect plane([sin(0.2 * h), cos(0.2 * h), 0.3 * i], 0.7 * i + 0.3); } };",
    "show krs { kernel sphere(0.1 * h); mobius translate([0, -h, 0]); reflect plane([1, 1, 0], "
    "0.1);"
    "  kernel box([0.3, h, 0.3]); reflect plane([0, 1, 0.2], 0.4 * h); };",
    "let base = 2 * h; show cone(1, base); show torus(h, 0.2 * h);",
};

static void compare_boxes(Opened asked, Opened fixed)
{
    double found[2][3], truth[2][3];
    assert_true(krs_state_box(asked.state, found[0], found[1]));
    assert_true(krs_state_box(fixed.state, truth[0], truth[1]));
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++)
            assert_true(fabs(found[side][k] - truth[side][k]) < 1e-6);
    for (size_t i = 0; i < krs_component_count(fixed.scene); i++) {
        const bool ends = krs_state_component_box(fixed.state, i, truth[0], truth[1]);
        assert_int_equal(krs_state_component_box(asked.state, i, found[0], found[1]), ends);
        for (int k = 0; ends && k < 3; k++)
            assert_true(fabs(found[0][k] - truth[0][k]) < 1e-6 &&
                        fabs(found[1][k] - truth[1][k]) < 1e-6);
    }
    assert_false(
        krs_state_component_box(fixed.state, krs_component_count(fixed.scene), found[0], found[1]));
}

/* Compares a scene with a parameter, for some values of it, with the text with these numbers. */
static void compare_floors(const char *head, const char *text, uint32_t specialize)
{
    const double values[] = {1, 0.5, 3.3, 4};
    const Opened asked    = open_scene(head, text, specialize);
    for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
        char number[64];
        snprintf(number, sizeof number, "let h = %g;", values[v]);
        const Opened fixed = open_scene(number, text, KRS_SPECIALIZE_NUMBERS);
        set_height(asked, values[v]);
        const double found = floor_height(asked), truth = floor_height(fixed);
        compare_boxes(asked, fixed);
        if (!(fabs(found - truth) < 1e-6))
            fail_msg("%s%s, h = %g: the floor is at %g, not at %g", head, text, values[v], found,
                     truth);
        close_scene(fixed);
    }
    close_scene(asked);
}

static void follows_parameters(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        compare_floors("param h = 1 in [0.5, 4];", scenes[i], KRS_SPECIALIZE_NUMBERS);
        compare_floors("param h = 1 in [0.5, 4];", scenes[i], KRS_SPECIALIZE_STRUCTURE);
    }
}

/* The box for all values of the parameter is endless. */
static void follows_parameters_without_a_range(void **context)
{
    (void)context;
    compare_floors("param h = 1;", "show box([1, h, 1]);", KRS_SPECIALIZE_NUMBERS);
    compare_floors("param h = 1;", "show sphere(1).move([0, h, 0]);", KRS_SPECIALIZE_NUMBERS);
}

static void camera_follows_where_it_is_asked_to(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const Opened asked = open_scene("param h = 1 in [0.5, 4];", scenes[i], 0);
        const Opened fixed = open_scene("let h = 3.3;", scenes[i], 0);
        KrsCamera    first, before, after, truth;
        double       error = 0, moved = 0, away = 0;
        assert_int_equal(krs_state_camera(asked.state, 0, &first), KRS_OK);
        set_height(asked, 3.3);
        assert_int_equal(krs_state_camera(asked.state, 0, &before), KRS_OK);
        assert_memory_equal(first.eye, before.eye, sizeof first.eye);
        assert_int_equal(krs_state_fit_camera(asked.state), KRS_OK);
        assert_int_equal(krs_state_camera(asked.state, 0, &after), KRS_OK);
        assert_int_equal(krs_state_camera(fixed.state, 0, &truth), KRS_OK);
        for (int k = 0; k < 3; k++) {
            error = fmax(error, fabs(after.eye[k] - truth.eye[k]));
            moved = fmax(moved, fabs(after.eye[k] - before.eye[k]));
            away  = fmax(away, fabs(truth.eye[k] - truth.target[k]));
        }
        if (error > 0.02 * away)
            fail_msg("%s: the camera is %g from where it should be", scenes[i], error);
        if (!(moved > 0.02 * away))
            fail_msg("%s: the camera has moved by %g only", scenes[i], moved);
        close_scene(asked);
        close_scene(fixed);
    }
}

/* What moves with the time stands on one floor for all times; what is set moves that. */
static void stays_with_the_time(void **context)
{
    const Opened opened = open_scene("param h = 1 in [0.5, 4];",
                                     "show box([1, h, 1]).move([0, 3 * sin(time), 0]);", 0);
    (void)context;
    for (int i = 0; i < 5; i++) {
        assert_int_equal(krs_state_set_time(opened.state, 0.7 * i), KRS_OK);
        set_height(opened, 1);
        assert_true(fabs(floor_height(opened) + 3.5) < 1e-6);
        set_height(opened, 2);
        assert_true(fabs(floor_height(opened) + 4) < 1e-6);
    }
    close_scene(opened);
}

/* A camera of the scene is never below the floor. */
static void stays_below_cameras(void **context)
{
    const char *const text   = "show sphere(1).move([0, h, 0]); camera { eye: [0, 1, 8] }";
    const Opened      opened = open_scene("param h = 0 in [0, 5];", text, 0);
    (void)context;
    assert_true(fabs(floor_height(opened) + 1) < 1e-6);
    set_height(opened, 1.5);
    assert_true(fabs(floor_height(opened) - 0.5) < 1e-6);
    set_height(opened, 5);
    assert_true(fabs(floor_height(opened) + 1) < 1e-6);
    close_scene(opened);
}

/* The box of mirrors that turn with the time is ten times too large, and rays hit little but the floor. */
static void camera_finds_a_small_thing_in_a_large_box(void **context)
{
    const char *const text     = "show krs {"
                                 "kernel cylinder(0.1, 1).move([0, 0.5, 0]);"
                                 "for i in 0..6 {"
                                 "reflect plane([sin(h), cos(h), 0.2 * i], 0.9 * i + 0.8); } };";
    const double      lower[3] = {-0.2, 0, -0.2}, upper[3] = {1.8, 5.4, 5.4};
    const Opened      opened = open_scene("let h = clamp(0.3 + sin(time), 0, 1);", text, 0);
    KrsComponent      component;
    KrsCamera         camera;
    double            away = 0;
    (void)context;
    assert_int_equal(krs_component(opened.scene, 0, &component), KRS_OK);
    assert_true(component.low[0] < -10 && component.high[0] > 10);
    assert_int_equal(krs_state_camera(opened.state, 0, &camera), KRS_OK);
    for (int k = 0; k < 3; k++) {
        assert_true(lower[k] < camera.target[k] && camera.target[k] < upper[k]);
        away = hypot(away, camera.eye[k] - camera.target[k]);
    }
    assert_true(5 < away && away < 25);
    close_scene(opened);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(follows_parameters),
                                       cmocka_unit_test(follows_parameters_without_a_range),
                                       cmocka_unit_test(camera_follows_where_it_is_asked_to),
                                       cmocka_unit_test(stays_with_the_time),
                                       cmocka_unit_test(stays_below_cameras),
                                       cmocka_unit_test(camera_finds_a_small_thing_in_a_large_box)};
    return cmocka_run_group_tests_name("state_floor", tests, NULL, NULL);
}
