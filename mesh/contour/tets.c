/* tets.c: bisects tetrahedra, and closes the bisection. */
#include "mesh/contour/tets.h"

#include <string.h>

#include "compiler/base/vec.h"

static NumberKey point_key(const uint32_t at[3])
{
    return (NumberKey){(uint64_t)at[0] << 32 | at[1], (uint64_t)at[2] + 1};
}

static uint32_t take_point(Tets *tets, const uint32_t at[3])
{
    uint32_t fresh  = (uint32_t)tets->points.count;
    uint32_t number = numbering_take(&tets->numbers, point_key(at), fresh);
    if (number == fresh) {
        TetPoint point = {.at = {at[0], at[1], at[2]}, .distance = NAN};
        array_push_large(tets->arena, &tets->points, point);
    }
    return number;
}

/* Returns the width of a tetrahedron: 1 over the largest gradient of a barycentric coordinate, or
   of a sum of two. */
static float find_width(const Tets *tets, const Tet *tet)
{
    double corners[4][3], edges[3][3], shares[4][3] = {{0}}, most = 0;
    tets_corners(tets, tet, corners);
    for (int i = 0; i < 3; i++)
        add_scaled3(edges[i], corners[i + 1], -1, corners[0]);
    for (int i = 0; i < 3; i++) {
        cross3(edges[(i + 1) % 3], edges[(i + 2) % 3], shares[i + 1]);
        add_scaled3(shares[i + 1], shares[0], 1 / dot3(shares[i + 1], edges[i]), shares[i + 1]);
    }
    for (int i = 1; i < 4; i++)
        add_scaled3(shares[0], shares[0], -1, shares[i]);
    for (int i = 0; i < 4; i++) {
        double pair[3];
        add_scaled3(pair, shares[0], i > 0, shares[i]);
        most = max2(most, max2(length3(shares[i]), length3(pair)));
    }
    return (float)((1 - 1e-6) / most);
}

/* ---- points, and tetrahedra that wait for closure ---- */

static void link_point(Tets *tets, uint32_t point, uint32_t tet)
{
    TetLink link = {tet, tets->points.items[point].first};
    array_push_large(tets->arena, &tets->links, link);
    tets->points.items[point].first = (uint32_t)tets->links.count;
}

static bool has_point(const Tet *tet, uint32_t point)
{
    return tet->points[0] == point || tet->points[1] == point || tet->points[2] == point ||
           tet->points[3] == point;
}

static void queue_tet(Tets *tets, size_t tet)
{
    while (tets->waiting.count <= tet / 64)
        array_push_large(tets->arena, &tets->waiting, 0);
    tets->waiting.items[tet / 64] |= (uint64_t)1 << tet % 64;
}

/* Returns the first that waits, from a number on; 64 times the number of words if none does. */
static size_t first_waiting(const Tets *tets, size_t from)
{
    size_t end = 64 * tets->waiting.count;
    while (from < end && !(tets->waiting.items[from / 64] >> from % 64 & 1))
        from = tets->waiting.items[from / 64] >> from % 64 ? from + 1 : (from / 64 + 1) * 64;
    return from;
}

/* Lets tetrahedra with both points wait, and replaces `from` by `moved` in the list of the second
   point. */
static void queue_around(Tets *tets, uint32_t first, uint32_t second, uint32_t from, uint32_t moved)
{
    for (uint32_t at = tets->points.items[second].first; at; at = tets->links.items[at - 1].next) {
        TetLink *link = &tets->links.items[at - 1];
        if (has_point(&tets->list.items[link->tet], first))
            queue_tet(tets, link->tet);
        if (link->tet == from)
            link->tet = moved;
    }
}

/* ---- bisection ---- */

static void add_tet(Tets *tets, Tet tet)
{
    tet.fresh = true;
    array_push_large(tets->arena, &tets->fresh, (uint32_t)tets->list.count);
    array_push_large(tets->arena, &tets->list, tet);
}

static void replace_tet(Tets *tets, size_t index, Tet tet)
{
    if (!tet.fresh)
        array_push_large(tets->arena, &tets->fresh, (uint32_t)index);
    tet.fresh               = true;
    tets->list.items[index] = tet;
}

void tets_forget_fresh(Tets *tets)
{
    for (size_t i = 0; i < tets->fresh.count; i++)
        tets->list.items[tets->fresh.items[i]].fresh = false;
    tets->fresh.count = 0;
}

void tets_renew(Tets *tets, uint32_t point)
{
    for (uint32_t at = tets->points.items[point].first; at; at = tets->links.items[at - 1].next) {
        uint32_t number = tets->links.items[at - 1].tet;
        Tet      tet    = tets->list.items[number];
        tet.replaced    = tet.replaced || tet.triangle_count > 0;
        tet.state       = TET_UNPROVEN;
        tet.deviation   = INFINITY;
        tet.stale       = false;

        tet.triangle_count = 0;
        replace_tet(tets, number, tet);
    }
}

bool tets_is_moved(const Tets *tets, const Tet *tet)
{
    const TetPoint *points = tets->points.items;
    return points[tet->points[0]].moved || points[tet->points[1]].moved ||
           points[tet->points[2]].moved || points[tet->points[3]].moved;
}

/* Makes Kuhn's six tetrahedra: each is a path along edges from one corner of the cube to the
   opposite one. */
