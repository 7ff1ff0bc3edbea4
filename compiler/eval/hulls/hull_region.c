/*
 * hull_region.c: a region that holds parts, and is their convex hull or little more.
 */
#include "compiler/eval/hulls/hull_region.h"

#include <math.h>
#include <stdint.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/eval/hulls/hull.h"
#include "compiler/eval/hulls/hull_normals.h"
#include "compiler/family/family.h"
#include "compiler/graph/build.h"
#include "compiler/lower/lower.h"

/* The numbers of corners that stand for a circle, and for a ball if there are no more of these:
   fewer where more planes would be left than so many. */
typedef struct Sampling {
    int    rim, ball;
    size_t most;
} Sampling;
static const Sampling samplings[] = {{64, 200, 64}, {32, 100, SIZE_MAX}};
enum { MAX_SAMPLED_BALLS = 4 };

/* The number of which the planes of many regions are multiples. */
enum { ALIKE = 4 };

/* Up to which distance unit vectors count as one. */
static const double SAME = 1e-9;

/* Finds the parts in numbers; false: some depend on the frame, or there is a half-space. */
static bool parts_of_extents(Elaboration *e, const Extents *extents, HullParts *parts)
{
    bool known    = extents->half_spaces.count == 0;
    parts->figure = extents->figure;
    for (size_t i = 0; i < extents->count && known; i++) {
        const Extent *extent = &extents->items[i];
        HullPart      part   = {.rim = {0}};
        known = graph_known_components(e->graph, extent->centre, 3, part.ball.centre) &&
                graph_known_components(e->graph, extent->radius, 1, &part.ball.radius) &&
                (extent->rim == NODE_NONE ||
                 graph_known_components(e->graph, extent->rim, 3, part.rim));
        array_push(e->values, parts, part);
    }
    return known;
}

typedef struct Points {
    double *items;
    size_t  count, capacity; /* of numbers */
} Points;

static void add_point(Elaboration *e, Points *points, const double centre[3], double away,
                      const double direction[3])
{
    for (int k = 0; k < 3; k++)
        array_push(e->values, points, centre[k] + away * direction[k]);
}

/* Adds points of a ball on a spiral that turns by the golden angle: they are far from each
   other. */
static void add_ball(Elaboration *e, Points *points, const double centre[3], double radius,
                     int corners)
{
    for (int i = 0; i < corners; i++) {
        const double height = (2 * i + 1.0) / corners - 1, turn = 2.399963229728653 * i;
        const double across       = sqrt(1 - height * height);
        const double direction[3] = {across * real_cos(turn), height, across * real_sin(turn)};
        add_point(e, points, centre, radius, direction);
    }
}

static void add_rim(Elaboration *e, Points *points, const HullPart *part, int corners)
{
    double       along[3] = {part->rim[0], part->rim[1], part->rim[2]}, first[3], second[3];
    const double rim      = length3(part->rim);
    normalize3(along);
    axes_across3(along, first, second);
    for (int i = 0; i < corners; i++) {
        const double turn = 2 * M_PI * i / corners;
        double       direction[3], on[3];
        for (int k = 0; k < 3; k++)
            direction[k] = real_cos(turn) * first[k] + real_sin(turn) * second[k];
        add_point(e, points, part->ball.centre, rim + part->ball.radius, direction);
        if (part->ball.radius > 0) {
            add_scaled3(on, part->ball.centre, rim, direction);
            add_point(e, points, on, part->ball.radius, along);
            add_point(e, points, on, -part->ball.radius, along);
        }
    }
}

/* Adds the directions of faces of the hull, or those of a solid with corners that is nearly the
   hull. */
static void add_hull_faces(Elaboration *e, const HullParts *parts, const Sampling *sampling,
                           Extents *extents)
{
    HullNormals normals = {.arena = e->values};
    Points      points  = {0};
    size_t      balls   = 0;
    for (size_t i = 0; i < parts->count; i++)
        balls += parts->items[i].ball.radius > 0;
    for (size_t i = 0; i < parts->count; i++) {
        const HullPart *part = &parts->items[i];
        if (length3(part->rim) > 0)
            add_rim(e, &points, part, sampling->rim);
        else if (part->ball.radius > 0 && balls <= MAX_SAMPLED_BALLS)
            add_ball(e, &points, part->ball.centre, part->ball.radius, sampling->ball);
        else
            add_point(e, &points, part->ball.centre, 0, part->rim);
    }
    hull_normals(points.items, points.count / 3, &normals);
    for (size_t i = 0; i < normals.count; i++)
        array_push(e->values, &extents->faces,
                   graph_constant(e->graph, TYPE_VEC3, normals.items[i]));
}

/* A region that is made bit by bit, as the greatest of distances with slope 1.  Those that are spare are
   nowhere above 0 in the zone. */
typedef struct Region {
    Elaboration      *e;
    const FilletZone *zone;
    bool              many; /* of one of many pairs, which had best be alike */
    struct {
        Node  *items;
        size_t count, capacity;
    } distances, spare, normals; /* `normals` are those of planes that have been tried */
} Region;

static void add_distance(Region *region, Node distance, bool acts)
{
    if (acts)
        array_push(region->e->values, &region->distances, distance);
    else
        array_push(region->e->values, &region->spare, distance);
}

/* Adds planes so that many pairs have equally many, as far as possible. */
static void add_spare(Region *region)
{
    for (size_t i = 0; i < region->spare.count && region->distances.count % ALIKE; i++)
        array_push(region->e->values, &region->distances, region->spare.items[i]);
    region->spare.count = 0;
}

