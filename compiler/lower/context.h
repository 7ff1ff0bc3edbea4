/*
 * context.h: lowering of a tree of shapes: what is passed down to each shape, and what it returns.
 *
 * Each kind of shape has a function in the file of its family (shapes.def).
 */
#ifndef KRS_CONTEXT_H
#define KRS_CONTEXT_H

#include "compiler/shape/shape.h"

/* The properties of the surface at a hit (surface.def).  `color` is NODE_NONE while nothing has
   been painted.  `normal` is in the space of the shape that was lowered.  It need not be a unit
   vector: see unit_normal. */
typedef struct Surface {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) Node name;
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends)            Node name;
#define KRS_INNER(name, blends)                                                Node name;
#include "krs/surface.def"
} Surface;

typedef struct Lowered {
    Node    distance; /* NODE_NONE: the empty set */
    Surface surface;
} Lowered;

/* A shape that has been lowered, the point in its space, and its distance there. */
typedef struct LoweredShape {
    const struct Shape *shape;
    Node                point, distance; /* `distance` may be NODE_NONE */
} LoweredShape;
typedef struct LoweredShapes {
    LoweredShape *items;
    size_t        count, capacity;
} LoweredShapes;

/* The t up to which a series, which is not 0 at t = 0, is not 0; it may change the series. */
struct Series; /* graph/symbolic/series.h */
typedef Node SeriesStep(Graph *graph, struct Series *series);

typedef struct Nodes {
    Node  *items;
    size_t count, capacity;
} Nodes;

typedef struct Lowering {
    Graph      *graph;
    Arena      *scratch;
    bool        surfaces;    /* lower the surface too, not the distance alone */
    SeriesStep *series_step; /* for ray_step.c; NULL: its own */
    bool        thin;        /* rays_pass for all shapes above: open surfaces have no thickness */
    bool        far;      /* without instance groups: distances to outlines are right everywhere */
    bool        guarded;  /* skip levels of sequences that are far away (guards.c) */
    Node        unit;     /* guarded: length, outside of all shapes, of 1 in this space */
    size_t      most;     /* nodes that the graph may have */
    bool        overflow; /* it would have more */
    struct LoweredGroups *groups;  /* instance_groups.h; NULL: each part is lowered for itself */
    Nodes         *held_constant;  /* for lower_gradient: nodes that count as constants; or NULL */
    LoweredShapes *lowered_shapes; /* gets all shapes, children first; or NULL */
    bool           places;         /* find Surface.place */
} Lowering;

/* The place where a shape is lowered: the point in the space of the shape, and the sequence around
   it.  `normal` and `footprint`, the radius of a pixel, are set in a lowering with surfaces
   only. */
typedef struct LowerContext {
    Node point, level, instance; /* level, instance: NODE_NONE outside of sequences */
    bool lipschitz; /* the slope is needed, as a blend or offset above moves the zero set */
    Node normal, footprint;
    double
         reach; /* how far from the surface distances must be right; beyond it they may be any bound
                     that is no less */
    bool fronts;    /* a material above asks which side of an open surface is seen */
    Node smoothing; /* width over which a mirror turns normals; NODE_NONE: mirrors are sharp */
} LowerContext;

/* Returns the context outside of all shapes, for a lowering without surfaces. */
LowerContext context_new(Node point, bool lipschitz);

/* The empty set. */
extern const Lowered lowered_nothing;

/* These return the same context at another point; the same context with `lipschitz` set and
   distances that are right everywhere, or as far as `more` beyond what was asked for. */
LowerContext context_at(LowerContext context, Node point);
LowerContext context_lipschitz(LowerContext context);
LowerContext context_lipschitz_within(LowerContext context, double more);
/* Returns the context with `lipschitz` set, where distances are divided by `factor`, at most,
   before they are used. */
LowerContext context_divided(LowerContext context, double factor);
/* Returns the reach behind a map that enlarges by `scale`. */
double reach_behind(const Graph *graph, double reach, Node scale);

/* Most nodes that one shape may add to the graph. */
enum { MAX_LOWERED = 4000000 };

/* Tells whether a step along a ray that is safe for the parts of a shape is safe for the shape. */
bool    rays_pass(const Shape *shape);
Lowered lower_shape(Lowering *l, const Shape *shape, LowerContext context);

Lowered scale_distance(Lowering *l, Lowered result, Node factor);
/* Sets `unit` for the space behind a map with this scale; returns the old one, to be restored. */
Node enter_scale(Lowering *l, Node scale);

/* ---- in compiler/family: the function that lowers each kind ---- */
typedef Lowered LowerShape(Lowering *l, const Shape *shape, LowerContext context);
#define SHAPE(KIND, name, ...) LowerShape lower_##name;
#include "compiler/shape/shapes.def"

#endif
