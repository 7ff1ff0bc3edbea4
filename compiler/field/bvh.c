/* bvh.c: makes boxes of triangles, halved at the middle of their centres. */
#include "compiler/field/bvh.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { FEW = 4, MAX_DEPTH = 64 };

static void triangle_corners(const Bvh *bvh, uint32_t triangle, double corners[3][3])
{
    for (int i = 0; i < 3; i++)
        memcpy(corners[i], bvh->vertices[bvh->triangles[triangle][i]], sizeof corners[i]);
}

static void find_box(const Bvh *bvh, BvhNode *node, uint32_t first, uint32_t count)
{
    for (int k = 0; k < 3; k++) {
        node->low[k]  = INFINITY;
        node->high[k] = -INFINITY;
    }
    for (uint32_t i = first; i < first + count; i++)
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) {
                double at     = bvh->vertices[bvh->triangles[bvh->order[i]][c]][k];
                node->low[k]  = at < node->low[k] ? at : node->low[k];
                node->high[k] = at > node->high[k] ? at : node->high[k];
            }
}

/* Thrice the centre of a triangle.  They are in the order of the tree, so that they are read one
   after the other. */
typedef struct Center {
    double at[3];
} Center;

/* Brings those whose centre is below the middle of all to the front; returns how many. */
static uint32_t divide(const Bvh *bvh, Center *centers, uint32_t first, uint32_t count)
{
    double   low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    uint32_t front = 0;
    int      axis  = 0;
    for (uint32_t i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++) {
            low[k]  = min2(low[k], centers[i].at[k]);
            high[k] = max2(high[k], centers[i].at[k]);
        }
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[axis] - low[axis])
            axis = k;
    double middle = 0.5 * (low[axis] + high[axis]);
    for (uint32_t i = first; i < first + count; i++)
        if (centers[i].at[axis] < middle) {
            uint32_t at = first + front++, swap = bvh->order[i];
            Center   center = centers[i];
            bvh->order[i]   = bvh->order[at];
            centers[i]      = centers[at];
            bvh->order[at]  = swap;
            centers[at]     = center;
        }
    return front == 0 || front == count ? count / 2 : front;
}

static void build(Bvh *bvh, Center *centers, uint32_t first, uint32_t count, int depth)
{
    BvhNode *node = &bvh->nodes[bvh->node_count++];
    node->first   = first;
    node->count   = count;
    if (count <= FEW || depth == MAX_DEPTH) {
        find_box(bvh, node, first, count);
        return;
    }
    uint32_t front = divide(bvh, centers, first, count);
    node->count    = 0;
    build(bvh, centers, first, front, depth + 1);
    node->second = (uint32_t)bvh->node_count;
    build(bvh, centers, first + front, count - front, depth + 1);
    for (int k = 0; k < 3; k++) {
        node->low[k]  = min2(node[1].low[k], bvh->nodes[node->second].low[k]);
        node->high[k] = max2(node[1].high[k], bvh->nodes[node->second].high[k]);
    }
}

void bvh_new(Bvh *bvh, const double (*vertices)[3], const uint32_t (*triangles)[3], size_t count,
             Arena *arena)
{
    *bvh = (Bvh){.vertices = vertices, .triangles = triangles, .triangle_count = count};
    if (count == 0)
        return;
    bvh->order        = arena_new_array(arena, uint32_t, count);
    bvh->nodes        = arena_new_array(arena, BvhNode, 2 * count);
    ArenaMark mark    = arena_mark(arena);
    Center   *centers = arena_new_array(arena, Center, count);
    for (size_t i = 0; i < count; i++) {
        bvh->order[i] = (uint32_t)i;
        for (int k = 0; k < 3; k++)
            centers[i].at[k] = vertices[triangles[i][0]][k] + vertices[triangles[i][1]][k] +
                               vertices[triangles[i][2]][k];
    }
    build(bvh, centers, 0, (uint32_t)count, 0);
    arena_rewind(arena, mark);
}

void bvh_free(Bvh *bvh, size_t count, Arena *arena)
{
    if (count == 0)
        return;
    arena_release(arena, bvh->order, count * sizeof *bvh->order);
    arena_release(arena, bvh->nodes, 2 * count * sizeof *bvh->nodes);
}

