/*
 * memory.c: an allocation that fails, at every point where one is made, ends the call with
 * KRS_OUT_OF_MEMORY, nothing leaked and nothing broken.  Memory grows in step with scenes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/scarce.h"

static const char *const scenes[] = {
    "show sphere(1);",
    ("param r = 0.3 in [0.1, 0.5];"
     "show union([sphere(1), box([1, 2, 1])], blend: r).move([r, 1, 0]);"),
    "show krs { kernel box([1, 1, 1]); for i in 0..6 { reflect plane(random_direction(i), 1); } };",
    "show [sphere(0.2).move([i, 0, 0]) for i in 0..40]; camera { eye: [1, 2, 3] }",
    "show field(y - sin(x * time)).within(box([2, 2, 2]));",
    "let a = 1 +; show sphre(1); show box(a).mvoe(1);", /* several mistakes */
};

/* Everything a caller does with a scene. */
static KrsStatus use_scene(const char *text, Scarce *scarce)
{
    KrsOptions options = {.allocator = scarce_allocator(scarce)};
    KrsScene  *scene;
    KrsState  *state  = NULL;
    KrsStatus  status = krs_compile_text(text, strlen(text), "scene.krs", &options, &scene);
    if (status == KRS_OK)
        status = krs_state_new(scene, &state);
    if (status == KRS_OK) {
        double point[1][3] = {{1, 2, 3}}, distance;
        KrsHit hit;
        krs_distance(state, (const double(*)[3])point, 1, &distance);
        krs_probe(state, (const double(*)[3])point, 1, &hit);
    }
    krs_state_free(state);
    krs_scene_free(scene);
    return status;
}

static void fail_at_every_point(bool lasting)
{
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Scarce    plenty   = {0};
        KrsStatus expected = use_scene(scenes[i], &plenty);
        assert_int_equal(plenty.held, 0);
        assert_true(plenty.made > 3);
        for (int64_t failing = 1; failing <= plenty.made; failing++) {
            Scarce    scarce = {.failing = failing, .lasting = lasting};
            KrsStatus status = use_scene(scenes[i], &scarce);
            assert_int_equal(scarce.held, 0);
            if (status != expected)
                assert_int_equal(status, KRS_OUT_OF_MEMORY);
            else
                assert_false(lasting); /* memory that never comes cannot go unnoticed */
        }
    }
}

static void one_allocation_fails(void **context)
{
    (void)context;
    fail_at_every_point(false);
}

static void all_later_allocations_fail(void **context)
{
    (void)context;
    fail_at_every_point(true);
}

