/*
 * hull.c: convex hulls of points, balls and rims.
 *
 * Balls of one size that do not lie in a plane have the hull of their centres, grown: by Qhull (Barber,
 * Dobkin and Huhdanpaa, "The Quickhull algorithm for convex hulls", 1996).  Others have supports
 * (hull_supports.h).  Rims about one axis, or between two planes across it, are a plane figure's hull.
 */
#include "compiler/eval/hulls/hull.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/eval/declared/claims.h"
#include "compiler/shape/map.h"

/* A hull may be of so many balls of one size, or of several: those count by their third power. */
enum { MAX_POINTS = 4096, MAX_BALLS = 200 };

static const double NEAR = 1e-9;

/* A hull that is to be made: all its parts, and by how much it is grown. */
typedef struct Hulling {
    Elaboration *e;
    const Call  *call;
    HullParts    parts;
    Value        grown; /* a number of frame time */
    double       least; /* of that */
} Hulling;

static Value refuse(const Hulling *h, const char *what, const char *help)
{
    const Syntax *first = h->call->rest_count ? h->call->rest[0].syntax : h->call->syntax;
    Diag         *diag  = diag_add(h->e->diags, DIAG_BAD_VALUE, first->span, "%s", what);
    diag->help          = help;
    return value_error();
}

/* ---- values for the library ---- */

static Value pair_value(Elaboration *e, Value first, Value second)
{
    Value *items = arena_new_array(e->values, Value, 2);
    items[0]     = first;
    items[1]     = second;
    return value_list(e, items, 2);
}

static Value triple_value(Elaboration *e, Value first, Value second, Value third)
{
    Value *items = arena_new_array(e->values, Value, 3);
    items[0]     = first;
    items[1]     = second;
    items[2]     = third;
    return value_list(e, items, 3);
}

static Value faces_value(Elaboration *e, const HullSupports *hull)
{
    Values faces = {0};
    for (size_t i = 0; i < hull->faces.count; i++) {
        const HullFace *face = &hull->faces.items[i];
        Value pair = pair_value(e, value_vector(e, face->normal, 3), value_number(face->offset));
        array_push(e->values, &faces, pair);
    }
    return value_list(e, faces.items, faces.count);
}

/* Returns [[centre, axis, middle], [radius, sine, cosine, least]]. */
static Value edges_value(Elaboration *e, const HullSupports *hull)
{
    Values edges = {0};
    for (size_t i = 0; i < hull->edges.count; i++) {
        const HullEdge *edge      = &hull->edges.items[i];
        const double    numbers[] = {edge->ball.radius, edge->sine, edge->cosine, edge->least};
        Value           vectors   = triple_value(e, value_vector(e, edge->ball.centre, 3),
                                                 value_vector(e, edge->axis, 3),
                                                 value_vector(e, edge->middle, 3));
        array_push(e->values, &edges, pair_value(e, vectors, value_vector(e, numbers, 4)));
    }
    return value_list(e, edges.items, edges.count);
}

/* Returns [centre, radius, [[towards, longer], ...]]. */
static Value corners_value(Elaboration *e, const HullSupports *hull)
{
    Values corners = {0};
    for (size_t i = 0; i < hull->corners.count; i++) {
        const HullCorner *corner = &hull->corners.items[i];
        Values            limits = {0};
        for (size_t k = 0; k < corner->limits.count; k++) {
            const HullLimit *limit = &corner->limits.items[k];
            Value            pair  = pair_value(e, value_vector(e, limit->towards, 3),
                                                value_number(limit->longer));
            array_push(e->values, &limits, pair);
        }
        array_push(e->values, &corners,
                   triple_value(e, value_vector(e, corner->ball.centre, 3),
                                value_number(corner->ball.radius),
                                value_list(e, limits.items, limits.count)));
    }
    return value_list(e, corners.items, corners.count);
}

/* Returns two corners of the box around all balls. */
static Value box_value(Elaboration *e, const HullBall *balls, size_t count)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            low[k]  = fmin(low[k], balls[i].centre[k] - balls[i].radius);
            high[k] = fmax(high[k], balls[i].centre[k] + balls[i].radius);
        }
    return pair_value(e, value_vector(e, low, 3), value_vector(e, high, 3));
}

/* ---- hulls of balls ---- */

static bool one_size(const HullBall *balls, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (fabs(balls[i].radius - balls[0].radius) > NEAR * balls[0].radius)
            return false;
    return true;
}

static Value by_supports(const Hulling *h, const HullBall *balls, size_t count, bool plane)
{
    Elaboration *e        = h->e;
    HullSupports hull     = hull_supports(e->values, balls, count, plane);
    Value        supports = triple_value(e, faces_value(e, &hull), edges_value(e, &hull),
                                         corners_value(e, &hull));
    Value        parts    = triple_value(e, supports, box_value(e, balls, count), h->grown);
    return call_library(e, plane ? "_hull_of_discs" : "_hull_of_balls", parts, h->call->syntax);
}

