/*
 * svg_stroke.c: strokes of paths as areas.
 *
 * A stroke is the union of simple contours, all of one orientation: what each piece of a curve sweeps,
 * a wedge on the outer side of each corner, and caps at the ends.  They meet along lines through the
 * points of the path, which cancel where contours are resolved.
 *
 * A curve is cut into pieces that turn by a small angle a.  What is parallel to a piece is drawn as the
 * parabola with the same tangents at its ends.  Of a circle of radius r that leaves the arc by
 * r a^4 / 128.
 */
#include "compiler/outline/svg_stroke.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/outline/edges.h"

enum { MAX_CORNERS = 64, MAX_DASHES = 100000 };

/* One contour before it is drawn: points, and the control points of the curves that lead to them. */
typedef struct Contour {
    double to[MAX_CORNERS][2], via[MAX_CORNERS][2];
    bool   curved[MAX_CORNERS];
    int    count;
} Contour;

typedef struct Stroker {
    SvgPen          *pen;
    const SvgStroke *stroke;
    double           radius, angle; /* half of the width; by which pieces turn at most */
} Stroker;

/* A point of a path, and the direction there. */
typedef struct Tangent {
    double at[2], along[2]; /* unit */
} Tangent;

/* ---- contours ---- */

static void corner(Contour *contour, const double to[2])
{
    memcpy(contour->to[contour->count], to, sizeof contour->to[0]);
    contour->curved[contour->count++] = false;
}

static void bend(Contour *contour, const double via[2], const double to[2])
{
    memcpy(contour->via[contour->count], via, sizeof contour->via[0]);
    corner(contour, to);
    contour->curved[contour->count - 1] = true;
}

/* Returns twice the area between its points and control points. */
static double area_of(const Contour *contour)
{
    double        area = 0;
    const double *last = contour->to[contour->count - 1];
    for (int i = 0; i < contour->count; i++) {
        if (contour->curved[i]) {
            area += cross2(last, contour->via[i]);
            last = contour->via[i];
        }
        area += cross2(last, contour->to[i]);
        last = contour->to[i];
    }
    return area;
}

static void draw_to(SvgPen *pen, const Contour *contour, int curve, const double to[2])
{
    if (contour->curved[curve])
        pen_quadratic(pen, contour->via[curve], to);
    else
        pen_line(pen, to);
}

/* Draws a contour so that its area is above 0: backwards where it is not. */
static void draw_contour(SvgPen *pen, const Contour *contour)
{
    int last = contour->count - 1;
    pen_move(pen, contour->to[last]);
    if (area_of(contour) >= 0)
        for (int i = 0; i <= last; i++)
            draw_to(pen, contour, i, contour->to[i]);
    else
        for (int i = last; i >= 0; i--)
            draw_to(pen, contour, i, contour->to[i > 0 ? i - 1 : last]);
    path_close(&pen->path);
}

/* ---- pieces ---- */

/* Finds the point at a distance to the left of a tangent; to the right where that is negative. */
static void beside(const Tangent *tangent, double distance, double point[2])
{
    point[0] = tangent->at[0] - distance * tangent->along[1];
    point[1] = tangent->at[1] + distance * tangent->along[0];
}

static bool unit2(double v[2])
{
    double length = real_hypot(v[0], v[1]);
    if (!(length > 0))
        return false;
    v[0] /= length;
    v[1] /= length;
    return true;
}

static Tangent tangent_at(const Curve *curve, double t)
{
    Tangent tangent;
    curve_point(curve, t, tangent.at);
    curve_tangent(curve, t, tangent.along);
    if (!unit2(tangent.along)) {
        for (int k = 0; k < 2; k++)
            tangent.along[k] = curve->to[k] - curve->from[k];
        unit2(tangent.along);
    }
    return tangent;
}

/* Returns the angle from one direction to another, in (-pi, pi]. */
static double angle_between(const double a[2], const double b[2])
{
    return real_atan2(cross2(a, b), dot2(a, b));
}

/* Finds where the tangents of what is parallel to a piece meet. */
static void control_beside(const Tangent *a, const Tangent *b, const double via[2], double distance,
                           double point[2])
{
    double share = distance / (1 + dot2(a->along, b->along));
    point[0]     = via[0] - share * (a->along[1] + b->along[1]);
    point[1]     = via[1] + share * (a->along[0] + b->along[0]);
}