void tets_new(Tets *tets, const double origin[3], double side, Arena *arena)
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                     {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    *tets                         = (Tets){
                                .arena = arena, .numbers = {.arena = arena}, .closures = 1, .step = side / CUBE_STEPS};
    memcpy(tets->origin, origin, sizeof tets->origin);
    for (int i = 0; i < 6; i++) {
        uint32_t at[3] = {0, 0, 0};
        Tet      tet   = {.tag = 3};
        for (int k = 0; k < 4; k++) {
            tet.points[k] = take_point(tets, at);
            if (k < 3)
                at[orders[i][k]] = CUBE_STEPS;
        }
        tet.width = find_width(tets, &tet);
        for (int k = 0; k < 4; k++)
            link_point(tets, tet.points[k], (uint32_t)tets->list.count);
        add_tet(tets, tet);
    }
}

/* Finds the middle of two points; returns false if it is between whole steps. */
static bool find_middle(const Tets *tets, uint32_t a, uint32_t b, uint32_t middle[3])
{
    const uint32_t *from = tets->points.items[a].at, *to = tets->points.items[b].at;
    for (int k = 0; k < 3; k++) {
        if ((from[k] + to[k]) % 2)
            return false;
        middle[k] = (from[k] + to[k]) / 2;
    }
    return true;
}

bool tets_can_bisect(const Tets *tets, size_t index)
{
    const Tet *tet = &tets->list.items[index];
    uint32_t   middle[3];
    return find_middle(tets, tet->points[0], tet->points[tet->tag], middle);
}

void tets_bisect(Tets *tets, size_t index)
{
    Tet      tet = tets->list.items[index], first = tet, second = tet;
    uint32_t middle[3];
    find_middle(tets, tet.points[0], tet.points[tet.tag], middle);
    uint32_t point                                = take_point(tets, middle);
    tets->points.items[tet.points[0]].split       = tets->closures;
    tets->points.items[tet.points[tet.tag]].split = tets->closures;
    first.points[tet.tag]                         = point;
    second.points[tet.tag]                        = point;
    for (int k = 0; k < tet.tag; k++)
        second.points[k] = tet.points[k + 1];
    first.tag      = tet.tag > 1 ? (uint8_t)(tet.tag - 1) : 3;
    second.tag     = first.tag;
    first.hopeless = second.hopeless = tet.hopeless && tet.state == TET_REFUTED && first.tag < 3;
    first.state = second.state = tet.state == TET_EMPTY ? TET_EMPTY
                                 : first.hopeless       ? TET_REFUTED
                                                        : TET_NEW;
    first.replaced = second.replaced = tet.replaced || tet.triangle_count > 0;
    first.triangle_count = second.triangle_count = 0;
    first.width                                  = find_width(tets, &first);
    second.width                                 = find_width(tets, &second);
    uint32_t added                               = (uint32_t)tets->list.count;
    queue_around(tets, tet.points[0], tet.points[tet.tag], (uint32_t)index, added);
    replace_tet(tets, index, first);
    add_tet(tets, second);
    queue_tet(tets, added);
    link_point(tets, point, (uint32_t)index);
    for (int k = 0; k < 4; k++)
        if (second.points[k] != tet.points[tet.tag])
            link_point(tets, second.points[k], added);
}

/* Tells whether a neighbour has bisected an edge since the last closure. */
static bool has_hanging_point(const Tets *tets, const Tet *tet)
{
    uint32_t middle[3];
    bool     split[4];
    for (int i = 0; i < 4; i++)
        split[i] = tets->points.items[tet->points[i]].split == tets->closures;
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++)
            if (split[i] && split[j] && find_middle(tets, tet->points[i], tet->points[j], middle) &&
                numbering_find(&tets->numbers, point_key(middle)) != NO_NUMBER)
                return true;
    return false;
}

/* Bisects what waits in the order of the list, again and again, so that numbers are the same as if
   all were tested. */
void tets_close(Tets *tets)
{
    bool any = true;
    while (any) {
        any = false;
        for (size_t i = first_waiting(tets, 0); i < 64 * tets->waiting.count;
             i        = first_waiting(tets, i + 1)) {
            any = true;
            while (has_hanging_point(tets, &tets->list.items[i]))
                tets_bisect(tets, i);
            tets->waiting.items[i / 64] &= ~((uint64_t)1 << i % 64);
        }
    }
    tets->closures++;
}

void tets_position(const Tets *tets, uint32_t point, double position[3])
{
    for (int k = 0; k < 3; k++)
        position[k] = tets->origin[k] + tets->step * tets->points.items[point].at[k];
}

void tets_corners(const Tets *tets, const Tet *tet, double corners[4][3])
{
    for (int i = 0; i < 4; i++)
        tets_position(tets, tet->points[i], corners[i]);
}

double tets_longest_edge(const Tets *tets, const Tet *tet)
{
    double corners[4][3], longest = 0;
    tets_corners(tets, tet, corners);
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++)
            longest = max2(longest, distance3(corners[i], corners[j]));
    return longest;
}

double corners_ball(const double corners[4][3], double center[3])
{
    double radius = 0;
    for (int k = 0; k < 3; k++)
        center[k] = 0.25 * (corners[0][k] + corners[1][k] + corners[2][k] + corners[3][k]);
    for (int i = 0; i < 4; i++)
        radius = max2(radius, distance3(center, corners[i]));
    return radius;
}

int bisect_corners(const double corners[4][3], int tag, double first[4][3], double second[4][3])
{
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (corners[0][k] + corners[tag][k]);
    memcpy(first, corners, 4 * sizeof *first);
    memcpy(second, corners, 4 * sizeof *second);
    memcpy(second, corners + 1, (size_t)tag * sizeof *second);
    memcpy(first[tag], middle, sizeof middle);
    memcpy(second[tag], middle, sizeof middle);
    return tag > 1 ? tag - 1 : 3;
}
