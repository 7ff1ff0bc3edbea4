/*
 * measure.c: what needs to know where a part ends: OpenSCAD's `resize`, and `projection`,
 * which makes figures of solids.
 */
#include <math.h>
#include <string.h>

#include "import/csg/node.h"

static const double SLACK = 1e-9; /* as a part of sizes */

/* ---- how far parts reach ---- */

/* Points of a part that reach as far as all of it along each axis, in both directions. */
typedef struct Reach {
    Import *import;
    double (*points)[3];
    size_t count, capacity;
} Reach;

static void add_point(Reach *reach, const double point[3])
{
    if (reach->count == reach->capacity) {
        reach->capacity  = reach->capacity > 0 ? 2 * reach->capacity : 64;
        double(*more)[3] = arena_alloc(reach->import->arena, reach->capacity, sizeof *more);
        if (reach->count > 0)
            memcpy(more, reach->points, reach->count * sizeof *more);
        reach->points = more;
    }
    memcpy(reach->points[reach->count++], point, 3 * sizeof *point);
}

/* Adds a ball, or a circle in x and y (`dimensions` 2), as it is placed: q = center + radius * M u for unit
   vectors u goes farthest along an axis where u is that row of M. */
static void add_round(Reach *reach, const Transform *transform, const double center[3],
                      double radius, int dimensions)
{
    for (int axis = 0; axis < 3; axis++) {
        const double *row  = transform->rows[axis];
        double        size = hypot(hypot(row[0], row[1]), dimensions == 3 ? row[2] : 0);
        for (int side = -1; side <= 1; side += 2) {
            double at[3], own[3];
            for (int i = 0; i < 3; i++)
                own[i] = center[i] +
                         (size > 0 && i < dimensions ? side * radius * row[i] / size : 0);
            transform_apply(transform, own, at);
            add_point(reach, at);
        }
    }
}

static bool add_reach(Reach *reach, const Part *part, const Transform *outer);

/* Adds a column, which reaches as far as its ends do. */
static bool add_column(Reach *reach, const PartColumn *column, const Transform *transform)
{
    for (int side = -1; side <= 1; side += 2) {
        Transform end = transform_move((double[]){0, 0, side * column->height / 2});
        end           = transform_chain(&end, transform);
        if (!add_reach(reach, column->figure, &end))
            return false;
    }
    return true;
}

static bool bounds_of(const Reach *reach, double low[3], double high[3])
{
    for (int i = 0; i < 3; i++) {
        low[i]  = INFINITY;
        high[i] = -INFINITY;
        for (size_t k = 0; k < reach->count; k++) {
            low[i]  = fmin(low[i], reach->points[k][i]);
            high[i] = fmax(high[i], reach->points[k][i]);
        }
    }
    return reach->count > 0;
}

/* Adds a difference; what is cut away may have held what reaches farthest: then nothing is known. */
static bool add_difference(Reach *reach, const Part *part, const Transform *transform)
{
    Reach  first = {.import = reach->import};
    double low[3], high[3], still_low[3], still_high[3];
    if (!add_reach(&first, part->parts.items[0], transform) || !bounds_of(&first, low, high))
        return false;
    for (size_t i = 1; i < part->parts.count; i++) {
        Reach  tool = {.import = reach->import}, rest = {.import = reach->import};
        double from[3], to[3];
        if (!add_reach(&tool, part->parts.items[i], transform) || !bounds_of(&tool, from, to))
            return false;
        for (size_t k = 0; k < first.count; k++) {
            bool held = true;
            for (int a = 0; a < 3; a++)
                held = held && first.points[k][a] >= from[a] && first.points[k][a] <= to[a];
            if (!held)
                add_point(&rest, first.points[k]);
        }
        first = rest;
    }
    if (!bounds_of(&first, still_low, still_high))
        return false;
    for (int a = 0; a < 3; a++) {
        double slack = SLACK * (high[a] - low[a]);
        if (still_low[a] > low[a] + slack || still_high[a] < high[a] - slack)
            return false;
    }
    for (size_t k = 0; k < first.count; k++)
        add_point(reach, first.points[k]);
    return true;
}

