/*
 * handles.h: the structs behind the handles of krs/vulkan.h, except KrsFilm (film/resident.h).
 * Functions for them are in renderer.h, rendering.h and shaders.h.
 */
#ifndef KRS_HANDLES_H
#define KRS_HANDLES_H

#include "compiler/passes/compile.h"
#include "runtime/device/buffer.h"
#include "runtime/device/sets.h"
#include "runtime/device/shader.h"
#include "runtime/shared/blocks.h"

/* The shaders without a scene, each with one task for every item of a list: a pixel, or a quarter
   of a tile.  Each task has its own shader because lavapipe executes all branches of a shader. */
typedef enum PixelShader {
    PIXELS_BACKGROUND,
    PIXELS_BACKGROUND_OF_MAP, /* where the sky is a picture */
    PIXELS_UNPROVEN,
    PIXELS_PENUMBRAE,
    PIXELS_SHADOW,
    PIXELS_OCCLUSION,
    PIXEL_SHADERS
} PixelShader;

/* Says where the rays of pixels come from.  Each kind has its own shaders.  Those of a kind of
   camera serve the kinds of cameras before it as well. */
typedef enum RayKind {
    RAYS_OF_CAMERAS,   /* perspective or orthographic */
    RAYS_OF_PANORAMAS, /* and all other cameras of a scene with a panorama */
    RAYS_OF_LENSES,    /* cameras with an aperture, a shift or two eyes */
    RAYS_OF_LISTS,     /* given by the caller */
    RAYS_OF_PATHS,     /* from where a path was scattered */
    RAY_KINDS
} RayKind;

/* The fields that lanes of the host ask (lane_fields.h); zero: nothing is kept. */
typedef struct LaneFields {
    uint64_t             stamp;  /* of the values that they are of (krs_state_stamp) */
    bool                 planes; /* which rays meet at once, are left out of the distance */
    struct RayField     *rays;
    struct SurfaceField *surfaces;
} LaneFields;

/* Milliseconds of a sample of a pixel, by lanes and by shaders, of compilers, and what lanes have taken longer than shaders
   would have: `lost` by this process, `lost_before` by others, as the cache knows by the key. */
typedef struct LaneTimes {
    bool     known;
    bool     keeps; /* the cache is to have what is lost, as it does not have the shaders */
    double   lanes, shaders, compile, lost, lost_before;
    CacheKey key;
} LaneTimes;

/* Shaders that are made while the host does other work (prewarm_thread.c). */
typedef struct PrewarmThread PrewarmThread;

struct KrsRenderer {
    Gpu            gpu;
    PrewarmThread *prewarm; /* NULL: none are made at the moment */
    KrsRendering  *first;   /* of its renderings */
    uint32_t  losses; /* how often the device was opened anew: its slices are halved as often */
    bool      compiler_started;
    bool      early_outs;   /* shaders skip far shapes by branches */
    SetLayout scene_layout; /* set 0: the scene's parameters and tables */
    SetLayout frame_layout; /* set 1: what frame.glsl declares */
    Handle    layout;       /* shared by all shaders */
    /* Each is made when it is needed, with the shaders of the first scene that needs it. */
    Shader pixels[RAY_KINDS][PIXEL_SHADERS];
    /* aim.comp and arrive.comp; [1]: paths have such rays, too. */
    Shader   aims[RAYS_OF_LISTS][2], arrivals[2];
    Shader   limits[RAY_KINDS];     /* limit.comp, made when it is needed */
    Shader   escapes[RAY_KINDS];    /* escape.comp, made when paths are traced */
    Shader   escapes_to_plate;      /* the same for paths that may meet a plate */
    Shader   noise;                 /* noise.comp, likewise */
    Shader   plate;                 /* plate.comp, likewise */
    Shader   next_dispatch;         /* on graphics cards only (dispatch.c), */
    Shader   clear_shared;          /* and likewise */
    double   spirv_ms, pipeline_ms; /* the time to make these shaders */
    Buffer   work;                  /* the blocks of dispatches, each in a slot */
    uint32_t work_slot;             /* the last that was written */
    /* Sets for prewarming, in which a shader finds no items, and the buffers of zeros that they
       bind. */
    Handle idle_pool;
    Handle idle_scene, idle_frame;
    Buffer idle[TEXEL_KINDS];
};

