/*
 * painter.c: pictures of a scene whose text changes: what needs other shaders waits for them, while
 * what there was can still be turned.  Each picture is what krs_render makes of the same.
 */
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

#include "live/pictures/painter.h"
#include "tests/support/device.h"
#include "tests/support/renderer.h"

enum { WIDTH = 64, HEIGHT = 48, BYTES = 4 * WIDTH * HEIGHT, TIMEOUT = 60 };

static const char one_ball[]  = "param r = 1 in [0.5, 2]; show sphere(r);";
static const char two_boxes[] = "param r = 1 in [0.5, 2]; show union([box([r, 2, 1]), box([3, 0.5, "
                                "r])], blend: 0.2).rotate([0, 1, 0], 20deg);";
/* Its shaders take long. */
static const char many_solids[] =
    "param r = 1 in [0.5, 2];\n"
    "show union([box([r, 2, 1]), torus(r, 0.2), cone(0.5, r).move([1, 0, 0]), cylinder(0.3, "
    "r).move([-1, 0, 0]),\n"
    "            capsule([0, 0, 0], [r, 1, 0], 0.2), ellipsoid([r, 0.4, 0.3]).twist([0, 1, 0], "
    "0.5)], blend: 0.2)\n"
    "    .rotate([0, 1, 0], 20deg);\n"
    "show (sphere(r) & box([r, 1, 1]).bend([0, 0, 1], 0.2)).move([0, 2, 0]);\n";

typedef struct Stage {
    char      path[32];
    Document *document;
    Painter  *painter;
    View      view;
    Version  *version;
} Stage;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* The next text, as if it were saved. */
static void edit(Stage *stage, const char *text)
{
    FILE *file = fopen(stage->path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    assert_int_equal(document_read(stage->document), KRS_OK);
    version_release(stage->view.version);
    stage->view.version = document_version(stage->document);
}

static unsigned show(Stage *stage, double aside)
{
    stage->view.camera.eye[0] = aside;
    return painter_show(stage->painter, &stage->view);
}

static void set_up_with(Stage *stage, const char *text, KrsSpecialize specialize)
{
    static double    values[1][4]; /* the defaults of both texts */
    const KrsOptions with      = {.specialize = specialize};
    *stage                     = (Stage){.path = "/tmp/krs-painter-XXXXXX"};
    const int            fd    = mkstemp(stage->path);
    const PainterOptions paint = {.renderer = {.device = tested_device()}, .budget = 40};
    assert_true(fd >= 0);
    close(fd);
    values[0][0]       = 1;
    stage->document    = document_new(stage->path, &with);
    stage->painter     = painter_new(&paint);
    stage->view.values = values;
    stage->view.camera = (KrsCamera){
        .projection = KRS_PERSPECTIVE, .eye = {0, 1, 5}, .up = {0, 1, 0}, .fov = 0.8};
    stage->view.width      = WIDTH;
    stage->view.height     = HEIGHT;
    stage->view.samples    = 1;
    stage->view.integrator = KRS_INTEGRATOR_PREVIEW;
    assert_non_null(stage->painter);
    edit(stage, text);
    show(stage, 0);
}

static void set_up(Stage *stage, const char *text)
{
    set_up_with(stage, text, KRS_SPECIALIZE_STRUCTURE);
}

static void tear_down(Stage *stage)
{
    painter_free(stage->painter);
    version_release(stage->view.version);
    document_free(stage->document);
    remove(stage->path);
}

/* The next picture with all pixels, of one of these versions, of this view or a later one. */
static Shot take_one_of(Stage *stage, unsigned first, unsigned last, unsigned view)
{
    for (const double begun = now(); now() - begun < TIMEOUT; usleep(2000)) {
        Shot shot;
        if (painter_state(stage->painter).status != KRS_OK)
            fail_msg("%s", painter_state(stage->painter).message);
        if (!painter_take(stage->painter, &shot))
            continue;
        if (shot.whole && shot.version >= first && shot.version <= last && shot.view >= view)
            return shot;
        free(shot.pixels);
    }
    fail_msg("there is no picture");
    return (Shot){0};
}

static Shot take_whole(Stage *stage, unsigned version, unsigned view)
{
    return take_one_of(stage, version, version, view);
}

/* What krs_render makes of a text, from the view's camera. */
static uint8_t *render(const Stage *stage, const char *text, double r)
{
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT};
    const KrsOptions with    = {.specialize = KRS_SPECIALIZE_STRUCTURE};
    uint8_t         *pixels  = malloc(BYTES);
    KrsScene        *scene;
    KrsFrame        *frame;
    KrsRendering    *rendering;
    KrsFilm         *film;
    KrsPicture      *picture;
    assert_int_equal(krs_compile_text(text, strlen(text), "a", &with, &scene), KRS_OK);
    assert_int_equal(krs_frame_new(scene, &frame), KRS_OK);
    assert_int_equal(krs_frame_set(frame, "r", &r, 1), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, &rendering), KRS_OK);
    assert_int_equal(krs_film_new(rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add(film, frame, &stage->view.camera, 1), KRS_OK);
    assert_int_equal(krs_film_read(film, KRS_PLANE_COLOR, &picture), KRS_OK);
    assert_int_equal(krs_picture_to_srgb8(picture, scene, 0, 4, pixels), KRS_OK);
    krs_picture_free(picture);
    krs_film_free(film);
    krs_rendering_free(rendering);
    krs_frame_free(frame);
    krs_scene_free(scene);
    return pixels;
}

