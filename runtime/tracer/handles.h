/*
 * handles.h: what stands behind the handles of krs_vulkan.h.  Their functions are in renderer.h,
 * rendering.h, kernels.h and film.h.
 */
#ifndef KRS_HANDLES_H
#define KRS_HANDLES_H

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

/* Where the rays of pixels come from, which kernels know when they are compiled. */
typedef enum RayKind {
    RAYS_OF_CAMERAS,   /* in perspective or orthographic */
    RAYS_OF_PANORAMAS, /* and of other cameras of their scenes */
    RAYS_OF_LISTS,     /* that the caller gives */
    RAY_KINDS
} RayKind;

/* How many numbers a texel has. */
typedef enum TexelKind { NO_TEXELS, ONE_NUMBER, TWO_NUMBERS, FOUR_NUMBERS, TEXEL_KINDS } TexelKind;

struct KrsRenderer {
    Gpu                   gpu;
    bool                  compiler_started;
    bool                  early_outs;                       /* of kernels that march */
    VkDescriptorSetLayout scene_layout;                     /* set 0: the scene's parameters */
    VkDescriptorSetLayout frame_layout;                     /* set 1: what frame.glsl declares */
    VkPipelineLayout      layout;                           /* of every kernel */
    Kernel                pixels[RAY_KINDS][PIXEL_KERNELS]; /* of cameras; others when needed */
    Kernel                next_dispatch;                    /* on graphics cards (dispatch.c) */
    double                spirv_ms, pipeline_ms;            /* of the former */
    VkDescriptorPool      idle_pool;                        /* to warm kernels up: */
    VkDescriptorSet       idle_scene, idle_frame;           /* with nothing in them, */
    Buffer                idle[TEXEL_KINDS];                /* all of it in these */
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

/* A film's band that the buffers of a rendering hold. */
typedef struct HeldBand {
    KrsFilm  *film;       /* NULL: none */
    uint32_t  from, rows; /* of the tiles that its crop has a part of */
    KrsWindow traced;     /* with its halo */
    bool      has_planes; /* those of the first sample are not in the film yet, */
    bool      has_colors; /* nor are all colours */
} HeldBand;

struct KrsRendering {
    KrsRenderer      *renderer;
    const KrsScene   *scene;
    const KrsProgram *program;
    KernelMap         kernels;
    uint32_t          zone_slots;      /* that kernels of this frame have for zones of the caller */
    uint32_t          most_zone_slots; /* the most that there are kernels for */
    bool              camera_relative; /* points of this frame are relative to the camera */
    KrsPurpose        purpose;
    RayKind           scene_rays; /* of the scene's own cameras */
    RayKind           rays;       /* of this frame */
    double            spirv_ms, pipeline_ms;

    VkDescriptorPool pool;
    VkDescriptorSet  scene_set, band_set, points_set;
    Buffer           parameters, frame, control;
    Buffer           inputs;         /* lights, and behind them rays of a list */
    Buffer           device_control; /* what kernels use of the control block, of which the host
                                         has a copy; none where they use the host's */
    Band             band;
    HeldBand         held;                               /* in it */
    Buffer           points, answers;                    /* of point_query.comp */
    Buffer           query_rays, ray_hits, taken;        /* of query.comp */
    uint32_t         groups_at_once[KRS_PHASE_COUNT][2]; /* learned from the last slices */
};

#endif
