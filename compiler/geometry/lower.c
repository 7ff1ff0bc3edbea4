/*
 * lower.c: from shapes to nodes of the graph.
 *
 * Going down the tree the point is mapped into each shape's own space; going up, distances are
 * joined.  The same walk makes the distance alone, which is what is marched, and the distance
 * with all that a hit needs (material, level, instance), which is evaluated once per hit.
 *
 * Distances are 1-Lipschitz up to the slope that make.c derived, by which the root divides.
 * Where only sharp joints and maps of space lie above a primitive, its sharper `bound` serves:
 * it need not be Lipschitz, only never exceed the distance.  `lipschitz` says that something
 * above (a blend, an offset) moves the zero set and so needs the slope.
 */
#include "compiler/geometry/lower.h"

#include <assert.h>
#include <math.h>

#include "compiler/geometry/box.h"
#include "compiler/graph/parity.h"

enum { MOST_HEAP_MIRRORS = 31 };

/* Farther than any scene: the distance to nothing.  Finite, so that sums stay numbers. */
static const double NOWHERE = 1e30;

/* What a hit needs; NODE_NONE in `color`: not painted yet. */
typedef struct Surface {
    Node color, roughness, metallic, emission, level, instance;
} Surface;

typedef struct Lowered {
    Node    distance; /* NODE_NONE: the empty set */
    Surface surface;
} Lowered;

typedef struct Lowering {
    Graph *graph;
    Arena *scratch;
    bool   surfaces;
    size_t most; /* nodes that the graph may have */
    bool   overflow;
} Lowering;

/* Where a shape stands: the mapped point, and the sequence around it. */
typedef struct Place {
    Node point, level, instance; /* level, instance: NODE_NONE outside of sequences */
    bool lipschitz;
} Place;

static Lowered lower(Lowering *l, const Shape *shape, Place place);

static const Lowered nothing = {
    NODE_NONE, {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE}};

static Place at(Place place, Node point)
{
    place.point = point;
    return place;
}

static Place steady(Place place)
{
    place.lipschitz = true;
    return place;
}

/* ---- surfaces ---- */

static Node choose(Graph *g, Node condition, Node a, Node b)
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
                     choose(g, condition, a.instance, b.instance)};
}

/* Weight 1 is a. */
static Node mix_nodes(Graph *g, Node a, Node b, Node weight)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_mix, b, a, weight);
}

/* Materials blend with the shapes; numbers of levels and instances cannot. */
static Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b)
{
    return (Surface){mix_nodes(g, a.color, b.color, weight),
                     mix_nodes(g, a.roughness, b.roughness, weight),
                     mix_nodes(g, a.metallic, b.metallic, weight),
                     mix_nodes(g, a.emission, b.emission, weight),
                     choose(g, nearer, a.level, b.level),
                     choose(g, nearer, a.instance, b.instance)};
}

/* ---- joints ---- */

static Node join_distances(Graph *g, Blend blend, Node a, Node b)
{
    if (blend.width == NODE_NONE)
        return graph_op2(g, OP_min, a, b);
    if (blend.kind == BLEND_STAIRS)
        return graph_op4(g, OP_smin_stairs, a, b, blend.width, blend.steps);
    return graph_op3(g, blend_info[blend.kind].op, a, b, blend.width);
}

/* The union of two distances, sharp or blended. */
static Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b)
{
    Graph *g = l->graph;
    if (a.distance == NODE_NONE)
        return b;
    if (b.distance == NODE_NONE)
        return a;
    Lowered joined  = nothing;
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
    return shape->blend.width == NODE_NONE ? place : steady(place);
}

/* Joined in pairs, so that the graph stays shallow and a blend of many keeps its slope. */
static Lowered union_of(Lowering *l, const Shape *shape, const Shape *const *children,
                        uint32_t count, Place place)
{
    if (count == 0)
        return nothing;
    if (count == 1)
        return lower(l, children[0], place);
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
    Lowered all = lower(l, shape->children[0], place);
    for (uint32_t i = 1; i < shape->child_count; i++) {
        Lowered next = lower(l, shape->children[i], place);
        if (all.distance == NODE_NONE || next.distance == NODE_NONE)
            return nothing;
        Lowered joined = join_two(l, shape->blend, complement(l, all), complement(l, next));
        all            = complement(l, joined);
    }
    return all;
}

