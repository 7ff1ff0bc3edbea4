/*
 * crossing.c: finds open edges, and triangles that cross.
 *
 * By the separating axis theorem two triangles are disjoint if some direction separates them: a
 * normal, the cross product of an edge of each, or, where both are in a plane, the direction across
 * an edge.
 */
#include "mesh/common/crossing.h"

#include <string.h>

#include "compiler/base/vec.h"

/* ---- edges ---- */

static uint64_t ends_of(uint32_t from, uint32_t to) { return (uint64_t)from << 32 | to; }

static uint32_t from_of(const TriangleEdge *edge) { return (uint32_t)(edge->ends >> 32); }

/* Sorts the edges from one vertex by insertion, since they are few. */
static void sort_of_vertex(TriangleEdge *edges, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        TriangleEdge edge = edges[i];
        size_t       k    = i;
        for (; k > 0 && edges[k - 1].ends > edge.ends; k--)
            edges[k] = edges[k - 1];
        edges[k] = edge;
    }
}

TriangleEdges sort_edges(const uint32_t (*triangles)[3], size_t count, Arena *arena)
{
    TriangleEdges edges = {.count = 3 * count};
    for (size_t i = 0; i < 3 * count; i++)
        if (triangles[i / 3][i % 3] >= edges.vertex_count)
            edges.vertex_count = (size_t)triangles[i / 3][i % 3] + 1;
    edges.items    = arena_new_array(arena, TriangleEdge, edges.count + 1);
    edges.begins   = arena_new_array(arena, uint32_t, edges.vertex_count + 2);
    uint32_t *next = edges.begins + 1; /* becomes `begins` while edges are put there */
    for (size_t i = 0; i < edges.count; i++)
        next[triangles[i / 3][i % 3] + 1]++;
    for (size_t i = 0; i < edges.vertex_count; i++)
        next[i + 1] += next[i];
    for (size_t i = 0; i < edges.count; i++) {
        const uint32_t *corners   = triangles[i / 3];
        uint32_t        from      = corners[i % 3];
        edges.items[next[from]++] = (TriangleEdge){ends_of(from, corners[(i + 1) % 3]),
                                                   (uint32_t)(i / 3)};
    }
    for (size_t i = 0; i < edges.vertex_count; i++)
        sort_of_vertex(edges.items + edges.begins[i], edges.begins[i + 1] - edges.begins[i]);
    return edges;
}

const TriangleEdge *find_edge(const TriangleEdges *edges, uint32_t from, uint32_t to)
{
    if (from < edges->vertex_count)
        for (uint32_t i = edges->begins[from]; i < edges->begins[from + 1]; i++)
            if (edges->items[i].ends == ends_of(from, to))
                return &edges->items[i];
    return NULL;
}

void report_open(const TriangleEdges *edges, ReportTriangle *report, void *user)
{
    for (size_t i = 0; i < edges->count; i++) {
        const TriangleEdge *edge = &edges->items[i];
        uint32_t            from = from_of(edge), to = (uint32_t)edge->ends;
        bool                twice = (i > 0 && edge[-1].ends == edge->ends) ||
                     (i + 1 < edges->count && edge[1].ends == edge->ends);
        if (twice || from == to || !find_edge(edges, to, from))
            report(user, edge->triangle);
    }
}

/* Goes around the vertex, from each triangle to the one behind its last edge. */
bool is_one_ring(const TriangleEdges *edges, const uint32_t (*triangles)[3], uint32_t vertex)
{
    uint32_t begin = edges->begins[vertex], count = edges->begins[vertex + 1] - begin;
    if (count == 0)
        return true;
    const TriangleEdge *first = &edges->items[begin], *edge = first;
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t *own = triangles[edge->triangle];
        int             c   = own[0] == vertex ? 0 : own[1] == vertex ? 1 : 2;
        edge                = find_edge(edges, vertex, own[(c + 2) % 3]);
        if (!edge || edge == first)
            return false;
    }
    return true;
}

/* ---- two triangles ---- */

typedef struct Pair {
    const double (*a)[3], (*b)[3];
    double margin; /* least gap between the two */
} Pair;

static bool separates(const Pair *pair, const double axis[3])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        double a = dot3(axis, pair->a[i]), b = dot3(axis, pair->b[i]);
        low[0]  = a < low[0] ? a : low[0];
        high[0] = a > high[0] ? a : high[0];
        low[1]  = b < low[1] ? b : low[1];
        high[1] = b > high[1] ? b : high[1];
    }
    double length = length3(axis), gap = fmax(low[1] - high[0], low[0] - high[1]);
    return length > 0 && gap > pair->margin * length;
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

/* Tells whether the normal of one triangle, or a direction across one of its edges, separates
   them. */
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

/* Tells whether two triangles with a common edge lie on each other. */
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

/* ---- a triangle and the mesh ---- */

typedef struct Search {
    const Bvh *bvh;
    uint32_t   triangle;
    double     corners[3][3];
    double     margin, rounding;
} Search;

static int count_shared(const uint32_t a[3], const uint32_t b[3])
{
    int shared = 0;
    for (int i = 0; i < 9; i++)
        shared += a[i / 3] == b[i % 3];
    return shared;
}

static bool is_separate(void *user, uint32_t other, const double corners[3][3])
{
    const Search *search = user;
    int           shared = count_shared(search->bvh->triangles[search->triangle],
                                        search->bvh->triangles[other]);
    Pair          pair   = {(const double(*)[3])search->corners, corners, search->margin};
    if (other == search->triangle)
        return true;
    if (shared >= 2)
        return shared == 2 && !are_folded(pair.a, pair.b);
    if (shared == 1)
        pair.margin = fmin(pair.margin, -search->rounding);
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

bool triangle_crosses(const Bvh *bvh, uint32_t triangle, double depth)
{
    Search search  = {.bvh = bvh, .triangle = triangle, .rounding = 1e-13 * size_of(bvh)};
    search.margin  = depth > 0 ? -depth : search.rounding;
    double low[3]  = {INFINITY, INFINITY, INFINITY};
    double high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int c = 0; c < 3; c++) {
        memcpy(search.corners[c], bvh->vertices[bvh->triangles[triangle][c]],
               sizeof *search.corners);
        for (int k = 0; k < 3; k++) {
            low[k]  = fmin(low[k], search.corners[c][k] - 2 * search.rounding);
            high[k] = fmax(high[k], search.corners[c][k] + 2 * search.rounding);
        }
    }
    return !bvh_visit_box(bvh, low, high, is_separate, &search);
}
