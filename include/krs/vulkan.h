/*
 * vulkan.h: render compiled scenes on a Vulkan device.
 *
 * A KrsRenderer is an open device.  A KrsRendering is a scene whose shaders are compiled for it.
 * krs_render turns one state of the scene into a KrsPicture in host memory.  A KrsFilm is a picture
 * that persists: samples are added to it, and it is read when it is wanted.  Different renderers
 * may be used from different threads; a renderer, and all that was made from it, belongs to one
 * thread at a time.  Nothing here prints, exits or aborts: every failure is a status, and one
 * line of text that krs_renderer_message returns.
 */
#ifndef KRS_VULKAN_H
#define KRS_VULKAN_H

#include "krs/krs.h"
#include "krs/choices.h"

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

typedef struct KrsRenderer  KrsRenderer;
typedef struct KrsRendering KrsRendering;

typedef enum KrsDeviceKind {
    KRS_DEVICE_OTHER,
    KRS_DEVICE_CPU,
    KRS_DEVICE_VIRTUAL,
    KRS_DEVICE_INTEGRATED,
    KRS_DEVICE_DISCRETE
} KrsDeviceKind;

typedef struct KrsDevice {
    char          name[256];
    KrsDeviceKind kind;
    uint32_t      api_version; /* as Vulkan packs it */
    bool          usable;      /* has compute, Vulkan 1.1 and eight storage buffers */
    bool          preferred;   /* what a renderer takes when nothing is asked for */
} KrsDevice;

/* A message of Vulkan's validation layers; the text lives until the callback returns. */
typedef void KrsValidationCallback(void *user, const char *message);

/* Called about once a second while the driver compiles and keeps the processor busy, so that a
   caller can tell slow from stuck. */
typedef void KrsWorkingCallback(void *user);

/* Says whether branches skip shapes that are far away for their size.  The default is on, but off
   on devices of type CPU, which run both sides of a branch. */
typedef enum KrsEarlyOuts {
    KRS_EARLY_OUTS_DEFAULT,
    KRS_EARLY_OUTS_ON,
    KRS_EARLY_OUTS_OFF
} KrsEarlyOuts;

/* Zero asks for the defaults. */
typedef struct KrsRendererOptions {
    /* NULL or "": a real graphics card if there is one (discrete before integrated), else a
       device of type CPU.  "cpu": a device of type CPU.  A number: the device of that index in
       krs_devices.  Anything else: the first device whose name contains it, in any case. */
    const char *device;
    bool        validation; /* core and synchronization validation */
    KRS_WAS(KrsValidationCallback *validation_message, KrsValidationCallback *complaint,
            "validation_message"); /* may be NULL: messages are counted all the same */
    KrsWorkingCallback *working;   /* may be NULL */
    void               *user;      /* handed to both */
    /* Called between steps of compiling shaders: `done` rises from 0 to 1 for those that are compiled together.  False
       interrupts when the step has ended, and what there was stays.  May be NULL. */
    KRS_WAS(KrsProgressCallback *progress, KrsProgressCallback *compiling, "progress");
    KRS_WAS(void *progress_user, void *compiling_user, "progress_user");
    /* A folder that caches compiled shaders.  It is made if it is missing, and need not be
       writable.  NULL: no cache, and nothing is written to disk. */
    const char  *cache;
    KrsEarlyOuts early_outs;
    /* Shaders that all pictures need are compiled in the background from now on, on a device of
       type CPU; for callers that have a scene to compile meanwhile. */
    KRS_WAS(bool prewarm, bool pictures_ahead, "prewarm");
    KrsAllocator allocator; /* of the library; the driver and glslang have their own */
    KRS_WAS(double timeout, double patience,
            "timeout"); /* seconds that the device may take for one of the many steps of
                               a picture; then it counts as lost: KRS_INTERNAL.  0: 300 */
} KrsRendererOptions;

/* Lists the devices of this machine, in Vulkan's order.  *count is how many there are, of which the
   first `capacity` are written.  KRS_NO_DEVICE: Vulkan cannot be started, or knows no device. */
KRS_SIZED KrsStatus krs_devices(KrsDevice *devices, size_t capacity, size_t *count);

/* Opens a device.  *renderer is the caller's to free whatever the status, so that its message
   can be read; it is NULL only when memory ran out, and with options that this library does not know.
   KRS_NO_DEVICE, KRS_OUT_OF_MEMORY, KRS_INTERNAL.  A renderer whose opening failed must only be freed. */
