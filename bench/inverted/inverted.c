/*
 * inverted.c: every way to trace sequences with maps that invert, beside every other.
 *
 * Plain, relaxed and automatic steps by the centred bound, exits of rays from balls, and balls that
 * are tried, in turns, with beams and without; all held against plain steps with a permitted error
 * of a hundredth of a pixel.  bench/README.md says what the columns mean.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "bench/sheet.h"
#include "compiler/compile.h"
#include "runtime/krs_vulkan.h"

enum { WIDTH = 640, HEIGHT = 360, PIXELS = WIDTH * HEIGHT, MOST_REPEATS = 15 };

static const struct Subject {
    const char *name, *path;
} subjects[] = {
#define SCENE(name, path) {name, path},
#include "bench/inverted/scenes.def"
#undef SCENE
};
enum { SUBJECTS = sizeof subjects / sizeof *subjects };

static const KrsTrace traces[] = {KRS_TRACE_PLAIN,       KRS_TRACE_RELAXED, KRS_TRACE_AUTO,
                                  KRS_TRACE_DIRECTIONAL, KRS_TRACE_BINARY,  KRS_TRACE_PREDICTED};
enum { TRACES = sizeof traces / sizeof *traces };

typedef struct Row {
    KrsTrace trace;
    bool     beams;
    double   ms[MOST_REPEATS]; /* of beams and primary rays */
    double   cpu_ms;           /* of all threads for the whole picture: the least */
    double   evaluations, hits, differing;
    uint64_t unresolved;
} Row;

typedef struct Stage {
    const char   *name;
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
} Stage;

static Sheet sheet;

static void fail(const char *what, const char *why)
{
    fprintf(stderr, "inverted: %s: %s\n", what, why);
    exit(1);
}

static void complain(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fprintf(stderr, "%s\n", diagnostic->text);
}

static Stage stage_open(KrsRenderer *renderer, const struct Subject *subject)
{
    Stage      stage   = {.name = subject->name, .renderer = renderer};
    KrsOptions options = {.diagnostic = complain};
    if (krs_compile_file(subject->path, &options, &stage.scene) != KRS_OK ||
        krs_frame_new(stage.scene, &stage.frame) != KRS_OK)
        fail(subject->name, "it does not compile");
    if (krs_rendering_new(renderer, stage.scene, &stage.rendering) != KRS_OK)
        fail(subject->name, krs_renderer_message(renderer));
    return stage;
}

static void stage_close(Stage *stage)
{
    krs_rendering_free(stage->rendering);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
}

/* Milliseconds that the threads of this process have computed. */
static double cpu_ms(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-3 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static KrsPicture *render(const Stage *stage, KrsTrace trace, bool beams, double error)
{
    KrsPicture      *picture;
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1, .trace = trace,
                                .no_beams = !beams, .error = error, .no_upsampling = true,
                                .planes = KRS_PLANE_DEPTH | KRS_PLANE_IDS};
    if (krs_render(stage->rendering, stage->frame, &options, &picture) != KRS_OK)
        fail(stage->name, krs_renderer_message(stage->renderer));
    return picture;
}

/* Where only one of two pictures shows something, or its depth is off by a hundredth. */
static double differing(const KrsPicture *a, const KrsPicture *b)
{
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        bool hit = a->component[i] != 0;
        count += hit != (b->component[i] != 0) ||
                 (hit && fabsf(a->depth[i] - b->depth[i]) > 0.01F * b->depth[i]);
    }
    return (double)count / PIXELS;
}

static double hits_of(const KrsPicture *picture)
{
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++)
        count += picture->component[i] != 0;
    return (double)count / PIXELS;
}

static int by_size(const void *a, const void *b)
{
    double difference = *(const double *)a - *(const double *)b;
    return (difference > 0) - (difference < 0);
}

static void measure(const Stage *stage, const KrsPicture *fine, Row *row, size_t turn)
{
    double      used = cpu_ms();
    KrsPicture *picture = render(stage, row->trace, row->beams, 0.25);
    used = cpu_ms() - used;
    row->cpu_ms = turn == 0 ? used : fmin(row->cpu_ms, used);
    const KrsRenderStats *stats = &picture->stats;
    row->ms[turn]    = stats->phase_ms[KRS_PHASE_BEAMS] + stats->phase_ms[KRS_PHASE_PRIMARY];
    row->evaluations = stats->evaluations_per_ray;
    row->unresolved  = stats->unresolved;
    row->hits        = hits_of(picture);
    row->differing   = differing(picture, fine);
    krs_picture_free(picture);
}

static void print_row(const Stage *stage, Row *row, size_t repeats)
{
    qsort(row->ms, repeats, sizeof row->ms[0], by_size);
    double least = row->ms[0] * 1e6 / PIXELS, median = row->ms[repeats / 2] * 1e6 / PIXELS;
    sheet_print(&sheet, "| %s | %s | %s | %.2f | %.0f | %.0f | %.1f | %.0f |", stage->name,
                krs_trace_names[row->trace], row->beams ? "yes" : "no", row->evaluations, median,
                least, least / row->evaluations, row->cpu_ms);
    sheet_print(&sheet, " %.2f %% | %.3f %% | %llu |\n", 100 * row->hits, 100 * row->differing,
                (unsigned long long)row->unresolved);
}

static void compare(KrsRenderer *renderer, const struct Subject *subject, size_t repeats)
{
    Row         rows[2 * TRACES] = {0};
    Stage       stage = stage_open(renderer, subject);
    KrsPicture *fine  = render(&stage, KRS_TRACE_PLAIN, false, 0.01);
    /* Nothing is timed that has not run before. */
    for (size_t turn = 0; turn <= repeats; turn++)
        for (size_t i = 0; i < 2 * TRACES; i++) {
            rows[i].trace = traces[i % TRACES];
            rows[i].beams = i < TRACES;
            measure(&stage, fine, &rows[i], turn ? turn - 1 : 0);
        }
    for (size_t i = 0; i < 2 * TRACES; i++)
        print_row(&stage, &rows[i], repeats);
    krs_picture_free(fine);
    stage_close(&stage);
}

/* inverted [REPEATS [NAME]]: one scene. */
int main(int count, char **arguments)
{
    KrsRenderer *renderer;
    size_t       repeats = count > 1 ? strtoul(arguments[1], NULL, 10) : 5;
    if (repeats < 1 || repeats > MOST_REPEATS)
        fail(arguments[1], "1 to 15 repeats");
    spirv_start();
    if (krs_renderer_new(NULL, &renderer) != KRS_OK)
        fail("cannot open the device", renderer ? krs_renderer_message(renderer) : "no memory");
    sheet = sheet_open("inverted", "Sequences with maps that invert", "make inverted", renderer,
                       count > 1);
    sheet_print(&sheet, "%dx%d, medians of %zu\n\n", WIDTH, HEIGHT, repeats);
    sheet_print(&sheet, "| scene | trace | beams | evals/ray | ns/ray | least | ns/eval | cpu ms |"
                        " hit | differs | unresolved |\n"
                        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < SUBJECTS; i++)
        if (count < 3 || strcmp(subjects[i].name, arguments[2]) == 0)
            compare(renderer, &subjects[i], repeats);
    sheet_close(&sheet);
    krs_renderer_free(renderer);
    spirv_stop();
    return 0;
}
