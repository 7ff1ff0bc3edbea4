/*
 * contest.c: every method and the shader by hand in turns, A B C A B C, on one device.
 *
 * Nothing is timed that has not run before.  The pictures are compared with one whose permitted
 * error is a hundredth as large, found ray by ray by plain steps.
 */
#include "bench/contest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const SceneRow scene_rows[] = {
#define SCENE(name, path, levels, quick, handwritten) {name, path, levels, quick, handwritten},
#include "bench/scenes.def"
#undef SCENE
};
const size_t scene_count = sizeof scene_rows / sizeof scene_rows[0];

static const KrsRenderOptions methods[] = {
#define METHOD(how, dealt, with_beams)         \
    {.methods.trace    = KRS_TRACE_##how,      \
     .methods.schedule = KRS_SCHEDULE_##dealt, \
     .methods.no_beams = !(with_beams)},
#include "bench/methods.def"
#undef METHOD
};
enum { METHODS = sizeof methods / sizeof methods[0], MAX_ENTRIES = METHODS + 2 };

/* Permitted errors of shaders by hand, from that of ours down to the reference's. */
static const double errors[] = {PERMITTED_ERROR, 0.1, 0.03, 0.01, 0.003, REFERENCE_ERROR};
enum { ERRORS = sizeof errors / sizeof errors[0] };

double contest_ratio(const Contest *contest, const Entry *written)
{
    return written->median.total / times_without_secondary(&contest->entries[0].median);
}

double contest_min_ratio(const Contest *contest, const Entry *written)
{
    return written->least / contest->entries[0].least;
}

double coverage_error(const Contest *contest, double coverage)
{
    return coverage / contest->reference_coverage - 1;
}

static void add_fault(Text *faults, const Contest *contest, const char *who, const char *what,
                      double found, double permitted)
{
    text_format(faults, "%s, %s: %s is %.3g, and may be %.3g\n", contest->row->name, who, what,
                found, permitted);
}

void contest_judge(const Bench *bench, const Contest *contest, Text *faults)
{
    const double tolerance = bench->quick ? QUICK_TOLERANCE : METHOD_TOLERANCE;
    for (size_t i = 0; i < contest->methods; i++) {
        const Entry *entry = &contest->entries[i];
        double       off   = fabs(coverage_error(contest, entry->coverage));
        if (!(off <= tolerance))
            add_fault(faults, contest, entry->name, "error of coverage", off, tolerance);
        if (!(entry->agreement.inside_differs <= INSIDE_TOLERANCE))
            add_fault(faults, contest, entry->name, "share of wrong pixels away from edges",
                      entry->agreement.inside_differs, INSIDE_TOLERANCE);
        if (entry->unresolved > 0)
            add_fault(faults, contest, entry->name, "number of unresolved rays", entry->unresolved,
                      0);
    }
    const Agreement *geometry = &contest->geometry;
    if (!(geometry->depth_error <= DEPTH_TOLERANCE))
        add_fault(faults, contest, "by hand", "error of depth", geometry->depth_error,
                  DEPTH_TOLERANCE);
    if (!(geometry->inside_differs <= INSIDE_TOLERANCE))
        add_fault(faults, contest, "by hand", "share of wrong pixels away from edges",
                  geometry->inside_differs, INSIDE_TOLERANCE);
}

/* ---- Who takes part ---- */

static Entry *add_entry(Bench *bench, Contest *contest)
{
    Entry *entry = &contest->entries[contest->count++];
    entry->runs  = arena_new_array(bench->arena, Times, bench->repeats);
    return entry;
}

static void add_methods(Bench *bench, Contest *contest)
{
    for (size_t i = 0; i < METHODS; i++) {
        Entry *entry         = add_entry(bench, contest);
        entry->options       = methods[i];
        entry->options.error = entry->error = PERMITTED_ERROR;
        bool is_default                     = methods[i].methods.trace == KRS_TRACE_DEFAULT;
        snprintf(entry->name, sizeof entry->name, "%s%s%s%s",
                 krs_trace_names[methods[i].methods.trace], is_default ? "" : " ",
                 is_default ? "" : krs_schedule_names[methods[i].methods.schedule],
                 !is_default && !methods[i].methods.no_beams ? " beams" : "");
    }
    contest->methods = contest->count;
}

static const Entry *add_written(Bench *bench, Contest *contest, Handwritten *written,
                                const Subject *subject)
{
    Entry *entry = add_entry(bench, contest);
    handwritten_count(bench, written, contest->row->handwritten, &subject->view);
    entry->written             = written;
    entry->error               = written->error;
    entry->evaluations_per_ray = written->evaluations_per_ray;
    entry->unresolved          = written->unresolved;
    entry->spirv_ms            = written->shader.spirv_ms;
    entry->pipeline_ms         = written->shader.pipeline_ms;
    snprintf(entry->name, sizeof entry->name, "by hand, %g pixels", written->error);
    return entry;
}

static double coverage_of(Bench *bench, const Handwritten *written)
{
    Image image;
    handwritten_run(bench, written, &image);
    double coverage = image_coverage(&image);
    image_destroy(&image);
    return coverage;
}

