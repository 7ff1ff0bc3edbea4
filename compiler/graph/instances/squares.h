/*
 * squares.h: squared distances in a grid.
 */
#ifndef KRS_SQUARES_H
#define KRS_SQUARES_H

#include <stdint.h>

#include "compiler/base/arena.h"

/* Replaces the value of each cell by the least sum of any cell's value and the square of the
   distance to that cell.  HUGE_VAL stands for cells that do not count.  x runs fastest, then y. */
void squares_transform(const uint32_t cells[3], double *values, Arena *scratch);

#endif
