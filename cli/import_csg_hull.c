/*
 * import_csg_hull.c: OpenSCAD's solids and figures that are given by points, hulls, and sums with
 * balls.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/import_csg_node.h"
#include "compiler/base/vec.h"

enum { MOST_POINTS = 4096, MOST_PATHS = 500 };

/* ---- polygons ---- */

static Part *polygon_part(const CsgNode *node, double (*points)[3], size_t count)
{
    Text list = {.arena = node->import->arena};
    for (size_t i = 0; i < count; i++)
        text_format(&list, "%s%s", i == 0 ? "" : ", ",
                    import_vector_text(node->import, points[i], 2));
    Part *part   = part_shape(node->import, node->line, "polygon", "polygon([%s])", list.bytes);
    part->figure = true;
    part->balls  = (PartBalls){points, count, count, 0};
    return part;
}

/* One of `paths`, a list of indices. */
static bool path_points(const CsgNode *node, const CsgValue *path, double (*points)[3],
                        size_t count, double (**chosen)[3])
{
    size_t corners = path->kind == CSG_LIST ? path->list.count : 0;
    *chosen        = arena_alloc(node->import->arena, corners + 1, sizeof **chosen);
    for (size_t i = 0; i < corners; i++) {
        const CsgValue *index = &path->list.items[i];
        if (index->kind != CSG_NUMBER || !(index->number >= 0 && index->number < (double)count))
            return import_refuse(node->import, node->line, "`%s` has no point of this index",
                                 node->name);
        memcpy((*chosen)[i], points[(size_t)index->number], sizeof **chosen);
    }
    return corners >= 3 ||
           import_refuse(node->import, node->line, "`%s` needs three points at least", node->name);
}

/* Several paths: what is in an odd number of them. */
bool csg_polygon(const CsgNode *node, Part **part)
{
    const CsgValue *list = csg_argument(node, "points"), *paths = csg_argument(node, "paths");
    double(*points)[3], (*chosen)[3];
    if (!csg_points(node, list, 2, &points))
        return false;
    size_t count = list->list.count;
    if (!paths || paths->kind != CSG_LIST || paths->list.count == 0) {
        *part = polygon_part(node, points, count);
        return count >= 3 ||
               import_refuse(node->import, node->line, "`polygon` needs three points at least");
    }
    if (paths->list.count > MOST_PATHS)
        return import_refuse(node->import, node->line, "`polygon` has more than %d paths",
                             MOST_PATHS);
    for (size_t i = 0; i < paths->list.count; i++) {
        if (!path_points(node, &paths->list.items[i], points, count, &chosen))
            return false;
        Part *path = polygon_part(node, chosen, paths->list.items[i].list.count);
        Part *both = part_new(node->import, node->line, "polygons");
        both->join = PART_XOR;
        if (i > 0) {
            part_add(node->import, both, *part);
            part_add(node->import, both, path);
        }
        *part = i > 0 ? both : path;
    }
    return true;
}

/* ---- polyhedra ---- */

/* Whether all points are on one side of a face. */
static bool face_is_outside(double (*const points)[3], size_t count, const double *a,
                            const double *b, const double *c)
{
    double first[3], second[3], normal[3], size = 0;
    bool   above = false, below = false;
    add_scaled3(first, b, -1, a);
    add_scaled3(second, c, -1, a);
    cross3(first, second, normal);
    for (size_t i = 0; i < count; i++)
        size = fmax(size, distance3(points[i], a));
    double slack = 1e-6 * size * length3(normal);
    for (size_t i = 0; i < count; i++) {
        double offset[3];
        add_scaled3(offset, points[i], -1, a);
        above = above || dot3(normal, offset) > slack;
        below = below || dot3(normal, offset) < -slack;
    }
    return !(above && below);
}

static Part *hull_part(const CsgNode *node, const PartBalls *balls)
{
    Text list = {.arena = node->import->arena};
    for (size_t i = 0; i < balls->count; i++)
        text_format(&list, "%s%s",
                    i == 0  ? ""
                    : i % 4 ? ", "
                            : ",\n    ",
                    import_vector_text(node->import, balls->points[i], 3));
    Part *part  = part_shape(node->import, node->line, "hull",
                            balls->radius > 0 ? "hull([%s], %s)" : "hull([%s])", list.bytes,
                             import_number_text(node->import, balls->radius));
    part->balls = *balls;
    return part;
}

