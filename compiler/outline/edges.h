/*
 * edges.h: the curves of contours, cut where they meet: the steps of outline_make.
 */
#ifndef KRS_EDGES_H
#define KRS_EDGES_H

#include "compiler/outline/knots.h"
#include "compiler/outline/outline.h"

/* A curve between two knots, along which neither coordinate turns back. */
typedef struct Edge {
    Curve    curve;
    uint32_t from, to;
    int      weight; /* how many times contours go along it, less how many times back */
} Edge;

typedef struct Edges {
    Edge  *items;
    size_t count, capacity;
} Edges;

/* Contours may have so many edges, and where they cross so many cuts. */
enum { MAX_EDGES = 400000 };

/* Everything at hand while an outline is made; all of it is scratch. */
typedef struct Making {
    Arena *arena;
    Knots  knots;
    Edges  edges;
    double fault_at[2];
} Making;

/* Adds an edge between the knots at its ends, unless they are one. */
void add_edge(Making *making, const Curve *curve, int weight);
/* edge_cuts.c: cuts edges where they meet others, so that they share knots only. */
OutlineFault cut_edges(Making *making);
/* edge_sides.c: whether there is inside on the left and on the right of each edge. */
typedef struct Sides {
    bool left, right;
} Sides;
Sides *edge_sides(const Making *making, FillRule rule);
/* Returns where an edge that goes from one side of a line to the other crosses it: the line has this
   level, and is along `axis`. */
double edge_crossing(const Curve *curve, int axis, double level);

#endif
