/* lanes_avx2.c: lane tapes for processors with AVX2; their flags are in the Makefile. */
#define REAL      double
#define LANE_LOOP lane_double_avx2
#include "compiler/graph/lanes/lane_loop.h"
#define REAL      float
#define LANE_LOOP lane_single_avx2
#define CELL_LOOP lane_cells_avx2
#define WIDE_LOOP lane_wide_avx2
#include "compiler/graph/lanes/lane_loop.h"