/* Those that are convex are the hull of their points. */
bool csg_polyhedron(const CsgNode *node, Part **part)
{
    const CsgValue *list = csg_argument(node, "points"), *faces = csg_argument(node, "faces");
    double(*points)[3], (*corners)[3];
    if (!csg_points(node, list, 3, &points))
        return false;
    size_t count = list->list.count;
    if (!faces || faces->kind != CSG_LIST || faces->list.count < 4 || count > MOST_POINTS ||
        faces->list.count > 2 * MOST_POINTS)
        return import_refuse(node->import, node->line,
                             "a polyhedron needs four faces, and at most %d points", MOST_POINTS);
    for (size_t i = 0; i < faces->list.count; i++) {
        if (!path_points(node, &faces->list.items[i], points, count, &corners))
            return false;
        size_t last = faces->list.items[i].list.count - 1;
        if (!face_is_outside(points, count, corners[0], corners[1], corners[last]))
            return import_refuse(node->import, node->line,
                                 "a polyhedron that is not convex is not translated");
    }
    PartBalls balls = {points, count, count, 0};
    *part           = hull_part(node, &balls);
    return true;
}

/* ---- hulls ---- */

/* Adds the balls of which a part is the hull; false where it is something else. */
static bool collect(Import *import, const Part *part, const Place *outer, PartBalls *all)
{
    Place  place  = place_chain(&part->place, outer);
    double factor = place_factor(&place), radius = part->balls.radius * factor;
    if (part->methods || part->join != PART_UNION || (part->shape && !part->balls.points))
        return false;
    for (size_t i = 0; i < part->parts.count; i++)
        if (!collect(import, part->parts.items[i], &place, all))
            return false;
    if (!part->shape)
        return true;
    if (part->balls.radius > 0 && factor == 0)
        return false;
    if (all->count > 0 && fabs(radius - all->radius) > 1e-9 * radius)
        return false;
    if (all->count + part->balls.count > all->capacity) {
        all->capacity     = 2 * (all->count + part->balls.count);
        double(*wider)[3] = arena_alloc(import->arena, all->capacity, sizeof *wider);
        if (all->count > 0)
            memcpy(wider, all->points, all->count * sizeof *wider);
        all->points = wider;
    }
    for (size_t i = 0; i < part->balls.count; i++)
        place_apply(&place, part->balls.points[i], all->points[all->count++]);
    all->radius = radius;
    return all->count <= MOST_POINTS;
}

static int compare_points(const void *left, const void *right)
{
    const double *a = left, *b = right;
    if (a[0] != b[0])
        return a[0] < b[0] ? -1 : 1;
    return a[1] != b[1] ? (a[1] < b[1] ? -1 : 1) : 0;
}

/* Andrew's chain: the corners of the hull, counterclockwise; at most 2 when it is a line. */
static size_t convex_corners(Import *import, PartBalls *balls)
{
    size_t n = balls->count, count = 0;
    double(*points)[3] = balls->points;
    double(*chain)[3]  = arena_alloc(import->arena, 2 * n + 1, sizeof *chain);
    qsort(points, n, sizeof *points, compare_points);
    for (size_t turn = 0, bottom = 0; turn<2; turn++, bottom = count> 0 ? count - 1 : 0)
        for (size_t i = 0; i < n; i++) {
            const double *p = points[turn ? n - 1 - i : i];
            if (count > 0 && compare_points(chain[count - 1], p) == 0)
                continue;
            while (count >= bottom + 2) {
                const double *a = chain[count - 2], *b = chain[count - 1];
                if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0)
                    break;
                count--;
            }
            memcpy(chain[count++], p, sizeof *chain);
        }
    if (count > 1 && compare_points(chain[0], chain[count - 1]) == 0)
        count--;
    balls->points = chain;
    balls->count  = count;
    return count;
}

