/*
 * fillet.c: unions whose joints are rounded and never swell.
 *
 * Of two parts that is their circular blend, cut by a region that holds both: their convex hull or, where
 * that cannot be said, what is left by the planes of their faces, and by cylinders and balls about what
 * is round in them.  Of more parts it is the union of all pairs.  What is a sharp union counts as its
 * parts, without fillets between these.
 */
#include "compiler/eval/fillet.h"

#include <math.h>
#include <stdlib.h>

#include "compiler/base/vec.h"
#include "compiler/eval/extents.h"
#include "compiler/eval/hull_normals.h"
#include "compiler/eval/hull_parts.h"
#include "compiler/family/family.h"
#include "compiler/graph/build.h"
#include "compiler/lower/crowd.h"
#include "compiler/lower/lower.h"

enum { MOST_PARTS = 20000, MOST_PAIRS = 20000 };

/* From how many pairs on they had best be alike, and how many planes they have then at least. */
enum { LEAST_PAIRS = LEAST_CROWD, LEAST_ALIKE = 8 };

/* How many corners stand for a circle, and of how many balls the directions are tried. */
enum { RIM_CORNERS = 48, MOST_SAMPLED_BALLS = 8 };

/* A part of a joint, and the number of the shape that it belongs to. */
typedef struct FilletPart {
    const Shape *shape;
    uint32_t     owner;
    bool         paired;
    Extents      extents;
} FilletPart;

typedef struct FilletParts {
    FilletPart *items;
    size_t      count, capacity;
} FilletParts;

typedef struct Shapes {
    const Shape **items;
    size_t        count, capacity;
} Shapes;

/* Two of them that are near to each other, and a box around all that joins them. */
typedef struct FilletPair {
    const FilletPart *a, *b;
    Box               zone;
} FilletPair;

typedef struct Filleting {
    Elaboration *e;
    const Call  *call;
    Blend        blend;
    double       widest;
    FilletParts  parts;
    struct {
        FilletPair *items;
        size_t      count, capacity;
    } pairs;
} Filleting;

/* ---- parts ---- */

static bool has_clip(const Shape *shape)
{
    bool found = shape->kind == SHAPE_CLIP;
    for (uint32_t i = 0; i < shape->child_count && !found; i++)
        found = has_clip(shape->children[i]);
    return found;
}

static const Shape *wrapped(Elaboration *e, const Shape *wrapper, const Shape *part)
{
    switch (wrapper->kind) {
    case SHAPE_PAINT: return make_paint(e->builder, part, wrapper->material, wrapper->span);
    case SHAPE_SMOOTH: return make_smooth(e->builder, part, wrapper->values[0], wrapper->span);
    default: return make_transform(e->builder, part, &wrapper->map, wrapper->span);
    }
}

/* Adds the parts of a sharp union, wherever it has been put and however it is painted. */
static bool add_parts(Elaboration *e, const Shape *shape, Shapes *parts)
{
    const size_t first   = parts->count;
    const bool   wrapper = shape->kind == SHAPE_PAINT || shape->kind == SHAPE_SMOOTH ||
                         shape->kind == SHAPE_TRANSFORM;
    const bool sharp = shape->kind == SHAPE_UNION && shape->blend.width == NODE_NONE;
    if (parts->count > MOST_PARTS)
        return true; /* reported below */
    if (sharp || wrapper) {
        for (uint32_t i = 0; i < shape->child_count; i++)
            if (!add_parts(e, shape->children[i], parts))
                return false;
        if (sharp)
            return true;
        if (parts->count != first + 1 || parts->items[first] != shape->children[0]) {
            for (size_t i = first; i < parts->count; i++)
                if (!(parts->items[i] = wrapped(e, shape, parts->items[i])))
                    return false;
            return true;
        }
        parts->count = first;
    }
    if (!box_is_empty(shape->box))
        array_push(e->values, parts, shape);
    return true;
}

static bool refuse_many(Filleting *f, const char *what)
{
    Diag *diag = diag_add(f->e->diags, DIAG_LIMIT, f->call->syntax->span, "%s", what);
    diag->help = "join sharply, with `|`, what needs no fillets in between: a union counts as one "
                 "part of the next `union`";
    return false;
}

static bool add_shape_parts(Filleting *f, const Shape *shape, uint32_t owner)
{
    Elaboration *e     = f->e;
    Shapes       parts = {0};
    if (!add_parts(e, shape, &parts))
        return false;
    for (size_t i = 0; i < parts.count; i++) {
        FilletPart part = {.shape = parts.items[i], .owner = owner};
        if (f->parts.count == MOST_PARTS)
            return refuse_many(f, "fillets between more than 20,000 parts");
        extents_add(e, part.shape, &part.extents);
        if (part.extents.wants_turns) {
            e->turns->refused = true;
            return false;
        }
        array_push(e->values, &f->parts, part);
    }
    return true;
}