static Lowered lower_difference(Lowering *l, const Shape *shape, Place place)
{
    Lowered left  = lower(l, shape->children[0], place);
    Lowered right = union_of(l, shape, shape->children + 1, shape->child_count - 1, place);
    if (left.distance == NODE_NONE || right.distance == NODE_NONE)
        return left;
    Lowered joined = join_two(l, shape->blend, complement(l, left), right);
    return complement(l, joined);
}

/* What is in one of two: their union less what they share. */
static Lowered lower_xor(Lowering *l, const Shape *shape, Place place)
{
    Lowered a = lower(l, shape->children[0], place), b = lower(l, shape->children[1], place);
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return join_two(l, shape->blend, a, b);
    Lowered result = join_two(l, shape->blend, a, b);
    /* What they share is the complement of: */
    Lowered shared = join_two(l, shape->blend, complement(l, a), complement(l, b));
    result.distance = graph_op2(l->graph, OP_max, result.distance, shared.distance);
    return result;
}

static Lowered lower_morph(Lowering *l, const Shape *shape, Place place)
{
    Lowered a = lower(l, shape->children[0], steady(place));
    Lowered b = lower(l, shape->children[1], steady(place));
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return a.distance == NODE_NONE ? b : a;
    Graph  *g      = l->graph;
    Lowered result = nothing;
    Node    one    = graph_number(g, 1);
    Node    weight = graph_op2(g, OP_sub, one, shape->values[0]);
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
static Node before_map(Graph *g, const Similarity *map, Node point)
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

static Lowered scale_distance(Lowering *l, Lowered result, Node factor)
{
    if (result.distance != NODE_NONE && factor != graph_number(l->graph, 1))
        result.distance = graph_op2(l->graph, OP_mul, result.distance, factor);
    return result;
}

static Lowered lower_transform(Lowering *l, const Shape *shape, Place place)
{
    Node    point  = before_map(l->graph, &shape->map, place.point);
    Lowered result = lower(l, shape->children[0], at(place, point));
    return scale_distance(l, result, shape->map.scale);
}

static Lowered lower_stretch(Lowering *l, const Shape *shape, Place place)
{
    Graph *g = l->graph;
    Node   x = graph_component(g, shape->values[0], 0), y = graph_component(g, shape->values[0], 1);
    Node   z = graph_component(g, shape->values[0], 2);
    Node   least   = graph_op2(g, OP_min, x, y);
    least          = graph_op2(g, OP_min, least, z);
    Node   point   = graph_op2(g, OP_div, place.point, shape->values[0]);
    Lowered result = lower(l, shape->children[0], at(place, point));
    return scale_distance(l, result, least);
}

static Lowered lower_mirror(Lowering *l, const Shape *shape, Place place)
{
    Node point = graph_op3(l->graph, OP_fold, place.point, shape->values[0], shape->values[1]);
    return lower(l, shape->children[0], at(place, point));
}

static Lowered lower_elongate(Lowering *l, const Shape *shape, Place place)
{
    Graph *g      = l->graph;
    Node   low    = graph_op1(g, OP_neg, shape->values[0]);
    Node   inside = graph_op3(g, OP_clamp, place.point, low, shape->values[0]);
    Node   point  = graph_op2(g, OP_sub, place.point, inside);
    return lower(l, shape->children[0], at(place, point));
}

/* ---- figures made solid ---- */

static Lowered lower_extrude(Lowering *l, const Shape *shape, Place place)
{
    Graph *g    = l->graph;
    Node   x    = graph_component(g, place.point, 0), y = graph_component(g, place.point, 1);
    Node   zero = graph_number(g, 0);
    Node   flat = graph_op3(g, OP_vec3, x, y, zero);
    Lowered result = lower(l, shape->children[0], at(place, flat));
    if (result.distance == NODE_NONE)
        return result;
    Node height  = graph_component(g, place.point, 2);
    height       = graph_op1(g, OP_abs, height);
    height       = graph_op2(g, OP_sub, height, shape->values[0]);
    Node inside  = graph_op2(g, OP_max, result.distance, height);
    inside       = graph_op2(g, OP_min, inside, zero);
    Node across  = graph_op2(g, OP_max, result.distance, zero);
    Node along   = graph_op2(g, OP_max, height, zero);
    Node outside = graph_op2(g, OP_vec2, across, along);
    outside      = graph_op1(g, OP_length, outside);
    result.distance = graph_op2(g, OP_add, inside, outside);
    return result;
}

static Lowered lower_revolve(Lowering *l, const Shape *shape, Place place)
{
    Graph *g    = l->graph;
    Node   x    = graph_component(g, place.point, 0), y = graph_component(g, place.point, 1);
    Node   z    = graph_component(g, place.point, 2);
    Node   axis = graph_op2(g, OP_vec2, x, z);
    Node   away = graph_op1(g, OP_length, axis);
    away        = graph_op2(g, OP_sub, away, shape->values[0]);
    Node   zero = graph_number(g, 0);
    Node   flat = graph_op3(g, OP_vec3, away, y, zero);
    return lower(l, shape->children[0], at(place, flat));
}

/* ---- repetition ---- */

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

/*
 * The walls of cells go on for ever, and far away would still hold rays up and throw false
 * penumbras; the distance to the box of all copies is a bound as well, and there the larger one.
 */
static Lowered outside_of_box(Lowering *l, const Shape *shape, Place place, Lowered result)
{
    Graph *g = l->graph;
    if (result.distance == NODE_NONE || !box_is_finite(shape->box))
        return result;
    Node around     = box_distance(g, place.point, shape->box);
    Node zero       = graph_number(g, 0);
    Node beyond     = graph_op2(g, OP_less, zero, around);
    Node larger     = graph_op2(g, OP_max, result.distance, around);
    result.distance = graph_op3(g, OP_select, beyond, larger, result.distance);
    return result;
}

/* Whether the content looks the same mirrored in the middle of its cell on an axis; `mapped`
   is OP_POINT seen by the content, which may stand turned in its cell. */
static bool is_symmetric(Lowering *l, const Shape *content, Node mapped, uint32_t axis)
{
    Lowering alone = {l->graph, l->scratch, false, l->most, false};
    Lowered  inner = lower(&alone, content, (Place){mapped, NODE_NONE, NODE_NONE, true});
    l->overflow    = l->overflow || alone.overflow;
    return inner.distance != NODE_NONE && graph_is_even(l->graph, inner.distance, axis, l->scratch);
}

/*
 * On an axis that repeats, the content lies in its cell; what are the other copies to a point?
 *   SYMMETRIC  content that is its own mirror image: the copies beyond a wall are the image of
 *              this one, and never nearer.
 *   WALLS      content that keeps a margin from the walls: the next copy is at least as far as
 *              the wall plus the margin.  The least of that and the distance inside is safe and
 *              continuous, but it is a bound only: not where a blend or an offset lies above.
 *   NEIGHBOURS else: the copy on the nearer side is evaluated as well, which is exact
 *              (math.md, section 4, "repetition").
 */
typedef enum Joining { SYMMETRIC, WALLS, NEIGHBOURS } Joining;

static Joining choose_joining(Lowering *l, const Shape *content, Node mapped, uint32_t axis,
                              double margin, double size, Place place)
{
    if (is_symmetric(l, content, mapped, axis))
        return SYMMETRIC;
    return margin >= 0.05 * size && !place.lipschitz ? WALLS : NEIGHBOURS;
}

typedef struct Lattice {
    Node   period;        /* of the axis */
    Node   shifted;       /* coordinate, moved so that cells have whole numbers */
    Node   low, high;     /* numbers of the first and the last cell; NODE_NONE: endless */
    double margin;        /* of the content */
    double least_period;
    bool   repeats;
} Lattice;

static Range frame_range(Lowering *l, Node node)
{
    if (graph_is_constant(l->graph, node))
        return (Range){l->graph->items[node].number[0], l->graph->items[node].number[0]};
    return graph_frame_fact(l->graph, node, l->scratch).value[0];
}

static Lattice lattice_of(Lowering *l, const Shape *shape, Place place, uint32_t axis)
{
    Graph  *g     = l->graph;
    Lattice cells = {.repeats = shape->cells[axis] != 1};
    cells.shifted = graph_component(g, place.point, axis);
    if (!cells.repeats)
        return cells;
    cells.period       = graph_component(g, shape->values[0], axis);
    cells.least_period = frame_range(l, cells.period).low;
    Range content      = shape->children[0]->box.axis[axis];
    cells.margin       = cell_margin(content, cells.least_period);
    uint32_t count     = shape->cells[axis];
    /* An even number of copies is centred between two of them. */
    if (count && count % 2 == 0) {
        Node half     = graph_number(g, 0.5);
        Node offset   = graph_op2(g, OP_mul, cells.period, half);
        cells.shifted = graph_op2(g, OP_add, cells.shifted, offset);
    }
    double last = floor(count / 2);
    cells.high  = count ? graph_number(g, last) : NODE_NONE;
    cells.low   = count ? graph_number(g, last + 1 - count) : NODE_NONE;
    return cells;
}

static Node within_lattice(Graph *g, const Lattice *cells, Node number)
{
    return cells->low == NODE_NONE ? number
                                   : graph_op3(g, OP_clamp, number, cells->low, cells->high);
}

/* Coordinate within the nearest cell. */
static Node in_cell(Graph *g, const Lattice *cells, Node *number)
{
    Node ratio  = graph_op2(g, OP_div, cells->shifted, cells->period);
    ratio       = graph_op1(g, OP_round, ratio);
    *number     = within_lattice(g, cells, ratio);
    Node start  = graph_op2(g, OP_mul, *number, cells->period);
    return graph_op2(g, OP_sub, cells->shifted, start);
}

/* Coordinate within the neighbour cell on the side where the point is; the same cell again
   where there is no neighbour. */
static Node in_neighbour(Graph *g, const Lattice *cells, Node local, Node number)
{
    Node zero   = graph_number(g, 0), one = graph_number(g, 1), minus = graph_number(g, -1);
    Node left   = graph_op2(g, OP_less, local, zero);
    Node side   = graph_op3(g, OP_select, left, minus, one);
    Node next   = graph_op2(g, OP_add, number, side);
    next        = within_lattice(g, cells, next);
    Node start  = graph_op2(g, OP_mul, next, cells->period);
    return graph_op2(g, OP_sub, cells->shifted, start);
}

/* Distance to the wall of the nearest existing neighbour, plus the margin behind it. */
static Node wall_distance(Graph *g, const Lattice *cells, Node local, Node number)
{
    Node half   = graph_number(g, 0.5);
    Node wall   = graph_op2(g, OP_mul, cells->period, half);
    Node right  = graph_op2(g, OP_sub, wall, local);
    Node left   = graph_op2(g, OP_add, wall, local);
    if (cells->low != NODE_NONE) {
        Node far   = graph_number(g, NOWHERE);
        Node first = graph_op2(g, OP_less_equal, number, cells->low);
        Node last  = graph_op2(g, OP_less_equal, cells->high, number);
        left       = graph_op3(g, OP_select, first, far, left);
        right      = graph_op3(g, OP_select, last, far, right);
    }
    Node nearer = graph_op2(g, OP_min, left, right);
    Node margin = graph_number(g, cells->margin);
    return graph_op2(g, OP_add, nearer, margin);
}

/* The copy in the point's own cell, joined with those in the neighbour cells that count: at
   most one on each axis, so the cells of a corner. */
static Lowered join_neighbours(Lowering *l, const Shape *shape, Place place, const Node own[3],
                               const Node other[3], const bool neighbour[3])
{
    Lowered result = nothing;
    for (uint32_t corner = 0; corner < 8; corner++) {
        Node parts[3];
        bool exists = true;
        for (uint32_t i = 0; i < 3; i++) {
            bool across = corner >> i & 1;
            exists      = exists && (!across || neighbour[i]);
            parts[i]    = across ? other[i] : own[i];
        }
        if (!exists)
            continue;
        Node    point = graph_op(l->graph, OP_vec3, parts);
        Lowered copy  = lower(l, shape->children[0], at(place, point));
        result        = join_two(l, blend_sharp, result, copy);
    }
    return result;
}

static Lowered lower_repeat(Lowering *l, const Shape *shape, Place place)
{
    Graph *g = l->graph;
    Node   own[3], other[3], walls = NODE_NONE;
    bool   neighbour[3];
    Node   plain = graph_leaf(g, OP_POINT);
    for (uint32_t i = 0; i < 3; i++) {
        Lattice cells = lattice_of(l, shape, place, i);
        own[i] = other[i] = cells.shifted;
        neighbour[i]      = false;
        if (!cells.repeats)
            continue;
        Node number;
        own[i]          = in_cell(g, &cells, &number);
        Joining joining = choose_joining(l, shape->children[0], plain, i, cells.margin,
                                         cells.least_period, place);
        neighbour[i]    = joining == NEIGHBOURS;
        if (neighbour[i])
            other[i] = in_neighbour(g, &cells, own[i], number);
        if (joining == WALLS) {
            Node wall = wall_distance(g, &cells, own[i], number);
            walls     = walls == NODE_NONE ? wall : graph_op2(g, OP_min, walls, wall);
        }
    }
    Lowered result = join_neighbours(l, shape, place, own, other, neighbour);
    if (walls == NODE_NONE || result.distance == NODE_NONE)
        return result;
    result.distance = graph_op2(g, OP_min, result.distance, walls);
    return outside_of_box(l, shape, place, result);
}

/* Rotation about y that brings an angle to the x axis. */
static Node turn_about_y(Graph *g, Node point, double angle)
{
    double c = cos(angle), s = sin(angle);
    Node   r0 = graph_vec3(g, c, 0, s), r1 = graph_vec3(g, 0, 1, 0), r2 = graph_vec3(g, -s, 0, c);
    return angle == 0 ? point : graph_op4(g, OP_turn, point, r0, r1, r2);
}

/* How far the content, turned by -angle, stays from the walls of the sector around +x. */
static double sector_margin(Box content, double angle, double half_sector)
{
    double least = INFINITY, c = cos(angle), s = sin(angle);
    for (int corner = 0; corner < 4; corner++) {
        double x = corner & 1 ? content.axis[0].high : content.axis[0].low;
        double z = corner & 2 ? content.axis[2].high : content.axis[2].low;
        double along = c * x + s * z, across = -s * x + c * z;
        least = fmin(least, along * sin(half_sector) - fabs(across) * cos(half_sector));
    }
    return isnan(least) ? -INFINITY : least;
}

static Lowered all_around(Lowering *l, const Shape *shape, Place place, uint32_t first,
                          uint32_t count)
{
    if (count == 1) {
        Node point = turn_about_y(l->graph, place.point, 2 * M_PI * first / shape->cells[0]);
        return lower(l, shape->children[0], at(place, point));
    }
    Lowered a = all_around(l, shape, place, first, count / 2);
    Lowered b = all_around(l, shape, place, first + count / 2, count - count / 2);
    return join_two(l, blend_sharp, a, b);
}

/* The copy in the sector on the side of a point that lies in its own, turned towards +x. */
static Lowered lower_next_sector(Lowering *l, const Shape *shape, Place place, Node local,
                                 double angle)
{
    Graph *g      = l->graph;
    double sector = 2 * (M_PI / shape->cells[0]);
    Node   z      = graph_component(g, local, 2), zero = graph_number(g, 0);
    Node   right  = graph_op2(g, OP_less, zero, z);
    Node   plus   = turn_about_y(g, local, sector);
    Node   minus  = turn_about_y(g, local, -sector);
    Node   next   = graph_op3(g, OP_select, right, plus, minus);
    Node   point  = turn_about_y(g, next, -angle);
    return lower(l, shape->children[0], at(place, point));
}

/* Distance to the nearer wall of the sector around +x, plus the margin behind it. */
static Node sector_wall(Graph *g, Node local, double half_sector, double margin)
{
    Node z      = graph_component(g, local, 2), x = graph_component(g, local, 0);
    Node sine   = graph_number(g, sin(half_sector)), cosine = graph_number(g, cos(half_sector));
    Node along  = graph_op2(g, OP_mul, x, sine);
    Node aside  = graph_op1(g, OP_abs, z);
    aside       = graph_op2(g, OP_mul, aside, cosine);
    Node wall   = graph_op2(g, OP_sub, along, aside);
    Node behind = graph_number(g, margin);
    return graph_op2(g, OP_add, wall, behind);
}

/* Copies around y: the point is turned into the sector of the content, and the sectors join as
   cells do.  Content that crosses the walls is written out, copy by copy. */
static Lowered lower_repeat_polar(Lowering *l, const Shape *shape, Place place)
{
    Graph *g           = l->graph;
    double half_sector = M_PI / shape->cells[0];
    Box    content     = shape->children[0]->box;
    double centre[3];
    box_centre(content, centre);
    double angle  = box_is_finite(content) ? atan2(centre[2], centre[0]) : 0;
    double margin = sector_margin(content, angle, half_sector);
    if (shape->cells[0] < 3 || margin < 0)
        return all_around(l, shape, place, 0, shape->cells[0]);

    Node    facing = turn_about_y(g, place.point, angle);
    Node    count  = graph_number(g, shape->cells[0]);
    Node    local  = graph_op2(g, OP_cell_polar, facing, count);
    Node    back   = turn_about_y(g, local, -angle);
    Lowered result = lower(l, shape->children[0], at(place, back));
    Node    mapped = turn_about_y(g, graph_leaf(g, OP_POINT), -angle);
    double  width  = hypot(centre[0], centre[2]) * sin(half_sector);
    Joining joining = choose_joining(l, shape->children[0], mapped, 2, margin, width, place);
    if (joining == SYMMETRIC)
        return result;
    if (joining == NEIGHBOURS) {
        Lowered copy = lower_next_sector(l, shape, place, local, angle);
        return join_two(l, blend_sharp, result, copy);
    }
    if (result.distance == NODE_NONE)
        return result;
    Node wall       = sector_wall(g, local, half_sector, margin);
    result.distance = graph_op2(g, OP_min, result.distance, wall);
    return outside_of_box(l, shape, place, result);
}

/* ---- sequences ---- */

/*
 * From the last statement to the first (math.md, section 1): a mirror folds the point and gives
 * the instance its next bit, a kernel joins with the level that it has: the mirrors before it.
 */
static Lowered lower_krs(Lowering *l, const Shape *shape, Place place)
{
    Graph   *g      = l->graph;
    Lowered  result = nothing;
    Node     point  = place.point, scale = graph_number(g, 1);
    Node     id     = graph_uint(g, 1);
    uint32_t level  = shape->levels;
    Op       next_id = shape->levels <= MOST_HEAP_MIRRORS ? OP_push_id : OP_hash_id;
    for (uint32_t i = shape->stage_count; i-- > 0;) {
        const Stage *stage = &shape->stages[i];
        if (stage->kind == STAGE_REFLECT) {
            if (l->surfaces) {
                Node behind = graph_op3(g, OP_front, point, stage->normal, stage->offset);
                id          = graph_op2(g, next_id, id, behind);
            }
            point = graph_op3(g, OP_fold, point, stage->normal, stage->offset);
            level--;
        } else if (stage->kind == STAGE_SIMILARITY) {
            point = before_map(g, &stage->map, point);
            scale = graph_op2(g, OP_mul, scale, stage->map.scale);
        } else {
            Place inner = at(place, point);
            if (l->surfaces) {
                /* Within an outer sequence its level counts, and this instance is hashed in. */
                bool outer     = place.level != NODE_NONE;
                inner.level    = outer ? place.level : graph_number(g, level);
                inner.instance = outer ? graph_op2(g, OP_join_id, place.instance, id) : id;
            }
            Lowered kernel = lower(l, shape->children[stage->kernel], inner);
            result         = join_two(l, blend_sharp, result, scale_distance(l, kernel, scale));
        }
    }
    return result;
}

/* ---- leaves, paint, and the walk ---- */

static Lowered lower_primitive(Lowering *l, const Shape *shape, Place place)
{
    Graph       *g    = l->graph;
    Substitution with = {place.point, NODE_NONE, NODE_NONE};
    Lowered      leaf = nothing;
    leaf.distance     = graph_substitute(g, shape->distance, with, l->scratch);
    if (shape->bound != NODE_NONE && !place.lipschitz) {
        Node bound    = graph_substitute(g, shape->bound, with, l->scratch);
        leaf.distance = graph_op2(g, OP_max, leaf.distance, bound);
    }
    if (l->surfaces) {
        leaf.surface.level    = place.level == NODE_NONE ? graph_number(g, 0) : place.level;
        leaf.surface.instance = place.instance == NODE_NONE ? graph_uint(g, 1) : place.instance;
    }
    return leaf;
}

/* The outermost paint counts, as the last method of a chain does. */
static Lowered lower_paint(Lowering *l, const Shape *shape, Place place)
{
    Lowered result = lower(l, shape->children[0], place);
    if (!l->surfaces || result.distance == NODE_NONE)
        return result;
    Substitution    with     = {place.point, result.surface.instance, result.surface.level};
    const Material *material = shape->material;
    result.surface.color     = graph_substitute(l->graph, material->color, with, l->scratch);
    result.surface.roughness = graph_substitute(l->graph, material->roughness, with, l->scratch);
    result.surface.metallic  = graph_substitute(l->graph, material->metallic, with, l->scratch);
    result.surface.emission  = graph_substitute(l->graph, material->emission, with, l->scratch);
    return result;
}

static Lowered lower_offset(Lowering *l, const Shape *shape, Place place)
{
    Lowered result = lower(l, shape->children[0], steady(place));
    if (result.distance != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_sub, result.distance, shape->values[0]);
    return result;
}

static Lowered lower_shell(Lowering *l, const Shape *shape, Place place)
{
    Graph  *g      = l->graph;
    Lowered result = lower(l, shape->children[0], steady(place));
    if (result.distance == NODE_NONE)
        return result;
    Node half       = graph_number(g, 0.5);
    half            = graph_op2(g, OP_mul, shape->values[0], half);
    Node size       = graph_op1(g, OP_abs, result.distance);
    result.distance = graph_op2(g, OP_sub, size, half);
    return result;
}

static Lowered lower(Lowering *l, const Shape *shape, Place place)
{
    l->graph->here = shape->span;
    l->overflow    = l->overflow || l->graph->count > l->most;
    if (l->overflow)
        return nothing;
    switch (shape->kind) {
    case SHAPE_EMPTY:        return nothing;
    case SHAPE_PRIMITIVE:    return lower_primitive(l, shape, place);
    case SHAPE_TRANSFORM:    return lower_transform(l, shape, place);
    case SHAPE_STRETCH:      return lower_stretch(l, shape, place);
    case SHAPE_UNION:        return lower_union(l, shape, joint_place(shape, place));
    case SHAPE_INTERSECTION: return lower_intersection(l, shape, joint_place(shape, place));
    case SHAPE_DIFFERENCE:   return lower_difference(l, shape, joint_place(shape, place));
    case SHAPE_XOR:          return lower_xor(l, shape, joint_place(shape, place));
    case SHAPE_MORPH:        return lower_morph(l, shape, place);
    case SHAPE_OFFSET:       return lower_offset(l, shape, place);
    case SHAPE_SHELL:        return lower_shell(l, shape, place);
    case SHAPE_ELONGATE:     return lower_elongate(l, shape, place);
    case SHAPE_EXTRUDE:      return lower_extrude(l, shape, place);
    case SHAPE_REVOLVE:      return lower_revolve(l, shape, place);
    case SHAPE_REPEAT:       return lower_repeat(l, shape, place);
    case SHAPE_REPEAT_POLAR: return lower_repeat_polar(l, shape, place);
    case SHAPE_MIRROR:       return lower_mirror(l, shape, place);
    case SHAPE_PAINT:        return lower_paint(l, shape, place);
    case SHAPE_KRS:          return lower_krs(l, shape, place);
    }
    assert(!"every kind of shape has a rule");
    return nothing;
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
    Lowering l     = {graph, scratch, true, graph->count + MOST_LOWERED, false};
    Place    place = {graph_leaf(graph, OP_POINT), NODE_NONE, NODE_NONE, false};
    Lowered  all   = lower(&l, shape, place);
    Node     distance = or_else(all.distance, graph_number(graph, NOWHERE));
    roots[ROOT_DISTANCE]  = divide_by_slope(graph, distance, shape->slope);
    roots[ROOT_COLOR]     = or_else(all.surface.color, graph_vec3(graph, 0.6, 0.6, 0.6));
    roots[ROOT_ROUGHNESS] = or_else(all.surface.roughness, graph_number(graph, 0.6));
    roots[ROOT_METALLIC]  = or_else(all.surface.metallic, graph_number(graph, 0));
    roots[ROOT_EMISSION]  = or_else(all.surface.emission, graph_vec3(graph, 0, 0, 0));
    roots[ROOT_LEVEL]     = or_else(all.surface.level, graph_number(graph, 0));
    roots[ROOT_INSTANCE]  = or_else(all.surface.instance, graph_uint(graph, 1));
    return !l.overflow;
}
