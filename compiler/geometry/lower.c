/*
 * lower.c: from shapes to nodes of the graph.
 *
 * Going down the tree the point is mapped into each shape's own space; going up, distances are
 * joined.  The same walk makes the distance alone, which is what is marched, and the distance
 * with all that a hit needs (material, level, instance), which is evaluated once per hit.
 *
 * Distances are 1-Lipschitz up to the slope that make.c derived, by which the root divides.
 * Where only sharp joints and maps of space lie above a primitive, its sharper `bound` serves:
 * it need not be Lipschitz, only never exceed the distance.
 */
#include "compiler/geometry/lowering.h"

#include <assert.h>
#include <math.h>

#include "compiler/graph/derive.h"
#include "compiler/graph/evaluate.h"

/* Farther than any scene: the distance to nothing.  Finite, so that sums stay numbers. */
static const double NOWHERE = 1e30;

const Lowered lowered_nothing = {NODE_NONE,
                                 {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE,
                                  NODE_NONE, NODE_NONE, NODE_NONE}};

Place place_bare(Node point, bool lipschitz)
{
    return (Place){point, NODE_NONE, NODE_NONE, lipschitz, NODE_NONE, NODE_NONE, NODE_NONE};
}

Place place_at(Place place, Node point)
{
    place.point = point;
    return place;
}

Place place_steady(Place place)
{
    place.lipschitz = true;
    return place;
}

/* ---- surfaces ---- */

Node choose(Graph *g, Node condition, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_select, condition, a, b);
}

static Surface choose_surface(Graph *g, Node condition, Surface a, Surface b)
{
    return (Surface){choose(g, condition, a.color, b.color),
                     choose(g, condition, a.roughness, b.roughness),
                     choose(g, condition, a.metallic, b.metallic),
                     choose(g, condition, a.emission, b.emission),
                     choose(g, condition, a.level, b.level),
                     choose(g, condition, a.instance, b.instance),
                     choose(g, condition, a.uv, b.uv),
                     choose(g, condition, a.normal, b.normal),
                     choose(g, condition, a.trap, b.trap)};
}

/* Weight 1 is a. */
static Node mix_nodes(Graph *g, Node a, Node b, Node weight)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_mix, b, a, weight);
}

/* Materials blend with the shapes; numbers of levels and instances cannot, nor can coordinates. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b)
{
    return (Surface){mix_nodes(g, a.color, b.color, weight),
                     mix_nodes(g, a.roughness, b.roughness, weight),
                     mix_nodes(g, a.metallic, b.metallic, weight),
                     mix_nodes(g, a.emission, b.emission, weight),
                     choose(g, nearer, a.level, b.level),
                     choose(g, nearer, a.instance, b.instance),
                     choose(g, nearer, a.uv, b.uv),
                     mix_nodes(g, a.normal, b.normal, weight),
                     choose(g, nearer, a.trap, b.trap)};
}

/* ---- joints ---- */

static Node join_distances(Graph *g, Blend blend, Node a, Node b)
{
    if (blend.width == NODE_NONE)
        return graph_op2(g, OP_min, a, b);
    Node operands[MAX_OPERANDS] = {a, b, blend.width, blend.steps};
    return graph_op(g, blend_info[blend.kind].op, operands);
}

/* The union of two distances, sharp or blended. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b)
{
    Graph *g = l->graph;
    if (a.distance == NODE_NONE)
        return b;
    if (b.distance == NODE_NONE)
        return a;
    Lowered joined  = lowered_nothing;
    joined.distance = join_distances(g, blend, a.distance, b.distance);
    if (!l->surfaces)
        return joined;
    Node nearer = graph_op2(g, OP_less, a.distance, b.distance);
    if (blend.width == NODE_NONE)
        joined.surface = choose_surface(g, nearer, a.surface, b.surface);
    else {
        Node weight    = graph_op3(g, OP_blend_weight, a.distance, b.distance, blend.width);
        joined.surface = mix_surface(g, nearer, weight, a.surface, b.surface);
    }
    return joined;
}

static Lowered complement(Lowering *l, Lowered a)
{
    if (a.distance != NODE_NONE)
        a.distance = graph_op1(l->graph, OP_neg, a.distance);
    return a;
}

/* A blend moves the zero set. */
static Place joint_place(const Shape *shape, Place place)
{
    return shape->blend.width == NODE_NONE ? place : place_steady(place);
}

