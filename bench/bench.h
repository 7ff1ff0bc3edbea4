/*
 * bench.h: what the parts of the bench share.
 *
 * The bench is one process on one device: whatever is compared runs in turns, so that a machine
 * that becomes slower for a while is slower for all.  It stops at the first failure and says why.
 */
#ifndef KRS_BENCH_H
#define KRS_BENCH_H

#include "compiler/base/text.h"
#include "runtime/device/gpu.h"

/* The permitted distance from the surface that everything is measured at, and the one of the
   pictures that others are compared with, in pixels. */
#define PERMITTED_ERROR 0.25
#define REFERENCE_ERROR 0.002

typedef struct Bench {
    Arena       *arena;    /* for as long as the process lives */
    const char  *krs;      /* the command whose first picture is timed */
    const char  *folder;   /* where the results go */
    const char  *revision; /* of the source */
    const char  *device;   /* as KrsRendererOptions has it */
    const char  *only;     /* name of the one scene, or NULL for all */
    bool         quick;
    uint32_t     repeats, width, height;
    KrsRenderer *renderer;
    Gpu          gpu; /* the same device again, for shaders of our own */
} Bench;

/* Prints what went wrong, and ends the process. */
_Noreturn void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* What is being done now, for who waits. */
void tell(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Returns a file as text; a file that cannot be read is a failure. */
char *read_file(Arena *arena, const char *path);

#endif
