/*
 * boundary.c: finds the boundary of a CSG node of figures, and builds the distance to it.
 */
#include "compiler/lower/boundary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/build.h"
#include "compiler/graph/instances/iterations.h"
#include "compiler/lower/instance_groups.h"
#include "compiler/lower/outline.h"

/* More lines go to a table, and more arcs are left. */
enum { MAX_LINES = 48, MAX_ARCS = 192, MAX_ITERATIONS = 8 };

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
};

struct Boundary *boundary_new(Arena *arena)
{
    struct Boundary *boundary = arena_new(arena, struct Boundary);
    boundary->arena           = arena;
    return boundary;
}

/* ---- outlines of the parts ---- */

/* The walk through a CSG node; all that it makes is scratch. */
typedef struct Gathering {
    Graph       *graph;
    Arena       *scratch;
    const Shape *iterations[MAX_ITERATIONS]; /* around the shape at hand */
    uint32_t     iteration_count;
    bool         changed; /* some part of an outline is gone, or its distance is only a bound */
} Gathering;

static bool gather(Gathering *g, const Shape *shape, Curves *curves);

/* Finds a number that is known now; false: it is not. */
static bool known(Gathering *g, Node node, uint32_t component, double *number)
{
    for (uint32_t i = g->iteration_count; i > 0; i--)
        node = graph_in_iteration(g->graph, node, g->iterations[i - 1]->iteration,
                                  g->iterations[i - 1]->number, g->scratch);
    return graph_known_component(g->graph, node, component, number) && isfinite(*number);
}

static void append(Gathering *g, Curves *curves, const Curves *more)
{
    for (size_t i = 0; i < more->count; i++)
        array_push(g->scratch, curves, more->items[i]);
}

/* Leaves the outline of what contours fill. */
static bool resolve(Gathering *g, Curves *curves, FillRule rule)
{
    Outline outline;
    double  at[2];
    if (outline_make(&outline, curves, rule, g->scratch, g->scratch, at) != OUTLINE_GOOD)
        return false;
    *curves = (Curves){0};
    for (uint32_t i = 0; i < outline.count; i++)
        array_push(g->scratch, curves, outline.pieces[i].curve);
    return true;
}

static void reverse_all(Curves *curves)
{
    for (size_t i = 0; i < curves->count; i++)
        curves->items[i] = curve_reversed(&curves->items[i]);
}

static bool known_corner(Gathering *g, const BorderCorner *corner, double numbers[3])
{
    for (uint32_t k = 0; k < 3; k++) {
        numbers[k] = corner->numbers[k];
        if (corner->nodes[k] != NODE_NONE && !known(g, corner->nodes[k], 0, &numbers[k]))
            return false;
    }
    return true;
}

static bool gather_primitive(Gathering *g, const Shape *shape, Curves *curves)
{
    const Border *border = shape->border;
    Path          path   = {.arena = g->scratch};
    double        first[3], from[3], to[3];
    bool          round = false;
    if (box_is_empty(shape->box))
        return true;
    for (uint32_t i = 0; shape->outline && i < shape->outline->outline.count; i++)
        array_push(g->scratch, curves, shape->outline->outline.pieces[i].curve);
    if (shape->outline)
        return true;
    if (!border || border->count < 2 || !shape->exact ||
        !known_corner(g, &border->corners[0], first))
        return false;
    path_move(&path, first);
    memcpy(from, first, sizeof from);
    for (uint32_t i = 1; i <= border->count; i++) {
        if (!known_corner(g, &border->corners[i % border->count], to))
            return false;
        path_arc(&path, to, from[2]);
        round = round || from[2] != 0;
        memcpy(from, to, sizeof from);
    }
    *curves = path.curves;
    return resolve(g, curves, round ? FILL_NONZERO : FILL_EVEN_ODD);
}

/* The map p -> m p + shift of the plane. */
typedef struct PlaneMap {
    double m[2][2], shift[2];
} PlaneMap;

static void map_point(const PlaneMap *map, double p[2])
{
    double q[2] = {p[0], p[1]};
    for (int i = 0; i < 2; i++)
        p[i] = map->m[i][0] * q[0] + map->m[i][1] * q[1] + map->shift[i];
}

