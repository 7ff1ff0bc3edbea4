/* flat_edges.c: joins the segments of all boxes to edges of faces, and fills these with
   triangles. */
#include "mesh/flat/flat_edges.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/minmax.h"
#include "compiler/base/vec.h"
#include "mesh/flat/flat_separate.h"
#include "mesh/flat/flat_touches.h"

/* Parts of the size, above rounding: what is one point on a line, and what is one point where
   planes meet. */
static const double SAME = 1e-13, TOUCHING = 1e-10;

typedef struct Edge {
    uint32_t face, line, from, to; /* the line is the other plane, as of a segment */
    double   begin, end;           /* on the line; it may go backwards */
    double   direction[3];
    bool     walked;
} Edge;

/* A vertex on the line of two planes. */
typedef struct Stop {
    uint32_t low, high; /* the planes */
    double   at;
    uint32_t vertex;
} Stop;

typedef struct Finishing {
    FlatFaces    *faces;
    FlatVertices *vertices;
    Numbering     numbers; /* of vertices, by their planes */
    struct {
        Edge  *items;
        size_t count, capacity;
    } edges;
    uint32_t *one; /* of each vertex, another one at the same point; itself */
} Finishing;

/* ---- edges ---- */

static int compare_segments(const void *first, const void *second)
{
    const FlatSegment *a = first, *b = second;
    if (a->face != b->face)
        return a->face < b->face ? -1 : 1;
    if (a->line != b->line)
        return a->line < b->line ? -1 : 1;
    return (a->begin > b->begin) - (a->begin < b->begin);
}

/* An end of a segment: how often the line is covered behind it, less how often before. */
typedef struct Event {
    double   at;
    int      change;
    uint32_t plane;
} Event;

/* Returns the sine of the angle between two planes: the less it is, the less is known of where
   their line is. */
static double sine_between(const FlatFaces *faces, uint32_t a, uint32_t b)
{
    double product[3];
    cross3(faces->planes.items[a].exact.normal, faces->planes.items[b].exact.normal, product);
    return max2(length3(product), 1e-6);
}

/* Returns the distance at which two ends on the line of two planes are one. */
static double same_on(const FlatFaces *faces, uint32_t a, uint32_t b)
{
    return SAME * faces->size / sine_between(faces, a, b);
}

static int compare_events(const void *first, const void *second)
{
    const Event *a = first, *b = second;
    return (a->at > b->at) - (a->at < b->at);
}

static bool meeting_point(const HalfSpace *const planes[3], const double offsets[3],
                          double point[3])
{
    double products[3][3];
    for (int i = 0; i < 3; i++)
        cross3(planes[(i + 1) % 3]->normal, planes[(i + 2) % 3]->normal, products[i]);
    double volume = dot3(planes[0]->normal, products[0]);
    if (fabs(volume) < 1e-12)
        return false;
    for (int k = 0; k < 3; k++)
        point[k] = -(offsets[0] * products[0][k] + offsets[1] * products[1][k] +
                     offsets[2] * products[2][k]) /
                   volume;
    return true;
}

/* Returns the vertex of three planes, or NO_NUMBER; it is where the moved planes meet if the exact
   ones are near to parallel. */
static uint32_t find_vertex(Finishing *f, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t fresh  = (uint32_t)f->vertices->count;
    uint32_t number = numbering_take(&f->numbers, face_key(a, b, c), fresh);
    if (number != fresh)
        return number;
    const uint32_t   numbers[3] = {a, b, c};
    const HalfSpace *planes[3];
    double           offsets[3], moved[3], at[3] = {0, 0, 0}, near[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        planes[i]  = &f->faces->planes.items[numbers[i]].exact;
        offsets[i] = planes[i]->offset;
        moved[i]   = f->faces->planes.items[numbers[i]].moved;
    }
    if (!meeting_point(planes, moved, near))
        return NO_NUMBER;
    meeting_point(planes, offsets, at);
    array_reserve_large(f->faces->arena, f->vertices);
    bool close = distance3(at, near) < 1e-2 * f->faces->size;
    memcpy(f->vertices->items[f->vertices->count++], close ? at : near, sizeof at);
    return number;
}

/* A walk along a line: the vertex before, and how often the line is covered behind it. */
typedef struct Walk {
    const FlatSegment *of;
    uint32_t           last;
    double             last_at;
    int                covered;
} Walk;

