/*
 * krs.c: sequences, Moebius sequences and compounds of eight, with more and more levels, in turns.
 *
 * A tree as the papers' first program traced it, with what they added, and by default; a tree by
 * similarities and the same by Moebius stages; eight trees, side by side and grown into one
 * another, marched as one distance and apart; and what those are measured by: one sequence with as
 * many kernels.
 */
#include "bench/krs.h"

#include <math.h>

#include "bench/subject.h"

static const uint32_t all_levels[] = {4, 8, 14, 20, 28}, quick_levels[] = {4};

#define TREE     "bench/scenes/tree28.krs"
#define STRAIGHT "bench/scenes/straight.krs"
#define BENT     "bench/scenes/bent.krs"
#define BUNDLE   "bench/scenes/bundle.krs"
#define COMPOUND "bench/scenes/compound.krs"
#define THICKET  "bench/scenes/thicket.krs"
#define TOGETHER {.components = KRS_COMPONENTS_TOGETHER}
#define APART    {.components = KRS_COMPONENTS_APART}
#define BY_PIXEL .schedule = KRS_SCHEDULE_PIXEL
const StandRow stand_rows[STAND_COUNT] = {
    [STAND_TREE_STRAIGHTFORWARD] =
        {"tree, straightforward", TREE, 28, STAND_TREE_STRAIGHTFORWARD, 28,
         {.trace = KRS_TRACE_PLAIN, BY_PIXEL, .no_beams = true}},
    [STAND_TREE_BEAMS] = {"tree, the same and beams", TREE, 28, STAND_TREE_STRAIGHTFORWARD, 0,
                          {.trace = KRS_TRACE_PLAIN, BY_PIXEL}},
    [STAND_TREE]       = {"tree", TREE, 28, STAND_TREE_STRAIGHTFORWARD, 28, {0}},
    [STAND_STRAIGHT]   = {"similarities", STRAIGHT, 28, STAND_STRAIGHT, 28, {0}},
    [STAND_BENT_BINARY] = {"Moebius, binary", BENT, 28, STAND_STRAIGHT, 14,
                           {.trace = KRS_TRACE_BINARY, BY_PIXEL, .no_beams = true}},
    [STAND_BENT_PLAIN] = {"Moebius, straightforward", BENT, 28, STAND_STRAIGHT, 14,
                          {.trace = KRS_TRACE_PLAIN, BY_PIXEL, .no_beams = true}},
    [STAND_BENT]       = {"Moebius", BENT, 28, STAND_STRAIGHT, 14, {0}},
    [STAND_BUNDLE]     = {"eight kernels a level", BUNDLE, 28, STAND_BUNDLE, 0, {0}},
    [STAND_COMPOUND_TOGETHER] = {"eight trees, as one", COMPOUND, 14, STAND_BUNDLE, 0, TOGETHER},
    [STAND_COMPOUND]          = {"eight trees, apart", COMPOUND, 28, STAND_BUNDLE, 0, APART},
    [STAND_THICKET_TOGETHER]  = {"thicket, as one", THICKET, 14, STAND_BUNDLE, 0, TOGETHER},
    [STAND_THICKET]           = {"thicket, apart", THICKET, 14, STAND_BUNDLE, 0, APART},
};

double march_ms(const Times *times)
{
    const double *phase = times->phase;
    return phase[KRS_PHASE_BEAMS] + phase[KRS_PHASE_PRIMARY] + phase[KRS_PHASE_NORMALS];
}

/* One of them with some levels. */
typedef struct Runner {
    Subject          subject;
    KrsRenderOptions options;
    Times           *runs; /* NULL: it is left out */
} Runner;

static void set_out(Bench *bench, Runner *runner, const StandRow *row, uint32_t levels)
{
    KrsRenderStats stats;
    *runner = (Runner){.options = row->options};
    if (levels > row->most_levels)
        return;
    runner->options.error = PERMITTED_ERROR;
    runner->runs = arena_new_array(bench->arena, Times, bench->repeats);
    subject_open(bench, &runner->subject, row->path, levels);
    subject_warm_up(bench, &runner->subject, &runner->options, &stats);
}

static void run_once(Bench *bench, Sequences *sequences, Runner *runner, int stand, size_t at,
                     size_t turn)
{
    KrsRenderStats stats;
    Image          image;
    runner->runs[turn] = subject_render(bench, &runner->subject, &runner->options, &stats, &image);
    sequences->coverage[stand][at] = image_coverage(&image);
    sequences->evaluations[stand][at] = stats.evaluations_per_ray;
    sequences->flops[stand][at] = stats.flops_per_evaluation;
    sequences->unresolved += (double)stats.unresolved;
    image_destroy(&image);
}

static void run_levels(Bench *bench, Sequences *sequences, size_t at, uint32_t levels)
{
    Runner runners[STAND_COUNT];
    for (int i = 0; i < STAND_COUNT; i++)
        set_out(bench, &runners[i], &stand_rows[i], levels);
    for (size_t turn = 0; turn < bench->repeats; turn++)
        for (int i = 0; i < STAND_COUNT; i++)
            if (runners[i].runs)
                run_once(bench, sequences, &runners[i], i, at, turn);
    for (int i = 0; i < STAND_COUNT; i++) {
        sequences->ms[i][at] = NAN;
        if (!runners[i].runs)
            continue;
        Times times = times_median(runners[i].runs, bench->repeats);
        sequences->ms[i][at] = march_ms(&times);
        sequences->beams_ms[i][at] = times.phase[KRS_PHASE_BEAMS];
        subject_close(&runners[i].subject);
    }
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
    *sequences = (Sequences){.count = bench->quick ? sizeof quick_levels / sizeof quick_levels[0]
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
                             Text *complaints)
{
    for (size_t i = 0; i < sequences->count; i++) {
        double off = fabs(sequences->coverage[one][i] / sequences->coverage[other][i] - 1);
        if (!isnan(sequences->ms[one][i] + sequences->ms[other][i]) && !(off <= most))
            text_format(complaints, "%s, %.0f levels: coverage is off by %.3g, and may be %g\n",
                        stand_rows[one].name, sequences->levels[i], off, most);
    }
}

void sequences_judge(const Sequences *sequences, Text *complaints)
{
    compare_coverage(sequences, STAND_COMPOUND, STAND_COMPOUND_TOGETHER, 1e-3, complaints);
    compare_coverage(sequences, STAND_THICKET, STAND_THICKET_TOGETHER, 1e-3, complaints);
    compare_coverage(sequences, STAND_TREE_BEAMS, STAND_TREE_STRAIGHTFORWARD, 0.01, complaints);
    compare_coverage(sequences, STAND_TREE, STAND_TREE_STRAIGHTFORWARD, 0.01, complaints);
    compare_coverage(sequences, STAND_BENT, STAND_BENT_PLAIN, 0.01, complaints);
    if (sequences->unresolved > 0)
        text_format(complaints, "sequences and compounds: %.0f rays are unresolved\n",
                    sequences->unresolved);
}
