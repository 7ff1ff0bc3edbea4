/* flat_faces.c: polygons of planes in boxes, and the edges between them. */
#include "mesh/flat/flat_faces.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/minmax.h"
#include "compiler/base/vec.h"
#include "mesh/flat/flat_separate.h"
#include "mesh/flat/flat_touches.h"

#define WALL UINT32_MAX

/* Parts of the size: by how much planes are moved at most; how near to a plane a corner must not be; what is one place on a
   line; and what is one place where planes meet.  The latter are above rounding. */
static const double MOVE = 1e-7, NARROW = 1e-14, SAME = 1e-13, TOUCHING = 1e-10;

/* ---- planes ---- */

/* A number from -1 to 1 for each plane, another one at each attempt. */
static double jitter(uint32_t number, uint32_t attempt)
{
    uint32_t h = (number + 1) * 2654435761u + attempt * 3266489917u;
    h ^= h >> 15;
    h *= 2246822519u;
    h ^= h >> 13;
    h *= 3266489917u;
    h ^= h >> 16;
    return (double)h / 2147483648.0 - 1;
}

/* A number that planes have in common with themselves turned over, and other ones seldom. */
static double plane_mark(const FlatFaces *faces, const HalfSpace *plane)
{
    static const double MIXED[3] = {0.7548776662, 0.5698402910, 0.3819660113};
    return fabs(dot3(plane->normal, MIXED) + plane->offset / faces->size);
}

static bool is_plane(const FlatFaces *faces, uint32_t number, const HalfSpace *plane, int *sign)
{
    static const double EQUAL = 1e-9;
    const HalfSpace    *own   = &faces->planes.items[number].exact;
    double              off[3];
    *sign = dot3(plane->normal, own->normal) < 0 ? -1 : 1;
    add_scaled3(off, plane->normal, -*sign, own->normal);
    return largest3(off) < EQUAL && fabs(plane->offset - *sign * own->offset) < EQUAL * faces->size;
}

static uint32_t find_plane(FlatFaces *faces, const HalfSpace *plane, int *sign)
{
    static const double WIDTH = 1e-7; /* far above what is equal */
    int64_t             slot  = (int64_t)floor(plane_mark(faces, plane) / WIDTH);
    faces->marks.arena        = faces->arena;
    for (int64_t i = slot - 1; i <= slot + 1; i++)
        for (uint32_t at         = numbering_find(&faces->marks, (NumberKey){(uint64_t)i, 0});
             at != NO_NUMBER; at = faces->planes.items[at].next)
            if (is_plane(faces, at, plane, sign))
                return at;
    uint32_t  number = (uint32_t)faces->planes.count;
    uint32_t  first  = numbering_take(&faces->marks, (NumberKey){(uint64_t)slot, 0}, number);
    FlatPlane fresh  = {*plane, plane->offset + MOVE * faces->size * jitter(number, faces->attempt),
                        NO_NUMBER};
    array_push_large(faces->arena, &faces->planes, fresh);
    if (first != number) {
        faces->planes.items[number].next = faces->planes.items[first].next;
        faces->planes.items[first].next  = number;
    }
    *sign = 1;
    return number;
}

static double above(const FlatPlane *plane, const double point[3])
{
    return dot3(plane->exact.normal, point) + plane->moved;
}

/* ---- polygons ---- */

enum { MAX_CORNERS = 96 };

/* In the positive order around the normal of its plane; labels[i] is the plane at the edge from corner i. */
typedef struct Polygon {
    int      count;
    double   at[MAX_CORNERS][3];
    uint32_t labels[MAX_CORNERS];
} Polygon;

enum { MAX_CELL_NODES = 16 * MAX_FLAT_NODES };

typedef struct Cell {
    FlatFaces *faces;
    Box        box;
    uint32_t   planes[MAX_FLATS]; /* of half-spaces */
    int        signs[MAX_FLATS];
    int        own;                   /* the half-space that is cut */
    FlatNode   nodes[MAX_CELL_NODES]; /* those of the pieces, and what is left of them */
    int        node_count;
    bool       failed;
} Cell;

