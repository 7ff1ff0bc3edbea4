/*
 * device.h: what one wants to know of a Vulkan device first; tools/check-device.sh asks for one
 * section after the other.  Each prints a table in Markdown on standard output.
 */
#ifndef KRS_BENCH_DEVICE_H
#define KRS_BENCH_DEVICE_H

#include "bench/fixture.h"
#include "runtime/tracer/shaders.h"

typedef struct Size {
    uint32_t width, height;
} Size;

/* limits.c: properties, limits and features that the runtime depends on. */
void print_device_limits(KrsRenderer *renderer);
/* accuracy.c: built-in operations and our own functions, against double precision. */
void print_accuracy(KrsRenderer *renderer);
/* examples.c: one row: a scene on this device and on lavapipe. */
void print_example(KrsRenderer *renderer, const char *path, Size size);
/* methods.c: a scene by schedule, beams, components and size of the bands; the rows of one choice
   of early outs. */
void print_methods(KrsRenderer *renderer, const char *path, Size size, bool early_outs);
/* shaders.c: what the compilers take for each shader of a scene. */
void print_shaders(KrsRenderer *renderer, const char *path);

#endif
