/*
 * live.c: what the viewer does to cameras and texts, without a window.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>
#include <png.h>

#include "krs/camera.h"
#include "live/cut.h"
#include "live/history.h"
#include "live/pictures/false_color.h"
#include "live/text/document.h"
#include "live/text/presets.h"
#include "live/text/text_edit.h"

static const KrsCamera start = {.projection = KRS_PERSPECTIVE,
                                .eye        = {3, 2, 5},
                                .target     = {0.5, 0.25, -1},
                                .up         = {0, 1, 0},
                                .fov        = 0.7};

static double apart(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* Where a point is in the picture, in parts of its height from the center. */
static void project(const KrsCamera *camera, const double point[3], double out[2])
{
    double forward[3], right[3], up[3], x = 0, y = 0, z = 0;
    krs_camera_axes(camera, forward, right, up);
    for (int i = 0; i < 3; i++) {
        const double d = point[i] - camera->eye[i];
        x += d * right[i];
        y += d * up[i];
        z += d * forward[i];
    }
    const double height = camera->projection == KRS_PERSPECTIVE ? 2 * z * tan(camera->fov / 2)
                                                                : camera->height;
    out[0]              = x / height;
    out[1]              = y / height;
}

static void turns_keep_the_target(void **state)
{
    (void)state;
    KrsCamera camera = start;
    for (int i = 0; i < 200; i++) {
        double forward[3], right[3], up[3];
        krs_camera_orbit(&camera, 0.3 * sin(i), 0.5 * cos(0.7 * i));
        krs_camera_axes(&camera, forward, right, up);
        assert_true(fabs(apart(camera.eye, camera.target) - apart(start.eye, start.target)) < 1e-9);
        assert_true(fabs(right[1]) < 1e-9 && up[1] > 0); /* upright */
    }
    assert_memory_equal(camera.target, start.target, sizeof camera.target);
}

static void what_is_grabbed_stays_under_the_mouse(void **state)
{
    (void)state;
    const double point[3] = {1, 0.5, 0.75};
    double       before[2], after[2];
    KrsCamera    camera = start;
    project(&camera, start.target, before);
    krs_camera_pan(&camera, 0.25, -0.125);
    project(&camera, start.target, after);
    assert_true(fabs(after[0] - before[0] - 0.25) < 1e-9);
    assert_true(fabs(after[1] - before[1] + 0.125) < 1e-9);
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        if (orthographic)
            krs_camera_toggle_perspective(&camera);
        project(&camera, point, before);
        krs_camera_dolly(&camera, point, 0.6);
        project(&camera, point, after);
        assert_true(fabs(after[0] - before[0]) < 1e-9 && fabs(after[1] - before[1]) < 1e-9);
    }
}

/* With a floor to the horizon in the picture, things at 5 and at 7 are told apart; near is bright. */
static void depths_before_a_horizon_differ(void **state)
{
    (void)state;
    enum { SIDE = 10, PIXELS = SIDE * SIDE };
    float      depth[PIXELS], normal[3 * PIXELS] = {0};
    uint32_t   component[PIXELS];
    uint8_t    pixels[4 * PIXELS];
    KrsPicture picture = {.window    = {.width = SIDE, .height = SIDE},
                          .depth     = depth,
                          .normal    = normal,
                          .component = component};
    for (int i = 0; i < PIXELS; i++) {
        depth[i]     = i < 10 ? 900 * (float)(i + 1) : i < 50 ? 5 : 7;
        component[i] = 1;
    }
    false_color(&picture, SHADING_DEPTH, NULL, pixels);
    assert_true(pixels[4 * 10] > pixels[4 * 60] + 20);
    assert_true(pixels[4 * 60] > pixels[4 * 9] + 20);
    assert_int_equal(pixels[4 * 10], 255);
}

