/*
 * polygons.h: triangulates flat polygons with holes.
 */
#ifndef KRS_MESH_POLYGONS_H
#define KRS_MESH_POLYGONS_H

#include <stdint.h>

#include "compiler/base/arena.h"

/* Closed polygons, one after the other; the inside is on the left. */
typedef struct Loops {
    struct {
        uint32_t *items; /* vertices */
        size_t    count, capacity;
    } vertices;
    struct {
        size_t *items; /* number behind the last vertex of each */
        size_t  count, capacity;
    } ends;
} Loops;

typedef struct FlatVertices {
    double (*items)[3];
    size_t count, capacity;
} FlatVertices;

typedef struct Triangles {
    uint32_t (*items)[3];
    size_t count, capacity;
} Triangles;

/* Triangulates loops in a plane with this unit normal, in the order of the loops, which do not
   cross but where they are closer than `narrow`.  Each edge is in one triangle, each diagonal in
   two.  Returns false if no triangles are found. */
bool polygons_cut(const double (*at)[3], const double normal[3], const Loops *loops, double narrow,
                  Triangles *triangles, Arena *arena);

#endif
