/*
 * edits.c: how long it takes from a saved number to the written picture of 640x360 pixels.
 *
 * A process that stays (`krs watch`) and one for each picture (`krs render --specialize structure`) get the
 * same edits, after the first has made the shaders of edits.
 */
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bench/sheet.h"
#include "bench/fixture.h"
#include "bench/view/number_edit.h"

enum { NUMBERS = 3, REPEATS = 3, MAX_EDITS = NUMBERS * REPEATS, TIMEOUT = 600 };
static const char picture_name[] = "picture.png";

extern char **environ;

typedef struct Trial {
    const char *krs, *scene;
    char        picture[PATH_MAX];
    int         inotify; /* of the folder of the picture */
    NumberEdit  numbers[NUMBERS];
    size_t      count;
} Trial;

/* Milliseconds of an edit: by the clock, of its frame, and of all processors. */
typedef struct Edit {
    double clock, frame, used;
} Edit;

static double read_clock(clockid_t which)
{
    struct timespec time;
    clock_gettime(which, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

static double now(void) { return read_clock(CLOCK_MONOTONIC); }

/* ---- the numbers ---- */

/* Finds one in each third of the text, where there is one. */
static void find_numbers(Trial *trial)
{
    const KrsOptions with     = {.specialize = KRS_SPECIALIZE_STRUCTURE, .studio = true};
    Document        *document = document_new(trial->scene, &with);
    FILE            *file     = fopen(trial->scene, "r");
    if (!document || !file || document_read(document) != KRS_OK || fseek(file, 0, SEEK_END) != 0)
        give_up(trial->scene, "it does not compile");
    const size_t length = (size_t)ftell(file);
    fclose(file);
    trial->count = 0;
    for (size_t i = 0; i < NUMBERS; i++) {
        const NumberEdit found = number_edit_find(document, trial->scene, i * length / NUMBERS);
        if (found.at == 0 || (trial->count > 0 && found.at == trial->numbers[trial->count - 1].at))
            break;
        trial->numbers[trial->count++] = found;
    }
    document_free(document);
}

/* ---- the picture ---- */

/* Waits until a picture is in its place. */
static void await_picture(const Trial *trial)
{
    struct pollfd                       events = {.fd = trial->inotify, .events = POLLIN};
    _Alignas(struct inotify_event) char buffer[4096];
    while (poll(&events, 1, TIMEOUT * 1000) > 0) {
        const ssize_t length = read(trial->inotify, buffer, sizeof buffer);
        for (const char *at = buffer; at < buffer + length;) {
            const struct inotify_event *event = (const struct inotify_event *)(const void *)at;
            if (event->len > 0 && strcmp(event->name, picture_name) == 0)
                return;
            at += sizeof *event + event->len;
        }
    }
    give_up(trial->scene, "there is no picture");
}

/* Returns the frame's own time, from a line of --stats json. */
static double read_frame(const Trial *trial, FILE *stats)
{
    char       *line = NULL;
    size_t      size = 0;
    const char *wall = NULL;
    if (getline(&line, &size, stats) > 0)
        wall = strstr(line, "\"render\": ");
    if (wall)
        wall = strstr(wall, "\"wall\": ");
    if (!wall)
        give_up(trial->scene, "it prints no statistics");
    const double ms = strtod(wall + strlen("\"wall\": "), NULL);
    free(line);
    return ms;
}

/* ---- processes ---- */

/* Starts the command with a pipe from its standard output; what it says is not shown.  `rays`: who marches them.
   `option`: that which is "structure", or NULL. */
static pid_t start(const Trial *trial, const char *command, const char *rays, const char *option,
                   FILE **stats)
{
    int                        ends[2];
    pid_t                      process;
    char                      *arguments[] = {(char *)trial->krs,
                                              (char *)command,
                                              (char *)trial->scene,
                                              "--output",
                                              (char *)trial->picture,
                                              "--size",
                                              "640x360",
                                              "--samples",
                                              "1",
                                              "--stats",
                                              "json",
                                              "--deadline",
                                              "600",
                                              "--rays",
                                              (char *)rays,
                                              (char *)option,
                                              "structure",
                                              NULL};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (pipe2(ends, O_CLOEXEC) != 0)
        give_up(trial->krs, "there is no pipe");
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&process, trial->krs, &actions, NULL, arguments, environ) != 0)
        give_up(trial->krs, "it cannot be started");
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    *stats = fdopen(ends[0], "r");
    return process;
}

/* Returns the clock of processors of the process that works: the command's only child. */
static clockid_t find_clock(const Trial *trial, pid_t process)
{
    char      path[64];
    clockid_t clock;
    int       child = 0;
    snprintf(path, sizeof path, "/proc/%d/task/%d/children", process, process);
    FILE *file = fopen(path, "r");
    if (!file || fscanf(file, "%d", &child) != 1 || clock_getcpuclockid(child, &clock) != 0)
        give_up(trial->scene, "nothing works for `krs watch`");
    fclose(file);
    return clock;
}

static Edit edit_watched(const Trial *trial, NumberEdit *number, FILE *stats, clockid_t clock)
{
    const double begun = now(), before = read_clock(clock);
    number_edit_write(number);
    await_picture(trial);
    const double seen = now() - begun, used = read_clock(clock) - before;
    return (Edit){seen, read_frame(trial, stats), used};
}