static void add_corner(Polygon *polygon, const double at[3], uint32_t label)
{
    if (polygon->count < MAX_CORNERS) {
        memcpy(polygon->at[polygon->count], at, sizeof polygon->at[0]);
        polygon->labels[polygon->count] = label;
    }
    polygon->count++;
}

/* The part where values are below 0, whose new edge has the label. */
static void cut_polygon(Cell *cell, const Polygon *polygon, const double *values, double sign,
                        uint32_t label, Polygon *part)
{
    part->count = 0;
    for (int i = 0; i < polygon->count; i++) {
        int    next = (i + 1) % polygon->count;
        double a = sign * values[i], b = sign * values[next], between[3], along[3];
        bool   inside = a < 0, stays = b < 0;
        if (inside)
            add_corner(part, polygon->at[i], polygon->labels[i]);
        if (inside != stays) {
            add_scaled3(along, polygon->at[next], -1, polygon->at[i]);
            add_scaled3(between, polygon->at[i], a / (a - b), along);
            add_corner(part, between, inside ? label : polygon->labels[i]);
        }
    }
    cell->failed |= part->count > MAX_CORNERS;
}

/* The whole plane in the box. */
static void begin_polygon(Cell *cell, const FlatPlane *plane, Polygon *polygon)
{
    const double *normal = plane->exact.normal;
    double        center[3], axes[2][3], at[3], values[MAX_CORNERS], reach = 0;
    int           least = 0;
    Polygon       part;
    for (int k = 0; k < 3; k++) {
        center[k] = 0.5 * (cell->box.axis[k].low + cell->box.axis[k].high);
        reach += cell->box.axis[k].high - cell->box.axis[k].low;
        least = fabs(normal[k]) < fabs(normal[least]) ? k : least;
    }
    double unit[3] = {least == 0, least == 1, least == 2};
    cross3(normal, unit, axes[0]);
    normalize3(axes[0]);
    cross3(normal, axes[0], axes[1]);
    add_scaled3(center, center, -above(plane, center), normal);
    polygon->count = 0;
    for (int i = 0; i < 4; i++) {
        add_scaled3(at, center, i == 0 || i == 3 ? -reach : reach, axes[0]);
        add_scaled3(at, at, i < 2 ? -reach : reach, axes[1]);
        add_corner(polygon, at, WALL);
    }
    for (int side = 0; side < 6; side++) {
        int k = side / 2;
        for (int i = 0; i < polygon->count; i++)
            values[i] = side % 2 ? polygon->at[i][k] - cell->box.axis[k].high
                                 : cell->box.axis[k].low - polygon->at[i][k];
        cut_polygon(cell, polygon, values, 1, WALL, &part);
        *polygon = part;
    }
}

/* ---- edges ---- */

static void line_direction(const FlatFaces *faces, uint32_t a, uint32_t b, double along[3])
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    cross3(faces->planes.items[low].exact.normal, faces->planes.items[high].exact.normal, along);
    normalize3(along);
}

/* `outward`: the solid is below the plane, 1, or above it, -1. */
static void add_part(Cell *cell, const Polygon *polygon, int outward)
{
    FlatFaces *faces = cell->faces;
    uint32_t   plane = cell->planes[cell->own];
    for (int i = 0; i < polygon->count; i++) {
        int         next   = (i + 1) % polygon->count;
        uint32_t    before = polygon->labels[(i + polygon->count - 1) % polygon->count];
        FlatSegment s      = {
                 .face = 2 * plane + (outward < 0), .line = polygon->labels[i], .way = outward};
        double along[3];
        if (s.line == WALL)
            continue;
        line_direction(faces, plane, s.line, along);
        s.begin   = dot3(along, polygon->at[i]);
        s.end     = dot3(along, polygon->at[next]);
        s.ends[0] = before;
        s.ends[1] = polygon->labels[next];
        if (s.begin > s.end) {
            double   begin = s.begin;
            uint32_t end   = s.ends[0];
            s.begin        = s.end;
            s.end          = begin;
            s.ends[0]      = s.ends[1];
            s.ends[1]      = end;
            s.way          = -s.way;
        }
        array_push_large(faces->arena, &faces->segments, s);
    }
}

