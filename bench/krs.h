/*
 * krs.h: one sequence and compounds of eight against their levels: figure 12 of the KRS paper of 2016.
 */
#ifndef KRS_BENCH_KRS_H
#define KRS_BENCH_KRS_H

#include "bench/bench.h"
#include "bench/measure.h"

enum { MOST_LEVELS = 4 };

typedef enum Stand {
    STAND_TREE, STAND_BUNDLE, STAND_COMPOUND_TOGETHER, STAND_COMPOUND, STAND_THICKET_TOGETHER,
    STAND_THICKET, STAND_COUNT
} Stand;

typedef struct StandRow {
    const char *name, *path;
    uint32_t    components; /* KrsComponents */
} StandRow;
extern const StandRow stand_rows[STAND_COUNT];

typedef struct Sequences {
    size_t count;
    double levels[MOST_LEVELS];
    double ms[STAND_COUNT][MOST_LEVELS];       /* beams, primary rays and normals: the median */
    double coverage[STAND_COUNT][MOST_LEVELS];
    double flops[STAND_COUNT][MOST_LEVELS];    /* of a distance */
    double unresolved;
} Sequences;

void sequences_run(Bench *bench, Sequences *sequences);
/* Compounds cover what they should, however they are marched. */
void sequences_judge(const Sequences *sequences, Text *complaints);

/* 28 levels at 15 pictures of 1920x1200 a second on 6.1 TFLOP/s (section 11): nanoseconds a ray
   times the peak of the device, which is what a ray may cost, in thousands of operations. */
#define PAPER_KILOFLOPS (1e9 / 15 / (1920.0 * 1200) * 6.1)

#endif