static bool hull_of_figures(const CsgNode *node, PartBalls *balls, Part **part)
{
    Import     *import  = node->import;
    size_t      corners = convex_corners(import, balls);
    const char *radius  = import_number_text(import, balls->radius);
    if (corners < 3 && balls->radius == 0)
        return import_refuse(import, node->line, "the hull of points on a line is nothing");
    if (corners == 1)
        *part = part_shape(import, node->line, "hull", "circle(%s)", radius);
    else if (corners == 2)
        *part = part_shape(import, node->line, "hull", "segment(%s, %s, %s)",
                           import_vector_text(import, balls->points[0], 2),
                           import_vector_text(import, balls->points[1], 2),
                           import_number_text(import, 2 * balls->radius));
    else
        *part = polygon_part(node, balls->points, corners);
    if (corners == 1) {
        Place place = place_move(balls->points[0]);
        part_move(*part, &place);
    }
    (*part)->figure = true;
    (*part)->balls  = *balls;
    if (corners > 2 && balls->radius > 0) {
        Text text = {.arena = import->arena};
        text_format(&text, "%s.offset(%s)", (*part)->shape, radius);
        (*part)->shape = text.bytes;
    }
    if (corners == 1) /* its place moves it already */
        memset((*part)->balls.points[0], 0, sizeof *balls->points);
    return true;
}

bool csg_hull(const CsgNode *node, Part **part)
{
    Part     *joined = NULL;
    PartBalls balls  = {0};
    Place     here   = place_identity();
    if (!node->parts)
        return true;
    if (!csg_joined(node, node->parts->figure, &joined))
        return false;
    if (!collect(node->import, joined, &here, &balls))
        return import_refuse(node->import, node->line,
                             "a hull is translated if it is of points, or of balls of one size");
    if (joined->figure)
        return hull_of_figures(node, &balls, part);
    *part = hull_part(node, &balls);
    if (balls.count == 1) {
        *part = part_shape(node->import, node->line, "hull", "sphere(%s)",
                           import_number_text(node->import, balls.radius));
        here  = place_move(balls.points[0]);
        part_move(*part, &here);
        (*part)->balls = (PartBalls){arena_alloc(node->import->arena, 1, sizeof *balls.points), 1,
                                     1, balls.radius};
    }
    return true;
}

/* ---- sums with balls ---- */

static Part *grown(const CsgNode *node, Part *part, double radius)
{
    Text methods = {.arena = node->import->arena};
    text_format(&methods, ".offset(%s)", import_number_text(node->import, radius));
    if (part->join == PART_INTERSECTION || part->join == PART_DIFFERENCE)
        import_note(node->import, node->line, "edges of what is cut are grown, not rounded, there");
    Part *around    = part_around(node->import, node->line, "grown", part);
    around->methods = methods.bytes;
    return around;
}

bool csg_minkowski(const CsgNode *node, Part **part)
{
    Place here = place_identity();
    if (!node->parts || node->lacks)
        return true;
    Part *other = NULL, *joined = NULL;
    if (!csg_joined(node, node->parts->figure, &joined))
        return false;
    double radius = 0, shift[3] = {0, 0, 0};
    for (size_t i = 0; i < node->parts->parts.count; i++) {
        Part     *item  = node->parts->parts.items[i];
        PartBalls balls = {0};
        if (collect(node->import, item, &here, &balls) && balls.count == 1 && balls.radius > 0 &&
            (other || i + 1 < node->parts->parts.count)) {
            radius += balls.radius;
            add_scaled3(shift, shift, 1, balls.points[0]);
        } else if (other) {
            return import_refuse(node->import, node->line,
                                 "`minkowski` is translated for sums with spheres or circles");
        } else {
            other = item;
        }
    }
    *part = radius > 0 ? grown(node, other, radius) : other;
    here  = place_move(shift);
    part_move(*part, &here);
    return true;
}

bool csg_offset(const CsgNode *node, Part **part)
{
    Part  *figure = NULL;
    double radius;
    if (!csg_number(node, "r", 0, &radius) || !csg_joined(node, true, &figure) || !figure)
        return node->import->refusal.length == 0;
    if (csg_argument(node, "delta") && radius == 0)
        return import_refuse(node->import, node->line,
                             "`offset` by `delta` is not translated; `r` is");
    *part = radius != 0 ? grown(node, figure, radius) : figure;
    return true;
}
