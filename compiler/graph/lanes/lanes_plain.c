/* lanes_plain.c: lane tapes for plain C; their flags are in the Makefile. */
#define REAL        double
#define LANE_KERNEL lane_double_plain
#include "compiler/graph/lanes/lane_kernel.h"
#define REAL        float
#define LANE_KERNEL lane_single_plain
#include "compiler/graph/lanes/lane_kernel.h"
