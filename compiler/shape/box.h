/*
 * box.h: bounding volumes of shapes: boxes with sides of ranges, and balls.
 */
#ifndef KRS_BOX_H
#define KRS_BOX_H

#include "compiler/graph/range.h"

extern const Box box_empty, box_infinite;

bool box_is_empty(Box box);
bool box_is_finite(Box box);
Box  box_hull(Box a, Box b);
Box  box_common(Box a, Box b);
/* Returns a box that is larger by `by` on every side. */
Box box_grow(Box box, double by);
Box box_move(Box box, const Range by[3]);
/* Returns the box around a box after a linear map with these rows, each entry a range. */
Box    box_rotate(Box box, Range rows[3][3]);
double box_diagonal(Box box);
/* Finds the middle of a finite box. */
void box_centre(Box box, double centre[3]);
/* Tells how far the side `content` of a box stays from the walls of a cell that is centred at 0;
   < 0: it sticks out. */
double cell_margin(Range content, double period);

typedef struct Ball {
    double centre[3];
    double radius; /* < 0: empty; may be infinite */
} Ball;

/* Returns a ball around a box, which is infinite unless the box is finite. */
Ball ball_around(Box box);
Box  ball_box(Ball ball);
Ball ball_hull(Ball a, Ball b);
/* Returns the ball of what is in `ball` with u.x <= w, and its mirror image (math.md 1, "Bounding
   balls"), for a unit vector and an offset that may move in their ranges. */
Ball ball_fold(Ball ball, const Range u[3], Range w);
/* Returns the box around the same set; ranges for mirrors that move. */
Box box_fold(Box box, const Range u[3], Range w);

#endif