Node beyond_sides(Graph *g, Node point, Box box)
{
    Node most = NODE_NONE;
    for (uint32_t i = 0; i < 3; i++) {
        Range side = box.axis[i];
        if (!isfinite(side.low) || !isfinite(side.high) || side.low >= side.high)
            continue;
        Node middle = graph_number(g, 0.5 * (side.low + side.high));
        Node half   = graph_number(g, 0.5 * (side.high - side.low));
        Node away   = graph_op2(g, OP_sub, graph_component(g, point, i), middle);
        Node beyond = graph_op2(g, OP_sub, graph_op1(g, OP_abs, away), half);
        most        = most == NODE_NONE ? beyond : graph_op2(g, OP_max, most, beyond);
    }
    return most;
}

/* What is only a bound may be small far from the shape; the distance to the sides of its box is a
   bound as well, and with it the place where it is r lies within r of the box, as the boxes of make.c
   say. */
Lowered lower_operand(Lowering *l, const Shape *shape, Place place)
{
    Lowered result = lower_shape(l, shape, place_steady(place));
    if (result.distance == NODE_NONE || shape->exact)
        return result;
    Node beyond = beyond_sides(l->graph, place.point, shape->box);
    if (beyond != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_max, result.distance, beyond);
    return result;
}

static Lowered lower_joined(Lowering *l, const Shape *joint, const Shape *child, Place place)
{
    return joint->blend.width == NODE_NONE ? lower_shape(l, child, place)
                                           : lower_operand(l, child, place);
}

/* Joined in pairs, so that the graph stays shallow and a blend of many keeps its slope. */
static Lowered union_of(Lowering *l, const Shape *shape, const Shape *const *children,
                        uint32_t count, Place place)
{
    if (count == 0)
        return lowered_nothing;
    if (count == 1)
        return lower_joined(l, shape, children[0], place);
    uint32_t half  = count / 2;
    Lowered  left  = union_of(l, shape, children, half, place);
    Lowered  right = union_of(l, shape, children + half, count - half, place);
    return join_two(l, shape->blend, left, right);
}

static Lowered lower_union(Lowering *l, const Shape *shape, Place place)
{
    return union_of(l, shape, shape->children, shape->child_count, place);
}

static Lowered lower_intersection(Lowering *l, const Shape *shape, Place place)
{
    /* The complement of the union of the complements. */
    Lowered all = lower_joined(l, shape, shape->children[0], place);
    for (uint32_t i = 1; i < shape->child_count; i++) {
        Lowered next = lower_joined(l, shape, shape->children[i], place);
        if (all.distance == NODE_NONE || next.distance == NODE_NONE)
            return lowered_nothing;
        Lowered joined = join_two(l, shape->blend, complement(l, all), complement(l, next));
        all            = complement(l, joined);
    }
    return all;
}

static Lowered lower_difference(Lowering *l, const Shape *shape, Place place)
{
    Lowered left  = lower_joined(l, shape, shape->children[0], place);
    Lowered right = union_of(l, shape, shape->children + 1, shape->child_count - 1, place);
    if (left.distance == NODE_NONE || right.distance == NODE_NONE)
        return left;
    Lowered joined = join_two(l, shape->blend, complement(l, left), right);
    return complement(l, joined);
}

/* What is in one of two: their union less what they share. */
static Lowered lower_xor(Lowering *l, const Shape *shape, Place place)
{
    Lowered a = lower_joined(l, shape, shape->children[0], place);
    Lowered b = lower_joined(l, shape, shape->children[1], place);
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return join_two(l, shape->blend, a, b);
    Lowered result = join_two(l, shape->blend, a, b);
    /* What they share is the complement of: */
    Lowered shared  = join_two(l, shape->blend, complement(l, a), complement(l, b));
    result.distance = graph_op2(l->graph, OP_max, result.distance, shared.distance);
    return result;
}

static Lowered lower_morph(Lowering *l, const Shape *shape, Place place)
{
    Lowered a = lower_shape(l, shape->children[0], place_steady(place));
    Lowered b = lower_shape(l, shape->children[1], place_steady(place));
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return a.distance == NODE_NONE ? b : a;
    Graph  *g       = l->graph;
    Lowered result  = lowered_nothing;
    Node    one     = graph_number(g, 1);
    Node    weight  = graph_op2(g, OP_sub, one, shape->values[0]);
    result.distance = graph_op3(g, OP_mix, a.distance, b.distance, shape->values[0]);
    if (l->surfaces) {
        Node half      = graph_number(g, 0.5);
        Node nearer    = graph_op2(g, OP_less, shape->values[0], half);
        result.surface = mix_surface(g, nearer, weight, a.surface, b.surface);
    }
    return result;
}

