/*
 * solids.c: hulls, swept balls, and surfaces made of patches.
 */
#include "tests/oracle/solids.h"

#include <assert.h>

static const double PI = 3.14159265358979323846;

/* ---- hulls ---- */

void hull_add(Hull *hull, double x, double y, double z)
{
    assert(hull->vertex_count < (int)(sizeof hull->vertices / sizeof *hull->vertices));
    hull->vertices[hull->vertex_count++] = vec(x, y, z);
}

/* A plane is a face when it has all vertices on one side; each is kept once. */
static void hull_try_face(Hull *hull, Vec normal, Vec on)
{
    Half face = {normal, vec_dot(normal, on)};
    for (int i = 0; i < hull->vertex_count; i++)
        if (half_excess(face, hull->vertices[i]) > 1e-9)
            return;
    for (int i = 0; i < hull->face_count; i++)
        if (vec_distance(hull->faces[i].normal, normal) < 1e-6)
            return;
    assert(hull->face_count < (int)(sizeof hull->faces / sizeof *hull->faces));
    hull->faces[hull->face_count++] = face;
}

void hull_close(Hull *hull)
{
    const Vec *v = hull->vertices;
    for (int a = 0; a < hull->vertex_count; a++)
        for (int b = a + 1; b < hull->vertex_count; b++)
            for (int c = b + 1; c < hull->vertex_count; c++) {
                Vec normal = vec_cross(vec_sub(v[b], v[a]), vec_sub(v[c], v[a]));
                if (vec_length(normal) < 1e-9)
                    continue;
                normal = vec_unit(normal);
                hull_try_face(hull, normal, v[a]);
                hull_try_face(hull, vec_scale(-1, normal), v[a]);
            }
}

bool hull_contains(const Hull *hull, Vec point)
{
    for (int i = 0; i < hull->face_count; i++)
        if (half_excess(hull->faces[i], point) > 0)
            return false;
    return true;
}

typedef struct Triangle {
    Vec corner, side, other;
} Triangle;

static Vec triangle_patch(const void *user, double u, double v)
{
    const Triangle *t = user;
    return vec_add(t->corner, vec_scale(u, vec_mix(t->side, t->other, v)));
}

/* A face is the fan of triangles between its first corner and the edges of the hull in it: two
   of its vertices are an edge when all the others are on one side of them. */
static void face_cloud(const Hull *hull, Half face, Cloud *cloud, double step)
{
    Vec corners[48];
    int count = 0;
    for (int i = 0; i < hull->vertex_count; i++)
        if (fabs(half_excess(face, hull->vertices[i])) < 1e-9)
            corners[count++] = hull->vertices[i];
    for (int a = 1; a < count; a++)
        for (int b = 1; b < count; b++) {
            Vec  out  = vec_cross(vec_sub(corners[b], corners[a]), face.normal);
            bool edge = a != b;
            for (int i = 0; i < count && edge; i++)
                edge = vec_dot(out, vec_sub(corners[i], corners[a])) <= 1e-9;
            Triangle triangle = {corners[0], vec_sub(corners[a], corners[0]),
                                 vec_sub(corners[b], corners[0])};
            if (edge)
                cloud_patch(cloud, triangle_patch, NULL, &triangle, step);
        }
}

void hull_cloud(const Hull *hull, Cloud *cloud, double step)
{
    for (int i = 0; i < hull->face_count; i++)
        face_cloud(hull, hull->faces[i], cloud, step);
}

/* ---- curves and swept balls ---- */

Curve curve_segment(Vec from, Vec to)
{
    return (Curve){.kind = CURVE_SEGMENT, .from = from, .via = vec_mix(from, to, 0.5), .to = to};
}

Curve curve_bezier(Vec from, Vec control, Vec to)
{
    return (Curve){.kind = CURVE_BEZIER, .from = from, .via = control, .to = to};
}

static double turn_between(Vec right, Vec up, Vec v)
{
    double angle = atan2(vec_dot(up, v), vec_dot(right, v));
    return angle < 0 ? angle + 2 * PI : angle;
}

