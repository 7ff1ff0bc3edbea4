/*
 * polygons.c: triangulates by ear clipping.
 *
 * A hole is joined to the ring around it by a bridge, an edge in both directions (Eberly,
 * "Triangulation by ear clipping", 2002).
 */
#include "mesh/flat/polygons.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

typedef struct Corner {
    double   at[2];
    uint32_t vertex;
} Corner;

/* A loop, and holes that were joined to it. */
typedef struct Ring {
    Corner *items;
    size_t  count, capacity;
    double  area;  /* twice */
    double  thin;  /* twice the area that it has if it is as narrow as a line */
    size_t  outer; /* of a hole: the ring around it */
    bool    joined;
} Ring;

typedef struct Cutting {
    Arena     *arena;
    Ring      *rings;
    size_t     count;
    Triangles *triangles;
    double     tiny; /* twice the area of what counts as a line */
    double     narrow;
} Cutting;

/* Returns twice the area of a triangle; above 0 where c is on the left of a to b. */
static double area2(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool same(const double a[2], const double b[2]) { return a[0] == b[0] && a[1] == b[1]; }

static void find_axes(const double normal[3], double axes[2][3])
{
    double size[3] = {fabs(normal[0]), fabs(normal[1]), fabs(normal[2])}, least[3] = {0, 0, 0};
    int    axis = size[0] <= size[1] && size[0] <= size[2] ? 0 : size[1] <= size[2] ? 1 : 2;
    least[axis] = 1;
    cross3(normal, least, axes[0]);
    normalize3(axes[0]);
    cross3(normal, axes[0], axes[1]);
}

static void read_rings(Cutting *c, const double (*at)[3], const double normal[3],
                       const Loops *loops)
{
    double axes[2][3];
    size_t begin = 0;
    find_axes(normal, axes);
    c->count = loops->ends.count;
    c->rings = arena_new_array(c->arena, Ring, c->count + 1);
    for (size_t r = 0; r < c->count; begin = loops->ends.items[r++]) {
        Ring *ring = &c->rings[r];
        for (size_t i = begin; i < loops->ends.items[r]; i++) {
            uint32_t vertex = loops->vertices.items[i];
            Corner   corner = {.vertex = vertex};
            for (int k = 0; k < 2; k++)
                corner.at[k] = dot3(at[vertex], axes[k]);
            array_push_large(c->arena, ring, corner);
        }
        for (size_t i = 1; i + 1 < ring->count; i++)
            ring->area += area2(ring->items[0].at, ring->items[i].at, ring->items[i + 1].at);
        c->tiny += 1e-13 * fabs(ring->area);
        for (size_t i = 0, j = ring->count - 1; i < ring->count; j = i++)
            ring->thin += c->narrow * real_hypot(ring->items[i].at[0] - ring->items[j].at[0],
                                                 ring->items[i].at[1] - ring->items[j].at[1]);
        if (fabs(ring->area) < ring->thin)
            ring->area = fabs(ring->area); /* it is no hole, whatever its orientation */
    }
}

/* ---- holes ---- */

static bool ring_has(const Ring *ring, const double point[2])
{
    bool inside = false;
    for (size_t i = 0, j = ring->count - 1; i < ring->count; j = i++) {
        const double *a = ring->items[i].at, *b = ring->items[j].at;
        if ((a[1] > point[1]) != (b[1] > point[1]) &&
            point[0] < (b[0] - a[0]) * (point[1] - a[1]) / (b[1] - a[1]) + a[0])
            inside = !inside;
    }
    return inside;
}

/* Finds the smallest ring around a hole, which may touch it at some of its corners. */
static bool find_outer(Cutting *c, Ring *hole)
{
    bool found = false;
    for (size_t r = 0; r < c->count; r++) {
        const Ring *ring = &c->rings[r];
        size_t      has  = 0;
        for (size_t i = 0; ring->area > 0 && i < hole->count; i++)
            has += ring_has(ring, hole->items[i].at);
        if (2 * has > hole->count && (!found || ring->area < c->rings[hole->outer].area)) {
            hole->outer = r;
            found       = true;
        }
    }
    return found;
}

/* Tells whether two points are on different sides of the line a to b, or one of them is on it. */
static bool line_parts(const double a[2], const double b[2], const double c[2], const double d[2],
                       double tiny)
{
    double first = area2(a, b, c), second = area2(a, b, d);
    return (first >= 0) != (second >= 0) || fabs(first) <= tiny || fabs(second) <= tiny;
}

/* Tells whether the lines a to b and c to d cross, or one has an end on the other, but for a common
   end. */
static bool lines_cross(const double a[2], const double b[2], const double c[2], const double d[2],
                        double tiny)
{
    if (same(a, c) || same(a, d) || same(b, c) || same(b, d))
        return false;
    double margin = tiny > 0 ? sqrt(tiny) : 0;
    for (int k = 0; k < 2; k++) /* they are far from each other, perhaps collinear */
        if (max2(a[k], b[k]) < min2(c[k], d[k]) - margin ||
            max2(c[k], d[k]) < min2(a[k], b[k]) - margin)
            return false;
    return line_parts(a, b, c, d, tiny) && line_parts(c, d, a, b, tiny);
}

static bool ring_blocks(const Ring *ring, const double a[2], const double b[2], double tiny)
{
    for (size_t i = 0, j = ring->count - 1; i < ring->count; j = i++)
        if (lines_cross(a, b, ring->items[j].at, ring->items[i].at, tiny))
            return true;
    return false;
}

/* Tells whether the line from corner i of a ring to a point begins inside. */
static bool goes_inside(const Ring *ring, size_t i, const double to[2])
{
    const double *at     = ring->items[i].at;
    const double *before = ring->items[(i + ring->count - 1) % ring->count].at;
    const double *behind = ring->items[(i + 1) % ring->count].at;
    bool left_of_before = area2(before, at, to) > 0, left_of_behind = area2(at, behind, to) > 0;
    return area2(before, at, behind) > 0 ? left_of_before && left_of_behind
                                         : left_of_before || left_of_behind;
}

static bool is_blocked(const Cutting *c, const double a[2], const double b[2])
{
    for (size_t r = 0; r < c->count; r++)
        if (!c->rings[r].joined && ring_blocks(&c->rings[r], a, b, c->tiny))
            return true;
    return false;
}

/* Finds the shortest bridge from a hole to the ring around it that crosses nothing: mostly the
   first or second that is tried. */
static bool find_bridge(const Cutting *c, const Ring *hole, size_t *from, size_t *to)
{
    const Ring *outer = &c->rings[hole->outer];
    size_t      right = 0;
    for (size_t i = 1; i < hole->count; i++)
        if (hole->items[i].at[0] > hole->items[right].at[0])
            right = i;
    *from               = right;
    const double *a     = hole->items[right].at;
    ArenaMark     mark  = arena_mark(c->arena);
    bool         *tried = arena_new_array(c->arena, bool, outer->count), found = false;
    for (double least = 0; !found && least < HUGE_VAL;) {
        least = HUGE_VAL;
        for (size_t i = 0; i < outer->count; i++) {
            const double *b        = outer->items[i].at;
            double        distance = real_hypot(a[0] - b[0], a[1] - b[1]);
            if (tried[i] || distance >= least || !goes_inside(outer, i, a) ||
                !goes_inside(hole, right, b))
                continue;
            least = distance;
            *to   = i;
        }
        if (least < HUGE_VAL) {
            tried[*to] = true;
            found      = !is_blocked(c, a, outer->items[*to].at);
        }
    }
    arena_rewind(c->arena, mark);
    return found;
}

static bool join_hole(Cutting *c, Ring *hole)
{
    size_t from = 0, to = 0;
    if (!find_bridge(c, hole, &from, &to))
        return false;
    Ring  *outer  = &c->rings[hole->outer];
    size_t behind = outer->count - to, added = hole->count + 2;
    for (size_t i = 0; i < added; i++)
        array_push_large(c->arena, outer, (Corner){0});
    Corner *at = outer->items +
                 to; /* the corner, the hole and its first corner again, the corner again */
    memmove(at + added, at, behind * sizeof *at);
    for (size_t i = 0; i <= hole->count; i++)
        at[1 + i] = hole->items[(from + i) % hole->count];
    hole->joined = true;
    return true;
}

static double right_end(const Ring *ring)
{
    double right = -HUGE_VAL;
    for (size_t i = 0; i < ring->count; i++)
        right = max2(right, ring->items[i].at[0]);
    return right;
}

/* Joins holes to the rings around them, from right to left: no other hole is between the rightmost
   and its ring. */
static bool join_holes(Cutting *c)
{
    for (size_t r = 0; r < c->count; r++)
        if (c->rings[r].area < 0 && !find_outer(c, &c->rings[r]))
            return false;
    for (;;) {
        Ring *next = NULL;
        for (size_t r = 0; r < c->count; r++) {
            Ring *ring = &c->rings[r];
            if (ring->area < 0 && !ring->joined && (!next || right_end(ring) > right_end(next)))
                next = ring;
        }
        if (!next)
            return true;
        if (!join_hole(c, next))
            return false;
    }
}

/* ---- ears ---- */

/* The rules of ears.  First ears that no corner comes near; if there are none, those that corners
   may touch, then those without area, since collinear corners are common, and last any that is as
   narrow as corners are inexact. */
typedef struct EarRule {
    /* Twice the areas of an ear, and of the triangles that a corner makes with each side of it. */
    double least, touching;
} EarRule;

static bool triangle_has(const double *const corners[3], const double point[2], double touching)
{
    for (int i = 0; i < 3; i++)
        if (same(corners[i], point))
            return false;
    for (int i = 0; i < 3; i++)
        if (area2(corners[i], corners[(i + 1) % 3], point) < touching)
            return false;
    return true;
}

/* Corners that are left, by the cells of a grid that they are in. */
typedef struct Buckets {
    double    low[2], cells[2]; /* per length */
    uint32_t  side;
    uint32_t *first, *next; /* of each cell, and of each corner; NONE ends them */
    bool     *cut;
} Buckets;

enum { NONE = 0x7fffffff };

static uint32_t cell_along(const Buckets *buckets, double at, int k)
{
    double cell = (at - buckets->low[k]) * buckets->cells[k];
    return (uint32_t)min2(max2(cell, 0), buckets->side - 1);
}

static void fill_buckets(Buckets *buckets, const Ring *ring, Arena *arena)
{
    double high[2];
    *buckets       = (Buckets){.side = 1 + (uint32_t)sqrt((double)ring->count)};
    size_t cells   = (size_t)buckets->side * buckets->side;
    buckets->first = arena_new_array(arena, uint32_t, cells);
    buckets->next  = arena_new_array(arena, uint32_t, ring->count);
    buckets->cut   = arena_new_array(arena, bool, ring->count);
    for (size_t i = 0; i < cells; i++)
        buckets->first[i] = NONE;
    for (int k = 0; k < 2; k++) {
        buckets->low[k] = high[k] = ring->items[0].at[k];
        for (size_t i = 1; i < ring->count; i++) {
            buckets->low[k] = min2(buckets->low[k], ring->items[i].at[k]);
            high[k]         = max2(high[k], ring->items[i].at[k]);
        }
        buckets->cells[k] = buckets->side / max2(high[k] - buckets->low[k], 1e-300);
    }
    for (size_t i = 0; i < ring->count; i++) {
        size_t cell = (size_t)cell_along(buckets, ring->items[i].at[1], 1) * buckets->side +
                      cell_along(buckets, ring->items[i].at[0], 0);
        buckets->next[i]     = buckets->first[cell];
        buckets->first[cell] = (uint32_t)i;
    }
}

/* Tells whether some corner that is left is in a triangle, or touches it. */
static bool has_corner(const Buckets *buckets, const Ring *ring, const double *const corners[3],
                       double touching)
{
    uint32_t low[2], high[2];
    double   margin = touching < 0 ? sqrt(-touching) : 0;
    for (int k = 0; k < 2; k++) {
        low[k]  = cell_along(buckets,
                             min2(min2(corners[0][k], corners[1][k]), corners[2][k]) - margin, k);
        high[k] = cell_along(buckets,
                             max2(max2(corners[0][k], corners[1][k]), corners[2][k]) + margin, k);
    }
    for (uint32_t y = low[1]; y <= high[1]; y++)
        for (uint32_t x = low[0]; x <= high[0]; x++)
            for (uint32_t i = buckets->first[(size_t)y * buckets->side + x]; i != NONE;
                 i          = buckets->next[i])
                if (!buckets->cut[i] && triangle_has(corners, ring->items[i].at, touching))
                    return true;
    return false;
}

static bool is_ear(const Ring *ring, const Buckets *buckets, const uint32_t *left, size_t count,
                   size_t i, EarRule rule)
{
    const Corner *items      = ring->items;
    const double *corners[3] = {items[left[(i + count - 1) % count]].at, items[left[i]].at,
                                items[left[(i + 1) % count]].at};
    return area2(corners[0], corners[1], corners[2]) > rule.least &&
           !has_corner(buckets, ring, corners, rule.touching);
}

static void cut_ear(Cutting *c, const Ring *ring, uint32_t *left, size_t *count, size_t at)
{
    array_reserve_large(c->arena, c->triangles);
    uint32_t *triangle = c->triangles->items[c->triangles->count++];
    for (size_t k = 0; k < 3; k++)
        triangle[k] = ring->items[left[(at + *count + k - 1) % *count]].vertex;
    memmove(&left[at], &left[at + 1], (*count - at - 1) * sizeof *left);
    --*count;
}

/* Clips the ears of a ring.  Each search begins two corners behind the last ear, so that triangles
   fan less. */
static bool cut_ring(Cutting *c, const Ring *ring)
{
    const double  tiny    = c->tiny;
    const EarRule rules[] = {{tiny, -tiny}, {tiny, tiny}, {-tiny, tiny}, {-ring->thin, HUGE_VAL}};
    uint32_t     *left    = arena_new_array(c->arena, uint32_t, ring->count);
    size_t        count = ring->count, at = 0, tries = 0, rule = 0;
    Buckets       buckets;
    fill_buckets(&buckets, ring, c->arena);
    for (size_t i = 0; i < count; i++)
        left[i] = (uint32_t)i;
    while (count > 2) {
        at %= count;
        if (is_ear(ring, &buckets, left, count, at, rules[rule])) {
            buckets.cut[left[at]] = true;
            cut_ear(c, ring, left, &count, at);
            tries = rule = 0;
        } else if (++tries > count) {
            tries = 0;
            if (++rule == sizeof rules / sizeof *rules)
                return false;
        }
        at++;
    }
    return true;
}

bool polygons_cut(const double (*at)[3], const double normal[3], const Loops *loops, double narrow,
                  Triangles *triangles, Arena *arena)
{
    Cutting c = {.arena = arena, .triangles = triangles, .narrow = narrow};
    read_rings(&c, at, normal, loops);
    if (!join_holes(&c))
        return false;
    for (size_t r = 0; r < c.count; r++)
        if (!c.rings[r].joined && !cut_ring(&c, &c.rings[r]))
            return false;
    return true;
}