/* ---- maps of space ---- */

/* R^T (point - shift) / scale: where the point was before the map. */
Node before_map(Graph *g, const Map *map, Node point)
{
    Node rows[3];
    transpose_rows(g, map->rows, rows);
    Node moved  = graph_op2(g, OP_sub, point, map->shift);
    Node turned = moved;
    Node e0 = graph_vec3(g, 1, 0, 0), e1 = graph_vec3(g, 0, 1, 0), e2 = graph_vec3(g, 0, 0, 1);
    if (rows[0] != e0 || rows[1] != e1 || rows[2] != e2)
        turned = graph_op4(g, OP_turn, moved, rows[0], rows[1], rows[2]);
    Node one = graph_number(g, 1);
    if (map->scale == one)
        return turned;
    Node factor = graph_op2(g, OP_div, one, map->scale);
    return graph_op2(g, OP_scale, turned, factor);
}

Lowered scale_distance(Lowering *l, Lowered result, Node factor)
{
    if (result.distance != NODE_NONE && factor != graph_number(l->graph, 1))
        result.distance = graph_op2(l->graph, OP_mul, result.distance, factor);
    return result;
}

Lowered lower_behind(Lowering *l, const Shape *child, Place place, const NormalPath *path,
                     Node point)
{
    Lowered result        = lower_shape(l, child, place_behind(path, place, point));
    result.surface.normal = normal_out(l, path, result.surface.normal);
    return result;
}

Node enter_scale(Lowering *l, Node scale)
{
    Node unit = l->unit;
    if (l->guarded)
        l->unit = graph_op2(l->graph, OP_mul, unit, scale);
    return unit;
}

static Lowered lower_transform(Lowering *l, const Shape *shape, Place place)
{
    NormalPath path  = normal_path(l, place, 1);
    Node       point = before_map(l->graph, &shape->map, place.point);
    normal_turn(l, &path, shape->map.rows, shape->map.scale);
    Node    unit   = enter_scale(l, shape->map.scale);
    Lowered result = lower_behind(l, shape->children[0], place, &path, point);
    l->unit        = unit;
    return scale_distance(l, result, shape->map.scale);
}

static Lowered lower_stretch(Lowering *l, const Shape *shape, Place place)
{
    Graph *g = l->graph;
    Node   x = graph_component(g, shape->values[0], 0), y = graph_component(g, shape->values[0], 1);
    Node   z         = graph_component(g, shape->values[0], 2);
    Node   least     = graph_op2(g, OP_min, x, y);
    least            = graph_op2(g, OP_min, least, z);
    Node       point = graph_op2(g, OP_div, place.point, shape->values[0]);
    NormalPath path  = normal_path(l, place, 1);
    normal_stretch(l, &path, shape->values[0], least);
    Node    unit   = enter_scale(l, least);
    Lowered result = lower_behind(l, shape->children[0], place, &path, point);
    l->unit        = unit;
    return scale_distance(l, result, least);
}

static Lowered lower_mirror(Lowering *l, const Shape *shape, Place place)
{
    NormalPath path = normal_path(l, place, 1);
    normal_fold(l, &path, place.point, shape->values[0], shape->values[1]);
    Node point = graph_op3(l->graph, OP_fold, place.point, shape->values[0], shape->values[1]);
    return lower_behind(l, shape->children[0], place, &path, point);
}

/* The last of a chain counts, as with paint. */
static Lowered lower_smooth(Lowering *l, const Shape *shape, Place place)
{
    if (l->surfaces && place.smoothing == NODE_NONE)
        place.smoothing = shape->values[0] != NODE_NONE
                              ? shape->values[0]
                              : graph_op2(l->graph, OP_add, place.footprint, place.footprint);
    return lower_shape(l, shape->children[0], place);
}

