/*
 * view.c: how fast `krs view` follows an edit, a slider and the camera, at 640x360.
 *
 * It drives what the window shows pictures of (live/pictures/painter.h), without the window.  IDLE in the
 * environment is what view.sh has measured of the window itself, FIRST the file of what it has measured by first.c.
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
#include "bench/view/trial.h"
#include "krs/camera.h"

enum { EDITS = 5 };
static const double SECONDS = 2; /* that the camera, and a slider, move */

/* Milliseconds of all processors that this process has used: other work on the machine does not count. */
static double used_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
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
    const double begun = trial_now(), before = used_ms();
    number_edit_write(number);
    if (document_read(trial->document) != KRS_OK)
        give_up(trial->path, "the edited text does not compile");
    edit->text = used_ms() - before;
    trial_take_version(trial);
    trial_show(trial);
    trial_await(trial, false);
    edit->used  = used_ms() - before;
    edit->clock = 1e3 * (trial_now() - begun);
    trial_await(trial, true);
}

/* Returns the medians of some edits; below 0: there is no number to edit. */
static Edit time_edits(Trial *trial)
{
    double     clock[EDITS], used[EDITS], texts[EDITS];
    NumberEdit number = number_edit_find(trial->document, trial->path, 0);
    const bool found  = number.at > 0;
    trial_take_version(trial);
    trial_show(trial);
    trial_await(trial, true);
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
        trial_show(trial);
        trial_await(trial, false);
    }
    const double begun = trial_now();
    int          count = 0;
    for (; trial_now() - begun < SECONDS; count++) {
        step(trial, i + count);
        trial_show(trial);
        *width = trial_await(trial, false);
    }
    return count / (trial_now() - begun);
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

static void measure(const Sheet *sheet, const char *path)
{
    const char  *slash  = strrchr(path, '/');
    const double begun  = trial_now();
    Trial        trial  = trial_open(path, KRS_EXECUTOR_DEFAULT, KRS_SPECIALIZE_STRUCTURE);
    uint32_t     turned = 0, slid = 0;
    trial_take_version(&trial);
    trial_take_camera(&trial);
    trial_show(&trial);
    trial_await(&trial, false);
    const double first = trial_now() - begun;
    trial_await_rest(&trial);
    trial_await_shaders(&trial);
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
    trial_close(&trial);
}

/* How soon there are pictures, as first.c has printed it for each scene. */
static void print_first(const Sheet *sheet)
{
    char        line[400];
    const char *path = getenv("FIRST");
    FILE       *file = path ? fopen(path, "r") : NULL;
    if (!file)
        return;
    sheet_print(
        sheet, "\nSeconds until the first picture, the one with all pixels, and shaders: from the "
               "start, with empty caches, then from an edit of the structure. First by shaders "
               "alone, then with lanes until there are shaders.\n\n"
               "| scene | first | whole | shaders | edit: first | whole | shaders | lanes: first | "
               "whole | shaders | edit: first | whole | shaders |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    while (fgets(line, sizeof line, file))
        sheet_print(sheet, "%s", line);
    fclose(file);
}

int main(int argc, char **argv)
{
    KrsRenderer *renderer = device_open();
    const char  *idle     = getenv("IDLE");
    Sheet        sheet    = sheet_open("view", "The viewer", "make bench-view", renderer, false);
    krs_renderer_free(renderer);
    sheet_print(
        &sheet,
        "\nAt %dx%d, by the preview, with %d ms for a picture of what moves. *first*: seconds "
        "until the first picture, by lanes where they can draw it; *edit*: milliseconds from a "
        "saved number to its "
        "first picture, the median of %d; *used*: milliseconds of "
        "all processors for that, and of these *text*: what reading and compiling it takes (other "
        "work on the machine makes *edit* longer, but not these); then pictures a second "
        "while the camera turns and while a slider is pulled (or time runs), and how wide they "
        "are.\n\nThe window, when nothing happens, uses %s of a processor.\n\n",
        TRIAL_WIDTH, TRIAL_HEIGHT, TRIAL_BUDGET, EDITS, idle && *idle ? idle : "an unknown part");
    sheet_print(&sheet, "| scene | first | edit | used | text | camera | wide | slider | wide |\n"
                        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 1; i < argc; i++)
        measure(&sheet, argv[i]);
    print_first(&sheet);
    sheet_close(&sheet);
    return 0;
}
