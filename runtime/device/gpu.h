/*
 * gpu.h: a device with one queue, and what is needed to keep it busy.
 */
#ifndef KRS_GPU_H
#define KRS_GPU_H

#include "runtime/device/devices.h"
#include "runtime/device/gpu_state.h"

typedef struct Buffer Buffer; /* buffer.h */

/* Bits, for tests: what device a device emulates, as far as the host treats it.  Pictures are the same. */
enum {
    EMULATE_CARD       = 1, /* a graphics card, whatever its type */
    EMULATE_MIN_LIMITS = 2  /* a device with the smallest limits that Vulkan permits */
};

/* Opens the device that the options ask for, with bits of emulation; `gpu` must stay where it is.  On failure only the
   status and the message remain. */
bool gpu_open(Gpu *gpu, const KrsRendererOptions *options, unsigned emulation);
/* Opens a second device of the kind of `other`, which must stay longer; it has no caches. */
bool gpu_open_beside(Gpu *gpu, const Gpu *other);
void gpu_close(Gpu *gpu);
/* Opens anew a device that is lost, when all that was made on it has been destroyed.  False, with the failure
   noted: it stays lost. */
bool gpu_reopen(Gpu *gpu);

/* ---- commands.c ---- */

/* Starts recording.  What earlier work wrote can be read from here on. */
bool gpu_begin(Gpu *gpu);
/* Notes the time when all that was recorded so far has run; at most MAX_MARKS times. */
enum { MAX_MARKS = 64 };
void gpu_mark(Gpu *gpu);
/* Tells, after gpu_finish, the milliseconds up to the mark of this number, from the one before or
   from the start; 0 without a clock. */
bool gpu_marked(Gpu *gpu, uint32_t mark, double *ms);
/* Separates two commands of which the second uses what the first wrote. */
void gpu_barrier(Gpu *gpu);
/* Runs what was recorded, waits, and adds its milliseconds to *ms: by the device's clock where
   it has one. */
bool gpu_finish(Gpu *gpu, double *ms);

/* These record that bytes are copied from one buffer to another, that bytes of a buffer become copies of one
   word, and that they become these: 64 KB at most. */
void gpu_copy(Gpu *gpu, const Buffer *from, uint64_t from_at, const Buffer *to, uint64_t to_at,
              uint64_t bytes);
void gpu_fill(Gpu *gpu, const Buffer *buffer, uint64_t at, uint64_t bytes, uint32_t word);
void gpu_write(Gpu *gpu, const Buffer *buffer, uint64_t at, const void *bytes, uint32_t length);

/* A shader with what it reads and writes (sets.h). */
typedef struct Run {
    Handle   pipeline, layout;
    Handle   sets[2]; /* the first may be 0, where the shader has no scene */
    uint32_t work_at; /* where in the buffer of the second its block of work is */
} Run;

/* These record that a shader runs on `groups` workgroups, or on as many as the three numbers in a buffer
   say by then. */
void gpu_dispatch(Gpu *gpu, const Run *run, uint32_t groups);
void gpu_dispatch_counted(Gpu *gpu, const Run *run, const Buffer *counts, uint64_t at);

/* Has the device run one group of a shader, and does not wait for it: a driver that compiles a
   shader only when it first runs does so meanwhile.  *number is for gpu_prewarm_ms. */
bool gpu_prewarm(Gpu *gpu, const Run *run, uint32_t *number);
/* Tells, after gpu_wait, how long prewarming took on the device; 0 without a clock, and behind the
   first MAX_TIMED_PREWARMS. */
enum { MAX_TIMED_PREWARMS = 256 };
double gpu_prewarm_ms(const Gpu *gpu, uint32_t number);
/* Waits until all that is prewarmed has run. */
bool gpu_wait(Gpu *gpu);

#endif
