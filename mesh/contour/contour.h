/*
 * contour.h: the mesh of the present tetrahedra.
 *
 * Where an edge goes from inside to outside there is a vertex on it.  Those of a face are joined by
 * a line, which may have a further vertex in the face where the surface has an edge there.  So on
 * the boundary of each tetrahedron there is at most one closed line, and the triangles within fill
 * it.  They are a fan around a vertex inside, or one or two triangles between the vertices of the
 * edges.  In a convex body a fan from a point inside to a line on the boundary that does not meet
 * itself is a surface that does not, either.  So the mesh is closed, manifold, and never crosses
 * itself.
 */
#ifndef KRS_MESH_CONTOUR_H
#define KRS_MESH_CONTOUR_H

#include "compiler/field/field.h"
#include "mesh/contour/groups.h"
#include "mesh/contour/tets.h"

/* A vertex on an edge of the tetrahedra. */
typedef struct Crossing {
    uint32_t from, to; /* points; `from` is inside */
    double   at[3], normal[3], value;
} Crossing;

/* A face with two crossings. */
typedef struct FaceLine {
    uint32_t points[3], crossings[2];
    bool     known, bent; /* there is a vertex in the face */
    double   at[3], value;
    double   off; /* the largest distance of middles of its parts from the surface; 0: little */
} FaceLine;

/* A tetrahedron with inside and outside corners. */
typedef struct Patch {
    uint32_t tet, corner_count; /* 3 or 4 crossings */
    /* The crossings in order around it, outside to the front; lines[i] follows crossings[i]. */
    uint32_t crossings[4], lines[4];
    bool     fan;
    double   apex[3], value;
    double   off; /* as of lines */
} Patch;

typedef struct Patches {
    Patch *items;
    size_t count, capacity;
} Patches;

typedef struct Contour {
    Arena     *arena;
    Tets      *tets;
    MeshField *fields; /* for each part of run_in_parallel */
    double     error;
    Groups     groups; /* of what is being computed */
    Numbering  crossing_numbers, line_numbers;
    struct {
        Crossing *items;
        size_t    count, capacity;
    } crossings;
    struct {
        FaceLine *items;
        size_t    count, capacity;
    } lines;
    /* Some patches are of tetrahedra that were bisected, until triangles are found; `before` is
       room to drop these. */
    Patches patches, before;
    size_t  known_crossings, known_lines, known_points; /* those that are computed */
    struct {
        double (*items)[3];
        size_t count, capacity;
    } vertices;
    struct {
        uint32_t (*items)[3];
        size_t count, capacity;
    } triangles;
    uint32_t *vertex_of; /* of crossings, then of lines; NO_NUMBER: not used */
} Contour;

/* Finds the distances at new points. */
void contour_distances(Contour *contour);
/* Finds the patches of tetrahedra that are fresh. */
void contour_find_patches(Contour *contour);
/* Finds vertices and triangles of all patches; the triangles of a tetrahedron follow each other. */
void contour_find(Contour *contour);

/* Returns the crossing, 0 or 1, that all triangles of a patch have which is no fan. */
uint32_t patch_diagonal(const Contour *contour, const Patch *patch);

/* Returns the largest distance of middles of its lines from the surface; 0: little. */
double patch_off(const Contour *contour, const Patch *patch);

static inline bool point_is_inside(const Tets *tets, uint32_t point)
{
    return (tets->points.items[point].distance < 0) != tets->points.items[point].moved;
}

#endif
