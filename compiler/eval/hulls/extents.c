/*
 * extents.c: from shapes to the balls, rims and half-spaces that they are within.  Maps and CSG nodes are
 * followed from the outside inwards; where nothing more is known, the corners of a box stand for a
 * shape.
 */
#include "compiler/eval/hulls/extents.h"

#include <math.h>

#include "compiler/base/vec.h"
#include "compiler/eval/declared/declare.h"
#include "compiler/family/family.h"
#include "compiler/graph/build.h"

/* An affine map, x -> x[0] columns[0] + x[1] columns[1] + x[2] columns[2] + shift; `scale` is that of
   all lengths, or NODE_NONE where it is not the same in all directions. */
typedef struct Placing {
    Node columns[3], shift, scale;
} Placing;

/* The values that stay the same in all parts of a shape. */
typedef struct Gathering {
    Elaboration *e;
    Graph       *graph;
    Extents     *extents;
} Gathering;

static const double SAME = 1e-12;

/* ---- places ---- */

static Placing placing_identity(Graph *g)
{
    Placing identity = {.shift = graph_vec3(g, 0, 0, 0), .scale = graph_number(g, 1)};
    for (int i = 0; i < 3; i++)
        identity.columns[i] = graph_vec3(g, i == 0, i == 1, i == 2);
    return identity;
}

static Node place_direction(Graph *g, const Placing *placing, Node direction)
{
    Node sum = NODE_NONE;
    for (uint32_t i = 0; i < 3; i++) {
        Node part = stretch(g, placing->columns[i], graph_component(g, direction, i));
        sum       = i ? plus(g, sum, part) : part;
    }
    return sum;
}

static Node place_point(Graph *g, const Placing *placing, Node point)
{
    return plus(g, place_direction(g, placing, point), placing->shift);
}

/* Returns placing(inner(x)). */
static Placing placing_product(Graph *g, const Placing *placing, const Placing *inner)
{
    bool    even    = placing->scale != NODE_NONE && inner->scale != NODE_NONE;
    Placing product = {.shift = place_point(g, placing, inner->shift),
                       .scale = even ? times(g, placing->scale, inner->scale) : NODE_NONE};
    for (int i = 0; i < 3; i++)
        product.columns[i] = place_direction(g, placing, inner->columns[i]);
    return product;
}

static Placing placing_of_map(Graph *g, const Map *map)
{
    Placing placing = {.shift = map->shift, .scale = map->scale};
    for (uint32_t i = 0; i < 3; i++) {
        Node entries[3];
        for (uint32_t k = 0; k < 3; k++)
            entries[k] = graph_component(g, map->rows[k], i);
        placing.columns[i] = stretch(g, graph_op(g, OP_vec3, entries), map->scale);
    }
    return placing;
}

static Placing placing_of_stretch(Graph *g, Node factors)
{
    Placing placing = placing_identity(g);
    placing.scale   = NODE_NONE;
    for (uint32_t i = 0; i < 3; i++)
        placing.columns[i] = stretch(g, placing.columns[i], graph_component(g, factors, i));
    return placing;
}

/* Returns x -> x - 2 (dot(normal, x) - offset) normal. */
static Placing placing_of_mirror(Graph *g, Node normal, Node offset)
{
    Placing placing = placing_identity(g);
    Node    twice   = stretch(g, normal, graph_number(g, 2));
    for (uint32_t i = 0; i < 3; i++)
        placing.columns[i] = sub(g, placing.columns[i],
                                 stretch(g, twice, graph_component(g, normal, i)));
    placing.shift = stretch(g, twice, offset);
    return placing;
}

/* ---- features ---- */

/* Tells whether two unit vectors are one, or opposite to each other. */
static bool are_parallel(const Graph *g, Node a, Node b)
{
    double u[3], v[3], across[3];
    if (a == b)
        return true;
    if (!graph_known_components(g, a, 3, u) || !graph_known_components(g, b, 3, v))
        return false;
    cross3(u, v, across);
    return length3(across) <= SAME;
}

static void add_face(const Gathering *g, Node normal)
{
    for (size_t i = 0; i < g->extents->faces.count; i++)
        if (are_parallel(g->graph, g->extents->faces.items[i], normal))
            return;
    array_push(g->e->values, &g->extents->faces, normal);
}

