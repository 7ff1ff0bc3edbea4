/*
 * outline.h: plane figures between closed contours of lines and quadratic Bezier curves.
 *
 * Contours may overlap, cross and touch each other and themselves, as those of letters and drawings
 * do.  The outline is what is left of them: pieces that have the inside on their left only, and meet
 * at their ends only.  Then the nearest piece alone tells the signed distance.
 */
#ifndef KRS_OUTLINE_H
#define KRS_OUTLINE_H

#include <stdint.h>

#include "compiler/outline/path.h"

/* The rule of the inside: where contours go around, in all, an odd number of times, not 0 times, to
   the left at least once or at least twice. */
typedef enum FillRule { FILL_EVEN_ODD, FILL_NONZERO, FILL_POSITIVE, FILL_TWICE } FillRule;

/*
 * A piece of an outline.  What is nearest to an end of it lies on the outer side of the corner
 * there: on the side of its bisector, a rotated normal.  `corner` is the tangent of the angle
 * between both.
 */
typedef struct Piece {
    Curve  curve;
    double corner[2]; /* at its first and its last end, in the direction of the curve */
    double lean;      /* how much the inside grows here: see below */
} Piece;

/*
 * Near the tip of a sharp corner both sides are equally near, as far as single precision can tell,
 * and each would say something else.  There the inside grows, or in a sharp notch shrinks, by as much
 * as numbers are uncertain: LEAN of the largest coordinate.
 */
#define LEAN 5e-7

typedef struct Outline {
    Piece   *pieces;
    uint32_t count;
    double   low[2], high[2]; /* around them; low > high where there are none */
    double   size;            /* the largest coordinate */
} Outline;

/* Why contours have no outline. */
typedef enum OutlineFault {
    OUTLINE_GOOD,
    OUTLINE_TOO_MANY,  /* curves or crossings */
    OUTLINE_UNRESOLVED /* curves run along each other, all but equal */
} OutlineFault;

/* Makes the outline of contours.  Lengths below a thousand-millionth of their size count as 0.
   `fault_at` is where the fault is. */
OutlineFault outline_make(Outline *outline, const Curves *curves, FillRule rule, Arena *arena,
                          Arena *scratch, double fault_at[2]);

/* Returns the signed distance to a piece: to its nearest point, negative where that has the
   inside. */
double piece_distance(const Piece *piece, const double point[2]);

#endif
