/*
 * few_parts.c: for pictures few large parts of a sharp CSG node share code and have a table; everywhere else,
 * in blends, and if they are small, they do not.  Answers are the same.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "krs/krs.h"
#include "tests/support/random.h"

/* Eight of these are enough, and five are too few. */
#define LARGE                                                                                \
    "def part(i) = union(torus(0.5, 0.1 + 0.01 * i), capped_cone(0.1 + 0.02 * i, 0.2, 0.6)," \
    " ellipsoid([0.1, 0.7, 0.2 + 0.01 * i]), box([0.9, 0.1, 0.2 + 0.03 * i]), blend: 0.05)"  \
    ".rotate([0, 0, 1], 5deg * i).paint(mix(#ff0000, #0000ff, i / 8)).move([3 * i, 0, 0]);"
#define PARTS(count) LARGE "show union([part(i) for i in 0.." #count "]"

static KrsScene *compile(const char *text, bool pictures)
{
    const KrsOptions options = {.pictures = pictures};
    KrsScene        *scene   = NULL;
    assert_int_equal(krs_compile_text(text, strlen(text), "few.krs", &options, &scene), KRS_OK);
    return scene;
}

static bool has_table(const char *text, bool pictures)
{
    KrsScene  *scene = compile(text, pictures);
    const bool has   = krs_table_rows(scene) > 0;
    krs_scene_free(scene);
    return has;
}

static void few_large_parts_share_code(void **context)
{
    (void)context;
    assert_true(has_table(PARTS(8) ");", true));
    assert_false(has_table(PARTS(8) ");", false));
    assert_false(has_table(PARTS(5) ");", true));
    assert_false(has_table(PARTS(8) ", blend: 0.1);", true));
    assert_false(
        has_table("show union([sphere(0.1 * i + 0.2).move([i, 0, 0]) for i in 0..8]);", true));
}

static void answers_are_those_of_parts_apart(void **context)
{
    enum { COUNT = 2000 };
    static double points[COUNT][3];
    static KrsHit together[COUNT], apart[COUNT];
    Random        random = {11};
    (void)context;
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = random_between(&random, -2, k == 0 ? 26 : 3);
    for (int pictures = 0; pictures < 2; pictures++) {
        KrsScene *scene = compile(PARTS(8) ");", pictures);
        KrsState *state = NULL;
        assert_int_equal(krs_state_new(scene, &state), KRS_OK);
        assert_int_equal(
            krs_probe(state, (const double(*)[3])points, COUNT, pictures ? together : apart),
            KRS_OK);
        krs_state_free(state);
        krs_scene_free(scene);
    }
    for (int i = 0; i < COUNT; i++) {
        assert_true(fabs(together[i].distance - apart[i].distance) < 1e-12);
        assert_true(fabs(together[i].color[0] - apart[i].color[0]) < 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_large_parts_share_code),
        cmocka_unit_test(answers_are_those_of_parts_apart),
    };
    return cmocka_run_group_tests_name("few parts", tests, NULL, NULL);
}
