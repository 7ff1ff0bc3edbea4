/* fit.c: drops points of contours, and fits arcs. */
#include "slice/section.h"

#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/minmax.h"

/* ---- beginnings ---- */

static double distance2(const double a[2], const double b[2])
{
    return real_hypot(b[0] - a[0], b[1] - a[1]);
}

static size_t farthest_from(const OutlinePoint *points, size_t count, const double from[2])
{
    size_t farthest = 0;
    for (size_t i = 1; i < count; i++)
        if (distance2(points[i].at, from) > distance2(points[farthest].at, from))
            farthest = i;
    return farthest;
}

/* Rotates a contour to begin with a corner, or else with the point farthest from the first, and
   repeats that at the end, where there is room. */
static void rotate_to_corner(OutlinePoint *points, size_t count, Arena *scratch)
{
    size_t first = 0;
    while (first < count && !points[first].corner)
        first++;
    if (first == count)
        first = farthest_from(points, count, points[0].at);
    OutlinePoint *before = arena_new_array(scratch, OutlinePoint, first + 1);
    memcpy(before, points, first * sizeof *points);
    memmove(points, points + first, (count - first) * sizeof *points);
    memcpy(points + count - first, before, first * sizeof *points);
    points[0].corner = true;
    points[count]    = points[0];
}

/* ---- points ---- */

static double distance_to_line(const double at[2], const double from[2], const double to[2])
{
    double along[2] = {to[0] - from[0], to[1] - from[1]},
           off[2]   = {at[0] - from[0], at[1] - from[1]};
    double length2  = along[0] * along[0] + along[1] * along[1];
    double part     = length2 > 0 ? (off[0] * along[0] + off[1] * along[1]) / length2 : 0;
    part            = max2(0, min2(1, part));
    return real_hypot(off[0] - part * along[0], off[1] - part * along[1]);
}

/* Returns the point between two that is farthest from the line between them, if that is more than
   the error; or 0. */
static size_t farthest_between(const OutlinePoint *points, size_t from, size_t to, double error)
{
    size_t farthest = 0;
    for (size_t i = from + 1; i < to; i++) {
        double distance = distance_to_line(points[i].at, points[from].at, points[to].at);
        if (distance > error) {
            error    = distance;
            farthest = i;
        }
    }
    return farthest;
}

/* Keeps the points that are needed, by Douglas and Peucker's algorithm.  Both ends must differ, so
   a contour without corners is halved before. */
static void keep_needed(const OutlinePoint *points, size_t from, size_t to, double error,
                        bool *kept, Arena *scratch)
{
    struct {
        size_t (*items)[2];
        size_t count, capacity;
    } open = {0};
    array_reserve_large(scratch, &open);
    memcpy(open.items[open.count++], (size_t[2]){from, to}, sizeof *open.items);
    kept[from] = kept[to] = true;
    while (open.count > 0) {
        size_t run[2];
        memcpy(run, open.items[--open.count], sizeof run);
        size_t at = farthest_between(points, run[0], run[1], error);
        if (at == 0)
            continue;
        kept[at] = true;
        for (int i = 0; i < 2; i++) {
            array_reserve_large(scratch, &open);
            memcpy(open.items[open.count++],
                   i ? ((size_t[2]){at, run[1]}) : ((size_t[2]){run[0], at}), sizeof *open.items);
        }
    }
}

size_t leave_out_points(OutlinePoint *points, size_t count, double error, Arena *scratch)
{
    ArenaMark before = arena_mark(scratch);
    bool     *kept   = arena_new_array(scratch, bool, count + 1);
    size_t    left   = 0;
    rotate_to_corner(points, count, scratch);
    for (size_t from = 0, to; from < count; from = to) {
        for (to = from + 1; !points[to].corner;)
            to++;
        if (from == 0 && to == count) {
            size_t half = farthest_from(points, count, points[0].at);
            keep_needed(points, from, half, error, kept, scratch);
            keep_needed(points, half, to, error, kept, scratch);
        } else
            keep_needed(points, from, to, error, kept, scratch);
    }
    for (size_t i = 0; i < count; i++)
        if (kept[i])
            points[left++] = points[i];
    arena_rewind(scratch, before);
    return left;
}

/* ---- lines and arcs ---- */

/* Errors within which pieces touch: a run may end with a point behind where the next piece touches
   it, which bends its arc a little. */
static const double LOOSER = 20;

/* A line, or an arc, whose radius is above 0. */
typedef struct Piece2 {
    double from[2], to[2], centre[2], radius, bulge;
} Piece2;

static Piece2 line_of(const double from[2], const double to[2])
{
    return (Piece2){.from = {from[0], from[1]}, .to = {to[0], to[1]}};
}