static void boxes_are_framed(void **state)
{
    (void)state;
    const double low[3] = {-3, 1, 2}, high[3] = {4, 2, 9}, aspect = 1.5;
    KrsCamera    camera = start;
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        double largest = 0;
        if (orthographic)
            krs_camera_toggle_perspective(&camera);
        krs_camera_fit(&camera, low, high, aspect);
        for (int corner = 0; corner < 8; corner++) {
            const double at[3] = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                                  corner & 4 ? high[2] : low[2]};
            double seen[2];
            project(&camera, at, seen);
            largest = fmax(largest, fmax(fabs(seen[0]) / aspect, fabs(seen[1])));
        }
        assert_true(largest < 0.5 && largest > 0.4);
    }
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void assert_file(const char *path, const char *meant)
{
    char  text[1000] = "";
    FILE *file       = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(text, meant);
}

/* What stands around the defaults stays. */
#define TEXT(r, turn, tint, size)                                    \
    "// r = 1;\nparam r=" r " in [0, 9]; /* r */ param turn = " turn \
    " in [0deg, 90deg];\n\tparam tint = " tint "  ;\n"               \
    "param size = " size "; show box(size).rotate([0, 1, 0], turn).paint(tint);show sphere(r);\n"

static void defaults_are_written(void **state)
{
    (void)state;
    char             path[] = "/tmp/krs-live-XXXXXX";
    const int        fd     = mkstemp(path);
    const char      *before = TEXT("1 + 1", "30deg", "#ff8000", "[1, 2, 3]");
    const KrsOptions with   = {0};
    double           values[4][4];
    size_t           written;
    assert_true(fd >= 0);
    close(fd);
    write_file(path, before);
    Document *document = document_new(path, &with);
    assert_int_equal(document_read(document), KRS_OK);
    Version  *version = document_version(document);
    KrsScene *scene   = version_scene(version);
    for (size_t i = 0; i < 4; i++) {
        KrsParameter parameter;
        assert_int_equal(krs_parameter(scene, i, &parameter), KRS_OK);
        memcpy(values[i], parameter.value, sizeof parameter.value);
    }
    assert_int_equal(write_defaults(scene, (const double(*)[4])values, &written), KRS_OK);
    assert_int_equal(written, 0);
    for (size_t i = 0; i < 4; i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        values[i][0] = strcmp(parameter.name, "r") == 0      ? 2.5
                       : strcmp(parameter.name, "turn") == 0 ? M_PI / 4
                       : strcmp(parameter.name, "tint") == 0 ? 0
                                                             : 1.5;
    }
    assert_int_equal(write_defaults(scene, (const double(*)[4])values, &written), KRS_OK);
    assert_int_equal(written, 4);
    assert_file(path, TEXT("2.5", "45deg", "#008000", "[1.5, 2, 3]"));
    assert_int_equal(write_defaults(scene, (const double(*)[4])values, &written), KRS_BAD_ARGUMENT);
    assert_file(path, TEXT("2.5", "45deg", "#008000", "[1.5, 2, 3]"));
    assert_true(document_changed(document));
    version_release(version);
    document_free(document);
    remove(path);
}

/* A slider at its end stays there: the text has as many digits as that needs. */
static void ends_of_ranges_are_written(void **state)
{
    (void)state;
    char             path[] = "/tmp/krs-live-XXXXXX";
    const int        fd     = mkstemp(path);
    const KrsOptions with   = {0};
    double           values[3][4];
    size_t           written;
    assert_true(fd >= 0);
    close(fd);
    write_file(
        path, "param a = 1 in [0, tau]; param b = 0 in [-2/3, 1]; param c = [0, 0] in [0, 200 / 3];"
              "show sphere(1).move([a, b, c.x]);");
    Document *document = document_new(path, &with);
    assert_int_equal(document_read(document), KRS_OK);
    Version  *version = document_version(document);
    KrsScene *scene   = version_scene(version);
    for (size_t i = 0; i < 3; i++) {
        KrsParameter parameter;
        assert_int_equal(krs_parameter(scene, i, &parameter), KRS_OK);
        memcpy(values[i], i == 1 ? parameter.low : parameter.high, sizeof values[i]);
    }
    assert_int_equal(write_defaults(scene, (const double(*)[4])values, &written), KRS_OK);
    assert_int_equal(written, 3);
    assert_int_equal(document_read(document), KRS_OK);
    version_release(version);
    document_free(document);
    remove(path);
}