static Lowered lower_elongate(Lowering *l, const Shape *shape, Place place)
{
    Graph *g      = l->graph;
    Node   low    = graph_op1(g, OP_neg, shape->values[0]);
    Node   inside = graph_op3(g, OP_clamp, place.point, low, shape->values[0]);
    Node   point  = graph_op2(g, OP_sub, place.point, inside);
    return lower_shape(l, shape->children[0], place_at(place, point));
}
Node box_distance(Graph *g, Node point, Box box)
{
    double centre[3], half[3];
    box_centre(box, centre);
    for (int i = 0; i < 3; i++)
        half[i] = 0.5 * (box.axis[i].high - box.axis[i].low);
    Node middle  = graph_constant(g, TYPE_VEC3, centre);
    Node sides   = graph_constant(g, TYPE_VEC3, half);
    Node local   = graph_op2(g, OP_sub, point, middle);
    Node size    = graph_op1(g, OP_abs, local);
    Node excess  = graph_op2(g, OP_sub, size, sides);
    Node zero    = graph_number(g, 0);
    Node outside = graph_op2(g, OP_max, excess, zero);
    return graph_op1(g, OP_length, outside);
}

/* ---- figures made solid ---- */

static Lowered lower_extrude(Lowering *l, const Shape *shape, Place place)
{
    Graph  *g = l->graph;
    Node    x = graph_component(g, place.point, 0), y = graph_component(g, place.point, 1);
    Node    zero   = graph_number(g, 0);
    Node    flat   = graph_op3(g, OP_vec3, x, y, zero);
    Lowered result = lower_shape(l, shape->children[0], place_at(place, flat));
    if (result.distance == NODE_NONE)
        return result;
    Node height     = graph_component(g, place.point, 2);
    height          = graph_op1(g, OP_abs, height);
    height          = graph_op2(g, OP_sub, height, shape->values[0]);
    Node inside     = graph_op2(g, OP_max, result.distance, height);
    inside          = graph_op2(g, OP_min, inside, zero);
    Node across     = graph_op2(g, OP_max, result.distance, zero);
    Node along      = graph_op2(g, OP_max, height, zero);
    Node outside    = graph_op2(g, OP_vec2, across, along);
    outside         = graph_op1(g, OP_length, outside);
    result.distance = graph_op2(g, OP_add, inside, outside);
    return result;
}

static Lowered lower_revolve(Lowering *l, const Shape *shape, Place place)
{
    Graph *g = l->graph;
    Node   x = graph_component(g, place.point, 0), y = graph_component(g, place.point, 1);
    Node   z        = graph_component(g, place.point, 2);
    Node   axis     = graph_op2(g, OP_vec2, x, z);
    Node   away     = graph_op1(g, OP_length, axis);
    away            = graph_op2(g, OP_sub, away, shape->values[0]);
    Node       zero = graph_number(g, 0);
    Node       flat = graph_op3(g, OP_vec3, away, y, zero);
    NormalPath path = normal_path(l, place, 1);
    normal_turn_about_y(l, &path, place.point, graph_vec3(g, 1, 0, 0));
    return lower_behind(l, shape->children[0], place, &path, flat);
}

/* ---- leaves, paint, and the walk ---- */

/* A number with this value and this gradient: with n and the rest w held still, dot(n, q) + w
   changes with the point q as a plane does. */
static Node with_gradient(Lowering *l, Node value, Node n, Node point)
{
    Graph *g     = l->graph;
    Node   along = graph_op2(g, OP_dot, n, point);
    Node   w     = graph_op2(g, OP_sub, value, along);
    array_push(l->scratch, l->still, n);
    array_push(l->scratch, l->still, w);
    return graph_op2(g, OP_add, along, w);
}

/* What has a formula f has its gradient from that: the bound by which it is marched costs many
   times as much.  NODE_NONE: the formula has no derivative. */
static Node tangent_by_formula(Lowering *l, const Shape *shape, Place place)
{
    Graph       *g    = l->graph;
    Substitution with = substitute_point(place.point);
    Node         gradient;
    if (graph_gradient(g, shape->formula, &gradient, NULL, l->scratch) == DERIVED_NOT)
        return NODE_NONE;
    gradient   = graph_substitute(g, gradient, with, l->scratch);
    Node f     = graph_substitute(g, shape->formula, with, l->scratch);
    Node n     = graph_op1(g, OP_normalize, gradient);
    Node steep = graph_op1(g, OP_length, gradient);
    steep      = graph_op2(g, OP_max, steep, graph_number(g, 1e-30));
    return with_gradient(l, graph_op2(g, OP_div, f, steep), n, place.point);
}