Curve curve_arc(Vec from, Vec via, Vec to)
{
    Vec    a = vec_sub(from, to), b = vec_sub(via, to), n = vec_cross(a, b);
    double square = vec_dot(n, n);
    if (square < 1e-18)
        return curve_segment(from, to);
    Vec   toward = vec_sub(vec_scale(vec_dot(a, a), b), vec_scale(vec_dot(b, b), a));
    Vec   middle = vec_add(to, vec_scale(0.5 / square, vec_cross(toward, n)));
    Curve arc    = {.kind = CURVE_ARC, .from = from, .via = via, .to = to, .middle = middle};
    arc.right    = vec_sub(from, middle);
    arc.up       = vec_cross(vec_unit(n), arc.right);
    arc.angle    = turn_between(arc.right, arc.up, vec_sub(to, middle));
    if (turn_between(arc.right, arc.up, vec_sub(via, middle)) > arc.angle) {
        arc.up    = vec_scale(-1, arc.up);
        arc.angle = 2 * PI - arc.angle;
    }
    return arc;
}

Vec curve_at(const Curve *c, double t)
{
    switch (c->kind) {
    case CURVE_SEGMENT: return vec_mix(c->from, c->to, t);
    case CURVE_BEZIER: return vec_mix(vec_mix(c->from, c->via, t), vec_mix(c->via, c->to, t), t);
    default:
        return vec_add(c->middle, vec_add(vec_scale(cos(t * c->angle), c->right),
                                          vec_scale(sin(t * c->angle), c->up)));
    }
}

static Vec curve_velocity(const Curve *c, double t)
{
    switch (c->kind) {
    case CURVE_SEGMENT: return vec_sub(c->to, c->from);
    case CURVE_BEZIER:
        return vec_scale(2, vec_mix(vec_sub(c->via, c->from), vec_sub(c->to, c->via), t));
    default:
        return vec_scale(c->angle, vec_add(vec_scale(-sin(t * c->angle), c->right),
                                           vec_scale(cos(t * c->angle), c->up)));
    }
}

static double ball_depth(const Sweep *sweep, const Curve *curve, Vec point, double t)
{
    double radius = (1 - t) * sweep->radius + t * sweep->radius_end;
    return vec_distance(point, curve_at(curve, t)) - radius;
}

/* How much the depth can change, at most, while t goes from 0 to 1. */
static double depth_change(const Sweep *sweep, const Curve *c)
{
    double distance = c->kind == CURVE_ARC
                          ? c->angle * vec_length(c->right)
                          : 2 * fmax(vec_distance(c->from, c->via), vec_distance(c->via, c->to));
    return distance + fabs(sweep->radius - sweep->radius_end);
}

/* Returns the least depth between two parameters that hold one minimum. */
static double refine_depth(const Sweep *sweep, const Curve *curve, Vec point, double low,
                           double high)
{
    const double golden = 0.61803398874989485;
    double       a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = ball_depth(sweep, curve, point, a), at_b = ball_depth(sweep, curve, point, b);
    for (int i = 0; i < 40; i++) {
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a    = high - golden * (high - low);
            at_a = ball_depth(sweep, curve, point, a);
        } else {
            low = a, a = b, at_a = at_b;
            b    = low + golden * (high - low);
            at_b = ball_depth(sweep, curve, point, b);
        }
    }
    return fmin(at_a, at_b);
}

double sweep_depth(const Sweep *sweep, Vec point)
{
    enum { PIECES = 48 };
    double best = HUGE_VAL;
    for (int k = 0; k < sweep->curve_count; k++) {
        const Curve *curve = &sweep->curves[k];
        double       depth[PIECES + 1], slack = depth_change(sweep, curve) / PIECES;
        for (int i = 0; i <= PIECES; i++) {
            depth[i] = ball_depth(sweep, curve, point, (double)i / PIECES);
            best     = fmin(best, depth[i]);
        }
        for (int i = 0; i <= PIECES; i++) {
            bool valley = (i == 0 || depth[i] < depth[i - 1]) &&
                          (i == PIECES || depth[i] <= depth[i + 1]);
            if (valley && depth[i] - slack < best)
                best = fmin(best, refine_depth(sweep, curve, point, fmax(0, i - 1.0) / PIECES,
                                               fmin(PIECES, i + 1.0) / PIECES));
        }
    }
    return best;
}

/* ---- patches ---- */

typedef struct Ellipsoid {
    Vec centre, radii;
} Ellipsoid;

static Vec ellipsoid_patch(const void *user, double u, double v)
{
    const Ellipsoid *e    = user;
    double           ring = sin(PI * u);
    return vec_add(e->centre, vec(e->radii.x * ring * cos(2 * PI * v),
                                  e->radii.y * ring * sin(2 * PI * v), e->radii.z * cos(PI * u)));
}

