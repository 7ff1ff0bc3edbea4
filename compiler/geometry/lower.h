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

/* Lowers a shape at the point OP_POINT; roots[ROOT_COUNT] are filled.  False when more than
   MOST_LOWERED nodes would be needed: copies within copies. */
enum { MOST_LOWERED = 400000 };
bool lower_component(Graph *graph, const Shape *shape, Arena *scratch, Node *roots);

#endif