static bool map_all(const PlaneMap *map, Curves *curves)
{
    double size = map->m[0][0] * map->m[1][1] - map->m[0][1] * map->m[1][0];
    double ways = map->m[0][0] * map->m[0][1] + map->m[1][0] * map->m[1][1];
    double x = real_hypot(map->m[0][0], map->m[1][0]), y = real_hypot(map->m[0][1], map->m[1][1]);
    bool   even = fabs(x - y) <= 1e-12 * x && fabs(ways) <= 1e-12 * x * y;
    for (size_t i = 0; i < curves->count; i++) {
        Curve *curve = &curves->items[i];
        if (curve->radius > 0 && !even)
            return false;
        map_point(map, curve->from);
        map_point(map, curve->via);
        map_point(map, curve->to);
        map_point(map, curve->centre);
        curve->radius *= x;
    }
    if (size < 0)
        reverse_all(curves);
    return size != 0;
}

static bool gather_transform(Gathering *g, const Shape *shape, Curves *curves)
{
    PlaneMap map;
    double   scale, upright;
    if (!known(g, shape->map.scale, 0, &scale) || !known(g, shape->map.rows[2], 2, &upright) ||
        !(fabs(upright) > 1 - 1e-9) || !gather(g, shape->children[0], curves))
        return false;
    for (uint32_t i = 0; i < 2; i++) {
        if (!known(g, shape->map.shift, i, &map.shift[i]))
            return false;
        for (uint32_t k = 0; k < 2; k++) {
            if (!known(g, shape->map.rows[i], k, &map.m[i][k]))
                return false;
            map.m[i][k] *= scale;
        }
    }
    return map_all(&map, curves);
}

static bool gather_stretch(Gathering *g, const Shape *shape, Curves *curves)
{
    PlaneMap map = {{{0, 0}, {0, 0}}, {0, 0}};
    g->changed   = true;
    return known(g, shape->values[0], 0, &map.m[0][0]) &&
           known(g, shape->values[0], 1, &map.m[1][1]) && gather(g, shape->children[0], curves) &&
           map_all(&map, curves);
}

static double length_of(const Curves *curves)
{
    double length = 0;
    for (size_t i = 0; i < curves->count; i++)
        length += real_hypot(curves->items[i].to[0] - curves->items[i].from[0],
                             curves->items[i].to[1] - curves->items[i].from[1]);
    return length;
}

/* Gathers the union of some parts. */
static bool gather_union(Gathering *g, const Shape *shape, uint32_t first, Curves *curves)
{
    for (uint32_t i = first; i < shape->child_count; i++) {
        Curves part = {0};
        if (!gather(g, shape->children[i], &part))
            return false;
        append(g, curves, &part);
    }
    double length = length_of(curves);
    if (shape->child_count - first == 1)
        return true;
    bool good  = resolve(g, curves, FILL_NONZERO);
    g->changed = g->changed || fabs(length_of(curves) - length) > 1e-9 * length;
    return good;
}

/* Joins the outlines of parts one by one. */
static bool gather_csg_node(Gathering *g, const Shape *shape, FillRule rule, Curves *curves)
{
    g->changed = true;
    if (!gather(g, shape->children[0], curves))
        return false;
    for (uint32_t i = 1; i < shape->child_count; i++) {
        Curves next = {0};
        if (!gather(g, shape->children[i], &next))
            return false;
        append(g, curves, &next);
        if (!resolve(g, curves, rule))
            return false;
    }
    return true;
}

static bool gather_difference(Gathering *g, const Shape *shape, Curves *curves)
{
    Curves tools = {0};
    g->changed   = true;
    if (!gather(g, shape->children[0], curves) || !gather_union(g, shape, 1, &tools))
        return false;
    reverse_all(&tools);
    append(g, curves, &tools);
    return resolve(g, curves, FILL_POSITIVE);
}

/* ---- outlines that grow ---- */

/* Finds the unit normal on the right of a curve, where the outside is. */
static void outside_at(const Curve *curve, double t, double normal[2])
{
    double tangent[2];
    curve_tangent(curve, t, tangent);
    double length = real_hypot(tangent[0], tangent[1]);
    normal[0]     = tangent[1] / length;
    normal[1]     = -tangent[0] / length;
}

