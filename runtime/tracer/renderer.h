/*
 * renderer.h: what stands behind the handles of krs_vulkan.h.
 */
#ifndef KRS_RENDERER_H
#define KRS_RENDERER_H

#include "compiler/compile.h"
#include "runtime/device/buffer.h"
#include "runtime/device/kernel.h"
#include "runtime/shared/blocks.h"

/* The kernels without a scene that do one thing for every pixel of a list, row or quarter of a
   tile: on lavapipe a kernel takes as long as all of its branches. */
typedef enum PixelKernel {
    PIXELS_BACKGROUND,
    PIXELS_UNPROVEN,
    PIXELS_PENUMBRAE,
    PIXELS_SHADOW,
    PIXELS_OCCLUSION,
    PIXEL_KERNELS
} PixelKernel;

/* How many numbers a texel has. */
typedef enum TexelKind { NO_TEXELS, ONE_NUMBER, TWO_NUMBERS, FOUR_NUMBERS, TEXEL_KINDS } TexelKind;

struct KrsRenderer {
    Gpu                   gpu;
    bool                  compiler_started;
    bool                  early_outs;          /* of kernels that march */
    VkDescriptorSetLayout scene_layout;        /* set 0: the scene's parameters */
    VkDescriptorSetLayout frame_layout;        /* set 1: what frame.glsl declares */
    VkPipelineLayout      layout;              /* of every kernel */
    Kernel           pixels[2][PIXEL_KERNELS]; /* [1]: for scenes with panoramas, when needed */
    Kernel           plan;                     /* on graphics cards (dispatch.c) */
    double           spirv_ms, pipeline_ms;    /* of the former */
    VkDescriptorPool idle_pool;                /* to warm kernels up: */
    VkDescriptorSet  idle_scene, idle_frame;   /* with nothing in them, */
    Buffer           idle[TEXEL_KINDS];        /* all of it in these */
};

/* The buffers that hold a band of the picture. */
typedef struct Band {
    uint64_t pixels; /* room for so many; 0: no buffers */
    Buffer   ends, hits, results, queue, taken, tiles;
    Buffer   fetched; /* where the host reads the results; none where it reads them directly */
} Band;

/* Instead of a march group: all but planes, which rays intersect without a march. */
enum { MARCH_WITHOUT_PLANES = 1 + KRS_MOST_MARCH_GROUPS };
/* And all, scene part by scene part within each ray. */
enum { MARCH_PACKED = 1 + MARCH_WITHOUT_PLANES, MARCH_KINDS };

/* The kernels with the scene in them, each made when it is first needed (kernels.c). */
typedef struct KernelEntry KernelEntry;
typedef struct KernelMap {
    KernelEntry *first;
} KernelMap;

struct KrsRendering {
    KrsRenderer      *renderer;
    const KrsScene   *scene;
    const KrsProgram *program;
    KernelMap         kernels;
    uint32_t          zone_slots;      /* that kernels of this frame have for zones of the caller */
    uint32_t          most_zone_slots; /* the most that there are kernels for */
    bool              camera_relative; /* points of this frame are relative to the camera */
    KrsPurpose        purpose;
    bool              panoramic; /* a camera of the scene is a panorama */
    double            spirv_ms, pipeline_ms;

    VkDescriptorPool pool;
    VkDescriptorSet  scene_set, band_set, points_set;
    Buffer           parameters, frame, control, lights;
    Buffer           device_control; /* what kernels use of the control block, of which the host
                                         has a copy; none where they use the host's */
    Band             band;
    Buffer           points, answers;                    /* of point_query.comp */
    Buffer           query_rays, ray_hits, taken;        /* of query.comp */
    uint32_t         groups_at_once[KRS_PHASE_COUNT][2]; /* learned from the last slices */
};

/* The kernel of primary rays for a method and a schedule (neither is the default), of a group of
   components, of all (0), or MARCH_WITHOUT_PLANES, compiled when it is first asked for.  NULL with
   the failure noted. */
Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* The same for beams, which need distances for all directions. */
Kernel *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* How many slots of values of the frame the host fills in: all, or none where the device has no
   room. */