static void add_axis(const Gathering *g, Node on, Node along)
{
    double first[3], second[3], offset[3], u[3], across[3];
    for (size_t i = 0; i < g->extents->axes.count; i++) {
        const ExtentLine *known = &g->extents->axes.items[i];
        if (!are_parallel(g->graph, known->along, along))
            continue;
        if (known->on == on)
            return;
        if (!graph_known_components(g->graph, known->on, 3, first) ||
            !graph_known_components(g->graph, on, 3, second) ||
            !graph_known_components(g->graph, along, 3, u))
            continue;
        add_scaled3(offset, second, -1, first);
        cross3(offset, u, across);
        if (length3(across) <= SAME * (length3(first) + length3(second)))
            return;
    }
    array_push(g->e->values, &g->extents->axes, ((ExtentLine){on, along}));
}

/* Adds the images of the planes between the axes. */
static void add_faces(const Gathering *g, const Placing *placing, bool figure)
{
    for (int i = 0; i < (figure ? 2 : 3); i++) {
        Node across = graph_op2(g->graph, OP_cross, placing->columns[(i + 1) % 3],
                                placing->columns[(i + 2) % 3]);
        add_face(g, graph_op1(g->graph, OP_normalize, across));
    }
}

/* ---- parts ---- */

static void add_extent(const Gathering *g, const Placing *placing, Extent part, Node grown)
{
    Graph *graph  = g->graph;
    Extent placed = {.centre = place_point(graph, placing, part.centre), .rim = NODE_NONE};
    placed.radius = placing->scale == NODE_NONE ? graph_number(graph, 0)
                                                : times(graph, part.radius, placing->scale);
    placed.radius = plus(graph, placed.radius, grown);
    if (part.rim != NODE_NONE)
        placed.rim = place_direction(graph, placing, part.rim);
    array_push(g->e->values, g->extents, placed);
}

static Node corner_side(Graph *g, const Shape *shape, int side, uint32_t axis)
{
    const Range range = shape->box.axis[axis];
    if (shape->corners[side] != NODE_NONE)
        return graph_component(g, shape->corners[side], axis);
    return graph_number(g, side ? range.high : range.low);
}

/* Adds the corners of its box. */
static void add_box(const Gathering *g, const Shape *shape, const Placing *placing, Node grown)
{
    Graph *graph = g->graph;
    Node   zero  = graph_number(graph, 0);
    if (box_is_empty(shape->box))
        return;
    if (!box_is_finite(shape->box)) {
        g->extents->endless = true;
        return;
    }
    add_faces(g, placing, shape->figure);
    for (int corner = 0; corner < (shape->figure ? 4 : 8); corner++) {
        Node sides[3] = {zero, zero, zero};
        for (uint32_t k = 0; k < (shape->figure ? 2 : 3); k++)
            sides[k] = corner_side(graph, shape, corner >> k & 1, k);
        add_extent(g, placing, (Extent){graph_op(graph, OP_vec3, sides), zero, NODE_NONE}, grown);
    }
}

/* Reads `[centre, radius]` or `[centre, radius, rim]`. */
static bool read_extent(Elaboration *e, Value value, Extent *part)
{
    Graph *g = e->graph;
    if (value.type != VALUE_LIST || value.list->count < 2 || value.list->count > 3)
        return false;
    const Value *items = value.list->items;
    uint32_t     size  = value_size(e, items[0]);
    bool         rim   = value.list->count == 3;
    if (size < 2 || size > 3 || value_size(e, items[1]) != 1 ||
        value_time(e, value) == TIME_POINT || (rim && value_size(e, items[2]) != 3))
        return false;
    *part = (Extent){value_node(e, items[0]), value_node(e, items[1]), NODE_NONE};
    if (size == 2) {
        Node x = graph_component(g, part->centre, 0), y = graph_component(g, part->centre, 1);
        part->centre = graph_op3(g, OP_vec3, x, y, graph_number(g, 0));
    }
    if (rim)
        part->rim = value_node(e, items[2]);
    return true;
}

/* Adds the axes about which the parts are round: through two balls of one size, or of rims. */
static void add_axes(const Gathering *g, size_t first)
{
    Graph        *graph = g->graph;
    const Extent *parts = g->extents->items + first;
    const size_t  count = g->extents->count - first;
    if (count == 1 && parts[0].rim == NODE_NONE)
        array_push(g->e->values, &g->extents->centres, parts[0].centre);
    for (size_t i = 0; i < count; i++) {
        if (parts[i].rim == NODE_NONE)
            continue;
        Node along = graph_op1(graph, OP_normalize, parts[i].rim);
        add_face(g, along);
        add_axis(g, parts[i].centre, along);
    }
    if (count == 2 && parts[0].rim == NODE_NONE && parts[1].rim == NODE_NONE &&
        parts[0].radius == parts[1].radius) {
        Node along = sub(graph, parts[1].centre, parts[0].centre);
        add_axis(g, parts[0].centre, graph_op1(graph, OP_normalize, along));
    }
}

