/*
 * crossing.c: closed surfaces, and triangles that cross.
 *
 * Two triangles are apart if some direction separates them: a normal, a product of an edge of each, or, where both
 * are in a plane, what is across an edge (the separating axis theorem).
 */
#include "compiler/mesh/crossing.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"

/* ---- edges ---- */

static int compare_edges(const void *a, const void *b)
{
    uint64_t first = ((const TriangleEdge *)a)->ends, second = ((const TriangleEdge *)b)->ends;
    return (first > second) - (first < second);
}

static uint64_t ends_of(uint32_t from, uint32_t to) { return (uint64_t)from << 32 | to; }

TriangleEdge *sort_edges(const uint32_t (*triangles)[3], size_t count, Arena *arena)
{
    TriangleEdge *edges = arena_new_array(arena, TriangleEdge, 3 * count + 1);
    for (size_t i = 0; i < 3 * count; i++) {
        const uint32_t *corners = triangles[i / 3];
        edges[i] = (TriangleEdge){ends_of(corners[i % 3], corners[(i + 1) % 3]), (uint32_t)(i / 3)};
    }
    qsort(edges, 3 * count, sizeof *edges, compare_edges);
    return edges;
}

const TriangleEdge *find_edge(const TriangleEdge *edges, size_t count, uint32_t from, uint32_t to)
{
    TriangleEdge wanted = {ends_of(from, to), 0};
    return bsearch(&wanted, edges, 3 * count, sizeof *edges, compare_edges);
}

void report_open(const uint32_t (*triangles)[3], size_t count, ReportTriangle *report, void *user,
                 Arena *arena)
{
    const TriangleEdge *edges = sort_edges(triangles, count, arena);
    for (size_t i = 0; i < 3 * count; i++) {
        uint64_t ends = edges[i].ends;
        uint32_t from = (uint32_t)(ends >> 32), to = (uint32_t)ends;
        bool     twice = (i > 0 && edges[i - 1].ends == ends) ||
                     (i + 1 < 3 * count && edges[i + 1].ends == ends);
        if (twice || from == to || !find_edge(edges, count, to, from))
            report(user, edges[i].triangle);
    }
}

/* ---- two triangles ---- */

typedef struct Pair {
    const double (*a)[3], (*b)[3];
    double margin; /* they must be apart by more than that, */
} Pair;

static bool separates(const Pair *pair, const double axis[3])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        double a = dot3(axis, pair->a[i]), b = dot3(axis, pair->b[i]);
        low[0]  = fmin(low[0], a);
        high[0] = fmax(high[0], a);
        low[1]  = fmin(low[1], b);
        high[1] = fmax(high[1], b);
    }
    double length = length3(axis);
    return length > 0 && fmax(low[1] - high[0], low[0] - high[1]) > pair->margin * length;
}

static void edge_of(const double (*corners)[3], int i, double edge[3])
{
    add_scaled3(edge, corners[(i + 1) % 3], -1, corners[i]);
}

static bool separated_by_edges(const Pair *pair)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double first[3], second[3], axis[3];
            edge_of(pair->a, i, first);
            edge_of(pair->b, k, second);
            cross3(first, second, axis);
            if (separates(pair, axis))
                return true;
        }
    return false;
}

/* By the normal of one of them, or across its edges. */
static bool separated_by_plane(const Pair *pair, const double (*corners)[3])
{
    double edges[2][3], normal[3];
    edge_of(corners, 0, edges[0]);
    edge_of(corners, 1, edges[1]);
    cross3(edges[0], edges[1], normal);
    if (separates(pair, normal))
        return true;
    for (int i = 0; i < 3; i++) {
        double edge[3], across[3];
        edge_of(corners, i, edge);
        cross3(edge, normal, across);
        if (separates(pair, across))
            return true;
    }
    return false;
}

/* Neighbours at an edge are apart unless one lies on the other. */
static bool are_folded(const double (*a)[3], const double (*b)[3])
{
    static const double least = 1e-4; /* radians */
    double              edges[2][3], normals[2][3], cross[3];
    for (int side = 0; side < 2; side++) {
        edge_of(side ? b : a, 0, edges[0]);
        edge_of(side ? b : a, 1, edges[1]);
        cross3(edges[0], edges[1], normals[side]);
        if (!normalize3(normals[side]))
            return true;
    }
    cross3(normals[0], normals[1], cross);
    return dot3(normals[0], normals[1]) < 0 && length3(cross) < least;
}

/* ---- all ---- */

typedef struct Search {
    const Bvh *bvh;
    uint32_t   triangle;
    double     corners[3][3];
    double     rounding;
} Search;

static int count_shared(const uint32_t a[3], const uint32_t b[3])
{
    int shared = 0;
    for (int i = 0; i < 9; i++)
        shared += a[i / 3] == b[i % 3];
    return shared;
}

static bool is_apart(void *user, uint32_t other, const double corners[3][3])
{
    const Search *search = user;
    int           shared = count_shared(search->bvh->triangles[search->triangle],
                                        search->bvh->triangles[other]);
    Pair          pair   = {(const double(*)[3])search->corners, corners, search->rounding};
    if (other == search->triangle)
        return true;
    if (shared >= 2)
        return shared == 2 && !are_folded(pair.a, pair.b);
    if (shared == 1)
        pair.margin = -search->rounding;
    return separated_by_plane(&pair, pair.a) || separated_by_plane(&pair, pair.b) ||
           separated_by_edges(&pair);
}

static double size_of(const Bvh *bvh)
{
    double size = 0;
    for (int k = 0; k < 3 && bvh->node_count > 0; k++)
        size = fmax(size, fmax(fabs(bvh->nodes[0].low[k]), fabs(bvh->nodes[0].high[k])));
    return size;
}

bool triangle_crosses(const Bvh *bvh, uint32_t triangle)
{
    Search search    = {.bvh = bvh, .triangle = triangle, .rounding = 1e-13 * size_of(bvh)};
    double center[3] = {0, 0, 0}, radius = 0;
    for (int c = 0; c < 3; c++) {
        memcpy(search.corners[c], bvh->vertices[bvh->triangles[triangle][c]],
               sizeof *search.corners);
        add_scaled3(center, center, 1.0 / 3, search.corners[c]);
    }
    for (int c = 0; c < 3; c++)
        radius = fmax(radius, distance3(center, search.corners[c]));
    return !bvh_visit(bvh, center, radius * (1 + 1e-9) + search.rounding, is_apart, &search);
}
