/*
 * handwritten.h: the same scenes as an author of shaders would write them, to be compared with.
 */
#ifndef KRS_BENCH_HANDWRITTEN_H
#define KRS_BENCH_HANDWRITTEN_H

#include "bench/image.h"
#include "bench/measure.h"
#include "bench/shader.h"
#include "compiler/passes/compile.h"

typedef struct Handwritten {
    BenchShader shader;
    Buffer      picture, fetched; /* on the device, and for the host */
    double      error;            /* permitted, in pixels */
    double      evaluations_per_ray;
    double      unresolved; /* rays that ran out of steps */
} Handwritten;

/* Compiles a shader of bench/handwritten for a view and a permitted error. */
void handwritten_create(Bench *bench, Handwritten *written, const char *path, const KrsView *view,
                        double error);
void handwritten_destroy(Bench *bench, Handwritten *written);

/* Draws the picture; `image` may be NULL. */
Times handwritten_run(Bench *bench, const Handwritten *written, Image *image);

/* Counts the evaluations, by a shader of its own: counting takes time. */
void handwritten_count(Bench *bench, Handwritten *written, const char *path, const KrsView *view);

#endif
