/*
 * box_rules.c: the boxes of shapes, by the rule of each kind.
 */
#include "compiler/shape/box_rules.h"

#include <assert.h>
#include <math.h>

#include "compiler/base/elementary.h"

uint32_t box_part_count(const Shape *shape) { return shape->within ? 1 : shape->child_count; }

const Shape *box_part(const Shape *shape, uint32_t index)
{
    return shape->within ? shape->within : shape->children[index];
}

static uint32_t add_node(Node node, Node *nodes, uint32_t count)
{
    nodes[count] = node;
    return count + (node != NODE_NONE);
}

uint32_t map_box_nodes(const Map *map, Node *nodes, uint32_t count)
{
    if (map->scale == NODE_NONE)
        return count;
    for (int i = 0; i < 3; i++)
        nodes[count++] = map->rows[i];
    count = add_node(map->scale, nodes, count);
    return add_node(map->shift, nodes, count);
}

uint32_t box_nodes(const Shape *shape, Node nodes[MAX_BOX_NODES])
{
    uint32_t count = map_box_nodes(&shape->map, nodes, 0);
    for (int i = 0; i < 2; i++) {
        count = add_node(shape->values[i], nodes, count);
        count = add_node(shape->corners[i], nodes, count);
    }
    count = add_node(shape->ball_radius, nodes, count);
    return add_node(shape->blend.width, nodes, count);
}

static Box part(const BoxInput *in, uint32_t index)
{
    return in->parts ? in->parts[index * in->stride] : box_part(in->shape, index)->box;
}

static Range number(const BoxInput *in, Node node, uint32_t component)
{
    return in->numbers->range(in->numbers, node, component);
}

/* ---- maps ---- */

/* Returns the range of an entry of an orthonormal matrix, which never leaves [-1, 1], whatever it
   was derived as. */
static Range cosine_range(Range range)
{
    return (Range){fmax(-1, fmin(range.low, 1)), fmin(1, fmax(range.high, -1))};
}

MapRange map_range_of(const BoxNumbers *numbers, const Map *map)
{
    MapRange range = {.inverts = map->pole != NODE_NONE,
                      .scale   = numbers->range(numbers, map->scale, 0)};
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t j = 0; j < 3; j++)
            range.rows[i][j] = cosine_range(numbers->range(numbers, map->rows[i], j));
        range.shift[i] = numbers->range(numbers, map->shift, i);
        if (range.inverts)
            range.pole[i] = numbers->range(numbers, map->pole, i);
    }
    return range;
}

