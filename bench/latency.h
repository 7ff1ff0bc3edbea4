/*
 * latency.h: how long a user waits for the first picture.
 */
#ifndef KRS_BENCH_LATENCY_H
#define KRS_BENCH_LATENCY_H

#include "bench/bench.h"

/* The time from the start of the command to its end, when the EXR is written, for a small scene at
   640x360. */
typedef struct Latency {
    double cold_ms; /* nothing was ever compiled */
    double warm_ms; /* for the second time, with what the first one left in the caches */
} Latency;

void latency_run(Bench *bench, Latency *latency);

#endif
