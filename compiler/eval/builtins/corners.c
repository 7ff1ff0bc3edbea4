/* corners.c: the corners of plane figures that are convex polygons. */
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/eval/builtins/builtins.h"
#include "compiler/eval/declared/declare.h"
#include "compiler/lower/outline.h"
#include "compiler/shape/map.h"

/* A figure with more corners is as good as round. */
enum { MAX_CORNERS = 128 };

typedef struct Corners {
    Node   at[MAX_CORNERS]; /* [x, y, 0] */
    size_t count;
} Corners;

static bool add_corner(Corners *corners, Node at)
{
    if (corners->count == MAX_CORNERS)
        return false;
    corners->at[corners->count++] = at;
    return true;
}

/* ---- figures whose outline is known ---- */

static bool add_border(Elaboration *e, const Border *border, Corners *corners)
{
    for (uint32_t i = 0; i < border->count; i++) {
        const BorderCorner *corner = &border->corners[i];
        Node                at[3];
        if (corner->numbers[2] != 0 || corner->nodes[2] != NODE_NONE)
            return false;
        for (int k = 0; k < 3; k++)
            at[k] = corner->nodes[k] != NODE_NONE ? corner->nodes[k]
                                                  : graph_number(e->graph, corner->numbers[k]);
        if (!add_corner(corners, graph_op3(e->graph, OP_vec3, at[0], at[1], at[2])))
            return false;
    }
    return true;
}

/* Returns the piece that begins where a straight one ends; NULL: there is none. */
static const Piece *piece_behind(const Outline *outline, const Piece *piece)
{
    for (uint32_t i = 0; i < outline->count && piece->curve.straight; i++)
        if (memcmp(outline->pieces[i].curve.from, piece->curve.to, sizeof piece->curve.to) == 0)
            return &outline->pieces[i];
    return NULL;
}

/* Adds the pieces of an outline that is one line around. */
static bool add_pieces(Elaboration *e, const Outline *outline, Corners *corners)
{
    const Piece *piece = outline->pieces;
    for (uint32_t i = 0; i < outline->count; i++) {
        const double *at = piece->curve.from;
        piece            = piece_behind(outline, piece);
        if (!piece || (piece == outline->pieces) != (i + 1 == outline->count) ||
            !add_corner(corners, graph_vec3(e->graph, at[0], at[1], 0)))
            return false;
    }
    return true;
}

/* ---- convexity ---- */

/* Tells whether the corners are known now, and the polygon turns to the left all the way around, once. */
static bool turns_left_once(const Elaboration *e, const Corners *corners)
{
    double at[MAX_CORNERS][2], size = 0, around = 0;
    for (size_t i = 0; i < corners->count; i++) {
        if (!graph_known_components(e->graph, corners->at[i], 2, at[i]))
            return false;
        size = fmax(size, fmax(fabs(at[i][0]), fabs(at[i][1])));
    }
    for (size_t i = 0; i < corners->count; i++) {
        const double *from = at[i], *via = at[(i + 1) % corners->count],
                     *to      = at[(i + 2) % corners->count];
        const double way[2]   = {via[0] - from[0], via[1] - from[1]};
        const double on[2]    = {to[0] - via[0], to[1] - via[1]};
        double       product  = way[0] * on[1] - way[1] * on[0];
        double       parallel = way[0] * on[0] + way[1] * on[1];
        if (product < -1e-12 * size * size || (parallel < 0 && product <= 0))
            return false;
        around += real_atan2(product, parallel);
    }
    return around < 3 * M_PI;
}

static void reverse_corners(Corners *corners)
{
    for (size_t i = 0, k = corners->count; i + 1 < k--; i++) {
        Node swap      = corners->at[i];
        corners->at[i] = corners->at[k];
        corners->at[k] = swap;
    }
}

/* Tells whether a figure is convex.  Some shapes of the library are, whatever the numbers of their parameters. */
static bool is_convex(const Elaboration *e, const Shape *shape, Corners *corners)
{
    static const char *const convex[] = {"rectangle", "regular"};
    for (size_t i = 0; i < sizeof convex / sizeof *convex; i++)
        if (shape->declaration && is_of_library(e, shape) && strcmp(shape->name, convex[i]) == 0)
            return true;
    if (turns_left_once(e, corners))
        return true;
    reverse_corners(corners);
    return turns_left_once(e, corners);
}

/* ---- the method ---- */

static void move_corners(Elaboration *e, const Shape *shape, Corners *corners)
{
    for (size_t i = 0; i < corners->count; i++)
        corners->at[i] = shape->kind == SHAPE_TRANSFORM
                             ? map_apply(e->builder, &shape->map, corners->at[i])
                             : graph_op2(e->graph, OP_mul, corners->at[i], shape->values[0]);
}

/* Finds the corners of a convex polygon; false: the shape is none, or may be none. */
static bool find_corners(Elaboration *e, const Shape *shape, Corners *corners)
{
    switch (shape->kind) {
    case SHAPE_PRIMITIVE:
        find_borders(e, shape);
        return (shape->outline  ? add_pieces(e, &shape->outline->outline, corners)
                : shape->border ? add_border(e, shape->border, corners)
                                : false) &&
               corners->count > 0 && is_convex(e, shape, corners);
    case SHAPE_TRANSFORM:
        if (shape->map.pole != NODE_NONE || shape->map.first)
            return false;
        break;
    case SHAPE_STRETCH:
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: break;
    default: return false;
    }
    if (!find_corners(e, shape->children[0], corners))
        return false;
    if (shape->kind == SHAPE_TRANSFORM || shape->kind == SHAPE_STRETCH)
        move_corners(e, shape, corners);
    return true;
}

Value method_corners(Elaboration *e, const Shape *shape, Call *call)
{
    (void)call;
    Corners corners = {.count = 0};
    if (!shape->figure || !find_corners(e, shape, &corners))
        corners.count = 0;
    Value *values = arena_new_array(e->arena, Value, corners.count + 1);
    for (size_t i = 0; i < corners.count; i++) {
        Value *ends = arena_new_array(e->arena, Value, 2);
        for (uint32_t k = 0; k < 2; k++)
            ends[k] = value_of_node(e, graph_component(e->graph, corners.at[i], k));
        values[i] = value_list(e, ends, 2);
    }
    return value_list(e, values, corners.count);
}
