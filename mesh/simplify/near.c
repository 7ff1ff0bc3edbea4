/*
 * near.c: proves that triangles are within an error of a mesh.
 *
 * The part of a closed mesh that is above or below a triangle is found from one of its triangles,
 * over all edges that are above or below as well.  The rest of the mesh meets this part only beyond
 * the triangle's border.  So all inner points of the triangle have equally many layers of it above
 * and below them, when those that face the other side are subtracted (the degree of a map).  Where
 * one point has some, all have.  Heights are linear where a triangle of the mesh covers the
 * triangle, so the largest is at a corner of their intersection.
 *
 * Beside sharp edges heights are oblique, so that both their sides are seen from above.
 *
 * Where that does not decide there is a slower test.  A triangle is within an error of a mesh if
 * all its corners are within it of one triangle of the mesh, which is convex; if they are not, it
 * is cut into four.
 */
#include "mesh/simplify/near.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { MAX_CUTS = 12 };

/* ---- the mesh ---- */

static uint32_t only_edge(const TriangleEdges *edges, uint32_t from, uint32_t to)
{
    const TriangleEdge *edge = find_edge(edges, from, to);
    if (!edge || (edge + 1 < edges->items + edges->count && edge[1].ends == edge->ends))
        return NO_TRIANGLE;
    return edge->triangle;
}

void near_mesh_new(NearMesh *mesh, const double (*vertices)[3], const uint32_t (*triangles)[3],
                   size_t count, Arena *arena)
{
    bvh_new(&mesh->bvh, vertices, triangles, count, arena);
    mesh->edges  = sort_edges(triangles, count, arena);
    mesh->beyond = arena_alloc(arena, count + 1, sizeof *mesh->beyond);
    mesh->size   = 0;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            uint32_t from = triangles[i][c], to = triangles[i][(c + 1) % 3];
            bool     once      = only_edge(&mesh->edges, from, to) == i;
            mesh->beyond[i][c] = once ? only_edge(&mesh->edges, to, from) : NO_TRIANGLE;
            mesh->size         = fmax(mesh->size, largest3(vertices[from]));
        }
}

/* ---- by facing triangles ---- */

/* Coordinates of a triangle: barycentric shares of its corners, and the height above its plane,
   along its normal or oblique. */
typedef struct Frame {
    double origin[3], first[3], second[3], height[3];
    double rounding; /* bound of the rounding of shares */
    double error;
} Frame;

typedef struct Seen {
    double shares[3], height;
} Seen;

/* Makes the coordinates of a triangle, with heights along its normal plus `aslant`, if that is not
   NULL; returns false if it is so thin that rounding matters. */
static bool frame_new(const NearMesh *mesh, const double corners[3][3], double error,
                      const double *aslant, Frame *frame)
{
    static const double least = 1e-9, most = 1e-5;
    double              edges[2][3], normal[3], along[3], longest = 0;
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    double twice = length3(normal);
    if (!normalize3(normal))
        return false;
    memcpy(along, normal, sizeof along);
    if (aslant)
        add_scaled3(along, along, 1, aslant);
    normalize3(along);
    double upright = dot3(along, normal);
    memcpy(frame->origin, corners[0], sizeof frame->origin);
    cross3(edges[1], along, frame->first);
    cross3(along, edges[0], frame->second);
    for (int k = 0; k < 3; k++) {
        frame->first[k] /= twice * upright;
        frame->second[k] /= twice * upright;
        frame->height[k] = normal[k] / upright;
    }
    for (int c = 0; c < 3; c++)
        longest = fmax(longest, distance3(corners[c], corners[(c + 1) % 3]));
    frame->rounding = fmax(least,
                           1e-14 * mesh->size * (length3(frame->first) + length3(frame->second)));
    /* The border is left out; this bounds how far it is from what is not. */
    frame->error = error - 6 * frame->rounding * longest;
    return frame->rounding < most && frame->error > 0;
}

static void see(const Frame *frame, const double point[3], Seen *seen)
{
    double offset[3];
    add_scaled3(offset, point, -1, frame->origin);
    seen->shares[1] = dot3(offset, frame->first);
    seen->shares[2] = dot3(offset, frame->second);
    seen->shares[0] = 1 - seen->shares[1] - seen->shares[2];
    seen->height    = dot3(offset, frame->height);
}

/* Tells whether a segment has points above or below the triangle. */
static bool is_edge_seen(const Frame *frame, const Seen *a, const Seen *b)
{
    double low = 0, high = 1;
    for (int i = 0; i < 3; i++) {
        double from = a->shares[i] - frame->rounding, to = b->shares[i] - frame->rounding;
        if (from < 0 && to < 0)
            return false;
        if (from < 0)
            low = fmax(low, from / (from - to));
        else if (to < 0)
            high = fmin(high, from / (from - to));
    }
    return low <= high;
}

