/*
 * coordinates.c: shapes compute `u` and `v` only if some material may ask for them.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/scene/compiled.h"
#include "tests/support/same_scene.h"

static KrsScene *compile(const char *text)
{
    KrsScene *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "coordinates.krs", NULL, &scene), KRS_OK);
    return scene;
}

static KrsScene *compile_after(const char *material, const char *rest)
{
    char text[1000];
    snprintf(text, sizeof text, "%s %s", material, rest);
    return compile(text);
}

#define GROUP(part)                                                            \
    "show union([" part ".move([i % 10, 0, floor(i / 10)]) for i in 0..100]);" \
    "camera { eye: [4, 3, 15] }"

/* Whether they do, nothing else is another: the same instance group, from the first part on. */
static void coordinates_that_none_asks_for_change_nothing(void **state)
{
    (void)state;
    const char *balls   = GROUP("sphere(0.1 + 0.001 * i)");
    KrsScene   *without = compile_after("material unused { color: [0, 0, 0] }", balls);
    KrsScene   *with    = compile_after("material unused { color: [u, v, 0] }", balls);
    assert_true(krs_table_rows(with) > 0);
    assert_same_scene(with, without);
    krs_scene_free(with);
    krs_scene_free(without);
}

/* Where they have numbers of their own, tables have fewer columns without them. */
static void coordinates_that_none_asks_for_need_no_columns(void **state)
{
    (void)state;
    const char *rods    = GROUP("capsule([0, 0, 0], [0, 1, 0.01 * i], 0.2)");
    KrsScene   *without = compile_after("material unused { color: [0, 0, 0] }", rods);
    KrsScene   *with    = compile_after("material unused { color: [u, v, 0] }", rods);
    assert_true(krs_table_rows(without) > 0);
    assert_true(krs_table_rows(without) < krs_table_rows(with));
    assert_same_distances(with, without);
    krs_scene_free(with);
    krs_scene_free(without);
}

/* A material asks by a name, or as it is anisotropic without a tangent, also in a function. */
static void coordinates_that_some_ask_for_are_there(void **state)
{
    (void)state;
    static const char *const asks[][2] = {
        {"material m { color: [0, 0, 0] }", "material m { color: [u, 0, 0] }"},
        {"material m { color: [0, 0, 0] }", "def f(a) = a * v; material m { color: [f(1), 0, 0] }"},
        {"material m { specular_roughness_anisotropy: 0.5, tangent: [1, 0, 0] }",
         "material m { specular_roughness_anisotropy: 0.5 }"}};
    for (size_t i = 0; i < sizeof asks / sizeof *asks; i++) {
        KrsScene *scenes[2];
        for (int k = 0; k < 2; k++)
            scenes[k] = compile_after(asks[i][k],
                                      "show sphere(1).paint(m); camera { eye: [4, 3, 15] }");
        assert_false(same_shaders(scenes[0], scenes[1]));
        krs_scene_free(scenes[0]);
        krs_scene_free(scenes[1]);
    }
}

/* An arc costs as much as a part: where it belongs to the nearer of two, that is asked once. */
static void one_arc_is_enough_for_all_parts(void **state)
{
    (void)state;
    KrsScene         *scene   = compile("material m { color: [u, v, 0] }"
                                                  "show union([cylinder(1, 1), cone(2, 1).move([4, 0, 0]),"
                                                  "            cylinder(1, 3).move([0, 5, 0])]).paint(m);"
                                                  "camera { eye: [4, 3, 15] }");
    const KrsFunction wanted  = KRS_FUNCTION_SURFACE;
    const KrsVariant  variant = {0};
    char             *text    = krs_scene_text(scene, &variant, &wanted, 1, NULL);
    int               arcs    = 0;
    assert_non_null(text);
    for (const char *at = text; (at = strstr(at, "krs_atan2(")); at++)
        arcs++;
    assert_int_equal(arcs, 2); /* the function, and a call */
    free(text);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_that_none_asks_for_change_nothing),
        cmocka_unit_test(coordinates_that_none_asks_for_need_no_columns),
        cmocka_unit_test(coordinates_that_some_ask_for_are_there),
        cmocka_unit_test(one_arc_is_enough_for_all_parts),
    };
    return cmocka_run_group_tests_name("coordinates", tests, NULL, NULL);
}