static bool add_shape(Reach *reach, const Part *part, const Transform *transform)
{
    const PartBalls *balls = &part->balls;
    const PartCone  *cone  = &part->cone;
    if (part->figure_radius > 0) {
        add_round(reach, transform, (double[]){0, 0, 0}, part->figure_radius, 2);
        return true;
    }
    if (cone->height > 0) {
        add_round(reach, transform, (double[]){0, 0, -cone->height / 2}, cone->bottom, 2);
        add_round(reach, transform, (double[]){0, 0, cone->height / 2}, cone->top, 2);
        return true;
    }
    for (size_t i = 0; i < balls->count && balls->points; i++) {
        double radius = balls->radii ? balls->radii[i] : balls->radius, at[3];
        transform_apply(transform, balls->points[i], at);
        if (radius > 0)
            add_round(reach, transform, balls->points[i], radius, part->figure ? 2 : 3);
        else
            add_point(reach, at);
    }
    return balls->points != NULL;
}

/* Adds the reach of a part; false if it is not known. */
static bool add_reach(Reach *reach, const Part *part, const Transform *outer)
{
    Transform transform = transform_chain(&part->transform, outer);
    if (part->column.figure)
        return add_column(reach, &part->column, &transform);
    if (part->methods)
        return false;
    if (part->shape)
        return add_shape(reach, part, &transform);
    if (part->join == PART_DIFFERENCE)
        return add_difference(reach, part, &transform);
    bool known = part->join != PART_INTERSECTION;
    for (size_t i = 0; i < part->parts.count && known; i++)
        known = add_reach(reach, part->parts.items[i], &transform);
    return known;
}

/* ---- resize ---- */

/* Resizes a part: a length of 0 stays, or with `auto` grows as the longest that is given does. */
bool csg_resize(const CsgNode *node, Part **part)
{
    double    size[3] = {0, 0, 0}, follows[3] = {0, 0, 0}, low[3], high[3], factors[3] = {1, 1, 1};
    Reach     reach = {.import = node->import};
    Transform here  = transform_identity();
    if (!csg_vector(node, "newsize", size, 3) || !csg_vector(node, "auto", follows, 3) ||
        !csg_joined(node, node->parts && node->parts->figure, part) || !*part)
        return node->import->refusal.length == 0;
    if (!add_reach(&reach, *part, &here) || !bounds_of(&reach, low, high))
        return import_refuse(node->import, node->line,
                             "`resize` of a part whose exact size is not known here is not "
                             "translated; write `scale`");
    int count = (*part)->figure ? 2 : 3, longest = 0;
    for (int i = 0; i < count; i++) {
        longest = size[i] > size[longest] ? i : longest;
        if (size[i] > 0 && high[i] > low[i])
            factors[i] = size[i] / (high[i] - low[i]);
    }
    for (int i = 0; i < count; i++)
        if (follows[i] != 0 && !(size[i] > 0))
            factors[i] = factors[longest];
    Transform stretched = transform_scale(factors);
    if ((*part)->figure)
        transform_flatten(&stretched);
    *part = part_around(node->import, node->line, "resized", *part);
    part_move(*part, &stretched);
    return true;
}

/* ---- files ---- */

bool csg_import(const CsgNode *node, Part **part)
{
    (void)part;
    return import_refuse(node->import, node->line,
                         "`import` is not translated: scenes have no meshes, such as `%.60s`%s",
                         csg_string(node, "file", ""),
                         strstr(csg_string(node, "file", ""), ".svg")
                             ? "; write `union(svg(...))` for a drawing"
                             : "");
}

bool csg_surface(const CsgNode *node, Part **part)
{
    (void)part;
    return import_refuse(
        node->import, node->line,
        "`surface` is not translated: scenes have no fields of heights, such as `%.60s`",
        csg_string(node, "file", ""));
}

/* ---- projection ---- */

typedef struct Projection {
    const CsgNode *node;
    bool           cut; /* where z is 0; else of all that is above and below */
} Projection;

static bool project(const Projection *projection, const Part *part, const Transform *outer,
                    Part **figure);

static bool refuse_projection(const Projection *projection, const Part *part)
{
    return import_refuse(projection->node->import, part->line,
                         projection->cut ? "`projection` cuts balls, upright columns, solids with "
                                           "corners, and joints of these; not `%s`"
                                         : "`projection` shows balls, upright columns, solids with "
                                           "corners, and unions of these; not `%s`",
                         part->stem);
}

/* Tells whether z stays z. */
static bool is_upright(const Transform *transform)
{
    double across = fabs(transform->rows[0][2]) + fabs(transform->rows[1][2]) +
                    fabs(transform->rows[2][0]) + fabs(transform->rows[2][1]);
    return across <= SLACK * fabs(transform->rows[2][2]);
}