/* Adds the extents that a declaration of the library states; claims of others are checked by `hull`
   alone. */
static bool add_declared(const Gathering *g, const Shape *shape, const Placing *placing, Node grown)
{
    Elaboration *e = g->e;
    if (!shape->declaration || !shape->declaration->hull || !is_of_library(e, shape))
        return false;
    const Value list = declared_hull(e, shape);
    if (list.type != VALUE_LIST || list.list->count == 0)
        return false;
    Extent *parts = arena_new_array(e->values, Extent, list.list->count);
    for (size_t i = 0; i < list.list->count; i++) {
        if (!read_extent(e, list.list->items[i], &parts[i]))
            return false;
        if (placing->scale == NODE_NONE &&
            (parts[i].rim != NODE_NONE || !is_number(g->graph, parts[i].radius, 0)))
            return false;
    }
    const size_t first = g->extents->count;
    for (size_t i = 0; i < list.list->count; i++)
        add_extent(g, placing, parts[i], grown);
    if (list.list->count > 1 || parts[0].rim != NODE_NONE)
        add_faces(g, placing, shape->figure);
    add_axes(g, first);
    return true;
}

static bool add_half_space(const Gathering *g, const Shape *shape, const Placing *placing,
                           Node grown)
{
    Graph *graph = g->graph;
    Node   normal, offset;
    if (placing->scale == NODE_NONE || !shape_plane(g->e->builder, shape, &normal, &offset))
        return false;
    Node on    = place_point(graph, placing, stretch(graph, normal, offset));
    Node along = graph_op1(graph, OP_normalize, place_direction(graph, placing, normal));
    on         = plus(graph, on, stretch(graph, along, grown));
    array_push(g->e->values, &g->extents->half_spaces, ((ExtentLine){on, along}));
    return true;
}

/* Adds the extents of a shape that is placed; `grown` is added to all radii. */
static void add_shape(const Gathering *g, const Shape *shape, const Placing *placing, Node grown);

static void add_children(const Gathering *g, const Shape *shape, uint32_t count,
                         const Placing *placing, Node grown)
{
    for (uint32_t i = 0; i < count; i++)
        add_shape(g, shape->children[i], placing, grown);
}

/* Adds a shape that is grown by `by`, which a distance less than the true one does not tell. */
static void add_grown(const Gathering *g, const Shape *shape, const Placing *placing, Node by,
                      Node grown)
{
    if (placing->scale == NODE_NONE || !shape->children[0]->exact ||
        node_range(g->e->builder, by, 0).low < 0) {
        add_box(g, shape, placing, grown);
        return;
    }
    add_children(g, shape, 1, placing, plus(g->graph, grown, times(g->graph, by, placing->scale)));
}

/* Finds the extents of a figure by themselves; false: they are not all balls of numbers that a
   solid can have. */
static bool flat_extents(const Gathering *g, const Shape *figure, Extents *flat)
{
    flat->figure = true;
    extents_add(g->e, figure, flat);
    return !flat->endless && flat->half_spaces.count == 0;
}

/* A disc becomes a cylinder, and so two rims. */
static void add_extruded(const Gathering *g, const Shape *shape, const Placing *placing, Node grown)
{
    Graph       *graph = g->graph;
    const size_t first = g->extents->count;
    Extents      flat  = {0};
    bool         good  = flat_extents(g, shape->children[0], &flat);
    for (size_t i = 0; i < flat.count; i++)
        good = good && (placing->scale != NODE_NONE || is_number(graph, flat.items[i].radius, 0));
    if (!good) {
        add_box(g, shape, placing, grown);
        return;
    }
    Node zero = graph_number(graph, 0), low = neg(graph, shape->values[0]);
    for (size_t i = 0; i < 2 * flat.count; i++) {
        const Extent *disc = &flat.items[i / 2];
        Node          x    = graph_component(graph, disc->centre, 0);
        Node          y    = graph_component(graph, disc->centre, 1);
        Node          z    = i % 2 ? shape->values[0] : low;
        Extent        end  = {graph_op3(graph, OP_vec3, x, y, z), zero, NODE_NONE};
        if (!is_number(graph, disc->radius, 0))
            end.rim = graph_op3(graph, OP_vec3, zero, zero, disc->radius);
        add_extent(g, placing, end, grown);
    }
    add_faces(g, placing, false);
    for (size_t i = 0; i < flat.faces.count; i++) {
        Node rotated = place_direction(graph, placing, flat.faces.items[i]);
        if (placing->scale != NODE_NONE)
            add_face(g, graph_op1(graph, OP_normalize, rotated));
    }
    add_axes(g, first);
}

