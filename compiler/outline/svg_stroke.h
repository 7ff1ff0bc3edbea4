/*
 * svg_stroke.h: strokes of paths as areas, by SVG 1.1, 11.4.
 */
#ifndef KRS_SVG_STROKE_H
#define KRS_SVG_STROKE_H

#include "compiler/outline/svg_shapes.h"

typedef enum SvgCap { CAP_BUTT, CAP_ROUND, CAP_SQUARE } SvgCap;
typedef enum SvgJoin { JOIN_MITER, JOIN_ROUND, JOIN_BEVEL } SvgJoin;

typedef struct SvgStroke {
    double        width, miter_limit;
    SvgCap        cap;
    SvgJoin       join;
    const double *dashes; /* lengths that are drawn and left out by turns; an even number of them */
    int           dash_count;
    double        dash_offset;
} SvgStroke;

/* Draws the area of the stroke: contours that all turn the same way, for FILL_NONZERO.  Curves leave it
   by the pen's tolerance. */
void svg_stroke(SvgPen *pen, const SvgTrail *trail, const SvgStroke *stroke);

#endif