/* ---- the region of a pair ---- */

static void add_lines(Elaboration *e, ExtentLines *to, const ExtentLines *from)
{
    for (size_t i = 0; i < from->count; i++)
        array_push(e->values, to, from->items[i]);
}

static Extents extents_of_both(Elaboration *e, const Extents *a, const Extents *b)
{
    const Extents *both[] = {a, b};
    Extents        joined = {.figure = a->figure};
    for (int k = 0; k < 2; k++) {
        const Extents *one = both[k];
        for (size_t i = 0; i < one->count; i++)
            array_push(e->values, &joined, one->items[i]);
        for (size_t i = 0; i < one->faces.count; i++)
            array_push(e->values, &joined.faces, one->faces.items[i]);
        for (size_t i = 0; i < one->centres.count; i++)
            array_push(e->values, &joined.centres, one->centres.items[i]);
        add_lines(e, &joined.axes, &one->axes);
        add_lines(e, &joined.half_spaces, &one->half_spaces);
    }
    return joined;
}

static bool known_numbers(const Graph *g, Node node, uint32_t count, double *numbers)
{
    bool known = true;
    for (uint32_t i = 0; i < count; i++)
        known = known && graph_known_component(g, node, i, &numbers[i]);
    return known;
}

/* In numbers; false: some depend on the frame, or there is a half-space. */
static bool parts_of_extents(Elaboration *e, const Extents *extents, HullParts *parts)
{
    bool known    = extents->half_spaces.count == 0;
    parts->figure = extents->figure;
    for (size_t i = 0; i < extents->count && known; i++) {
        const Extent *extent = &extents->items[i];
        HullPart      part   = {.rim = {0}};
        known                = known_numbers(e->graph, extent->centre, 3, part.ball.centre) &&
                known_numbers(e->graph, extent->radius, 1, &part.ball.radius) &&
                (extent->rim == NODE_NONE || known_numbers(e->graph, extent->rim, 3, part.rim));
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

static void add_ball(Elaboration *e, Points *points, const double centre[3], double radius)
{
    for (int code = 0; code < 27; code++) {
        double direction[3] = {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
        if (normalize3(direction))
            add_point(e, points, centre, radius, direction);
    }
}

static void add_rim(Elaboration *e, Points *points, const HullPart *part)
{
    double along[3] = {part->rim[0], part->rim[1], part->rim[2]}, first[3], second[3];
    normalize3(along);
    const int    least   = fabs(along[0]) < 0.6 ? 0 : 1;
    const double side[3] = {least == 0, least == 1, 0}, rim = length3(part->rim);
    cross3(along, side, first);
    normalize3(first);
    cross3(along, first, second);
    for (int i = 0; i < RIM_CORNERS; i++) {
        const double turn = 2 * 3.14159265358979323846 * i / RIM_CORNERS;
        double       direction[3], on[3];
        for (int k = 0; k < 3; k++)
            direction[k] = cos(turn) * first[k] + sin(turn) * second[k];
        add_point(e, points, part->ball.centre, rim + part->ball.radius, direction);
        if (part->ball.radius > 0) {
            add_scaled3(on, part->ball.centre, rim, direction);
            add_point(e, points, on, part->ball.radius, along);
            add_point(e, points, on, -part->ball.radius, along);
        }
    }
}

/* Which ways faces of the hull look, or those of a solid with corners that is nearly the hull. */
static void add_hull_faces(Elaboration *e, const HullParts *parts, Extents *extents)
{
    HullNormals normals = {.arena = e->values};
    Points      points  = {0};
    size_t      balls   = 0;
    for (size_t i = 0; i < parts->count; i++)
        balls += parts->items[i].ball.radius > 0;
    for (size_t i = 0; i < parts->count; i++) {
        const HullPart *part = &parts->items[i];
        if (length3(part->rim) > 0)
            add_rim(e, &points, part);
        else if (part->ball.radius > 0 && balls <= MOST_SAMPLED_BALLS)
            add_ball(e, &points, part->ball.centre, part->ball.radius);
        else
            add_point(e, &points, part->ball.centre, 0, part->rim);
    }
    hull_normals(points.items, points.count / 3, &normals);
    for (size_t i = 0; i < normals.count; i++)
        array_push(e->values, &extents->faces,
                   graph_constant(e->graph, TYPE_VEC3, normals.items[i]));
}

static void zone_corner(const Box *zone, int corner, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = corner >> k & 1 ? zone->axis[k].high : zone->axis[k].low;
}

/* Whether a convex function of the point can be above 0 in a box: it is greatest at a corner. */
static bool acts_in(Elaboration *e, Node distance, const Box *zone)
{
    bool acts = !box_is_finite(*zone);
    for (int corner = 0; corner < 8 && !acts; corner++) {
        double point[3];
        zone_corner(zone, corner, point);
        Node at = graph_constant(e->graph, TYPE_VEC3, point);
        at      = graph_substitute(e->graph, distance, substitute_point(at), e->values);
        acts    = node_range(e->builder, at, 0).high > 0;
    }
    return acts;
}

/* A region that is made bit by bit, as the greatest of distances with slope 1.  Those that are spare are
   nowhere above 0 in the zone. */
typedef struct Region {
    Elaboration *e;
    const Box   *zone;
    bool         crowd; /* of one of many pairs, which had best be alike */
    struct {
        Node  *items;
        size_t count, capacity;
    } distances, spare;
} Region;

static void add_distance(Region *region, Node distance)
{
    Elaboration *e = region->e;
    if (acts_in(e, distance, region->zone))
        array_push(e->values, &region->distances, distance);
    else
        array_push(e->values, &region->spare, distance);
}

/* A power of 2, where many pairs shall have as many. */
static void add_spare(Region *region)
{
    size_t wanted = LEAST_ALIKE;
    while (wanted < region->distances.count)
        wanted *= 2;
    for (size_t i = 0; i < region->spare.count && region->distances.count < wanted; i++)
        array_push(region->e->values, &region->distances, region->spare.items[i]);
}

static Node greatest(Region *region)
{
    Node most = region->distances.items[0];
    for (size_t i = 1; i < region->distances.count; i++)
        most = graph_op2(region->e->graph, OP_max, most, region->distances.items[i]);
    return most;
}

/* dot(along, p), where it is a coordinate without a product. */
static Node height_along(const Region *region, Node along)
{
    Graph     *g     = region->e->graph;
    const Node point = graph_leaf(g, OP_POINT);
    double     u[3];
    if (!region->crowd && known_numbers(g, along, 3, u))
        for (uint32_t k = 0; k < 3; k++)
            if (fabs(u[k]) == 1 && u[(k + 1) % 3] == 0 && u[(k + 2) % 3] == 0) {
                Node coordinate = graph_component(g, point, k);
                return u[k] > 0 ? coordinate : neg(g, coordinate);
            }
    return graph_op2(g, OP_dot, along, point);
}

static void add_plane(Region *region, const Extents *extents, Node along)
{
    Graph *g    = region->e->graph;
    Node   most = extents_along(region->e, extents, along);
    if (most != NODE_NONE)
        add_distance(region, sub(g, height_along(region, along), most));
}

static void add_cylinder(Region *region, const Extents *extents, ExtentLine axis)
{
    Graph *g      = region->e->graph;
    Node   offset = sub(g, graph_leaf(g, OP_POINT), axis.on);
    Node   away   = graph_op2(g, OP_dot, offset, axis.along);
    away          = graph_op1(g, OP_length, sub(g, offset, stretch(g, axis.along, away)));
    add_distance(region, sub(g, away, extents_about(region->e, extents, axis)));
}

static void add_ball_about(Region *region, const Extents *extents, Node centre)
{
    Graph *g    = region->e->graph;
    Node   away = graph_op1(g, OP_length, sub(g, graph_leaf(g, OP_POINT), centre));
    add_distance(region, sub(g, away, extents_from(region->e, extents, centre)));
}

static const Shape *region_by_features(Filleting *f, const Extents *extents, const Box *zone)
{
    Elaboration *e      = f->e;
    Region       region = {.e = e, .zone = zone, .crowd = f->pairs.count >= LEAST_PAIRS};
    for (size_t i = 0; i < extents->faces.count; i++) {
        add_plane(&region, extents, extents->faces.items[i]);
        add_plane(&region, extents, neg(e->graph, extents->faces.items[i]));
    }
    for (size_t i = 0; i < extents->half_spaces.count; i++)
        add_plane(&region, extents, extents->half_spaces.items[i].along);
    if (region.crowd && region.distances.count > 0)
        add_spare(&region);
    for (size_t i = 0; i < extents->axes.count && extents->half_spaces.count == 0; i++)
        add_cylinder(&region, extents, extents->axes.items[i]);
    for (size_t i = 0; i < extents->centres.count && extents->half_spaces.count == 0; i++)
        add_ball_about(&region, extents, extents->centres.items[i]);
    if (region.distances.count == 0)
        return NULL;
    Shape *shape  = primitive_new(e->builder, "hull", greatest(&region), box_infinite,
                                  f->call->syntax->span);
    shape->figure = extents->figure;
    claim_slope(e->builder, shape, 1);
    return shape;
}

/* NULL: nothing is outside of it where the blend swells. */
static const Shape *region_of_pair(Filleting *f, const FilletPair *pair)
{
    Elaboration *e       = f->e;
    const Box   *zone    = &pair->zone;
    Extents      extents = extents_of_both(e, &pair->a->extents, &pair->b->extents);
    HullParts    parts   = {0};
    if (!parts_of_extents(e, &extents, &parts))
        return region_by_features(f, &extents, zone);
    const Shape *hull = round_hull(e, f->call, &parts);
    Node         distance;
    if (hull && lower_solid(e->graph, hull, NULL, e->scratch, &distance)) {
        arena_clear(e->scratch);
        return acts_in(e, distance, zone) ? hull : NULL;
    }
    if (!extents.figure)
        add_hull_faces(e, &parts, &extents);
    return region_by_features(f, &extents, zone);
}

/* ---- pairs ---- */

static const Shape *make_pair(Filleting *f, const FilletPair *pair)
{
    const Span   span    = f->call->syntax->span;
    const Shape *parts[] = {pair->a->shape, pair->b->shape};
    const Shape *joint   = make_joint(f->e->builder, SHAPE_UNION, parts, 2, f->blend, span);
    return make_clip(f->e->builder, joint, region_of_pair(f, pair), span);
}

static bool refuse_endless(Filleting *f, const FilletPart *part)
{
    Diag *diag = diag_add(f->e->diags, DIAG_BAD_VALUE, f->call->syntax->span,
                          "a fillet needs to know how far its parts reach");
    diag->help = "cut what is endless, by `.within(box([10, 10, 10]))`, say";
    diag_secondary(f->e->diags, diag, part->shape->span, "this is endless");
    return false;
}

static int compare_parts(const void *first, const void *second)
{
    const double a = ((const FilletPart *)first)->shape->box.axis[0].low;
    const double b = ((const FilletPart *)second)->shape->box.axis[0].low;
    return a < b ? -1 : a > b;
}

static bool add_pair(Filleting *f, FilletPart *a, FilletPart *b)
{
    const Box zone = box_common(box_grow(a->shape->box, f->widest),
                                box_grow(b->shape->box, f->widest));
    if (a->owner == b->owner || box_is_empty(zone))
        return true;
    if (a->extents.endless || b->extents.endless)
        return refuse_endless(f, a->extents.endless ? a : b);
    if (f->pairs.count == MOST_PAIRS)
        return refuse_many(f, "fillets between more than 20,000 pairs of near parts");
    a->paired = b->paired = true;
    array_push(f->e->values, &f->pairs, ((FilletPair){a, b, zone}));
    return true;
}

static bool add_pairs(Filleting *f)
{
    FilletPart *parts = f->parts.items;
    qsort(parts, f->parts.count, sizeof *parts, compare_parts);
    for (size_t i = 0; i < f->parts.count; i++)
        for (size_t k = i + 1; k < f->parts.count; k++) {
            const Range after = parts[k].shape->box.axis[0], before = parts[i].shape->box.axis[0];
            if (after.low - f->widest > before.high + f->widest)
                break;
            if (!add_pair(f, &parts[i], &parts[k]))
                return false;
        }
    return true;
}

const Shape *make_fillet(Elaboration *e, const Call *call, const Shape *const *shapes,
                         uint32_t count, Blend blend)
{
    Filleting f = {.e = e, .call = call, .blend = blend};
    if (e->turn != NODE_NONE)
        return NULL; /* which parts are near is known turn by turn */
    f.widest = fmax(node_range(e->builder, blend.width, 0).high, 0);
    for (uint32_t i = 0; i < count; i++)
        if (!add_shape_parts(&f, shapes[i], i))
            return NULL;
    if (!add_pairs(&f))
        return NULL;
    Shapes joined = {0};
    for (size_t i = 0; i < f.pairs.count && !is_stopped(e); i++)
        array_push(e->values, &joined, make_pair(&f, &f.pairs.items[i]));
    for (size_t i = 0; i < f.parts.count; i++) /* a region may cut what was a fillet by a hair */
        if (!f.parts.items[i].paired || has_clip(f.parts.items[i].shape))
            array_push(e->values, &joined, f.parts.items[i].shape);
    if (joined.count == 1)
        return joined.items[0];
    return value_of_joint(e, make_joint(e->builder, SHAPE_UNION, joined.items,
                                        (uint32_t)joined.count, blend_sharp, call->syntax->span))
        .shape;
}
