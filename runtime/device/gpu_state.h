/*
 * gpu_state.h: what is known of a device, memory of the host, and failures.
 *
 * Every call that can fail because of the machine returns false and leaves a status and one
 * line of words in the Gpu.
 */
#ifndef KRS_GPU_STATE_H
#define KRS_GPU_STATE_H

#include "runtime/device/cache.h"
#include "krs/vulkan.h"

/* The storage buffers that a stage of a shader binds (layouts.h), and how many more in place of
   texels; devices may have four and no more, but those of desktops have 16 and more. */
enum { STORAGE_BUFFERS = 8, STORAGE_BUFFERS_FOR_TEXELS = 3 };

typedef struct SharedShader SharedShader; /* shared_shaders.h */

/* An object of the driver; 0: none. */
typedef uint64_t Handle;

/* What the driver has of a device (driver.h). */
typedef struct Driver Driver;

/* How much of a buffer a shader reads. */
typedef struct GpuLimits {
    uint32_t texels;                       /* of a buffer that is read as such */
    uint32_t storage_bytes, uniform_bytes; /* of others */
    uint32_t uniform_step;                 /* blocks of work begin at multiples of it */
} GpuLimits;

typedef struct Gpu {
    KrsAllocator allocator;
    Driver      *driver;   /* NULL: there is no device */
    uint32_t     marks;    /* of times, since recording began */
    uint32_t     prewarms; /* that were timed */

    GpuLimits limits;
    bool      has_clock;     /* of its own */
    bool      validates;     /* validation layers are listened to, in one thread */
    bool      emulates_card; /* a device of type CPU is treated as a graphics card */
    bool      texels;        /* shaders read what they only read as texels, not as buffers */
    bool      sums_lanes;    /* lanes of a subgroup can add up before they count */
    uint32_t  refill_lanes;  /* of a group whose lanes exchange numbers: 8, or 4; 0: they cannot */
    uint64_t  memory_used, memory_peak; /* bytes of device memory */
    uint64_t  submissions;              /* that were waited for */

    Cache         cache;            /* of shaders; zero when none was asked for */
    SharedShader *shared_shaders;   /* shaders with a scene */
    uint64_t      shaders_made;     /* pipelines, so far */
    size_t        pipelines_loaded; /* bytes that it began with */

    KrsValidationCallback *validation_message;
    KrsWorkingCallback    *working;
    void                  *user;
    KrsProgressCallback   *compiling;
    void                  *compiling_user;
    uint64_t               validation_messages;

    double timeout; /* seconds that a submission may take */
    bool   stuck;   /* one took longer */
    bool   lost;    /* work was not done: nothing is submitted until gpu_reopen */

    KrsStatus status; /* of the last call that failed */
    char      message[512];
} Gpu;

#define NO_DEVICE \
    "no usable Vulkan device: install a driver, for example Debian's mesa-vulkan-drivers"

/* Tells whether a device was opened, and not closed. */
bool gpu_is_open(const Gpu *gpu);
/* Tells whether the device is of type CPU, and not to be treated as a graphics card. */
bool gpu_is_cpu(const Gpu *gpu);
/* Returns the bytes of the largest memory that is the device's own. */
uint64_t gpu_memory(const Gpu *gpu);

/* Returns zeroed memory of the host, or NULL with the failure noted. */
void *gpu_alloc(Gpu *gpu, size_t count, size_t size, const char *attempt);
void  gpu_release(Gpu *gpu, void *block);

/* Notes a failure. */
void gpu_refuse(Gpu *gpu, KrsStatus status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Tells how much of the shaders that are made is ready.  False, and noted: that is to end. */
bool gpu_tell_compiled(Gpu *gpu, double done);

/* Returns the milliseconds of the host's steady clock. */
double clock_ms(void);

#endif