enum { MAX_CORNERS = 6 };

/* Clips a polygon to points with at least this share of a corner; returns how many corners it
   has. */
static int clip(Seen *corners, int count, int share, double least)
{
    Seen left[MAX_CORNERS + 1];
    int  left_count = 0;
    for (int i = 0; i < count; i++) {
        const Seen *a = &corners[i], *b = &corners[(i + 1) % count];
        double      from = a->shares[share] - least, to = b->shares[share] - least;
        if (from >= 0)
            left[left_count++] = *a;
        if ((from >= 0) != (to >= 0)) {
            double part = from / (from - to);
            Seen  *at   = &left[left_count++];
            for (int k = 0; k < 3; k++)
                at->shares[k] = a->shares[k] + part * (b->shares[k] - a->shares[k]);
            at->height = a->height + part * (b->height - a->height);
        }
    }
    memcpy(corners, left, (size_t)left_count * sizeof *left);
    return left_count;
}

static int clip_all(const Seen triangle[3], double least, Seen corners[MAX_CORNERS + 1])
{
    int count = 3;
    memcpy(corners, triangle, 3 * sizeof *corners);
    for (int share = 0; share < 3 && count > 0; share++)
        count = clip(corners, count, share, least);
    return count;
}

/* Tells whether a triangle of the mesh surely faces the same side as the triangle. */
static bool faces_same_side(const Frame *frame, const Seen corners[3])
{
    double a      = corners[1].shares[1] - corners[0].shares[1],
           b      = corners[1].shares[2] - corners[0].shares[2],
           c      = corners[2].shares[1] - corners[0].shares[1],
           d      = corners[2].shares[2] - corners[0].shares[2];
    double spread = fabs(a) + fabs(b) + fabs(c) + fabs(d);
    return a * d - b * c > 1e-6 * (fabs(a * d) + fabs(b * c)) + frame->rounding * spread;
}

/* Points of the triangle where layers are counted: some edges may be too near to one of them to
   tell. */
enum { POINTS = 3 };
static const double points[POINTS][2] = {{0.3349, 0.3317}, {0.2713, 0.4139}, {0.4491, 0.2357}};

typedef struct Layers {
    int  count[POINTS];
    bool unsure[POINTS];
} Layers;

static void count_layer(const Frame *frame, const Seen corners[3], int point, Layers *layers)
{
    int above = 0, below = 0;
    for (int c = 0; c < 3; c++) {
        const double *from = corners[c].shares, *to = corners[(c + 1) % 3].shares;
        double        a = to[1] - from[1], b = to[2] - from[2], x = points[point][0] - from[1],
               y     = points[point][1] - from[2];
        double side  = a * y - b * x;
        double least = 4 * frame->rounding * (fabs(a) + fabs(b) + fabs(x) + fabs(y));
        above += side > -least;
        below += side < least;
        if (fabs(side) <= least)
            layers->unsure[point] = true;
    }
    if (above == 3 && below == 0)
        layers->count[point]++;
    else if (below == 3 && above == 0)
        layers->count[point]--;
}

static bool has_layers(const Layers *layers)
{
    for (int i = 0; i < POINTS; i++)
        if (!layers->unsure[i])
            return layers->count[i] != 0;
    return false;
}

/* Tells whether the part of a triangle over the other is within the error; otherwise `*far` becomes
   a point that is not.  `*highest` is raised to its height. */
static bool is_low(const Frame *frame, const Seen triangle[3], Seen *far, double *highest)
{
    Seen   corners[MAX_CORNERS + 1];
    double most = fmax(fabs(triangle[0].height),
                       fmax(fabs(triangle[1].height), fabs(triangle[2].height)));
    if (most <= frame->error) {
        *highest = fmax(*highest, most);
        return true;
    }
    int count = clip_all(triangle, frame->rounding, corners);
    for (int i = 0; i < count; i++) {
        *highest = fmax(*highest, fabs(corners[i].height));
        if (fabs(corners[i].height) > frame->error) {
            *far = corners[i];
            return false;
        }
    }
    return true;
}

static uint32_t first_slot(uint32_t triangle)
{
    return (triangle * 2654435761u >> 7) % FACED_SLOTS;
}

/* Adds a triangle to those that are faced; returns false if there are too many. */
static bool face(NearQuery *query, uint32_t triangle)
{
    uint32_t slot = first_slot(triangle);
    for (; query->slots[slot]; slot = (slot + 1) % FACED_SLOTS)
        if (query->faced[query->slots[slot] - 1] == triangle)
            return true;
    if (query->faced_count == MAX_FACED)
        return false;
    query->faced[query->faced_count++] = triangle;
    query->slots[slot]                 = (uint32_t)query->faced_count;
    return true;
}

