/*
 * offset.c: OpenSCAD's `offset`, which rounds corners or keeps them sharp.
 */
#include <math.h>

#include "import/csg/node.h"

enum { MAX_CORNERS = 2000 };

/* Finds the corners of a polygon whose sides are moved outwards; false where sides vanish. */
static bool move_sides(const double (*corners)[3], size_t count, double by, double (*to)[3])
{
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        area += a[0] * b[1] - a[1] * b[0];
    }
    by = area < 0 ? -by : by;
    for (size_t i = 0; i < count; i++) {
        const double *a = corners[(i + count - 1) % count], *b = corners[i],
                     *c = corners[(i + 1) % count];
        double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - b[0], c[1] - b[1]};
        double lu = hypot(u[0], u[1]), lv = hypot(v[0], v[1]);
        double m[2]  = {u[1] / lu + v[1] / lv, -u[0] / lu - v[0] / lv};
        double share = 1 + (u[0] * v[0] + u[1] * v[1]) / (lu * lv);
        if (!(lu > 0 && lv > 0 && share > 1e-9))
            return false;
        to[i][0] = b[0] + by * m[0] / share;
        to[i][1] = b[1] + by * m[1] / share;
        to[i][2] = 0;
    }
    for (size_t i = 0; i < count; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        const double *c = to[i], *d = to[(i + 1) % count];
        if ((b[0] - a[0]) * (d[0] - c[0]) + (b[1] - a[1]) * (d[1] - c[1]) <= 0)
            return false;
    }
    return true;
}

static double side_of(const double a[3], const double b[3], const double c[3])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Tells whether no two sides cross. */
static bool is_simple(const double (*corners)[3], size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t k = i + 2; k < count; k++) {
            const double *a = corners[i], *b = corners[i + 1];
            const double *c = corners[k], *d = corners[(k + 1) % count];
            if (i == 0 && k + 1 == count)
                continue;
            if (side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0)
                return false;
        }
    return true;
}

/* Returns a single polygon or circle, whose sides or whose edge move. */
static Part *widened(const CsgNode *node, const Part *figure, double by)
{
    Part *part = NULL;
    if (figure->methods)
        return NULL;
    if (!figure->shape && figure->parts.count == 1 && figure->join == PART_UNION) {
        part = widened(node, figure->parts.items[0], by);
    } else if (figure->figure_radius > 0 && figure->figure_radius + by > 0) {
        part                = part_shape(node->import, node->line, "circle", "circle(%s)",
                                         import_number_text(node->import, figure->figure_radius + by));
        part->figure        = true;
        part->figure_radius = figure->figure_radius + by;
    } else if (figure->corner_count >= 3 && figure->corner_count <= MAX_CORNERS &&
               is_simple((const double(*)[3])figure->corners, figure->corner_count)) {
        double(*to)[3] = arena_alloc(node->import->arena, figure->corner_count, sizeof *to);
        if (move_sides((const double(*)[3])figure->corners, figure->corner_count, by, to) &&
            is_simple((const double(*)[3])to, figure->corner_count))
            part = csg_polygon_part(node, to, figure->corner_count);
    }
    if (!part || fabs(transform_factor(&figure->transform) - 1) > 1e-9)
        return NULL; /* a stretched figure has other distances */
    part_move(part, &figure->transform);
    return part;
}

bool csg_offset(const CsgNode *node, Part **part)
{
    Part  *figure = NULL;
    double radius, delta, chamfer;
    if (!csg_number(node, "r", 0, &radius) || !csg_number(node, "delta", 0, &delta) ||
        !csg_number(node, "chamfer", 0, &chamfer) || !csg_joined(node, true, &figure) || !figure)
        return node->import->refusal.length == 0;
    if (delta != 0 && radius == 0) {
        *part = chamfer == 0 ? widened(node, figure, delta) : NULL;
        return *part ||
               import_refuse(node->import, node->line,
                             "`offset` by `delta` is translated for one polygon or circle, whose"
                             " sides stay, without `chamfer`");
    }
    *part = radius != 0 ? csg_grown(node, figure, radius) : figure;
    return true;
}