/* Adds the side of a piece to a contour that ends at its first point. */
static void add_side(Contour *contour, const Curve *piece, const Tangent *a, const Tangent *b,
                     double distance)
{
    double via[2], to[2];
    beside(b, distance, to);
    if (piece->straight) {
        corner(contour, to);
        return;
    }
    control_beside(a, b, piece->via, distance, via);
    bend(contour, via, to);
}

/* Finds where the lines across both ends of a piece meet: the middle of its circle. */
static void middle_of(const Tangent *a, const Tangent *b, double point[2])
{
    double between[2] = {b->at[0] - a->at[0], b->at[1] - a->at[1]};
    double cross      = cross2(a->along, b->along);
    beside(a, dot2(between, b->along) / cross, point);
}

/* Draws a piece that is bent more than the stroke is wide: two sectors, of which one goes back. */
static void draw_bent(Stroker *stroker, const Curve *piece, const Tangent *a, const Tangent *b)
{
    double middle[2];
    middle_of(a, b, middle);
    for (int side = -1; side <= 1; side += 2) {
        Contour contour = {.count = 0};
        double  from[2];
        beside(a, side * stroker->radius, from);
        corner(&contour, middle);
        corner(&contour, from);
        add_side(&contour, piece, a, b, side * stroker->radius);
        draw_contour(stroker->pen, &contour);
    }
}

/* Tells whether the sides of a piece end where they should, not behind where they began. */
static bool goes_on(const Stroker *stroker, const Tangent *a, const Tangent *b)
{
    for (int side = -1; side <= 1; side += 2) {
        double from[2], to[2];
        beside(a, side * stroker->radius, from);
        beside(b, side * stroker->radius, to);
        double chord[2] = {to[0] - from[0], to[1] - from[1]};
        if (dot2(chord, a->along) < 0)
            return false;
    }
    return true;
}

static void draw_piece(Stroker *stroker, const Curve *piece)
{
    Tangent a = tangent_at(piece, 0), b = tangent_at(piece, 1);
    double  left[2], right[2];
    if (!piece->straight && !goes_on(stroker, &a, &b)) {
        draw_bent(stroker, piece, &a, &b);
        return;
    }
    Contour contour = {.count = 0};
    beside(&a, -stroker->radius, right);
    beside(&b, stroker->radius, left);
    corner(&contour, a.at);
    corner(&contour, right);
    add_side(&contour, piece, &a, &b, -stroker->radius);
    corner(&contour, b.at);
    corner(&contour, left);
    /* The left side, backwards: from the end of the piece to its beginning. */
    add_side(&contour, piece, &b, &a, stroker->radius);
    draw_contour(stroker->pen, &contour);
}

/* Tells how far a parabola turns up to t, from its first tangent. */
static double angle_up_to(const Curve *curve, double t)
{
    Tangent a = tangent_at(curve, 0), b = tangent_at(curve, t);
    return fabs(angle_between(a.along, b.along));
}

