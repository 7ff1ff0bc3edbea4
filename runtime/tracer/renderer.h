/*
 * renderer.h: what stands behind the handles of krs_vulkan.h.
 */
#ifndef KRS_RENDERER_H
#define KRS_RENDERER_H

#include "compiler/compile.h"
#include "runtime/device/buffer.h"
#include "runtime/device/kernel.h"
#include "runtime/tracer/blocks.h"

struct KrsRenderer {
    Gpu                   gpu;
    bool                  compiler_started;
    VkDescriptorSetLayout scene_layout; /* set 0: the scene's parameters */
    VkDescriptorSetLayout frame_layout; /* set 1: what frame.glsl declares */
    VkPipelineLayout      layout;       /* of every kernel */
    Kernel                background, fill, shade;
    double                spirv_ms, pipeline_ms; /* of these three */
    VkDescriptorPool      idle_pool;             /* for rehearsals: */
    VkDescriptorSet       idle_set;              /* a frame with nothing in it, */
    Buffer                idle;                  /* all of it in here */
};

/* The buffers that hold a band of the picture. */
typedef struct Band {
    uint64_t pixels; /* room for so many; 0: no buffers */
    Buffer   ends, fates, hits, results, queue, taken, tiles;
    Buffer   fetched; /* where the host reads the results */
} Band;

struct KrsRendering {
    KrsRenderer      *renderer;
    const KrsScene   *scene;
    const KrsProgram *program;
    Kernel            material;
    Kernel            sample; /* when first needed, as the variants of these: */
    Kernel            trace[KRS_TRACE_COUNT][KRS_SCHEDULE_COUNT], secondary[KRS_SCHEDULE_COUNT];
    double            spirv_ms, pipeline_ms;

    VkDescriptorPool  pool;
    VkDescriptorSet   scene_set, band_set, points_set;
    Buffer            parameters, frame, control, lights;
    Band              band;
    Buffer            points, answers; /* of krs_sample */
    uint32_t          groups_at_once[KRS_PHASE_COUNT][2]; /* learned from the last slices */
};

/* The kernels of primary and secondary rays for a method and a schedule (neither is the default),
   compiled when they are first asked for.  NULL with the failure noted. */
Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule);
Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule);
/* Puts what `make bench` found fastest for such a scene on such a device where the default is
   asked for. */
void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule);
/* Copies the values of the frame's parameters to the device. */
bool rendering_set_parameters(KrsRendering *rendering, const KrsFrame *frame);
/* Copies the lights of a frame to the device. */
bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count);
/* Points a binding of set 1 at a buffer. */
void rendering_bind(KrsRendering *rendering, VkDescriptorSet set, uint32_t binding,
                    const Buffer *buffer);
/* Records that a kernel runs with these push constants on `groups` workgroups. */
void rendering_dispatch(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                        const void *work, uint32_t work_bytes, uint32_t groups);
/* Forgets the message of the call before. */
void renderer_clear(KrsRenderer *renderer);

#endif