/* Returns how many kernels the device has made that shows it. */
static uint64_t assert_shows(Stage *stage, unsigned version, unsigned view, const char *text,
                             double r)
{
    const Shot shown = take_whole(stage, version, view);
    uint8_t   *meant = render(stage, text, r);
    assert_memory_equal(shown.pixels, meant, BYTES);
    free(shown.pixels);
    free(meant);
    return shown.stats.kernels;
}

/* How many views are shown before shaders are ready is for the machine to say, but the first is. */
static void what_there_was_is_turned_meanwhile(void **state)
{
    enum { VIEWS = 3 };
    (void)state;
    Stage    stage;
    uint8_t *turned[VIEWS];
    int      shown = 0;
    set_up(&stage, one_ball);
    assert_shows(&stage, 1, 1, one_ball, 1);
    for (int i = 0; i < VIEWS; i++) { /* before the processor is busy */
        stage.view.camera.eye[0] = i;
        turned[i]                = render(&stage, one_ball, 1);
    }
    edit(&stage, many_solids);
    for (bool ready = false; !ready && shown < VIEWS;) {
        const unsigned view = show(&stage, shown);
        const Shot     shot = take_one_of(&stage, 1, 2, view);
        ready               = shot.version == 2;
        if (!ready)
            assert_memory_equal(shot.pixels, turned[shown++], BYTES);
        free(shot.pixels);
    }
    assert_true(shown > 0);
    for (int i = 0; i < VIEWS; i++)
        free(turned[i]);
    assert_shows(&stage, 2, 0, many_solids, 1);
    assert_false(painter_state(stage.painter).compiling);
    tear_down(&stage);
}

/* Numbers need no shaders, and neither does what was there before. */
static void nothing_is_compiled_twice(void **state)
{
    (void)state;
    Stage stage;
    set_up(&stage, one_ball);
    const uint64_t kernels = assert_shows(&stage, 1, 1, one_ball, 1);
    edit(&stage, two_boxes);
    unsigned view = show(&stage, 1);
    assert_shows(&stage, 2, view, two_boxes, 1);
    edit(&stage, one_ball);
    view = show(&stage, 1);
    assert_int_equal(assert_shows(&stage, 3, view, one_ball, 1), kernels);
    edit(&stage, "param r = 1.5 in [0.5, 2]; show sphere(r);");
    stage.view.values[0][0] = 1.5;
    view                    = show(&stage, 1);
    assert_false(painter_state(stage.painter).compiling);
    assert_shows(&stage, 4, view, one_ball, 1.5);
    tear_down(&stage);
}

/* Compiles what the first edit will need, as the viewer does when nothing else happens. */
static void prepare_edits(Stage *stage)
{
    View later = stage->view;
    document_changed(stage->document); /* it was read already */
    document_prepare(stage->document);
    later.version = document_spare(stage->document);
    assert_non_null(later.version);
    for (const double begun = now(); !painter_prepare(stage->painter, &later); usleep(5000)) {
        assert_false(painter_state(stage->painter).compiling);
        assert_true(now() - begun < TIMEOUT);
    }
    version_release(later.version);
}

