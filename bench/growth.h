/*
 * growth.h: how the time grows with the levels of a tree.
 */
#ifndef KRS_BENCH_GROWTH_H
#define KRS_BENCH_GROWTH_H

#include "bench/bench.h"
#include "bench/measure.h"

enum { MAX_SIZES = 8 };

typedef struct Growth {
    size_t count;
    double levels[MAX_SIZES];
    double ns_per_distance[MAX_SIZES];   /* of a shader that does nothing else */
    double ns_per_evaluation[MAX_SIZES]; /* beams and primary rays, by their evaluations */
    double total_ms[MAX_SIZES];          /* without shadows and occlusion */
    Line   distance_line, evaluation_line, total_line;
} Growth;

void growth_run(Bench *bench, Growth *growth);

#endif
