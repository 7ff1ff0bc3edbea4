/*
 * shaders.c: what glslang and the driver take for each shader of a scene.
 */
#include <stdio.h>
#include <string.h>

#include "bench/device/device.h"
#include "runtime/tracer/methods.h"

static void print_shader(KrsRendering *rendering, const char *scene, const char *shader,
                         Shader *made, double *spirv_ms, double *pipeline_ms)
{
    double start = clock_ms();
    if (!made || !gpu_wait(&rendering->renderer->gpu)) /* some compile when a shader first runs */
        give_up(scene, krs_renderer_message(rendering->renderer));
    printf("| %s | %s | %.0f | %.0f |\n", scene, shader, rendering->spirv_ms - *spirv_ms,
           rendering->pipeline_ms - *pipeline_ms + clock_ms() - start);
    fflush(stdout);
    *spirv_ms    = rendering->spirv_ms;
    *pipeline_ms = rendering->pipeline_ms;
}

void print_shaders(KrsRenderer *renderer, const char *path)
{
    const char *name    = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    Fixture     fixture = {.name = path, .renderer = renderer};
    double      start = clock_ms(), spirv = renderer->spirv_ms, pipeline = renderer->pipeline_ms;
    KrsTrace    trace    = KRS_TRACE_DEFAULT;
    KrsSchedule schedule = KRS_SCHEDULE_DEFAULT;
    if (krs_compile_file(path, NULL, &fixture.scene) != KRS_OK ||
        krs_state_new(fixture.scene, &fixture.state) != KRS_OK)
        give_up(path, "it does not compile");
    printf("| %s | front end | %.0f | |\n", name, clock_ms() - start);
    if (krs_rendering_new(renderer, fixture.scene, KRS_FOR_QUESTIONS, &fixture.rendering))
        give_up(path, krs_renderer_message(renderer));
    KrsRendering *r = fixture.rendering;
    rendering_choose(r, &trace, &schedule);
    print_shader(r, name, "query, point query", rendering_point_query(r), &spirv, &pipeline);
    print_shader(r, name, "trace", rendering_trace(r, trace, schedule, 0), &spirv, &pipeline);
    print_shader(r, name, "normals", rendering_normals_shader(r, KRS_NORMALS_DEFAULT, 0), &spirv,
                 &pipeline);
    print_shader(r, name, "shadows, occlusion", rendering_secondary(r, schedule, false, false),
                 &spirv, &pipeline);
    print_shader(r, name, "shade", rendering_shade(r), &spirv, &pipeline);
    fixture_close(&fixture);
}
