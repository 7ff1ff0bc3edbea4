/*
 * hull_parts.c: from shapes and points to the balls and rims of which a hull is made.  Maps and CSG nodes are
 * followed from the outside inwards.
 */
#include "compiler/eval/hulls/hull_parts.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/eval/declared/declare.h"

/* An affine map; `scale` is that of all lengths, or 0 where it is not the same in all directions. */
typedef struct Place {
    double matrix[3][3], shift[3], scale;
} Place;

/* The values that stay the same in all parts of an argument. */
typedef struct Gathering {
    Elaboration  *e;
    const Call   *call;
    const Syntax *syntax;
    HullParts    *parts;
} Gathering;

static const Place IDENTITY = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, 1};

static Diag *refuse(const Gathering *g, const char *what)
{
    Diag *diag = diag_add(g->e->diags, DIAG_BAD_VALUE, g->syntax->span, "%s", what);
    diag->help =
        "hulls are of points, balls, boxes, other solids with corners, and capsules; figures "
        "likewise. Round solids need one axis, or the same two ends";
    return diag;
}

static bool refuse_shape(const Gathering *g, const Shape *shape)
{
    const char *name = shape->kind == SHAPE_PRIMITIVE ? shape->name : shape_info[shape->kind].name;
    Diag       *diag = refuse(g, diag_text(g->e->diags, "the hull of `%s` is not known", name));
    diag->label      = "what this is the hull of cannot be said by balls";
    return false;
}

static bool refuse_unknown(const Gathering *g)
{
    refuse(g, "what a hull is made of must be known at compile time")->label = "this is not";
    return false;
}

/* ---- places ---- */

static void place_rotate(const Place *place, const double v[3], double rotated[3])
{
    for (int i = 0; i < 3; i++)
        rotated[i] = dot3(place->matrix[i], v);
}

/* Returns place(inner(x)). */
static Place place_product(const Place *place, const Place *inner)
{
    Place product = {.scale = place->scale * inner->scale};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            for (int m = 0; m < 3; m++)
                product.matrix[i][k] += place->matrix[i][m] * inner->matrix[m][k];
    place_rotate(place, inner->shift, product.shift);
    add_scaled3(product.shift, product.shift, 1, place->shift);
    return product;
}

static bool place_of_map(const Elaboration *e, const Map *map, Place *place)
{
    double scale;
    if (!graph_known_component(e->graph, map->scale, 0, &scale) ||
        !graph_known_components(e->graph, map->shift, 3, place->shift))
        return false;
    place->scale = scale;
    for (int i = 0; i < 3; i++) {
        if (!graph_known_components(e->graph, map->rows[i], 3, place->matrix[i]))
            return false;
        for (int k = 0; k < 3; k++)
            place->matrix[i][k] *= scale;
    }
    return true;
}

static bool place_of_stretch(const Elaboration *e, const Shape *shape, Place *place)
{
    double factors[3];
    if (!graph_known_components(e->graph, shape->values[0], 3, factors))
        return false;
    *place       = IDENTITY;
    bool even    = factors[0] == factors[1] && (factors[1] == factors[2] || shape->figure);
    place->scale = even ? factors[0] : 0;
    for (int i = 0; i < 3; i++)
        place->matrix[i][i] = factors[i];
    return true;
}

/* ---- parts ---- */

static bool add_part(const Gathering *g, const Shape *shape, const Place *place, HullPart part,
                     double grown)
{
    double   middle[3];
    HullPart placed = {.ball.radius = part.ball.radius * place->scale + grown};
    if (place->scale == 0 && (part.ball.radius > 0 || length3(part.rim) > 0))
        return refuse_shape(g, shape);
    place_rotate(place, part.ball.centre, middle);
    add_scaled3(placed.ball.centre, middle, 1, place->shift);
    place_rotate(place, part.rim, placed.rim);
    array_push(g->e->values, g->parts, placed);
    return true;
}

/* Reads `[centre, radius]` or `[centre, radius, rim]`. */
static bool read_part(Value value, HullPart *part)
{
    double numbers[4];
    *part = (HullPart){.rim = {0}};
    if (value.type != VALUE_LIST || value.list->count < 2 || value.list->count > 3 ||
        value.list->items[1].type != VALUE_NUMBER)
        return false;
    uint32_t size = value_numbers(value.list->items[0], numbers);
    if (size < 2 || size > 3)
        return false;
    memcpy(part->ball.centre, numbers, size * sizeof *numbers);
    part->ball.radius = value.list->items[1].number;
    if (value.list->count == 3) {
        if (value_numbers(value.list->items[2], numbers) != 3)
            return false;
        memcpy(part->rim, numbers, sizeof part->rim);
    }
    return part->ball.radius >= 0 && isfinite(part->ball.radius);
}

static bool add_declared(const Gathering *g, const Shape *shape, const Place *place, double grown)
{
    if (!shape->declaration || !shape->declaration->hull)
        return refuse_shape(g, shape);
    if (!is_of_library(g->e, shape) && needs_check(g->e, shape->declaration->hull))
        array_push(g->e->values, &g->parts->unchecked, shape);
    Value list = declared_hull(g->e, shape);
    if (list.type == VALUE_ERROR)
        return false;
    if (list.type != VALUE_LIST || value_time(g->e, list) > TIME_COMPILE)
        return refuse_unknown(g);
    for (size_t i = 0; i < list.list->count; i++) {
        HullPart part;
        if (!read_part(list.list->items[i], &part))
            return refuse_unknown(g);
        if (!add_part(g, shape, place, part, grown))
            return false;
    }
    return true;
}

