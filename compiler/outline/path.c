/*
 * path.c: contours in the plane, and what is asked of one curve.
 */
#include "compiler/outline/path.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"

enum { MAX_QUADRATICS = 64 /* of a cubic curve */ };

Curve line_between(const double from[2], const double to[2])
{
    Curve line = {.straight = true};
    for (int k = 0; k < 2; k++) {
        line.from[k] = from[k];
        line.via[k]  = 0.5 * (from[k] + to[k]);
        line.to[k]   = to[k];
    }
    return line;
}

/* ---- drawing ---- */

static bool is_same(const double a[2], const double b[2]) { return a[0] == b[0] && a[1] == b[1]; }

static void add_curve(Path *path, const Curve *curve)
{
    array_push(path->arena, &path->curves, *curve);
    memcpy(path->at, curve->to, sizeof path->at);
}

void path_line(Path *path, const double to[2])
{
    if (is_same(path->at, to))
        return;
    Curve line = line_between(path->at, to);
    add_curve(path, &line);
}

void path_close(Path *path) { path_line(path, path->start); }

void path_move(Path *path, const double to[2])
{
    path_close(path);
    memcpy(path->start, to, sizeof path->start);
    memcpy(path->at, to, sizeof path->at);
}

/* Curves whose points are on one line are drawn as lines, to where they turn back and from there. */
void path_quadratic(Path *path, const double via[2], const double to[2])
{
    Curve  curve = {.straight = false};
    double chord[2], tangent[2];
    memcpy(curve.from, path->at, sizeof curve.from);
    memcpy(curve.via, via, sizeof curve.via);
    memcpy(curve.to, to, sizeof curve.to);
    for (int k = 0; k < 2; k++) {
        chord[k]   = to[k] - curve.from[k];
        tangent[k] = via[k] - curve.from[k];
    }
    double size = fmax(real_hypot(chord[0], chord[1]), real_hypot(tangent[0], tangent[1]));
    if (fabs(cross2(chord, tangent)) > 1e-9 * size * size) {
        add_curve(path, &curve);
        return;
    }
    double bend[2] = {curve.from[0] - 2 * via[0] + to[0], curve.from[1] - 2 * via[1] + to[1]};
    double square  = dot2(bend, bend), turn[2];
    double t       = square > 0 ? dot2(tangent, bend) / -square : 0;
    if (t > 0 && t < 1) {
        curve_point(&curve, t, turn);
        path_line(path, turn);
    }
    path_line(path, to);
}

/* Draws an arc by parts that each turn by a quarter of a circle at most. */
void path_arc(Path *path, const double to[2], double bulge)
{
    double from[2] = {path->at[0], path->at[1]}, turn = 4 * real_atan(bulge);
    double chord[2] = {to[0] - from[0], to[1] - from[1]};
    /* The centre is to the left of the middle of the chord by this share of the chord. */
    double left  = 0.25 * (1 / bulge - bulge);
    int    count = (int)fmax(ceil(fabs(turn) / (0.5 * M_PI) - 1e-9), 1);
    Curve  arc   = {.straight = false};
    if (fabs(bulge) < 1e-9 || is_same(from, to)) {
        path_line(path, to);
        return;
    }
    arc.centre[0] = 0.5 * (from[0] + to[0]) - left * chord[1];
    arc.centre[1] = 0.5 * (from[1] + to[1]) + left * chord[0];
    arc.radius    = real_hypot(from[0] - arc.centre[0], from[1] - arc.centre[1]);
    double begin  = real_atan2(from[1] - arc.centre[1], from[0] - arc.centre[0]);
    double part = turn / count, far = arc.radius / real_cos(0.5 * part);
    for (int i = 1; i <= count; i++) {
        double end = begin + i * part, middle = end - 0.5 * part;
        memcpy(arc.from, path->at, sizeof arc.from);
        arc.via[0] = arc.centre[0] + far * real_cos(middle);
        arc.via[1] = arc.centre[1] + far * real_sin(middle);
        arc.to[0]  = i < count ? arc.centre[0] + arc.radius * real_cos(end) : to[0];
        arc.to[1]  = i < count ? arc.centre[1] + arc.radius * real_sin(end) : to[1];
        add_curve(path, &arc);
    }
}

