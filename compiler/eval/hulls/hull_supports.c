/*
 * hull_supports.c: for each pair of balls the directions in which one plane touches both and no other
 * ball is beyond it.  That takes time by the third power of their number, and needs no care where
 * more than three balls touch a plane: such a plane is found several times, and kept once.
 */
#include "compiler/eval/hulls/hull_supports.h"

#include <math.h>
#include <stdlib.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

/* The part of the size of all below which a length is rounding. */
static const double SLACK = 1e-11;
/* Shorter arcs leave nothing out that single precision can tell, nor do nearer normals. */
static const double SHORTEST_ARC = 1e-7, NEAR_NORMALS = 1e-9;

/* An angle at which an arc begins or ends, and by how much the number of arcs changes there. */
typedef struct ArcEnd {
    double angle;
    int    change;
} ArcEnd;

typedef struct Work {
    Arena          *arena;
    const HullBall *balls;
    size_t          count;
    double          slack;
    HullSupports    hull;
    bool           *joined; /* pairs with an edge, or a face in the plane */
    ArcEnd         *arc_ends;
} Work;

/* Two balls, and directions sine * axis + cosine * (cos(angle) * e1 + sin(angle) * e2). */
typedef struct Pair {
    size_t first, second;
    double axis[3], e1[3], e2[3], sine, cosine;
} Pair;

static double size_of(const HullBall *balls, size_t count)
{
    double size = 0;
    for (size_t i = 0; i < count; i++)
        size = fmax(size, distance3(balls[i].centre, balls[0].centre) + balls[i].radius);
    return size;
}

/* ---- pairs ---- */

/* Makes a pair of balls; false: one has the other in it. */
static bool pair_make(const Work *w, size_t first, size_t second, bool plane, Pair *pair)
{
    const HullBall *a = &w->balls[first], *b = &w->balls[second];
    double          size = distance3(a->centre, b->centre);
    if (size <= fabs(a->radius - b->radius) + w->slack)
        return false;
    *pair = (Pair){first, second, {0}, {0}, {0}, (a->radius - b->radius) / size, 0};
    add_scaled3(pair->axis, b->centre, -1, a->centre);
    normalize3(pair->axis);
    int least = fabs(pair->axis[0]) < fabs(pair->axis[1]) ? 0 : 1;
    if (fabs(pair->axis[2]) < fabs(pair->axis[least]))
        least = 2;
    double side[3] = {least == 0, least == 1, least == 2};
    if (plane)
        side[0] = side[1] = 0, side[2] = 1;
    cross3(pair->axis, side, pair->e1);
    normalize3(pair->e1);
    cross3(pair->axis, pair->e1, pair->e2);
    pair->cosine = sqrt(fmax(1 - pair->sine * pair->sine, 0));
    return true;
}

static void pair_direction(const Pair *pair, double angle, double direction[3])
{
    for (int i = 0; i < 3; i++)
        direction[i] = pair->sine * pair->axis[i] + pair->cosine * (real_cos(angle) * pair->e1[i] +
                                                                    real_sin(angle) * pair->e2[i]);
}

static void add_face(Work *w, const Pair *pair, double angle)
{
    HullFace        face;
    const HullBall *ball = &w->balls[pair->first];
    pair_direction(pair, angle, face.normal);
    face.offset = dot3(face.normal, ball->centre) + ball->radius;
    for (size_t i = 0; i < w->hull.faces.count; i++)
        if (distance3(w->hull.faces.items[i].normal, face.normal) < NEAR_NORMALS)
            return;
    array_push(w->arena, &w->hull.faces, face);
}

static void mark_joined(Work *w, const Pair *pair)
{
    w->joined[pair->first * w->count + pair->second] = true;
    w->joined[pair->second * w->count + pair->first] = true;
}

/* ---- space: arcs ---- */