/* A mistake leaves the version before, and what was said of it. */
static void mistakes_leave_the_version(void **state)
{
    (void)state;
    char             path[] = "/tmp/krs-live-XXXXXX";
    const int        fd     = mkstemp(path);
    const KrsOptions with   = {0};
    assert_true(fd >= 0);
    close(fd);
    write_file(path, "show sphere(1);");
    Document *document = document_new(path, &with);
    assert_int_equal(document_read(document), KRS_OK);
    Version *first = document_version(document);
    write_file(path, "\nshow spere(1);");
    assert_int_equal(document_read(document), KRS_BAD_SCENE);
    Version    *same        = document_version(document);
    Diagnostics diagnostics = document_diagnostics(document);
    assert_ptr_equal(same, first);
    assert_int_equal(diagnostics.errors, 1);
    assert_int_equal(diagnostics.items[0].line, 2);
    assert_ptr_equal(diagnostics_first_error(&diagnostics), &diagnostics.items[0]);
    diagnostics_free(&diagnostics);
    write_file(path, "let x = 1;\nshow spere(x);"); /* a warning comes before the error */
    assert_int_equal(document_read(document), KRS_BAD_SCENE);
    diagnostics = document_diagnostics(document);
    assert_false(diagnostics.items[0].error);
    assert_int_equal(diagnostics_first_error(&diagnostics)->line, 2);
    diagnostics_free(&diagnostics);
    write_file(path, "show sphere(2);");
    assert_int_equal(document_read(document), KRS_OK);
    Version *second = document_version(document);
    diagnostics     = document_diagnostics(document);
    assert_int_equal(diagnostics.count, 0);
    assert_true(version_number(second) > version_number(first));
    diagnostics_free(&diagnostics);
    document_free(document); /* versions that are held stay */
    assert_int_equal(krs_component_count(version_scene(first)), 1);
    version_release(first);
    version_release(same);
    version_release(second);
    remove(path);
}

/* ---- what is cut away ---- */

static bool is_cut(const Cut *cut, const double point[3])
{
    double       zones[KRS_MAX_ZONES][4];
    const size_t count = cut_zones(cut, zones, 0);
    bool         empty = false;
    for (size_t i = 0; i < count; i++)
        empty = empty || apart(zones[i], point) < zones[i][3];
    return empty;
}

/* A plane is one for all of the scene, to a thousandth of its size. */
static void planes_cut_what_is_before_them(void **state)
{
    (void)state;
    Cut    cut = {.size = 10};
    double forward[3], right[3], up[3];
    krs_camera_axes(&start, forward, right, up);
    cut_face(&cut, &start, start.target);
    for (int i = 0; i < 1000; i++) {
        const double x = 5 * sin(i), y = 5 * cos(1.7 * i), z = 3 * sin(2.3 * i);
        double       point[3];
        for (int k = 0; k < 3; k++)
            point[k] = start.target[k] + x * right[k] + y * up[k] + z * forward[k];
        if (fabs(z) > 0.01 * cut.size)
            assert_int_equal(is_cut(&cut, point), z < 0);
    }
    assert_true(is_cut(&cut, start.eye));
    cut_drag(&cut, &start, 0, 0.1);
    assert_false(is_cut(&cut, start.target)); /* it came nearer to the viewer */
}

static void balls_follow_the_mouse(void **state)
{
    (void)state;
    Cut    cut = {.size = 10, .ball = true, .radius = 0.5, .center = {1, 0.5, 0.75}};
    double before[2], after[2];
    assert_true(is_cut(&cut, (double[]){1, 0.5, 1.1}) && !is_cut(&cut, (double[]){1, 0.5, 1.3}));
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        KrsCamera camera = start;
        if (orthographic)
            krs_camera_toggle_perspective(&camera);
        project(&camera, cut.center, before);
        cut_drag(&cut, &camera, 0.2, -0.1);
        project(&camera, cut.center, after);
        assert_true(fabs(after[0] - before[0] - 0.2) < 1e-9);
        assert_true(fabs(after[1] - before[1] + 0.1) < 1e-9);
    }
    double zones[KRS_MAX_ZONES][4];
    assert_int_equal(cut_zones(&cut, zones, KRS_MAX_ZONES), KRS_MAX_ZONES); /* no room */
}