/* Whether a distance is the length of a vector that vanishes at the surface, with a sign: rounding
   decides which way that vector points. */
static bool is_signed_length(const Graph *g, Node distance)
{
    const Expr *e = &g->items[distance];
    for (int i = 0; e->op == OP_mul && i < 2; i++) {
        Op size = (Op)g->items[e->operands[i]].op;
        if ((size == OP_sqrt || size == OP_length) && !graph_is_constant(g, e->operands[1 - i]))
            return true;
    }
    return false;
}

/* Such a shape is looked at a thousandth of its coordinates to each side. */
static Node tangent_by_differences(Lowering *l, const Shape *shape, Place place, Node distance)
{
    Graph *g    = l->graph;
    Node   size = graph_op1(g, OP_abs, place.point), sides[3], seen[2];
    for (uint32_t i = 0; i < 3; i++)
        sides[i] = graph_component(g, size, i);
    Node step = graph_op2(g, OP_max, sides[0], sides[1]);
    step      = graph_op2(g, OP_max, step, sides[2]);
    step      = graph_op2(g, OP_add, step, graph_number(g, 0.1));
    step      = graph_op2(g, OP_mul, step, graph_number(g, 1e-3));
    for (uint32_t i = 0; i < 3; i++) {
        Node axis = graph_vec3(g, i == 0, i == 1, i == 2);
        Node away = graph_op2(g, OP_scale, axis, step);
        for (int side = 0; side < 2; side++) {
            Node point = graph_op2(g, side ? OP_sub : OP_add, place.point, away);
            seen[side] = graph_substitute(g, shape->distance, substitute_point(point), l->scratch);
        }
        sides[i] = graph_op2(g, OP_sub, seen[0], seen[1]);
    }
    Node n = graph_op1(g, OP_normalize, graph_op(g, OP_vec3, sides));
    return with_gradient(l, distance, n, place.point);
}

static Lowered lower_primitive(Lowering *l, const Shape *shape, Place place)
{
    Graph       *g    = l->graph;
    Substitution with = substitute_point(place.point);
    Lowered      leaf = lowered_nothing;
    if (l->still && shape->formula != NODE_NONE && !place.lipschitz)
        leaf.distance = tangent_by_formula(l, shape, place);
    if (leaf.distance == NODE_NONE)
        leaf.distance = graph_substitute(g, shape->distance, with, l->scratch);
    if (l->still && is_signed_length(g, shape->distance))
        leaf.distance = tangent_by_differences(l, shape, place, leaf.distance);
    if (l->still)
        return leaf;
    if (shape->bound != NODE_NONE && !place.lipschitz) {
        Node bound    = graph_substitute(g, shape->bound, with, l->scratch);
        leaf.distance = graph_op2(g, OP_max, leaf.distance, bound);
    }
    if (l->surfaces) {
        leaf.surface.level    = place.level == NODE_NONE ? graph_number(g, 0) : place.level;
        leaf.surface.instance = place.instance == NODE_NONE ? graph_uint(g, 1) : place.instance;
        leaf.surface.normal   = place.normal;
        if (shape->uv != NODE_NONE)
            leaf.surface.uv = graph_substitute(g, shape->uv, with, l->scratch);
        if (shape->trap != NODE_NONE)
            leaf.surface.trap = graph_substitute(g, shape->trap, with, l->scratch);
    }
    return leaf;
}

/* What a material leaves open stays. */
static void paint_with(Lowering *l, Node *property, Node paint, Substitution with)
{
    if (paint != NODE_NONE)
        *property = graph_substitute(l->graph, paint, with, l->scratch);
}

/* The outermost paint counts, as the last method of a chain does. */
static Lowered lower_paint(Lowering *l, const Shape *shape, Place place)
{
    Lowered result = lower_shape(l, shape->children[0], place);
    if (!l->surfaces || result.distance == NODE_NONE)
        return result;
    Substitution with = {
        place.point, result.surface.instance, result.surface.level, result.surface.uv,
        NODE_NONE,   result.surface.trap};
    const Material *material = shape->material;
    with.normal              = unit_normal(l->graph, result.surface.normal, place.normal);
    paint_with(l, &result.surface.color, material->color, with);
    paint_with(l, &result.surface.roughness, material->roughness, with);
    paint_with(l, &result.surface.metallic, material->metallic, with);
    paint_with(l, &result.surface.emission, material->emission, with);
    return result;
}

