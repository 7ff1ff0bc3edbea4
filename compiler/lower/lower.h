/*
 * lower.h: from shapes to nodes of the graph.
 */
#ifndef KRS_LOWER_H
#define KRS_LOWER_H

#include "compiler/shape/shape.h"

struct LoweredGroups; /* instance_groups.h */

/* The roots of a component's graph: what is computed at a point. */
typedef enum ComponentRoot {
    ROOT_DISTANCE, /* FLOAT, divided by the slope of the shape, so that it is a safe step */
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) ROOT_##name,
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends)            ROOT_##name,
#include "krs/surface.def"
    ROOT_NORMAL, /* VEC3, unit: OP_NORMAL, unless smooth mirrors or bumps change it */
    ROOT_COUNT
} ComponentRoot;

/* The columns of surface.def.  ROOT_DISTANCE and ROOT_NORMAL are not in it: their rows are 0. */
typedef struct RootInfo {
    const char *name;
    GraphType   type, shown;        /* of the node; in shaders */
    double      otherwise, nothing; /* where no shape sets it; in a scene without components */
    bool        material;           /* it is a property of materials */
    double      low, high;          /* of a property: its range in pictures */
    bool        limited;            /* the range holds for answers to queries, too */
} RootInfo;
extern const RootInfo root_info[ROOT_COUNT];
/* Returns the value of a root where no material and no shape sets it. */
Node root_otherwise(Graph *graph, ComponentRoot root);

/* All of these take the instances of the scene (instance_groups.h) as `instances`, or NULL. */

/* Lowers a shape at the point OP_POINT and sets roots[ROOT_COUNT].  `number` is that of the component,
   from 1, where the shape's parts have none of their own (Shape.shown).  *place, unless NULL, is where its
   material reads a texture, a VEC2, or NODE_NONE.  False when that needs more than MAX_LOWERED nodes, for
   example for copies of copies. */
bool lower_component(Graph *graph, const Shape *shape, uint32_t number,
                     struct LoweredGroups *groups, Arena *scratch, Node *roots, Node *place);

/* Lowers the distance of a shape alone, and nothing else of it; as ROOT_DISTANCE. */
bool lower_solid(Graph *graph, const Shape *shape, struct LoweredGroups *groups, Arena *scratch,
                 Node *distance);

/*
 * Lowers a distance for marching that replaces ROOT_DISTANCE where branches save time.  OP_guard
 * skips levels of sequences that are far away compared with their size, or smaller than
 * OP_FOOTPRINT. The result is a bound and positive in the same places as ROOT_DISTANCE, but often
 * smaller, and it jumps.  It is `plain`, which is ROOT_DISTANCE, when the graph would be too large.
 */
Node lower_guarded(Graph *graph, const Shape *shape, Node plain, struct LoweredGroups *groups,
                   Arena *scratch);

/*
 * Returns how far a ray from OP_POINT along OP_DIRECTION may go before it can enter the shape.
 * Inside it is negative: how far the ray may go before it can leave.  It is at least the distance,
 * and much more where the shape is given by polynomials or has open surfaces.  Else it is `plain`,
 * which is ROOT_DISTANCE.
 */
Node lower_along(Graph *graph, const Shape *shape, Node plain, struct LoweredGroups *groups,
                 Arena *scratch);
/* Tells whether there is a map that inverts in a shape, below kinds in whose parts rays have images. */
bool reaches_inversion(const Shape *shape);

/*
 * Lowers the gradient of a function that is about ROOT_DISTANCE near the surface, and in `near`
 * that function.  The gradient is a VEC3 of any length.  False when an operation has no derivative,
 * or when the graph would be too large.
 */
bool lower_gradient(Graph *graph, const Shape *shape, Node *gradient, Node *near,
                    struct LoweredGroups *groups, Arena *scratch);

/* Tells whether a shape has open surfaces without thickness.  Their distance is 0, but nowhere near them is it
   negative, so only lower_along finds where a ray meets them. */
bool has_thin_open_surfaces(const Shape *shape);

#endif