static Node greatest(Region *region)
{
    Node most = region->distances.items[0];
    for (size_t i = 1; i < region->distances.count; i++)
        most = graph_op2(region->e->graph, OP_max, most, region->distances.items[i]);
    return most;
}

/* Returns dot(along, p), which may be a coordinate without a product. */
static Node height_along(const Region *region, Node along)
{
    Graph     *g     = region->e->graph;
    const Node point = graph_leaf(g, OP_POINT);
    double     u[3];
    if (!region->many && graph_known_components(g, along, 3, u))
        for (uint32_t k = 0; k < 3; k++)
            if (fabs(u[k]) == 1 && u[(k + 1) % 3] == 0 && u[(k + 2) % 3] == 0) {
                Node coordinate = graph_component(g, point, k);
                return u[k] > 0 ? coordinate : neg(g, coordinate);
            }
    return graph_op2(g, OP_dot, along, point);
}

/* Tells whether a direction was tried: both parts have some of their faces in common, and with
   their hull. */
static bool is_tried(Region *region, Node along)
{
    const Graph *g = region->e->graph;
    double       normal[3], other[3];
    const bool   known = graph_known_components(g, along, 3, normal);
    for (size_t i = 0; i < region->normals.count; i++) {
        const Node tried = region->normals.items[i];
        if (tried == along || (known && graph_known_components(g, tried, 3, other) &&
                               distance3(normal, other) < SAME))
            return true;
    }
    array_push(region->e->values, &region->normals, along);
    return false;
}

static void add_plane(Region *region, const Extents *extents, Node along)
{
    Elaboration *e    = region->e;
    Node         most = extents_along(e, extents, along);
    double       normal[3], offset;
    if (most == NODE_NONE || is_tried(region, along))
        return;
    Node distance = sub(e->graph, height_along(region, along), most);
    bool known    = graph_known_components(e->graph, along, 3, normal) &&
                 graph_known_components(e->graph, most, 1, &offset);
    add_distance(region, distance,
                 known ? zone_goes_beyond_plane(region->zone, normal, offset)
                       : zone_goes_beyond(e, region->zone, distance));
}

static void add_round(Region *region, Node away, Node most)
{
    Node distance = sub(region->e->graph, away, most);
    add_distance(region, distance, zone_goes_beyond(region->e, region->zone, distance));
}

static void add_cylinder(Region *region, const Extents *extents, ExtentLine axis)
{
    Graph *g      = region->e->graph;
    Node   offset = sub(g, graph_leaf(g, OP_POINT), axis.on);
    Node   away   = graph_op2(g, OP_dot, offset, axis.along);
    away          = graph_op1(g, OP_length, sub(g, offset, stretch(g, axis.along, away)));
    add_round(region, away, extents_about(region->e, extents, axis));
}

static void add_ball_about(Region *region, const Extents *extents, Node centre)
{
    Graph *g    = region->e->graph;
    Node   away = graph_op1(g, OP_length, sub(g, graph_leaf(g, OP_POINT), centre));
    add_round(region, away, extents_from(region->e, extents, centre));
}

static Region region_by_features(Elaboration *e, const Extents *extents, const FilletZone *zone,
                                 bool many)
{
    Region region = {.e = e, .zone = zone, .many = many};
    for (int k = 0; k < (extents->figure ? 4 : 6);
         k++) { /* the box of the fillet relies on these */
        const double sign = k % 2 ? 1 : -1;
        add_plane(&region, extents,
                  graph_vec3(e->graph, k / 2 == 0 ? sign : 0, k / 2 == 1 ? sign : 0,
                             k / 2 == 2 ? sign : 0));
    }
    for (size_t i = 0; i < extents->faces.count; i++) {
        add_plane(&region, extents, extents->faces.items[i]);
        add_plane(&region, extents, neg(e->graph, extents->faces.items[i]));
    }
    for (size_t i = 0; i < extents->half_spaces.count; i++)
        add_plane(&region, extents, extents->half_spaces.items[i].along);
    if (many && region.distances.count > 0)
        add_spare(&region);
    for (size_t i = 0; i < extents->axes.count && extents->half_spaces.count == 0; i++)
        add_cylinder(&region, extents, extents->axes.items[i]);
    for (size_t i = 0; i < extents->centres.count && extents->half_spaces.count == 0; i++)
        add_ball_about(&region, extents, extents->centres.items[i]);
    return region;
}

static const Shape *shape_of_region(Region *region, const Call *call, bool figure)
{
    if (region->distances.count == 0)
        return NULL;
    Shape *shape  = primitive_new(region->e->builder, "hull", greatest(region), box_infinite,
                                  call->syntax->span);
    shape->figure = figure;
    claim_slope(region->e->builder, shape, 1);
    return shape;
}

const Shape *hull_region(Elaboration *e, const Call *call, const Extents *extents,
                         const FilletZone *zone, bool many)
{
    HullParts    parts  = {0};
    Region       region = {0};
    const bool   known  = parts_of_extents(e, extents, &parts);
    Node         distance;
    const Shape *hull = known ? round_hull(e, call, &parts) : NULL;
    if (hull && lower_solid(e->graph, hull, NULL, e->scratch, &distance)) {
        arena_clear(e->scratch);
        return zone_goes_beyond(e, zone, distance) ? hull : NULL;
    }
    for (size_t i = 0; i < sizeof samplings / sizeof *samplings; i++) {
        Extents more        = *extents;
        more.faces.capacity = more.faces.count; /* a copy of its own, when it grows */
        if (known && !extents->figure)
            add_hull_faces(e, &parts, &samplings[i], &more);
        region = region_by_features(e, &more, zone, many);
        if (region.distances.count <= samplings[i].most)
            break;
    }
    return shape_of_region(&region, call, extents->figure);
}