/* Empties the faced triangles, the last first, so that probing misses none. */
static void forget_faced(NearQuery *query)
{
    while (query->faced_count > 0) {
        uint32_t triangle = query->faced[--query->faced_count];
        uint32_t slot     = first_slot(triangle);
        while (query->slots[slot] != query->faced_count + 1)
            slot = (slot + 1) % FACED_SLOTS;
        query->slots[slot] = 0;
    }
}

static void see_triangle(const NearMesh *mesh, const Frame *frame, uint32_t triangle, Seen seen[3])
{
    for (int c = 0; c < 3; c++)
        see(frame, mesh->bvh.vertices[mesh->bvh.triangles[triangle][c]], &seen[c]);
}

/* Tells whether a triangle of the mesh surely is above or below some of the triangle, and faces the
   same side. */
static bool is_faced(const NearMesh *mesh, const Frame *frame, uint32_t triangle)
{
    Seen seen[3], corners[MAX_CORNERS + 1];
    see_triangle(mesh, frame, triangle, seen);
    return faces_same_side(frame, seen) && clip_all(seen, 3 * frame->rounding, corners) > 0;
}

typedef enum Verdict { IS_NEAR, IS_FAR, IS_UNDECIDED } Verdict;

/* Tells whether a point of the triangle is surely farther than the error. */
static bool is_far(const NearMesh *mesh, const double corners[3][3], double error, const Seen *seen,
                   NearQuery *query)
{
    double at[3] = {0, 0, 0};
    for (int c = 0; c < 3; c++)
        add_scaled3(at, at, fmin(fmax(seen->shares[c], 0), 1), corners[c]);
    return !bvh_is_near(&mesh->bvh, at, error, &query->last);
}

/* Finds all triangles that are faced from those that are known, and decides by their heights;
   `*steep` becomes one that is too high. */
static Verdict face_all(const NearMesh *mesh, const double corners[3][3], double error,
                        const Frame *frame, NearQuery *query, uint32_t *steep)
{
    Layers layers = {.count = {0}};

    double highest = 0;
    for (size_t i = 0; i < query->faced_count; i++) {
        uint32_t triangle = query->faced[i];
        Seen     seen[3], high;
        see_triangle(mesh, frame, triangle, seen);
        if (!is_low(frame, seen, &high, &highest)) {
            *steep = triangle;
            return is_far(mesh, corners, error, &high, query) ? IS_FAR : IS_UNDECIDED;
        }
        for (int point = 0; point < POINTS; point++)
            count_layer(frame, seen, point, &layers);
        for (int c = 0; c < 3; c++)
            if (is_edge_seen(frame, &seen[c], &seen[(c + 1) % 3])) {
                uint32_t beyond = mesh->beyond[triangle][c];
                if (beyond == NO_TRIANGLE || !face(query, beyond))
                    return IS_UNDECIDED;
            }
    }
    if (!has_layers(&layers))
        return IS_UNDECIDED;
    query->distance = fmin(error, highest + (error - frame->error));
    return IS_NEAR;
}

typedef struct Start {
    const NearMesh *mesh;
    const Frame    *frame;
    NearQuery      *query;
} Start;

/* Stops the visit at a triangle that is faced. */
static bool find_start(void *user, uint32_t triangle, const double corners[3][3])
{
    Start *start = user;
    (void)corners;
    return !is_faced(start->mesh, start->frame, triangle) || !face(start->query, triangle);
}

/* Decides by heights along a direction, beginning with the first of `starts` that is faced, or
   without any with a triangle near the middle. */
static Verdict face_along(const NearMesh *mesh, const double corners[3][3], double error,
                          const double *aslant, const uint32_t *starts, size_t start_count,
                          NearQuery *query, uint32_t *steep)
{
    Frame frame;
    forget_faced(query);
    if (!frame_new(mesh, corners, error, aslant, &frame))
        return IS_UNDECIDED;
    for (size_t i = 0; i < start_count && query->faced_count == 0; i++)
        if (is_faced(mesh, &frame, starts[i]))
            face(query, starts[i]);
    if (start_count == 0) {
        Start  start     = {mesh, &frame, query};
        double middle[3] = {0, 0, 0};
        for (int c = 0; c < 3; c++)
            add_scaled3(middle, middle, 1.0 / 3, corners[c]);
        bvh_visit(&mesh->bvh, middle, error, find_start, &start);
    }
    return face_all(mesh, corners, error, &frame, query, steep);
}

static void unit_normal(const double corners[3][3], double normal[3])
{
    double edges[2][3];
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    normalize3(normal);
}

