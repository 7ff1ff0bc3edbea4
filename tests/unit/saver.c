/*
 * saver.c: pictures that are saved while something else is shown are those of krs_render, for each
 * frame of a turn and of a range of time.
 */
#include <dirent.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "compiler/image/image.h"
#include "live/pictures/saver.h"
#include "live/text/text_file.h"
#include "tests/support/device.h"
#include "tests/support/folder.h"
#include "tests/support/renderer.h"

enum { WIDTH = 40, HEIGHT = 30, SAMPLES = 2, BYTES = 3 * WIDTH * HEIGHT };

static const char scene_text[] = "param r = 1 in [0.5, 2]; show box([1, r, 2]).move([0, time, 0]);"
                                 "camera { eye: [3, 1 + time, 5], target: [0, 0, 0] }";

static struct {
    Document     *document;
    Saver        *saver;
    SaveOrder     order;
    KrsRendering *rendering;
    KrsState     *state;
} stage;

static void nothing_is_told(void *user) { (void)user; }

static int set_up(void **context)
{
    static double            values[1][4] = {{1.5}};
    const KrsRendererOptions with         = {.device = tested_device()};
    const KrsOptions         options      = {0};
    View                    *view         = &stage.order.view;
    if (renderer_open(context) != 0 || enter_folder(context) != 0)
        return -1;
    FILE *file = fopen("scene.krs", "w");
    fputs(scene_text, file);
    fclose(file);
    stage.document = document_new("scene.krs", &options);
    if (document_read(stage.document) != KRS_OK)
        return -1;
    view->version         = document_version(stage.document);
    view->values          = values;
    view->width           = WIDTH;
    view->height          = HEIGHT;
    view->samples         = SAMPLES;
    view->time            = 0.25;
    view->integrator      = KRS_INTEGRATOR_PREVIEW;
    const KrsScene *scene = version_scene(view->version);
    krs_state_new(scene, &stage.state);
    krs_state_set(stage.state, "r", values[0], 1);
    krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &stage.rendering);
    krs_state_set_time(stage.state, view->time);
    krs_state_camera(stage.state, 0, &view->camera);
    stage.saver = saver_new(&with, nothing_is_told, NULL);
    return 0;
}

static int tear_down(void **context)
{
    saver_free(stage.saver);
    krs_rendering_free(stage.rendering);
    krs_state_free(stage.state);
    version_release(stage.order.view.version);
    document_free(stage.document);
    return leave_folder(context) + renderer_close(context);
}

static void order(SaveKind kind, uint32_t frames, bool exr, const char *name)
{
    stage.order.kind   = kind;
    stage.order.frames = frames;
    stage.order.fps    = 4;
    stage.order.exr    = exr;
    snprintf(stage.order.name, sizeof stage.order.name, "%s", name);
    assert_true(saver_start(stage.saver, &stage.order));
}

static SaverState wait_for_it(void)
{
    SaverState state = saver_state(stage.saver);
    for (int i = 0; i < 6000 && state.busy; i++) {
        usleep(10000);
        state = saver_state(stage.saver);
    }
    assert_false(state.busy);
    return state;
}

/* Returns what krs_render's machinery makes of a camera and a time. */
static KrsPicture *render(const KrsCamera *camera, double time)
{
    const KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = SAMPLES};
    KrsFilm               *film;
    KrsPicture            *picture;
    KrsCamera              own;
    assert_int_equal(krs_state_set_time(stage.state, time), KRS_OK);
    assert_int_equal(krs_state_camera(stage.state, 0, &own), KRS_OK);
    assert_int_equal(krs_film_new(stage.rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add(film, stage.state, camera ? camera : &own, SAMPLES), KRS_OK);
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    krs_film_free(film);
    return picture;
}

static void assert_png(const char *name, const KrsCamera *camera, double time)
{
    uint8_t     saved[BYTES], meant[BYTES];
    png_image   image   = {.version = PNG_IMAGE_VERSION};
    KrsPicture *picture = render(camera, time);
    if (!png_image_begin_read_from_file(&image, name))
        fail_msg("%s: %s", name, image.message);
    image.format = PNG_FORMAT_RGB;
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_true(png_image_finish_read(&image, NULL, saved, 0, NULL));
    krs_picture_to_srgb8(picture, version_scene(stage.order.view.version), 0, 3, meant);
    assert_memory_equal(saved, meant, BYTES);
    krs_picture_free(picture);
}

