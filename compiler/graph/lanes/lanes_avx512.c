/* lanes_avx512.c: lane tapes for processors with AVX-512; their flags are in the Makefile. */
#define REAL        double
#define LANE_KERNEL lane_double_avx512
#include "compiler/graph/lanes/lane_kernel.h"
#define REAL        float
#define LANE_KERNEL lane_single_avx512
#include "compiler/graph/lanes/lane_kernel.h"
