/* lanes_plain.c: lane tapes for plain C; their flags are in the Makefile. */
#define REAL      double
#define LANE_LOOP lane_double_plain
#include "compiler/graph/lanes/lane_loop.h"
#define REAL      float
#define LANE_LOOP lane_single_plain
#ifndef WITHOUT_CELLS
#define CELL_LOOP lane_cells_plain
#define WIDE_LOOP lane_wide_plain
#endif
#include "compiler/graph/lanes/lane_loop.h"
