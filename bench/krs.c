/*
 * krs.c: sequences, Moebius sequences and compounds of eight, with more and more levels, in turns.
 *
 * A tree as the papers' first program traced it, with what they added, and by default; a tree by
 * similarities and the same by Moebius stages, with each tracer; eight trees, side by side and
 * grown into one another, marched as one distance and apart; and what those are measured by: one
 * sequence with as many kernels, that covers as much.
 */
#include "bench/krs.h"

#include <math.h>
#include <string.h>

#include "bench/subject.h"

static const uint32_t all_levels[] = {4, 8, 14, 20, 28}, quick_levels[] = {4};

#define TREE     "bench/scenes/tree28.krs"
#define STRAIGHT "bench/scenes/straight.krs"
#define BENT     "bench/scenes/bent.krs"
#define BUNDLE   "bench/scenes/bundle.krs"
#define NEAR     "bench/scenes/bundle-near.krs"
#define COMPOUND "bench/scenes/compound.krs"
#define THICKET  "bench/scenes/thicket.krs"
#define TOGETHER                                      \
    {                                                 \
        .methods.components = KRS_COMPONENTS_TOGETHER \
    }
#define PACKED                                      \
    {                                               \
        .methods.components = KRS_COMPONENTS_PACKED \
    }
#define APART                                      \
    {                                              \
        .methods.components = KRS_COMPONENTS_APART \
    }
#define BY_PIXEL .methods.schedule = KRS_SCHEDULE_PIXEL
const StandRow stand_rows[STAND_COUNT] = {
    [STAND_TREE_STRAIGHTFORWARD] = {"tree, straightforward",
                                    TREE,
                                    28,
                                    STAND_TREE_STRAIGHTFORWARD,
                                    {.methods.trace = KRS_TRACE_PLAIN,
                                     BY_PIXEL,
                                     .methods.no_beams = true}},
    [STAND_TREE_BEAMS]           = {"tree, the same and beams",
                                    TREE,
                                    28,
                                    STAND_TREE_STRAIGHTFORWARD,
                                    {.methods.trace = KRS_TRACE_PLAIN, BY_PIXEL}},
    [STAND_TREE]                 = {"tree", TREE, 28, STAND_TREE_STRAIGHTFORWARD, {0}},
    [STAND_STRAIGHT]             = {"similarities", STRAIGHT, 28, STAND_STRAIGHT, {0}},
    [STAND_BENT_STRAIGHTFORWARD] = {"Moebius, straightforward",
                                    BENT,
                                    28,
                                    STAND_STRAIGHT,
                                    {.methods.trace = KRS_TRACE_BINARY,
                                     BY_PIXEL,
                                     .methods.no_beams = true}},
    [STAND_BENT_BINARY] =
        {"Moebius, binary", BENT, 28, STAND_STRAIGHT, {.methods.trace = KRS_TRACE_BINARY}},
    [STAND_BENT_PREDICTED] =
        {"Moebius, predicted", BENT, 28, STAND_STRAIGHT, {.methods.trace = KRS_TRACE_PREDICTED}},
    [STAND_BENT_DIRECTIONAL] = {"Moebius, directional",
                                BENT,
                                28,
                                STAND_STRAIGHT,
                                {.methods.trace = KRS_TRACE_DIRECTIONAL}},
    [STAND_BENT_PLAIN] =
        {"Moebius, centred", BENT, 28, STAND_STRAIGHT, {.methods.trace = KRS_TRACE_PLAIN}},
    [STAND_BENT]              = {"Moebius", BENT, 28, STAND_STRAIGHT, {0}},
    [STAND_BUNDLE]            = {"eight kernels a level", BUNDLE, 28, STAND_BUNDLE, {0}},
    [STAND_COMPOUND_TOGETHER] = {"eight trees, as one", COMPOUND, 14, STAND_BUNDLE, TOGETHER},
    [STAND_COMPOUND_PACKED]   = {"eight trees, packed", COMPOUND, 8, STAND_BUNDLE, PACKED},
    [STAND_COMPOUND]          = {"eight trees, apart", COMPOUND, 28, STAND_BUNDLE, APART},
    [STAND_BUNDLE_NEAR]       = {"the same from nearer", NEAR, 14, STAND_BUNDLE_NEAR, {0}},
    [STAND_THICKET_TOGETHER]  = {"thicket, as one", THICKET, 14, STAND_BUNDLE_NEAR, TOGETHER},
    [STAND_THICKET_PACKED]    = {"thicket, packed", THICKET, 8, STAND_BUNDLE_NEAR, PACKED},
    [STAND_THICKET]           = {"thicket, apart", THICKET, 14, STAND_BUNDLE_NEAR, APART},
};