static void away(const double at[2], const double normal[2], double by, double point[2])
{
    point[0] = at[0] + by * normal[0];
    point[1] = at[1] + by * normal[1];
}

/* Returns the tangent of a quarter of the angle that an arc turns by; of lines 0. */
static double bulge_of(const Curve *curve)
{
    double first[2], last[2];
    outside_at(curve, 0, first);
    outside_at(curve, 1, last);
    double turn = real_atan2(first[0] * last[1] - first[1] * last[0],
                             first[0] * last[0] + first[1] * last[1]);
    return curve->radius > 0 ? real_tan(0.25 * turn) : 0;
}

/* Draws what lies beside a curve, to the right of it.  Of an arc around what is outside no more
   than up to its centre: what is beyond that is nearer to the ends. */
static void draw_beside(Path *path, const Curve *curve, double by)
{
    double bulge  = bulge_of(curve), normals[2][2], ends[2][2];
    bool   closes = bulge < 0 && curve->radius <= by * (1 + 1e-9);
    outside_at(curve, 0, normals[0]);
    outside_at(curve, 1, normals[1]);
    away(curve->from, normals[0], by, ends[0]);
    away(curve->to, normals[1], by, ends[1]);
    path_move(path, curve->from);
    path_line(path, closes ? curve->centre : ends[0]);
    if (!closes)
        path_arc(path, ends[1], bulge);
    path_line(path, curve->to);
    path_arc(path, curve->from, -bulge);
}

static double angle_of(const double v[2]) { return real_atan2(v[1], v[0]); }

/* Draws the sector around the end of a curve, up to the next curve to its right. */
static void draw_corner(Path *path, const Curves *curves, const Curve *curve, double by,
                        double size)
{
    double normal[2], next[2], least = HUGE_VAL, ends[2][2];
    outside_at(curve, 1, normal);
    for (size_t i = 0; i < curves->count; i++) {
        const Curve *other = &curves->items[i];
        if (real_hypot(other->from[0] - curve->to[0], other->from[1] - curve->to[1]) > 1e-8 * size)
            continue;
        outside_at(other, 0, next);
        /* The outside there has a sector from half of a rotation on. */
        double angle = M_PI + angle_of(next) - angle_of(normal);
        angle        = remainder(angle - M_PI, 2 * M_PI) + M_PI;
        least        = fmin(least, angle);
    }
    double turn = least - M_PI;
    if (!(turn > 1e-9) || turn > M_PI)
        return;
    double begin = angle_of(normal);
    away(curve->to, normal, by, ends[0]);
    away(curve->to, (double[]){real_cos(begin + turn), real_sin(begin + turn)}, by, ends[1]);
    path_move(path, curve->to);
    path_line(path, ends[0]);
    path_arc(path, ends[1], real_tan(0.25 * turn));
    path_close(path);
}

static double size_of(const Curves *curves)
{
    double size = 0;
    for (size_t i = 0; i < curves->count; i++)
        for (int k = 0; k < 2; k++)
            size = fmax(size, fmax(fabs(curves->items[i].from[k]), curves->items[i].radius));
    return size;
}

/* Leaves the outline of what is no farther than `by` from the inside; below 0, of what is farther than
   that from the outside.  False: there are Bezier curves. */
static bool grow(Gathering *g, Curves *curves, double by)
{
    Path   path = {.arena = g->scratch};
    double size = size_of(curves);
    Curves all  = {0};
    append(g, &all, curves);
    if (by < 0)
        reverse_all(curves);
    for (size_t i = 0; i < curves->count; i++) {
        if (!curves->items[i].straight && !(curves->items[i].radius > 0))
            return false;
        draw_beside(&path, &curves->items[i], fabs(by));
        draw_corner(&path, curves, &curves->items[i], fabs(by), size);
    }
    if (by < 0)
        reverse_all(&path.curves);
    append(g, &all, &path.curves);
    *curves = all;
    return by == 0 || resolve(g, curves, FILL_POSITIVE);
}