/* One curve of a sweep, and the ball at one of its ends. */
typedef struct SweepPiece {
    const Sweep *sweep;
    const Curve *curve;
    Ellipsoid    end;
} SweepPiece;

/* Returns a unit vector across the curve that turns with it. */
static Vec curve_side(const Curve *curve, Vec tangent)
{
    Vec bend = vec_cross(vec_sub(curve->via, curve->from), vec_sub(curve->to, curve->from));
    return vec_length(bend) > 1e-12 ? vec_unit(vec_cross(tangent, bend)) : vec_across(tangent);
}

/* Returns where a ball touches the hull of its neighbours: n.c' = -r' (canal surface). */
static Vec tube_patch(const void *user, double u, double v)
{
    const SweepPiece *piece    = user;
    const Sweep      *sweep    = piece->sweep;
    Vec               velocity = curve_velocity(piece->curve, u), tangent = vec_unit(velocity);
    Vec               side = curve_side(piece->curve, tangent), other = vec_cross(tangent, side);
    double            back = -(sweep->radius_end - sweep->radius) / vec_length(velocity);
    double            out  = sqrt(fmax(0, 1 - back * back));
    Vec    around = vec_add(vec_scale(cos(2 * PI * v), side), vec_scale(sin(2 * PI * v), other));
    Vec    normal = vec_add(vec_scale(back, tangent), vec_scale(out, around));
    double radius = (1 - u) * sweep->radius + u * sweep->radius_end;
    return vec_add(curve_at(piece->curve, u), vec_scale(radius, normal));
}

static Vec end_patch(const void *user, double u, double v)
{
    const SweepPiece *piece = user;
    return ellipsoid_patch(&piece->end, u, v);
}

/* What is inside of another ball is not on the surface. */
static bool on_sweep(const void *user, Vec point)
{
    const SweepPiece *piece = user;
    return sweep_depth(piece->sweep, point) >= -1e-9;
}

void sweep_cloud(const Sweep *sweep, Cloud *cloud, double step)
{
    double change = fabs(sweep->radius - sweep->radius_end);
    for (int i = 0; i < sweep->curve_count; i++) {
        SweepPiece piece = {.sweep = sweep, .curve = &sweep->curves[i]};
        if (vec_length(curve_velocity(piece.curve, 0)) > change)
            cloud_patch(cloud, tube_patch, on_sweep, &piece, step);
        for (int end = 0; end < 2; end++) {
            double radius = end ? sweep->radius_end : sweep->radius;
            piece.end     = (Ellipsoid){curve_at(piece.curve, end), vec(radius, radius, radius)};
            cloud_patch(cloud, end_patch, on_sweep, &piece, step);
        }
    }
}

void ellipsoid_cloud(Cloud *cloud, Vec radii, double step)
{
    Ellipsoid ellipsoid = {vec(0, 0, 0), radii};
    cloud_patch(cloud, ellipsoid_patch, NULL, &ellipsoid, step);
}

typedef struct Frustum {
    double radius, y, radius_end, y_end;
} Frustum;

static Vec frustum_patch(const void *user, double u, double v)
{
    const Frustum *f      = user;
    double         radius = (1 - u) * f->radius + u * f->radius_end;
    return vec(radius * cos(2 * PI * v), (1 - u) * f->y + u * f->y_end, radius * sin(2 * PI * v));
}

void frustum_cloud(Cloud *cloud, double radius, double y, double radius_end, double y_end,
                   double step)
{
    Frustum frustum = {radius, y, radius_end, y_end};
    cloud_patch(cloud, frustum_patch, NULL, &frustum, step);
}

typedef struct Torus {
    double major, minor;
} Torus;

static Vec torus_patch(const void *user, double u, double v)
{
    const Torus *t   = user;
    double       out = t->major + t->minor * cos(2 * PI * v);
    return vec(out * cos(2 * PI * u), t->minor * sin(2 * PI * v), out * sin(2 * PI * u));
}

void torus_cloud(Cloud *cloud, double major, double minor, double step)
{
    Torus torus = {major, minor};
    cloud_patch(cloud, torus_patch, NULL, &torus, step);
}

/* ---- plane figures ---- */

void figure_add(Figure *figure, double x, double y)
{
    assert(figure->corner_count < (int)(sizeof figure->corners / sizeof *figure->corners));
    figure->corners[figure->corner_count++] = vec(x, y, 0);
}