static bool arc_of(const double from[2], const double via[2], const double to[2], Piece2 *arc)
{
    double a[2] = {via[0] - from[0], via[1] - from[1]}, b[2] = {to[0] - from[0], to[1] - from[1]};
    double cross = a[0] * b[1] - a[1] * b[0];
    double aa = a[0] * a[0] + a[1] * a[1], bb = b[0] * b[0] + b[1] * b[1];
    if (fabs(cross) <= 1e-12 * bb)
        return false;
    *arc           = line_of(from, to);
    arc->centre[0] = from[0] + 0.5 * (b[1] * aa - a[1] * bb) / cross;
    arc->centre[1] = from[1] + 0.5 * (a[0] * bb - b[0] * aa) / cross;
    arc->radius    = distance2(arc->centre, from);
    /* The inscribed angle is half of the central one. */
    double c[2]  = {to[0] - via[0], to[1] - via[1]};
    double angle = real_atan2(a[0] * c[1] - a[1] * c[0], a[0] * c[0] + a[1] * c[1]);
    arc->bulge   = real_tan(0.5 * angle);
    return fabs(angle) < 0.75 * M_PI;
}

static bool fits(const OutlinePoint *points, size_t from, size_t to, const Piece2 *piece,
                 double error)
{
    for (size_t i = from + 1; i < to; i++) {
        double off = piece->radius > 0
                         ? fabs(distance2(points[i].at, piece->centre) - piece->radius)
                         : distance_to_line(points[i].at, piece->from, piece->to);
        if (!(off <= error))
            return false;
    }
    return true;
}

static bool fit_run(const OutlinePoint *points, size_t from, size_t to, double error, Piece2 *piece)
{
    *piece = line_of(points[from].at, points[to].at);
    if (fits(points, from, to, piece, error))
        return true;
    return to - from >= 3 &&
           arc_of(points[from].at, points[(from + to) / 2].at, points[to].at, piece) &&
           fits(points, from, to, piece, error);
}

/* Returns the end of the longest run that one piece fits, up to `end`: doubles its length, at least
   to eight steps, until none fits, then bisects. */
static size_t longest_run(const OutlinePoint *points, size_t from, size_t end, double error,
                          Piece2 *best)
{
    size_t good = from + 1, bad = end + 1;
    *best = line_of(points[from].at, points[good].at);
    for (size_t step = 2; good < end && bad > end; step *= 2) {
        size_t to = from + step < end ? from + step : end;
        Piece2 piece;
        if (fit_run(points, from, to, error, &piece)) {
            good  = to;
            *best = piece;
        } else if (step >= 8)
            bad = to;
    }
    while (bad - good > 1 && bad <= end) {
        size_t to = good + (bad - good) / 2;
        Piece2 piece;
        if (fit_run(points, from, to, error, &piece)) {
            good  = to;
            *best = piece;
        } else
            bad = to;
    }
    return good;
}

/* Returns the distance from a point to the line or the circle of a piece. */
static double distance_to_whole(const Piece2 *piece, const double at[2])
{
    if (piece->radius > 0)
        return fabs(distance2(at, piece->centre) - piece->radius);
    double along[2] = {piece->to[0] - piece->from[0], piece->to[1] - piece->from[1]};
    double cross    = along[0] * (at[1] - piece->from[1]) - along[1] * (at[0] - piece->from[0]);
    return fabs(cross) / real_hypot(along[0], along[1]);
}

/* Finds where a line and a circle, or two circles, touch, as near to `near` as they do. */
static bool touching_point(const Piece2 *a, const Piece2 *b, const double near[2], double touch[2])
{
    const Piece2 *round = a->radius > 0 ? a : b, *other = a->radius > 0 ? b : a;
    double        to[2];
    if (round->radius == 0)
        return false;
    if (other->radius > 0) {
        for (int k = 0; k < 2; k++)
            to[k] = other->centre[k] - round->centre[k];
    } else {
        to[0] = other->from[1] - other->to[1];
        to[1] = other->to[0] - other->from[0];
    }
    double length = real_hypot(to[0], to[1]);
    double side   = to[0] * (near[0] - round->centre[0]) + to[1] * (near[1] - round->centre[1]);
    for (int k = 0; k < 2 && length > 0; k++)
        touch[k] = round->centre[k] + (side < 0 ? -1 : 1) * round->radius * to[k] / length;
    return length > 0;
}