static double square_to_box(const BvhNode *node, const double point[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double below = node->low[k] - point[k], above = point[k] - node->high[k];
        double excess = below > 0 ? below : above > 0 ? above : 0;
        square += excess * excess;
    }
    return square;
}

/* Tells whether a triangle's box or its plane is farther away: most are, which costs less than to find the nearest
   point. */
static bool is_clearly_far(const double corners[3][3], const double point[3], double radius)
{
    double edges[2][3], offset[3], normal[3];
    for (int k = 0; k < 3; k++) {
        double a = corners[0][k] - point[k], b = corners[1][k] - point[k],
               c = corners[2][k] - point[k];
        if ((a > radius && b > radius && c > radius) || (a < -radius && b < -radius && c < -radius))
            return true;
    }
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    add_scaled3(offset, point, -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    double height = dot3(offset, normal);
    return height * height > (1 + 1e-9) * radius * radius * dot3(normal, normal);
}

/* ---- walks ---- */

/* Nodes that wait to be looked at. */
typedef struct Walk {
    const Bvh *bvh;
    uint32_t   waiting[MAX_DEPTH + 2], count;
} Walk;

static void walk_begin(Walk *walk, const Bvh *bvh)
{
    walk->bvh        = bvh;
    walk->waiting[0] = 0;
    walk->count      = bvh->node_count > 0;
}

static const BvhNode *walk_next(Walk *walk)
{
    return walk->count > 0 ? &walk->bvh->nodes[walk->waiting[--walk->count]] : NULL;
}

/* The halves of a node wait; one with triangles has none. */
static void walk_into(Walk *walk, const BvhNode *node)
{
    if (node->count > 0)
        return;
    walk->waiting[walk->count++] = node->second;
    walk->waiting[walk->count++] = (uint32_t)(node - walk->bvh->nodes) + 1;
}

static bool visit_node(const Bvh *bvh, const BvhNode *node, const double point[3], double radius,
                       BvhVisit *visit, void *user)
{
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        double corners[3][3], nearest[3];
        triangle_corners(bvh, bvh->order[i], corners);
        if (is_clearly_far((const double(*)[3])corners, point, radius))
            continue;
        triangle_nearest((const double(*)[3])corners, point, nearest);
        if (distance3(nearest, point) <= radius &&
            !visit(user, bvh->order[i], (const double(*)[3])corners))
            return false;
    }
    return true;
}

bool bvh_visit(const Bvh *bvh, const double point[3], double radius, BvhVisit *visit, void *user)
{
    Walk           walk;
    const BvhNode *node;
    walk_begin(&walk, bvh);
    while ((node = walk_next(&walk))) {
        if (square_to_box(node, point) > radius * radius)
            continue;
        walk_into(&walk, node);
        if (!visit_node(bvh, node, point, radius, visit, user))
            return false;
    }
    return true;
}

static bool boxes_meet(const BvhNode *node, const double low[3], const double high[3])
{
    for (int k = 0; k < 3; k++)
        if (node->low[k] > high[k] || node->high[k] < low[k])
            return false;
    return true;
}

static bool triangle_meets_box(const double corners[3][3], const double low[3],
                               const double high[3])
{
    for (int k = 0; k < 3; k++) {
        double a = corners[0][k], b = corners[1][k], c = corners[2][k];
        if ((a > high[k] && b > high[k] && c > high[k]) || (a < low[k] && b < low[k] && c < low[k]))
            return false;
    }
    return true;
}

bool bvh_visit_box(const Bvh *bvh, const double low[3], const double high[3], BvhVisit *visit,
                   void *user)
{
    Walk           walk;
    const BvhNode *node;
    walk_begin(&walk, bvh);
    while ((node = walk_next(&walk))) {
        if (!boxes_meet(node, low, high))
            continue;
        walk_into(&walk, node);
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            double corners[3][3];
            triangle_corners(bvh, bvh->order[i], corners);
            if (triangle_meets_box((const double(*)[3])corners, low, high) &&
                !visit(user, bvh->order[i], (const double(*)[3])corners))
                return false;
        }
    }
    return true;
}

bool bvh_triangle_is_near(const Bvh *bvh, uint32_t triangle, const double point[3], double radius,
                          double nearest[3])
{
    double corners[3][3];
    triangle_corners(bvh, triangle, corners);
    if (is_clearly_far((const double(*)[3])corners, point, radius))
        return false;
    triangle_nearest((const double(*)[3])corners, point, nearest);
    return distance3(nearest, point) <= radius;
}