/* A disc becomes a ring. */
static void add_revolved(const Gathering *g, const Shape *shape, const Placing *placing, Node grown)
{
    Graph       *graph = g->graph;
    const size_t first = g->extents->count;
    Extents      flat  = {0};
    if (placing->scale == NODE_NONE || !flat_extents(g, shape->children[0], &flat)) {
        add_box(g, shape, placing, grown);
        return;
    }
    Node zero = graph_number(graph, 0);
    for (size_t i = 0; i < flat.count; i++) {
        const Extent *disc = &flat.items[i];
        Node          x    = graph_component(graph, disc->centre, 0);
        Node          y    = graph_component(graph, disc->centre, 1);
        Node          away = graph_op1(graph, OP_abs, plus(graph, x, shape->values[0]));
        Extent        ring = {graph_op3(graph, OP_vec3, zero, y, zero), disc->radius, NODE_NONE};
        if (!is_number(graph, away, 0))
            ring.rim = graph_op3(graph, OP_vec3, zero, away, zero);
        add_extent(g, placing, ring, grown);
    }
    add_axes(g, first);
}

static void add_mirrored(const Gathering *g, const Shape *shape, const Placing *placing, Node grown)
{
    const Placing mirror = placing_of_mirror(g->graph, shape->values[0], shape->values[1]);
    const Placing image  = placing_product(g->graph, placing, &mirror);
    add_shape(g, shape->children[0], placing, grown);
    add_shape(g, shape->children[0], &image, grown);
}

static void add_shape(const Gathering *g, const Shape *shape, const Placing *placing, Node grown)
{
    Graph  *graph = g->graph;
    Placing inner;
    switch (shape->kind) {
    case SHAPE_EMPTY: return;
    case SHAPE_PRIMITIVE:
        if (!add_half_space(g, shape, placing, grown) && !add_declared(g, shape, placing, grown))
            add_box(g, shape, placing, grown);
        return;
    case SHAPE_EXTRUDE: add_extruded(g, shape, placing, grown); return;
    case SHAPE_REVOLVE: add_revolved(g, shape, placing, grown); return;
    case SHAPE_MIRROR: add_mirrored(g, shape, placing, grown); return;
    case SHAPE_OFFSET: add_grown(g, shape, placing, shape->values[0], grown); return;
    case SHAPE_TRANSFORM: inner = placing_of_map(graph, &shape->map); break;
    case SHAPE_STRETCH: inner = placing_of_stretch(graph, shape->values[0]); break;
    case SHAPE_ITERATION:
        shape = iteration_alone(g->e, shape);
        if (shape)
            add_shape(g, shape, placing, grown);
        return;
    case SHAPE_DIFFERENCE: add_children(g, shape, 1, placing, grown); return;
    case SHAPE_CLIP: /* of a CSG node that does not leave the hull of its parts */
        add_children(g, shape->children[0], shape->children[0]->child_count, placing, grown);
        return;
    case SHAPE_UNION:
        if (shape->blend.width != NODE_NONE) {
            add_box(g, shape, placing, grown);
            return;
        }
        add_children(g, shape, shape->child_count, placing, grown);
        return;
    case SHAPE_CHOICE:
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: add_children(g, shape, shape->child_count, placing, grown); return;
    default: add_box(g, shape, placing, grown); return;
    }
    inner = placing_product(graph, placing, &inner);
    add_children(g, shape, 1, &inner, grown);
}

void extents_add(Elaboration *e, const Shape *shape, Extents *extents)
{
    const Gathering g        = {e, e->graph, extents};
    const Placing   identity = placing_identity(e->graph);
    extents->figure          = shape->figure;
    add_shape(&g, shape, &identity, graph_number(e->graph, 0));
}

