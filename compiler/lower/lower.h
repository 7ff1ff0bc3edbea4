/*
 * lower.h: from shapes to nodes of the graph.
 */
#ifndef KRS_LOWER_H
#define KRS_LOWER_H

#include "compiler/lower/along_method.h"
#include "compiler/shape/shape.h"

/* What is computed for a component at a point: the roots of its graph. */
typedef enum ComponentRoot {
    ROOT_DISTANCE, /* FLOAT, safe: divided by the slope of the shape */
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) ROOT_##name,
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends)            ROOT_##name,
#include "compiler/shape/surface.def"
    ROOT_NORMAL, /* VEC3, unit: OP_NORMAL, but for smooth mirrors */
    ROOT_COUNT
} ComponentRoot;

/* What surface.def says of a root; of the distance and the normal, nothing. */
typedef struct RootInfo {
    const char *name;
    GraphType   type, shown;        /* of the node, and in shaders */
    double      otherwise, nothing; /* in each element */
    bool        material;           /* it is a property of materials, */
    double      low, high;          /* and limited to these: in pictures, */
    bool        limited;            /* and in answers too */
} RootInfo;
extern const RootInfo root_info[ROOT_COUNT];
/* Its value where no material and no shape says another. */
Node root_otherwise(Graph *graph, ComponentRoot root);

/* Lowers a shape at the point OP_POINT; roots[ROOT_COUNT] are filled.  False when more than
   MOST_LOWERED nodes would be needed: copies within copies. */
bool lower_component(Graph *graph, const Shape *shape, Arena *scratch, Node *roots);

/*
 * What to march by instead of ROOT_DISTANCE where branches save time: levels of sequences that are
 * far away for their size are left out (OP_guard), and those smaller than OP_FOOTPRINT.  Never
 * above the distance to the surface, and not above 0 in the same places, but often less than
 * ROOT_DISTANCE, and it jumps.  `plain`, which is ROOT_DISTANCE, when it grows too large.
 */
Node lower_guarded(Graph *graph, const Shape *shape, Node plain, Arena *scratch);

/*
 * How far a ray from OP_POINT along OP_DIRECTION may go before it can enter the shape, negative
 * when it is within and looks for the way out: at least the distance, and where polynomials bound
 * the shape, or inversions are above it, much more.  `plain`, which is ROOT_DISTANCE, where that is
 * as good.
 */
Node lower_along(Graph *graph, const Shape *shape, Node plain, AlongMethod method, Arena *scratch);

/*
 * The gradient of ROOT_DISTANCE, a VEC3 of any length, and in `near` what it is the gradient of,
 * which is about the distance near the surface; false when some operation has no derivative, or
 * when that would grow too large.
 */
bool lower_gradient(Graph *graph, const Shape *shape, Node *gradient, Node *near, Arena *scratch);

/* Whether there are sheets in it that have no thickness: its distance is 0 there, and nowhere
   negative around; only lower_along tells where a ray meets them. */
bool has_thin_sheets(const Shape *shape);

#endif
