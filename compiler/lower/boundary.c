/*
 * boundary.c: finds the boundary of a CSG node of figures (figure_outline.h), and builds the distance to it.
 */
#include "compiler/lower/boundary.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/build.h"
#include "compiler/lower/figure_outline.h"
#include "compiler/lower/instance_groups.h"
#include "compiler/lower/outline.h"

/* More lines go to a table, and more arcs are left. */
enum { MAX_LINES = 48, MAX_ARCS = 192 };

/* A part of a circle, to both sides of a direction: half of the angle. */
typedef struct Arc {
    double centre[2], radius, middle, half;
} Arc;

typedef struct Arcs {
    Arc   *items;
    size_t count, capacity;
} Arcs;

struct Boundary {
    Arena *arena;
    enum { BOUNDARY_NEW, BOUNDARY_UNKNOWN, BOUNDARY_KNOWN } state;
    Curves        lines;
    Arcs          arcs;
    OutlineShape *table; /* of all but the arcs, if they are many or curved; or NULL */
    const double *axis;  /* the x about which the figure is revolved; or NULL */
};

struct Boundary *boundary_new(Arena *arena)
{
    struct Boundary *boundary = arena_new(arena, struct Boundary);
    boundary->arena           = arena;
    return boundary;
}

struct Boundary *boundary_about(Arena *arena, double axis)
{
    struct Boundary *boundary = boundary_new(arena);
    double          *at       = arena_new(arena, double);
    *at                       = axis;
    boundary->axis            = at;
    return boundary;
}

/* ---- arcs ---- */

static Arc arc_of(const Curve *curve)
{
    Arc    arc = {.radius = curve->radius};
    double ends[2];
    for (int k = 0; k < 2; k++)
        arc.centre[k] = curve->centre[k];
    ends[0]     = real_atan2(curve->from[1] - arc.centre[1], curve->from[0] - arc.centre[0]);
    ends[1]     = real_atan2(curve->to[1] - arc.centre[1], curve->to[0] - arc.centre[0]);
    double turn = remainder(ends[1] - ends[0], 2 * M_PI);
    arc.middle  = ends[0] + 0.5 * turn;
    arc.half    = 0.5 * fabs(turn);
    return arc;
}

/* Makes one arc of two that go on in each other; `size` is that of the figure. */
static bool join_arc(Arc *arc, const Arc *next, double size)
{
    double slack = 1e-7 * size;
    double turn  = remainder(next->middle - arc->middle, 2 * M_PI);
    if (fabs(arc->radius - next->radius) > slack ||
        real_hypot(arc->centre[0] - next->centre[0], arc->centre[1] - next->centre[1]) > slack ||
        arc->half + next->half > M_PI + 1e-7)
        return false;
    /* The second may go on at either end of the first. */
    for (int side = -1; side <= 1; side += 2) {
        double way = side * turn;
        way        = way < 0 ? way + 2 * M_PI : way;
        if (fabs(way - arc->half - next->half) * arc->radius > slack)
            continue;
        arc->middle = remainder(arc->middle + side * next->half, 2 * M_PI);
        arc->half   = fmin(arc->half + next->half, M_PI);
        return true;
    }
    return false;
}

static void join_arcs(Arcs *arcs, double size)
{
    for (size_t i = 0; i < arcs->count; i++)
        for (size_t k = i + 1; k < arcs->count; k++)
            if (join_arc(&arcs->items[i], &arcs->items[k], size)) {
                arcs->items[k] = arcs->items[--arcs->count];
                k              = i;
            }
}

/* ---- the boundary ---- */

static void make_table(struct Boundary *boundary, Span span, Arena *scratch)
{
    OutlineShape *table = arena_new(boundary->arena, OutlineShape);
    Outline      *all   = &table->outline;
    *table              = (OutlineShape){.span = span};
    all->pieces         = arena_new_array(boundary->arena, Piece, boundary->lines.count + 1);
    all->count          = (uint32_t)boundary->lines.count;
    for (uint32_t i = 0; i < all->count; i++)
        all->pieces[i].curve = boundary->lines.items[i];
    table->instances      = outline_instances(all, boundary->arena, scratch);
    boundary->table       = table;
    boundary->lines.count = 0;
}

/* Leaves out the pieces that lie on the axis; returns false if there are none, or some are beyond it. */
static bool drop_axis(Curves *curves, double axis)
{
    double slack = 1e-9 * (curves_size(curves) + fabs(axis));
    size_t kept  = 0;
    for (size_t i = 0; i < curves->count; i++) {
        const Curve *curve = &curves->items[i];
        if (curve->from[0] < axis - slack || curve->to[0] < axis - slack)
            return false;
        if (!curve->straight || curve->from[0] > axis + slack || curve->to[0] > axis + slack)
            curves->items[kept++] = *curve;
    }
    const bool any = kept < curves->count;
    curves->count  = kept;
    return any;
}

static void find_boundary(Lowering *l, const Shape *shape, struct Boundary *boundary)
{
    const Shape *figure = boundary->axis ? shape->children[0] : shape;
    Curves       curves = {0};
    bool         curved = false, changed;
    boundary->state     = BOUNDARY_UNKNOWN;
    if (!figure_outline(l->graph, figure, l->scratch, &curves, &changed) ||
        (boundary->axis && !drop_axis(&curves, *boundary->axis)) || curves.count == 0 ||
        !(changed || boundary->axis))
        return;
    for (size_t i = 0; i < curves.count; i++) {
        const Curve *curve = &curves.items[i];
        if (curve->radius > 0)
            array_push(boundary->arena, &boundary->arcs, arc_of(curve));
        else
            array_push(boundary->arena, &boundary->lines, *curve);
        curved = curved || !(curve->straight || curve->radius > 0);
    }
    join_arcs(&boundary->arcs, curves_size(&curves));
    if (boundary->arcs.count > MAX_ARCS)
        return;
    if (curved || boundary->lines.count > MAX_LINES)
        make_table(boundary, shape->span, l->scratch);
    boundary->state = BOUNDARY_KNOWN;
}