static double where_at_angle(const Curve *curve, double angle)
{
    double low = 0, high = 1;
    for (int i = 0; i < 50; i++) {
        double middle                                        = 0.5 * (low + high);
        *(angle_up_to(curve, middle) < angle ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

static void draw_curve(Stroker *stroker, const Curve *curve)
{
    double angle = curve->straight ? 0 : angle_up_to(curve, 1), before = 0;
    int    count = (int)ceil(angle / stroker->angle);
    for (int i = 1; i <= count || i == 1; i++) {
        double t     = i >= count ? 1 : where_at_angle(curve, angle * i / count);
        Curve  piece = count > 1 ? curve_part(curve, before, t) : *curve;
        draw_piece(stroker, &piece);
        before = t;
    }
}

/* ---- corners and ends ---- */

/* Adds the arc about a point from an end of a radius on, by an angle. */
static void add_arc(const Stroker *stroker, Contour *contour, const double at[2],
                    const double radius[2], double by)
{
    int    count = (int)fmin(fmax(ceil(fabs(by) / stroker->angle), 1), MAX_CORNERS - 8);
    double step = by / count, stretch = 1 / real_cos(0.5 * step);
    for (int i = 0; i < count; i++) {
        double middle = (i + 0.5) * step, end = (i + 1) * step, via[2], to[2];
        via[0] = at[0] + stretch * (real_cos(middle) * radius[0] - real_sin(middle) * radius[1]);
        via[1] = at[1] + stretch * (real_sin(middle) * radius[0] + real_cos(middle) * radius[1]);
        to[0]  = at[0] + real_cos(end) * radius[0] - real_sin(end) * radius[1];
        to[1]  = at[1] + real_sin(end) * radius[0] + real_cos(end) * radius[1];
        bend(contour, via, to);
    }
}

/* Draws what is between the end of one curve and the beginning of the next. */
static void draw_join(Stroker *stroker, const Tangent *a, const Tangent *b)
{
    const double SMALL = 1e-6;
    double       angle = angle_between(a->along, b->along), from[2], to[2];
    double       side  = angle >= 0 ? -stroker->radius : stroker->radius; /* the outer one */
    double       share = 1 + dot2(a->along, b->along);
    if (fabs(angle) < SMALL)
        return;
    Contour contour = {.count = 0};
    beside(a, side, from);
    beside(b, side, to);
    double radius[2] = {from[0] - a->at[0], from[1] - a->at[1]};
    corner(&contour, a->at);
    corner(&contour, from);
    if (stroker->stroke->join == JOIN_ROUND) {
        add_arc(stroker, &contour, a->at, radius, angle);
    } else {
        double limit = stroker->stroke->miter_limit, tip[2];
        control_beside(a, b, a->at, side, tip);
        if (stroker->stroke->join == JOIN_MITER && share > 0 && 2 / share <= limit * limit)
            corner(&contour, tip);
        corner(&contour, to);
    }
    draw_contour(stroker->pen, &contour);
}

/* Draws the cap of an end; the tangent goes out of the path. */
static void draw_cap(Stroker *stroker, const Tangent *tangent)
{
    Contour contour = {.count = 0};
    double  left[2], right[2];
    beside(tangent, stroker->radius, left);
    beside(tangent, -stroker->radius, right);
    double radius[2] = {right[0] - tangent->at[0], right[1] - tangent->at[1]};
    corner(&contour, tangent->at);
    corner(&contour, right);
    if (stroker->stroke->cap == CAP_ROUND) {
        add_arc(stroker, &contour, tangent->at, radius, M_PI);
    } else {
        Tangent end = *tangent;
        for (int k = 0; k < 2; k++)
            end.at[k] += stroker->radius * tangent->along[k];
        double far[2];
        beside(&end, -stroker->radius, far);
        corner(&contour, far);
        beside(&end, stroker->radius, far);
        corner(&contour, far);
        corner(&contour, left);
    }
    if (stroker->stroke->cap != CAP_BUTT)
        draw_contour(stroker->pen, &contour);
}

static Tangent reversed(Tangent tangent)
{
    tangent.along[0] = -tangent.along[0];
    tangent.along[1] = -tangent.along[1];
    return tangent;
}

static void draw_run(Stroker *stroker, const Curve *curves, size_t count, bool closed)
{
    for (size_t i = 0; i < count; i++) {
        draw_curve(stroker, &curves[i]);
        Tangent end = tangent_at(&curves[i], 1), next = tangent_at(&curves[(i + 1) % count], 0);
        if (i + 1 < count || closed)
            draw_join(stroker, &end, &next);
    }
    if (closed || count == 0)
        return;
    Tangent first = reversed(tangent_at(&curves[0], 0)), last = tangent_at(&curves[count - 1], 1);
    draw_cap(stroker, &first);
    draw_cap(stroker, &last);
}

/* ---- dashes ---- */

/* Returns the length by Gauss's three points on parts whose length is smooth. */
static double length_up_to(const Curve *curve, double end)
{
    static const double places[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double shares[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    enum { PARTS = 16 };
    double sum = 0, tangent[2];
    for (int i = 0; i < PARTS; i++)
        for (int k = 0; k < 3; k++) {
            curve_tangent(curve, end * (i + places[k]) / PARTS, tangent);
            sum += shares[k] * 2 * real_hypot(tangent[0], tangent[1]);
        }
    return sum * end / PARTS;
}

static double where_long(const Curve *curve, double length)
{
    double low = 0, high = 1;
    for (int i = 0; i < 40; i++) {
        double middle                                          = 0.5 * (low + high);
        *(length_up_to(curve, middle) < length ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

typedef struct Dashing {
    Stroker *stroker;
    Curves   run;  /* the dash at hand */
    int      dash; /* whose number is even where something is drawn */
    double   left; /* of it */
} Dashing;

static void end_dash(Dashing *dashing)
{
    if (dashing->dash % 2 == 0)
        draw_run(dashing->stroker, dashing->run.items, dashing->run.count, false);
    dashing->run.count = 0;
    dashing->dash      = (dashing->dash + 1) % dashing->stroker->stroke->dash_count;
    dashing->left      = dashing->stroker->stroke->dashes[dashing->dash];
}

static void dash_curve(Dashing *dashing, const Curve *curve)
{
    Arena *arena  = dashing->stroker->pen->path.arena;
    double length = length_up_to(curve, 1), at = 0, before = 0;
    while (at < length) {
        bool   ends = at + dashing->left < length;
        double t    = ends ? where_long(curve, at + dashing->left) : 1;
        Curve  part = curve_part(curve, before, t);
        if (dashing->dash % 2 == 0 && t > before)
            array_push(arena, &dashing->run, part);
        double step = ends ? dashing->left : length - at;
        at += step;
        before = t;
        if (ends)
            end_dash(dashing);
        else
            dashing->left -= step;
        if (!ends)
            break;
    }
}

static void draw_dashes(Stroker *stroker, const Curves *curves)
{
    const SvgStroke *stroke  = stroker->stroke;
    Dashing          dashing = {.stroker = stroker};
    double           period  = 0, offset;
    for (int i = 0; i < stroke->dash_count; i++)
        period += stroke->dashes[i];
    offset = fmod(stroke->dash_offset, period);
    offset += offset < 0 ? period : 0;
    while (offset >= stroke->dashes[dashing.dash] && dashing.dash + 1 < stroke->dash_count)
        offset -= stroke->dashes[dashing.dash++];
    dashing.left = stroke->dashes[dashing.dash] - offset;
    for (size_t i = 0; i < curves->count; i++)
        dash_curve(&dashing, &curves->items[i]);
    end_dash(&dashing);
}

/* A length of 0 is drawn solid, and so are dashes that are too many to be seen. */
static bool is_dashed(const SvgStroke *stroke, const Curves *curves)
{
    double length = 0, period = 0;
    for (size_t i = 0; i < curves->count; i++)
        length += length_up_to(&curves->items[i], 1);
    for (int i = 0; i < stroke->dash_count; i++)
        period += stroke->dashes[i];
    return period > 0 && stroke->dash_count * length / period < MAX_DASHES;
}

/* ---- the whole ---- */

/* A path that goes nowhere is a dot where its ends are round or square. */
static void draw_dot(Stroker *stroker, const double at[2])
{
    Tangent right = {{at[0], at[1]}, {1, 0}}, left = reversed(right);
    draw_cap(stroker, &right);
    draw_cap(stroker, &left);
}

void svg_stroke(SvgPen *pen, const SvgTrail *trail, const SvgStroke *stroke)
{
    double  radius  = 0.5 * stroke->width;
    Stroker stroker = {pen, stroke, radius, M_PI / 6};
    for (size_t i = 0; i < trail->count; i++) {
        const SvgSubpath *sub   = &trail->items[i];
        double            angle = real_pow(128 * sub->path.tolerance / radius, 0.25);
        stroker.angle           = fmin(fmax(angle, M_PI / 48), M_PI / 6);
        if (sub->path.curves.count == 0 && sub->drawn)
            draw_dot(&stroker, sub->path.start);
        else if (is_dashed(stroke, &sub->path.curves))
            draw_dashes(&stroker, &sub->path.curves);
        else
            draw_run(&stroker, sub->path.curves.items, sub->path.curves.count, sub->closed);
    }
}
