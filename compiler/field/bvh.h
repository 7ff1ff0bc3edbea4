/*
 * bvh.h: triangles by where they are: a tree of boxes.
 */
#ifndef KRS_FIELD_BVH_H
#define KRS_FIELD_BVH_H

#include "compiler/base/arena.h"

#include <stdint.h>

typedef struct BvhNode {
    double   low[3], high[3];
    uint32_t first, count; /* of its triangles in `order`; `count` 0: it has two nodes, the first is
                              next in the list */
    uint32_t second;
} BvhNode;

typedef struct Bvh {
    const double (*vertices)[3];
    const uint32_t (*triangles)[3];
    uint32_t *order;
    BvhNode  *nodes;
    size_t    node_count, triangle_count;
} Bvh;

/* Makes memory in the arena for a tree of so many triangles. */
void bvh_new(Bvh *bvh, const double (*vertices)[3], const uint32_t (*triangles)[3], size_t count,
             Arena *arena);
/* Frees what is large of it. */
void bvh_free(Bvh *bvh, size_t count, Arena *arena);

/* Calls `visit` for the triangles that come within the radius of a point, until one returns false;
   whether none did. */
typedef bool BvhVisit(void *user, uint32_t triangle, const double corners[3][3]);
bool bvh_visit(const Bvh *bvh, const double point[3], double radius, BvhVisit *visit, void *user);
/* Does the same for those whose boxes meet a box. */
bool bvh_visit_box(const Bvh *bvh, const double low[3], const double high[3], BvhVisit *visit,
                   void *user);
/* Tells whether a triangle comes within the radius of a point, and its nearest point then. */
bool bvh_triangle_is_near(const Bvh *bvh, uint32_t triangle, const double point[3], double radius,
                          double nearest[3]);
/* Tells whether any does.  `last` is one that may, which is tried first, and becomes the one that does. */
bool bvh_is_near(const Bvh *bvh, const double point[3], double radius, uint32_t *last);

/* Tells whether any does, and the nearest then. */
bool bvh_find_nearest(const Bvh *bvh, const double point[3], double radius, uint32_t *found);

/* Returns the distance of the nearest triangle, `found` then; the radius if none is nearer than
   that.  The radius may be infinite. */
double bvh_distance(const Bvh *bvh, const double point[3], double radius, uint32_t *found);

/* Finds the nearest point of a triangle. */
void triangle_nearest(const double corners[3][3], const double point[3], double nearest[3]);

#endif
