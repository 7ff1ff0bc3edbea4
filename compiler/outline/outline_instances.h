/*
 * outline_instances.h: the pieces of an outline as the rows of a table.
 *
 * A row is a curve start + 2 tangent t + bend t^2, 0 <= t <= 1, that turns by 45 degrees at most
 * and is bent less and less.  So the nearest point has the largest root of a cubic that is convex
 * there, and a few steps of Newton's method from t = 1 find it.  Of an outline without curves there
 * are fewer columns: start + tangent t.
 */
#ifndef KRS_OUTLINE_INSTANCES_H
#define KRS_OUTLINE_INSTANCES_H

#include "compiler/outline/outline.h"

typedef enum OutlineColumn {
    COLUMN_START,
    COLUMN_TANGENT      = 2,
    COLUMN_FIRST_CORNER = 4,
    COLUMN_LAST_CORNER,
    COLUMN_LEAN,
    COLUMN_SIDE, /* -1: the row goes against the piece, so that the inside is on its right */
    LINE_COLUMNS,
    COLUMN_BEND      = LINE_COLUMNS,
    COLUMN_BEND_BEND = COLUMN_BEND + 2, /* products that rows know in double precision */
    COLUMN_TANGENT_BEND,
    CURVE_COLUMNS
} OutlineColumn;

/* Steps of Newton's method. */
enum { OUTLINE_STEPS = 8 };

typedef struct OutlineInstances {
    Piece   *pieces; /* one for each row */
    uint32_t count, columns;
    double  *numbers; /* row by row */
} OutlineInstances;

OutlineInstances outline_instances(const Outline *outline, Arena *arena, Arena *scratch);

/* Tells whether points are inside, in rows of `count` points from `low` on, `step` apart; for points that are
   not on the outline.  `inside` has them row by row. */
void outline_fill(const Outline *outline, const double low[2], double step, const uint32_t count[2],
                  bool *inside, Arena *scratch);

#endif