static bool add_shape(const Gathering *g, const Shape *shape, const Place *place, double grown);

/* Warns once of a hull that it loses paint. */
static void warn_of_paint(const Gathering *g, const Shape *shape)
{
    if (g->parts->painted)
        return;
    g->parts->painted = true;
    Diag *diag        = diag_add(g->e->diags, DIAG_NO_EFFECT, shape->span,
                                 "a hull does not have the materials of its parts");
    diag->help        = "paint the hull: `hull(...).paint(...)`";
}

/* A disc becomes a cylinder, and so two rims. */
static bool add_extruded(const Gathering *g, const Shape *shape, const Place *place, double grown)
{
    HullParts flat  = {0};
    Gathering inner = {g->e, g->call, g->syntax, &flat};
    double    half;
    if (!graph_known_component(g->e->graph, shape->values[0], 0, &half))
        return refuse_unknown(g);
    if (!add_shape(&inner, shape->children[0], &IDENTITY, 0))
        return false;
    for (size_t i = 0; i < 2 * flat.count; i++) {
        HullPart part       = flat.items[i / 2];
        part.rim[2]         = part.ball.radius;
        part.ball.radius    = 0;
        part.ball.centre[2] = i % 2 ? half : -half;
        if (!add_part(g, shape, place, part, grown))
            return false;
    }
    return true;
}

/* Adds the parts of a shape.  CSG nodes and maps keep the hull if it is one of hulls. */
static bool add_shape(const Gathering *g, const Shape *shape, const Place *place, double grown)
{
    Place  inner = IDENTITY;
    double radius;
    switch (shape->kind) {
    case SHAPE_PRIMITIVE: return add_declared(g, shape, place, grown);
    case SHAPE_EXTRUDE: return add_extruded(g, shape, place, grown);
    case SHAPE_TRANSFORM:
        if (!place_of_map(g->e, &shape->map, &inner))
            return refuse_unknown(g);
        break;
    case SHAPE_STRETCH:
        if (!place_of_stretch(g->e, shape, &inner))
            return refuse_unknown(g);
        break;
    case SHAPE_OFFSET:
        if (!graph_known_component(g->e->graph, shape->values[0], 0, &radius))
            return refuse_unknown(g);
        if (radius < 0 || place->scale == 0)
            return refuse_shape(g, shape);
        grown += radius * place->scale;
        break;
    case SHAPE_UNION:
        if (shape->blend.width != NODE_NONE)
            return refuse_shape(g, shape);
        break;
    case SHAPE_PAINT: warn_of_paint(g, shape); break;
    case SHAPE_ITERATION:
        shape = iteration_alone(g->e, shape);
        return shape && add_shape(g, shape, place, grown);
    case SHAPE_EMPTY:
    case SHAPE_SMOOTH: break;
    default: return refuse_shape(g, shape);
    }
    inner = place_product(place, &inner);
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!add_shape(g, shape->children[i], &inner, grown))
            return false;
    return true;
}

/* ---- arguments ---- */

/* Tells whether solids, or figures, are all that there is. */
static bool goes_with(const Gathering *g, bool figure)
{
    if (g->parts->count == 0 || g->parts->figure == figure) {
        g->parts->figure = figure;
        return true;
    }
    Diag *diag = diag_add(g->e->diags, DIAG_TYPE_MISMATCH, g->syntax->span,
                          "a hull is of solids, or of plane figures, not of both");
    diag->help = "make figures solid with `.extrude(height)` or `.revolve()`";
    return false;
}

bool hull_parts_of_shape(Elaboration *e, const Call *call, const Syntax *syntax, const Shape *shape,
                         HullParts *parts)
{
    Gathering g = {e, call, syntax, parts};
    return shape->nothing || (goes_with(&g, shape->figure) && add_shape(&g, shape, &IDENTITY, 0));
}

static bool add_value(const Gathering *g, Value value)
{
    double   numbers[4];
    uint32_t size = value_numbers(value, numbers);
    if (value.type == VALUE_SHAPE)
        return hull_parts_of_shape(g->e, g->call, g->syntax, value.shape, g->parts);
    if (size == 2 || size == 3) {
        HullPart part = {.rim = {0}};
        memcpy(part.ball.centre, numbers, size * sizeof *numbers);
        if (!goes_with(g, size == 2))
            return false;
        g->parts->points++;
        return add_part(g, NULL, &IDENTITY, part, 0);
    }
    if (value.type != VALUE_LIST || size > 0) {
        Diag *diag = refuse(g, "a point of a hull is three numbers, known at compile time");
        diag->help =
            "give shapes, or points such as `[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]`";
        return false;
    }
    if (!check_shape_count(g->e, value.list, g->syntax->span))
        return false;
    for (size_t i = 0; i < value.list->count; i++)
        if (!add_value(g, value.list->items[i]))
            return false;
    return true;
}

bool hull_parts(Elaboration *e, const Call *call, HullParts *parts)
{
    for (uint32_t i = 0; i <= call->rest_count; i++) {
        const Argument *argument = i ? &call->rest[i - 1] : &call->arguments[0];
        Gathering       g        = {e, call, argument->syntax, parts};
        if (argument->syntax && !add_value(&g, argument->value))
            return false;
    }
    return true;
}
