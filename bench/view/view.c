/*
 * view.c: how fast `krs view` follows an edit, a slider and the camera, at 640x360.
 *
 * It drives what the window shows pictures of (live/pictures/painter.h), without the window.  IDLE in the
 * environment is what view.sh has measured of the window itself.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "bench/sheet.h"
#include "bench/fixture.h"
#include "bench/view/number_edit.h"
#include "krs/camera.h"
#include "live/pictures/painter.h"

enum { WIDTH = 640, HEIGHT = 360, EDITS = 5 };
static const double SECONDS = 2; /* that the camera, and a slider, move */
static const double BUDGET = 40, TIMEOUT = 120;

typedef struct Trial {
    const char *path;
    Document   *document;
    Painter    *painter;
    View        view;
    unsigned    number; /* of the view that was shown last */
} Trial;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void show(Trial *trial) { trial->number = painter_show(trial->painter, &trial->view); }

/* Milliseconds of all processors that this process has used: other work on the machine does not count. */
static double used_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

/* The next picture of the last view: its width. */
static uint32_t await(Trial *trial, bool whole)
{
    for (const double begun = now(); now() - begun < TIMEOUT; usleep(200)) {
        Shot               shot;
        const PainterState state = painter_state(trial->painter);
        if (state.status != KRS_OK)
            give_up(trial->path, state.message);
        if (!painter_take(trial->painter, &shot))
            continue;
        free(shot.pixels);
        if (shot.view == trial->number && (shot.whole || !whole) &&
            shot.version == version_number(trial->view.version))
            return shot.width;
    }
    give_up(trial->path, "there is no picture");
}

static void take_version(Trial *trial)
{
    Version        *version = document_version(trial->document);
    const KrsScene *scene   = version_scene(version);
    const size_t    count   = krs_parameter_count(scene);
    view_free(&(View){.version = trial->view.version, .values = trial->view.values});
    trial->view.version = version;
    trial->view.values  = calloc(count + 1, sizeof *trial->view.values);
    for (size_t i = 0; i < count; i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        memcpy(trial->view.values[i], parameter.value, sizeof parameter.value);
    }
}

/* ---- an edit of a number ---- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Milliseconds from a saved file to its first picture: by the clock, of all processors, and of these
   what the text takes. */
typedef struct Edit {
    double clock, used, text;
} Edit;

static double median(double ms[EDITS])
{
    qsort(ms, EDITS, sizeof *ms, compare);
    return ms[EDITS / 2];
}

static void edit_once(Trial *trial, NumberEdit *number, Edit *edit)
{
    const double begun = now(), before = used_ms();
    number_edit_write(number);
    if (document_read(trial->document) != KRS_OK)
        give_up(trial->path, "the edited text does not compile");
    edit->text = used_ms() - before;
    take_version(trial);
    show(trial);
    await(trial, false);
    edit->used  = used_ms() - before;
    edit->clock = 1e3 * (now() - begun);
    await(trial, true);
}

/* The medians of some edits; below 0: there is no number to edit. */
static Edit time_edits(Trial *trial)
{
    double     clock[EDITS], used[EDITS], texts[EDITS];
    NumberEdit number = number_edit_find(trial->document, trial->path, 0);
    const bool found  = number.at > 0;
    take_version(trial);
    show(trial);
    await(trial, true);
    for (int i = 0; found && i < EDITS; i++) {
        Edit edit;
        edit_once(trial, &number, &edit);
        clock[i] = edit.clock;
        used[i]  = edit.used;
        texts[i] = edit.text;
    }
    return found ? (Edit){median(clock), median(used), median(texts)} : (Edit){-1, -1, -1};
}

/* ---- what moves ---- */

/* Pictures a second while `step` changes the view; *width is that of the last one. */
static double count_pictures(Trial *trial, void (*step)(Trial *trial, int i), uint32_t *width)
{
    int i = 0;
    for (; i < 8; i++) { /* until it knows what a picture costs */
        step(trial, i);
        show(trial);
        await(trial, false);
    }
    const double begun = now();
    int          count = 0;
    for (; now() - begun < SECONDS; count++) {
        step(trial, i + count);
        show(trial);
        *width = await(trial, false);
    }
    return count / (now() - begun);
}