static Lowered lower_offset(Lowering *l, const Shape *shape, Place place)
{
    Lowered result = lower_operand(l, shape->children[0], place);
    if (result.distance != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_sub, result.distance, shape->values[0]);
    return result;
}

/* What is nowhere negative.  A gradient is that of the solid: it does not turn at the sheet. */
static Lowered thin_sheet(Lowering *l, Lowered solid)
{
    Graph *g    = l->graph;
    Node   size = graph_op1(g, OP_abs, solid.distance);
    if (l->still) {
        Node more = graph_op2(g, OP_sub, size, solid.distance);
        array_push(l->scratch, l->still, more);
        size = graph_op2(g, OP_add, solid.distance, more);
    }
    solid.distance = size;
    return solid;
}

static Lowered lower_shell(Lowering *l, const Shape *shape, Place place)
{
    Graph *g       = l->graph;
    bool   thin    = l->thin && shape->sheet;
    l->thin        = false;
    Lowered result = thin ? lower_shape(l, shape->children[0], place)
                          : lower_operand(l, shape->children[0], place);
    if (result.distance == NODE_NONE || thin)
        return thin && result.distance != NODE_NONE ? thin_sheet(l, result) : result;
    Node half       = graph_number(g, 0.5);
    half            = graph_op2(g, OP_mul, shape->values[0], half);
    Node size       = graph_op1(g, OP_abs, result.distance);
    result.distance = graph_op2(g, OP_sub, size, half);
    return result;
}

static Lowered lower_kind(Lowering *l, const Shape *shape, Place place)
{
    switch (shape->kind) {
    case SHAPE_EMPTY: return lowered_nothing;
    case SHAPE_PRIMITIVE: return lower_primitive(l, shape, place);
    case SHAPE_TRANSFORM: return lower_transform(l, shape, place);
    case SHAPE_INVERSION: return lower_inversion(l, shape, place);
    case SHAPE_STRETCH: return lower_stretch(l, shape, place);
    case SHAPE_UNION: return lower_union(l, shape, joint_place(shape, place));
    case SHAPE_INTERSECTION: return lower_intersection(l, shape, joint_place(shape, place));
    case SHAPE_DIFFERENCE: return lower_difference(l, shape, joint_place(shape, place));
    case SHAPE_XOR: return lower_xor(l, shape, joint_place(shape, place));
    case SHAPE_MORPH: return lower_morph(l, shape, place);
    case SHAPE_META: return lower_meta(l, shape, place);
    case SHAPE_OFFSET: return lower_offset(l, shape, place);
    case SHAPE_SHELL: return lower_shell(l, shape, place);
    case SHAPE_ELONGATE: return lower_elongate(l, shape, place);
    case SHAPE_EXTRUDE: return lower_extrude(l, shape, place);
    case SHAPE_REVOLVE: return lower_revolve(l, shape, place);
    case SHAPE_REPEAT: return lower_repeat(l, shape, place);
    case SHAPE_REPEAT_POLAR: return lower_repeat_polar(l, shape, place);
    case SHAPE_MIRROR: return lower_mirror(l, shape, place);
    case SHAPE_TWIST: return lower_twist(l, shape, place);
    case SHAPE_BEND: return lower_bend(l, shape, place);
    case SHAPE_TAPER: return lower_taper(l, shape, place);
    case SHAPE_DISPLACE: return lower_displace(l, shape, place);
    case SHAPE_SMOOTH: return lower_smooth(l, shape, place);
    case SHAPE_PAINT: return lower_paint(l, shape, place);
    case SHAPE_KRS: return lower_krs(l, shape, place);
    }
    assert(!"every kind of shape has a rule");
    return lowered_nothing;
}

bool rays_pass(const Shape *shape)
{
    switch (shape->kind) {
    case SHAPE_PRIMITIVE:
    case SHAPE_TRANSFORM:
    case SHAPE_STRETCH:
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: return true;
    case SHAPE_SHELL: return shape->sheet;
    case SHAPE_UNION:
    case SHAPE_INTERSECTION: return shape->blend.width == NODE_NONE;
    case SHAPE_DIFFERENCE:
        for (uint32_t i = 1; i < shape->child_count; i++)
            if (shape->children[i]->sheets)
                return false;
        return shape->blend.width == NODE_NONE;
    default: return false;
    }
}

