/*
 * edits.c: a rendering follows the edits of its scene, and compiles what is new only.
 *
 * Pictures of an updated scene are those of a scene that its text alone makes, bit by bit.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/device.h"
#include "tests/support/renderer.h"

enum { WIDTH = 96, HEIGHT = 64, SAMPLES = 2 };

#define VIEW                    \
    "camera { eye: [3, 2, 5] }" \
    "light { direction: [1, 2, 1], intensity: 2, softness: 1deg }"
static const char before[] = "param r = 1; show union([sphere(r), box([1, 0.5, 2])], blend: 0.25)"
                             ".paint(#ff8000); show plane([0, 1, 0], -1);" VIEW;
static const char numbers[] =
    "param r = 0.8; show union([sphere(r), box([1.5, 0.6, 1])], blend: 0.4)"
    ".paint(#20c040); show plane([0, 1, 0.1], -1.2);"
    "camera { eye: [2, 3, 4] }"
    "light { direction: [0, 2, 1], intensity: 3, softness: 2deg }";
static const char structure[] = "param r = 1; show union([sphere(r), torus(1, 0.3)], blend: 0.25)"
                                ".paint(#ff8000); show plane([0, 1, 0], -1);" VIEW;
static const char panorama[]  = "param r = 1; show sphere(r).move([0, 0, -3]);"
                                "camera { eye: [0, 1, 0], projection: \"panorama\" }";

/* 100 rings are an instance group; 12 are none. */
#define RINGS(lift, count)                                                                   \
    "show union([torus(0.3, 0.1).move([0.7 * (i % 10) - 3, if i == 55 then " lift " else 0," \
    " 0.7 * floor(i / 10) - 4]) for i in 0.." count "]).paint(#ff8000);"                     \
    "show plane([0, 1, 0], -1);" VIEW
static const char group[] = RINGS("0.1", "100"), moved[] = RINGS("0.5", "100"),
                  more[] = RINGS("0.1", "130"), few[] = RINGS("0.1", "12");

static const KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = SAMPLES};

/* A scene on the device, with what a viewer has of it. */
typedef struct Viewer {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    KrsFilm      *film;
} Viewer;

static void check(KrsStatus status)
{
    if (status != KRS_OK)
        fail_msg("status %d: %s", (int)status, krs_renderer_message(renderer));
}

static Viewer open_viewer(const char *text)
{
    const KrsOptions how = {.specialize = KRS_SPECIALIZE_STRUCTURE};
    Viewer           viewer;
    check(krs_compile_text(text, strlen(text), "edited.krs", &how, &viewer.scene));
    check(krs_state_new(viewer.scene, &viewer.state));
    check(krs_rendering_new(renderer, viewer.scene, KRS_FOR_PICTURES, &viewer.rendering));
    check(krs_film_new(viewer.rendering, &options, &viewer.film));
    return viewer;
}

static void close_viewer(Viewer *viewer)
{
    krs_film_free(viewer->film);
    krs_rendering_free(viewer->rendering);
    krs_state_free(viewer->state);
    krs_scene_free(viewer->scene);
}

static KrsChange edit(Viewer *viewer, const char *text)
{
    KrsScene  *updated;
    KrsChanges changes;
    check(krs_scene_update(viewer->scene, text, strlen(text), &updated, &changes));
    check(krs_rendering_update(viewer->rendering, updated));
    check(krs_state_update(viewer->state, updated));
    krs_scene_free(viewer->scene);
    viewer->scene = updated;
    return changes.kind;
}

static KrsPicture *render(Viewer *viewer)
{
    KrsPicture *picture;
    check(krs_render(viewer->rendering, viewer->state, &options, &picture));
    return picture;
}

static KrsPicture *film(Viewer *viewer)
{
    KrsPicture *picture;
    for (int i = 0; i < SAMPLES; i++)
        check(krs_film_add(viewer->film, viewer->state, NULL, 1));
    assert_int_equal(krs_film_samples(viewer->film), SAMPLES);
    check(krs_film_read(viewer->film, 0, &picture));
    return picture;
}

static bool are_equal(const KrsPicture *a, const KrsPicture *b)
{
    const size_t pixels = WIDTH * HEIGHT;
    return memcmp(a->color, b->color, 4 * pixels * sizeof *a->color) == 0 &&
           memcmp(a->depth, b->depth, pixels * sizeof *a->depth) == 0 &&
           memcmp(a->normal, b->normal, 3 * pixels * sizeof *a->normal) == 0 &&
           memcmp(a->component, b->component, pixels * sizeof *a->component) == 0;
}

/* What the viewer shows is what a viewer of the text alone shows. */
static void assert_shows(Viewer *viewer, const char *text)
{
    Viewer      alone  = open_viewer(text);
    KrsPicture *right  = render(&alone);
    KrsPicture *shown  = render(viewer);
    KrsPicture *filmed = film(viewer);
    assert_true(are_equal(shown, right));
    assert_true(are_equal(filmed, right));
    krs_picture_free(filmed);
    krs_picture_free(shown);
    krs_picture_free(right);
    krs_film_clear(viewer->film);
    close_viewer(&alone);
}

/* Shaders that the renderer has made so far. */
static uint64_t shaders_made(Viewer *viewer)
{
    KrsPicture    *picture = render(viewer);
    const uint64_t made    = picture->stats.shaders;
    krs_picture_free(picture);
    return made;
}

/* No text of a shader was printed for the last edit: that would have taken time. */
static void assert_shaders_stay(const Viewer *viewer)
{
    KrsShaderStats shaders[32];
    size_t         with_scene = 0;
    const size_t   count      = krs_rendering_shaders(viewer->rendering, shaders, 32);
    assert_in_range(count, 1, 32);
    for (size_t i = 0; i < count; i++) {
        with_scene += shaders[i].glsl_bytes > 0;
        assert_true(shaders[i].glsl_bytes == 0 || (shaders[i].cached && shaders[i].spirv_ms == 0));
    }
    assert_true(with_scene > 0);
}