/* A ray to the right crosses the outline of a polygon an odd number of times from inside. */
bool figure_contains(const Figure *figure, double x, double y)
{
    bool inside = false;
    if (figure->corner_count == 0)
        return sweep_depth(&figure->stroke, vec(x, y, 0)) <= 0;
    for (int i = 0; i < figure->corner_count; i++) {
        Vec a = figure->corners[i], b = figure->corners[(i + 1) % figure->corner_count];
        if ((a.y > y) != (b.y > y) && a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x) > x)
            inside = !inside;
    }
    return inside;
}

/* Line `line` of an outline: an edge; or, of a stroke, per curve its sides and its ends. */
typedef struct Outline {
    const Figure *figure;
    int           line;
    double        height, offset; /* of the solid made from it */
} Outline;

static int outline_count(const Figure *figure)
{
    return figure->corner_count ? figure->corner_count : 4 * figure->stroke.curve_count;
}

static Vec outline_at(const Outline *outline, double t)
{
    const Figure *figure = outline->figure;
    const Sweep  *stroke = &figure->stroke;
    if (figure->corner_count)
        return vec_mix(figure->corners[outline->line],
                       figure->corners[(outline->line + 1) % figure->corner_count], t);
    const Curve *curve = &stroke->curves[outline->line / 4];
    int          part  = outline->line % 4;
    Vec velocity = curve_velocity(curve, t), normal = vec(cos(2 * PI * t), sin(2 * PI * t), 0);
    if (part >= 2)
        return vec_add(curve_at(curve, part - 2), vec_scale(stroke->radius, normal));
    if (vec_length(velocity) > 0)
        normal = vec_unit(vec(-velocity.y, velocity.x, 0));
    return vec_add(curve_at(curve, t), vec_scale(part ? -stroke->radius : stroke->radius, normal));
}

static bool on_outline(const Figure *figure, double x, double y)
{
    return figure->corner_count || sweep_depth(&figure->stroke, vec(x, y, 0)) >= -1e-9;
}

static Vec wall_patch(const void *user, double u, double v)
{
    const Outline *outline = user;
    Vec            point   = outline_at(outline, u);
    return vec(point.x, point.y, outline->height * (v - 0.5));
}

static bool on_wall(const void *user, Vec point)
{
    const Outline *outline = user;
    return on_outline(outline->figure, point.x, point.y);
}

typedef struct Lid {
    const Figure *figure;
    double        size, z;
} Lid;

static Vec lid_patch(const void *user, double u, double v)
{
    const Lid *lid = user;
    return vec(lid->size * (2 * u - 1), lid->size * (2 * v - 1), lid->z);
}

static bool on_lid(const void *user, Vec point)
{
    const Lid *lid = user;
    return figure_contains(lid->figure, point.x, point.y);
}

void extrusion_cloud(const Figure *figure, double height, Cloud *cloud, double step)
{
    double size = 0;
    for (int line = 0; line < outline_count(figure); line++) {
        Outline outline = {figure, line, height, 0};
        cloud_patch(cloud, wall_patch, on_wall, &outline, step);
        for (int i = 0; i <= 64; i++)
            size = fmax(size, vec_length(outline_at(&outline, i / 64.0)));
    }
    for (int side = -1; side <= 1; side += 2) {
        Lid lid = {figure, 1.01 * size, side * height / 2};
        cloud_patch(cloud, lid_patch, on_lid, &lid, step);
    }
}

static Vec turned_patch(const void *user, double u, double v)
{
    const Outline *outline = user;
    Vec            point   = outline_at(outline, u);
    double         out     = point.x + outline->offset;
    if (out < 0)
        out = NAN;
    return vec(out * cos(2 * PI * v), point.y, out * sin(2 * PI * v));
}

/* What a figure has on the other side of the axis, a NaN by turned_patch, is not turned. */
static bool on_turned(const void *user, Vec point)
{
    const Outline *outline = user;
    double         out     = hypot(point.x, point.z) - outline->offset;
    return !isnan(out) && on_outline(outline->figure, out, point.y);
}

void revolution_cloud(const Figure *figure, double offset, Cloud *cloud, double step)
{
    for (int line = 0; line < outline_count(figure); line++) {
        Outline outline = {figure, line, 0, offset};
        cloud_patch(cloud, turned_patch, on_turned, &outline, step);
    }
}
