/*
 * bounds.h: what is known of the distances of a scene's shapes, kept beyond the shapes.
 */
#ifndef KRS_BOUNDS_H
#define KRS_BOUNDS_H

#include "compiler/shape/shape.h"
#include "krs/krs.h"

enum { KRS_MAX_BOUNDS = 256 }; /* of one component */

/* An entry of a list.  In the trees of one loop most say the same, but for the box. */
typedef struct BoundEntry {
    const KrsBound *about; /* all but the box */
    double          low[3], high[3];
} BoundEntry;

typedef struct KrsBounds {
    BoundEntry *items;
    size_t      count;
    size_t      more; /* that there was no room for */
} KrsBounds;

/* Returns the list of one tree, in `arena`; it may share entries with the list of the tree before,
   or NULL. */
KrsBounds bounds_of(const Shape *shape, const Sources *sources, const KrsBounds *before,
                    Arena *arena, Arena *scratch);

#endif