/* ---- textures ---- */

static void write_gray(const char *path, unsigned char gray)
{
    const unsigned char texels[4] = {gray, gray, gray, gray};
    png_image           image     = {.version = PNG_IMAGE_VERSION, .width = 2, .height = 2};
    image.format                  = PNG_FORMAT_GRAY;
    assert_true(png_image_write_to_file(&image, path, 0, texels, 2, NULL));
}

/* Reads it again, and checks that a texture of this gray moves the surface of the ball. */
static void expect_gray(Document *document, KrsChange kind, unsigned char gray)
{
    assert_int_equal(document_read(document), KRS_OK);
    Version  *version = document_version(document);
    KrsState *state;
    double    distance;
    assert_int_equal(version_changes(version).kind, kind);
    assert_int_equal(krs_state_new(version_scene(version), &state), KRS_OK);
    const double point[1][3] = {{1 + 0.2 * gray / 255.0, 0, 0}};
    assert_int_equal(krs_distance(state, point, 1, &distance), KRS_OK);
    assert_true(fabs(distance) < 1e-6);
    krs_state_free(state);
    version_release(version);
}

/* A picture that is written again, or replaced as programs for painting do, is read again, and
   compiles nothing. */
static void textures_are_followed(void **state)
{
    (void)state;
    char             folder[] = "/tmp/krs-live-XXXXXX", scene[40], picture[40], other[40];
    const KrsOptions with     = {.specialize = KRS_SPECIALIZE_STRUCTURE};
    assert_non_null(mkdtemp(folder));
    snprintf(scene, sizeof scene, "%s/a.krs", folder);
    snprintf(picture, sizeof picture, "%s/a.png", folder);
    snprintf(other, sizeof other, "%s/b.png", folder);
    write_gray(picture, 51);
    write_file(scene, "let t = texture(\"a.png\", space: \"linear\");"
                      "show sphere(1).displace(t(x, y).r, amplitude: 0.2);");
    Document *document = document_new(scene, &with);
    expect_gray(document, KRS_CHANGE_STRUCTURE, 51);
    assert_false(document_changed(document));
    write_gray(picture, 204);
    assert_true(document_changed(document));
    expect_gray(document, KRS_CHANGE_VALUES, 204);
    write_gray(other, 102);
    assert_false(document_changed(document)); /* it is another file */
    assert_int_equal(rename(other, picture), 0);
    assert_true(document_changed(document));
    expect_gray(document, KRS_CHANGE_VALUES, 102);
    write_gray(picture, 102);
    assert_true(document_changed(document));
    expect_gray(document, KRS_CHANGE_NOTHING, 102);
    document_free(document);
    remove(picture);
    remove(scene);
    rmdir(folder);
}

/* ---- presets ---- */

static void presets_are_kept(void **state)
{
    (void)state;
    char       path[] = "/tmp/krs-live-XXXXXX", file[64];
    const int  fd     = mkstemp(path);
    const char text[] =
        "param r = 1; param tint = #ff8000; param lit = 1 in 0..2; param f = 0.5 in "
        "[0, 1]; show sphere(r).paint(tint).move([lit, f, 0]);";
    const double values[4][4] = {{1.0 / 3}, {0.1, 0.2, 0.7}, {0}, {1}};
    KrsScene    *scene;
    assert_true(fd >= 0);
    close(fd);
    assert_int_equal(krs_compile_text(text, strlen(text), "a", NULL, &scene), KRS_OK);
    Presets presets = presets_read(path, NULL);
    assert_int_equal(presets.count, 0);
    assert_true(presets_set(&presets, "at night", scene, values));
    assert_true(presets_set(&presets, "b", scene, (const double[4][4]){{0}}));
    assert_true(presets_set(&presets, "b", scene, (const double[4][4]){{2}}));
    assert_true(presets_write(&presets, path));
    presets_free(&presets);
    presets = presets_read(path, NULL);
    assert_int_equal(presets.count, 2);
    assert_string_equal(presets.items[0].name, "at night");
    assert_int_equal(presets.items[0].count, 4);
    assert_true(presets.items[1].values[0].value[0] == 2);
    for (size_t i = 0; i < 4; i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        assert_string_equal(presets.items[0].values[i].name, parameter.name);
        assert_int_equal(presets.items[0].values[i].count, parameter.components);
        assert_memory_equal(presets.items[0].values[i].value, values[i],
                            parameter.components * sizeof(double));
        assert_int_equal(parameter.whole, strcmp(parameter.name, "lit") == 0);
    }
    presets_remove(&presets, 0);
    assert_true(presets_write(&presets, path));
    presets_free(&presets);
    presets = presets_read(path, NULL);
    assert_int_equal(presets.count, 1);
    assert_string_equal(presets.items[0].name, "b");
    assert_false(presets_write(&presets, "/nowhere/a"));
    presets_free(&presets);
    krs_scene_free(scene);
    snprintf(file, sizeof file, "%s.presets", path);
    remove(file);
    remove(path);
}

