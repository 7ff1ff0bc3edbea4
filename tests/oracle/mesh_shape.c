/*
 * mesh_shape.c: counts of edges and parts.
 */
#include "tests/oracle/mesh_shape.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int compare_edges(const void *a, const void *b)
{
    const uint32_t *e = a, *f = b;
    return e[0] != f[0] ? (e[0] < f[0] ? -1 : 1) : e[1] < f[1] ? -1 : e[1] > f[1];
}

void check_closed(const KrsMesh *mesh)
{
    size_t count        = 3 * mesh->triangle_count;
    uint32_t(*edges)[2] = malloc((count + 1) * sizeof *edges);
    for (size_t i = 0; i < count; i++) {
        edges[i][0] = mesh->triangles[i / 3][i % 3];
        edges[i][1] = mesh->triangles[i / 3][(i + 1) % 3];
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i++) {
        uint32_t back[2] = {edges[i][1], edges[i][0]};
        assert_true(i == 0 || compare_edges(edges[i - 1], edges[i]) != 0);
        assert_non_null(bsearch(back, edges, count, sizeof *edges, compare_edges));
    }
    free(edges);
}

static uint32_t leader_of(uint32_t *leaders, uint32_t vertex)
{
    while (leaders[vertex] != vertex) {
        leaders[vertex] = leaders[leaders[vertex]];
        vertex          = leaders[vertex];
    }
    return vertex;
}

static Vec corner(const KrsMesh *mesh, size_t triangle, int k)
{
    const double *v = mesh->vertices[mesh->triangles[triangle][k]];
    return vec(v[0], v[1], v[2]);
}

MeshShape mesh_shape(const KrsMesh *mesh)
{
    MeshShape shape   = {0, (long)mesh->vertex_count - (long)mesh->triangle_count / 2, 0};
    uint32_t *leaders = malloc((mesh->vertex_count + 1) * sizeof *leaders);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        leaders[i] = (uint32_t)i;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t                 = mesh->triangles[i];
        leaders[leader_of(leaders, t[0])] = leader_of(leaders, t[1]);
        leaders[leader_of(leaders, t[1])] = leader_of(leaders, t[2]);
        shape.volume += vec_dot(corner(mesh, i, 0),
                                vec_cross(corner(mesh, i, 1), corner(mesh, i, 2))) /
                        6;
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        shape.parts += leaders[i] == i;
    free(leaders);
    return shape;
}

/* ---- cubes ---- */

/* Tells whether a cube is inside; around all of them is nothing. */
static bool cube_at(const bool *inside, int cells, int x, int y, int z)
{
    if (x < 0 || y < 0 || z < 0 || x >= cells || y >= cells || z >= cells)
        return false;
    return inside[((size_t)x * (size_t)cells + (size_t)y) * (size_t)cells + (size_t)z];
}

/* Corners, edges, faces and cubes of closed cubes, by turns added and subtracted: each belongs to the grid point
   at its lower end and the axes that it goes along, and is there if a cube around it is. */
static long count_at(const bool *inside, int cells, int x, int y, int z)
{
    long sum = 0;
    for (int axes = 0; axes < 8; axes++) {
        bool there = false;
        for (int side = 0; side < 8; side++)
            there = there ||
                    ((side & axes) == 0 && cube_at(inside, cells, x - (side & 1),
                                                   y - (side >> 1 & 1), z - (side >> 2 & 1)));
        sum += !there ? 0 : __builtin_popcount((unsigned)axes) % 2 ? -1 : 1;
    }
    return sum;
}

long solid_euler(const Surface *surface, int cells)
{
    size_t side   = (size_t)cells;
    bool  *inside = malloc(side * side * side * sizeof *inside);
    long   sum    = 0;
    Vec    low = surface->low, size = vec_scale(1. / cells, vec_sub(surface->high, low));
    for (size_t i = 0; i < side * side * side; i++) {
        Vec p     = vec(low.x + size.x * ((double)(i / side / side) + 0.5),
                        low.y + size.y * ((double)(i / side % side) + 0.5),
                        low.z + size.z * ((double)(i % side) + 0.5));
        inside[i] = surface->value(surface->user, p) < 0;
    }
    for (int x = 0; x <= cells; x++)
        for (int y = 0; y <= cells; y++)
            for (int z = 0; z <= cells; z++)
                sum += count_at(inside, cells, x, y, z);
    free(inside);
    return 2 * sum; /* a solid has half of its surface's */
}

void write_off(const KrsMesh *mesh, const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "OFF\n%zu %zu 0\n", mesh->vertex_count, mesh->triangle_count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        fprintf(file, "%.17g %.17g %.17g\n", mesh->vertices[i][0], mesh->vertices[i][1],
                mesh->vertices[i][2]);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        fprintf(file, "3 %u %u %u\n", mesh->triangles[i][0], mesh->triangles[i][1],
                mesh->triangles[i][2]);
    assert_int_equal(fclose(file), 0);
}