/* A cubic curve leaves the quadratic one with the same ends, and a control point in the middle, by
   at most sqrt(3) / 36 of its third difference.  A part of 1 / n has 1 / n^3 of that; its control
   points are old + slope / n and end - next / n. */
void path_cubic(Path *path, const double first[2], const double second[2], const double to[2])
{
    double from[2] = {path->at[0], path->at[1]}, third[2];
    for (int k = 0; k < 2; k++)
        third[k] = to[k] - 3 * second[k] + 3 * first[k] - from[k];
    double away   = sqrt(3) / 36 * real_hypot(third[0], third[1]);
    double parts  = ceil(real_cbrt(away / path->tolerance));
    int    count  = parts > 1 ? (int)fmin(parts, MAX_QUADRATICS) : 1;
    double old[2] = {from[0], from[1]}, slope[2];
    for (int k = 0; k < 2; k++)
        slope[k] = first[k] - from[k];
    for (int i = 1; i <= count; i++) {
        double t = (double)i / count, u = 1 - t, end[2], next[2], via[2];
        for (int k = 0; k < 2; k++) {
            end[k] = u * u * u * from[k] + 3 * u * u * t * first[k] + 3 * u * t * t * second[k] +
                     t * t * t * to[k];
            next[k] = u * u * (first[k] - from[k]) + 2 * u * t * (second[k] - first[k]) +
                      t * t * (to[k] - second[k]);
            via[k] = 0.5 * (old[k] + end[k]) + 0.75 * (slope[k] - next[k]) / count;
        }
        path_quadratic(path, via, i < count ? end : to);
        memcpy(old, end, sizeof old);
        memcpy(slope, next, sizeof slope);
    }
}

/* ---- one curve ---- */

/* Returns the weight of `via` among the control points. */
static double weight_of(const Curve *curve)
{
    return curve->radius > 0 ? curve->radius / real_hypot(curve->via[0] - curve->centre[0],
                                                          curve->via[1] - curve->centre[1])
                             : 1;
}

/* Finds the weighted control points of the part from t to u: its ends and what is between them; t =
   u: a point.  The third component is the weight. */
static void blossom(const Curve *curve, double t, double u, double point[3])
{
    double weight = weight_of(curve);
    double first = (1 - t) * (1 - u), last = t * u, between = (1 - first - last) * weight;
    for (int k = 0; k < 2; k++)
        point[k] = first * curve->from[k] + between * curve->via[k] + last * curve->to[k];
    point[2] = first + between + last;
}

void curve_point(const Curve *curve, double t, double point[2])
{
    double u = 1 - t, weighted[3];
    if (curve->radius > 0) {
        blossom(curve, t, t, weighted);
        point[0] = weighted[0] / weighted[2];
        point[1] = weighted[1] / weighted[2];
        return;
    }
    for (int k = 0; k < 2; k++)
        point[k] = curve->straight
                       ? u * curve->from[k] + t * curve->to[k]
                       : u * u * curve->from[k] + 2 * u * t * curve->via[k] + t * t * curve->to[k];
}

/* Returns half of the derivative of a quotient, from the points at both ends of what has the
   tangent. */
static void arc_tangent(const Curve *curve, double t, double tangent[2])
{
    double at[3], before[3], behind[3];
    blossom(curve, t, t, at);
    blossom(curve, t, 0, before);
    blossom(curve, t, 1, behind);
    for (int k = 0; k < 2; k++)
        tangent[k] = (behind[k] - before[k] - (behind[2] - before[2]) * at[k] / at[2]) / at[2];
}

void curve_tangent(const Curve *curve, double t, double tangent[2])
{
    if (curve->radius > 0) {
        arc_tangent(curve, t, tangent);
        return;
    }
    for (int k = 0; k < 2; k++)
        tangent[k] = curve->straight ? 0.5 * (curve->to[k] - curve->from[k])
                                     : (1 - t) * (curve->via[k] - curve->from[k]) +
                                           t * (curve->to[k] - curve->via[k]);
}