static bool gather_offset(Gathering *g, const Shape *shape, Curves *curves)
{
    double by;
    g->changed = true;
    return known(g, shape->values[0], 0, &by) && gather(g, shape->children[0], curves) &&
           grow(g, curves, by);
}

static bool gather_shell(Gathering *g, const Shape *shape, Curves *curves)
{
    double thickness;
    Curves inner = {0};
    g->changed   = true;
    if (!known(g, shape->values[0], 0, &thickness) || !(thickness > 0) ||
        !gather(g, shape->children[0], curves))
        return false;
    append(g, &inner, curves);
    if (!grow(g, curves, 0.5 * thickness) || !grow(g, &inner, -0.5 * thickness))
        return false;
    reverse_all(&inner);
    append(g, curves, &inner);
    return resolve(g, curves, FILL_POSITIVE);
}

/* ---- copies ---- */

/* Gathers what is in dot(u, p) <= w, and its mirror image. */
static bool gather_mirror(Gathering *g, const Shape *shape, Curves *curves)
{
    double u[2], w;
    g->changed = true;
    if (!known(g, shape->values[0], 0, &u[0]) || !known(g, shape->values[0], 1, &u[1]) ||
        !known(g, shape->values[1], 0, &w) || !gather(g, shape->children[0], curves) ||
        !(real_hypot(u[0], u[1]) > 1 - 1e-9))
        return false;
    double   far = 4 * (size_of(curves) + fabs(w)), at[2] = {w * u[0], w * u[1]};
    double   along[2] = {-u[1] * far, u[0] * far};
    Path     half     = {.arena = g->scratch};
    Curves   image    = {0};
    PlaneMap mirror   = {
          {{1 - 2 * u[0] * u[0], -2 * u[0] * u[1]}, {-2 * u[0] * u[1], 1 - 2 * u[1] * u[1]}},
          {2 * at[0], 2 * at[1]}};
    path_move(&half, (double[]){at[0] - along[0], at[1] - along[1]});
    path_line(&half, (double[]){at[0] + along[0], at[1] + along[1]});
    path_line(&half, (double[]){at[0] + along[0] - far * u[0], at[1] + along[1] - far * u[1]});
    path_line(&half, (double[]){at[0] - along[0] - far * u[0], at[1] - along[1] - far * u[1]});
    path_close(&half);
    append(g, curves, &half.curves);
    if (!resolve(g, curves, FILL_TWICE))
        return false;
    append(g, &image, curves);
    if (!map_all(&mirror, &image))
        return false;
    append(g, curves, &image);
    return resolve(g, curves, FILL_NONZERO);
}

/* Gathers the copies of a lattice about the origin that ends. */
static bool gather_repeat(Gathering *g, const Shape *shape, Curves *curves)
{
    enum { MAX_COPIES = 1000 };
    const uint32_t *cells     = shape->cells;
    double          period[2] = {0, 0};
    Curves          part      = {0};
    g->changed                = true;
    if (shape->values[1] != NODE_NONE || cells[2] != 1 || cells[0] == 0 || cells[1] == 0 ||
        (double)cells[0] * cells[1] > MAX_COPIES || !gather(g, shape->children[0], &part))
        return false;
    for (uint32_t k = 0; k < 2; k++)
        if (cells[k] > 1 && !known(g, shape->values[0], k, &period[k]))
            return false;
    for (uint32_t i = 0; i < cells[0] * cells[1]; i++) {
        Curves   copy = {0};
        PlaneMap move = {{{1, 0}, {0, 1}},
                         {(i % cells[0] - 0.5 * (cells[0] - 1)) * period[0],
                          ((double)(i / cells[0]) - 0.5 * (cells[1] - 1)) * period[1]}};
        append(g, &copy, &part);
        if (!map_all(&move, &copy))
            return false;
        append(g, curves, &copy);
    }
    return resolve(g, curves, FILL_NONZERO);
}

/* ---- any part ---- */

static bool gather_iteration(Gathering *g, const Shape *shape, Curves *curves)
{
    if (g->iteration_count == MAX_ITERATIONS)
        return false;
    g->iterations[g->iteration_count++] = shape;
    bool good                           = gather(g, shape->iterated, curves);
    g->iteration_count--;
    return good;
}