KRS_SIZED KrsStatus krs_renderer_new(const KrsRendererOptions *options, KrsRenderer **renderer);
void krs_renderer_free(KrsRenderer *renderer); /* its renderings must be freed before */

/* Returns why the last call on this renderer, or on one of its renderings, failed: one line, ""
   when it did not.  It lives until the next such call. */
const char *krs_renderer_message(const KrsRenderer *renderer);
/* Returns the device that was opened. */
KRS_SIZED KrsDevice krs_renderer_device(const KrsRenderer *renderer);
/* Returns how many messages the validation layers have had so far. */
uint64_t krs_renderer_validation_messages(const KrsRenderer *renderer);

/* The main use of a rendering.  Its shaders are compiled at once, others when they are first
   needed.  Empty zones (krs_state_set_zones) need shaders of their own: for the first zone, and
   when there are more than 1, 2, 4 or 8 for the first time. */
typedef enum KrsPurpose {
    KRS_FOR_PICTURES,       /* krs_render, by the integrator preview */
    KRS_FOR_QUESTIONS,      /* krs_device_probe, krs_device_raycast */
    KRS_FOR_PATHS,          /* krs_render, by the integrators direct and path */
    KRS_FOR_SMALL_PICTURES, /* as KRS_FOR_FIRST_PICTURES, of few rays in all: fewer shaders, which are
                               ready earlier, and are slower.  Pictures differ within the permitted error */
    KRS_FOR_LANES, /* as KRS_FOR_PICTURES, by the executor LANES: no shader contains the scene, unless it
                      has mirrors or glass */
    KRS_FOR_FIRST_PICTURES /* as KRS_FOR_PICTURES, but shaders are compiled only when a picture is asked for,
                              and by the executor DEFAULT not before lanes would take longer than
                              compilers and shaders together */
} KrsPurpose;

/* Compiles the scene's shaders, for a purpose.  The scene must outlive the rendering.  On any status
   but KRS_OK *rendering is NULL: KRS_BAD_SCENE (krs_scene_too_large), KRS_OUT_OF_MEMORY, KRS_INTERRUPTED,
   KRS_INTERNAL.

   To go on rendering meanwhile, compile by a second renderer, in a thread of its own: whichever
   rendering is ready is shown, and the other renderer is free for the next edit. */
KrsStatus krs_rendering_new(KrsRenderer *renderer, const KrsScene *scene, KrsPurpose purpose,
                            KrsRendering **rendering);
void      krs_rendering_free(KrsRendering *rendering);

/* A compute shader that a picture or a query is made by. */
typedef struct KrsShaderStats {
    char     name[48];   /* "trace.comp"; "trace.comp 2" of march group 2 alone */
    uint64_t glsl_bytes; /* of its text; 0: the library carries it as SPIR-V */
    double   spirv_ms;   /* of one processor, to print the text and to compile it */
    double   driver_ms;  /* to make it ready on the device; some drivers do so in its first run */
    bool     cached;     /* its SPIR-V was found in the cache, or in the library */
} KrsShaderStats;

/* Returns the shaders made so far, those without a scene first.  Writes up to `capacity` of them,
   and returns how many there are. */
KRS_SIZED size_t krs_rendering_shaders(const KrsRendering *rendering, KrsShaderStats *shaders,
                                       size_t capacity);

/*
 * Takes a rendering over to an update of its scene (krs_scene_update), or to one that its scene is
 * an update of.  Its films stay as large as they are, and lose their samples; what their options
 * left to the scene is chosen anew.  Afterwards the rendering needs the other scene alone, and
 * states of that one.  On any other status than KRS_OK rendering and films are as they were:
 * KRS_OUT_OF_MEMORY, KRS_INTERRUPTED, KRS_INTERNAL.
 *
 * Shaders whose text is the same stay.  A renderer has each of them once, whatever scene they are
 * of, and keeps some that are no longer used.  So after an edit of numbers nothing is compiled, nor
 * after an edit that is undone.  krs_rendering_new finds them as well.
 */
KrsStatus krs_rendering_update(KrsRendering *rendering, const KrsScene *scene);

