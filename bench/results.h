/*
 * results.h: all that a run of the bench found, and how it is told.
 */
#ifndef KRS_BENCH_RESULTS_H
#define KRS_BENCH_RESULTS_H

#include "bench/contest.h"
#include "bench/growth.h"
#include "bench/krs.h"
#include "bench/latency.h"
#include "bench/machine.h"
#include "bench/questions.h"
#include "bench/triangles.h"

typedef struct Results {
    const char *date; /* 2026-11-21 */
    Machine     machine;
    Peak        peak;
    Contest    *contests;
    size_t      contest_count;
    Growth      growth;
    Sequences   sequences;
    Triangles   triangles;
    Questions   questions;
    Latency     latency;
    Text        faults; /* what is not right, a line each */
} Results;

/* Everything, for programs. */
void results_json(const Bench *bench, const Results *results, Text *json);

/* Everything, for readers: tables in Markdown. */
void results_tables(const Bench *bench, const Results *results, Text *text);

#endif
