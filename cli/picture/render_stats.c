/*
 * render_stats.c: what `krs render --stats` prints of a frame.
 */
#include "cli/picture/render_stats.h"

#include <stdio.h>

static void add_stats_json(Text *json, const KrsRenderStats *stats, const KrsProgram *program)
{
    text_format(json,
                "\"compile\": {\"front\": %.3f, \"glsl\": %.3f, \"spirv\": %.3f, "
                "\"pipeline\": %.3f, \"passes\": {",
                program->front_ms, program->glsl_ms, stats->spirv_ms, stats->pipeline_ms);
    for (size_t i = 0; krs_pass(i); i++)
        text_format(json, "%s\"%s\": %.3f", i ? ", " : "", krs_pass(i)->name, program->pass_ms[i]);
    text_add(json, "}}, \"render\": {");
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        text_format(json, "\"%s\": %.3f, ", krs_phase_names[phase], stats->phase_ms[phase]);
    text_format(json,
                "\"total\": %.3f, \"wall\": %.3f}, \"device_time\": %s, \"executor\": \"%s\", "
                "\"rays\": %llu, "
                "\"evaluations\": %llu, \"evaluations_per_ray\": {\"mean\": %.3f, "
                "\"maximum\": %u}, \"flops_per_evaluation\": %.3f, \"gflops\": %.3f, "
                "\"unresolved\": %llu, \"clamped\": %llu, \"submissions\": %llu, \"device\": ",
                stats->total_ms, stats->wall_ms, stats->device_time ? "true" : "false",
                krs_executor_names[stats->executor], (unsigned long long)stats->rays,
                (unsigned long long)stats->evaluations, stats->evaluations_per_ray,
                stats->max_evaluations_per_ray, stats->flops_per_evaluation, stats->gflops,
                (unsigned long long)stats->unresolved, (unsigned long long)stats->clamped,
                (unsigned long long)stats->submissions);
    text_json(json, stats->device);
    text_format(json, ", \"peak_memory_bytes\": %llu",
                (unsigned long long)stats->peak_memory_bytes);
}

/* The most shaders that statistics list: those of a picture are fewer. */
enum { MAX_SHADERS = 64 };

static size_t read_shaders(const KrsRendering *rendering, KrsShaderStats shaders[MAX_SHADERS])
{
    const size_t count = krs_rendering_shaders(rendering, shaders, MAX_SHADERS);
    return count < MAX_SHADERS ? count : MAX_SHADERS;
}

static void add_shaders_json(Text *json, const KrsRendering *rendering)
{
    KrsShaderStats shaders[MAX_SHADERS];
    const size_t   count = read_shaders(rendering, shaders);
    text_add(json, ", \"kernels\": [");
    for (size_t i = 0; i < count; i++)
        text_format(json,
                    "%s{\"name\": \"%s\", \"glsl_bytes\": %llu, \"spirv_ms\": %.3f, "
                    "\"driver_ms\": %.3f, \"cached\": %s}",
                    i ? ", " : "", shaders[i].name, (unsigned long long)shaders[i].glsl_bytes,
                    shaders[i].spirv_ms, shaders[i].driver_ms,
                    shaders[i].cached ? "true" : "false");
    text_add(json, "]");
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
    Text json = {.arena = options->arena};
    text_add(&json, "{");
    if (options->animated)
        text_format(&json, "\"frame\": %u, ", frame);
    add_stats_json(&json, stats, program);
    add_shaders_json(&json, rendering);
    text_add(&json, "}");
    puts(json.bytes);
}