/* The parts of a picture, as bits: KRS_AOV_COLOR and so on, a row of aovs.def each. */
typedef enum KrsAov {
#define KRS_AOV(id, bit, aov, about, arrays) KRS_AOV_##id = 1 << bit,
#include "krs/aovs.def"
#undef KRS_AOV
    KRS_AOV_ALL = 0
#define KRS_AOV(id, bit, aov, about, arrays) | 1 << bit
#include "krs/aovs.def"
#undef KRS_AOV
#ifndef KRS_NO_DEPRECATED
#define KRS_AOV(id, bit, aov, about, arrays) \
    , KRS_PLANE_##id KRS_DEPRECATED("KRS_AOV_" #id) = 1 << bit
#include "krs/aovs.def"
#undef KRS_AOV
    ,
    KRS_PLANE_ALL KRS_DEPRECATED("KRS_AOV_ALL") = KRS_AOV_ALL
#endif
} KrsAov;

typedef struct KrsWindow {
    uint32_t x, y, width, height; /* of pixels; row 0 is the top */
} KrsWindow;

/* The eye of a camera that sees, for stereo; KrsCamera.eyes is their distance. */
typedef enum KrsEye { KRS_EYE_OF_BOTH, KRS_EYE_ON_LEFT, KRS_EYE_ON_RIGHT } KrsEye;

/* The sizes if neither the caller nor the scene gives them, and the greatest ones. */
#define KRS_DEFAULT_WIDTH         1280
#define KRS_DEFAULT_HEIGHT        720
#define KRS_DEFAULT_SAMPLES       1
#define KRS_DEFAULT_NOISY_SAMPLES 1024 /* where they end by noise, */
#define KRS_MIN_NOISY_SAMPLES     16   /* but not before */
#define KRS_DEFAULT_NOISE_FLOOR   0.05
#define KRS_DEFAULT_ERROR         0.25
#define KRS_MAX_SIDE              16384 /* pixels along a side of a picture */
#define KRS_MAX_SAMPLES           65536
#define KRS_MAX_ERROR             1000
#define KRS_DEFAULT_BOUNCES       10
#define KRS_MAX_BOUNCES           1000
#define KRS_MAX_EVEN_HITS         16
#define KRS_DEFAULT_REFLECTANCE   0.04
#define KRS_MAX_REFLECTANCE       0.99
#define KRS_NO_LIGHT              UINT32_MAX
#define KRS_MAX_LIGHT_GROUPS      240

/* Zero asks for the defaults. */
typedef struct KrsRenderOptions {
    uint32_t      width, height; /* 0: what the scene says, or the default */
    KrsWindow     crop;          /* width 0: everything */
    uint32_t      samples;       /* rays per pixel; 0: likewise */
    size_t        camera;        /* its number */
    KrsEye        eye;
    double        frame_seconds; /* between frames, for shutters; 0: they count as closed */
    KrsIntegrator integrator;
    uint32_t      bounces; /* of a path, at most; 0: 10 */
    uint64_t      seed;  /* of the samples' positions; the first stays at the centre of the pixel */
    double        error; /* permitted distance from the surface, pixels; 0: likewise */
    /* Light of a ray is clamped to this, by its largest component; 0: no limit.  Each pass is
       clamped by itself: the light of three lamps, and every further sun. */
    KRS_WAS(double max_radiance, double most_radiance, "max_radiance");
    /* Samples of a pixel end where the estimated error of its colour is below this, but not before
       16, and at `samples` at the latest: 0.02 is 2 %.  The error is the standard deviation of the
       mean of R, G and B, relative to their mean plus `noise_floor`.  0: as the scene says, or all
       pixels have equal samples. */
    double noise;
    double noise_floor; /* 0: 0.05 at the scene's exposure, and as much darker for each stop */
    /* 0: all light.  A number from 1 on: that light alone, without sky and fog's color; KRS_NO_LIGHT: none.
       What things emit is there in any case.  So pictures of lights, less the one without, add up. */
    uint32_t light;
    bool     light_groups; /* makes KrsPicture.lights; neither with max_radiance nor with noise */
    bool     mattes;       /* count what the rays of each pixel hit: KrsPicture.mattes */
    /* The picture of another renderer: a number and a colour for each pixel of the whole picture,
       from the top; NULL: none.  Rays end at the depths, which are as those of the depth AOV; what
       is not a number is no limit.  What rays do not hit shows the plate: premultiplied light and
       alpha.  Both must live as long as the film.  Where both are known, the plate catches shadows
       of the scene, as a surface whose normals follow from the depths: see KrsPicture.caught.
       Shapes mirror the plate, and lie in its shadow, where a camera that is no panorama shows what
       rays meet of it. */
    const float *depth;
    const float (*plate)[4];
    KrsCatcher catcher;             /* anything but KRS_CATCHER_NONE needs depths */
    double     catcher_roughness;   /* of a glossy one, from 0 to 1; 0: as a mirror */
    double     catcher_reflectance; /* head on, from 0 to KRS_MAX_REFLECTANCE; 0: 0.04 */
    KRS_WAS(uint32_t aovs, uint32_t planes, "aovs"); /* bits of KrsAov; 0: all but noise, which is
                                    there where samples end by it */
    KrsShadows     shadows;
    KrsPixelFilter pixel_filter; /* not of rays of a list, which stand where the caller has them */
    bool           no_occlusion; /* corners get as much light of the sky as open places */
    double         slice_ms;     /* how long a dispatch should take; 0: 50 */
    KRS_WITH_OLD_METHODS(
        KrsMethods methods);       /* by which the picture is found; {0}: the fastest known */
    KrsProgressCallback *progress; /* may be NULL */
    void                *user;     /* handed to `progress` */
    /* KRS_CAUSTICS_PHOTONS wants the integrator `path`, and neither light_groups nor a catcher. */
    KrsCaustics caustics;
} KrsRenderOptions;