/* Gathers the outline of a figure, with the inside on its left; false: it is not known. */
static bool gather(Gathering *g, const Shape *shape, Curves *curves)
{
    if (shape->blend.width != NODE_NONE)
        return false;
    switch (shape->kind) {
    case SHAPE_EMPTY: return true;
    case SHAPE_PRIMITIVE: return gather_primitive(g, shape, curves);
    case SHAPE_TRANSFORM: return gather_transform(g, shape, curves);
    case SHAPE_STRETCH: return gather_stretch(g, shape, curves);
    case SHAPE_UNION: return gather_union(g, shape, 0, curves);
    case SHAPE_INTERSECTION: return gather_csg_node(g, shape, FILL_TWICE, curves);
    case SHAPE_XOR: return gather_csg_node(g, shape, FILL_EVEN_ODD, curves);
    case SHAPE_DIFFERENCE: return gather_difference(g, shape, curves);
    case SHAPE_OFFSET: return gather_offset(g, shape, curves);
    case SHAPE_SHELL: return gather_shell(g, shape, curves);
    case SHAPE_MIRROR: return gather_mirror(g, shape, curves);
    case SHAPE_REPEAT: return gather_repeat(g, shape, curves);
    case SHAPE_ITERATION: return gather_iteration(g, shape, curves);
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: return gather(g, shape->children[0], curves);
    default: return false;
    }
}

bool boundary_outline(Graph *graph, const Shape *figure, Arena *arena, Curves *curves)
{
    Gathering g = {.graph = graph, .scratch = arena};
    return gather(&g, figure, curves);
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

static void find_boundary(Lowering *l, const Shape *csg_node, struct Boundary *boundary)
{
    Gathering g      = {.graph = l->graph, .scratch = l->scratch};
    Curves    curves = {0};
    bool      curved = false;
    boundary->state  = BOUNDARY_UNKNOWN;
    if (!gather(&g, csg_node, &curves) || curves.count == 0 || !g.changed)
        return;
    for (size_t i = 0; i < curves.count; i++) {
        const Curve *curve = &curves.items[i];
        if (curve->radius > 0)
            array_push(boundary->arena, &boundary->arcs, arc_of(curve));
        else
            array_push(boundary->arena, &boundary->lines, *curve);
        curved = curved || !(curve->straight || curve->radius > 0);
    }
    join_arcs(&boundary->arcs, size_of(&curves));
    if (boundary->arcs.count > MAX_ARCS)
        return;
    if (curved || boundary->lines.count > MAX_LINES)
        make_table(boundary, csg_node->span, l->scratch);
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

static bool boundary_counts(Lowering *l, const Shape *csg_node, LowerContext context)
{
    struct Boundary *boundary = csg_node->boundary;
    if (!boundary || !(context.reach > 0) || !(l->groups || l->far))
        return false;
    if (boundary->state == BOUNDARY_NEW)
        find_boundary(l, csg_node, boundary);
    return boundary->state == BOUNDARY_KNOWN;
}

static Node boundary_distance(Lowering *l, const Shape *csg_node, LowerContext context, Node joined)
{
    Graph           *g        = l->graph;
    struct Boundary *boundary = csg_node->boundary;
    Node             near     = distance_to_pieces(l, boundary, context.point);
    if (boundary->table) {
        Node table = distance_to_table(l, boundary, context.reach, context.point);
        near       = near == NODE_NONE ? table : graph_op2(g, OP_min, near, table);
    }
    Node inside = graph_op2(g, OP_less, joined, graph_number(g, 0));
    return graph_op3(g, OP_select, inside, neg(g, near), near);
}

Lowered lower_within_boundary(Lowering *l, const Shape *csg_node, LowerContext context,
                              LowerShape *by_parts)
{
    if (!boundary_counts(l, csg_node, context))
        return by_parts(l, csg_node, context);
    LowerContext sides = context; /* what is asked of the parts is the side alone */
    sides.reach        = 0;
    Lowered result     = by_parts(l, csg_node, sides);
    if (result.distance != NODE_NONE)
        result.distance = boundary_distance(l, csg_node, context, result.distance);
    return result;
}
