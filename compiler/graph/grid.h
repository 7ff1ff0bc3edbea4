/*
 * grid.h: which of many boxes are near a point: a grid of cubic cells, with a list for each.
 *
 * The list of a cell has all instances whose box is nearer to the cell than its margin and `reach`.
 * So, wherever a point is in the cell, all that is not listed is farther than the clearance of the cell,
 * even when distances up to `reach` apart influence each other (blends).
 */
#ifndef KRS_GRID_H
#define KRS_GRID_H

#include <stdbool.h>
#include <stdint.h>

#include "compiler/base/arena.h"
#include "compiler/graph/range.h"

typedef struct Grid {
    Box       inner; /* around all boxes, larger by `reach`; infinite where a box is, and when all
                        are empty */
    double    low[3], size; /* the corner of the first cell; the side of a cell */
    uint32_t  cells[3];     /* along each axis; x runs fastest, then y */
    uint32_t *first;        /* of each cell, where its list begins; one more: where the last ends */
    float    *clearance;    /* of each cell, above 0; rounded down.  A sign may be given to it: see
                               InstanceFunction.either */
    uint32_t *instances;    /* the lists, ascending where they have no tails */
    uint32_t  max_listed;   /* the length of the longest list */
    float    *tails, *middles; /* of entries and cells: grid_tails.h; NULL: there are none */
} Grid;

/*
 * Returns the list for a point, of *count instances.  No other instance is nearer than *clearance,
 * after all that `reach` allows for.  Outside of the grid the list is empty, and the clearance is
 * the distance to `inner`, which is there larger than some constant.
 */
const uint32_t *grid_find(const Grid *grid, const double point[3], uint32_t *count,
                          double *clearance);

size_t grid_cell_count(const Grid *grid);
/* Returns the number of the cell at a place along each axis. */
static inline size_t grid_cell_number(const Grid *grid, const uint32_t at[3])
{
    return ((size_t)at[2] * grid->cells[1] + at[1]) * grid->cells[0] + at[0];
}

/* Tells how far a point is from a box. */
double distance_to_box(const Box *box, const double point[3]);
/* Tells how far a box is from one with these three sides, at least. */
double distance_of_boxes(const Box *box, const Range *sides);

/* The instances that are asked for at once: bit i % 64 of bits[i / 64] tells whether instance first
   + i is near a point. */
enum { NEAR_AT_ONCE = 32768 };
typedef struct NearInstances {
    uint32_t first, count; /* at most NEAR_AT_ONCE */
    uint64_t bits[NEAR_AT_ONCE / 64];
} NearInstances;

/* Sets the bits of all whose box is nearer than radius + `reach`, and some that are farther: the lists
   of all cells that meet the ball, but for those that are in a ball of the radius `clear`, which no
   instance meets.  `first` and `count` are set before. */
void grid_near(const Grid *grid, const double point[3], double radius, double clear,
               NearInstances *near);
/* Tells whether all cells are in the ball, so that no instance is left out. */
bool grid_is_within(const Grid *grid, const double point[3], double radius);

/* Returns the cell along an axis with this coordinate, or the outermost one. */
uint32_t grid_cell_along(const Grid *grid, int axis, double coordinate);

#endif
