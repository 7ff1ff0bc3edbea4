/*
 * resolve.c: from contours to the outline of what they fill.
 */
#include "compiler/outline/outline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/outline/edges.h"

#define TOLERANCE 1e-9 /* of the size */
#define SHARP     0.1  /* a corner leans where its angle is less */

/* ---- edges ---- */

void add_edge(Making *making, const Curve *curve, int weight)
{
    Edge edge = {*curve, knot_at(&making->knots, curve->from), knot_at(&making->knots, curve->to),
                 weight};
    if (edge.from == edge.to)
        return;
    memcpy(edge.curve.from, making->knots.items[edge.from].at, sizeof edge.curve.from);
    memcpy(edge.curve.to, making->knots.items[edge.to].at, sizeof edge.curve.to);
    if (edge.curve.straight)
        edge.curve = line_between(edge.curve.from, edge.curve.to);
    array_push_large(making->arena, &making->edges, edge);
}

/* Finds where an arc is farthest along an axis; at most two of these are in a quarter of a
   circle. */
static int arc_extremes(const Curve *curve, double extremes[2])
{
    static const double axes[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int                 count      = 0;
    for (int i = 0; i < 4 && count < 2; i++) {
        double t = curve_nearest(curve, (double[]){curve->centre[0] + curve->radius * axes[i][0],
                                                   curve->centre[1] + curve->radius * axes[i][1]});
        if (t > 1e-9 && t < 1 - 1e-9)
            extremes[count++] = t;
    }
    return count;
}

/* Cuts a curve where a coordinate turns back. */
static void add_monotone(Making *making, const Curve *curve)
{
    double extremes[4] = {0, 1, 1, 1};
    int    count       = 1;
    for (int k = 0; k < 2 && !curve->straight && !(curve->radius > 0); k++) {
        double way = curve->via[k] - curve->from[k], next = curve->to[k] - curve->via[k];
        double t = way != next ? way / (way - next) : 0;
        if (t > 0 && t < 1)
            extremes[count++] = t;
    }
    if (curve->radius > 0)
        count += arc_extremes(curve, extremes + 1);
    if (count == 3 && extremes[1] > extremes[2]) {
        double t    = extremes[1];
        extremes[1] = extremes[2];
        extremes[2] = t;
    }
    extremes[count] = 1;
    for (int i = 0; i < count; i++) {
        Curve part = count > 1 ? curve_part(curve, extremes[i], extremes[i + 1]) : *curve;
        add_edge(making, &part, 1);
    }
}

/* ---- edges that are one ---- */

/* Returns an edge so that it starts from the knot with the smaller number. */
static Edge ascending(const Edge *edge)
{
    if (edge->from < edge->to)
        return *edge;
    return (Edge){curve_reversed(&edge->curve), edge->to, edge->from, -edge->weight};
}

static int compare_numbers(double a, double b) { return (a > b) - (a < b); }

static int compare_edges(const void *a, const void *b)
{
    const Edge *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    if (x->to != y->to)
        return x->to < y->to ? -1 : 1;
    int order = compare_numbers(x->curve.via[0], y->curve.via[0]);
    return order ? order : compare_numbers(x->curve.via[1], y->curve.via[1]);
}

static bool is_one(const Edge *a, const Edge *b, double tolerance)
{
    return a->from == b->from && a->to == b->to &&
           real_hypot(a->curve.via[0] - b->curve.via[0], a->curve.via[1] - b->curve.via[1]) <=
               8 * tolerance;
}

static void merge_edges(Making *making)
{
    Edges *edges = &making->edges;
    size_t kept  = 0;
    for (size_t i = 0; i < edges->count; i++)
        edges->items[i] = ascending(&edges->items[i]);
    if (edges->count)
        qsort(edges->items, edges->count, sizeof *edges->items, compare_edges);
    for (size_t i = 0; i < edges->count; i++)
        if (kept > 0 && is_one(&edges->items[kept - 1], &edges->items[i], making->knots.tolerance))
            edges->items[kept - 1].weight += edges->items[i].weight;
        else
            edges->items[kept++] = edges->items[i];
    edges->count = kept;
}

/* ---- what separates inside and outside ---- */

static void reverse(Edge *edge)
{
    *edge = (Edge){curve_reversed(&edge->curve), edge->to, edge->from, edge->weight};
}

/* Keeps the edges of the boundary, with the inside on the left. */
static void retain_boundary(Making *making, FillRule rule)
{
    const Sides *sides = edge_sides(making, rule);
    size_t       kept  = 0;
    for (size_t i = 0; i < making->edges.count; i++) {
        Edge edge = making->edges.items[i];
        if (sides[i].left == sides[i].right)
            continue;
        if (sides[i].right)
            reverse(&edge);
        making->edges.items[kept++] = edge;
    }
    making->edges.count = kept;
}

/* ---- corners ---- */

/* The end of an edge at a knot. */
typedef struct End {
    uint32_t knot, edge;
    bool     last;  /* the edge ends there */
    double   angle; /* of the direction in which the edge leaves the knot */
} End;

/* Returns the angle at which an edge leaves.  If tangents are equal the curves tell which is where:
   so not the tangent counts, but the way to a point that is near. */
static double leaving_angle(const Edge *edge, bool last)
{
    const double *at = last ? edge->curve.to : edge->curve.from;
    double        near[2];
    curve_point(&edge->curve, last ? 1 - 1e-4 : 1e-4, near);
    return real_atan2(near[1] - at[1], near[0] - at[0]);
}

static int compare_ends(const void *a, const void *b)
{
    const End *x = a, *y = b;
    if (x->knot != y->knot)
        return x->knot < y->knot ? -1 : 1;
    if (x->angle != y->angle)
        return compare_numbers(x->angle, y->angle);
    return x->edge != y->edge ? (x->edge > y->edge) - (x->edge < y->edge) : x->last - y->last;
}

static End *sorted_ends(const Making *making)
{
    const Edges *edges = &making->edges;
    End         *ends  = arena_new_array(making->arena, End, 2 * edges->count + 1);
    for (uint32_t i = 0; i < edges->count; i++) {
        const Edge *edge = &edges->items[i];
        ends[2 * i]      = (End){edge->from, i, false, leaving_angle(edge, false)};
        ends[2 * i + 1]  = (End){edge->to, i, true, leaving_angle(edge, true)};
    }
    if (edges->count)
        qsort(ends, 2 * edges->count, sizeof *ends, compare_ends);
    return ends;
}

/* Returns the angle of the inside, from where an edge begins, around to where one ends. */
static double angle_inside(const End *begins, const End *ends)
{
    double angle = ends->angle - begins->angle;
    return angle > 0 ? angle : angle + 2 * M_PI;
}

static void set_corner(const End *begins, const End *ends, double lean, Piece *pieces)
{
    double angle = angle_inside(begins, ends);
    double turn  = fmin(fmax(real_tan(0.5 * (M_PI - angle)), -1e3), 1e3);
    double leans = angle < SHARP ? lean : angle > 2 * M_PI - SHARP ? -lean : 0;

    pieces[begins->edge].corner[0] = -turn;
    pieces[ends->edge].corner[1]   = turn;
    if (leans != 0)
        pieces[begins->edge].lean = pieces[ends->edge].lean = leans;
}

/*
 * The edges at a knot bound sectors that are inside and outside in turn.  One of them at most is
 * wider than half a turn; only in that one the knot itself may be nearest.  All corners must agree
 * there: so corners are those of the sectors that are on the other side.
 */
static bool set_corners(const End *ends, size_t count, double lean, Piece *pieces)
{
    bool wide = false;
    for (size_t i = 0; i < count; i++) {
        const End *next = &ends[(i + 1) % count];
        if (ends[i].last == next->last)
            return false;
        if (!ends[i].last)
            wide = wide || (count > 2 && angle_inside(&ends[i], next) > M_PI);
    }
    for (size_t i = 0; i < count; i++) {
        const End *next = &ends[(i + 1) % count];
        if (!ends[i].last && !wide)
            set_corner(&ends[i], next, lean, pieces);
        if (ends[i].last && wide) /* from the end of one to the beginning of the next is outside */
            set_corner(next, &ends[i], lean, pieces);
    }
    return true;
}

static OutlineFault find_corners(Making *making, double lean, Piece *pieces)
{
    const End *ends  = sorted_ends(making);
    size_t     count = 2 * making->edges.count;
    for (size_t i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count && ends[next].knot == ends[i].knot;)
            next++;
        if (!set_corners(ends + i, next - i, lean, pieces)) {
            memcpy(making->fault_at, making->knots.items[ends[i].knot].at, sizeof making->fault_at);
            return OUTLINE_UNRESOLVED;
        }
    }
    return OUTLINE_GOOD;
}