static void end_piece_at(Piece2 *piece, bool at_end, const double touch[2])
{
    double *end = at_end ? piece->to : piece->from;
    memcpy(end, touch, 2 * sizeof *touch);
    if (piece->radius == 0)
        return;
    double a[2]  = {piece->from[0] - piece->centre[0], piece->from[1] - piece->centre[1]};
    double b[2]  = {piece->to[0] - piece->centre[0], piece->to[1] - piece->centre[1]};
    double sweep = real_atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    if (piece->bulge > 0 && sweep < 0)
        sweep += 2 * M_PI;
    if (piece->bulge < 0 && sweep > 0)
        sweep -= 2 * M_PI;
    piece->bulge = real_tan(0.25 * sweep);
}

/* Moves the end of a piece and the beginning of the next, near `near`, to where they touch; returns
   false if they do not, within an error, or farther away than `reach`. */
static bool join_smoothly(Piece2 *before, Piece2 *behind, const double near[2], double reach,
                          double error)
{
    double touch[2];
    if (!touching_point(before, behind, near, touch) || distance2(touch, near) > reach ||
        distance_to_whole(before, touch) > error || distance_to_whole(behind, touch) > error)
        return false;
    end_piece_at(before, true, touch);
    end_piece_at(behind, false, touch);
    return true;
}

/* The pieces of a contour; links lead only from one point to the next. */
typedef struct Pieces {
    Piece2 *items;
    bool   *links;
    size_t  count;
} Pieces;

static void fit_runs(const OutlinePoint *points, size_t count, double error, Pieces *pieces)
{
    for (size_t from = 0, end = 0, to; from < count; from = to) {
        if (end <= from)
            for (end = from + 1; !points[end].corner;)
                end++;
        to = longest_run(points, from, end, error, &pieces->items[pieces->count]);
        pieces->links[pieces->count++] = to == from + 1;
    }
}

/* Drops links between a line and an arc that touches it, which lead from the last point on one to
   the first on the other. */
static void leave_out_links(Pieces *pieces, double error)
{
    size_t left = 0, count = pieces->count;
    for (size_t i = 0; i < count; i++) {
        Piece2 *link = &pieces->items[i], *behind = &pieces->items[(i + 1) % count];
        Piece2 *before = left > 0 ? &pieces->items[left - 1] : &pieces->items[count - 1];
        double near[2] = {0.5 * (link->from[0] + link->to[0]), 0.5 * (link->from[1] + link->to[1])};
        bool gone = left + count - i > 2 && pieces->links[i] && before->radius != behind->radius &&
                    join_smoothly(before, behind, near, distance2(link->from, link->to), error);
        if (!gone)
            pieces->items[left++] = *link;
    }
    pieces->count = left;
}

static void touch_neighbours(Pieces *pieces, double error)
{
    static const double PART = 0.25;
    for (size_t i = 0; i < pieces->count && pieces->count > 1; i++) {
        Piece2 *before = &pieces->items[i], *behind = &pieces->items[(i + 1) % pieces->count];
        double  near[2] = {before->to[0], before->to[1]};
        double  reach   = PART * min2(distance2(before->from, before->to),
                                      distance2(behind->from, behind->to));
        join_smoothly(before, behind, near, reach, error);
    }
}

/* Joins the first piece with the last, if they are one: contours without corners begin anywhere. */
static void join_ends(Pieces *pieces, double error)
{
    if (pieces->count < 4)
        return;
    Piece2 *first = &pieces->items[0], *last = &pieces->items[pieces->count - 1];
    double  sweep = 4 * fabs(real_atan(first->bulge) + real_atan(last->bulge));
    if ((first->radius > 0) != (last->radius > 0) || first->bulge * last->bulge < 0 ||
        sweep > M_PI || distance_to_whole(last, first->to) > error ||
        distance_to_whole(first, last->from) > error)
        return;
    end_piece_at(last, true, first->to);
    pieces->items[0] = *last;
    pieces->count--;
}

/* Tells whether an arc is within the error of its chord. */
static bool is_straight(const Piece2 *piece, double error)
{
    return 0.5 * fabs(piece->bulge) * distance2(piece->from, piece->to) <= error;
}

size_t fit_arcs(OutlinePoint *points, double *bulges, size_t count, double error, Arena *scratch)
{
    ArenaMark before = arena_mark(scratch);
    Pieces    pieces = {.items = arena_new_array(scratch, Piece2, count),
                        .links = arena_new_array(scratch, bool, count)};
    size_t    left   = 0;
    rotate_to_corner(points, count, scratch);
    fit_runs(points, count, error, &pieces);
    leave_out_links(&pieces, LOOSER * error);
    touch_neighbours(&pieces, LOOSER * error);
    join_ends(&pieces, LOOSER * error);
    for (size_t i = 0; i < pieces.count; i++) {
        memcpy(points[left].at, pieces.items[i].from, sizeof points[left].at);
        bulges[left++] = is_straight(&pieces.items[i], error) ? 0 : pieces.items[i].bulge;
    }
    arena_rewind(scratch, before);
    return left;
}
