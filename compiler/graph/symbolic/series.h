/*
 * series.h: polynomials of the point as power series about a point.
 *
 * A polynomial stays as it was written, in factors, and never multiplied out: its series about
 * a place comes from the series of its operands, by sums and products (math.md, section 3, "jets").
 */
#ifndef KRS_SERIES_H
#define KRS_SERIES_H

#include "compiler/graph/graph.h"

enum { MAX_DEGREE = 24 };

/* c[0] + c[1] t + ... + c[degree] t^degree; FLOAT nodes. */
typedef struct Series {
    uint32_t degree;
    Node     c[MAX_DEGREE + 1];
} Series;

/* The reason why graph_series could not make a series, and where. */
typedef struct SeriesFault {
    Node     blame;  /* an operation that no polynomial has, or */
    uint32_t degree; /* one whose degree is more than MAX_DEGREE; else 0 */
} SeriesFault;

/* Expands `root` (FLOAT) along the line origin + t direction (VEC3 nodes).  False when it is not a
   polynomial of the point, or one of too high a degree. */
bool graph_line_series(Graph *graph, Node root, Node origin, Node direction, Series *series,
                       SeriesFault *fault, Arena *scratch);

/*
 * Expands `root` in the balls around `point` (a VEC3 node): c[0] is its value there, c[1] the length
 * of its gradient, and the others are so large that for every direction v of length 1
 *     |root(point + r v) - c[0]| <= c[1] r + c[2] r^2 + ... + c[degree] r^degree.
 * So there is no zero within the r where the right side reaches |c[0]|.
 */
bool graph_ball_series(Graph *graph, Node root, Node point, Series *series, SeriesFault *fault,
                       Arena *scratch);

/* Returns the r > 0 with |c[0]| = c[1] r + c[2] r^2 + ..., or a little less, of a series whose
   c[1], c[2] ... are not negative. */
Node series_radius(Graph *graph, const Series *series);

#endif