/* Returns the hull of their centres, grown by their radius. */
static Value by_points(const Hulling *h, const HullBall *balls, size_t count)
{
    Elaboration *e      = h->e;
    Values       points = {0};
    for (size_t i = 0; i < count; i++)
        array_push(e->values, &points, value_vector(e, balls[i].centre, 3));
    Value radius = h->grown;
    if (radius.type == VALUE_NUMBER)
        radius.number += balls[0].radius;
    return call_library(e, "_hull_of_points",
                        pair_value(e, value_list(e, points.items, count), radius), h->call->syntax);
}

/* Tells whether the hull has an inside. */
static bool is_solid(const Hulling *h, const HullBall *balls, size_t count, bool flat)
{
    bool solid = h->least > 0 || !flat;
    for (size_t i = 0; i < count; i++)
        solid = solid || balls[i].radius > 0;
    return solid;
}

static Value hull_of_balls(const Hulling *h, const HullBall *balls, size_t count, bool plane)
{
    bool flat = balls_are_flat(balls, count, plane);
    if (!is_solid(h, balls, count, flat))
        return refuse(h,
                      plane ? "these points lie on a line, or nearly so"
                            : "these points lie in a plane, or nearly so",
                      "give points around the solid, or a `radius`");
    bool points = !plane && !flat && one_size(balls, count) &&
                  (balls[0].radius == 0 || h->grown.type == VALUE_NUMBER);
    if (count > (points ? MAX_POINTS : MAX_BALLS))
        return refuse(h,
                      points ? "a hull has at most 4096 points"
                             : "a hull has at most 200 balls of different sizes, or in a plane",
                      "leave out what is inside");
    return points ? by_points(h, balls, count) : by_supports(h, balls, count, plane);
}

/* ---- hulls with rims ---- */

/* A point, a unit vector along the axis through it, and two across; `along` is across x other. */
typedef struct Axis {
    double on[3], along[3], across[3], other[3];
} Axis;

/* Finds the axis of the rims, if it is that of all of them. */
static bool common_axis(const HullParts *parts, Axis *axis)
{
    size_t first = parts->count;
    for (size_t i = 0; i < parts->count; i++) {
        const double *rim = parts->items[i].rim;
        double        aside[3];
        if (length3(rim) == 0)
            continue;
        if (first == parts->count) {
            first = i;
            for (int k = 0; k < 3; k++)
                axis->along[k] = rim[k];
            normalize3(axis->along);
        }
        cross3(axis->along, rim, aside);
        if (length3(aside) > NEAR * length3(rim))
            return false;
    }
    for (int k = 0; k < 3; k++)
        axis->on[k] = parts->items[first].ball.centre[k];
    axes_across3(axis->along, axis->across, axis->other);
    return true;
}

/* Finds the coordinates of a centre: across the axis, twice, and along it. */
static void axis_place(const Axis *axis, const HullPart *part, double place[3])
{
    double offset[3];
    add_scaled3(offset, part->ball.centre, -1, axis->on);
    place[0] = dot3(offset, axis->across);
    place[1] = dot3(offset, axis->other);
    place[2] = dot3(offset, axis->along);
}

static double parts_size(const Axis *axis, const HullParts *parts)
{
    double size = 0;
    for (size_t i = 0; i < parts->count; i++)
        size = fmax(size, distance3(parts->items[i].ball.centre, axis->on) +
                              length3(parts->items[i].rim) + parts->items[i].ball.radius);
    return size;
}

/* Moves a shape so that its axes are along these unit vectors, and its origin is on the axis. */
static Value put_in_place(const Hulling *h, const Shape *shape, double axes[3][3], const Axis *axis,
                          double along)
{
    Map   *map = map_new(h->e->builder);
    double middle[3];
    add_scaled3(middle, axis->on, along, axis->along);
    map->shift = graph_constant(h->e->graph, TYPE_VEC3, middle);
    for (int i = 0; i < 3; i++) {
        const double row[3] = {axes[0][i], axes[1][i], axes[2][i]};
        map->rows[i]        = graph_constant(h->e->graph, TYPE_VEC3, row);
    }
    return value_shape(make_transform(h->e->builder, shape, map, h->call->syntax->span));
}

/* Makes the hull of balls about one axis: that of what is left and right of it in a plane through
   it, revolved. */