typedef enum KrsPhase {
#define KRS_PHASE(id, name) KRS_PHASE_##id,
#include "krs/choices.def"
    KRS_PHASE_COUNT
} KrsPhase;
extern const char *const krs_phase_names[KRS_MAX_CHOICES]; /* "beams", ... */

typedef struct KrsRenderStats {
    double   spirv_ms, pipeline_ms;     /* compiling shaders: to SPIR-V, by the driver */
    double   phase_ms[KRS_MAX_CHOICES]; /* on the device */
    double   total_ms;                  /* their sum */
    double   wall_ms;                   /* of krs_render, without compiling */
    bool     device_time;         /* phases by timestamps of the device, else by the host's clock */
    uint64_t rays;                /* primary rays */
    uint64_t evaluations;         /* of the distance, spent on them */
    double   evaluations_per_ray; /* the mean */
    KRS_WAS(uint32_t max_evaluations_per_ray, uint32_t most_evaluations_per_ray,
            "max_evaluations_per_ray");
    double   flops_per_evaluation;
    double   gflops;      /* of the primary phase */
    uint64_t unresolved;  /* primary and shadow rays that ran out of steps */
    uint64_t clamped;     /* rays whose light was clamped to max_radiance */
    uint64_t submissions; /* of work to the device; the host waits for each */
    KRS_WAS(uint64_t shaders, uint64_t kernels,
            "shaders"); /* that the renderer has made since it was opened, for all scenes */
    uint64_t    peak_memory_bytes; /* the most held at once on the device, and the picture */
    char        device[256];
    KrsExecutor executor; /* that marched the rays of the sample added last; DEFAULT: several did,
                             or the samples were loaded */
    uint32_t    reserved_half; /* 0, as what follows */
    uint64_t    reserved[7];   /* 0: this is a part of KrsPicture, and keeps its size */
} KrsRenderStats;

/* Rays of a pixel that hit a component, one of its instances, or a material. */
typedef struct KrsMatte {
    uint32_t part, instance; /* number of the component or material; of an instance, else 0 */
    uint32_t rays;           /* 0: there is no more */
} KrsMatte;
typedef enum KrsMatteKind {
    KRS_MATTE_COMPONENTS,
    KRS_MATTE_INSTANCES,
    KRS_MATTE_MATERIALS,
    KRS_MATTE_COUNT
} KrsMatteKind;
#define KRS_MATTE_RANKS 6 /* of each pixel; what comes later is not counted */

/*
 * A picture.  The AOVs hold the pixels of `window` only, row by row from the top, and
 * are NULL when they were not asked for.  Where a pixel's centre hits nothing, the depth is
 * +infinity and all AOVs but colour and steps are 0.
 */
