/*
 * collapse.c: collapses edges in the order of the cost, a sum of squared distances to planes
 * (Garland and Heckbert 1997).
 */
#include "mesh/simplify/collapse.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/field/bvh.h"
#include "mesh/simplify/fans.h"

enum { MAX_STAR = 48, ASK_EVERY = 32 };
#define NO_VERTEX UINT32_MAX
/* The least height over the longest edge, of triangles that are made. */
static const double THIN = 1e-5;
/* The weight of the length of an edge beside distances, so that flat parts begin with short
   ones. */
static const double LENGTH_PART = 1e-6;

typedef struct Candidate {
    double   cost;
    uint32_t from, to, stamp;
} Candidate;

/* The sum of w (n . x - d)^2: of x^2, xy, xz, y^2, yz, z^2, x, y, z, and 1. */
typedef struct Quadric {
    double of[10];
} Quadric;

typedef struct Collapse {
    const double (*at)[3];
    uint32_t (*triangles)[3];
    bool *dead;
    /* The first corner + 1 of a vertex, and of a corner, the next of its vertex. */
    uint32_t *first, *next;
    uint32_t *stamps; /* of a vertex: counts changes of its triangles */
    uint32_t *marks, mark;
    bool     *fixed;
    Quadric  *quadrics;
    /* Bounds of how far a triangle is from the mesh that is simplified, and of how far what it
       replaces is from it. */
    double *off, *missed;
    /* The first vertex + 1 that a triangle replaced, and of a vertex the next. */
    uint32_t *points, *other;
    struct {
        Candidate *items;
        size_t     count, capacity;
    } heap;                      /* the least first; a vertex is in it once at most */
    bool                *queued; /* of a vertex: it is in the heap */
    size_t               left;   /* triangles */
    Arena               *arena;
    const CollapseRules *rules;
} Collapse;

/* ---- costs ---- */

static void normal_of(const Collapse *c, const uint32_t triangle[3], double normal[3])
{
    double edges[2][3];
    add_scaled3(edges[0], c->at[triangle[1]], -1, c->at[triangle[0]]);
    add_scaled3(edges[1], c->at[triangle[2]], -1, c->at[triangle[0]]);
    cross3(edges[0], edges[1], normal);
}

/* Adds the plane of a triangle to the quadric of a vertex. */
static void add_plane(Collapse *c, uint32_t vertex, const uint32_t triangle[3])
{
    double normal[3];
    normal_of(c, triangle, normal);
    double weight = length3(normal);
    if (!normalize3(normal))
        return;
    double *q = c->quadrics[vertex].of, d = -dot3(normal, c->at[triangle[0]]);
    double  n[4] = {normal[0], normal[1], normal[2], d};
    int     k    = 0;
    for (int i = 0; i < 4; i++)
        for (int j = i; j < 4; j++)
            q[k++] += weight * n[i] * n[j] * (i == j ? 1 : 2);
}

static double cost_at(const Quadric *quadric, const double p[3])
{
    const double *q = quadric->of;
    return p[0] * (q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3]) +
           p[1] * (q[4] * p[1] + q[5] * p[2] + q[6]) + p[2] * (q[7] * p[2] + q[8]) + q[9];
}

/* ---- the heap ---- */

static bool is_before(const Candidate *a, const Candidate *b)
{
    if (a->cost != b->cost)
        return a->cost < b->cost;
    return a->from != b->from ? a->from < b->from : a->to < b->to;
}

static void push(Collapse *c, Candidate candidate)
{
    array_push_large(c->arena, &c->heap, candidate);
    size_t i = c->heap.count - 1;
    for (; i > 0 && is_before(&candidate, &c->heap.items[(i - 1) / 2]); i = (i - 1) / 2)
        c->heap.items[i] = c->heap.items[(i - 1) / 2];
    c->heap.items[i] = candidate;
}

static Candidate pop(Collapse *c)
{
    Candidate *items = c->heap.items, least = items[0], last = items[--c->heap.count];
    size_t     i = 0, count = c->heap.count;
    for (size_t child; (child = 2 * i + 1) < count; i = child) {
        if (child + 1 < count && is_before(&items[child + 1], &items[child]))
            child++;
        if (!is_before(&items[child], &last))
            break;
        items[i] = items[child];
    }
    items[i] = last;
    return least;
}

/* ---- stars of vertices ---- */

/* Lists the triangles of a vertex; returns more than MAX_STAR if there are too many.  Removes dead
   ones from its list, which would grow with each collapse. */