/* What is left to be known of a solid where the sides of some half-spaces are: 1, -1, or 0. */
static int rest_of(Cell *cell, int solid, const signed char *sides)
{
    if (solid < 0)
        return solid;
    FlatNode node = cell->nodes[solid];
    if (node.kind == FLAT_HALF_SPACE) {
        int side = node.second * sides[node.first];
        return side == 0 ? solid : side < 0 ? FLAT_ALL : FLAT_NONE;
    }
    int decides = node.kind == FLAT_BOTH ? FLAT_NONE : FLAT_ALL;
    int second  = rest_of(cell, node.second, sides);
    if (second == decides)
        return second;
    int first = rest_of(cell, node.first, sides);
    if (first == decides || second < 0)
        return first;
    if (first < 0 || (first == node.first && second == node.second))
        return first < 0 ? second : solid;
    if (cell->node_count == MAX_CELL_NODES) {
        cell->failed = true;
        return solid;
    }
    cell->nodes[cell->node_count] = (FlatNode){node.kind, first, second};
    return cell->node_count++;
}

/* One of those that a solid depends on. */
static int half_space_of(const Cell *cell, int solid)
{
    while (cell->nodes[solid].kind != FLAT_HALF_SPACE)
        solid = cell->nodes[solid].first;
    return cell->nodes[solid].first;
}

/* `within`, `beyond`: what is left of the solid below the plane that is cut, and above it. */
static void cut_part(Cell *cell, const Polygon *polygon, int within, int beyond, signed char *sides)
{
    if (polygon->count < 3 || cell->failed)
        return;
    if (within < 0 && beyond < 0) {
        if (within != beyond)
            add_part(cell, polygon,
                     within == FLAT_ALL ? cell->signs[cell->own] : -cell->signs[cell->own]);
        return;
    }
    int              unknown = half_space_of(cell, beyond >= 0 ? beyond : within);
    int              nodes   = cell->node_count;
    const FlatPlane *plane   = &cell->faces->planes.items[cell->planes[unknown]];
    double           values[MAX_CORNERS];
    for (int i = 0; i < polygon->count; i++) {
        values[i] = above(plane, polygon->at[i]);
        cell->failed |= fabs(values[i]) < NARROW * cell->faces->size;
    }
    for (int sign = -1; sign <= 1; sign += 2) {
        Polygon part;
        cut_polygon(cell, polygon, values, -sign, cell->planes[unknown], &part);
        sides[unknown] = (signed char)(sign * cell->signs[unknown]);
        cut_part(cell, &part, rest_of(cell, within, sides), rest_of(cell, beyond, sides), sides);
        cell->node_count = nodes;
    }
    sides[unknown] = 0;
}

bool flat_faces_add(FlatFaces *faces, Box box, const FlatPieces *pieces)
{
    signed char sides[MAX_FLATS];
    Cell        cell;
    if (pieces->root < 0)
        return true;
    cell.faces  = faces;
    cell.box    = box;
    cell.failed = false;
    memcpy(cell.nodes, pieces->nodes, pieces->node_count * sizeof *cell.nodes);
    for (size_t i = 0; i < pieces->count; i++)
        cell.planes[i] = find_plane(faces, &pieces->list[i], &cell.signs[i]);
    for (size_t i = 0; i < pieces->count && !cell.failed; i++) {
        Polygon polygon;
        int     solids[2];
        cell.own        = (int)i;
        cell.node_count = (int)pieces->node_count;
        memset(sides, 0, sizeof sides);
        for (int side = 0; side < 2; side++) {
            sides[i]     = (signed char)(2 * side - 1);
            solids[side] = rest_of(&cell, pieces->root, sides);
        }
        sides[i] = 0;
        begin_polygon(&cell, &faces->planes.items[cell.planes[i]], &polygon);
        cut_part(&cell, &polygon, solids[0], solids[1], sides);
    }
    return !cell.failed;
}

