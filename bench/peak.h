/*
 * peak.h: how many floating-point operations a second the device can do at most.
 *
 * A shared machine gives more at one time than at another; so the peak is taken again and again
 * between the other measurements, and the largest counts.
 */
#ifndef KRS_BENCH_PEAK_H
#define KRS_BENCH_PEAK_H

#include "bench/shader.h"

typedef struct Peak {
    BenchShader shader; /* with the best number of chains */
    Buffer      sums;
    uint32_t    chains, groups;
    double      gflops; /* billions of single-precision operations a second, two a multiply-add */
} Peak;

/* Finds out which number of chains suits the device. */
void peak_open(Bench *bench, Peak *peak);
void peak_close(Bench *bench, Peak *peak);

/* Takes it once more. */
void peak_measure(Bench *bench, Peak *peak);

#endif