/* Texts and meshes that the caller gets are blocks of its allocator, and go back to it. */
static void results_are_of_the_allocator(void **context)
{
    (void)context;
    static const char text[]  = "show  sphere(1);";
    Scarce            scarce  = {0};
    KrsOptions        options = {.allocator = scarce_allocator(&scarce)};
    KrsScene         *scene;
    KrsState         *state;
    KrsMesh          *mesh, *simplified;
    char             *formatted, *glsl;
    bool              same;
    assert_int_equal(krs_format_text(text, strlen(text), "a.krs", &options, &formatted, &same),
                     KRS_OK);
    assert_string_equal(formatted, "show sphere(1);\n");
    assert_int_equal(scarce.held, 1);
    options.allocator.release(options.allocator.user, formatted);
    assert_int_equal(krs_compile_text(text, strlen(text), "a.krs", &options, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    int64_t before = scarce.held;
    assert_int_equal(krs_text(scene, KRS_TARGET_GLSL, NULL, &glsl), KRS_OK);
    assert_int_equal(scarce.held, before + 1);
    options.allocator.release(options.allocator.user, glsl);
    assert_int_equal(krs_mesh(state, &(KrsMeshOptions){.error = 0.1}, &mesh), KRS_OK);
    assert_int_equal(scarce.held, before + 3); /* the mesh, its vertices and its triangles */
    assert_int_equal(krs_mesh_simplify(mesh, &(KrsMeshOptions){.error = 0.1}, &simplified), KRS_OK);
    assert_int_equal(scarce.held, before + 6);
    krs_mesh_free(simplified);
    krs_mesh_free(mesh);
    assert_int_equal(scarce.held, before);
    krs_state_free(state);
    krs_scene_free(scene);
    assert_int_equal(scarce.held, 0);
}

/* The list of words is one block, or there is none. */
static void words_are_listed_or_not(void **context)
{
    (void)context;
    Scarce       plenty    = {0};
    KrsAllocator allocator = scarce_allocator(&plenty);
    char        *words, *again;
    assert_int_equal(krs_words(&allocator, &words), KRS_OK);
    assert_int_equal(plenty.held, 1);
    assert_non_null(strstr(words,
                           "{\"kind\": \"shape\", \"name\": \"sphere\", \"parameters\": "
                           "[{\"name\": \"radius\", \"optional\": true, \"default\": \"1\"}], "
                           "\"about\": \"A ball around the origin. Exact in- and outside.\"}"));
    assert_non_null(strstr(words, "\"name\": \"union\", \"parameters\": [{\"name\": \"shapes\", "
                                  "\"many\": true}, {\"name\": \"blend\", \"optional\": true}"));
    assert_int_equal(krs_words(NULL, &again), KRS_OK);
    assert_string_equal(again, words);
    free(again);
    for (int64_t failing = 1; failing <= plenty.made; failing++) {
        Scarce scarce = {.failing = failing, .lasting = true};
        allocator     = scarce_allocator(&scarce);
        assert_int_equal(krs_words(&allocator, &again), KRS_OUT_OF_MEMORY);
        assert_null(again);
        assert_int_equal(scarce.held, 0);
    }
    allocator = scarce_allocator(&plenty);
    allocator.release(allocator.user, words);
    assert_int_equal(plenty.held, 0);
}

static void the_limit_holds(void **context)
{
    (void)context;
    Scarce      scarce  = {0};
    KrsOptions  options = {.allocator = scarce_allocator(&scarce), .memory_limit = 1 << 20};
    const char *text    = "let a = [[i, i + 1, i + 2] for i in 0..900000]; show sphere(1);";
    KrsScene   *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &scene),
                     KRS_OUT_OF_MEMORY);
    assert_null(scene);
    assert_int_equal(scarce.held, 0);
}

/* ---- growth ---- */

typedef struct Counted {
    size_t bytes; /* all that was ever asked for */
} Counted;

static void *counted_allocate(void *user, size_t size)
{
    Counted *counted = user;
    counted->bytes += size;
    return malloc(size);
}

static void counted_release(void *user, void *block)
{
    (void)user;
    free(block);
}

static size_t bytes_for(const char *format, int count)
{
    char       text[256];
    Counted    counted = {0};
    KrsOptions options = {.allocator = {counted_allocate, counted_release, &counted}};
    KrsScene  *scene;
    snprintf(text, sizeof text, format, count);
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &scene), KRS_OK);
    krs_scene_free(scene);
    return counted.bytes;
}

/* What each component, shape or mirror takes is not the size of the whole scene. */
static void memory_grows_with_the_scene(void **context)
{
    (void)context;
    static const char *const growing[] = {
        "camera {} for i in 0..%d { show sphere(0.1).move([0.1 * i, 0, 0]); }",
        "camera {} show union([sphere(0.1).move([0.1 * i, 0, 0]) for i in 0..%d]);",
        "camera {} show union([sphere(0.1).move([0.1 * i, 0, 0]) for i in 0..%d], blend: 0.1);",
        "camera {} for i in 0..%d / 4 { show krs { kernel box([1, 1, 1]); for k in 0..4 {"
        " reflect plane(random_direction(k), 1); } }.scale(0.1).move([0.5 * i, 0, 0]); }",
        "camera {} show krs { kernel box([1, 1, 1]); for i in 0..%d / 8 {"
        " reflect plane([cos(i), sin(i), 0], 0.1 * i); } };",
    };
    for (size_t i = 0; i < sizeof growing / sizeof *growing; i++)
        assert_true(bytes_for(growing[i], 800) < 4 * bytes_for(growing[i], 200));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_allocation_fails),
        cmocka_unit_test(all_later_allocations_fail),
        cmocka_unit_test(results_are_of_the_allocator),
        cmocka_unit_test(words_are_listed_or_not),
        cmocka_unit_test(the_limit_holds),
        cmocka_unit_test(memory_grows_with_the_scene),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