uint32_t rendering_value_slots(const KrsRendering *rendering);
/* Whether rays go by what lies ahead of them (krs_along). */
bool rendering_goes_along(const KrsRendering *rendering, KrsTrace trace);
/* Whether there is a kernel of MARCH_WITHOUT_PLANES. */
bool rendering_knows_planes(const KrsRendering *rendering);
/* The normals that are meant: by derivatives where all is algebraic, else the octahedron's. */
KrsNormals rendering_normals(const KrsRendering *rendering, KrsNormals normals);
/* The kernel of normals, of a march group or of all (0). */
Kernel *rendering_normals_kernel(KrsRendering *rendering, KrsNormals normals, uint32_t march_group);
/* Whether primary rays by this method go from root to root.  Then so do secondary ones. */
bool rendering_has_roots(const KrsRendering *rendering, KrsTrace trace);
/* The kernel of rays to lights and for occlusion. */
Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots);
Kernel *rendering_query(KrsRendering *rendering, KrsSchedule schedule);
/* Likewise. */
Kernel *rendering_shade(KrsRendering *rendering);
Kernel *rendering_point_query(KrsRendering *rendering);
/* Puts what `make bench` found fastest for such a scene on such a device where the default is
   asked for. */
void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule);
/* As many steps as are wanted of a lane in a dispatch, or as many as may be. */
uint32_t rendering_steps_within(const KrsRendering *rendering, uint32_t wanted);
/* The schedule for the rays of a group that is marched by itself. */
KrsSchedule rendering_schedule_of_march_group(const KrsRendering *rendering, KrsSchedule asked,
                                              uint32_t march_group);
/* Whether groups of components are marched one after the other, where that can be. */
bool rendering_marches_per_component(const KrsRendering *rendering, KrsComponents components);
/* Whether rays march by this method part by part, where that can be. */
bool rendering_marches_packed(const KrsRendering *rendering, KrsComponents components,
                              KrsTrace trace);
/* Copies the frame's parameters and zones to the device, and chooses the kernels for them. */
bool rendering_set_parameters(KrsRendering *rendering, const KrsFrame *frame);
/* After it: points are relative to this origin from now on; chooses the kernels for that. */
bool rendering_rebase(KrsRendering *rendering, KrsFrame *frame, const double rebase_origin[3]);
/* A step through [0, count) that visits all and goes far each time, so that neighbours, which cost
   alike, are spread over a device that assigns contiguous ranges. */
uint32_t rendering_spread(const KrsRendering *rendering, uint32_t count);
/* Copies the lights of a frame to the device, relative to an origin. */
bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count,
                          const double rebase_origin[3]);
/* Points a binding of set 1 at a buffer. */
void rendering_bind(KrsRendering *rendering, VkDescriptorSet set, uint32_t binding,
                    const Buffer *buffer);
/* As gpu_begin and gpu_finish: with what the control block says, and then counts. */
bool rendering_begin(KrsRendering *rendering);
bool rendering_finish(KrsRendering *rendering, double *ms);
/* The control block that kernels use. */
const Buffer *rendering_control(const KrsRendering *rendering);
/* Records that a kernel runs with these push constants on `groups` workgroups. */
void rendering_dispatch(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                        const void *work, uint32_t work_bytes, uint32_t groups);
/* The same on as many as the control block says (`groups`). */
void rendering_dispatch_counted(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                                const void *work, uint32_t work_bytes);
/* The most workgroups of a dispatch on any device. */
enum { MOST_GROUPS = 65535 };
/* ---- point_query.c ---- */
enum { POINTS_AT_ONCE = 16384 };
/* Makes room for that many points, and their answers. */
bool point_query_prepare(KrsRendering *rendering);
/* What is at the first `count` of them; with normals, or the distance alone. */
bool point_query_run(KrsRendering *rendering, uint32_t count, bool normals);

/* ---- query.c ---- */
/* Whether what the device says of `count` rays can be used: each has missed, or has its own place
   among the `ends` of rays. */
bool ray_hits_are_valid(const RayHitBlock *ray_hits, uint32_t count, uint32_t ends);

/* Makes the kernels for panoramas, unless they are there. */
bool renderer_create_panoramic(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms);
/* Forgets the message of the call before. */
void renderer_clear(KrsRenderer *renderer);

#endif
