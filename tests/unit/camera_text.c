/*
 * camera_text.c: cameras that the viewer writes into texts: the text makes the camera that was meant,
 * and what is not of the camera stays as it was, byte by byte.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "live/text/camera_text.h"
#include "live/text/text_file.h"
#include "tests/support/random.h"

static const KrsCamera start = {
    .projection = KRS_PERSPECTIVE, .eye = {4, 3, 6}, .up = {0, 1, 0}, .fov = 40 * M_PI / 180};

static KrsScene *compile(const char *text)
{
    KrsScene *scene;
    if (krs_compile_text(text, strlen(text), "a", NULL, &scene) != KRS_OK)
        fail_msg("this does not compile: %s", text);
    return scene;
}

static KrsCamera camera_of(const KrsScene *scene)
{
    KrsCamera camera;
    KrsState *state;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_camera(state, 0, &camera), KRS_OK);
    krs_state_free(state);
    return camera;
}

static KrsCamera camera_in(const char *block)
{
    char text[1000];
    snprintf(text, sizeof text, "show sphere(1);\n%s", block);
    KrsScene *scene  = compile(text);
    KrsCamera camera = camera_of(scene);
    krs_scene_free(scene);
    return camera;
}

static void assert_numbers(const double *a, const double *b, int count)
{
    for (int i = 0; i < count; i++)
        assert_true(fabs(a[i] - b[i]) < 1e-5 * (1 + fabs(b[i])));
}

/* As far as a picture shows it. */
static void assert_camera(const KrsCamera *a, const KrsCamera *b)
{
    assert_int_equal(a->projection, b->projection);
    assert_numbers(a->eye, b->eye, 3);
    assert_numbers(a->target, b->target, 3);
    assert_numbers(a->up, b->up, 3);
    if (b->projection == KRS_PERSPECTIVE)
        assert_numbers(&a->fov, &b->fov, 1);
    if (b->projection == KRS_ORTHOGRAPHIC)
        assert_numbers(&a->height, &b->height, 1);
    assert_numbers(&a->aperture, &b->aperture, 1);
    if (b->aperture > 0) {
        assert_numbers(&a->focus, &b->focus, 1);
        assert_int_equal(a->blades, b->blades);
    }
    assert_numbers(a->shift, b->shift, 2);
    assert_numbers(a->shutter, b->shutter, 2);
    assert_numbers(&a->eyes, &b->eyes, 1);
}

/* ---- exact texts ---- */

/* Cameras go to [1, 2, 3]. */
static void what_is_the_same_stays(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"camera { eye: [0, 1, 5], target: [0, 0.5, 0] }",
         "camera { eye: [1, 2, 3], target: [0, 0.5, 0] }"},
        {"camera side{eye:[0,1,5]/* far, } */,fov:20deg+20deg // angle\n}",
         "camera side{eye:[1, 2, 3]/* far, } */,fov:20deg+20deg // angle\n}"},
        {"camera {\n    target: [0, 0.5, 0],  // what is seen\n}",
         "camera {\n    target: [0, 0.5, 0], eye: [1, 2, 3],  // what is seen\n}"},
        {"camera {}", "camera { eye: [1, 2, 3]}"},
        {"camera { projection: \"perspective\", eye: let h = 3 in [h, min(h, 2), 4] }",
         "camera { projection: \"perspective\", eye: [1, 2, 3] }"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const KrsCamera before = camera_in(cases[i][0]);
        KrsCamera       camera = before;
        memcpy(camera.eye, (double[]){1, 2, 3}, sizeof camera.eye);
        char *edited = camera_text_edit(cases[i][0], &before, &camera);
        assert_non_null(edited);
        assert_string_equal(edited, cases[i][1]);
        const KrsCamera after = camera_in(edited);
        assert_camera(&after, &camera);
        free(edited);
        edited = camera_text_edit(cases[i][0], &before, &before);
        assert_string_equal(edited, cases[i][0]);
        free(edited);
    }
    assert_null(camera_text_edit("light { eye: [1, 2, 3] }", &start, &start));
    assert_null(camera_text_edit("camera { eye: [1, 2, 3] ", &start, &start));
}

/* ---- random cameras ---- */

static double any(Random *random) { return random_between(random, -9, 9); }

static KrsCamera random_camera(Random *random)
{
    KrsCamera camera = start;
    for (int i = 0; i < 3; i++) {
        camera.eye[i]    = any(random);
        camera.target[i] = any(random) + 20;
        camera.up[i]     = random_below(random, 2) ? start.up[i] : any(random);
    }
    camera.up[1]      = 1;
    camera.projection = (KrsProjection)random_below(random, 3);
    camera.fov        = random_between(random, 0.1, 2);
    camera.height     = random_between(random, 0.1, 9);
    if (camera.projection == KRS_PANORAMA)
        return camera;
    if (random_below(random, 2)) {
        camera.aperture = random_between(random, 0.01, 1);
        camera.focus    = random_below(random, 2) ? random_between(random, 0.1, 9) : 0;
        camera.blades   = (uint32_t)random_below(random, 2) * 6;
        camera.shift[0] = random_between(random, 0.1, 0.4);
    }
    if (random_below(random, 2))
        camera.shutter[1] = 0.5;
    if (random_below(random, 2))
        camera.eyes = 0.125;
    return camera;
}

