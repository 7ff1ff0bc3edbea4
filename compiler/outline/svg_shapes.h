/*
 * svg_shapes.h: numbers and shapes of SVG, which have a form of their own.
 */
#ifndef KRS_SVG_SHAPES_H
#define KRS_SVG_SHAPES_H

#include "compiler/outline/path.h"

/* x' = m[0] x + m[2] y + m[4], y' = m[1] x + m[3] y + m[5] */
typedef struct SvgMap {
    double m[6];
} SvgMap;

/* The curves from one `M` to the next, before the map, for strokes. */
typedef struct SvgSubpath {
    Path path;
    bool drawn, closed; /* something follows its first point; it ends with `Z` */
} SvgSubpath;

typedef struct SvgTrail {
    SvgSubpath *items;
    size_t      count, capacity;
} SvgTrail;

/* A path that is drawn behind a map. */
typedef struct SvgPen {
    Path      path;
    SvgMap    map;
    SvgTrail *trail; /* gets what is drawn; or NULL */
} SvgPen;

void pen_move(SvgPen *pen, const double to[2]);
void pen_line(SvgPen *pen, const double to[2]);
void pen_quadratic(SvgPen *pen, const double via[2], const double to[2]);
void pen_cubic(SvgPen *pen, const double first[2], const double second[2], const double to[2]);
/* Ends a contour where it began. */
void pen_close(SvgPen *pen);

/* Reads the next number of a list, whose elements are separated by blanks or a comma; false: there
   is none. */
bool svg_number(const char **text, double *number);
/* Reads as many numbers as there are, at most `most`. */
int svg_numbers(const char *text, double *numbers, int most);
/* Returns the map that applies first `inner`, then `outer`. */
SvgMap svg_product(const SvgMap *outer, const SvgMap *inner);
/* Reads the attribute `transform`; false: it means nothing. */
bool svg_transform(const char *text, SvgMap *map);

/* Draws the attribute `d` of a path; false: from some place on it means nothing. */
bool svg_path(SvgPen *pen, const char *text);
void svg_rectangle(SvgPen *pen, const double corner[2], const double size[2],
                   const double radii[2]);
void svg_ellipse(SvgPen *pen, const double center[2], const double radii[2]);
bool svg_polygon(SvgPen *pen, const char *points, bool closed);

#endif
