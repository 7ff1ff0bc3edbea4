/*
 * shader.h: a compute shader of the bench itself: a text, one storage buffer, one int that is 0.
 */
#ifndef KRS_BENCH_SHADER_H
#define KRS_BENCH_SHADER_H

#include "bench/bench.h"
#include "runtime/device/buffer.h"
#include "runtime/device/driver.h"

typedef struct BenchShader {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout      layout;
    VkDescriptorPool      pool;
    VkDescriptorSet       set;
    VkPipeline            pipeline;
    double                spirv_ms, pipeline_ms; /* glslang's and the driver's time */
} BenchShader;

/* An included file, and the text that takes its place. */
typedef struct StandIn {
    const char *name, *text;
} StandIn;

/* Returns the text of a shader file with its includes: stand-ins (a last one without a name ends
   them), files of runtime/shaders, or files beside this one. */
char *bench_shader_text(Bench *bench, const char *path, const StandIn *stand_ins);

/* Compiles a text; `name` is used in messages.  The buffer is binding 1 (0 would be parameters of
   a scene, of which those of the bench have none) and must outlive the shader.  Runs one group
   once, so that drivers compile now what they put off. */
void bench_shader_create(Bench *bench, BenchShader *shader, const char *text, const char *name,
                         const Buffer *buffer);
void bench_shader_destroy(Bench *bench, BenchShader *shader);

/* Runs so many workgroups and waits; returns the milliseconds on the device. */
double bench_shader_run(Bench *bench, const BenchShader *shader, uint32_t groups);

#endif
