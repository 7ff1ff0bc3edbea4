/*
 * svg.h: drawings in SVG as contours with colours.
 *
 * Areas and strokes are read: of paths, rectangles, circles, ellipses, lines and polygons, in groups with
 * transforms, styled by rules, and used again.  What else is drawn is left out, and noted with its line.
 */
#ifndef KRS_SVG_H
#define KRS_SVG_H

#include "compiler/outline/outline.h"

/* One shape.  Its colour is sRGB, 0xrrggbb. */
typedef struct SvgFigure {
    Curves   curves;
    FillRule rule;
    uint32_t rgb;
    unsigned line;
} SvgFigure;

typedef struct SvgNote {
    const char *what;
    unsigned    line;
} SvgNote;

typedef struct SvgDrawing {
    Arena *arena;
    struct {
        SvgFigure *items;
        size_t     count, capacity;
    } figures; /* in the order in which they are drawn, y downwards */
    struct {
        SvgNote *items;
        size_t   count, capacity;
    } notes;                     /* what was left out */
    double      low[2], high[2]; /* of its view; low > high: it has none */
    const char *fault;           /* why it cannot be read */
    unsigned    fault_line;
} SvgDrawing;

/* Reads a drawing, whose `arena` is set; false: it cannot be read. */
bool svg_read(SvgDrawing *drawing, const char *bytes, size_t length);

#endif
