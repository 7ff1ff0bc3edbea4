/*
 * figure_outline.c: finds the outline of a figure by those of its parts.
 */
#include "compiler/lower/figure_outline.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/instances/iterations.h"
#include "compiler/lower/outline.h"

enum { MAX_ITERATIONS = 8 };

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

double curves_size(const Curves *curves)
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
    double size = curves_size(curves);
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
    double   far = 4 * (curves_size(curves) + fabs(w)), at[2] = {w * u[0], w * u[1]};
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

bool figure_outline(Graph *graph, const Shape *figure, Arena *arena, Curves *curves, bool *changed)
{
    Gathering  g     = {.graph = graph, .scratch = arena};
    const bool known = gather(&g, figure, curves);
    *changed         = g.changed;
    return known;
}