/* Adds the shader by hand as it is, and with the largest error that covers what it should. */
static void add_handwritten(Bench *bench, Contest *contest, const Subject *subject)
{
    for (size_t i = 0; i < ERRORS && !contest->same_coverage; i++) {
        Handwritten *written = arena_new(bench->arena, Handwritten);
        handwritten_create(bench, written, contest->row->handwritten, &subject->view, errors[i]);
        double coverage = coverage_of(bench, written);
        bool   covers   = fabs(coverage_error(contest, coverage)) <= COVERAGE_TOLERANCE;
        if (i > 0 && !covers) {
            handwritten_destroy(bench, written);
            continue;
        }
        const Entry *entry     = add_written(bench, contest, written, subject);
        contest->same_error    = i == 0 ? entry : contest->same_error;
        contest->same_coverage = covers ? entry : NULL;
    }
}

/* ---- Pictures to compare with ---- */

static void draw_reference(Bench *bench, Contest *contest, Subject *subject, Image *reference)
{
    const KrsRenderOptions options = {.methods.trace    = KRS_TRACE_PLAIN,
                                      .methods.schedule = KRS_SCHEDULE_PIXEL,
                                      .methods.no_beams = true,
                                      .error            = REFERENCE_ERROR};
    KrsRenderStats         stats;
    subject_render(bench, subject, &options, &stats, reference);
    contest->reference_coverage            = image_coverage(reference);
    contest->reference_evaluations_per_ray = stats.evaluations_per_ray;
    contest->reference_unresolved          = stats.unresolved;
    if (!(contest->reference_coverage > 0))
        fail("%s: the picture is empty", contest->row->name);
}

/* Compares the shader by hand with the reference: it must be of the same scene. */
static void compare_geometry(Bench *bench, Contest *contest, const Subject *subject,
                             const Image *reference)
{
    Handwritten written;
    Image       image;
    handwritten_create(bench, &written, contest->row->handwritten, &subject->view, REFERENCE_ERROR);
    handwritten_run(bench, &written, &image);
    contest->geometry = image_compare(&image, reference, subject->pixel);
    image_destroy(&image);
    handwritten_destroy(bench, &written);
}

/* ---- Running ---- */

static void run_entry(Bench *bench, Subject *subject, Entry *entry, size_t repeat, Image *image)
{
    if (entry->written)
        entry->runs[repeat] = handwritten_run(bench, entry->written, image);
    else
        entry->runs[repeat] = subject_render(bench, subject, &entry->options, &entry->stats, image);
}

static void run_all(Bench *bench, Contest *contest, Subject *subject, const Image *reference)
{
    for (size_t repeat = 0; repeat < bench->repeats; repeat++)
        for (size_t i = 0; i < contest->count; i++) {
            Entry *entry = &contest->entries[i];
            bool   last  = repeat + 1 == bench->repeats;
            Image  image;
            run_entry(bench, subject, entry, repeat, last ? &image : NULL);
            if (!last)
                continue;
            entry->coverage  = image_coverage(&image);
            entry->agreement = image_compare(&image, reference, subject->pixel);
            entry->median    = times_median(entry->runs, bench->repeats);
            entry->least     = times_least(entry->runs, bench->repeats);
            image_destroy(&image);
        }
}

static void sum_up(Contest *contest, double pixels)
{
    for (size_t i = 0; i < contest->count; i++) {
        Entry *entry      = &contest->entries[i];
        entry->ns_per_ray = times_without_secondary(&entry->median) * 1e6 / pixels;
        if (entry->written)
            continue;
        const double *phase = entry->median.phase;
        double        flops = (double)entry->stats.evaluations * contest->flops_per_evaluation;
        entry->gflops       = flops / (phase[KRS_PHASE_BEAMS] + phase[KRS_PHASE_PRIMARY]) / 1e6;
        entry->evaluations_per_ray = entry->stats.evaluations_per_ray;
        entry->unresolved          = (double)entry->stats.unresolved;
    }
}

/* The first method first, while nothing is compiled yet. */
static void prewarm(Bench *bench, Contest *contest, Subject *subject)
{
    for (size_t i = 0; i < contest->methods; i++) {
        KrsRenderStats stats;
        subject_prewarm(bench, subject, &contest->entries[i].options, &stats);
        if (i > 0)
            continue;
        contest->entries[0].spirv_ms    = stats.spirv_ms;
        contest->entries[0].pipeline_ms = stats.pipeline_ms;
    }
}

void contest_run(Bench *bench, const SceneRow *row, Contest *contest)
{
    Subject subject;
    Image   reference;
    *contest = (Contest){.row = row, .entries = arena_new_array(bench->arena, Entry, MAX_ENTRIES)};
    tell("%s: compiling", row->name);
    subject_open(bench, &subject, row->path, row->levels);
    contest->flops_per_evaluation = subject.program->flops;
    add_methods(bench, contest);
    prewarm(bench, contest, &subject);
    tell("%s: pictures to compare with", row->name);
    draw_reference(bench, contest, &subject, &reference);
    compare_geometry(bench, contest, &subject, &reference);
    add_handwritten(bench, contest, &subject);
    tell("%s: %zu ways, %u times", row->name, contest->count, bench->repeats);
    run_all(bench, contest, &subject, &reference);
    sum_up(contest, (double)bench->width * bench->height);
    for (size_t i = contest->methods; i < contest->count; i++)
        handwritten_destroy(bench, contest->entries[i].written);
    image_destroy(&reference);
    subject_close(&subject);
}
