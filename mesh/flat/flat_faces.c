/* flat_faces.c: cuts planes into polygons in boxes, and finds the segments of edges between
   them. */
#include "mesh/flat/flat_faces.h"

#include <string.h>

#include "compiler/base/vec.h"

/* The least distance of a corner to a plane, as a part of the size. */
static const double NARROW = 1e-14;

/* ---- planes ---- */

/* Returns a pseudorandom number from -1 to 1 for a plane, another one at each attempt. */
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

/* Returns a number that opposite half-spaces of a plane share, and different planes seldom. */
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
    FlatPlane fresh  = {*plane,
                        plane->offset + FLAT_MOVED * faces->size * jitter(number, faces->attempt),
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

/* A polygon in positive order around the normal of its plane; labels[i] is the plane at the edge
   from corner i. */
typedef struct Polygon {
    int      count;
    double   at[MAX_CORNERS][3];
    uint32_t labels[MAX_CORNERS];
} Polygon;

enum { MAX_CELL_NODES = 16 * MAX_FLAT_NODES };

/* A set of half-spaces. */
typedef struct HalfSpaces {
    uint64_t bits[MAX_FLATS / 64];
} HalfSpaces;

typedef struct Cell {
    FlatFaces *faces;
    Box        box;
    uint32_t   planes[MAX_FLATS]; /* of half-spaces */
    int        signs[MAX_FLATS];
    int        own;                   /* the half-space that is cut */
    FlatNode   nodes[MAX_CELL_NODES]; /* those of the pieces, and what is left of them */
    HalfSpaces seen[MAX_CELL_NODES];  /* of each node, those that it depends on */
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

/* Finds the part of a polygon where sign times value is below 0, whose new edge has the label. */
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

/* Makes a polygon of the whole plane in the box. */
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
        add_corner(polygon, at, FLAT_WALL);
    }
    for (int side = 0; side < 6; side++) {
        int k = side / 2;
        for (int i = 0; i < polygon->count; i++)
            values[i] = side % 2 ? polygon->at[i][k] - cell->box.axis[k].high
                                 : cell->box.axis[k].low - polygon->at[i][k];
        cut_polygon(cell, polygon, values, 1, FLAT_WALL, &part);
        *polygon = part;
    }
}

/* ---- edges ---- */

void flat_line_direction(const FlatFaces *faces, uint32_t a, uint32_t b, double along[3])
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    cross3(faces->planes.items[low].exact.normal, faces->planes.items[high].exact.normal, along);
    normalize3(along);
}

/* Adds the edges of a part of a face; `outward` is 1 if the solid is below the plane, -1 if
   above. */
static void add_part(Cell *cell, const Polygon *polygon, int outward)
{
    FlatFaces *faces = cell->faces;
    uint32_t   plane = cell->planes[cell->own];
    for (int i = 0; i < polygon->count; i++) {
        int         next   = (i + 1) % polygon->count;
        uint32_t    before = polygon->labels[(i + polygon->count - 1) % polygon->count];
        FlatSegment s      = {
                 .face = 2 * plane + (outward < 0), .line = polygon->labels[i], .direction = outward};
        double along[3];
        if (s.line == FLAT_WALL)
            continue;
        flat_line_direction(faces, plane, s.line, along);
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
            s.direction    = -s.direction;
        }
        array_push_large(faces->arena, &faces->segments, s);
    }
}

/* Finds the half-spaces that a node depends on; those of its parts are known. */
static void find_seen(Cell *cell, int number)
{
    const FlatNode *node = &cell->nodes[number];
    HalfSpaces     *seen = &cell->seen[number];
    if (node->kind == FLAT_HALF_SPACE) {
        memset(seen, 0, sizeof *seen);
        seen->bits[node->first / 64] = (uint64_t)1 << node->first % 64;
    } else
        for (int i = 0; i < MAX_FLATS / 64; i++)
            seen->bits[i] = cell->seen[node->first].bits[i] | cell->seen[node->second].bits[i];
}

/* Simplifies a solid on one side of a half-space: 1 is outside, -1 inside. */
static int rest_of(Cell *cell, int solid, int half_space, int side)
{
    if (solid < 0 || !(cell->seen[solid].bits[half_space / 64] >> half_space % 64 & 1))
        return solid;
    FlatNode node = cell->nodes[solid];
    if (node.kind == FLAT_HALF_SPACE)
        return node.second * side < 0 ? FLAT_ALL : FLAT_NONE;
    int decides = node.kind == FLAT_BOTH ? FLAT_NONE : FLAT_ALL;
    int second  = rest_of(cell, node.second, half_space, side);
    if (second == decides)
        return second;
    int first = rest_of(cell, node.first, half_space, side);
    if (first == decides || second < 0)
        return first;
    if (first < 0)
        return second;
    if (cell->node_count == MAX_CELL_NODES) {
        cell->failed = true;
        return solid;
    }
    cell->nodes[cell->node_count] = (FlatNode){node.kind, first, second};
    find_seen(cell, cell->node_count);
    return cell->node_count++;
}

/* Returns a half-space that a solid depends on. */
static int half_space_of(const Cell *cell, int solid)
{
    while (cell->nodes[solid].kind != FLAT_HALF_SPACE)
        solid = cell->nodes[solid].first;
    return cell->nodes[solid].first;
}

/* Cuts a polygon by all half-spaces that decide between `within` and `beyond`, the rests of the
   solid below and above its plane, and adds those parts that are faces. */
static void cut_part(Cell *cell, const Polygon *polygon, int within, int beyond)
{
    if (within == beyond)
        return;
    if (within < 0 && beyond < 0) {
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
        int     side = sign * cell->signs[unknown];
        cut_polygon(cell, polygon, values, -sign, cell->planes[unknown], &part);
        if (part.count < 3 || cell->failed)
            continue;
        cut_part(cell, &part, rest_of(cell, within, unknown, side),
                 rest_of(cell, beyond, unknown, side));
        cell->node_count = nodes;
    }
}

bool flat_faces_add(FlatFaces *faces, Box box, const FlatPieces *pieces)
{
    Cell   cell;
    size_t before = faces->segments.count;
    if (pieces->root < 0)
        return true;
    cell.faces  = faces;
    cell.box    = box;
    cell.failed = false;
    memcpy(cell.nodes, pieces->nodes, pieces->node_count * sizeof *cell.nodes);
    for (size_t i = 0; i < pieces->node_count; i++)
        find_seen(&cell, (int)i);
    for (size_t i = 0; i < pieces->count; i++)
        cell.planes[i] = find_plane(faces, &pieces->list[i], &cell.signs[i]);
    for (size_t i = 0; i < pieces->count && !cell.failed; i++) {
        Polygon polygon;
        cell.own        = (int)i;
        cell.node_count = (int)pieces->node_count;
        int within      = rest_of(&cell, pieces->root, (int)i, -1);
        int beyond      = rest_of(&cell, pieces->root, (int)i, 1);
        begin_polygon(&cell, &faces->planes.items[cell.planes[i]], &polygon);
        if (polygon.count >= 3)
            cut_part(&cell, &polygon, within, beyond);
    }
    if (cell.failed)
        faces->segments.count = before;
    return !cell.failed;
}