/* ---- the distance ---- */

static Node vec2(Graph *g, Node x, Node y) { return graph_op2(g, OP_vec2, x, y); }

static Node known_vec2(Graph *g, const double v[2]) { return graph_constant(g, TYPE_VEC2, v); }

static Node square_to_line(Graph *g, const Curve *line, Node point)
{
    double way[2]   = {line->to[0] - line->from[0], line->to[1] - line->from[1]};
    double square   = way[0] * way[0] + way[1] * way[1];
    double share[2] = {way[0] / square, way[1] / square};
    Node   away = sub(g, point, known_vec2(g, line->from)), along = known_vec2(g, share);
    Node   t   = graph_op2(g, OP_dot, away, along);
    Node   one = graph_number(g, 1), zero = graph_number(g, 0);
    t         = graph_op3(g, OP_clamp, t, zero, one);
    Node part = mul(g, known_vec2(g, way), t);
    away      = sub(g, away, part);
    return graph_op2(g, OP_dot, away, away);
}

/* Returns the squared distance to an arc.  Mirrored at its middle, it has one end; what is beyond
   that is nearest to it. */
static Node square_to_arc(Graph *g, const Arc *arc, Node point)
{
    double middle[2] = {real_cos(arc->middle), real_sin(arc->middle)},
           left[2]   = {-middle[1], middle[0]};
    double end[2]    = {arc->radius * real_cos(arc->half), arc->radius * real_sin(arc->half)};
    Node   away      = sub(g, point, known_vec2(g, arc->centre));
    Node   length    = graph_op1(g, OP_length, away);
    Node   over      = sub(g, length, graph_number(g, arc->radius));
    if (arc->half > M_PI - 1e-7)
        return mul(g, over, over);
    Node x      = graph_op2(g, OP_dot, away, known_vec2(g, middle));
    Node y      = graph_op2(g, OP_dot, away, known_vec2(g, left));
    y           = graph_op1(g, OP_abs, y);
    Node up     = mul(g, y, graph_number(g, real_cos(arc->half)));
    Node along  = mul(g, x, graph_number(g, real_sin(arc->half)));
    Node beside = graph_op2(g, OP_less, up, along);
    Node corner = known_vec2(g, end);
    Node beyond = sub(g, vec2(g, x, y), corner);
    Node within = vec2(g, over, graph_number(g, 0));
    Node to     = graph_op3(g, OP_select, beside, within, beyond);
    return graph_op2(g, OP_dot, to, to);
}

static Node min_of(Graph *g, const Node *nodes, size_t count)
{
    if (count == 1)
        return nodes[0];
    Node first = min_of(g, nodes, count / 2);
    Node last  = min_of(g, nodes + count / 2, count - count / 2);
    return graph_op2(g, OP_min, first, last);
}

static Node distance_to_pieces(Lowering *l, const struct Boundary *boundary, Node point)
{
    Graph *g     = l->graph;
    size_t count = boundary->lines.count + boundary->arcs.count, next = 0;
    Node  *squares = arena_new_array(l->scratch, Node, count + 1);
    Node   x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    point = vec2(g, x, y);
    for (size_t i = 0; i < boundary->lines.count; i++)
        squares[next++] = square_to_line(g, &boundary->lines.items[i], point);
    for (size_t i = 0; i < boundary->arcs.count; i++)
        squares[next++] = square_to_arc(g, &boundary->arcs.items[i], point);
    return count ? graph_op1(g, OP_sqrt, min_of(g, squares, count)) : NODE_NONE;
}

static Node distance_to_table(Lowering *l, struct Boundary *boundary, double reach, Node point)
{
    bool is_new;
    Node distance = outline_distance(l->graph, boundary->table, reach, point, &is_new, l->scratch);
    if (is_new && l->groups)
        lowered_groups_made(l->groups);
    return graph_op1(l->graph, OP_abs, distance);
}

static bool boundary_counts(Lowering *l, const Shape *shape, LowerContext context)
{
    struct Boundary *boundary = shape->boundary;
    if (!boundary || !(context.reach > 0) || !(l->groups || l->far))
        return false;
    if (boundary->state == BOUNDARY_NEW)
        find_boundary(l, shape, boundary);
    return boundary->state == BOUNDARY_KNOWN;
}

/* Returns the distance to the boundary, with the sign of `joined`, which is 0 also within: on seams. */
static Node boundary_distance(Lowering *l, struct Boundary *boundary, double reach, Node point,
                              Node joined)
{
    Graph *g    = l->graph;
    Node   near = distance_to_pieces(l, boundary, point);
    if (boundary->table) {
        Node table = distance_to_table(l, boundary, reach, point);
        near       = near == NODE_NONE ? table : graph_op2(g, OP_min, near, table);
    }
    Node outside = graph_op2(g, OP_less, graph_number(g, 0), joined);
    return graph_op3(g, OP_select, outside, near, neg(g, near));
}

Lowered lower_within_boundary(Lowering *l, const Shape *shape, LowerContext context, Node point,
                              LowerShape *by_parts)
{
    if (!boundary_counts(l, shape, context))
        return by_parts(l, shape, context);
    LowerContext sides = context; /* what is asked of the parts is the side alone */
    sides.reach        = 0;
    Lowered result     = by_parts(l, shape, sides);
    if (result.distance != NODE_NONE)
        result.distance = boundary_distance(l, shape->boundary, context.reach, point,
                                            result.distance);
    return result;
}