/* Shaders of the first version have its numbers in their text, those of its edits have not. */
static void the_first_edit_can_be_prepared(void **state)
{
    (void)state;
    for (int prepared = 0; prepared < 2; prepared++) {
        Stage stage;
        set_up_with(&stage, "param r = 1 in [0.5, 2]; show sphere(1.1 * r);", KRS_SPECIALIZE_AUTO);
        free(take_whole(&stage, 1, 1).pixels);
        if (prepared)
            prepare_edits(&stage);
        edit(&stage, "param r = 1 in [0.5, 2]; show sphere(1.25 * r);");
        assert_int_equal(version_number(stage.view.version), 2);
        const unsigned view     = show(&stage, 1);
        bool           compiled = false;
        Shot           shot     = {0};
        for (const double begun = now(); shot.version != 2 && now() - begun < TIMEOUT;) {
            compiled = painter_state(stage.painter).compiling || compiled;
            free(shot.pixels);
            shot = (Shot){0};
            if (!painter_take(stage.painter, &shot))
                usleep(500);
        }
        free(shot.pixels);
        assert_int_equal(compiled, !prepared);
        edit(&stage, "param r = 1 in [0.5, 2]; show sphere(1.5 * r);");
        assert_true(show(&stage, 1) > view);
        assert_shows(&stage, 3, view + 1, "param r = 1; show sphere(1.5 * r);", 1);
        tear_down(&stage);
    }
}

/* Of edits that follow each other quickly the last is shown, and the others are given up. */
static void edits_overtake_each_other(void **state)
{
    (void)state;
    Stage    stage;
    unsigned view = 0;
    set_up(&stage, one_ball);
    for (int i = 0; i < 6; i++) {
        edit(&stage,
             i % 2 ? "show cylinder(1, 2); param r = 1;" : "show torus(1, 0.5); param r = 1;");
        view = show(&stage, 1);
        usleep(50000);
    }
    edit(&stage, two_boxes);
    view = show(&stage, 1);
    assert_shows(&stage, 8, view, two_boxes, 1);
    assert_string_equal(painter_state(stage.painter).unbuilt, "");
    tear_down(&stage);
}

static bool is_hot(const uint8_t *pixel) { return pixel[0] > 245 && pixel[1] > 225; }

/* A picture with this pixel hot.  Until there are shaders for slopes, light is shown. */
static void await_hot(Stage *stage, unsigned version, unsigned view, size_t pixel)
{
    bool hot = false;
    for (const double begun = now(); !hot && now() - begun < TIMEOUT;) {
        Shot shot = take_whole(stage, version, view);
        hot       = is_hot(shot.pixels + pixel);
        free(shot.pixels);
    }
    assert_true(hot);
}

/* A ball uses all of its slope, a twisted bar only where it is thickest. */
static void slopes_that_are_not_used_are_seen(void **state)
{
    (void)state;
    Stage        stage;
    const size_t middle = 4 * ((size_t)HEIGHT / 2 * WIDTH + WIDTH / 2);
    set_up(&stage, one_ball);
    stage.view.look = LOOK_SLOPE;
    await_hot(&stage, 1, show(&stage, 0), middle);
    edit(&stage, "show box([2, 4, 0.2]).twist([0, 1, 0], 60deg);param r = 1;");
    Shot shot = take_whole(&stage, 2, show(&stage, 0));
    assert_true(shot.pixels[middle + 1] < 200);
    free(shot.pixels);
    tear_down(&stage);
}

/* A device that does not answer is lost: that is said, and nobody waits for it. */
static void lost_devices_are_said(void **state)
{
    (void)state;
    Stage                stage;
    const PainterOptions options = {.renderer = {.device = tested_device(), .patience = 1e-9},
                                    .budget   = 40};
    set_up(&stage, one_ball);
    painter_free(stage.painter);
    stage.painter    = painter_new(&options);
    PainterState now = {.status = KRS_OK};
    show(&stage, 0);
    for (int i = 0; i < 6000 && now.status == KRS_OK; i++) {
        usleep(10000);
        now = painter_state(stage.painter);
    }
    assert_int_equal(now.status, KRS_INTERNAL);
    assert_non_null(strstr(now.message, "the device has not finished"));
    show(&stage, 1);
    tear_down(&stage);
}

static void the_end_does_not_wait_for_shaders_that_nobody_sees(void **state)
{
    (void)state;
    Stage stage;
    set_up(&stage, two_boxes);
    tear_down(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_there_was_is_turned_meanwhile),
        cmocka_unit_test(nothing_is_compiled_twice),
        cmocka_unit_test(the_first_edit_can_be_prepared),
        cmocka_unit_test(edits_overtake_each_other),
        cmocka_unit_test(slopes_that_are_not_used_are_seen),
        cmocka_unit_test(lost_devices_are_said),
        cmocka_unit_test(the_end_does_not_wait_for_shaders_that_nobody_sees),
    };
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
