/*
 * hull.c: OpenSCAD's solids and figures that are given by points, hulls, and sums with
 * balls.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/csg/node.h"
#include "compiler/base/vec.h"

enum { MAX_POINTS = 4096, MAX_PATHS = 500, MAX_BALLS = 200 };

/* ---- polygons ---- */

Part *csg_polygon_part(const CsgNode *node, double (*points)[3], size_t count)
{
    Text list = {.arena = node->import->arena};
    for (size_t i = 0; i < count; i++)
        text_format(&list, "%s%s", i == 0 ? "" : ", ",
                    import_vector_text(node->import, points[i], 2));
    Part *part    = part_shape(node->import, node->line, "polygon", "polygon([%s])", list.bytes);
    part->figure  = true;
    part->balls   = (PartBalls){points, count, count, 0, NULL};
    part->corners = points;
    part->corner_count = count;
    return part;
}

/* Finds the points of one of `paths`, a list of indices. */
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

/* Builds a polygon; several paths bound what is in an odd number of them. */
bool csg_polygon(const CsgNode *node, Part **part)
{
    const CsgValue *list = csg_argument(node, "points"), *paths = csg_argument(node, "paths");
    double(*points)[3], (*chosen)[3];
    if (!csg_points(node, list, 2, &points))
        return false;
    size_t count = list->list.count;
    if (!paths || paths->kind != CSG_LIST || paths->list.count == 0) {
        *part = csg_polygon_part(node, points, count);
        return count >= 3 ||
               import_refuse(node->import, node->line, "`polygon` needs three points at least");
    }
    if (paths->list.count > MAX_PATHS)
        return import_refuse(node->import, node->line, "`polygon` has more than %d paths",
                             MAX_PATHS);
    for (size_t i = 0; i < paths->list.count; i++) {
        if (!path_points(node, &paths->list.items[i], points, count, &chosen))
            return false;
        Part *path = csg_polygon_part(node, chosen, paths->list.items[i].list.count);
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

/* Tells whether all points are on one side of a face. */
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

static bool collect(Import *import, const Part *part, const Transform *outer, PartBalls *all);

static Part *hull_part(const CsgNode *node, const PartBalls *balls)
{
    Text list = {.arena = node->import->arena};
    for (size_t i = 0; i < balls->count; i++)
        text_format(&list, "%s%s",
                    i == 0  ? ""
                    : i % 4 ? ", "
                            : ",\n    ",
                    import_vector_text(node->import, balls->points[i], 3));
    const char *radius = balls->radii
                             ? import_vector_text(node->import, balls->radii, (int)balls->count)
                             : import_number_text(node->import, balls->radius);
    Part       *part   = part_shape(node->import, node->line, "hull",
                            balls->radius > 0 ? "hull([%s], radius: %s)" : "hull([%s])", list.bytes,
                                    radius);
    part->balls        = *balls;
    return part;
}

/* Builds a polyhedron, which must be convex: the hull of its points. */
bool csg_polyhedron(const CsgNode *node, Part **part)
{
    const CsgValue *list = csg_argument(node, "points"), *faces = csg_argument(node, "faces");
    double(*points)[3], (*corners)[3];
    if (!csg_points(node, list, 3, &points))
        return false;
    size_t count = list->list.count;
    if (!faces || faces->kind != CSG_LIST || faces->list.count < 4 || count > MAX_POINTS ||
        faces->list.count > 2 * MAX_POINTS)
        return import_refuse(node->import, node->line,
                             "a polyhedron needs four faces, and at most %d points", MAX_POINTS);
    for (size_t i = 0; i < faces->list.count; i++) {
        if (!path_points(node, &faces->list.items[i], points, count, &corners))
            return false;
        size_t last = faces->list.items[i].list.count - 1;
        if (!face_is_outside(points, count, corners[0], corners[1], corners[last]))
            return import_refuse(node->import, node->line,
                                 "a polyhedron that is not convex is not translated");
    }
    PartBalls balls = {points, count, count, 0, NULL};
    *part           = hull_part(node, &balls);
    return true;
}

/* ---- hulls ---- */

static void make_room(Import *import, PartBalls *all, size_t more)
{
    if (all->count + more <= all->capacity)
        return;
    all->capacity     = 2 * (all->count + more);
    double(*wider)[3] = arena_alloc(import->arena, all->capacity, sizeof *wider);
    double *radii     = arena_new_array(import->arena, double, all->capacity);
    if (all->count > 0) {
        memcpy(wider, all->points, all->count * sizeof *wider);
        memcpy(radii, all->radii, all->count * sizeof *radii);
    }
    all->points = wider;
    all->radii  = radii;
}

/* Collects what stands on a figure, as points: its ends. */
static bool collect_column(Import *import, const PartColumn *column, const Transform *transform,
                           PartBalls *all)
{
    PartBalls ends = {0};
    Transform here = transform_identity();
    if (!collect(import, column->figure, &here, &ends) || ends.radius > 0)
        return false;
    make_room(import, all, 2 * ends.count);
    for (size_t i = 0; i < 2 * ends.count; i++) {
        double at[3] = {ends.points[i / 2][0], ends.points[i / 2][1],
                        (i % 2 ? 0.5 : -0.5) * column->height};
        transform_apply(transform, at, all->points[all->count]);
        all->radii[all->count++] = 0;
    }
    return all->count <= MAX_POINTS;
}

/* Adds the balls of which a part is the hull; false where it is something else.  `radius` is that of the
   largest. */
static bool collect(Import *import, const Part *part, const Transform *outer, PartBalls *all)
{
    Transform transform = transform_chain(&part->transform, outer);
    double    factor = transform_factor(&transform), radius = part->balls.radius * factor;
    if (part->methods && part->column.figure)
        return collect_column(import, &part->column, &transform, all);
    if (part->methods || (part->join != PART_UNION && part->join != PART_HULL) ||
        (part->shape && !part->balls.points))
        return false;
    for (size_t i = 0; i < part->parts.count; i++)
        if (!collect(import, part->parts.items[i], &transform, all))
            return false;
    if (!part->shape)
        return true;
    if (part->balls.radius > 0 && factor == 0)
        return false;
    make_room(import, all, part->balls.count);
    for (size_t i = 0; i < part->balls.count; i++) {
        double own = part->balls.radii ? part->balls.radii[i] * factor : radius;
        transform_apply(&transform, part->balls.points[i], all->points[all->count]);
        all->radii[all->count++] = own;
        all->radius              = fmax(all->radius, own);
    }
    return all->count <= MAX_POINTS;
}

/* Tells whether all balls have one size; then `radii` is not needed. */
static bool are_of_one_size(PartBalls *balls)
{
    for (size_t i = 0; i < balls->count; i++)
        if (fabs(balls->radii[i] - balls->radius) > 1e-9 * balls->radius)
            return false;
    balls->radii = NULL;
    return true;
}

static int compare_points(const void *left, const void *right)
{
    const double *a = left, *b = right;
    if (a[0] != b[0])
        return a[0] < b[0] ? -1 : 1;
    return a[1] != b[1] ? (a[1] < b[1] ? -1 : 1) : 0;
}

/* Finds the convex corners by Andrew's chain. */
size_t csg_convex_corners(Import *import, PartBalls *balls)
{
    size_t n = balls->count, count = 0;
    double(*points)[3] = balls->points;
    double(*chain)[3]  = arena_alloc(import->arena, 2 * n + 1, sizeof *chain);
    qsort(points, n, sizeof *points, compare_points);
    for (int upper = 0; upper < 2; upper++) {
        const size_t bottom = count > 0 ? count - 1 : 0; /* the first corner of this half */
        for (size_t i = 0; i < n; i++) {
            const double *p = points[upper ? n - 1 - i : i];
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
    size_t      corners = csg_convex_corners(import, balls);
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
        *part = csg_polygon_part(node, balls->points, corners);
    if (corners == 1) {
        Transform transform = transform_move(balls->points[0]);
        part_move(*part, &transform);
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

/* Tells whether something in it is round, and stands for points that OpenSCAD has for it. */
static bool has_columns(const Part *part)
{
    bool found = part->column.figure && part->column.figure->figure_radius > 0;
    found      = found || (part->stem && strcmp(part->stem, "cone") == 0);
    for (size_t i = 0; i < part->parts.count && !found; i++)
        found = has_columns(part->parts.items[i]);
    return found;
}

/* Returns the hull of the parts themselves, where the language knows it; NULL: it does not. */
static Part *hull_of_parts(const CsgNode *node, const Part *joined)
{
    Import trial = {
        .path = node->import->path, .name = node->import->name, .arena = node->import->arena};
    PartWriter writer = {.import = &trial};
    Part      *hull   = part_new(node->import, node->line, "hull");
    trial.scene = trial.refusal = (Text){.arena = trial.arena};
    hull->join                  = PART_HULL;
    for (size_t i = 0; i < node->parts->parts.count; i++)
        part_add(node->import, hull, node->parts->parts.items[i]);
    return part_show(&writer, hull, joined->figure ? ".extrude(1)" : "") &&
                   import_compiles(node->import, trial.scene.bytes)
               ? hull
               : NULL;
}

bool csg_hull(const CsgNode *node, Part **part)
{
    Part     *joined = NULL;
    PartBalls balls  = {0};
    Transform here   = transform_identity();
    if (!node->parts)
        return true;
    if (!csg_joined(node, node->parts->figure, &joined))
        return false;
    bool known = collect(node->import, joined, &here, &balls);
    bool equal = known && are_of_one_size(&balls);
    if (!(equal && (joined->figure || !has_columns(joined)))) {
        *part = hull_of_parts(node, joined);
        if (*part) {
            (*part)->balls = balls;
            return true;
        }
    }
    if (!known || (!equal && (joined->figure || balls.count > MAX_BALLS)))
        return import_refuse(
            node->import, node->line,
            "a hull is translated if it is of points and balls, or of upright columns");
    if (known && has_columns(joined))
        import_note(node->import, node->line,
                    "in hulls of columns that are not parallel these have OpenSCAD's flat sides");
    if (joined->figure)
        return hull_of_figures(node, &balls, part);
    *part = hull_part(node, &balls);
    if (balls.count == 1) {
        *part = part_shape(node->import, node->line, "hull", "sphere(%s)",
                           import_number_text(node->import, balls.radius));
        here  = transform_move(balls.points[0]);
        part_move(*part, &here);
        (*part)->balls = (PartBalls){arena_alloc(node->import->arena, 1, sizeof *balls.points), 1,
                                     1, balls.radius, NULL};
    }
    return true;
}

/* ---- sums with balls ---- */

Part *csg_grown(const CsgNode *node, Part *part, double radius)
{
    Text methods = {.arena = node->import->arena};
    text_format(&methods, ".offset(%s)", import_number_text(node->import, radius));
    if (part->join == PART_INTERSECTION || part->join == PART_DIFFERENCE)
        import_note(node->import, node->line, "edges of what is cut are grown, not rounded, there");
    Part *around    = part_around(node->import, node->line, "grown", part);
    around->methods = methods.bytes;
    return around;
}

/* Finds an upright column, if it is only moved and rotated about z: its figure as it is seen from
   above. */
static bool upright_column(Import *import, const Part *part, PartColumn *column, double shift[3])
{
    const Transform *transform = &part->transform;
    if (part->methods && !part->column.figure)
        return false;
    if (!part->column.figure) {
        PartColumn inner;
        if (part->shape || part->parts.count != 1 || part->join != PART_UNION ||
            !upright_column(import, part->parts.items[0], &inner, shift))
            return false;
        *column = inner;
    } else {
        *column  = part->column;
        shift[2] = 0;
    }
    bool upright = transform->rows[0][2] == 0 && transform->rows[1][2] == 0 &&
                   transform->rows[2][0] == 0 && transform->rows[2][1] == 0 &&
                   transform->rows[2][2] > 0;
    Transform flat  = *transform;
    flat.rows[2][2] = 1;
    flat.shift[2]   = 0;
    shift[2]        = shift[2] * transform->rows[2][2] + transform->shift[2];
    column->figure  = part_around(import, part->line, "footprint", column->figure);
    column->height *= transform->rows[2][2];
    part_move(column->figure, &flat);
    return upright;
}

/* Returns the radius of a figure that is a circle; `center` is its middle. */
static double circle_of(Import *import, const Part *figure, double center[3])
{
    PartBalls balls = {0};
    Transform here  = transform_identity();
    if (!collect(import, figure, &here, &balls) || balls.count != 1)
        return 0;
    memcpy(center, balls.points[0], 3 * sizeof *center);
    return balls.radius;
}

/* Returns the sum of two columns, one of them round: what stands on the sum of their figures, as
   high as both. */
static Part *sum_of_columns(const CsgNode *node, const Part *a, const Part *b)
{
    PartColumn columns[2];
    double     shifts[2][3] = {{0}}, center[3] = {0, 0, 0}, height, at[3];
    if (!upright_column(node->import, a, &columns[0], shifts[0]) ||
        !upright_column(node->import, b, &columns[1], shifts[1]))
        return NULL;
    int    round  = 1;
    double radius = circle_of(node->import, columns[1].figure, center);
    if (radius == 0)
        radius = circle_of(node->import, columns[round = 0].figure, center);
    if (radius == 0)
        return NULL;
    height       = columns[0].height + columns[1].height;
    Part *figure = csg_grown(node, columns[1 - round].figure, radius);
    Text  text   = {.arena = node->import->arena};
    text_format(&text, ".extrude(%s)", import_number_text(node->import, height));
    Part *sum       = part_around(node->import, node->line, "sum", figure);
    sum->methods    = text.bytes;
    sum->figure     = false;
    sum->column     = (PartColumn){figure, height};
    at[0]           = center[0];
    at[1]           = center[1];
    at[2]           = shifts[0][2] + shifts[1][2];
    Transform moved = transform_move(at);
    part_move(sum, &moved);
    return sum;
}

/* Tells whether a part is the hull of its balls, not some part of it: polygons may be hollow. */
static bool is_convex(const Part *part)
{
    bool polygon = part->shape && strcmp(part->stem, "polygon") == 0;
    return !polygon && part->parts.count <= 1 &&
           (part->parts.count == 0 ||
            (part->join == PART_UNION && is_convex(part->parts.items[0])));
}

/* Returns the sum of two convex parts: the hull of the sums of their points. */
static Part *sum_of_hulls(const CsgNode *node, const Part *a, const Part *b)
{
    PartBalls one = {0}, other = {0}, sums = {0};
    Transform here = transform_identity();
    if (a->figure || !is_convex(a) || !is_convex(b) || !collect(node->import, a, &here, &one) ||
        !collect(node->import, b, &here, &other) || !are_of_one_size(&one) ||
        !are_of_one_size(&other) || one.count * other.count > MAX_POINTS)
        return NULL;
    make_room(node->import, &sums, one.count * other.count);
    for (size_t i = 0; i < one.count * other.count; i++)
        add_scaled3(sums.points[sums.count++], one.points[i / other.count], 1,
                    other.points[i % other.count]);
    sums.radius = one.radius + other.radius;
    sums.radii  = NULL;
    return hull_part(node, &sums);
}

/* Returns the sum of two parts; NULL: it is not known. */
static Part *sum_of(const CsgNode *node, Part *a, Part *b)
{
    Part *const parts[2] = {a, b};
    Transform   here     = transform_identity();
    for (int i = 1; i >= 0; i--) {
        PartBalls balls = {0};
        if (!collect(node->import, parts[i], &here, &balls) || balls.count != 1)
            continue;
        Transform moved = transform_move(balls.points[0]);
        Part     *sum   = balls.radius > 0 ? csg_grown(node, parts[1 - i], balls.radius)
                                           : part_around(node->import, node->line, "moved", parts[1 - i]);
        part_move(sum, &moved);
        return sum;
    }
    Part *columns = sum_of_columns(node, a, b);
    return columns ? columns : sum_of_hulls(node, a, b);
}

bool csg_minkowski(const CsgNode *node, Part **part)
{
    Part *joined = NULL;
    if (!node->parts || node->lacks)
        return true;
    if (!csg_joined(node, node->parts->figure, &joined))
        return false;
    *part = node->parts->parts.items[0];
    for (size_t i = 1; i < node->parts->parts.count && *part; i++)
        *part = sum_of(node, *part, node->parts->parts.items[i]);
    return *part ||
           import_refuse(node->import, node->line,
                         "`minkowski` is translated for sums with balls, of columns with round"
                         " ones, and of convex solids with corners");
}