/* The buffers that hold a band of the picture. */
typedef struct Band {
    uint64_t pixels;       /* the most that fit; 0: there are no buffers */
    uint32_t path_rows;    /* of the path of each, and of rays of its hit */
    uint32_t lights;       /* for whose light there are rows of results */
    uint32_t surface_rows; /* of each hit, that the host finds */
    bool     has_noise;    /* there are words of the quarters of tiles whose pixels have rays, */
    uint32_t sampled_at;   /* from here on in `tiles` */
    Buffer   ends, hits, results, queue, taken, tiles, surfaces;
    /* A copy of the results for the host; none where the host reads `results` directly. */
    Buffer fetched;
} Band;

/* Stands in place of a march group's number, for all components but planes, which rays intersect
   without a march. */
enum { MARCH_WITHOUT_PLANES = 1 + KRS_MAX_MARCH_GROUPS };
/* Stands likewise for all components, which each ray marches scene part by scene part
   (packed.glsl). */
enum { MARCH_PACKED = 1 + MARCH_WITHOUT_PLANES, MARCH_KINDS };

/* The shaders that contain functions of the scene, each made when it is first needed
   (shaders.c). */
typedef struct ShaderEntry ShaderEntry;
typedef struct ShaderMap {
    ShaderEntry *first;
} ShaderMap;

/* The band of a film whose samples are in the buffers of a rendering. */
typedef struct ResidentBand {
    KrsFilm  *film;       /* NULL: none */
    uint32_t  from, rows; /* of pixels, from the first tile of the crop on */
    KrsWindow traced;     /* the band with its halo */
    bool      has_aovs;   /* the film still lacks the AOVs of its first sample */
    bool      has_colors; /* the film still lacks some colours */
} ResidentBand;

struct KrsRendering {
    KrsRenderer      *renderer;
    KrsRendering     *next; /* of the renderer */
    const KrsScene   *scene;
    const KrsProgram *program;
    uint32_t          updates; /* how often it was taken over to another scene */
    ShaderMap         shaders;
    /* The number of the caller's zones that shaders of this frame have room for. */
    uint32_t zone_slots;
    /* The largest number that any shaders have room for. */
    uint32_t   max_zone_slots;
    bool       camera_relative; /* this frame's points are relative to the camera */
    KrsPurpose purpose;         /* KRS_FOR_FIRST_PICTURES is KRS_FOR_PICTURES, deferred */
    bool       defers;          /* shaders of a scene are made when a picture needs them */
    bool       deferred;        /* they have not been made so far (film/executor.h) */
    RayKind    scene_rays;      /* the kind for the scene's own cameras */
    RayKind    rays;            /* the kind for this frame */
    bool       snaps;           /* this frame's hits are snapped, as those of paths */
    bool       catches;         /* this frame's plate catches shadows */
    double     spirv_ms, pipeline_ms;

    Handle pool;
    Handle scene_set, band_set, points_set;
    Buffer parameters, frame, control;
    Buffer table_rows, table_cells; /* krs_state_tables; none where there are no tables */
    double (*table_inputs)
        [4]; /* krs_state_table_inputs of those on the device; NULL: there are none yet */
    Buffer   sky_table;         /* sky_table.h; none for other skies */
    uint64_t sky_version;       /* of the map in it */
    double   sky_irradiance;    /* by half of it, on the average */
    uint32_t (*volume_rows)[4]; /* volumes.h: of the state with this stamp; NULL: of none */
    size_t   volume_count;
    uint64_t volume_stamp;
    Buffer   inputs; /* lights, then the rays of a list */
    /* The control block that shaders use, copied from and to `control`; none where shaders use
       `control` itself. */
    Buffer       device_control;
    Band         band;
    ResidentBand resident;                    /* what the buffers of `band` hold */
    Buffer       points, answers;             /* for point_query.comp */
    Buffer       query_rays, ray_hits, taken; /* for query.comp */
    Buffer       photons;                     /* for photons.comp */
    LaneFields   lane_fields;
    LaneTimes    lane_times; /* (film/executor.h) */
    /* The items of a slice, as learned, for each phase; [1]: for shaders with the scene. */
    double items_at_once[KRS_PHASE_COUNT][2];
};

#endif