static bool revolved_hull(const Hulling *h, const Axis *axis, double slack, Value *result)
{
    size_t    count = 2 * h->parts.count;
    HullBall *discs = arena_new_array(h->e->values, HullBall, count);
    for (size_t i = 0; i < count; i++) {
        const HullPart *part = &h->parts.items[i / 2];
        double          place[3], rim = length3(part->rim);
        axis_place(axis, part, place);
        if (real_hypot(place[0], place[1]) > slack)
            return false;
        discs[i] = (HullBall){{i % 2 ? rim : -rim, place[2], 0}, part->ball.radius};
    }
    *result = hull_of_balls(h, discs, count, true);
    if (result->type != VALUE_SHAPE)
        return true;
    double       axes[3][3];
    Node         zero  = graph_number(h->e->graph, 0);
    const Shape *solid = make_revolve(h->e->builder, result->shape, zero, h->call->syntax->span);
    for (int i = 0; i < 3; i++) {
        axes[0][i] = axis->across[i];
        axes[1][i] = axis->along[i];
        axes[2][i] = -axis->other[i];
    }
    *result = put_in_place(h, solid, axes, axis, 0);
    return true;
}

/* Tells whether each part has one at the other end that is alike. */
static bool ends_match(const HullParts *parts, double (*places)[3], double middle, double slack)
{
    for (size_t i = 0; i < parts->count; i++) {
        bool found = false;
        for (size_t k = 0; k < parts->count && !found; k++)
            found = (places[i][2] < middle) != (places[k][2] < middle) &&
                    real_hypot(places[i][0] - places[k][0], places[i][1] - places[k][1]) <= slack &&
                    fabs(length3(parts->items[i].rim) - length3(parts->items[k].rim)) <= slack;
        if (!found)
            return false;
    }
    return true;
}

/* Finds the sections of columns that all have both their ends in the same two planes, and balls of
   one size about them.  False: they are no such columns. */
static bool sections(const Hulling *h, const Axis *axis, double slack, HullBall *discs, Range *ends)
{
    size_t count       = h->parts.count;
    double(*places)[3] = arena_alloc(h->e->values, count, sizeof *places);
    *ends              = (Range){HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < count; i++) {
        const HullPart *part = &h->parts.items[i];
        axis_place(axis, part, places[i]);
        ends->low  = fmin(ends->low, places[i][2]);
        ends->high = fmax(ends->high, places[i][2]);
        discs[i]   = (HullBall){{places[i][0], places[i][1], 0}, length3(part->rim)};
        if (fabs(part->ball.radius - h->parts.items[0].ball.radius) > slack)
            return false;
    }
    for (size_t i = 0; i < count; i++)
        if (places[i][2] > ends->low + slack && places[i][2] < ends->high - slack)
            return false;
    return ends->high - ends->low > slack &&
           ends_match(&h->parts, places, 0.5 * (ends->low + ends->high), slack);
}

/* Makes the hull of parallel columns: that of their sections, extruded. */
static bool extruded_hull(const Hulling *h, const Axis *axis, double slack, Value *result)
{
    HullBall *discs = arena_new_array(h->e->values, HullBall, h->parts.count);
    Range     ends;
    if (!sections(h, axis, slack, discs, &ends))
        return false;
    Hulling sharp = *h;
    sharp.grown   = value_number(0);
    sharp.least   = 0;
    *result       = hull_of_balls(&sharp, discs, h->parts.count, true);
    if (result->type != VALUE_SHAPE)
        return true;
    Span         span  = h->call->syntax->span;
    Graph       *graph = h->e->graph;
    Node         thick = graph_number(graph, ends.high - ends.low);
    Node         ball  = graph_number(graph, h->parts.items[0].ball.radius);
    Node         more  = graph_op2(graph, OP_add, value_node(h->e, h->grown), ball);
    const Shape *solid = make_extrude(h->e->builder, result->shape, thick, span);
    double       axes[3][3], known;
    if (!graph_known_component(graph, more, 0, &known) || known != 0)
        solid = make_offset(h->e->builder, solid, more, span);
    for (int i = 0; i < 3; i++) {
        axes[0][i] = axis->across[i];
        axes[1][i] = axis->other[i];
        axes[2][i] = axis->along[i];
    }
    *result = put_in_place(h, solid, axes, axis, 0.5 * (ends.low + ends.high));
    return true;
}

/* Makes the hull of rims; false: it is none of those that can be made. */
static bool rims_hull(const Hulling *h, bool *common, Value *result)
{
    Axis axis    = {0};
    *common      = common_axis(&h->parts, &axis);
    double slack = *common ? NEAR * parts_size(&axis, &h->parts) : 0;
    return *common &&
           (revolved_hull(h, &axis, slack, result) || extruded_hull(h, &axis, slack, result));
}

static Value hull_with_rims(const Hulling *h)
{
    bool  common;
    Value result;
    if (rims_hull(h, &common, &result))
        return result;
    return refuse(h,
                  common ? "round solids in a hull need one axis for all, or the same two ends"
                         : "the axes of round solids in a hull must be parallel",
                  "a `prism` of many sides is a column with corners, which any hull may have");
}