Curve curve_part(const Curve *curve, double t, double u)
{
    double from[2], to[2], tangent[2], via[3];
    curve_point(curve, t, from);
    curve_point(curve, u, to);
    Curve part = line_between(from, to);
    if (curve->straight)
        return part;
    part.straight = false;
    if (curve->radius > 0) {
        blossom(curve, t, u, via);
        memcpy(part.centre, curve->centre, sizeof part.centre);
        part.radius = curve->radius;
        for (int k = 0; k < 2; k++)
            part.via[k] = via[k] / via[2];
        return part;
    }
    curve_tangent(curve, t, tangent);
    for (int k = 0; k < 2; k++)
        part.via[k] = from[k] + (u - t) * tangent[k];
    return part;
}

Curve curve_reversed(const Curve *curve)
{
    Curve reversed = *curve;
    memcpy(reversed.from, curve->to, sizeof reversed.from);
    memcpy(reversed.to, curve->from, sizeof reversed.to);
    return reversed;
}

static double square_to(const Curve *curve, double t, const double point[2])
{
    double at[2];
    curve_point(curve, t, at);
    return (at[0] - point[0]) * (at[0] - point[0]) + (at[1] - point[1]) * (at[1] - point[1]);
}

/* The curve is a + 2 b t + c t^2.  Half of the derivative of the squared distance is concave before
   the parabola's apex and convex behind it.  So Newton's method, begun at the first end where that
   falls and at the last end where it rises, goes to the outermost root there. */
static double newton_root(const double f[4], double t)
{
    for (int i = 0; i < 60; i++) {
        double value = ((f[3] * t + f[2]) * t + f[1]) * t + f[0];
        double slope = (3 * f[3] * t + 2 * f[2]) * t + f[1];
        if (value == 0 || slope <= 0)
            break;
        double next = t - value / slope;
        if (fabs(next - t) < 1e-15)
            return next;
        t = next;
    }
    return t;
}

static double clamp_unit(double t) { return t < 0 ? 0 : t > 1 ? 1 : t; }

/* Returns the parameter of the nearest point.  From the middle of an arc on, the tangent of half of
   the angle grows evenly with t. */
static double arc_nearest(const Curve *curve, const double point[2])
{
    double middle[2], from[2], at[2];
    for (int k = 0; k < 2; k++) {
        middle[k] = curve->via[k] - curve->centre[k];
        from[k]   = curve->from[k] - curve->centre[k];
        at[k]     = point[k] - curve->centre[k];
    }
    double half  = real_atan2(cross2(middle, from), dot2(middle, from));
    double angle = real_atan2(cross2(middle, at), dot2(middle, at));
    if (fabs(angle) <= fabs(half))
        return clamp_unit(0.5 - 0.5 * real_tan(0.5 * angle) / real_tan(0.5 * half));
    return (angle < 0) == (half < 0) ? 0 : 1;
}

double curve_nearest(const Curve *curve, const double point[2])
{
    if (curve->radius > 0)
        return arc_nearest(curve, point);
    double q[2], b[2], c[2], bb = 0, bc = 0, cc = 0, qb = 0, qc = 0;
    for (int k = 0; k < 2; k++) {
        q[k] = curve->from[k] - point[k];
        b[k] = curve->straight ? 0.5 * (curve->to[k] - curve->from[k])
                               : curve->via[k] - curve->from[k];
        c[k] = curve->straight ? 0 : curve->from[k] - 2 * curve->via[k] + curve->to[k];
        bb += b[k] * b[k], bc += b[k] * c[k], cc += c[k] * c[k];
        qb += q[k] * b[k], qc += q[k] * c[k];
    }
    double f[4] = {qb, 2 * bb + qc, 3 * bc, cc};
    if (cc == 0)
        return bb > 0 ? clamp_unit(-qb / (2 * bb)) : 0;
    double apex = -bc / cc, at_end = f[0] + f[1] + f[2] + f[3];
    double tried[4] = {0, 1, apex > 0 && qb < 0 ? clamp_unit(newton_root(f, 0)) : 0,
                       apex < 1 && at_end > 0 ? clamp_unit(newton_root(f, 1)) : 1};
    double best = 0, least = HUGE_VAL;
    for (int i = 0; i < 4; i++) {
        double square = square_to(curve, tried[i], point);
        if (square < least) {
            least = square;
            best  = tried[i];
        }
    }
    return best;
}
