/*
 * mesh_distance.h: how far a mesh and a surface are apart at most, by dense rays and dense points.
 *
 * The surface is where a number changes its sign.  Nothing is shared with the mesher.
 */
#ifndef ORACLE_MESH_DISTANCE_H
#define ORACLE_MESH_DISTANCE_H

#include "tests/oracle/product.h"

/* Below 0 inside, above 0 outside. */
typedef double SurfaceValue(const void *user, Vec point);

typedef struct Surface {
    SurfaceValue *value;
    const void   *user;
    Vec           low, high; /* a box around it */
} Surface;

/* What was found. */
typedef struct Apart {
    size_t hits, points; /* of the surface, where rays cross it; of triangles */
    size_t lost,
        off_surface;     /* those hits and points that are farther from the other than the error */
    size_t thick;        /* lost hits where neither solid nor void is thinner than the error */
    double farthest_hit; /* of all hits, as far as some errors were looked at; in errors */
    Vec    lost_at, off_surface_at; /* one of them; a thick one, if there is */
    size_t crossings[2];            /* how often rays enter the surface and leave it again */
} Apart;

/* Triangles by where they are. */
typedef struct MeshGrid MeshGrid;
MeshGrid               *mesh_grid_new(const KrsMesh *mesh, double reach);
void                    mesh_grid_free(MeshGrid *grid);
/* Returns the distance of a point from the mesh; HUGE_VAL: it is more than the reach. */
double mesh_grid_distance(const MeshGrid *grid, Vec point);

/* `rays` random rays through the box, and about `points` points of the mesh. */
Apart mesh_apart(const KrsMesh *mesh, const Surface *surface, double error, size_t rays,
                 size_t points, Random *random);

#endif
