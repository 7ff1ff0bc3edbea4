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

#include "bench/measure.h"
#include "bench/sheet.h"
#include "bench/fixture.h"
#include "compiler/passes/compile.h"
#include "krs/vulkan.h"

enum { WIDTH = 640, HEIGHT = 360, PIXELS = WIDTH * HEIGHT, MAX_REPEATS = 15 };

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
    double   ms[MAX_REPEATS]; /* of beams and primary rays */
    double   cpu_ms;          /* of all threads for the whole picture: the least */
    double   evaluations, hits, differing;
    uint64_t unresolved;
} Row;

static Sheet sheet;

static KrsPicture *shoot(const Fixture *fixture, KrsTrace trace, bool beams, double error)
{
    return fixture_render(fixture, &(KrsRenderOptions){.width                 = WIDTH,
                                                       .height                = HEIGHT,
                                                       .samples               = 1,
                                                       .methods.trace         = trace,
                                                       .methods.no_beams      = !beams,
                                                       .error                 = error,
                                                       .methods.no_upsampling = true,
                                                       .aovs = KRS_AOV_DEPTH | KRS_AOV_IDS});
}

/* Returns the share of pixels where only one of two pictures shows something, or where its depth is
   off by a hundredth. */
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

static void measure(const Fixture *fixture, const KrsPicture *fine, Row *row, size_t repeat)
{
    double      used            = cpu_ms();
    KrsPicture *picture         = shoot(fixture, row->trace, row->beams, 0.25);
    used                        = cpu_ms() - used;
    row->cpu_ms                 = repeat == 0 ? used : fmin(row->cpu_ms, used);
    const KrsRenderStats *stats = &picture->stats;
    row->ms[repeat]  = stats->phase_ms[KRS_PHASE_BEAMS] + stats->phase_ms[KRS_PHASE_PRIMARY];
    row->evaluations = stats->evaluations_per_ray;
    row->unresolved  = stats->unresolved;
    row->hits        = hits_of(picture);
    row->differing   = differing(picture, fine);
    krs_picture_free(picture);
}

static void print_row(const char *name, Row *row, size_t repeats)
{
    double middle = median(row->ms, repeats) * 1e6 / PIXELS, least = row->ms[0] * 1e6 / PIXELS;
    sheet_print(&sheet, "| %s | %s | %s | %.2f | %.0f | %.0f | %.1f | %.0f |", name,
                krs_trace_names[row->trace], row->beams ? "yes" : "no", row->evaluations, middle,
                least, least / row->evaluations, row->cpu_ms);
    sheet_print(&sheet, " %.2f %% | %.3f %% | %llu |\n", 100 * row->hits, 100 * row->differing,
                (unsigned long long)row->unresolved);
}

static void compare(KrsRenderer *renderer, const struct Subject *subject, size_t repeats)
{
    Row         rows[2 * TRACES] = {0};
    Fixture     fixture          = fixture_open(renderer, subject->path, NULL, false);
    KrsPicture *fine             = shoot(&fixture, KRS_TRACE_PLAIN, false, 0.01);
    /* Nothing is timed that has not run before. */
    for (size_t repeat = 0; repeat <= repeats; repeat++)
        for (size_t i = 0; i < 2 * TRACES; i++) {
            rows[i].trace = traces[i % TRACES];
            rows[i].beams = i < TRACES;
            measure(&fixture, fine, &rows[i], repeat ? repeat - 1 : 0);
        }
    for (size_t i = 0; i < 2 * TRACES; i++)
        print_row(subject->name, &rows[i], repeats);
    krs_picture_free(fine);
    fixture_close(&fixture);
}

/* inverted [REPEATS [NAME]]: one scene. */
int main(int count, char **arguments)
{
    size_t repeats = count > 1 ? strtoul(arguments[1], NULL, 10) : 5;
    if (repeats < 1 || repeats > MAX_REPEATS)
        give_up(arguments[1], "1 to 15 repeats");
    spirv_start();
    KrsRenderer *renderer = device_open();
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
