/*
 * kernel.h: compute shaders of runtime/shaders, made ready to run.
 */
#ifndef KRS_KERNEL_H
#define KRS_KERNEL_H

#include "runtime/device/gpu.h"

typedef struct Kernel {
    VkPipeline pipeline;
} Kernel;

/* The text of a kernel with its includes: "scene.glsl" is `scene`, every other one a file of
   runtime/shaders.  The caller's to release; NULL with the failure noted. */
char *kernel_text(Gpu *gpu, const char *file, const char *scene);

/* Compiles `file` of runtime/shaders for the scene (NULL for a kernel without one) and adds the
   time it took. */
bool kernel_create(Gpu *gpu, Kernel *kernel, const char *file, const char *scene,
                   VkPipelineLayout layout, double *spirv_ms, double *pipeline_ms);
void kernel_destroy(Gpu *gpu, Kernel *kernel);

#endif
