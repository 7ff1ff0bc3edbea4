/* lanes_avx512.c: lane tapes for processors with AVX-512; their flags are in the Makefile. */
#define REAL      double
#define LANE_LOOP lane_double_avx512
#include "compiler/graph/lanes/lane_loop.h"
#define REAL      float
#define LANE_LOOP lane_single_avx512
#define CELL_LOOP lane_cells_avx512
#define WIDE_LOOP lane_wide_avx512
#include "compiler/graph/lanes/lane_loop.h"
