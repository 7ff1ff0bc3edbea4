/*
 * subject.h: a scene, and our pictures of it.
 */
#ifndef KRS_BENCH_SUBJECT_H
#define KRS_BENCH_SUBJECT_H

#include "bench/bench.h"
#include "bench/image.h"
#include "bench/measure.h"
#include "compiler/passes/compile.h"

typedef struct Subject {
    KrsScene         *scene;
    KrsState         *state;
    KrsRendering     *rendering;
    const KrsProgram *program;
    KrsView           view;
    double            pixel; /* its width at depth 1 */
} Subject;

/* Compiles a scene, with `let levels = ...;` changed to this number unless it is 0, and makes it
   ready. */
void subject_open(Bench *bench, Subject *subject, const char *path, uint32_t levels);
void subject_close(Subject *subject);

/* Renders a whole picture, of the bench's size, whatever the options say. */
Times subject_render(Bench *bench, Subject *subject, const KrsRenderOptions *options,
                     KrsRenderStats *stats, Image *image);

/* Renders a third of the picture, so that all is compiled and all memory is there. */
void subject_prewarm(Bench *bench, Subject *subject, const KrsRenderOptions *options,
                     KrsRenderStats *stats);

#endif
