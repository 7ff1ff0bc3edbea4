/*
 * around.h: finds where bounds of a tetrahedron and of those around it prove that the surface is
 * near to the mesh.
 */
#ifndef KRS_MESH_AROUND_H
#define KRS_MESH_AROUND_H

#include "compiler/graph/range.h"
#include "mesh/contour/tets.h"

/* Bounds of all tetrahedra that have a point (smooth.h). */
typedef struct Around {
    float    deviation, width; /* the largest and the least */
    float    distance;         /* to the surface, at most: the largest deviation over the slope */
    uint32_t origin;           /* of the function that is bounded in one of them */
    bool     in_pieces;        /* some are bounded by pieces (pieces.h) */
    bool     mixed;            /* perhaps not all by the same function */
} Around;

/* The pieces of a cell whose growth is known: derivatives of each are within `rest` of `middle`. */
enum { MAX_GROWING = 4 };
typedef struct Growth {
    float    direction[3]; /* in which all grow */
    float    middle[MAX_GROWING][3], rest[MAX_GROWING][3];
    uint32_t count, number; /* `number` is where it is kept, 1 and more; 0: nowhere yet */
} Growth;

typedef struct Growths {
    Growth *items;
    size_t  count, capacity;
} Growths;

typedef struct Arounds {
    Around *items;
    size_t  count, capacity;
    Growths growths; /* of cells, by the number of tetrahedra */
} Arounds;

/* Adds a piece with these derivatives, times a sign. */
void growth_add(Growth *growth, const Range by[3], double sign);
/* Returns by how much all pieces grow along a direction at least. */
double growth_along(const Growth *growth, const float direction[3]);

/* The part of a tetrahedron in which the surface is proven to be near to the mesh: where dot(slope,
   p) + offset is above `least`. */
typedef struct Sure {
    bool   anywhere, everywhere;
    double slope[3], offset, least;
} Sure;

void arounds_find(Arounds *arounds, const Tets *tets, Arena *arena);
/* Finds the proven part of a tetrahedron that fits. */
void sure_find(const Arounds *arounds, const Tets *tets, const Tet *tet, double error, Sure *sure);
bool sure_has(const Sure *sure, const double corners[4][3]);

#endif