const PaperRow paper_rows[PAPER_ROWS] = {
    {"1: single, a pixel shader", STAND_TREE_STRAIGHTFORWARD, 28, PAPER_KILOFLOPS},
    {"3: Moebius, binary", STAND_BENT_STRAIGHTFORWARD, 14, PAPER_KILOFLOPS},
    {"3: Moebius, our default", STAND_BENT, 14, PAPER_KILOFLOPS},
    {"4: single, low resolution first", STAND_TREE, 28, PAPER_KILOFLOPS / PAPER_SPEEDUP},
};

double paper_row_ours(const Bench *bench, const Sequences *sequences, const PaperRow *row,
                      double peak_gflops)
{
    for (size_t i = 0; i < sequences->count; i++)
        if (sequences->levels[i] == row->levels)
            return sequences->ms[row->stand][i] * 1e3 * peak_gflops /
                   ((double)bench->width * bench->height);
    return NAN;
}

double march_ms(const Times *times)
{
    const double *phase = times->phase;
    return phase[KRS_PHASE_BEAMS] + phase[KRS_PHASE_PRIMARY] + phase[KRS_PHASE_NORMALS];
}

/* One of them with some levels. */
typedef struct Runner {
    Subject         *subject; /* of all with the same scene */
    KrsRenderOptions options;
    Times           *runs; /* NULL: it is left out */
} Runner;

static Subject *find_subject(Bench *bench, const Runner *runners, int stand, uint32_t levels)
{
    const char *path = stand_rows[stand].path;
    for (int i = 0; i < stand; i++)
        if (runners[i].runs && strcmp(stand_rows[i].path, path) == 0)
            return runners[i].subject;
    Subject *subject = arena_new(bench->arena, Subject);
    subject_open(bench, subject, path, levels);
    return subject;
}

static void set_out(Bench *bench, Runner *runners, int stand, uint32_t levels)
{
    const StandRow *row    = &stand_rows[stand];
    Runner         *runner = &runners[stand];
    KrsRenderStats  stats;
    *runner = (Runner){.options = row->options};
    if (levels > row->max_levels)
        return;
    runner->options.error        = PERMITTED_ERROR;
    runner->options.no_occlusion = true; /* which is not told either */
    runner->subject              = find_subject(bench, runners, stand, levels);
    runner->runs                 = arena_new_array(bench->arena, Times, MAX_REPEATS);
    subject_prewarm(bench, runner->subject, &runner->options, &stats);
}

static void close_subjects(Runner *runners)
{
    for (int i = 0; i < STAND_COUNT; i++) {
        Subject *subject = runners[i].runs ? runners[i].subject : NULL;
        if (subject && subject->scene) /* not closed yet */
            subject_close(subject);
    }
}

static void run_once(Bench *bench, Sequences *sequences, Runner *runner, int stand, size_t at,
                     size_t repeat)
{
    KrsRenderStats stats;
    Image          image;
    runner->runs[repeat] = subject_render(bench, runner->subject, &runner->options, &stats, &image);
    sequences->coverage[stand][at]    = image_coverage(&image);
    sequences->evaluations[stand][at] = stats.evaluations_per_ray;
    sequences->flops[stand][at]       = stats.flops_per_evaluation;
    sequences->unresolved += (double)stats.unresolved;
    image_destroy(&image);
}

