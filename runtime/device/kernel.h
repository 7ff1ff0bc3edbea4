/*
 * kernel.h: compute shaders of runtime/shaders, made ready to run.
 */
#ifndef KRS_KERNEL_H
#define KRS_KERNEL_H

#include "compiler/passes/compile.h"
#include "runtime/device/gpu.h"

typedef struct Kernel {
    VkPipeline    pipeline;
    const char   *file; /* of runtime/shaders */
    uint32_t      march_group;
    size_t        glsl_bytes; /* 0: the program carries it as SPIR-V */
    bool          cached;     /* its SPIR-V was not compiled */
    double        spirv_ms, pipeline_ms;
    bool          prewarmed;
    uint32_t      prewarm; /* its number (gpu_prewarm_ms) */
    SharedKernel *shared;  /* whose pipeline it is, if others may use it as well */
} Kernel;

/* What a kernel calls of a scene: its text takes the place of "scene.glsl". */
typedef struct KernelScene {
    const KrsScene *scene;
    KrsVariant      variant;
    KrsFunction     wanted[KRS_FUNCTION_COUNT];
    size_t          wanted_count;
} KernelScene;

/* What a kernel is made from. */
typedef struct KernelSource {
    const char        *file;    /* of runtime/shaders */
    const KernelScene *scene;   /* NULL for a kernel without one */
    const char        *defines; /* lines of `#define NAME VALUE` that choose a variant, or NULL */
} KernelSource;

/* The text of a kernel: its includes in place, its defines after the `#version` line, and without
   comments, so that the cache knows a scene again that differs in them, in its name or folder.  The
   caller's to release; NULL with the failure noted. */
char *kernel_text(Gpu *gpu, const KernelSource *source);
/* Takes comments and blank lines out of a text in GLSL. */
void kernel_strip(char *text);

/* Compiles a kernel, or takes it from the cache, and adds the time it took. */
bool kernel_create(Gpu *gpu, Kernel *kernel, const KernelSource *source, VkPipelineLayout layout,
                   double *spirv_ms, double *pipeline_ms);

/* A kernel on its way to the device: SPIR-V, unless the device has it already. */
typedef struct KernelCode {
    const char   *file;
    uint32_t     *words;
    size_t        bytes;
    bool          compiled; /* just now: it was in no cache */
    uint32_t      march_group;
    size_t        glsl_bytes;
    double        ms;       /* processor time */
    SharedKernel *shared;   /* what the device has already: then there are no words */
    bool          to_share; /* others may use it */
    CacheKey      key;      /* of its text, then */
} KernelCode;

/* Of making kernels, how much is done when all are SPIR-V. */
#define COMPILED_PART 0.5

typedef struct KernelRequest {
    Kernel      *kernel; /* to be made */
    KernelSource source;
} KernelRequest;

/* The two halves of it: several kernels are compiled at the same time, and become pipelines of a
   device.  Codes are the caller's to release, in either case; a kernel that was not made is
   zero. */
bool kernel_compile_all(Gpu *gpu, const KernelRequest *requests, size_t count, KernelCode *codes,
                        double *spirv_ms);
bool kernel_load(Gpu *gpu, Kernel *kernel, const KernelCode *code, VkPipelineLayout layout,
                 double *pipeline_ms);
bool kernel_load_all(Gpu *gpu, const KernelRequest *requests, const KernelCode *codes, size_t count,
                     VkPipelineLayout layout);
/* What the driver has taken for a kernel so far. */
double kernel_driver_ms(const Gpu *gpu, const Kernel *kernel);
void   kernel_code_release(Gpu *gpu, KernelCode *code);

/* The same for several kernels, which are compiled at the same time.  On failure some may have
   been made: kernel_destroy in either case. */
bool kernel_create_all(Gpu *gpu, const KernelRequest *requests, size_t count,
                       VkPipelineLayout layout, double *spirv_ms, double *pipeline_ms);
void kernel_destroy(Gpu *gpu, Kernel *kernel);

#endif