static bool walk_on(Finishing *f, Walk *walk, const Event *event, int change)
{
    uint32_t plane = walk->of->face / 2;
    if (change == 0)
        return true;
    uint32_t vertex = event->plane == FLAT_WALL
                          ? NO_NUMBER
                          : find_vertex(f, plane, walk->of->line, event->plane);
    if (vertex == NO_NUMBER)
        return false;
    if (walk->covered != 0) {
        bool along = walk->covered > 0;
        Edge edge  = {.face  = walk->of->face,
                      .line  = walk->of->line,
                      .from  = along ? walk->last : vertex,
                      .to    = along ? vertex : walk->last,
                      .begin = along ? walk->last_at : event->at,
                      .end   = along ? event->at : walk->last_at};
        flat_line_direction(f->faces, plane, walk->of->line, edge.direction);
        for (int k = 0; k < 3; k++)
            edge.direction[k] *= walk->covered;
        array_push_large(f->faces->arena, &f->edges, edge);
    }
    walk->covered += change;
    walk->last    = vertex;
    walk->last_at = event->at;
    return walk->covered >= -1 && walk->covered <= 1;
}

/* Finds the edges of one face on one line, from the ends of segments in order.  Ends at one point
   cancel out where a box ends; where two planes end the line there it has a short edge. */
static bool find_edges_between(Finishing *f, const FlatSegment *of, Event *events, size_t count)
{
    Walk   walk = {of, NO_NUMBER, 0, 0};
    double same = same_on(f->faces, of->face / 2, of->line);
    for (size_t i = 0, next; i < count; i = next) {
        int at_walls = 0;
        for (next = i; next < count && events[next].at - events[i].at < same; next++)
            at_walls += events[next].plane == FLAT_WALL ? events[next].change : 0;
        for (size_t k = i; k < next; k++) {
            int change = at_walls;
            if (events[k].plane == FLAT_WALL)
                continue;
            for (size_t other = next; other-- > k;)
                if (events[other].plane == events[k].plane) {
                    change += events[other].change;
                    events[other].change = 0;
                }
            at_walls = 0;
            if (!walk_on(f, &walk, &events[k], change))
                return false;
        }
        if (at_walls != 0)
            return false;
    }
    return walk.covered == 0;
}

static bool find_edges(Finishing *f)
{
    FlatSegment *segments = f->faces->segments.items;
    size_t       count    = f->faces->segments.count;
    if (count > 0)
        qsort(segments, count, sizeof *segments, compare_segments);
    Event *events = arena_new_array(f->faces->arena, Event, 2 * count + 1);
    for (size_t i = 0, next; i < count; i = next) {
        size_t found = 0;
        for (next = i; next < count && segments[next].face == segments[i].face &&
                       segments[next].line == segments[i].line;
             next++) {
            const FlatSegment *s = &segments[next];
            events[found++]      = (Event){s->begin, s->direction, s->ends[0]};
            events[found++]      = (Event){s->end, -s->direction, s->ends[1]};
        }
        qsort(events, found, sizeof *events, compare_events);
        if (!find_edges_between(f, &segments[i], events, found))
            return false;
    }
    return true;
}

/* ---- edges that others end on ---- */

static int compare_stops(const void *first, const void *second)
{
    const Stop *a = first, *b = second;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (a->at > b->at) - (a->at < b->at);
}

static Stop stop_of(const Edge *edge, bool end)
{
    uint32_t plane = edge->face / 2;
    return (Stop){plane < edge->line ? plane : edge->line, plane < edge->line ? edge->line : plane,
                  end ? edge->end : edge->begin, end ? edge->to : edge->from};
}