static void run_levels(Bench *bench, Sequences *sequences, size_t at, uint32_t levels)
{
    Runner runners[STAND_COUNT];
    for (int i = 0; i < STAND_COUNT; i++)
        set_out(bench, runners, i, levels);
    for (size_t repeat = 0; repeat < sequences->repeats; repeat++)
        for (int i = 0; i < STAND_COUNT; i++)
            if (runners[i].runs)
                run_once(bench, sequences, &runners[i], i, at, repeat);
    for (int i = 0; i < STAND_COUNT; i++) {
        sequences->ms[i][at] = NAN;
        if (!runners[i].runs)
            continue;
        Times times                = times_median(runners[i].runs, sequences->repeats);
        sequences->ms[i][at]       = march_ms(&times);
        sequences->beams_ms[i][at] = times.phase[KRS_PHASE_BEAMS];
        sequences->cpu_ms[i][at]   = times.cpu;
    }
    close_subjects(runners);
}

static Line line_of(const Sequences *sequences, int stand)
{
    size_t count = 0; /* those that are left out are the last ones */
    while (count < sequences->count && !isnan(sequences->ms[stand][count]))
        count++;
    return line_through(sequences->levels, sequences->ms[stand], count);
}

void sequences_run(Bench *bench, Sequences *sequences)
{
    const uint32_t *levels = bench->quick ? quick_levels : all_levels;
    *sequences = (Sequences){.repeats = bench->repeats < MAX_REPEATS ? bench->repeats : MAX_REPEATS,
                             .count   = bench->quick ? sizeof quick_levels / sizeof quick_levels[0]
                                                     : sizeof all_levels / sizeof all_levels[0]};
    for (size_t i = 0; i < sequences->count; i++) {
        tell("sequences and compounds of %u levels", levels[i]);
        sequences->levels[i] = levels[i];
        run_levels(bench, sequences, i, levels[i]);
    }
    for (int i = 0; i < STAND_COUNT; i++)
        sequences->lines[i] = line_of(sequences, i);
}

static void compare_coverage(const Sequences *sequences, Stand one, Stand other, double most,
                             Text *faults)
{
    for (size_t i = 0; i < sequences->count; i++) {
        double off = fabs(sequences->coverage[one][i] / sequences->coverage[other][i] - 1);
        if (!isnan(sequences->ms[one][i] + sequences->ms[other][i]) && !(off <= most))
            text_format(faults, "%s, %.0f levels: coverage is off by %.3g, and may be %g\n",
                        stand_rows[one].name, sequences->levels[i], off, most);
    }
}

void sequences_judge(const Sequences *sequences, Text *faults)
{
    compare_coverage(sequences, STAND_COMPOUND, STAND_COMPOUND_TOGETHER, 1e-3, faults);
    compare_coverage(sequences, STAND_COMPOUND_PACKED, STAND_COMPOUND_TOGETHER, 1e-3, faults);
    compare_coverage(sequences, STAND_THICKET, STAND_THICKET_TOGETHER, 1e-3, faults);
    compare_coverage(sequences, STAND_THICKET_PACKED, STAND_THICKET_TOGETHER, 1e-3, faults);
    compare_coverage(sequences, STAND_TREE_BEAMS, STAND_TREE_STRAIGHTFORWARD, 0.01, faults);
    compare_coverage(sequences, STAND_TREE, STAND_TREE_STRAIGHTFORWARD, 0.01, faults);
    compare_coverage(sequences, STAND_BENT, STAND_BENT_PLAIN, 0.01, faults);
    if (sequences->unresolved > 0)
        text_format(faults, "sequences and compounds: %.0f rays are unresolved\n",
                    sequences->unresolved);
}