static Part *footprint(const Projection *projection, const Part *part, const Transform *transform)
{
    const PartColumn *column = &part->column;
    double            reach  = fabs(transform->rows[2][2]) * column->height / 2;
    if (projection->cut && !(fabs(transform->shift[2]) < reach))
        return NULL;
    Part *figure   = part_around(projection->node->import, part->line, "footprint", column->figure);
    Transform flat = *transform;
    flat.rows[0][2] = flat.rows[1][2] = flat.rows[2][0] = flat.rows[2][1] = 0;
    transform_flatten(&flat);
    figure->figure = true;
    part_move(figure, &flat);
    return figure;
}

static Part *disc(const Projection *projection, const Part *part, const Transform *transform)
{
    double center[3], radius = part->balls.radius * transform_factor(transform);
    transform_apply(transform, part->balls.points[0], center);
    if (projection->cut)
        radius = sqrt(fmax(radius * radius - center[2] * center[2], 0));
    if (!(radius > 0))
        return NULL;
    Part *figure          = part_shape(projection->node->import, part->line, "circle", "circle(%s)",
                                       import_number_text(projection->node->import, radius));
    figure->figure        = true;
    figure->figure_radius = radius;
    center[2]             = 0;
    Transform moved       = transform_move(center);
    part_move(figure, &moved);
    return figure;
}

/* Finds the outline of the hull of points: its edges join some of them, so that all pairs tell where z is 0. */
static Part *outline(const Projection *projection, const Part *part, const Transform *transform)
{
    const CsgNode *node  = projection->node;
    size_t         count = part->balls.count;
    Reach          flat  = {.import = node->import};
    double(*at)[3]       = arena_alloc(node->import->arena, count, sizeof *at);
    for (size_t i = 0; i < count; i++) {
        transform_apply(transform, part->balls.points[i], at[i]);
        if (!projection->cut)
            add_point(&flat, at[i]);
    }
    for (size_t i = 0; i < count && projection->cut; i++)
        for (size_t k = 0; k < i; k++) {
            if ((at[i][2] > 0) == (at[k][2] > 0))
                continue;
            double share = at[i][2] / (at[i][2] - at[k][2]);
            add_point(&flat, (double[]){at[i][0] + share * (at[k][0] - at[i][0]),
                                        at[i][1] + share * (at[k][1] - at[i][1]), 0});
        }
    if (part->cone.height > 0 || (part->column.figure && part->column.figure->figure_radius > 0))
        import_note(node->import, part->line,
                    "what is projected of a column that is not upright has OpenSCAD's flat sides");
    PartBalls balls = {flat.points, flat.count, flat.count, 0, NULL};
    return csg_convex_corners(node->import, &balls) >= 3
               ? csg_polygon_part(node, balls.points, balls.count)
               : NULL;
}

static bool project_join(const Projection *projection, const Part *part, const Transform *transform,
                         Part **figure)
{
    Part *joined = part_new(projection->node->import, part->line, part->stem);
    joined->join = part->join;
    if (part->join == PART_HULL || (!projection->cut && part->join != PART_UNION))
        return refuse_projection(projection, part);
    for (size_t i = 0; i < part->parts.count; i++) {
        Part *item = NULL;
        if (!project(projection, part->parts.items[i], transform, &item))
            return false;
        if (item)
            part_add(projection->node->import, joined, item);
        else if (part->join == PART_INTERSECTION || (part->join == PART_DIFFERENCE && i == 0))
            return true; /* nothing */
    }
    if (joined->parts.count > 0)
        *figure = joined;
    return true;
}

/* Projects a part; figure stays NULL where there is nothing. */
static bool project(const Projection *projection, const Part *part, const Transform *outer,
                    Part **figure)
{
    Transform        transform = transform_chain(&part->transform, outer);
    const PartBalls *balls     = &part->balls;
    if (part->column.figure && is_upright(&transform)) {
        *figure = footprint(projection, part, &transform);
        return true;
    }
    if (!part->shape && !part->methods)
        return project_join(projection, part, &transform, figure);
    if (part->methods || !balls->points || balls->radii)
        return refuse_projection(projection, part);
    if (balls->radius == 0)
        *figure = outline(projection, part, &transform);
    else if (balls->count == 1 && transform_factor(&transform) > 0)
        *figure = disc(projection, part, &transform);
    else
        return refuse_projection(projection, part);
    return true;
}

bool csg_projection(const CsgNode *node, Part **part)
{
    Projection projection = {.node = node};
    double     cut;
    Part      *solid = NULL;
    Transform  here  = transform_identity();
    if (!csg_number(node, "cut", 0, &cut) || !csg_joined(node, false, &solid) || !solid)
        return node->import->refusal.length == 0;
    projection.cut = cut != 0;
    return project(&projection, solid, &here, part);
}
