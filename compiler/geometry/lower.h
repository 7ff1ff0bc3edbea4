/*
 * lower.h: from shapes to nodes of the graph.
 */
#ifndef KRS_LOWER_H
#define KRS_LOWER_H

#include "compiler/geometry/shape.h"

/* What is computed for a component at a point: the roots of its graph. */
typedef enum ComponentRoot {
    ROOT_DISTANCE, /* FLOAT, safe: divided by the slope of the shape */
    ROOT_COLOR,    /* VEC3 */
    ROOT_ROUGHNESS,
    ROOT_METALLIC,
    ROOT_EMISSION, /* VEC3 */
    ROOT_LEVEL,    /* FLOAT */
    ROOT_INSTANCE, /* UINT */
    ROOT_COUNT
} ComponentRoot;

enum { MOST_LOWERED = 400000 };

/* Lowers a shape at the point OP_POINT; roots[ROOT_COUNT] are filled.  False when more than
   MOST_LOWERED nodes would be needed: copies within copies. */
bool lower_component(Graph *graph, const Shape *shape, Arena *scratch, Node *roots);

/* Distance to a finite box, 0 inside. */
Node box_distance(Graph *graph, Node point, Box box);

/* What grows `slope` times as fast as distance, made safe. */
Node divide_by_slope(Graph *graph, Node distance, double slope);

#endif
