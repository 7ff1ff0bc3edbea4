/*
 * growth.c: one tree with more and more levels, in turns: its picture by the default method, and
 * its distance alone.
 *
 * With few levels there is little to be hit, and what a ray costs before its first evaluation is
 * most of its time; so the time by evaluations says less than that of the distance alone.
 */
#include "bench/growth.h"

#include <stdlib.h>

#include "bench/shader.h"
#include "bench/subject.h"

static const uint32_t all_sizes[] = {4, 8, 12, 16, 20, 24, 28}, quick_sizes[] = {4, 12, 20};

/* The numbers of distance.comp. */
enum { GROUPS = 1024, LANES = 64, EVALUATIONS = 128 };

typedef struct Tree {
    Subject        subject;
    BenchShader    distance;
    KrsRenderStats stats; /* of the last picture */
    Times         *pictures;
    double        *distances; /* milliseconds */
} Tree;

static void plant(Bench *bench, Tree *tree, uint32_t levels, const KrsRenderOptions *options,
                  const Buffer *ends)
{
    static const char path[] = "bench/distance.comp";
    tree->pictures           = arena_new_array(bench->arena, Times, bench->repeats);
    tree->distances          = arena_new_array(bench->arena, double, bench->repeats);
    subject_open(bench, &tree->subject, "bench/scenes/tree28.krs", levels);
    subject_prewarm(bench, &tree->subject, options, &tree->stats);
    Text sizes = {.arena = bench->arena};
    text_format(&sizes, "#define EVALUATIONS %d\n", EVALUATIONS);
    const KrsFunction wanted[] = {KRS_FUNCTION_DISTANCE};
    char *scene = krs_scene_text(tree->subject.scene, &(KrsVariant){0}, wanted, 1, NULL);
    if (!scene)
        fail("out of memory");
    char *text = bench_shader_text(
        bench, path, (StandIn[]){{"scene.glsl", scene}, {"sizes.glsl", sizes.bytes}, {0}});
    free(scene);
    bench_shader_create(bench, &tree->distance, text, path, ends);
}

static void take_figures(Bench *bench, Growth *growth, size_t i, Tree *tree)
{
    Times  times                 = times_median(tree->pictures, bench->repeats);
    double primary               = times.phase[KRS_PHASE_BEAMS] + times.phase[KRS_PHASE_PRIMARY];
    double distances             = (double)GROUPS * LANES * EVALUATIONS;
    growth->ns_per_distance[i]   = median(tree->distances, bench->repeats) * 1e6 / distances;
    growth->ns_per_evaluation[i] = primary * 1e6 / (double)tree->stats.evaluations;
    growth->total_ms[i]          = times_without_secondary(&times);
}

static void run_in_turns(Bench *bench, Tree *trees, size_t count, const KrsRenderOptions *options)
{
    for (size_t repeat = 0; repeat < bench->repeats; repeat++)
        for (size_t i = 0; i < count; i++) {
            Tree *tree              = &trees[i];
            tree->pictures[repeat]  = subject_render(bench, &tree->subject, options, &tree->stats,
                                                     NULL);
            tree->distances[repeat] = bench_shader_run(bench, &tree->distance, GROUPS);
        }
}

void growth_run(Bench *bench, Growth *growth)
{
    const uint32_t        *sizes            = bench->quick ? quick_sizes : all_sizes;
    const KrsRenderOptions options          = {.error = PERMITTED_ERROR};
    Tree                   trees[MAX_SIZES] = {0};
    Buffer                 ends;
    *growth = (Growth){.count = bench->quick ? sizeof quick_sizes / sizeof quick_sizes[0]
                                             : sizeof all_sizes / sizeof all_sizes[0]};
    tell("growth: compiling");
    if (!buffer_create(&bench->gpu, &ends, sizeof(float[GROUPS * LANES][4]), ON_DEVICE, "ends"))
        fail("%s", bench->gpu.message);
    for (size_t i = 0; i < growth->count; i++) {
        growth->levels[i] = sizes[i];
        plant(bench, &trees[i], sizes[i], &options, &ends);
    }
    tell("growth: %zu trees, %u times", growth->count, bench->repeats);
    run_in_turns(bench, trees, growth->count, &options);
    for (size_t i = 0; i < growth->count; i++) {
        take_figures(bench, growth, i, &trees[i]);
        bench_shader_destroy(bench, &trees[i].distance);
        subject_close(&trees[i].subject);
    }
    buffer_destroy(&bench->gpu, &ends);
    growth->distance_line   = line_through(growth->levels, growth->ns_per_distance, growth->count);
    growth->evaluation_line = line_through(growth->levels, growth->ns_per_evaluation,
                                           growth->count);
    growth->total_line      = line_through(growth->levels, growth->total_ms, growth->count);
}
