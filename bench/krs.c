/*
 * krs.c: one sequence and compounds of eight, with more and more levels, in turns.
 *
 * A tree; eight trees, side by side and grown into one another, marched as one distance and apart;
 * and what they are measured by: one sequence with as many kernels.
 */
#include "bench/krs.h"

#include <math.h>

#include "bench/subject.h"

static const uint32_t all_levels[] = {4, 8, 12}, quick_levels[] = {4};

#define TOGETHER KRS_COMPONENTS_TOGETHER
#define APART    KRS_COMPONENTS_APART
const StandRow stand_rows[STAND_COUNT] = {
    [STAND_TREE]              = {"one tree", "bench/scenes/tree28.krs", TOGETHER},
    [STAND_BUNDLE]            = {"eight kernels a level", "bench/scenes/bundle.krs", TOGETHER},
    [STAND_COMPOUND_TOGETHER] = {"eight trees, as one", "bench/scenes/compound.krs", TOGETHER},
    [STAND_COMPOUND]          = {"eight trees, apart", "bench/scenes/compound.krs", APART},
    [STAND_THICKET_TOGETHER]  = {"thicket, as one", "bench/scenes/thicket.krs", TOGETHER},
    [STAND_THICKET]           = {"thicket, apart", "bench/scenes/thicket.krs", APART},
};

static double march_ms(const Times *times)
{
    const double *phase = times->phase;
    return phase[KRS_PHASE_BEAMS] + phase[KRS_PHASE_PRIMARY] + phase[KRS_PHASE_NORMALS];
}

static void run_levels(Bench *bench, Sequences *sequences, size_t at, uint32_t levels)
{
    Subject subjects[STAND_COUNT];
    Times  *runs[STAND_COUNT];
    for (int i = 0; i < STAND_COUNT; i++) {
        KrsRenderOptions options = {.components = stand_rows[i].components};
        KrsRenderStats   stats;
        subject_open(bench, &subjects[i], stand_rows[i].path, levels);
        subject_warm_up(bench, &subjects[i], &options, &stats);
        runs[i] = arena_new_array(bench->arena, Times, bench->repeats);
        sequences->flops[i][at] = stats.flops_per_evaluation;
    }
    for (size_t turn = 0; turn < bench->repeats; turn++)
        for (int i = 0; i < STAND_COUNT; i++) {
            KrsRenderOptions options = {.components = stand_rows[i].components,
                                        .error = PERMITTED_ERROR};
            KrsRenderStats   stats;
            Image            image;
            runs[i][turn] = subject_render(bench, &subjects[i], &options, &stats, &image);
            sequences->coverage[i][at] = image_coverage(&image);
            sequences->unresolved += (double)stats.unresolved;
            image_destroy(&image);
        }
    for (int i = 0; i < STAND_COUNT; i++) {
        Times times = times_median(runs[i], bench->repeats);
        sequences->ms[i][at] = march_ms(&times);
        subject_close(&subjects[i]);
    }
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
}

static void compare_coverage(const Sequences *sequences, Stand apart, Stand together,
                             Text *complaints)
{
    for (size_t i = 0; i < sequences->count; i++) {
        double off = fabs(sequences->coverage[apart][i] / sequences->coverage[together][i] - 1);
        if (!(off <= 1e-3))
            text_format(complaints, "%s, %.0f levels: coverage is off by %.3g, and may be 0.001\n",
                        stand_rows[apart].name, sequences->levels[i], off);
    }
}

void sequences_judge(const Sequences *sequences, Text *complaints)
{
    compare_coverage(sequences, STAND_COMPOUND, STAND_COMPOUND_TOGETHER, complaints);
    compare_coverage(sequences, STAND_THICKET, STAND_THICKET_TOGETHER, complaints);
    if (sequences->unresolved > 0)
        text_format(complaints, "sequences and compounds: %.0f rays are unresolved\n",
                    sequences->unresolved);
}
