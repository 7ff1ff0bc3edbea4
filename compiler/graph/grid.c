/*
 * grid.c: which instances of a grid are near a point.
 */
#include <math.h>
#include <string.h>

#include "compiler/graph/grid.h"

size_t grid_cell_count(const Grid *grid)
{
    return (size_t)grid->cells[0] * grid->cells[1] * grid->cells[2];
}

uint32_t grid_cell_along(const Grid *grid, int axis, double coordinate)
{
    double cell = (coordinate - grid->low[axis]) / grid->size;
    if (cell <= 0)
        return 0;
    return cell < grid->cells[axis] ? (uint32_t)cell : grid->cells[axis] - 1;
}

static double outside(double low, double high, double coordinate)
{
    return fmax(fmax(low - coordinate, coordinate - high), 0);
}

/* ---- the list of a cell ---- */

double distance_to_box(const Box *box, const double point[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double away = outside(box->axis[k].low, box->axis[k].high, point[k]);
        square += away * away;
    }
    return sqrt(square);
}

double distance_of_boxes(const Box *box, const Range *sides)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const Range  axis = box->axis[k];
        const double away = max2(max2(axis.low - sides[k].high, sides[k].low - axis.high), 0);
        square += away * away;
    }
    return sqrt(square) * (1 - 1e-12);
}

const uint32_t *grid_find(const Grid *grid, const double point[3], uint32_t *count,
                          double *clearance)
{
    size_t cell = 0;
    for (int k = 2; k >= 0; k--) {
        double along = floor((point[k] - grid->low[k]) / grid->size);
        if (!(along >= 0 && along < grid->cells[k])) {
            *count     = 0;
            *clearance = distance_to_box(&grid->inner, point);
            return grid->instances;
        }
        cell = cell * grid->cells[k] + (size_t)along;
    }
    *count     = grid->first[cell + 1] - grid->first[cell];
    *clearance = grid->clearance[cell];
    return grid->instances + grid->first[cell];
}

/* ---- the lists of all cells that a ball meets ---- */

/* Tells how far a point is from a cell along an axis. */
static double outside_cell(const Grid *grid, int axis, uint32_t cell, double coordinate)
{
    double low = grid->low[axis] + cell * grid->size;
    return outside(low, low + grid->size, coordinate);
}

/* Returns the first of the instances from `first` on in an ascending list. */
static const uint32_t *list_from(const uint32_t *list, const uint32_t *end, uint32_t first)
{
    while (list < end) {
        const uint32_t *middle = list + (end - list) / 2;
        if (*middle < first)
            list = middle + 1;
        else
            end = middle;
    }
    return list;
}

static void add_list(const Grid *grid, size_t cell, NearInstances *near)
{
    const uint32_t *end  = grid->instances + grid->first[cell + 1];
    const uint32_t *list = list_from(grid->instances + grid->first[cell], end, near->first);
    for (; list < end && *list - near->first < near->count; list++)
        near->bits[(*list - near->first) / 64] |= (uint64_t)1 << (*list - near->first) % 64;
}

/* Tells how far the far side of a cell is from a point along an axis. */
static double far_side(const Grid *grid, int axis, uint32_t cell, double coordinate)
{
    double low = grid->low[axis] + cell * grid->size;
    return fmax(coordinate - low, low + grid->size - coordinate);
}

/* Adds the cells of a row along x that are not farther than `away` along it, and not all within
   `clear`. */
static void add_row(const Grid *grid, size_t row, double x, double away, double clear,
                    NearInstances *near)
{
    uint32_t last = grid_cell_along(grid, 0, x + away);
    for (uint32_t cell = grid_cell_along(grid, 0, x - away); cell <= last; cell++)
        if (far_side(grid, 0, cell, x) > clear)
            add_list(grid, row + cell, near);
}

static double root_or_nothing(double square) { return square > 0 ? sqrt(square) : -1; }

/* A part of a cell's side that rounding may miss is less than boxes are larger in the lists. */
void grid_near(const Grid *grid, const double point[3], double radius, double clear,
               NearInstances *near)
{
    uint32_t first[3], last[3];
    memset(near->bits, 0, (near->count + 63) / 64 * sizeof near->bits[0]);
    if (isinf(grid->size)) { /* one cell for all of space */
        add_list(grid, 0, near);
        return;
    }
    for (int k = 1; k < 3; k++) {
        first[k] = grid_cell_along(grid, k, point[k] - radius);
        last[k]  = grid_cell_along(grid, k, point[k] + radius);
    }
    for (uint32_t z = first[2]; z <= last[2]; z++) {
        double away_z = outside_cell(grid, 2, z, point[2]), far_z = far_side(grid, 2, z, point[2]);
        for (uint32_t y = first[1]; y <= last[1]; y++) {
            double away_y = outside_cell(grid, 1, y, point[1]);
            double far_y  = far_side(grid, 1, y, point[1]);
            double within = root_or_nothing(clear * clear - far_y * far_y - far_z * far_z);
            double left   = radius * radius - away_y * away_y - away_z * away_z;
            size_t row    = ((size_t)z * grid->cells[1] + y) * grid->cells[0];
            if (left >= 0)
                add_row(grid, row, point[0], sqrt(left), within, near);
        }
    }
}

bool grid_is_within(const Grid *grid, const double point[3], double radius)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double low = grid->low[k], high = low + grid->cells[k] * grid->size;
        double away = fmax(point[k] - low, high - point[k]);
        square += away * away;
    }
    return square <= radius * radius;
}