static void a_picture_is_saved(void **context)
{
    (void)context;
    order(SAVE_PICTURE, 9, false, "one");
    assert_int_equal(wait_for_it().status, KRS_OK);
    assert_png("one.png", &stage.order.view.camera, stage.order.view.time);
}

static void light_is_saved_as_numbers(void **context)
{
    (void)context;
    Memory      memory = {0};
    Arena       arena  = {.memory = &memory};
    Bytes       bytes;
    KrsPicture *picture = render(&stage.order.view.camera, stage.order.view.time);
    order(SAVE_PICTURE, 1, true, "one");
    assert_int_equal(wait_for_it().status, KRS_OK);
    assert_true(text_file_read("one.exr", &bytes));
    Image image = {.arena = &arena, .max_side = 100, .max_pixels = 10000};
    assert_true(image_read(&image, (const unsigned char *)bytes.text, bytes.length));
    for (size_t i = 0; i < 4 * (size_t)WIDTH * HEIGHT; i++)
        assert_true(fabsf(image.samples[i] - picture->color[i]) <=
                    1e-3f * (1e-3f + picture->color[i]));
    arena_free(&arena);
    free(bytes.text);
    krs_picture_free(picture);
}

/* Quarters of a turn around the target, as their definition has them. */
static void turns_go_around(void **context)
{
    (void)context;
    KrsCamera camera = stage.order.view.camera;
    order(SAVE_TURNTABLE, 4, false, "turn");
    assert_int_equal(wait_for_it().status, KRS_OK);
    assert_png("turn-0000.png", &camera, stage.order.view.time);
    const double x = camera.eye[0] - camera.target[0], z = camera.eye[2] - camera.target[2];
    camera.eye[0] = camera.target[0] - x;
    camera.eye[2] = camera.target[2] - z;
    assert_png("turn-0002.png", &camera, stage.order.view.time);
}

static void time_goes_on(void **context)
{
    (void)context;
    order(SAVE_TIME, 3, false, "time"); /* by the scene's camera, which moves */
    assert_int_equal(wait_for_it().status, KRS_OK);
    assert_png("time-0001.png", NULL, 0.5);
    assert_png("time-0002.png", NULL, 0.75);
    stage.order.camera = -1; /* by the view's, which does not */
    order(SAVE_TIME, 2, false, "still");
    assert_int_equal(wait_for_it().status, KRS_OK);
    assert_png("still-0001.png", &stage.order.view.camera, 0.5);
}

static size_t count_files(const char *part)
{
    DIR   *here  = opendir(".");
    size_t count = 0;
    for (struct dirent *entry; (entry = readdir(here));)
        count += strstr(entry->d_name, part) != NULL;
    closedir(here);
    return count;
}

static void what_is_given_up_leaves_nothing(void **context)
{
    (void)context;
    stage.order.view.samples = 60000;
    stage.order.view.width   = 1600;
    order(SAVE_PICTURE, 1, false, "huge");
    assert_false(saver_start(stage.saver, &stage.order)); /* one at a time */
    usleep(200000);
    saver_cancel(stage.saver);
    assert_int_equal(wait_for_it().status, KRS_INTERRUPTED);
    assert_int_equal(count_files("huge"), 0);
    stage.order.view.samples = SAMPLES;
    stage.order.view.width   = WIDTH;
    snprintf(stage.order.name, sizeof stage.order.name, "none/one");
    assert_true(saver_start(stage.saver, &stage.order));
    const SaverState state_after = wait_for_it();
    assert_int_equal(state_after.status, KRS_CANNOT_CREATE);
    assert_non_null(strstr(state_after.message, "none/one.png"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_is_saved),
        cmocka_unit_test(light_is_saved_as_numbers),
        cmocka_unit_test(turns_go_around),
        cmocka_unit_test(time_goes_on),
        cmocka_unit_test(what_is_given_up_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