/* ---- the whole ---- */

static void find_box(Outline *outline, const Curves *curves)
{
    for (int k = 0; k < 2; k++) {
        outline->low[k]  = HUGE_VAL;
        outline->high[k] = -HUGE_VAL;
    }
    for (size_t i = 0; i < curves->count; i++)
        for (int k = 0; k < 2; k++) {
            const Curve *curve = &curves->items[i];
            outline->low[k]    = fmin(outline->low[k], fmin(curve->from[k], curve->to[k]));
            outline->high[k]   = fmax(outline->high[k], fmax(curve->from[k], curve->to[k]));
            outline->size      = fmax(outline->size,
                                      fmax(fabs(outline->low[k]), fabs(outline->high[k])));
        }
}

static OutlineFault make_pieces(Outline *outline, Making *making, Arena *arena)
{
    const Edges *edges = &making->edges;
    Curves       kept  = {0};
    outline->count     = (uint32_t)edges->count;
    outline->pieces    = arena_new_array(arena, Piece, edges->count + 1);
    for (size_t i = 0; i < edges->count; i++) {
        outline->pieces[i].curve = edges->items[i].curve;
        array_push_large(making->arena, &kept, edges->items[i].curve);
    }
    find_box(outline, &kept);
    return find_corners(making, LEAN * outline->size, outline->pieces);
}

