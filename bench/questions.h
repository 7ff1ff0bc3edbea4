/*
 * questions.h: how many points and rays a second are answered, by the host and by the device.
 */
#ifndef KRS_BENCH_QUESTIONS_H
#define KRS_BENCH_QUESTIONS_H

#include "bench/bench.h"

enum { ANSWERER_HOST, ANSWERER_DEVICE, ANSWERER_COUNT };
extern const char *const answerer_names[ANSWERER_COUNT];

/* Medians, for the tree of 28 levels. */
typedef struct Questions {
    size_t points[ANSWERER_COUNT], rays[ANSWERER_COUNT]; /* asked at once */
    double points_per_second[ANSWERER_COUNT], rays_per_second[ANSWERER_COUNT];
    double alone_ms; /* from one question to the device until its answer */
    double disagree; /* share of rays that hit for one of them only */
} Questions;

void questions_run(Bench *bench, Questions *questions);
/* Adds what is not as it should be. */
void questions_judge(const Questions *questions, Text *faults);

#endif