/* What is no file, or outside of the folder that may be read, is not read, and nothing is waited for. */
static void presets_are_read_from_files(void **state)
{
    (void)state;
    char folder[] = "/tmp/krs-live-XXXXXX", scene[64], file[80], outside[80];
    assert_non_null(mkdtemp(folder));
    snprintf(scene, sizeof scene, "%s/a.krs", folder);
    snprintf(file, sizeof file, "%s.presets", scene);
    snprintf(outside, sizeof outside, "%s.presets", folder);
    FILE *out = fopen(outside, "w");
    fputs("[one]\nr=1\n", out);
    fclose(out);
    const char *const links[] = {NULL, "/dev/zero", "/", "nowhere", outside};
    for (size_t i = 0; i < sizeof links / sizeof *links; i++)
        for (int confined = 0; confined <= 1; confined++) {
            assert_int_equal(links[i] ? symlink(links[i], file) : mkfifo(file, 0600), 0);
            Presets presets = presets_read(scene, confined ? folder : NULL);
            assert_int_equal(presets.count, links[i] == outside && !confined);
            presets_free(&presets);
            remove(file);
        }
    assert_int_equal(rename(outside, file), 0);
    Presets presets = presets_read(scene, folder);
    assert_int_equal(presets.count, 1);
    presets_free(&presets);
    remove(file);
    rmdir(folder);
}

static void gestures_are_undone(void **state)
{
    (void)state;
    History *history = history_new();
    View     view    = {.camera = start};
    history_note(history, &view, 0);
    for (int i = 1; i <= 5; i++) { /* one gesture */
        view.camera.eye[0] = 3 + i;
        history_note(history, &view, 10 + 0.1 * i);
    }
    view.camera.eye[0] = 20;
    history_note(history, &view, 30);
    assert_true(history_undo(history, &view) && view.camera.eye[0] == 8);
    assert_true(history_undo(history, &view) && view.camera.eye[0] == 3);
    assert_false(history_undo(history, &view));
    assert_true(history_redo(history, &view) && view.camera.eye[0] == 8);
    view.camera.eye[0] = 30;
    history_note(history, &view, 40);
    assert_false(history_redo(history, &view)); /* that was another branch */
    assert_true(history_undo(history, &view) && view.camera.eye[0] == 8);
    for (int i = 0; i < 1000; i++)
        history_note(history, &view, 100 + 10 * i);
    history_free(history);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_keep_the_target),
        cmocka_unit_test(what_is_grabbed_stays_under_the_mouse),
        cmocka_unit_test(depths_before_a_horizon_differ),
        cmocka_unit_test(boxes_are_framed),
        cmocka_unit_test(defaults_are_written),
        cmocka_unit_test(ends_of_ranges_are_written),
        cmocka_unit_test(mistakes_leave_the_version),
        cmocka_unit_test(gestures_are_undone),
        cmocka_unit_test(planes_cut_what_is_before_them),
        cmocka_unit_test(balls_follow_the_mouse),
        cmocka_unit_test(textures_are_followed),
        cmocka_unit_test(presets_are_kept),
        cmocka_unit_test(presets_are_read_from_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