/* Decides by heights, oblique ones if needed: where a triangle goes a little beyond a sharp edge,
   the other side of the edge is a high wall above or below it, but not from where both sides are
   seen. */
static Verdict face_from(const NearMesh *mesh, const double corners[3][3], double error,
                         const uint32_t *starts, size_t start_count, NearQuery *query)
{
    static const double ASLANT = 0.4, STEEPEST = -0.8;
    uint32_t            steep = NO_TRIANGLE;
    Verdict verdict = face_along(mesh, corners, error, NULL, starts, start_count, query, &steep);
    if (verdict != IS_UNDECIDED || steep == NO_TRIANGLE)
        return verdict;
    double wall[3][3], normals[2][3], aslant[3] = {0, 0, 0};
    for (int c = 0; c < 3; c++)
        memcpy(wall[c], mesh->bvh.vertices[mesh->bvh.triangles[steep][c]], sizeof wall[c]);
    unit_normal((const double(*)[3])wall, normals[0]);
    unit_normal(corners, normals[1]);
    double cosine = dot3(normals[0], normals[1]);
    if (cosine < STEEPEST)
        return IS_UNDECIDED;
    add_scaled3(aslant, aslant, ASLANT + max2(0, -cosine), normals[0]);
    return face_along(mesh, corners, error, aslant, starts, start_count, query, &steep);
}

/* ---- by subdivision ---- */

static bool are_near(const Bvh *bvh, uint32_t triangle, const double corners[3][3], double error)
{
    double nearest[3];
    for (int c = 0; c < 3; c++)
        if (!bvh_triangle_is_near(bvh, triangle, corners[c], error, nearest))
            return false;
    return true;
}

typedef struct Nearness {
    const double (*corners)[3];
    double     error;
    const Bvh *bvh;
    uint32_t   found;
} Nearness;

/* Stops the visit at a triangle to which all corners are near. */
static bool stop_if_near(void *user, uint32_t triangle, const double corners[3][3])
{
    Nearness *nearness = user;
    (void)corners;
    nearness->found = triangle;
    return !are_near(nearness->bvh, triangle, nearness->corners, nearness->error);
}

static bool is_near(const NearMesh *mesh, const double corners[3][3], double error,
                    const uint32_t *starts, size_t start_count, int cuts, NearQuery *query);

static bool are_parts_near(const NearMesh *mesh, const double corners[3][3], double error, int cuts,
                           NearQuery *query)
{
    double middles[3][3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            middles[c][k] = 0.5 * (corners[c][k] + corners[(c + 1) % 3][k]);
    for (int c = 0; c < 3; c++) {
        double corner[3][3];
        memcpy(corner[0], corners[c], sizeof corner[0]);
        memcpy(corner[1], middles[c], sizeof corner[1]);
        memcpy(corner[2], middles[(c + 2) % 3], sizeof corner[2]);
        if (!bvh_is_near(&mesh->bvh, corner[0], error, &query->last) ||
            !is_near(mesh, (const double(*)[3])corner, error, NULL, 0, cuts - 1, query))
            return false;
    }
    return is_near(mesh, (const double(*)[3])middles, error, NULL, 0, cuts - 1, query);
}

static bool is_near(const NearMesh *mesh, const double corners[3][3], double error,
                    const uint32_t *starts, size_t start_count, int cuts, NearQuery *query)
{
    const Bvh *bvh      = &mesh->bvh;
    Nearness   nearness = {corners, error, bvh, 0};
    bool       whole    = cuts == MAX_CUTS;
    forget_faced(query);
    if (!(whole && start_count > 0) && are_near(bvh, query->last, corners, error))
        return true;
    Verdict verdict = face_from(mesh, corners, error, starts, start_count, query);
    if (verdict != IS_UNDECIDED)
        return verdict == IS_NEAR;
    if (!bvh_visit(bvh, corners[0], error, stop_if_near, &nearness)) {
        query->last = nearness.found;
        return true;
    }
    if (cuts == 0)
        return false;
    bool near       = are_parts_near(mesh, corners, error, cuts, query);
    query->distance = error;
    return near;
}

bool is_near_triangle(const NearMesh *mesh, uint32_t triangle, const double corners[3][3],
                      double error)
{
    return are_near(&mesh->bvh, triangle, corners, error);
}

bool is_near_mesh(const NearMesh *mesh, const double corners[3][3], double error,
                  const uint32_t *starts, size_t start_count, NearQuery *query)
{
    /* Earlier queries must not matter, since threads share work in no order. */
    query->last     = start_count > 0 ? starts[0] : 0;
    query->distance = error;
    if (mesh->bvh.triangle_count == 0)
        return false;
    return is_near(mesh, corners, error, starts, start_count, MAX_CUTS, query);
}