/* ---- the function and the method ---- */

/* Reads `radius`, also as the second argument, behind a list of points: a number, or one for each
   point. */
static bool read_radius(Hulling *h, Call *call)
{
    Argument *radius = &call->arguments[1];
    Argument *last   = call->rest_count == 2 ? &call->rest[1] : NULL;
    if (!radius->syntax && last && value_size(h->e, last->value) == 1) {
        *radius = *last;
        call->rest_count--;
    }
    h->grown = value_number(0);
    if (!radius->syntax || radius->value.type == VALUE_LIST)
        return true;
    Node node = want_number(h->e, call, 1, 0);
    if (node == NODE_NONE || !check_not_negative(h->e, node, radius->syntax, "a radius"))
        return false;
    h->grown = radius->value;
    h->least = node_range(h->e->builder, node, 0).low;
    return true;
}

static bool read_radii(Hulling *h, const Argument *radius)
{
    if (!radius->syntax || radius->value.type != VALUE_LIST)
        return true;
    const List *radii = radius->value.list;
    bool        good  = radii->count == h->parts.count && h->parts.points == h->parts.count;
    for (size_t i = 0; good && i < radii->count; i++) {
        good = radii->items[i].type == VALUE_NUMBER && radii->items[i].number >= 0;
        h->parts.items[i].ball.radius = good ? radii->items[i].number : 0;
    }
    if (good)
        return true;
    Diag *diag = diag_add(h->e->diags, DIAG_BAD_VALUE, radius->syntax->span,
                          "`radius` of `hull` is a number, or a list of one for each point");
    diag->help = "known at compile time, and not negative: "
                 "`hull([[0, 0, 0], [2, 0, 0]], radius: [1, 0.5])`";
    return false;
}

static Value hull_of_parts(const Hulling *h)
{
    size_t    count = h->parts.count;
    HullBall *balls = arena_new_array(h->e->values, HullBall, count + 1);
    if (count == 0)
        return refuse(h, "`hull` needs at least one shape or point",
                      "for example `hull(sphere(1), box([1, 1, 1]).move([3, 0, 0]))`");
    for (size_t i = 0; i < count; i++) {
        if (length3(h->parts.items[i].rim) > 0)
            return hull_with_rims(h);
        balls[i] = h->parts.items[i].ball;
    }
    return hull_of_balls(h, balls, count, h->parts.figure);
}

const Shape *round_hull(Elaboration *e, const Call *call, const HullParts *parts)
{
    const Hulling h     = {.e = e, .call = call, .parts = *parts, .grown = value_number(0)};
    HullBall     *balls = arena_new_array(e->values, HullBall, parts->count + 1);
    bool          common, rims = false, round = false;
    Value         result = {.type = VALUE_ERROR};
    for (size_t i = 0; i < parts->count; i++) {
        balls[i] = parts->items[i].ball;
        rims     = rims || length3(parts->items[i].rim) > 0;
        round    = round || balls[i].radius > 0;
    }
    if (parts->count > MAX_BALLS)
        return NULL;
    if (rims)
        return rims_hull(&h, &common, &result) && result.type == VALUE_SHAPE ? result.shape : NULL;
    if (round || (parts->figure && !balls_are_flat(balls, parts->count, true)))
        result = hull_of_balls(&h, balls, parts->count, parts->figure);
    return result.type == VALUE_SHAPE ? result.shape : NULL;
}

/* Checks what shapes of the scene state of themselves, each by its hull alone. */
static bool check_claimed(const Hulling *h)
{
    for (size_t i = 0; i < h->parts.unchecked.count; i++) {
        const Shape *shape  = h->parts.unchecked.items[i];
        Hulling      single = {.e = h->e, .call = h->call, .grown = value_number(0)};
        if (!hull_parts_of_shape(h->e, h->call, h->call->syntax, shape, &single.parts))
            return false;
        Value hull = hull_of_parts(&single);
        if (hull.type != VALUE_SHAPE || !check_hull(h->e, shape, hull.shape))
            return false;
    }
    return true;
}

Value builtin_hull(Elaboration *e, Call *call)
{
    Hulling h = {.e = e, .call = call};
    if (!read_radius(&h, call) || !hull_parts(e, call, &h.parts) ||
        !read_radii(&h, &call->arguments[1]) || !check_claimed(&h))
        return value_error();
    return hull_of_parts(&h);
}

Value method_hull(Elaboration *e, const Shape *shape, Call *call)
{
    Hulling h = {.e = e, .call = call, .grown = value_number(0)};
    if (!hull_parts_of_shape(e, call, call->syntax->children[0], shape, &h.parts) ||
        !hull_parts(e, call, &h.parts) || !check_claimed(&h))
        return value_error();
    return hull_of_parts(&h);
}