static bool stop_at(void *user, uint32_t triangle, const double corners[3][3])
{
    uint32_t *found = user;
    (void)corners;
    *found = triangle;
    return false;
}

bool bvh_is_near(const Bvh *bvh, const double point[3], double radius, uint32_t *last)
{
    double nearest[3];
    if (*last < bvh->triangle_count && bvh_triangle_is_near(bvh, *last, point, radius, nearest))
        return true;
    return !bvh_visit(bvh, point, radius, stop_at, last);
}

typedef struct Nearest {
    const double *point;
    double        distance;
    uint32_t      triangle;
} Nearest;

static bool take_nearest(void *user, uint32_t triangle, const double corners[3][3])
{
    Nearest *nearest = user;
    double   place[3];
    triangle_nearest(corners, nearest->point, place);
    double distance = distance3(place, nearest->point);
    if (distance < nearest->distance) {
        nearest->distance = distance;
        nearest->triangle = triangle;
    }
    return true;
}

bool bvh_find_nearest(const Bvh *bvh, const double point[3], double radius, uint32_t *found)
{
    Nearest nearest = {point, INFINITY, 0};
    bvh_visit(bvh, point, radius, take_nearest, &nearest);
    if (isinf(nearest.distance))
        return false;
    *found = nearest.triangle;
    return true;
}

/* The half whose box is nearer is looked at first. */
static void walk_into_nearer(Walk *walk, const BvhNode *node, const double point[3])
{
    uint32_t first = (uint32_t)(node - walk->bvh->nodes) + 1, second = node->second;
    if (node->count > 0)
        return;
    bool second_nearer = square_to_box(&walk->bvh->nodes[second], point) <
                         square_to_box(&walk->bvh->nodes[first], point);
    walk->waiting[walk->count++] = second_nearer ? first : second;
    walk->waiting[walk->count++] = second_nearer ? second : first;
}

double bvh_distance(const Bvh *bvh, const double point[3], double radius, uint32_t *found)
{
    Nearest        nearest = {point, radius, *found};
    Walk           walk;
    const BvhNode *node;
    walk_begin(&walk, bvh);
    while ((node = walk_next(&walk))) {
        if (square_to_box(node, point) >= nearest.distance * nearest.distance)
            continue;
        walk_into_nearer(&walk, node, point);
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            double corners[3][3];
            triangle_corners(bvh, bvh->order[i], corners);
            if (!is_clearly_far((const double(*)[3])corners, point, nearest.distance))
                take_nearest(&nearest, bvh->order[i], (const double(*)[3])corners);
        }
    }
    *found = nearest.triangle;
    return nearest.distance;
}

/* Finds the nearest point of a segment. */
static void segment_nearest(const double a[3], const double b[3], const double point[3],
                            double nearest[3])
{
    double along[3], offset[3];
    add_scaled3(along, b, -1, a);
    add_scaled3(offset, point, -1, a);
    double square = dot3(along, along), part = square > 0 ? dot3(offset, along) / square : 0;
    add_scaled3(nearest, a, part < 0 ? 0 : part > 1 ? 1 : part, along);
}

static void nearest_of_edges(const double corners[3][3], const double point[3], double nearest[3])
{
    double least = INFINITY;
    for (int i = 0; i < 3; i++) {
        double candidate[3], offset[3];
        segment_nearest(corners[i], corners[(i + 1) % 3], point, candidate);
        add_scaled3(offset, candidate, -1, point);
        double square = dot3(offset, offset);
        if (square < least) {
            least = square;
            memcpy(nearest, candidate, sizeof candidate);
        }
    }
}

void triangle_nearest(const double corners[3][3], const double point[3], double nearest[3])
{
    double edges[2][3], normal[3], offset[3], cross[3];
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    add_scaled3(offset, point, -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    double square = dot3(normal, normal);
    cross3(offset, edges[1], cross);
    double first = dot3(cross, normal);
    cross3(edges[0], offset, cross);
    double second = dot3(cross, normal);
    if (square > 0 && first >= 0 && second >= 0 && first + second <= square)
        add_scaled3(nearest, point, -dot3(offset, normal) / square, normal);
    else
        nearest_of_edges(corners, point, nearest);
}
