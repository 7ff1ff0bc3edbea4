/*
 * choices.h: the part of vulkan.h that is about what there is to choose from for a picture; it
 * is included there.  Each choice has its rows, with what they mean, in choices.def.
 */
#ifndef KRS_PICTURE_CHOICES_H
#define KRS_PICTURE_CHOICES_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* Names stand in arrays of this size, whose last elements are NULL: there will be more choices. */
#define KRS_MAX_CHOICES 32

/* The ways in which light is found: KRS_INTEGRATOR_PREVIEW and so on. */
typedef enum KrsIntegrator {
    KRS_INTEGRATOR_DEFAULT, /* as the scene says, or preview */
#define KRS_INTEGRATOR(id, name, about) KRS_INTEGRATOR_##id,
#include "krs/choices.def"
    KRS_INTEGRATOR_COUNT
} KrsIntegrator;
extern const char *const krs_integrator_names[KRS_MAX_CHOICES]; /* "default", "preview", ... */

/* The ways in which rays advance: KRS_TRACE_DEFAULT, KRS_TRACE_PLAIN and so on.  KRS_TRACE_TAYLOR
   and all behind it want a scene that was compiled with `research`. */
typedef enum KrsTrace {
#define KRS_TRACE(id, name, about) KRS_TRACE_##id,
#include "krs/choices.def"
    KRS_TRACE_COUNT
} KrsTrace;
extern const char *const krs_trace_names[KRS_MAX_CHOICES]; /* "default", "plain", ... */

/* The ways in which rays are assigned to the lanes of the device: KRS_SCHEDULE_PIXEL and so on. */
typedef enum KrsSchedule {
#define KRS_SCHEDULE(id, name, about) KRS_SCHEDULE_##id,
#include "krs/choices.def"
    KRS_SCHEDULE_COUNT
} KrsSchedule;
extern const char *const krs_schedule_names[KRS_MAX_CHOICES];

/* Says whether heavy components of a scene are marched by one distance, or each by itself:
   KRS_COMPONENTS_TOGETHER and so on. */
typedef enum KrsComponents {
#define KRS_COMPONENTS(id, name, about) KRS_COMPONENTS_##id,
#include "krs/choices.def"
    KRS_COMPONENTS_COUNT
} KrsComponents;
extern const char *const krs_components_names[KRS_MAX_CHOICES];

/* Says where the distance is looked at around a hit for its normal: KRS_NORMALS_FORWARD and so on.
   KRS_NORMALS_ANALYTIC wants a scene that was compiled with `gradients`; where points are relative
   to the camera it is the octahedron.  Neither this nor KRS_NORMALS_FORWARD tells what is finer
   than a pixel: as with no_filter. */
typedef enum KrsNormals {
#define KRS_NORMALS(id, name, about) KRS_NORMALS_##id,
#include "krs/choices.def"
    KRS_NORMALS_COUNT
} KrsNormals;
extern const char *const krs_normals_names[KRS_MAX_CHOICES];

/* The shadows of lights that have a size: KRS_SHADOWS_SOFT, KRS_SHADOWS_AREA. */
typedef enum KrsShadows {
#define KRS_SHADOWS(id, name, about) KRS_SHADOWS_##id,
#include "krs/choices.def"
    KRS_SHADOWS_COUNT
} KrsShadows;
extern const char *const krs_shadows_names[KRS_MAX_CHOICES];

/* How light is found that smooth surfaces gather on others: KRS_CAUSTICS_PATHS, KRS_CAUSTICS_PHOTONS. */
typedef enum KrsCaustics {
#define KRS_CAUSTICS(id, name, about) KRS_CAUSTICS_##id,
#include "krs/choices.def"
    KRS_CAUSTICS_COUNT
} KrsCaustics;
extern const char *const krs_caustics_names[KRS_MAX_CHOICES];

/* The executors that march the rays of a camera: KRS_EXECUTOR_KERNELS, KRS_EXECUTOR_LANES. */
typedef enum KrsExecutor {
#define KRS_EXECUTOR(id, name, about) KRS_EXECUTOR_##id,
#include "krs/choices.def"
    KRS_EXECUTOR_COUNT
} KrsExecutor;
extern const char *const krs_executor_names[KRS_MAX_CHOICES];