static size_t first_behind(const Stop *stops, size_t count, const Stop *stop)
{
    size_t low = 0;
    for (size_t high = count; low < high;) {
        size_t middle = (low + high) / 2;
        if (compare_stops(&stops[middle], stop) <= 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Cuts an edge at a vertex; the rest becomes an edge of its own, whose number is returned. */
static size_t cut_edge(Finishing *f, size_t number, const Stop *stop, bool along)
{
    Edge *edge = &f->edges.items[number], rest = *edge;
    if (along) {
        rest.from = edge->to = stop->vertex;
        rest.begin = edge->end = stop->at;
    } else {
        rest.to = edge->from = stop->vertex;
        rest.end = edge->begin = stop->at;
    }
    array_push_large(f->faces->arena, &f->edges, rest);
    return f->edges.count - 1;
}

/* Joins vertices at one point, and finds those on edges that do not end there. */
static void join_touching(Finishing *f, FlatTouches *touches)
{
    Arena    *arena    = f->faces->arena;
    double    near     = TOUCHING * f->faces->size;
    size_t    count    = f->edges.count;
    uint32_t *first    = arena_new_array(arena, uint32_t, f->vertices->count + 1);
    uint32_t(*ends)[2] = (uint32_t(*)[2])arena_new_array(arena, uint32_t, 2 * count + 1);
    flat_join_vertices(f->vertices, near, first, arena);
    for (size_t i = 0; i < count; i++) {
        Edge *edge = &f->edges.items[i];
        edge->from = ends[i][0] = first[edge->from];
        edge->to = ends[i][1] = first[edge->to];
    }
    flat_find_touches(f->vertices, (const uint32_t(*)[2])ends, count, first, near, touches, arena);
}

static Stop stop_at_touch(const Finishing *f, const FlatTouch *touch)
{
    Stop   stop = stop_of(&f->edges.items[touch->edge], false);
    double along[3];
    flat_line_direction(f->faces, stop.low, stop.high, along);
    stop.at     = dot3(along, f->vertices->items[touch->vertex]);
    stop.vertex = touch->vertex;
    return stop;
}

/*
 * Cuts each edge at the vertices of all others on its line, and at those that touch it.  An edge of
 * one face may continue where the faces at its other side change: where a floor ends that is level
 * with the underside of what is beside it, the wall below both has no corner.
 */
static void cut_edges(Finishing *f, const FlatTouches *touches)
{
    size_t count = f->edges.count, all = 2 * count + touches->count;
    Stop  *stops = arena_new_array(f->faces->arena, Stop, all + 1);
    for (size_t i = 0; i < 2 * count; i++)
        stops[i] = stop_of(&f->edges.items[i / 2], i % 2);
    for (size_t i = 0; i < touches->count; i++)
        stops[2 * count + i] = stop_at_touch(f, &touches->items[i]);
    if (all > 0)
        qsort(stops, all, sizeof *stops, compare_stops);
    for (size_t i = 0; i < count; i++) {
        Edge   edge  = f->edges.items[i];
        bool   along = edge.begin < edge.end;
        Stop   first = stop_of(&edge, !along), last = stop_of(&edge, along);
        double same   = same_on(f->faces, first.low, first.high);
        size_t number = i;
        for (size_t k = first_behind(stops, all, &first);
             k < all && compare_stops(&stops[k], &last) < 0; k++)
            if (stops[k].at - first.at > same && last.at - stops[k].at > same) {
                number = cut_edge(f, number, &stops[k], along);
                first  = stops[k];
            }
    }
}

/* ---- vertices at the same point ---- */

static uint32_t one_of(Finishing *f, uint32_t vertex)
{
    while (f->one[vertex] != vertex)
        vertex = f->one[vertex] = f->one[f->one[vertex]];
    return vertex;
}

static void join_vertices(Finishing *f)
{
    f->one = arena_new_array(f->faces->arena, uint32_t, f->vertices->count + 1);
    for (uint32_t i = 0; i < f->vertices->count; i++)
        f->one[i] = i;
    for (size_t i = 0; i < f->edges.count; i++) {
        const Edge *edge     = &f->edges.items[i];
        const double(*at)[3] = (const double(*)[3])f->vertices->items;
        double length        = distance3(at[edge->from], at[edge->to]);
        if (length < f->faces->shortest) {
            uint32_t a = one_of(f, edge->from), b = one_of(f, edge->to);
            f->one[a < b ? b : a] = a < b ? a : b;
            f->faces->joined      = fmax(f->faces->joined, length);
        }
    }
}

/* ---- faces ---- */

static int compare_edges(const void *first, const void *second)
{
    const Edge *a = first, *b = second;
    if (a->face != b->face)
        return a->face < b->face ? -1 : 1;
    return (a->from > b->from) - (a->from < b->from);
}

/* Returns the angle by which one direction turns left into the next; a turn back is a left turn. */
static double turn_to_left(const double direction[3], const double next[3], const double normal[3])
{
    static const double NONE = 1e-9;
    double              product[3];
    cross3(direction, next, product);
    double left = dot3(product, normal), on = dot3(direction, next);
    return on < 0 && fabs(left) < NONE ? M_PI : real_atan2(left, on);
}

/* Returns the edge that follows: at a corner that parts of a face share, the one most to the
   left. */
static Edge *edge_behind(Edge *edges, size_t count, const Edge *edge, const double normal[3])
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (edges[middle].from < edge->to)
            low = middle + 1;
        else
            high = middle;
    }
    Edge  *found = NULL;
    double most  = -HUGE_VAL;
    for (; low < count && edges[low].from == edge->to; low++) {
        double turn = turn_to_left(edge->direction, edges[low].direction, normal);
        if (!edges[low].walked && turn > most) {
            found = &edges[low];
            most  = turn;
        }
    }
    return found;
}

/* Adds a loop without repeated vertices, and without edges that go back at once. */
static void add_loop(Finishing *f, const uint32_t *walked, size_t count, Loops *loops)
{
    Arena *arena = f->faces->arena;
    size_t begin = loops->vertices.count;
    for (size_t i = 0; i < count; i++) {
        uint32_t  vertex = one_of(f, walked[i]);
        size_t    own    = loops->vertices.count - begin;
        uint32_t *last   = loops->vertices.items + loops->vertices.count;
        if (own > 0 && last[-1] == vertex)
            continue;
        if (own > 1 && last[-2] == vertex)
            loops->vertices.count--;
        else
            array_push(arena, &loops->vertices, vertex);
    }
    for (;;) {
        uint32_t *items = loops->vertices.items;
        size_t    last  = loops->vertices.count;
        if (last - begin > 1 && items[last - 1] == items[begin])
            loops->vertices.count--;
        else if (last - begin > 2 && items[last - 1] == items[begin + 1]) {
            memmove(&items[begin], &items[begin + 1], (last - begin - 1) * sizeof *items);
            loops->vertices.count -= 2;
        } else if (last - begin > 2 && items[last - 2] == items[begin])
            loops->vertices.count -= 2;
        else
            break;
    }
    if (loops->vertices.count - begin < 3)
        loops->vertices.count = begin;
    else
        array_push(arena, &loops->ends, loops->vertices.count);
}

static bool find_loops(Finishing *f, Edge *edges, size_t count, const double normal[3],
                       Loops *loops)
{
    uint32_t *walked = arena_new_array(f->faces->arena, uint32_t, count);
    for (size_t i = 0; i < count; i++)
        edges[i].walked = edges[i].from == edges[i].to;
    for (size_t i = 0; i < count; i++) {
        size_t steps = 0;
        for (Edge *edge = &edges[i]; !edge->walked;) {
            edge->walked    = true;
            walked[steps++] = edge->from;
            if (edge->to == edges[i].from)
                break;
            edge = edge_behind(edges, count, edge, normal);
            if (!edge)
                return false;
        }
        if (steps > 0)
            add_loop(f, walked, steps, loops);
    }
    return true;
}

static bool cut_faces(Finishing *f, Triangles *triangles)
{
    Edge  *edges = f->edges.items;
    size_t count = f->edges.count;
    if (count > 0)
        qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0, next; i < count; i = next) {
        const FlatPlane *plane = &f->faces->planes.items[edges[i].face / 2];
        Loops            loops = {0};
        double           normal[3];
        for (int k = 0; k < 3; k++)
            normal[k] = edges[i].face % 2 ? -plane->exact.normal[k] : plane->exact.normal[k];
        for (next = i; next < count && edges[next].face == edges[i].face; next++)
            ;
        if (!find_loops(f, &edges[i], next - i, normal, &loops) ||
            !polygons_cut((const double(*)[3])f->vertices->items, normal, &loops,
                          f->faces->shortest, triangles, f->faces->arena))
            return false;
    }
    return true;
}

