/*
 * context.h: one walk through a tree of shapes: what goes down, and what comes back.
 *
 * Each kind of shape is lowered by the function of its family (shapes.def).
 */
#ifndef KRS_CONTEXT_H
#define KRS_CONTEXT_H

#include "compiler/lower/along_method.h"
#include "compiler/shape/shape.h"

/* What a hit needs (surface.def); NODE_NONE in `color`: not painted yet.  `normal` is in the space
   of the shape that was lowered; it need not be a unit vector (unit_normal). */
typedef struct Surface {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) Node name;
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends)            Node name;
#define KRS_INNER(name, blends)                                                Node name;
#include "compiler/shape/surface.def"
} Surface;

typedef struct Lowered {
    Node    distance; /* NODE_NONE: the empty set */
    Surface surface;
} Lowered;

/* A shape that has been lowered, the point where, and its distance there. */
typedef struct LoweredShape {
    const struct Shape *shape;
    Node                point, distance; /* `distance` may be NODE_NONE */
} LoweredShape;
typedef struct LoweredShapes {
    LoweredShape *items;
    size_t        count, capacity;
} LoweredShapes;

typedef struct Nodes {
    Node  *items;
    size_t count, capacity;
} Nodes;

typedef struct Lowering {
    Graph         *graph;
    Arena         *scratch;
    bool           surfaces; /* else the distance alone */
    AlongMethod    method;   /* of ray_step.c */
    bool           thin;     /* rays pass all that is around: sheets have no thickness */
    bool           guarded;  /* what is far is left out (guards.c) */
    Node           unit;     /* guarded: how long 1 is outside of everything */
    size_t         most;     /* nodes that the graph may have */
    bool           overflow;
    Nodes         *held_constant;  /* for lower_gradient: nodes that count as constants; or NULL */
    LoweredShapes *lowered_shapes; /* NULL, or a list of all shapes, children first */
} Lowering;

/* Where a shape is lowered: the mapped point, and the sequence around it.  `lipschitz` says that
   something above (a blend, an offset) moves the zero set and so needs the slope.  With surfaces
   also the normal of the surface and the radius of a pixel, in the shape's space. */
typedef struct LowerContext {
    Node point, level, instance; /* level, instance: NODE_NONE outside of sequences */
    bool lipschitz;
    Node normal, footprint;
    Node smoothing; /* the width over which normals change sides of a mirror; NODE_NONE: at once */
} LowerContext;

/* Outside of all shapes, for a lowering without surfaces. */
LowerContext context_new(Node point, bool lipschitz);

extern const Lowered lowered_nothing;

/* The same context at another point; the same below something that needs the slope. */
LowerContext context_at(LowerContext context, Node point);
LowerContext context_lipschitz(LowerContext context);

/* The most nodes that one shape is lowered to. */
enum { MOST_LOWERED = 400000 };

/* Whether rays that go from root to root of what is in a shape are rays to the shape. */
bool    rays_pass(const Shape *shape);
Lowered lower_shape(Lowering *l, const Shape *shape, LowerContext context);

Lowered scale_distance(Lowering *l, Lowered result, Node factor);
/* Takes up the unit behind a map that enlarges; returns the one to go back to. */
Node enter_scale(Lowering *l, Node scale);

/* ---- compiler/family: how each kind is lowered ---- */
typedef Lowered LowerShape(Lowering *l, const Shape *shape, LowerContext context);
#define SHAPE(KIND, name, ...) LowerShape lower_##name;
#include "compiler/shape/shapes.def"

#endif
