/*
 * render_stats.c: what `krs render --stats` prints of a frame.
 */
#include "cli/picture/render_stats.h"

#include <stdio.h>

#include "compiler/base/json.h"

static void add_stats_json(Json *json, const KrsRenderStats *stats, const KrsProgram *program)
{
    json_open(json, "compile", "{");
    json_rounded(json, "front", program->front_ms);
    json_rounded(json, "glsl", program->glsl_ms);
    json_rounded(json, "spirv", stats->spirv_ms);
    json_rounded(json, "pipeline", stats->pipeline_ms);
    json_open(json, "passes", "{");
    for (size_t i = 0; krs_pass(i); i++)
        json_rounded(json, krs_pass(i)->name, program->pass_ms[i]);
    json_close(json, "}");
    json_close(json, "}");
    json_open(json, "render", "{");
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        json_rounded(json, krs_phase_names[phase], stats->phase_ms[phase]);
    json_rounded(json, "total", stats->total_ms);
    json_rounded(json, "wall", stats->wall_ms);
    json_close(json, "}");
    json_truth(json, "device_time", stats->device_time);
    json_text(json, "executor", krs_executor_names[stats->executor]);
    json_whole(json, "rays", stats->rays);
    json_whole(json, "evaluations", stats->evaluations);
    json_open(json, "evaluations_per_ray", "{");
    json_rounded(json, "mean", stats->evaluations_per_ray);
    json_whole(json, "maximum", stats->max_evaluations_per_ray);
    json_close(json, "}");
    json_rounded(json, "flops_per_evaluation", stats->flops_per_evaluation);
    json_rounded(json, "gflops", stats->gflops);
    json_whole(json, "unresolved", stats->unresolved);
    json_whole(json, "clamped", stats->clamped);
    json_whole(json, "submissions", stats->submissions);
    json_text(json, "device", stats->device);
    json_whole(json, "peak_memory_bytes", stats->peak_memory_bytes);
}

/* The most shaders that statistics list: those of a picture are fewer. */
enum { MAX_SHADERS = 64 };

static size_t read_shaders(const KrsRendering *rendering, KrsShaderStats shaders[MAX_SHADERS])
{
    const size_t count = krs_rendering_shaders(rendering, shaders, MAX_SHADERS);
    return count < MAX_SHADERS ? count : MAX_SHADERS;
}

static void add_shaders_json(Json *json, const KrsRendering *rendering)
{
    KrsShaderStats shaders[MAX_SHADERS];
    const size_t   count = read_shaders(rendering, shaders);
    json_open(json, "kernels", "[");
    for (size_t i = 0; i < count; i++) {
        json_open(json, NULL, "{");
        json_text(json, "name", shaders[i].name);
        json_whole(json, "glsl_bytes", shaders[i].glsl_bytes);
        json_rounded(json, "spirv_ms", shaders[i].spirv_ms);
        json_rounded(json, "driver_ms", shaders[i].driver_ms);
        json_truth(json, "cached", shaders[i].cached);
        json_close(json, "}");
    }
    json_close(json, "]");
}

static void print_shaders(const KrsRendering *rendering)
{
    KrsShaderStats shaders[MAX_SHADERS];
    const size_t   count    = read_shaders(rendering, shaders);
    size_t         compiled = 0;
    double         spirv_ms = 0, driver_ms = 0;
    for (size_t i = 0; i < count; i++) {
        compiled += !shaders[i].cached;
        spirv_ms += shaders[i].spirv_ms;
        driver_ms += shaders[i].driver_ms;
    }
    printf("shaders        %zu, %zu compiled; one after the other SPIR-V %.1f ms, driver %.1f ms\n",
           count, compiled, spirv_ms, driver_ms);
}

static void print_stats(const KrsRenderStats *stats, const KrsProgram *program)
{
    printf("device         %s\n", stats->device);
    printf("compile        front end %.1f ms, GLSL %.1f ms, SPIR-V %.1f ms, pipelines %.1f ms\n",
           program->front_ms, program->glsl_ms, stats->spirv_ms, stats->pipeline_ms);
    printf("render         %.1f ms%s, %.1f ms in all:", stats->total_ms,
           stats->device_time ? " on the device" : "", stats->wall_ms);
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        printf(" %s %.1f", krs_phase_names[phase], stats->phase_ms[phase]);
    printf("\nexecutor       %s\n", krs_executor_names[stats->executor]);
    printf("rays           %llu, %llu evaluations, %.1f per ray, at most %u\n",
           (unsigned long long)stats->rays, (unsigned long long)stats->evaluations,
           stats->evaluations_per_ray, stats->max_evaluations_per_ray);
    printf("arithmetic     %.0f flops per evaluation, %.2f Gflop/s\n", stats->flops_per_evaluation,
           stats->gflops);
    printf(
        "unresolved     %llu\nclamped        %llu\nsubmissions    %llu\npeak memory    %.1f MiB\n",
        (unsigned long long)stats->unresolved, (unsigned long long)stats->clamped,
        (unsigned long long)stats->submissions, (double)stats->peak_memory_bytes / (1 << 20));
}

void render_stats_show(const Options *options, const KrsRendering *rendering,
                       const KrsProgram *program, const KrsRenderStats *stats, uint32_t frame)
{
    if (options->stats == STATS_TEXT)
        print_stats(stats, program);
    if (options->stats == STATS_TEXT)
        print_shaders(rendering);
    if (options->stats != STATS_JSON)
        return;
    Json json = {.text = {.arena = options->arena}, .spaced = true};
    json_open(&json, NULL, "{");
    if (options->animated)
        json_whole(&json, "frame", frame);
    add_stats_json(&json, stats, program);
    add_shaders_json(&json, rendering);
    json_close(&json, "}");
    puts(json.text.bytes);
}
