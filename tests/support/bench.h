/*
 * bench.h: an empty graph for each test of a group, for tests of what works on graphs.
 */
#ifndef SUPPORT_BENCH_H
#define SUPPORT_BENCH_H

#include "compiler/base/arena.h"
#include "compiler/graph/graph.h"

#include "tests/support/random.h"

typedef struct Bench {
    Memory memory;
    Arena  arena;
    Graph *graph;
    Node   point, x, y, z;
    Random random;
} Bench;

/* For cmocka: *state is the Bench, until bench_stop. */
int bench_start(void **state);
int bench_stop(void **state);

#endif