static void add_edge(Work *w, const Pair *pair, double from, double to)
{
    HullEdge edge = {w->balls[pair->first], {0}, pair->sine, pair->cosine, {0}, -2};
    double   half = 0.5 * (to - from), angle = 0.5 * (from + to);
    bool     whole = half > M_PI - 1e-9;
    for (int i = 0; i < 3; i++) {
        edge.axis[i]   = pair->axis[i];
        edge.middle[i] = real_cos(angle) * pair->e1[i] + real_sin(angle) * pair->e2[i];
    }
    if (!whole) {
        edge.least = real_cos(half);
        add_face(w, pair, from);
        add_face(w, pair, to);
    }
    array_push(w->arena, &w->hull.edges, edge);
    mark_joined(w, pair);
}

/* Finds the directions of a pair beyond which another ball reaches: `arc_ends` gets where they
   begin and end, from -pi to pi.  False: all of them. */
static bool hide_behind(Work *w, const Pair *pair, size_t other, size_t *end_count)
{
    const HullBall *a = &w->balls[pair->first], *c = &w->balls[other];
    double          towards[3];
    add_scaled3(towards, c->centre, -1, a->centre);
    double x = pair->cosine * dot3(towards, pair->e1), y = pair->cosine * dot3(towards, pair->e2);
    double room  = a->radius - c->radius - pair->sine * dot3(towards, pair->axis),
           reach = real_hypot(x, y);
    if (room >= reach - w->slack)
        return true;
    if (room <= -reach)
        return false;
    double middle = real_atan2(y, x), half = real_acos(room / reach);
    double from = middle - half, to = middle + half;
    for (int lap = -1; lap <= 1; lap++) {
        double low = fmax(from + 2 * M_PI * lap, -M_PI), high = fmin(to + 2 * M_PI * lap, M_PI);
        if (low >= high)
            continue;
        w->arc_ends[(*end_count)++] = (ArcEnd){low, 1};
        w->arc_ends[(*end_count)++] = (ArcEnd){high, -1};
    }
    return true;
}

static int compare_arc_ends(const void *left, const void *right)
{
    const ArcEnd *a = left, *b = right;
    if (a->angle != b->angle)
        return a->angle < b->angle ? -1 : 1;
    return b->change - a->change; /* what begins where another ends leaves no gap */
}

/* Adds an edge for each arc that is left of the circle.  The first and the last may be one. */
static void add_edges(Work *w, const Pair *pair, size_t end_count)
{
    double from = -M_PI, first_end = -M_PI;
    int    hidden = 0;
    qsort(w->arc_ends, end_count, sizeof *w->arc_ends, compare_arc_ends);
    for (size_t i = 0; i < end_count; i++) {
        double angle = w->arc_ends[i].angle;
        if (hidden == 0 && from == -M_PI)
            first_end = angle;
        else if (hidden == 0 && angle - from > SHORTEST_ARC)
            add_edge(w, pair, from, angle);
        hidden += w->arc_ends[i].change;
        if (hidden == 0)
            from = angle;
    }
    if (end_count == 0)
        add_edge(w, pair, -M_PI, M_PI);
    else if (M_PI - from + first_end + M_PI > SHORTEST_ARC)
        add_edge(w, pair, from, first_end + 2 * M_PI);
}

static void join_in_space(Work *w, const Pair *pair)
{
    size_t end_count = 0;
    for (size_t k = 0; k < w->count; k++)
        if (k != pair->first && k != pair->second && !hide_behind(w, pair, k, &end_count))
            return;
    add_edges(w, pair, end_count);
}

/* ---- the plane: two lines touch two discs ---- */

static void join_in_plane(Work *w, const Pair *pair)
{
    for (int side = 0; side < 2; side++) {
        double direction[3], beyond = -HUGE_VAL;
        pair_direction(pair, M_PI * side, direction);
        const HullBall *a      = &w->balls[pair->first];
        double          offset = dot3(direction, a->centre) + a->radius;
        for (size_t k = 0; k < w->count; k++)
            if (k != pair->first && k != pair->second)
                beyond = fmax(beyond, dot3(direction, w->balls[k].centre) + w->balls[k].radius);
        if (beyond > offset + w->slack)
            continue;
        add_face(w, pair, M_PI * side);
        mark_joined(w, pair);
    }
}