Box map_box_of(const MapRange *range, Box box)
{
    assert(!range->inverts);
    Range rows[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            rows[i][j] = range_mul(range->scale, range->rows[i][j]);
    return box_move(box_rotate(box, rows), range->shift);
}

/* ---- rules ---- */

static Box box_of_ball(double radius)
{
    const Range side = {-radius, radius};
    return (Box){{side, side, side}};
}

/* Finds a primitive's box by what its declaration says of it; corners that are known stand in its
   box. */
static Box box_primitive(const BoxInput *in)
{
    const Shape *shape = in->shape;
    Box          box   = shape->within ? part(in, 0) : shape->box;
    if (shape->ball_box)
        return box_of_ball(number(in, shape->ball_radius, 0).high);
    for (uint32_t i = 0; i < 3; i++) {
        if (shape->corners[0] != NODE_NONE)
            box.axis[i].low = number(in, shape->corners[0], i).low;
        if (shape->corners[1] != NODE_NONE)
            box.axis[i].high = number(in, shape->corners[1], i).high;
    }
    return box;
}

/* Returns what of a box is between the corners of a shape, as far as it has some. */
static Box between_corners(const BoxInput *in, Box box)
{
    const Shape *shape = in->shape;
    for (uint32_t i = 0; i < 3; i++) {
        if (shape->corners[0] != NODE_NONE)
            box.axis[i].low = fmax(box.axis[i].low, number(in, shape->corners[0], i).low);
        if (shape->corners[1] != NODE_NONE)
            box.axis[i].high = fmin(box.axis[i].high, number(in, shape->corners[1], i).high);
    }
    return box;
}

static Box box_of_part(const BoxInput *in) { return part(in, 0); }

static Box box_transform(const BoxInput *in)
{
    const MapRange range = map_range_of(in->numbers, &in->shape->map);
    return map_box_of(&range, part(in, 0));
}

static Box box_stretch(const BoxInput *in)
{
    Box box = part(in, 0);
    for (uint32_t i = 0; i < 3 && !box_is_empty(box); i++)
        box.axis[i] = range_mul(box.axis[i], number(in, in->shape->values[0], i));
    return box;
}

static Box hull_of_parts(const BoxInput *in)
{
    Box hull = box_empty;
    for (uint32_t i = 0; i < in->shape->child_count; i++)
        hull = i ? box_hull(hull, part(in, i)) : part(in, i);
    return hull;
}

static Box box_clip(const BoxInput *in) { return between_corners(in, part(in, 0)); }

/* A blend adds to its parts where they are near to each other. */
static Box box_union(const BoxInput *in)
{
    const Blend   *blend = &in->shape->blend;
    const uint32_t count = in->shape->child_count;
    const Box      hull  = hull_of_parts(in);
    if (blend->width == NODE_NONE || count < 2)
        return hull;
    return box_grow(hull, blend_bulge(blend->kind, count) * number(in, blend->width, 0).high);
}

static Box box_intersection(const BoxInput *in)
{
    Box common = part(in, 0);
    for (uint32_t i = 1; i < in->shape->child_count; i++)
        common = box_common(common, part(in, i));
    return common;
}

/* Bounds a morph: where the mix is 0 one of the distances is at most 0, or both are. */
static Box box_morph(const BoxInput *in) { return hull_of_parts(in); }

static Box box_choice(const BoxInput *in)
{
    const Range chosen = number(in, in->shape->values[0], 0);
    return range_is_single(chosen) ? part(in, chosen.low == 0) : hull_of_parts(in);
}

static Box box_meta(const BoxInput *in)
{
    Box hull = box_empty;
    for (uint32_t i = 0; i < in->shape->child_count; i++)
        hull = box_hull(hull, box_grow(part(in, i), number(in, in->shape->values[1], 0).high));
    return hull;
}

static Box box_offset(const BoxInput *in)
{
    return box_grow(part(in, 0), fmax(number(in, in->shape->values[0], 0).high, 0));
}

static Box box_shell(const BoxInput *in)
{
    return box_grow(part(in, 0), 0.5 * number(in, in->shape->values[0], 0).high);
}

static Box box_elongate(const BoxInput *in)
{
    Range sides[3];
    for (uint32_t i = 0; i < 3; i++) {
        const double most = number(in, in->shape->values[0], i).high;
        sides[i]          = (Range){-most, most};
    }
    return box_move(part(in, 0), sides);
}

static Box box_extrude(const BoxInput *in)
{
    Box          box  = part(in, 0);
    const double most = number(in, in->shape->values[0], 0).high;
    box.axis[2]       = (Range){-most, most};
    return box;
}

static Box box_revolve(const BoxInput *in)
{
    Box          box  = part(in, 0);
    const double most = fmax(range_add(box.axis[0], number(in, in->shape->values[0], 0)).high, 0);
    box.axis[0] = box.axis[2] = (Range){-most, most};
    return box;
}

static Box box_repeat(const BoxInput *in)
{
    Box box = part(in, 0);
    for (uint32_t i = 0; i < 3 && !box_is_empty(box); i++) {
        const Range    period = number(in, in->shape->values[0], i);
        const uint32_t cells  = in->shape->cells[i];
        if (cells == 1 || !(period.high > 0))
            continue;
        const double reach = cells ? 0.5 * (cells - 1) * period.high : INFINITY;
        box.axis[i]        = (Range){box.axis[i].low - reach, box.axis[i].high + reach};
    }
    return box;
}

static Box box_repeat_polar(const BoxInput *in)
{
    Box    box  = part(in, 0);
    double most = 0;
    for (int i = 0; i < 3; i += 2)
        most = real_hypot(most, fmax(fabs(box.axis[i].low), fabs(box.axis[i].high)));
    if (!box_is_empty(box))
        box.axis[0] = box.axis[2] = (Range){-most, most};
    return box;
}

static Box box_mirror(const BoxInput *in)
{
    Range u[3];
    for (uint32_t i = 0; i < 3; i++)
        u[i] = number(in, in->shape->values[0], i);
    return box_fold(part(in, 0), u, number(in, in->shape->values[1], 0));
}

/* ---- all kinds ---- */

/* Returns the box that was found where the shape is made. */
static Box box_own(const BoxInput *in) { return in->shape->box; }

typedef Box           BoxRule(const BoxInput *in);
static BoxRule *const rules[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, ...) box_##box,
#include "compiler/shape/shapes.def"
};

bool has_box_rule(const Shape *shape)
{
    const bool declared = shape->kind != SHAPE_PRIMITIVE || shape->declaration;
    return declared && rules[shape->kind] != box_own;
}

Box shape_box(const BoxInput *input) { return rules[input->shape->kind](input); }