/* The heights above surfaces at which rays of paths begin: KRS_STARTS_PRECISION,
   KRS_STARTS_DISTANCE. */
typedef enum KrsStarts {
#define KRS_STARTS(id, name, about) KRS_STARTS_##id,
#include "krs/choices.def"
    KRS_STARTS_COUNT
} KrsStarts;
extern const char *const krs_starts_names[KRS_MAX_CHOICES];

/* The weights of the rays of a pixel by their place: KRS_PIXEL_FILTER_BOX and so on. */
typedef enum KrsPixelFilter {
#define KRS_PIXEL_FILTER(id, name, reach, integral, about) KRS_PIXEL_FILTER_##id,
#include "krs/choices.def"
    KRS_PIXEL_FILTER_COUNT
} KrsPixelFilter;
extern const char *const krs_pixel_filter_names[KRS_MAX_CHOICES];

/* The light that a plate catches: KRS_CATCHER_DEFAULT, KRS_CATCHER_SHADOWS and so on. */
typedef enum KrsCatcher {
#define KRS_CATCHER(id, name, about) KRS_CATCHER_##id,
#include "krs/choices.def"
    KRS_CATCHER_COUNT
} KrsCatcher;
extern const char *const krs_catcher_names[KRS_MAX_CHOICES];

/*
 * The methods by which a picture is found, for programs that compare them: pictures are the same
 * within the permitted error, but take other times.  Zero asks for the fastest that is known.
 */
typedef struct KrsMethods {
    uint32_t      max_steps;     /* of a primary ray; 0: 16384, which is also the most */
    uint32_t      steps_at_once; /* of a primary ray in one dispatch; 0: 512; at most 8192 */
    KrsTrace      trace;
    KrsSchedule   schedule;
    KrsComponents components;
    KrsNormals    normals;
    KrsStarts     starts;
    uint32_t      even_hits; /* iterations that even hits out along their rays (Keinert et al. 2014,
                                 3.4); 0: none; at most KRS_MAX_EVEN_HITS */
    bool          no_beams;  /* rays of a tile do not share the marching of empty space */
    bool          no_upsampling; /* neighbours do not share rays to lights, and such rays are sent
                                    even where a light is proven to be visible */
    bool          no_filter; /* detail finer than a pixel changes neither normals nor roughness */
    uint8_t       unused[5]; /* it may have any value */
    KrsExecutor   executor;
    uint32_t      reserved_half; /* 0, as what follows */
    uint64_t      reserved[7];   /* 0: this is a part of KrsRenderOptions, and keeps its size */
} KrsMethods;

/* Version 0.2 has them as members of KrsRenderOptions itself. */
#ifdef KRS_NO_DEPRECATED
#define KRS_WITH_OLD_METHODS(member) member
#else
#ifdef __GNUC__
#define KRS_UNNAMED __extension__
#else
#define KRS_UNNAMED
#endif
#define KRS_WITH_OLD_METHODS(member)                                          \
    KRS_UNNAMED union {                                                       \
        member;                                                               \
        KRS_UNNAMED struct {                                                  \
            uint32_t most_steps      KRS_DEPRECATED("methods.max_steps");     \
            uint32_t steps_at_once   KRS_DEPRECATED("methods.steps_at_once"); \
            KrsTrace trace           KRS_DEPRECATED("methods.trace");         \
            KrsSchedule schedule     KRS_DEPRECATED("methods.schedule");      \
            KrsComponents components KRS_DEPRECATED("methods.components");    \
            KrsNormals normals       KRS_DEPRECATED("methods.normals");       \
            KrsStarts starts         KRS_DEPRECATED("methods.starts");        \
            uint32_t even_hits       KRS_DEPRECATED("methods.even_hits");     \
            bool no_beams            KRS_DEPRECATED("methods.no_beams");      \
            bool no_upsampling       KRS_DEPRECATED("methods.no_upsampling"); \
            bool no_filter           KRS_DEPRECATED("methods.no_filter");     \
        };                                                                    \
    }
#endif

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
