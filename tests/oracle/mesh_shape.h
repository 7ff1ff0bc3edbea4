/*
 * mesh_shape.h: what is known of meshes without their surface: whether they are closed, their volume and how many
 * holes they have; and the same of solids, by counting small cubes.
 */
#ifndef ORACLE_MESH_SHAPE_H
#define ORACLE_MESH_SHAPE_H

#include "tests/oracle/mesh_distance.h"

/* Fails the test unless each edge is in two triangles, once in each direction. */
void check_closed(const KrsMesh *mesh);

typedef struct MeshShape {
    long   parts; /* that do not hang together */
    long   euler; /* vertices - edges + triangles: twice the parts less twice the genus */
    double volume;
} MeshShape;
MeshShape mesh_shape(const KrsMesh *mesh);

/* Returns the Euler number of the surface of what is inside, if cubes are as small as the box over
   `cells`. */
long solid_euler(const Surface *surface, int cells);

/* Writes the mesh as OFF, which CGAL reads. */
void write_off(const KrsMesh *mesh, const char *path);

#endif
