/*
 * peak.c: dispatches of multiply-adds, long enough to be timed.
 */
#include "bench/peak.h"

#include <math.h>

/* These equal the numbers of peak.comp. */
enum { ITERATIONS = 1024, STEPS_PER_ITERATION = 8, LANES = 64, VECTOR = 4 };

/* A dispatch lasts this long at least. */
static const double MIN_MS = 50;

static void compile(Bench *bench, Peak *peak, uint32_t chains)
{
    static const char path[] = "bench/peak.comp";
    Text              sizes  = {.arena = bench->arena};
    text_format(&sizes, "#define CHAINS %u\n#define ITERATIONS %d\n", chains, ITERATIONS);
    peak->chains = chains;
    bench_shader_create(
        bench, &peak->shader,
        bench_shader_text(bench, path, (StandIn[]){{"sizes.glsl", sizes.bytes}, {0}}), path,
        &peak->sums);
}

static double run(Bench *bench, Peak *peak)
{
    double ms = bench_shader_run(bench, &peak->shader, peak->groups);
    while (ms < MIN_MS && peak->groups < 1u << 15) {
        peak->groups *= 2;
        ms = bench_shader_run(bench, &peak->shader, peak->groups);
    }
    return 2.0 * VECTOR * peak->chains * STEPS_PER_ITERATION * ITERATIONS * LANES * peak->groups /
           ms / 1e6;
}

void peak_open(Bench *bench, Peak *peak)
{
    static const uint32_t chains[] = {2, 3, 4, 6, 8};
    uint32_t              best     = chains[0];
    *peak                          = (Peak){.groups = 64};
    if (!buffer_create(&bench->gpu, &peak->sums, sizeof(float[LANES][VECTOR]), ON_DEVICE, "sums"))
        fail("%s", bench->gpu.message);
    for (size_t i = 0; i < sizeof chains / sizeof chains[0]; i++) {
        compile(bench, peak, chains[i]);
        double gflops = run(bench, peak);
        if (gflops > peak->gflops) {
            peak->gflops = gflops;
            best         = chains[i];
        }
        bench_shader_destroy(bench, &peak->shader);
    }
    compile(bench, peak, best);
}

void peak_close(Bench *bench, Peak *peak)
{
    bench_shader_destroy(bench, &peak->shader);
    buffer_destroy(&bench->gpu, &peak->sums);
}

void peak_measure(Bench *bench, Peak *peak)
{
    for (int i = 0; i < 3; i++)
        peak->gflops = fmax(peak->gflops, run(bench, peak));
}