/* ---- entry point ---- */

/* Drops vertices that no triangle has. */
static void number_vertices(Finishing *f, Triangles *triangles)
{
    uint32_t *numbers = arena_new_array(f->faces->arena, uint32_t, f->vertices->count + 1);
    double(*at)[3]    = f->vertices->items;
    uint32_t used     = 0;
    for (size_t i = 0; i < 3 * triangles->count; i++)
        numbers[triangles->items[i / 3][i % 3]] = 1;
    for (size_t i = 0; i < f->vertices->count; i++)
        if (numbers[i]) {
            memcpy(at[used], at[i], sizeof at[used]);
            numbers[i] = used++;
        }
    f->vertices->count = used;
    for (size_t i = 0; i < 3 * triangles->count; i++)
        triangles->items[i / 3][i % 3] = numbers[triangles->items[i / 3][i % 3]];
}

bool flat_faces_finish(FlatFaces *faces, FlatVertices *vertices, Triangles *triangles)
{
    Finishing   f = {.faces = faces, .vertices = vertices, .numbers = {.arena = faces->arena}};
    FlatTouches touches = {0};
    if (!find_edges(&f))
        return false;
    join_touching(&f, &touches);
    cut_edges(&f, &touches);
    join_vertices(&f);
    if (!cut_faces(&f, triangles))
        return false;
    number_vertices(&f, triangles);
    return flat_separate(vertices, triangles, faces->arena);
}