bool has_thin_sheets(const Shape *shape)
{
    if (!shape->sheets || !rays_pass(shape))
        return false;
    bool found = shape->sheet;
    for (uint32_t i = 0; i < shape->child_count; i++)
        found = found || has_thin_sheets(shape->children[i]);
    return found;
}

Lowered lower_shape(Lowering *l, const Shape *shape, Place place)
{
    bool thin      = l->thin;
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow)
        return lowered_nothing;
    l->thin        = thin && rays_pass(shape);
    Lowered result = lower_kind(l, shape, place);
    l->thin        = thin;
    /* Where no mirror is smooth, the normal that came in is the one that comes out. */
    if (result.distance != NODE_NONE && place.smoothing == NODE_NONE && !shape->smooth)
        result.surface.normal = place.normal;
    if (l->visits)
        array_push(l->scratch, l->visits, ((Visit){shape, place.point, result.distance}));
    return result;
}

Node divide_by_slope(Graph *g, Node distance, double slope)
{
    if (slope <= 1 + 1e-9)
        return distance;
    Node factor = graph_number(g, 1 / slope);
    return graph_op2(g, OP_mul, distance, factor);
}

static Node or_else(Node node, Node otherwise) { return node == NODE_NONE ? otherwise : node; }

bool lower_component(Graph *graph, const Shape *shape, Arena *scratch, Node *roots)
{
    Lowering l            = {.graph    = graph,
                             .scratch  = scratch,
                             .surfaces = true,
                             .thin     = true,
                             .most     = graph->count + MOST_LOWERED};
    Place    place        = place_bare(graph_leaf(graph, OP_POINT), false);
    place.normal          = graph_leaf(graph, OP_NORMAL);
    place.footprint       = graph_leaf(graph, OP_FOOTPRINT);
    Lowered all           = lower_shape(&l, shape, place);
    Node    distance      = or_else(all.distance, graph_number(graph, NOWHERE));
    roots[ROOT_DISTANCE]  = divide_by_slope(graph, distance, shape->slope);
    roots[ROOT_COLOR]     = or_else(all.surface.color, graph_vec3(graph, 0.6, 0.6, 0.6));
    roots[ROOT_ROUGHNESS] = or_else(all.surface.roughness, graph_number(graph, 0.6));
    roots[ROOT_METALLIC]  = or_else(all.surface.metallic, graph_number(graph, 0));
    roots[ROOT_EMISSION]  = or_else(all.surface.emission, graph_vec3(graph, 0, 0, 0));
    roots[ROOT_LEVEL]     = or_else(all.surface.level, graph_number(graph, 0));
    roots[ROOT_INSTANCE]  = or_else(all.surface.instance, graph_uint(graph, 1));
    Node normal           = or_else(all.surface.normal, place.normal);
    roots[ROOT_NORMAL]    = unit_normal(graph, normal, place.normal);
    return !l.overflow;
}

Node lower_guarded(Graph *graph, const Shape *shape, Node plain, Arena *scratch)
{
    Lowering l   = {.graph   = graph,
                    .scratch = scratch,
                    .guarded = true,
                    .thin    = true,
                    .unit    = graph_number(graph, 1),
                    .most    = graph->count + MOST_LOWERED};
    Lowered  all = lower_shape(&l, shape, place_bare(graph_leaf(graph, OP_POINT), false));
    if (all.distance == NODE_NONE || l.overflow)
        return plain;
    return divide_by_slope(graph, all.distance, shape->slope);
}

/* Three derivatives a node: what is larger is looked at by differences. */
enum { MOST_DERIVED = 20000 };

bool lower_gradient(Graph *graph, const Shape *shape, Node *gradient, Node *near, Arena *scratch)
{
    Nodes    still = {0};
    Lowering l     = {.graph   = graph,
                      .scratch = scratch,
                      .still   = &still,
                      .thin    = true,
                      .most    = graph->count + MOST_DERIVED};
    Lowered  all   = lower_shape(&l, shape, place_bare(graph_leaf(graph, OP_POINT), false));
    if (all.distance == NODE_NONE || l.overflow)
        return false;
    *near     = divide_by_slope(graph, all.distance, shape->slope);
    Tape tape = tape_new(graph, near, 1, scratch);
    return tape.count <= MOST_DERIVED && graph_gradient_of(graph, *near, still.items, still.count,
                                                           gradient, NULL, scratch) != DERIVED_NOT;
}
