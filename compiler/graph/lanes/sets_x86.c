/*
 * sets_x86.c: the instruction sets of x86-64 that lanes are compiled for.
 */
#include "compiler/graph/lanes/lane_call.h"

static const LaneSet all_sets[] = {
    {"avx512", {lane_double_avx512, lane_single_avx512}, lane_cells_avx512, lane_wide_avx512},
    {"avx2", {lane_double_avx2, lane_single_avx2}, lane_cells_avx2, lane_wide_avx2},
    {"plain", {lane_double_plain, lane_single_plain}, lane_cells_plain, lane_wide_plain},
};
enum { SETS = sizeof all_sets / sizeof *all_sets };

static size_t first_set(void)
{
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return 0;
    return __builtin_cpu_supports("avx2") ? 1 : 2;
}

size_t lane_sets(const LaneSet **sets)
{
    *sets = &all_sets[first_set()];
    return SETS - first_set();
}
