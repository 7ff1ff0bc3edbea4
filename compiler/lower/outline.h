/*
 * outline.h: the signed distance to an outline, as a function of an instance group (graph/instance_table.h).
 *
 * Its instances are curves, of which the nearest one decides, by its distance and its side.  The cells
 * of the grid that none of them is in say by the sign of their clearance whether they are inside.
 */
#ifndef KRS_LOWER_OUTLINE_H
#define KRS_LOWER_OUTLINE_H

#include "compiler/graph/instance_table.h"
#include "compiler/outline/outline_instances.h"

typedef struct OutlineFunction {
    double   margin; /* within which distances are exact */
    uint32_t function;
} OutlineFunction;

typedef struct OutlineShape {
    Outline          outline;
    OutlineInstances instances;
    Curves           drawn; /* what it was made of */
    FillRule         rule;
    Span             span;
    struct {
        OutlineFunction *items;
        size_t           count, capacity;
    } functions;
} OutlineShape;

/* Returns the distance at a point of the plane z = 0: exact up to `margin`, beyond it at most the
   true one.  The graph gets a function for each margin. */
Node outline_distance(Graph *graph, OutlineShape *shape, double margin, Node point, bool *is_new,
                      Arena *scratch);

#endif