static void orbit(Trial *trial, int i)
{
    (void)i;
    krs_camera_orbit(&trial->view.camera, 0.02, 0);
}

/* The first parameter with a range, or else the time. */
static void slide(Trial *trial, int i)
{
    const KrsScene *scene = version_scene(trial->view.version);
    const double    part  = 0.5 + 0.5 * sin(0.1 * i);
    trial->view.time      = 0.05 * i;
    for (size_t k = 0; k < krs_parameter_count(scene); k++) {
        KrsParameter parameter;
        krs_parameter(scene, k, &parameter);
        if (!isfinite(parameter.low[0]) || !isfinite(parameter.high[0]))
            continue;
        for (uint32_t c = 0; c < parameter.components; c++)
            trial->view.values[k][c] = parameter.low[c] +
                                       part * (parameter.high[c] - parameter.low[c]);
        trial->view.time = 0;
        return;
    }
}

/* ---- a scene ---- */

static void set_camera(Trial *trial)
{
    KrsState *state;
    if (krs_state_new(version_scene(trial->view.version), &state) != KRS_OK ||
        krs_state_camera(state, 0, &trial->view.camera) != KRS_OK)
        give_up(trial->path, "it has no camera");
    krs_state_free(state);
}

static void measure(const Sheet *sheet, const char *path)
{
    const KrsOptions     with    = {.specialize = KRS_SPECIALIZE_STRUCTURE, .studio = true};
    const PainterOptions options = {
        .renderer = {.device = getenv("KRS_DEVICE"), .cache = getenv("KRS_VIEW_CACHE")},
        .budget   = BUDGET};
    const char *slash = strrchr(path, '/');
    Trial       trial = {
              .path = path, .document = document_new(path, &with), .painter = painter_new(&options)};
    uint32_t turned = 0, slid = 0;
    if (!trial.document || !trial.painter || document_read(trial.document) != KRS_OK)
        give_up(path, "it does not compile");
    trial.view = (View){
        .width = WIDTH, .height = HEIGHT, .samples = 1, .integrator = KRS_INTEGRATOR_PREVIEW};
    const double begun = now();
    take_version(&trial);
    set_camera(&trial);
    show(&trial);
    await(&trial, false);
    const double first  = now() - begun;
    const Edit   edit   = time_edits(&trial);
    const double camera = count_pictures(&trial, orbit, &turned);
    const double slider = count_pictures(&trial, slide, &slid);
    char         edited[64];
    if (edit.clock < 0)
        snprintf(edited, sizeof edited, "- | - | -");
    else
        snprintf(edited, sizeof edited, "%.0f | %.0f | %.0f", edit.clock, edit.used, edit.text);
    sheet_print(sheet, "| %s | %.1f | %s | %.1f | %u | %.1f | %u |\n", slash ? slash + 1 : path,
                first, edited, camera, turned, slider, slid);
    painter_free(trial.painter);
    view_free(&trial.view);
    document_free(trial.document);
}

int main(int argc, char **argv)
{
    KrsRenderer *renderer = device_open();
    const char  *idle     = getenv("IDLE");
    Sheet        sheet    = sheet_open("view", "The viewer", "make bench-view", renderer, false);
    krs_renderer_free(renderer);
    sheet_print(
        &sheet,
        "\nAt %dx%d, by the preview, with %.0f ms for a picture of what moves. *first*: seconds "
        "until the first picture, with shaders; *edit*: milliseconds from a saved number to its "
        "first picture, the median of %d; *used*: milliseconds of "
        "all processors for that, and of these *text*: what reading and compiling it takes (other "
        "work on the machine makes *edit* longer, but not these); then pictures a second "
        "while the camera turns and while a slider is pulled (or time runs), and how wide they "
        "are.\n\nThe window, when nothing happens, uses %s of a processor.\n\n",
        WIDTH, HEIGHT, BUDGET, EDITS, idle && *idle ? idle : "an unknown part");
    sheet_print(&sheet, "| scene | first | edit | used | text | camera | wide | slider | wide |\n"
                        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 1; i < argc; i++)
        measure(&sheet, argv[i]);
    sheet_close(&sheet);
    return 0;
}