/* ---- edges ---- */

typedef struct Edge {
    uint32_t face, line, from, to; /* the line is the other plane, as of a segment */
    double   begin, end;           /* on the line; it may go backwards */
    double   way[3];
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
    uint32_t *one; /* of each vertex, another one at the same place; itself */
} Finishing;

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

/* Returns the sine of the angle between two planes: the less it is, the less is known of where their line is. */
static double sine_between(const FlatFaces *faces, uint32_t a, uint32_t b)
{
    double product[3];
    cross3(faces->planes.items[a].exact.normal, faces->planes.items[b].exact.normal, product);
    return max2(length3(product), 1e-6);
}

/* How near two ends on the line of two planes are one. */
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

/* Where three planes meet; those that were moved tell where it is if the others are near to parallel. */
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
    uint32_t vertex = event->plane == WALL ? NO_NUMBER
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
        line_direction(f->faces, plane, walk->of->line, edge.way);
        for (int k = 0; k < 3; k++)
            edge.way[k] *= walk->covered;
        array_push_large(f->faces->arena, &f->edges, edge);
    }
    walk->covered += change;
    walk->last    = vertex;
    walk->last_at = event->at;
    return walk->covered >= -1 && walk->covered <= 1;
}

/* Edges of one face on one line, from the ends of segments in order.  Ends at one place cancel out where a box ends, and where
   two planes end the line there it has a short edge. */
static bool find_edges_between(Finishing *f, const FlatSegment *of, Event *events, size_t count)
{
    Walk   walk = {of, NO_NUMBER, 0, 0};
    double same = same_on(f->faces, of->face / 2, of->line);
    for (size_t i = 0, next; i < count; i = next) {
        int at_walls = 0;
        for (next = i; next < count && events[next].at - events[i].at < same; next++)
            at_walls += events[next].plane == WALL ? events[next].change : 0;
        for (size_t k = i; k < next; k++) {
            int change = at_walls;
            if (events[k].plane == WALL)
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
            events[found++]      = (Event){s->begin, s->way, s->ends[0]};
            events[found++]      = (Event){s->end, -s->way, s->ends[1]};
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

/* The first part of an edge ends at the vertex; the rest becomes an edge of its own. */
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

/* Vertices at one place become one; finds those on edges that do not end there. */
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
    line_direction(f->faces, stop.low, stop.high, along);
    stop.at     = dot3(along, f->vertices->items[touch->vertex]);
    stop.vertex = touch->vertex;
    return stop;
}

/*
 * An edge of one face may go on where the faces at its other side change: where a floor ends that is level with the underside of
 * what is beside it, the wall below both has no corner.  So each edge gets the vertices of all others on its line, and those
 * that touch it.
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

/* ---- vertices at the same place ---- */

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

/* By how much a way turns to the left into another one; a way back is a turn to the left. */
static double turn_to_left(const double way[3], const double next[3], const double normal[3])
{
    static const double NONE = 1e-9;
    double              product[3];
    cross3(way, next, product);
    double left = dot3(product, normal), on = dot3(way, next);
    return on < 0 && fabs(left) < NONE ? acos(-1) : atan2(left, on);
}

/* The edge that follows: at a corner that parts of a face share, the one most to the left. */
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
        double turn = turn_to_left(edge->way, edges[low].way, normal);
        if (!edges[low].walked && turn > most) {
            found = &edges[low];
            most  = turn;
        }
    }
    return found;
}

/* Without vertices that are at the same place, and without lines that go back at once. */
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

/* ---- all ---- */

/* Leaves out vertices that no triangle has. */
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