typedef struct KrsPicture {
    uint32_t  width, height; /* of the whole picture */
    KrsWindow window;        /* the part of it that was rendered */
    /* KRS_MATTE_RANKS mattes for each pixel, the most covered first, with KrsRenderOptions.mattes;
       else NULL.  The share of a pixel that one covers is its rays / samples, or / pixel_samples
       where they differ. */
    KrsMatte *mattes[KRS_MATTE_COUNT];
    float (*lights)
        [3]; /* with light_groups: of each light, pixel by pixel; the rest is sky, fog, emission */
    uint32_t light_count, samples; /* of lights; of rays of each pixel, at most */
    /* The light of a plate that catches shadows, with the scene, relative to that without, by which
       the plate is multiplied; 1 where it has no depth.  Else NULL. */
    float (*caught)[3];
    /* The light that the surface of a glossy plate mirrors of the scene, less what that hides from
       it, which is added to the plate.  It may be negative.  Else NULL. */
    float (*mirrored)[3];
    /* The matrices of the camera; without one these change nothing.  For row vectors, v * M.
       Camera space has x to the right, y up, z along the view axis.  NDC has x and y from -1 to 1;
       in perspective z goes from 0 at distance 0.001 to 1 at infinity.  For a panorama NDC is
       camera space. */
    float          world_to_camera[4][4], world_to_ndc[4][4];
    KrsRenderStats stats;
    KrsAllocator   allocator; /* where the memory came from */
    /* color, depth, position, normal, albedo, component, level, instance and steps: aovs.def says
       what they are, and how many numbers a pixel has.  They are last, as there will be more. */
#define KRS_ARRAY(aov, member, type, numbers, row, first, sample, ...) type *member;
#define KRS_AOV(id, bit, aov, about, arrays)                           arrays
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
} KrsPicture;

/* Renders a state of the rendering's own scene.  On KRS_OK the caller owns *picture; on any
   other status it is NULL.  `options` may be NULL.  KRS_BAD_ARGUMENT, KRS_OUT_OF_MEMORY (host or
   device), KRS_INTERRUPTED, KRS_INTERNAL.  Equal arguments on an equal device give equal
   pictures, bit by bit, whatever the crop and the slices. */
KRS_SIZED KrsStatus krs_render(KrsRendering *rendering, KrsState *state,
                               const KrsRenderOptions *options, KrsPicture **picture);
void                krs_picture_free(KrsPicture *picture);

/* Fills what a screen shows of a picture: its window as 8-bit sRGB, `channels` bytes a pixel (3, or
   4 with an alpha of 255), as a PNG of `krs render` has it.  The curve, the exposure and the white
   balance are those of the scene's `image` block; `stops` are added to the exposure.  Colours are
   dithered by their place in the whole picture.  KRS_BAD_ARGUMENT: other channels, or the picture
   has no colour. */
KrsStatus krs_picture_to_srgb8(const KrsPicture *picture, const KrsScene *scene, double stops,
                               uint32_t channels, uint8_t *pixels);

/* Joins two pictures of the same size and AOVs, without `lights`: the second to the right of the
   first, or below it.  The statistics are the sums.  The result has no camera, so its matrices
   change nothing.  On KRS_OK the caller owns *joined.  KRS_BAD_ARGUMENT: they differ, or have a
   crop; KRS_OUT_OF_MEMORY. */
KrsStatus krs_picture_join(const KrsPicture *first, const KrsPicture *second, bool below,
                           KrsPicture **joined);

/*
 * Films: pictures that grow.
 *
 * A film begins without samples.  Each call that adds some may have another state and camera: the
 * mean of all is what is read, so equal ones refine the picture, and others blur it.  The AOVs
 * other than colour, and the matrices, are those of the first sample.  As many samples as
 * `options->samples` says, added in whatever portions, give the picture of krs_render bit by bit;
 * more may be added.  The host has them when a call returns, and every few seconds meanwhile.
 *
 * Where the device is lost, or its memory or the host's does not suffice for work, it is opened anew with shorter slices
 * and smaller bands, and the film goes on from what the host has of it, to the same picture.  KRS_INTERNAL or
 * KRS_OUT_OF_MEMORY: that has helped nothing three times in a row.  Samples that end by noise with mattes begin anew.
 *
 * Arguments that are refused change nothing; if adding fails otherwise, or is interrupted, the film
 * is as new.
 */
typedef struct KrsFilm KrsFilm;

/* Makes a film of a rendering's scene; `options` (or NULL) are checked and copied, and hold for all
   of its samples.  If it fails *film is NULL: KRS_BAD_ARGUMENT, KRS_OUT_OF_MEMORY. */
KRS_SIZED KrsStatus krs_film_new(KrsRendering *rendering, const KrsRenderOptions *options,
                                 KrsFilm **film);
