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

typedef struct Fixture {
    char      path[32];
    Document *document;
    Painter  *painter;
    View      view;
    Version  *version;
} Fixture;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Edits the next text, as if it were saved. */
static void edit(Fixture *fixture, const char *text)
{
    FILE *file = fopen(fixture->path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    assert_int_equal(document_read(fixture->document), KRS_OK);
    version_release(fixture->view.version);
    fixture->view.version = document_version(fixture->document);
}

static unsigned show(Fixture *fixture, double aside)
{
    fixture->view.camera.eye[0] = aside;
    return painter_show(fixture->painter, &fixture->view);
}

static void set_up_with(Fixture *fixture, const char *text, KrsSpecialize specialize,
                        KrsExecutor executor)
{
    static double    values[1][4]; /* the defaults of both texts */
    const KrsOptions with      = {.specialize = specialize};
    *fixture                   = (Fixture){.path = "/tmp/krs-painter-XXXXXX"};
    const int            fd    = mkstemp(fixture->path);
    const PainterOptions paint = {
        .renderer = {.device = tested_device()}, .budget = 40, .executor = executor};
    assert_true(fd >= 0);
    close(fd);
    values[0][0]         = 1;
    fixture->document    = document_new(fixture->path, &with);
    fixture->painter     = painter_new(&paint);
    fixture->view.values = values;
    fixture->view.camera = (KrsCamera){
        .projection = KRS_PERSPECTIVE, .eye = {0, 1, 5}, .up = {0, 1, 0}, .fov = 0.8};
    fixture->view.width      = WIDTH;
    fixture->view.height     = HEIGHT;
    fixture->view.samples    = 1;
    fixture->view.integrator = KRS_INTEGRATOR_PREVIEW;
    assert_non_null(fixture->painter);
    edit(fixture, text);
    show(fixture, 0);
}

static void set_up(Fixture *fixture, const char *text)
{
    set_up_with(fixture, text, KRS_SPECIALIZE_STRUCTURE, KRS_EXECUTOR_KERNELS);
}

static void tear_down(Fixture *fixture)
{
    painter_free(fixture->painter);
    version_release(fixture->view.version);
    document_free(fixture->document);
    remove(fixture->path);
}

/* Returns the next picture with all pixels, of one of these versions, of this view or a later one. */
static Shot take_one_of(Fixture *fixture, unsigned first, unsigned last, unsigned view)
{
    for (const double begun = now(); now() - begun < TIMEOUT; usleep(2000)) {
        Shot shot;
        if (painter_state(fixture->painter).status != KRS_OK)
            fail_msg("%s", painter_state(fixture->painter).message);
        if (!painter_take(fixture->painter, &shot))
            continue;
        if (shot.whole && shot.version >= first && shot.version <= last && shot.view >= view)
            return shot;
        free(shot.pixels);
    }
    fail_msg("there is no picture");
    return (Shot){0};
}

static Shot take_whole(Fixture *fixture, unsigned version, unsigned view)
{
    return take_one_of(fixture, version, version, view);
}

/* What krs_render makes of a text, from the view's camera. */
static uint8_t *render(const Fixture *fixture, const char *text, double r)
{
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT};
    const KrsOptions with    = {.specialize = KRS_SPECIALIZE_STRUCTURE};
    uint8_t         *pixels  = malloc(BYTES);
    KrsScene        *scene;
    KrsState        *state;
    KrsRendering    *rendering;
    KrsFilm         *film;
    KrsPicture      *picture;
    assert_int_equal(krs_compile_text(text, strlen(text), "a", &with, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_set(state, "r", &r, 1), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_film_new(rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add(film, state, &fixture->view.camera, 1), KRS_OK);
    assert_int_equal(krs_film_read(film, KRS_AOV_COLOR, &picture), KRS_OK);
    assert_int_equal(krs_picture_to_srgb8(picture, scene, 0, 4, pixels), KRS_OK);
    krs_picture_free(picture);
    krs_film_free(film);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
    return pixels;
}

/* Returns how many shaders the device has made that shows it. */
static uint64_t assert_shows(Fixture *fixture, unsigned version, unsigned view, const char *text,
                             double r)
{
    const Shot shown = take_whole(fixture, version, view);
    uint8_t   *meant = render(fixture, text, r);
    assert_memory_equal(shown.pixels, meant, BYTES);
    free(shown.pixels);
    free(meant);
    return shown.stats.shaders;
}

/* Waits until nothing is compiled, and what is shown is complete. */
static void await_rest(Fixture *fixture)
{
    PainterState state = {.busy = true};
    for (const double begun = now(); state.busy || state.compiling; usleep(2000)) {
        state = painter_state(fixture->painter);
        assert_true(now() - begun < TIMEOUT);
    }
}

/* How many views are shown before shaders are ready is for the machine to say, but the first is. */
static void what_there_was_is_turned_meanwhile(void **state)
{
    enum { VIEWS = 3 };
    (void)state;
    Fixture  fixture;
    uint8_t *turned[VIEWS];
    int      shown = 0;
    set_up(&fixture, one_ball);
    assert_shows(&fixture, 1, 1, one_ball, 1);
    for (int i = 0; i < VIEWS; i++) { /* before the processor is busy */
        fixture.view.camera.eye[0] = i;
        turned[i]                  = render(&fixture, one_ball, 1);
    }
    bool ready = false;
    edit(&fixture, many_solids);
    while (!ready && shown < VIEWS) {
        const unsigned view = show(&fixture, shown);
        const Shot     shot = take_one_of(&fixture, 1, 2, view);
        ready               = shot.version == 2;
        if (!ready)
            assert_memory_equal(shot.pixels, turned[shown++], BYTES);
        free(shot.pixels);
    }
    assert_true(shown > 0);
    for (int i = 0; i < VIEWS; i++)
        free(turned[i]);
    /* Without another view, unless there is a picture already. */
    assert_shows(&fixture, 2, ready ? show(&fixture, VIEWS) : 0, many_solids, 1);
    assert_false(painter_state(fixture.painter).compiling);
    tear_down(&fixture);
}

/* Numbers need no shaders, and neither does what was there before. */
static void nothing_is_compiled_twice(void **state)
{
    (void)state;
    Fixture fixture;
    set_up(&fixture, one_ball);
    const uint64_t shaders = assert_shows(&fixture, 1, 1, one_ball, 1);
    edit(&fixture, two_boxes);
    unsigned view = show(&fixture, 1);
    assert_shows(&fixture, 2, view, two_boxes, 1);
    edit(&fixture, one_ball);
    view = show(&fixture, 1);
    assert_int_equal(assert_shows(&fixture, 3, view, one_ball, 1), shaders);
    edit(&fixture, "param r = 1.5 in [0.5, 2]; show sphere(r);");
    fixture.view.values[0][0] = 1.5;
    view                      = show(&fixture, 1);
    assert_false(painter_state(fixture.painter).compiling);
    assert_shows(&fixture, 4, view, one_ball, 1.5);
    tear_down(&fixture);
}

/* Compiles what the first edit will need, as the viewer does when nothing else happens. */
static void prepare_edits(Fixture *fixture)
{
    View later = fixture->view;
    document_changed(fixture->document); /* it was read already */
    document_prepare(fixture->document);
    later.version = document_spare(fixture->document);
    assert_non_null(later.version);
    for (const double begun = now(); !painter_prepare(fixture->painter, &later); usleep(5000)) {
        assert_false(painter_state(fixture->painter).compiling);
        assert_true(now() - begun < TIMEOUT);
    }
    version_release(later.version);
}

/* Shaders of the first version have its numbers in their text, those of its edits have not. */
static void the_first_edit_can_be_prepared(void **state)
{
    (void)state;
    for (int prepared = 0; prepared < 2; prepared++) {
        Fixture fixture;
        set_up_with(&fixture, "param r = 1 in [0.5, 2]; show sphere(1.1 * r);", KRS_SPECIALIZE_AUTO,
                    KRS_EXECUTOR_KERNELS);
        free(take_whole(&fixture, 1, 1).pixels);
        if (prepared)
            prepare_edits(&fixture);
        edit(&fixture, "param r = 1 in [0.5, 2]; show sphere(1.25 * r);");
        assert_int_equal(version_number(fixture.view.version), 2);
        const unsigned view     = show(&fixture, 1);
        bool           compiled = false;
        Shot           shot     = {0};
        for (const double begun = now(); shot.version != 2 && now() - begun < TIMEOUT;) {
            compiled = painter_state(fixture.painter).compiling || compiled;
            free(shot.pixels);
            shot = (Shot){0};
            if (!painter_take(fixture.painter, &shot))
                usleep(500);
        }
        free(shot.pixels);
        assert_int_equal(compiled, !prepared);
        edit(&fixture, "param r = 1 in [0.5, 2]; show sphere(1.5 * r);");
        assert_true(show(&fixture, 1) > view);
        assert_shows(&fixture, 3, view + 1, "param r = 1; show sphere(1.5 * r);", 1);
        tear_down(&fixture);
    }
}

/* When edits follow each other quickly the last is shown, and the others are given up. */
static void edits_overtake_each_other(void **state)
{
    (void)state;
    Fixture  fixture;
    unsigned view = 0;
    set_up(&fixture, one_ball);
    for (int i = 0; i < 6; i++) {
        edit(&fixture,
             i % 2 ? "show cylinder(1, 2); param r = 1;" : "show torus(1, 0.5); param r = 1;");
        view = show(&fixture, 1);
        usleep(50000);
    }
    edit(&fixture, two_boxes);
    view = show(&fixture, 1);
    assert_shows(&fixture, 8, view, two_boxes, 1);
    assert_string_equal(painter_state(fixture.painter).unbuilt, "");
    tear_down(&fixture);
}

static bool is_hot(const uint8_t *pixel) { return pixel[0] > 245 && pixel[1] > 225; }

/* A picture with this pixel hot.  Until there are shaders for slopes, light is shown. */
static void await_hot(Fixture *fixture, unsigned version, unsigned view, size_t pixel)
{
    bool hot = false;
    for (const double begun = now(); !hot && now() - begun < TIMEOUT;) {
        Shot shot = take_whole(fixture, version, view);
        hot       = is_hot(shot.pixels + pixel);
        free(shot.pixels);
    }
    assert_true(hot);
}

/* A ball uses all of its slope, a twisted bar only where it is thickest. */
static void slopes_that_are_not_used_are_seen(void **state)
{
    (void)state;
    Fixture      fixture;
    const size_t middle = 4 * ((size_t)HEIGHT / 2 * WIDTH + WIDTH / 2);
    set_up(&fixture, one_ball);
    fixture.view.shading = SHADING_SLOPE;
    await_hot(&fixture, 1, show(&fixture, 0), middle);
    edit(&fixture, "show box([2, 4, 0.2]).twist([0, 1, 0], 60deg);param r = 1;");
    Shot shot = take_whole(&fixture, 2, show(&fixture, 0));
    assert_true(shot.pixels[middle + 1] < 200);
    free(shot.pixels);
    tear_down(&fixture);
}

/* ---- lanes ---- */

/* Bytes of a picture that may differ from the same by shaders, and how far others may. */
enum { MAX_OTHER_BYTES = BYTES / 100, MAX_DIFFERENCE = 3 };

static void assert_similar(const uint8_t *a, const uint8_t *b)
{
    size_t other = 0;
    for (size_t i = 0; i < BYTES; i++)
        other += abs(a[i] - b[i]) > MAX_DIFFERENCE;
    assert_in_range(other, 0, MAX_OTHER_BYTES);
}

/* The first picture of a version is by lanes, and looks as if it were by shaders. */
static void assert_lanes_show(Fixture *fixture, unsigned version, const char *text)
{
    Shot first = {0};
    for (const double begun = now(); first.version != version && now() - begun < TIMEOUT;) {
        free(first.pixels);
        first = (Shot){0};
        if (!painter_take(fixture->painter, &first))
            usleep(500);
    }
    assert_int_equal(first.version, version);
    assert_int_equal(first.stats.executor, KRS_EXECUTOR_LANES);
    const Shot whole = first.whole ? first : take_whole(fixture, version, first.view);
    uint8_t   *meant = render(fixture, text, 1);
    assert_similar(whole.pixels, meant);
    free(meant);
    if (!first.whole)
        free(first.pixels);
    free(whole.pixels);
}

/* Nobody waits for shaders, neither of what is opened nor of an edit.  When they are there other numbers are drawn by them. */
static void lanes_draw_until_there_are_shaders(void **state)
{
    (void)state;
    Fixture fixture;
    set_up_with(&fixture, many_solids, KRS_SPECIALIZE_STRUCTURE, KRS_EXECUTOR_DEFAULT);
    assert_lanes_show(&fixture, 1, many_solids);
    edit(&fixture, two_boxes);
    show(&fixture, 0);
    assert_lanes_show(&fixture, 2, two_boxes);
    await_rest(&fixture);
    fixture.view.values[0][0] = 1.5;
    const unsigned view       = show(&fixture, 0);
    const Shot     shot       = take_whole(&fixture, 2, view);
    uint8_t       *meant      = render(&fixture, two_boxes, 1.5);
    assert_int_equal(shot.stats.executor, KRS_EXECUTOR_KERNELS);
    assert_memory_equal(shot.pixels, meant, BYTES);
    free(shot.pixels);
    free(meant);
    tear_down(&fixture);
}

/* While shaders take over the picture has never fewer samples, nor fewer pixels, than it had. */
static void nobody_sees_who_draws(void **state)
{
    enum { MANY = 60000, LATER = 5 };
    (void)state;
    Fixture  fixture;
    uint32_t samples = 0, others = 0;
    bool     whole = false;
    set_up_with(&fixture, one_ball, KRS_SPECIALIZE_STRUCTURE, KRS_EXECUTOR_DEFAULT);
    fixture.view.samples = MANY;
    edit(&fixture, many_solids);
    const unsigned view = show(&fixture, 0);
    for (const double begun = now(); others < LATER; usleep(1000)) {
        Shot shot;
        assert_true(now() - begun < TIMEOUT);
        if (!painter_take(fixture.painter, &shot))
            continue;
        free(shot.pixels);
        if (shot.view != view)
            continue;
        assert_true(shot.whole || !whole);
        assert_true(shot.samples >= samples);
        whole   = shot.whole;
        samples = shot.whole ? shot.samples : 0;
        others += !painter_state(fixture.painter).compiling && shot.whole;
    }
    tear_down(&fixture);
}

/* Solids of which others are taken, no two of the same kinds: no shader is made of so many. */
static char *many_parts(void)
{
    enum { PARTS = 700, SOLIDS = 6, BYTES_OF_SOLID = 60 };
    static const char *const kinds[] = {"sphere(0.3)", "box([0.3, 0.4, 0.5])", "torus(0.3, 0.1)",
                                        "cylinder(0.2, 0.6)"};
    char                    *text    = malloc(100 + PARTS * SOLIDS * BYTES_OF_SOLID);
    size_t                   length  = 0;
    assert_non_null(text);
    length += (size_t)sprintf(text, "param r = 1 in [0.5, 2]; show union([");
    for (int i = 0; i < PARTS; i++)
        for (int k = 0; k < SOLIDS; k++)
            length += (size_t)sprintf(text + length, "%s%s.move([%d.%d, %d, 0.%d])",
                                      k > 0   ? " - "
                                      : i > 0 ? ", "
                                              : "",
                                      kinds[i >> 2 * k & 3], i % 25 - 12, k, i / 25 - 14, k);
    sprintf(text + length, "]).scale(0.1 * r);");
    return text;
}

static void what_is_too_large_for_shaders_is_drawn(void **state)
{
    (void)state;
    Fixture fixture;
    char   *text = many_parts();
    set_up_with(&fixture, text, KRS_SPECIALIZE_STRUCTURE, KRS_EXECUTOR_DEFAULT);
    assert_non_null(krs_scene_too_large(version_scene(fixture.view.version)));
    const Shot shot = take_whole(&fixture, 1, 1);
    assert_int_equal(shot.stats.executor, KRS_EXECUTOR_LANES);
    free(shot.pixels);
    await_rest(&fixture);
    assert_false(painter_state(fixture.painter).compiling);
    assert_string_equal(painter_state(fixture.painter).unbuilt, "");
    free(text);
    tear_down(&fixture);
}

/* What lanes refuse waits for shaders, and is seen then. */
static void what_lanes_refuse_waits_for_shaders(void **state)
{
    static const char glass[] =
        "param r = 1 in [0.5, 2]; material glass { transmission: 1, ior: 1.5 } show "
        "sphere(r).paint(glass);";
    (void)state;
    Fixture fixture;
    set_up_with(&fixture, one_ball, KRS_SPECIALIZE_STRUCTURE, KRS_EXECUTOR_DEFAULT);
    assert_lanes_show(&fixture, 1, one_ball);
    edit(&fixture, glass);
    assert_shows(&fixture, 2, show(&fixture, 0), glass, 1);
    assert_string_equal(painter_state(fixture.painter).unbuilt, "");
    tear_down(&fixture);
}

/* A device that does not answer is lost: that is said, and nobody waits for it. */
static void lost_devices_are_said(void **state)
{
    (void)state;
    Fixture              fixture;
    const PainterOptions options = {.renderer = {.device = tested_device(), .timeout = 1e-9},
                                    .budget   = 40}; /* lanes fail as well */
    set_up(&fixture, one_ball);
    painter_free(fixture.painter);
    fixture.painter  = painter_new(&options);
    PainterState now = {.status = KRS_OK};
    show(&fixture, 0);
    for (int i = 0; i < 6000 && now.status == KRS_OK; i++) {
        usleep(10000);
        now = painter_state(fixture.painter);
    }
    assert_int_equal(now.status, KRS_INTERNAL);
    assert_non_null(strstr(now.message, "the device has not finished"));
    show(&fixture, 1);
    tear_down(&fixture);
}

static void the_end_does_not_wait_for_shaders_that_nobody_sees(void **state)
{
    (void)state;
    Fixture fixture;
    set_up(&fixture, two_boxes);
    tear_down(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_there_was_is_turned_meanwhile),
        cmocka_unit_test(nothing_is_compiled_twice),
        cmocka_unit_test(the_first_edit_can_be_prepared),
        cmocka_unit_test(edits_overtake_each_other),
        cmocka_unit_test(slopes_that_are_not_used_are_seen),
        cmocka_unit_test(lanes_draw_until_there_are_shaders),
        cmocka_unit_test(nobody_sees_who_draws),
        cmocka_unit_test(what_is_too_large_for_shaders_is_drawn),
        cmocka_unit_test(what_lanes_refuse_waits_for_shaders),
        cmocka_unit_test(lost_devices_are_said),
        cmocka_unit_test(the_end_does_not_wait_for_shaders_that_nobody_sees),
    };
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