static size_t star_of(Collapse *c, uint32_t vertex, uint32_t star[MAX_STAR])
{
    size_t    count = 0;
    uint32_t *link  = &c->first[vertex];
    while (*link) {
        uint32_t corner = *link;
        if (c->dead[(corner - 1) / 3]) {
            *link = c->next[corner - 1];
            continue;
        }
        if (count == MAX_STAR)
            return MAX_STAR + 1;
        star[count++] = (corner - 1) / 3;
        link          = &c->next[corner - 1];
    }
    return count;
}

static void add_corner(Collapse *c, uint32_t vertex, uint32_t corner)
{
    c->next[corner]  = c->first[vertex];
    c->first[vertex] = corner + 1;
}

static bool has_corner(const uint32_t triangle[3], uint32_t vertex)
{
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

/* Returns the corner that follows a vertex in a triangle; these are all neighbours, since the mesh
   is closed. */
static uint32_t corner_after(const uint32_t triangle[3], uint32_t vertex)
{
    return triangle[0] == vertex ? triangle[1] : triangle[1] == vertex ? triangle[2] : triangle[0];
}

/* Proposes the cheapest collapse of a vertex, or the next one after a collapse that was
   rejected. */
static void propose_vertex(Collapse *c, uint32_t vertex, const Candidate *after)
{
    uint32_t  star[MAX_STAR];
    size_t    count   = star_of(c, vertex, star);
    Candidate least   = {INFINITY, vertex, NO_VERTEX, c->stamps[vertex]};
    c->queued[vertex] = false;
    if (c->fixed[vertex] || count > MAX_STAR)
        return;
    for (size_t i = 0; i < count; i++) {
        uint32_t to = corner_after(c->triangles[star[i]], vertex);
        if (c->rules->border && c->rules->border[to])
            continue;
        double    length = distance3(c->at[vertex], c->at[to]), square = length * length;
        Candidate candidate = least;
        candidate.to        = to;
        candidate.cost      = cost_at(&c->quadrics[vertex], c->at[to]) +
                         cost_at(&c->quadrics[to], c->at[to]) + LENGTH_PART * square * square;
        if (is_before(&candidate, &least) && (!after || is_before(after, &candidate)))
            least = candidate;
    }
    c->queued[vertex] = least.to != NO_VERTEX;
    if (least.to != NO_VERTEX)
        push(c, least);
}

/* ---- collapses ---- */

/* Tells whether two vertices have only the neighbours in common that are in triangles with both
   (the link condition). */
static bool stays_closed(Collapse *c, const uint32_t *star, size_t count, uint32_t from,
                         uint32_t to)
{
    uint32_t around[MAX_STAR];
    size_t   around_count = star_of(c, to, around), shared = 0, common = 0;
    if (around_count > MAX_STAR)
        return false;
    c->mark++;
    for (size_t i = 0; i < count; i++) {
        shared += has_corner(c->triangles[star[i]], to);
        c->marks[corner_after(c->triangles[star[i]], from)] = c->mark;
    }
    for (size_t i = 0; i < around_count; i++)
        common += c->marks[corner_after(c->triangles[around[i]], to)] == c->mark;
    return shared == 2 && common == 2 && count + around_count > 8;
}

static bool is_well_shaped(const Collapse *c, const uint32_t old[3], const uint32_t new[3])
{
    double before[3], after[3], longest = 0;
    normal_of(c, old, before);
    normal_of(c, new, after);
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, distance3(c->at[new[k]], c->at[new[(k + 1) % 3]]));
    return length3(after) > THIN * longest * longest && dot3(before, after) > 0;
}

static void replace(const uint32_t old[3], uint32_t from, uint32_t to, uint32_t new[3])
{
    for (int k = 0; k < 3; k++)
        new[k] = old[k] == from ? to : old[k];
}

/* The triangles that a collapse makes, with the numbers of those that they replace. */
typedef struct Made {
    uint32_t corners[MAX_STAR][3], numbers[MAX_STAR];
    size_t   count;
    double   off, missed; /* as of Collapse */
} Made;

/* Finds the nearest new triangle to a vertex, or the first that is much nearer than it must be;
   returns how far it is. */