void                krs_film_free(KrsFilm *film); /* before its rendering */
void     krs_film_clear(KrsFilm *film); /* forgets all samples, as after the camera has moved */
uint32_t krs_film_samples(const KrsFilm *film); /* of each pixel so far */

/* Adds samples of a state, as seen by the camera, or by the one of the options where it is NULL.
   krs_state_camera gives the scene's own to begin with.  KRS_BAD_ARGUMENT, KRS_OUT_OF_MEMORY,
   KRS_INTERRUPTED, KRS_INTERNAL. */
KRS_SIZED KrsStatus krs_film_add(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                                 uint32_t samples);

/* Tells about how many milliseconds a sample of all pixels would take by the executor LANES, and the compilers of shaders
   that are missing.  Lanes march small parts of the picture for some 10 ms, and nothing is compiled.  KRS_BAD_ARGUMENT: they
   cannot march these rays, or need a shader that contains the scene; krs_renderer_message says why.  KRS_OUT_OF_MEMORY. */
KRS_SIZED KrsStatus krs_film_try_lanes(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                                       double *lanes_ms, double *compiler_ms);

/* A ray for each pixel of the whole picture, row by row from the top, also where there is a crop:
   lenses and projections of the caller's own. */
typedef struct KrsRays {
    const double (*origins)[3];    /* in world units */
    const double (*directions)[3]; /* of any length but 0 */
    /* The width of a ray, which is what a pixel is for a camera: at its origin, and how much
       wider it gets for each unit along it, both at least 0.  The permitted error counts in
       these widths. */
    double width, spread;
    /* No ray goes farther, in world units along it; 0: as far as the scene's box reaches, or, where
       it has no end, 10,000 times its size or that of the box around the origins (at least 1). */
    double farthest;
} KrsRays;

/* Adds a sample of each pixel by rays of a list, which share no beams; its depth is the distance
   along the ray.  The first time it compiles shaders. */
KRS_SIZED KrsStatus krs_film_add_rays(KrsFilm *film, KrsState *state, const KrsRays *rays);

/* Reads the mean of the samples so far, with AOVs of the options (bits; 0: all of these).  The film
   stays as it is.  On KRS_OK the caller owns *picture; its statistics are sums over the samples.
   KRS_BAD_ARGUMENT: there is no sample, or no such AOV; KRS_OUT_OF_MEMORY, KRS_INTERNAL. */
KrsStatus krs_film_read(KrsFilm *film, uint32_t aovs, KrsPicture **picture);

/*
 * Queries of the device, for large batches: krs_distance, krs_probe and krs_raycast (krs.h) in single
 * precision.  Points and distances of krs_device_distance are of single precision themselves, since there may be
 * millions of them; the others have the same arguments and answers.  Numbers beyond 1e18 are refused as well.
 *
 * In simple scenes distances are accurate to a few units in the last place of the coordinates,
 * and so is t beyond the tolerance.  For sequences of dozens of mirrors it is some hundred
 * units.  Rays from far outside of a bounded scene lose no accuracy, since they begin at its
 * box.  What is far from the origin for its size is asked about relative to a point near it, so that
 * normals are those of the same thing at the origin: differences over a thousandth of what a batch
 * of 16384 sees, or of its coordinates where those are no more than ten times as large.  At points far from
 * many alike parts, distances may be less, never more, and where they are constant the normal is 0.  A tolerance of 0 asks for
 * the accuracy of single precision.  A ray is unresolved after 8192 steps.
 *
 * KRS_BAD_ARGUMENT (nothing is answered), KRS_OUT_OF_MEMORY, KRS_INTERNAL; what is written to
 * `hits` is then undefined.  Memory does not grow with `count`.
 */
KrsStatus krs_device_distance(KrsRendering *rendering, KrsState *state, const float (*points)[3],
                              size_t count, float *distances);
KRS_SIZED KrsStatus krs_device_probe(KrsRendering *rendering, KrsState *state,
                                     const double (*points)[3], size_t count, KrsHit *hits);
KRS_SIZED KrsStatus krs_device_raycast(KrsRendering *rendering, KrsState *state,
                                       const double (*origins)[3], const double (*directions)[3],
                                       size_t count, double farthest, double tolerance,
                                       KrsHit *hits);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#include "krs/film.h"
#include "krs/sized_vulkan.h"
#ifndef KRS_NO_DEPRECATED
#include "krs/deprecated_vulkan.h"
#endif
#endif