/* ---- of two shapes ---- */

static void add_lines(Elaboration *e, ExtentLines *to, const ExtentLines *from)
{
    for (size_t i = 0; i < from->count; i++)
        array_push(e->values, to, from->items[i]);
}

Extents extents_of_both(Elaboration *e, const Extents *a, const Extents *b)
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

/* ---- how far they reach ---- */

static Node greater(Graph *g, Node a, Node b)
{
    return a == NODE_NONE ? b : graph_op2(g, OP_max, a, b);
}

Node extents_along(Elaboration *e, const Extents *extents, Node along)
{
    Graph *g    = e->graph;
    Node   most = NODE_NONE;
    for (size_t i = 0; i < extents->half_spaces.count; i++) {
        const ExtentLine *half = &extents->half_spaces.items[i];
        double            u[3], v[3];
        const bool        known = graph_known_components(g, half->along, 3, u) &&
                           graph_known_components(g, along, 3, v);
        if (half->along != along && !(known && distance3(u, v) <= SAME))
            return NODE_NONE;
        most = greater(g, most, graph_op2(g, OP_dot, along, half->on));
    }
    for (size_t i = 0; i < extents->count; i++) {
        const Extent *part   = &extents->items[i];
        Node          centre = graph_op2(g, OP_dot, along, part->centre);
        Node          reach  = plus(g, centre, part->radius);
        if (part->rim != NODE_NONE) {
            Node size = graph_op2(g, OP_dot, part->rim, part->rim);
            Node lost = graph_op1(g, OP_square, graph_op2(g, OP_dot, part->rim, along));
            Node left = at_least(g, sub(g, size, lost), 0);
            reach     = plus(g, reach, graph_op1(g, OP_sqrt, left));
        }
        most = greater(g, most, reach);
    }
    return most;
}

/* Returns the part of an offset across a unit vector. */
static Node across(Graph *g, Node offset, Node along)
{
    return sub(g, offset, stretch(g, along, graph_op2(g, OP_dot, offset, along)));
}

Node extents_about(Elaboration *e, const Extents *extents, ExtentLine axis)
{
    Graph *g    = e->graph;
    Node   most = NODE_NONE;
    for (size_t i = 0; i < extents->count; i++) {
        const Extent *part   = &extents->items[i];
        Node          offset = across(g, sub(g, part->centre, axis.on), axis.along);
        Node          reach  = plus(g, graph_op1(g, OP_length, offset), part->radius);
        if (part->rim != NODE_NONE)
            reach = plus(g, reach, graph_op1(g, OP_length, part->rim));
        most = greater(g, most, reach);
    }
    return most;
}

Node extents_from(Elaboration *e, const Extents *extents, Node centre)
{
    Graph *g    = e->graph;
    Node   most = NODE_NONE;
    for (size_t i = 0; i < extents->count; i++) {
        const Extent *part   = &extents->items[i];
        Node          offset = sub(g, part->centre, centre);
        Node          reach  = graph_op1(g, OP_length, offset);
        if (part->rim != NODE_NONE) { /* the farthest point of the circle is beyond its centre */
            Node axis   = graph_op1(g, OP_normalize, part->rim);
            Node aside  = graph_op1(g, OP_length, across(g, offset, axis));
            Node rim    = graph_op1(g, OP_length, part->rim);
            Node height = graph_op2(g, OP_dot, offset, axis);
            reach = graph_op1(g, OP_length, graph_op2(g, OP_vec2, plus(g, aside, rim), height));
        }
        most = greater(g, most, plus(g, reach, part->radius));
    }
    return most;
}

bool extents_box(Elaboration *e, const Extents *extents, Node corners[2])
{
    Node sides[2][3];
    bool bounded = true;
    for (int k = 0; k < 6; k++) {
        const double sign   = k / 3 ? 1 : -1;
        const Node   along  = graph_vec3(e->graph, k % 3 == 0 ? sign : 0, k % 3 == 1 ? sign : 0,
                                      k % 3 == 2 ? sign : 0);
        const Node   most   = extents_along(e, extents, along);
        bounded             = bounded && most != NODE_NONE;
        sides[k / 3][k % 3] = !bounded || k / 3 ? most : neg(e->graph, most);
    }
    for (int i = 0; i < 2; i++)
        corners[i] = bounded ? graph_op(e->graph, OP_vec3, sides[i]) : NODE_NONE;
    return bounded;
}