static void an_edit_of_numbers_compiles_nothing(void **context)
{
    (void)context;
    Viewer      viewer = open_viewer(before);
    KrsPicture *first  = film(&viewer);
    krs_film_clear(viewer.film);
    const uint64_t made = shaders_made(&viewer);
    assert_int_equal(edit(&viewer, numbers), KRS_CHANGE_VALUES);
    assert_int_equal(shaders_made(&viewer), made);
    assert_shaders_stay(&viewer);
    KrsPicture *second = render(&viewer);
    assert_false(are_equal(first, second));
    assert_shows(&viewer, numbers);
    assert_int_equal(edit(&viewer, before), KRS_CHANGE_VALUES);
    assert_shows(&viewer, before);
    /* A rendering of its own finds the shaders, too. */
    assert_int_equal(shaders_made(&viewer), made);
    krs_picture_free(first);
    krs_picture_free(second);
    close_viewer(&viewer);
}

static void edits_of_a_instance_compile_nothing(void **context)
{
    (void)context;
    Viewer         viewer = open_viewer(group);
    KrsPicture    *first  = render(&viewer);
    const uint64_t made   = shaders_made(&viewer);
    assert_int_equal(edit(&viewer, moved), KRS_CHANGE_VALUES);
    KrsPicture *second = render(&viewer);
    assert_false(are_equal(first, second));
    assert_shows(&viewer, moved);
    assert_int_equal(edit(&viewer, more), KRS_CHANGE_VALUES);
    assert_shows(&viewer, more);
    assert_int_equal(edit(&viewer, group), KRS_CHANGE_VALUES);
    assert_shows(&viewer, group);
    assert_int_equal(shaders_made(&viewer), made);
    assert_int_equal(edit(&viewer, few), KRS_CHANGE_STRUCTURE);
    assert_shows(&viewer, few);
    assert_true(shaders_made(&viewer) > made);
    assert_int_equal(edit(&viewer, more), KRS_CHANGE_STRUCTURE);
    assert_shows(&viewer, more);
    krs_picture_free(first);
    krs_picture_free(second);
    close_viewer(&viewer);
}

static void other_structures_are_compiled_once(void **context)
{
    (void)context;
    Viewer         viewer = open_viewer(before);
    const uint64_t made   = shaders_made(&viewer);
    assert_int_equal(edit(&viewer, structure), KRS_CHANGE_STRUCTURE);
    const uint64_t then = shaders_made(&viewer);
    assert_true(then > made);
    assert_shows(&viewer, structure);
    assert_int_equal(edit(&viewer, before), KRS_CHANGE_STRUCTURE);
    assert_shows(&viewer, before);
    assert_int_equal(edit(&viewer, structure), KRS_CHANGE_STRUCTURE);
    assert_int_equal(shaders_made(&viewer), then);
    close_viewer(&viewer);
}

static void rays_and_zones_follow(void **context)
{
    (void)context;
    Viewer viewer = open_viewer(before);
    check(krs_state_set_zones(viewer.state, (const double[][4]){{0, 1, 0, 0.75}}, 1));
    KrsPicture *picture = render(&viewer);
    krs_picture_free(picture);
    assert_int_equal(edit(&viewer, numbers), KRS_CHANGE_VALUES);
    picture = render(&viewer);
    assert_shaders_stay(&viewer);
    check(krs_state_set_zones(viewer.state, NULL, 0));
    KrsPicture *whole = render(&viewer);
    assert_false(are_equal(picture, whole));
    assert_int_equal(edit(&viewer, panorama), KRS_CHANGE_STRUCTURE);
    assert_shows(&viewer, panorama);
    assert_int_equal(edit(&viewer, before), KRS_CHANGE_STRUCTURE);
    assert_shows(&viewer, before);
    krs_picture_free(picture);
    krs_picture_free(whole);
    close_viewer(&viewer);
}

static void films_lose_their_samples(void **context)
{
    (void)context;
    Viewer      viewer = open_viewer(before);
    KrsPicture *picture;
    check(krs_film_add(viewer.film, viewer.state, NULL, 1));
    edit(&viewer, numbers);
    assert_int_equal(krs_film_samples(viewer.film), 0);
    assert_int_equal(krs_film_read(viewer.film, 0, &picture), KRS_BAD_ARGUMENT);
    assert_shows(&viewer, numbers);
    close_viewer(&viewer);
}

static void mistakes_leave_what_is_shown(void **context)
{
    (void)context;
    KrsScene   *updated;
    Viewer      viewer = open_viewer(before);
    const char *wrong  = "show sphere(;";
    check(krs_film_add(viewer.film, viewer.state, NULL, 1));
    assert_int_equal(krs_scene_update(viewer.scene, wrong, strlen(wrong), &updated, NULL),
                     KRS_BAD_SCENE);
    assert_null(updated);
    check(krs_film_add(viewer.film, viewer.state, NULL, 1));
    assert_int_equal(krs_film_samples(viewer.film), 2);
    krs_film_clear(viewer.film);
    assert_shows(&viewer, before);
    close_viewer(&viewer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edit_of_numbers_compiles_nothing),
        cmocka_unit_test(edits_of_a_instance_compile_nothing),
        cmocka_unit_test(other_structures_are_compiled_once),
        cmocka_unit_test(rays_and_zones_follow),
        cmocka_unit_test(films_lose_their_samples),
        cmocka_unit_test(mistakes_leave_what_is_shown),
    };
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