static double find_nearest(const Collapse *c, const Made *made, uint32_t vertex, size_t *found)
{
    static const double NEAR_ENOUGH = 0.1; /* parts of the error */
    double              least       = INFINITY;
    for (size_t i = 0; i < made->count && least > NEAR_ENOUGH * c->rules->error; i++) {
        double corners[3][3], nearest[3];
        for (int k = 0; k < 3; k++)
            memcpy(corners[k], c->at[made->corners[i][k]], sizeof corners[k]);
        triangle_nearest((const double(*)[3])corners, c->at[vertex], nearest);
        double distance = distance3(nearest, c->at[vertex]);
        if (distance < least) {
            least  = distance;
            *found = i;
        }
    }
    return least;
}

/* Tells whether all new triangles are within the error of the mesh that is simplified. */
static bool are_made_near(const Collapse *c, Made *made)
{
    made->off = 0;
    for (size_t i = 0; i < made->count; i++) {
        double distance;
        if (!c->rules->is_good(c->rules->user, made->corners[i], &distance))
            return false;
        made->off = fmax(made->off, distance);
    }
    return true;
}

/* Tells whether the vertices that new triangles replace are within the error of them. */
static bool are_points_near(const Collapse *c, const uint32_t *star, size_t count, uint32_t from,
                            Made *made)
{
    size_t found;
    made->missed = find_nearest(c, made, from, &found);
    for (size_t i = 0; i < count; i++)
        for (uint32_t point = c->points[star[i]]; point; point = c->other[point - 1]) {
            if (made->missed > c->rules->error)
                return false;
            made->missed = fmax(made->missed, find_nearest(c, made, point - 1, &found));
        }
    return made->missed <= c->rules->error;
}

/* Tells whether a collapse stays within the error: by what it adds to the old bounds, if that is
   enough, or else by tests. */
static bool are_near(const Collapse *c, const uint32_t *star, size_t count, uint32_t from,
                     uint32_t to, Made *made)
{
    static const double ROUNDING = 1e-6;
    double              most     = (1 - ROUNDING) * c->rules->error;
    double added = fan_distance(c->at, (const uint32_t(*)[3])c->triangles, star, count, from, to);
    made->off = made->missed = 0;
    for (size_t i = 0; i < count; i++) {
        made->off    = fmax(made->off, c->off[star[i]]);
        made->missed = fmax(made->missed, c->missed[star[i]]);
    }
    made->off += added;
    made->missed += added;
    return (made->missed <= most || are_points_near(c, star, count, from, made)) &&
           (made->off <= most || (c->rules->is_good && are_made_near(c, made)));
}

static bool may_collapse(Collapse *c, const uint32_t *star, size_t count, uint32_t from,
                         uint32_t to, Made *made)
{
    made->count = 0;
    if (!stays_closed(c, star, count, from, to))
        return false;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *old = c->triangles[star[i]];
        if (has_corner(old, to))
            continue;
        replace(old, from, to, made->corners[made->count]);
        if (!is_well_shaped(c, old, made->corners[made->count]))
            return false;
        made->numbers[made->count++] = star[i];
    }
    return are_near(c, star, count, from, to, made);
}

static void add_point(Collapse *c, uint32_t triangle, uint32_t vertex)
{
    c->other[vertex]    = c->points[triangle];
    c->points[triangle] = vertex + 1;
}

/* Gives replaced vertices to the nearest new triangles, and new bounds to all. */
static void move_over(Collapse *c, const uint32_t *star, size_t count, const Made *made,
                      uint32_t from)
{
    size_t   found = 0;
    uint32_t all   = from + 1;
    c->other[from] = 0;
    for (size_t i = 0; i < count; i++) {
        for (uint32_t point = c->points[star[i]], next; point; point = next) {
            next                = c->other[point - 1];
            c->other[point - 1] = all;
            all                 = point;
        }
        c->points[star[i]] = 0;
    }
    for (size_t i = 0; i < made->count; i++) {
        c->off[made->numbers[i]]    = made->off;
        c->missed[made->numbers[i]] = made->missed;
    }
    for (uint32_t point = all, next; point; point = next) {
        next = c->other[point - 1];
        if (find_nearest(c, made, point - 1, &found) <= c->rules->error)
            add_point(c, made->numbers[found], point - 1);
    }
}

/* Makes the collapse of a vertex stale.  It is proposed again when its turn comes, since most cost
   more then; or now if there was none. */
static void renew(Collapse *c, uint32_t vertex)
{
    c->stamps[vertex]++;
    if (!c->queued[vertex])
        propose_vertex(c, vertex, NULL);
}

static void renew_around(Collapse *c, uint32_t vertex)
{
    uint32_t star[MAX_STAR];
    size_t   count = star_of(c, vertex, star);
    renew(c, vertex);
    for (size_t i = 0; i < count && count <= MAX_STAR; i++)
        renew(c, corner_after(c->triangles[star[i]], vertex));
}