/* Commas of comments are no commas of the block. */
static void comments_stay_where_a_property_goes(void **state)
{
    (void)state;
    const char *block  = "camera { eye: [4, 3, 6] /* a, b */, // near, and low\n"
                         "    shift: [0.1, 0.2] // wide, too\n}";
    KrsCamera   before = camera_in(block), camera = before;
    camera.shift[0] = camera.shift[1] = 0;
    char *edited                      = camera_text_edit(block, &before, &camera);
    assert_non_null(edited);
    const KrsCamera after = camera_in(edited);
    assert_camera(&after, &camera);
    assert_null(strstr(edited, "shift"));
    assert_non_null(strstr(edited, "/* a, b */"));
    assert_non_null(strstr(edited, "// near, and low\n"));
    assert_non_null(strstr(edited, "// wide, too\n}"));
    free(edited);
}

/* A block is edited from camera to camera, with everything added and removed on the way. */
static void any_camera_follows_any_other(void **state)
{
    (void)state;
    Random random = {7};
    char  *block  = strdup("camera one { /* { */ eye: [4, 3, 6] /* , */ }");
    for (int i = 0; i < 80; i++) {
        const KrsCamera before = camera_in(block), camera = random_camera(&random);
        char           *edited = camera_text_edit(block, &before, &camera);
        assert_non_null(edited);
        const KrsCamera after = camera_in(edited);
        assert_camera(&after, &camera);
        assert_non_null(strstr(edited, "camera one { /* { */ eye: ["));
        free(block);
        block                   = edited;
        char           *own     = camera_text(&camera);
        const KrsCamera written = camera_in(own);
        assert_camera(&written, &camera);
        free(own);
    }
    free(block);
}

/* ---- files ---- */

static void assert_written(const char *before, size_t index, KrsStatus status, const char *after)
{
    char      path[] = "/tmp/krs-camera-XXXXXX";
    const int fd     = mkstemp(path);
    Bytes     bytes;
    KrsScene *scene;
    assert_true(fd >= 0);
    close(fd);
    assert_true(text_file_write(path, &(Bytes){(char *)before, strlen(before)}));
    assert_int_equal(krs_compile_file(path, NULL, &scene), KRS_OK);
    KrsCamera was, camera;
    KrsState *state;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_camera(state, index, &was), KRS_OK);
    camera = was;
    memcpy(camera.eye, (double[]){1, 2, 3}, sizeof camera.eye);
    assert_int_equal(camera_text_write(scene, index, &was, &camera, path), status);
    assert_true(text_file_read(path, &bytes));
    assert_int_equal(bytes.length, strlen(after));
    assert_memory_equal(bytes.text, after, bytes.length);
    free(bytes.text);
    krs_state_free(state);
    krs_scene_free(scene);
    remove(path);
}

static void the_rest_of_the_file_stays(void **state)
{
    (void)state;
    assert_written(
        "// \xc3\xa4\nshow sphere(1);camera a { target: [0, 0, 1] }\n\tcamera b{eye:[5, 5, 5]}show "
        "box([1, 1, 1]) ;",
        1, KRS_OK,
        "// \xc3\xa4\nshow sphere(1);camera a { target: [0, 0, 1] }\n\tcamera b{eye:[1, 2, 3]}show "
        "box([1, 1, 1]) ;");
}

static void a_scene_without_a_camera_gets_one(void **state)
{
    (void)state;
    const char *text   = "show sphere(1); // the end";
    KrsScene   *scene  = compile(text);
    KrsCamera   camera = camera_of(scene);
    char        after[500];
    KrsLocation place;
    assert_int_equal(krs_camera_location(scene, 0, &place), KRS_BAD_ARGUMENT);
    memcpy(camera.eye, (double[]){1, 2, 3}, sizeof camera.eye);
    char *block = camera_text(&camera);
    snprintf(after, sizeof after, "%s\n%s", text, block);
    assert_written(text, 0, KRS_OK, after);
    free(block);
    krs_scene_free(scene);
}

/* A file that was changed since is not touched. */
static void other_texts_are_left_alone(void **state)
{
    (void)state;
    const char *first = "show sphere(1); camera { eye: [0, 0, 5] }",
               *then  = "// none\nshow sphere(1);";
    char      path[]  = "/tmp/krs-camera-XXXXXX";
    const int fd      = mkstemp(path);
    Bytes     bytes;
    KrsScene *scene;
    assert_true(fd >= 0);
    close(fd);
    assert_true(text_file_write(path, &(Bytes){(char *)first, strlen(first)}));
    assert_int_equal(krs_compile_file(path, NULL, &scene), KRS_OK);
    assert_true(text_file_write(path, &(Bytes){(char *)then, strlen(then)}));
    const KrsCamera camera = camera_of(scene);
    assert_int_equal(camera_text_write(scene, 0, &start, &camera, path), KRS_BAD_ARGUMENT);
    assert_true(text_file_read(path, &bytes));
    assert_memory_equal(bytes.text, then, strlen(then));
    free(bytes.text);
    krs_scene_free(scene);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_the_same_stays),
        cmocka_unit_test(comments_stay_where_a_property_goes),
        cmocka_unit_test(any_camera_follows_any_other),
        cmocka_unit_test(the_rest_of_the_file_stays),
        cmocka_unit_test(a_scene_without_a_camera_gets_one),
        cmocka_unit_test(other_texts_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
