/*
 * bench.c: an empty graph for each test.
 */
#include "tests/support/bench.h"

static jmp_buf out_of_memory;

int bench_start(void **state)
{
    static Bench bench;
    bench       = (Bench){.memory = {.exhausted = &out_of_memory}};
    bench.arena = (Arena){.memory = &bench.memory};
    bench.graph = graph_new(&bench.arena);
    bench.point = graph_leaf(bench.graph, OP_POINT);
    bench.x     = graph_component(bench.graph, bench.point, 0);
    bench.y     = graph_component(bench.graph, bench.point, 1);
    bench.z     = graph_component(bench.graph, bench.point, 2);
    *state      = &bench;
    return 0;
}

int bench_stop(void **state)
{
    arena_free(&((Bench *)*state)->arena);
    return 0;
}
