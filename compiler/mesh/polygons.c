/*
 * polygons.c: ears are cut off, one after the other.
 *
 * A hole is joined to what is around it by a line that is walked in both directions (Eberly, "Triangulation by ear clipping", 2002).
 */
#include "compiler/mesh/polygons.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"

typedef struct Corner {
    double   at[2];
    uint32_t vertex;
} Corner;

/* A loop, and what was joined to it. */
typedef struct Ring {
    Corner *items;
    size_t  count, capacity;
    double  area;  /* twice */
    size_t  outer; /* of a hole: the ring around it */
    bool    joined;
} Ring;

typedef struct Cutting {
    Arena     *arena;
    Ring      *rings;
    size_t     count;
    Triangles *triangles;
    double     tiny; /* twice the area of what counts as a line */
} Cutting;

/* Twice the area of a triangle; above 0 where c is on the left of a to b. */
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
            array_push(c->arena, ring, corner);
        }
        for (size_t i = 1; i + 1 < ring->count; i++)
            ring->area += area2(ring->items[0].at, ring->items[i].at, ring->items[i + 1].at);
        c->tiny += 1e-13 * fabs(ring->area);
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

/* The smallest ring around a hole; it may touch that at some of its corners. */
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

/* Whether two points are on different sides of the line a to b, or one of them is on it. */
static bool line_parts(const double a[2], const double b[2], const double c[2], const double d[2],
                       double tiny)
{
    double first = area2(a, b, c), second = area2(a, b, d);
    return (first >= 0) != (second >= 0) || fabs(first) <= tiny || fabs(second) <= tiny;
}

/* Whether the lines a to b and c to d cross, or one has an end on the other, but for a common end. */
static bool lines_cross(const double a[2], const double b[2], const double c[2], const double d[2],
                        double tiny)
{
    if (same(a, c) || same(a, d) || same(b, c) || same(b, d))
        return false;
    double margin = sqrt(tiny);
    for (int k = 0; k < 2; k++) /* far from each other, also where they are in one line */
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

/* Whether a line from corner i of a ring to a point begins inside. */
static bool goes_inside(const Ring *ring, size_t i, const double to[2])
{
    const double *at     = ring->items[i].at;
    const double *before = ring->items[(i + ring->count - 1) % ring->count].at;
    const double *behind = ring->items[(i + 1) % ring->count].at;
    bool left_of_before = area2(before, at, to) > 0, left_of_behind = area2(at, behind, to) > 0;
    return area2(before, at, behind) > 0 ? left_of_before && left_of_behind
                                         : left_of_before || left_of_behind;
}

/* The shortest line from a hole to the ring around it that crosses nothing. */
static bool find_bridge(const Cutting *c, const Ring *hole, size_t *from, size_t *to)
{
    const Ring *outer = &c->rings[hole->outer];
    double      least = HUGE_VAL;
    size_t      right = 0;
    for (size_t i = 1; i < hole->count; i++)
        if (hole->items[i].at[0] > hole->items[right].at[0])
            right = i;
    *from           = right;
    const double *a = hole->items[right].at;
    for (size_t i = 0; i < outer->count; i++) {
        const double *b        = outer->items[i].at;
        double        distance = hypot(a[0] - b[0], a[1] - b[1]);
        if (distance >= least || !goes_inside(outer, i, a) || !goes_inside(hole, right, b))
            continue;
        bool blocked = false;
        for (size_t r = 0; r < c->count && !blocked; r++)
            blocked = !c->rings[r].joined && ring_blocks(&c->rings[r], a, b, c->tiny);
        if (!blocked) {
            least = distance;
            *to   = i;
        }
    }
    return least < HUGE_VAL;
}

static bool join_hole(Cutting *c, Ring *hole)
{
    size_t from = 0, to = 0;
    if (!find_bridge(c, hole, &from, &to))
        return false;
    Ring *outer = &c->rings[hole->outer], whole = *outer;
    whole.items = NULL;
    whole.count = whole.capacity = 0;
    for (size_t i = 0; i <= to; i++)
        array_push(c->arena, &whole, outer->items[i]);
    for (size_t i = 0; i <= hole->count; i++)
        array_push(c->arena, &whole, hole->items[(from + i) % hole->count]);
    for (size_t i = to; i < outer->count; i++)
        array_push(c->arena, &whole, outer->items[i]);
    *outer       = whole;
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

/* Those that reach farthest to the right first: no other hole is between them and what is around. */
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

/* What counts as an ear.  First ears that no corner comes near; where there are none, those that corners may touch, and last
   those without area: corners in a line are common. */
typedef struct EarRule {
    double least,
        touching; /* twice areas: of an ear, and of what a corner makes with each side of it */
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

static bool is_ear(const Ring *ring, const uint32_t *left, size_t count, size_t i, EarRule rule)
{
    const Corner *items      = ring->items;
    const double *corners[3] = {items[left[(i + count - 1) % count]].at, items[left[i]].at,
                                items[left[(i + 1) % count]].at};
    if (!(area2(corners[0], corners[1], corners[2]) > rule.least))
        return false;
    for (size_t k = 0; k < count; k++)
        if (triangle_has(corners, items[left[k]].at, rule.touching))
            return false;
    return true;
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

/* The next ear is looked for behind the one beside, so that triangles fan less. */
static bool cut_ring(Cutting *c, const Ring *ring)
{
    const double  tiny    = c->tiny;
    const EarRule rules[] = {{tiny, -tiny}, {tiny, tiny}, {-tiny, tiny}};
    uint32_t     *left    = arena_new_array(c->arena, uint32_t, ring->count);
    size_t        count = ring->count, at = 0, looked = 0, rule = 0;
    for (size_t i = 0; i < count; i++)
        left[i] = (uint32_t)i;
    while (count > 2) {
        at %= count;
        if (is_ear(ring, left, count, at, rules[rule])) {
            cut_ear(c, ring, left, &count, at);
            looked = rule = 0;
        } else if (++looked > count) {
            looked = 0;
            if (++rule == sizeof rules / sizeof *rules)
                return false;
        }
        at++;
    }
    return true;
}

bool polygons_cut(const double (*at)[3], const double normal[3], const Loops *loops,
                  Triangles *triangles, Arena *arena)
{
    Cutting c = {.arena = arena, .triangles = triangles};
    read_rings(&c, at, normal, loops);
    if (!join_holes(&c))
        return false;
    for (size_t r = 0; r < c.count; r++)
        if (!c.rings[r].joined && !cut_ring(&c, &c.rings[r]))
            return false;
    return true;
}