/* ---- corners ---- */

/* Limits of the balls next to it suffice where none of them is smaller: directions between caps of a
   hemisphere at most are connected.  Else all balls count. */
static void add_corner(Work *w, size_t index)
{
    const HullBall *ball   = &w->balls[index];
    HullCorner      corner = {.ball = *ball};
    bool            found = false, all = false;
    for (size_t k = 0; k < w->count; k++) {
        bool joined = w->joined[index * w->count + k];
        found       = found || joined;
        all         = all || (joined && w->balls[k].radius < ball->radius - w->slack);
    }
    for (size_t k = 0; k < w->count; k++) {
        HullLimit limit = {{0}, ball->radius - w->balls[k].radius};
        if (k == index || !(all || w->joined[index * w->count + k]))
            continue;
        add_scaled3(limit.towards, w->balls[k].centre, -1, ball->centre);
        array_push(w->arena, &corner.limits, limit);
    }
    if (found || w->count == 1)
        array_push(w->arena, &w->hull.corners, corner);
}

/* ---- all ---- */

/* Finds the balls that are in no other one; of equal ones the first. */
static size_t outer_balls(const HullBall *balls, size_t count, double slack, HullBall *outer)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        bool inner = false;
        for (size_t k = 0; k < count && !inner; k++) {
            double depth = balls[k].radius - balls[i].radius -
                           distance3(balls[i].centre, balls[k].centre);
            bool equal = fabs(balls[k].radius - balls[i].radius) <= slack;
            inner      = k != i && depth >= -slack && (!equal || k < i);
        }
        if (!inner)
            outer[kept++] = balls[i];
    }
    return kept;
}

HullSupports hull_supports(Arena *arena, const HullBall *balls, size_t count, bool plane)
{
    HullBall *outer = arena_new_array(arena, HullBall, count);
    Work      w     = {.arena = arena, .balls = outer, .slack = SLACK * size_of(balls, count)};
    w.count         = outer_balls(balls, count, w.slack, outer);
    w.joined        = arena_new_array(arena, bool, w.count *w.count);
    w.arc_ends      = arena_new_array(arena, ArcEnd, 6 * w.count);
    for (size_t i = 0; i < w.count; i++)
        for (size_t k = i + 1; k < w.count; k++) {
            Pair pair;
            if (!pair_make(&w, i, k, plane, &pair))
                continue;
            if (plane)
                join_in_plane(&w, &pair);
            else
                join_in_space(&w, &pair);
        }
    for (size_t i = 0; i < w.count; i++)
        add_corner(&w, i);
    return w.hull;
}

/* Returns the centre that is farthest from a point, a line or a plane through the first one: what
   is left of its offset when the parts along unit vectors are taken away.  Returns its size. */
static double farthest(const HullBall *balls, size_t count, double (*along)[3], int known)
{
    double most = 0;
    for (size_t i = 1; i < count; i++) {
        double offset[3];
        add_scaled3(offset, balls[i].centre, -1, balls[0].centre);
        for (int k = 0; k < known; k++)
            add_scaled3(offset, offset, -dot3(offset, along[k]), along[k]);
        if (length3(offset) <= most)
            continue;
        most = length3(offset);
        for (int k = 0; k < 3; k++)
            along[known][k] = offset[k] / most;
    }
    return most;
}

bool balls_are_flat(const HullBall *balls, size_t count, bool plane)
{
    double along[3][3], size = size_of(balls, count);
    for (int known = 0; known < (plane ? 2 : 3); known++)
        if (farthest(balls, count, along, known) <= 1e-9 * size)
            return true;
    return false;
}