OutlineFault outline_make(Outline *outline, const Curves *curves, FillRule rule, Arena *arena,
                          Arena *scratch, double fault_at[2])
{
    *outline = (Outline){0};
    find_box(outline, curves);
    if (curves->count > MAX_EDGES)
        return OUTLINE_TOO_MANY;
    double extent = fmax(outline->high[0] - outline->low[0], outline->high[1] - outline->low[1]);
    Making making = {.arena = scratch};
    making.knots  = (Knots){.arena = scratch, .tolerance = TOLERANCE * fmax(extent, 1e-300)};
    for (size_t i = 0; i < curves->count; i++)
        add_monotone(&making, &curves->items[i]);
    OutlineFault fault = cut_edges(&making);
    if (fault == OUTLINE_GOOD) {
        merge_edges(&making);
        retain_boundary(&making, rule);
        fault = make_pieces(outline, &making, arena);
    }
    memcpy(fault_at, making.fault_at, sizeof making.fault_at);
    return fault;
}

double piece_distance(const Piece *piece, const double point[2])
{
    double t = curve_nearest(&piece->curve, point), at[2], tangent[2];
    curve_point(&piece->curve, t, at);
    curve_tangent(&piece->curve, t, tangent);
    double away[2] = {point[0] - at[0], point[1] - at[1]};
    double corner  = t <= 0 ? piece->corner[0] : t >= 1 ? piece->corner[1] : 0;
    double side    = corner * dot2(tangent, away) - cross2(tangent, away);
    return (side < 0 ? -1 : 1) * real_hypot(away[0], away[1]) - piece->lean;
}