/* The first edits make the shaders of edits. */
static size_t time_watch(Trial *trial, Edit edits[MAX_EDITS])
{
    FILE       *stats;
    size_t      count   = 0;
    const pid_t process = start(trial, "watch", "auto", NULL, &stats);
    await_picture(trial);
    read_frame(trial, stats);
    const clockid_t clock = find_clock(trial, process);
    for (size_t i = 0; i < trial->count; i++)
        edit_watched(trial, &trial->numbers[i], stats, clock);
    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (size_t i = 0; i < trial->count; i++)
            edits[count++] = edit_watched(trial, &trial->numbers[i], stats, clock);
    kill(process, SIGTERM);
    fclose(stats);
    waitpid(process, NULL, 0);
    return count;
}

static Edit edit_rendered(const Trial *trial, const char *rays, NumberEdit *number)
{
    FILE         *stats;
    struct rusage usage;
    int           status;
    const double  begun = now();
    number_edit_write(number);
    const pid_t process = start(trial, "render", rays, "--specialize", &stats);
    await_picture(trial);
    const double frame = read_frame(trial, stats);
    wait4(process, &status, 0, &usage);
    const double seen = now() - begun;
    fclose(stats);
    return (Edit){seen, frame,
                  1e3 * (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                      1e-3 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec)};
}

/* The first one fills the caches. */
static size_t time_render(Trial *trial, Edit edits[MAX_EDITS])
{
    size_t count = 0;
    edit_rendered(trial, "kernels", &trial->numbers[0]);
    for (size_t i = 0; i < trial->count; i++)
        edits[count++] = edit_rendered(trial, "auto", &trial->numbers[i]);
    return count;
}

/* ---- the table ---- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Finds the median of `weight`ed sums, over every `step`th edit from `edits` on. */
static double median(const Edit *edits, size_t count, size_t step, Edit weight)
{
    double sums[MAX_EDITS];
    size_t found = 0;
    for (size_t i = 0; i < count; i += step)
        sums[found++] = weight.clock * edits[i].clock + weight.frame * edits[i].frame +
                        weight.used * edits[i].used;
    qsort(sums, found, sizeof *sums, compare);
    return sums[found / 2];
}

static const Edit whole = {1, 0, 0}, frame_alone = {0, 1, 0}, without_frame = {1, -1, 0},
                  used = {0, 0, 1};

/* Returns the slowest number's median. */
static double find_slowest(const Edit *edits, size_t count, size_t numbers)
{
    double most = 0;
    for (size_t i = 0; i < numbers; i++) {
        const double ms = median(edits + i, count - i, numbers, without_frame);
        most            = ms > most ? ms : most;
    }
    return most;
}

/* Returns what the slowest number takes beyond its frame. */
static double measure(const Sheet *sheet, Trial *trial)
{
    Edit        edits[MAX_EDITS];
    const char *slash = strrchr(trial->scene, '/');
    find_numbers(trial);
    sheet_print(sheet, "| %s | ", slash ? slash + 1 : trial->scene);
    if (trial->count == 0) {
        sheet_print(sheet, "- | - | - | - | - | - | - | - |\n");
        return 0;
    }
    size_t       count   = time_watch(trial, edits);
    const double slowest = find_slowest(edits, count, trial->count);
    sheet_print(sheet, "%.0f | %.0f | %.0f | %.0f | %.0f | ", median(edits, count, 1, whole),
                median(edits, count, 1, frame_alone), median(edits, count, 1, without_frame),
                slowest, median(edits, count, 1, used));
    count = time_render(trial, edits);
    sheet_print(sheet, "%.0f | %.0f | %.0f |\n", median(edits, count, 1, whole),
                median(edits, count, 1, without_frame), median(edits, count, 1, used));
    return slowest;
}

static void print_head(const Sheet *sheet)
{
    sheet_print(
        sheet,
        "\nMilliseconds from a saved number to the picture of 640x360 in its place, one sample.  "
        "*edit*: by "
        "`krs watch`, the median of %d edits of each of %d numbers (one in each third of the text, "
        "if it has "
        "them), after one edit of each; *frame*: of these, the picture itself; *less*: the edit "
        "without the "
        "frame; *slowest*: the same of the number that takes longest; *used*: the edit in "
        "milliseconds of all "
        "processors, which other work on the machine does not lengthen.  *process*: a process of "
        "its own, "
        "`krs render --specialize structure`, with full caches, from its start to its end; then "
        "the same without the frame, and of all processors.\n\n",
        REPEATS, NUMBERS);
    sheet_print(sheet, "| scene | edit | frame | less | slowest | used | process | less | used |\n"
                       "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

int main(int argc, char **argv)
{
    KrsRenderer *renderer = device_open();
    const char  *folder   = argc > 3 ? argv[2] : NULL;
    double       most     = 0;
    if (!folder)
        give_up("usage", "edits KRS FOLDER SCENE...");
    Trial trial = {.krs = argv[1], .inotify = inotify_init1(IN_CLOEXEC)};
    Sheet sheet = sheet_open("edits", "Edits of a number", "make bench-edits", renderer,
                             getenv("SCENES") != NULL);
    krs_renderer_free(renderer);
    snprintf(trial.picture, sizeof trial.picture, "%s/%s", folder, picture_name);
    if (inotify_add_watch(trial.inotify, folder, IN_MOVED_TO) < 0)
        give_up(folder, "it cannot be watched");
    print_head(&sheet);
    for (int i = 3; i < argc; i++) {
        trial.scene     = argv[i];
        const double ms = measure(&sheet, &trial);
        most            = ms > most ? ms : most;
    }
    sheet_print(&sheet, "\nThe most beyond the frame, by `krs watch`: %.0f ms.\n", most);
    sheet_close(&sheet);
    return 0;
}