static void collapse(Collapse *c, const uint32_t *star, size_t count, uint32_t from, uint32_t to)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t *triangle = c->triangles[star[i]];
        if (has_corner(triangle, to)) {
            c->dead[star[i]] = true;
            c->left--;
            continue;
        }
        for (uint32_t k = 0; k < 3; k++)
            if (triangle[k] == from) {
                triangle[k] = to;
                add_corner(c, to, 3 * star[i] + k);
            }
    }
    for (int k = 0; k < 10; k++)
        c->quadrics[to].of[k] += c->quadrics[from].of[k];
    c->first[from] = 0;
    renew_around(c, to);
}

static void collapse_all(Collapse *c)
{
    size_t tried = 0, most = c->heap.count;
    while (c->heap.count > 0 && c->left > c->rules->enough) {
        if (tried++ % ASK_EVERY == 0 &&
            !c->rules->is_wanted(c->rules->user, 1 - (double)c->heap.count / (double)most))
            return;
        Candidate candidate = pop(c);
        uint32_t  star[MAX_STAR];
        Made      made;
        c->queued[candidate.from] = false;
        if (candidate.stamp != c->stamps[candidate.from]) {
            propose_vertex(c, candidate.from, NULL);
            continue;
        }
        size_t count = star_of(c, candidate.from, star);
        if (count <= MAX_STAR &&
            may_collapse(c, star, count, candidate.from, candidate.to, &made)) {
            move_over(c, star, count, &made, candidate.from);
            collapse(c, star, count, candidate.from, candidate.to);
        } else
            propose_vertex(c, candidate.from, &candidate);
    }
}

static void begin(Collapse *c, size_t vertex_count, size_t count)
{
    c->dead     = arena_new_array(c->arena, bool, count + 1);
    c->next     = arena_new_array(c->arena, uint32_t, 3 * count + 1);
    c->first    = arena_new_array(c->arena, uint32_t, vertex_count + 1);
    c->stamps   = arena_new_array(c->arena, uint32_t, vertex_count + 1);
    c->marks    = arena_new_array(c->arena, uint32_t, vertex_count + 1);
    c->fixed    = arena_new_array(c->arena, bool, vertex_count + 1);
    c->queued   = arena_new_array(c->arena, bool, vertex_count + 1);
    c->left     = count;
    c->off      = c->rules->off;
    c->missed   = c->rules->missed;
    c->points   = arena_new_array(c->arena, uint32_t, count + 1);
    c->other    = arena_new_array(c->arena, uint32_t, vertex_count + 1);
    c->quadrics = arena_new_array(c->arena, Quadric, vertex_count + 1);
    if (c->rules->border)
        memcpy(c->fixed, c->rules->border, vertex_count * sizeof *c->fixed);
    for (uint32_t i = 0; i < 3 * count; i++) {
        uint32_t vertex = c->triangles[i / 3][i % 3];
        add_corner(c, vertex, i);
        add_plane(c, vertex, c->triangles[i / 3]);
        if (c->rules->kept[i / 3])
            c->fixed[vertex] = true;
    }
    for (uint32_t i = 0; i < vertex_count; i++) {
        propose_vertex(c, i, NULL);
        if (!c->first[i] && c->rules->below[i] < count)
            add_point(c, c->rules->below[i], i);
    }
}

/* Drops dead triangles; returns how many are left. */
static size_t gather(Collapse *c, size_t vertex_count, size_t count)
{
    uint32_t *below = c->rules->below;
    size_t    left  = 0;
    for (size_t i = 0; i < vertex_count; i++)
        below[i] = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        if (c->dead[i])
            continue;
        for (uint32_t point = c->points[i]; point; point = c->other[point - 1])
            below[point - 1] = (uint32_t)left;
        memmove(c->triangles[left], c->triangles[i], sizeof *c->triangles);
        c->off[left]      = c->off[i];
        c->missed[left++] = c->missed[i];
    }
    return left;
}

size_t collapse_edges(const double (*vertices)[3], size_t vertex_count, uint32_t (*triangles)[3],
                      size_t count, const CollapseRules *rules, Arena *arena)
{
    Collapse  c    = {.at = vertices, .triangles = triangles, .arena = arena, .rules = rules};
    ArenaMark mark = arena_mark(arena);
    begin(&c, vertex_count, count);
    collapse_all(&c);
    size_t left = gather(&c, vertex_count, count);
    arena_rewind(arena, mark);
    return left;
}
