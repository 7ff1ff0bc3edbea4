/*
 * moving_scenes.c: instance groups that parameters and the time move, turn and scale: in each frame they are those
 * of a scene in which these numbers are known.
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
#include "tests/support/random.h"

enum { POINTS = 2000 };

static Random randomness = {1};

static double between(double low, double high) { return random_between(&randomness, low, high); }

static const char scene_text[] =
    "%s"
    "def place(i) = [gap * (i %% 20 - 10), sin(beat + i), 2 * floor(i / 20) - 10];"
    "show union([union([sphere(0.3), box([0.4, 0.4, 0.4]).move([0.3, 0, 0])]).rotate([0, 1, 0], "
    "turn * i)"
    ".scale(0.5 + 0.1 * gap).move(place(i)).paint(#808080) for i in 0..400]);"
    "show union([sphere(0.4).move([i - 100, gap, 3 * sin(beat)]) for i in 0..200], blend: 0.1);";

static KrsState *state_of(const char *declared, KrsScene **scene)
{
    char      text[1024];
    KrsState *state;
    snprintf(text, sizeof text, scene_text, declared);
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, scene), KRS_OK);
    assert_int_equal(krs_state_new(*scene, &state), KRS_OK);
    return state;
}

/* Whether answers in a state are those of a scene in which its numbers are known. */
static void assert_same_answers(KrsState *state, KrsState *known)
{
    double points[POINTS][3], is[POINTS], wanted[POINTS], bounds[POINTS];
    for (int i = 0; i < POINTS; i++)
        random_vector(&randomness, 12, points[i]);
    const double(*p)[3] = (const double(*)[3])points;
    assert_int_equal(krs_distance(state, p, POINTS, is), KRS_OK);
    assert_int_equal(krs_distance(known, p, POINTS, wanted), KRS_OK);
    assert_int_equal(krs_distance_bound(state, p, POINTS, bounds), KRS_OK);
    for (int i = 0; i < POINTS; i++) {
        assert_true(fabs(is[i] - wanted[i]) < 1e-9);
        assert_true(bounds[i] < wanted[i] + 1e-9);
        double alone; /* without lanes */
        assert_int_equal(krs_distance(state, p + i, 1, &alone), KRS_OK);
        assert_true(alone == is[i]);
    }
}

static void states_are_scenes(void **context)
{
    (void)context;
    KrsScene *scene, *other;
    KrsState *state = state_of(
        "param gap = 1 in [0.5, 3]; param turn = 1 in [0, 6]; let beat = time;", &scene);
    for (int i = 0; i < 4; i++) {
        double gap = between(0.5, 3), turn = between(0, 6), beat = between(-9, 9);
        char   declared[128];
        snprintf(declared, sizeof declared, "let gap = %.17g; let turn = %.17g; let beat = %.17g;",
                 gap, turn, beat);
        KrsState *known = state_of(declared, &other);
        assert_int_equal(krs_state_set(state, "gap", &gap, 1), KRS_OK);
        assert_int_equal(krs_state_set(state, "turn", &turn, 1), KRS_OK);
        assert_int_equal(krs_state_set_time(state, beat), KRS_OK);
        assert_same_answers(state, known);
        krs_state_free(known);
        krs_scene_free(other);
    }
    krs_state_free(state);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_are_scenes),
    };
    return cmocka_run_group_tests_name("moving scenes", tests, NULL, NULL);
}
