/*
 * edge_cuts.c: where edges meet.
 *
 * Pairs of edges whose boxes overlap are found by a sweep.  Of each pair, ends that lie on the other
 * edge cut that; then crossings are looked for by halving both, until they are all but lines.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/outline/edges.h"

enum {
    MAX_LEAVES   = 4096, /* of the halving of a pair: more run along each other */
    MAX_HALVINGS = 45
};

typedef struct Cut {
    uint32_t edge, knot;
    double   t;
} Cut;

typedef struct Cutter {
    Making *making;
    double  tolerance;
    struct {
        Cut   *items;
        size_t count, capacity;
    } cuts;
    uint32_t leaves; /* of the pair at hand */
} Cutter;

static double distance_between(const double a[2], const double b[2])
{
    return real_hypot(a[0] - b[0], a[1] - b[1]);
}

static void add_cut(Cutter *cutter, uint32_t edge, double t, uint32_t knot)
{
    const Edge *e = &cutter->making->edges.items[edge];
    if (knot == e->from || knot == e->to)
        return;
    Cut cut = {edge, knot, t};
    array_push_large(cutter->making->arena, &cutter->cuts, cut);
}

/* ---- ends on the other edge ---- */

static void cut_at_end(Cutter *cutter, uint32_t edge, uint32_t knot)
{
    const Making *making = cutter->making;
    const Curve  *curve  = &making->edges.items[edge].curve;
    const double *at     = making->knots.items[knot].at;
    double        t      = curve_nearest(curve, at), point[2];
    curve_point(curve, t, point);
    if (distance_between(point, at) <= cutter->tolerance)
        add_cut(cutter, edge, t, knot);
}

static void cut_at_ends(Cutter *cutter, uint32_t a, uint32_t b)
{
    const Edge *edges = cutter->making->edges.items;
    const Edge  x = edges[a], y = edges[b];
    cut_at_end(cutter, a, y.from);
    cut_at_end(cutter, a, y.to);
    cut_at_end(cutter, b, x.from);
    cut_at_end(cutter, b, x.to);
}

/* ---- crossings ---- */

/* A part of an edge, whose box is that of its ends. */
typedef struct Span2 {
    uint32_t edge;
    double   t[2], ends[2][2];
} Span2;

static Span2 whole_edge(const Making *making, uint32_t edge)
{
    const Curve *curve = &making->edges.items[edge].curve;
    Span2        span  = {.edge = edge, .t = {0, 1}};
    memcpy(span.ends[0], curve->from, sizeof span.ends[0]);
    memcpy(span.ends[1], curve->to, sizeof span.ends[1]);
    return span;
}

static bool boxes_meet(const Span2 *a, const Span2 *b)
{
    for (int k = 0; k < 2; k++)
        if (fmax(a->ends[0][k], a->ends[1][k]) < fmin(b->ends[0][k], b->ends[1][k]) ||
            fmax(b->ends[0][k], b->ends[1][k]) < fmin(a->ends[0][k], a->ends[1][k]))
            return false;
    return true;
}

/* Refines a crossing by Newton's method; false: it does not end where both meet. */
static bool refine(const Curve *a, const Curve *b, double *t, double *u, double tolerance)
{
    double at[2], other[2], tangent[2], along[2], away[2];
    for (int i = 0; i < 12; i++) {
        curve_point(a, *t, at);
        curve_point(b, *u, other);
        curve_tangent(a, *t, tangent);
        curve_tangent(b, *u, along);
        for (int k = 0; k < 2; k++)
            away[k] = 0.5 * (other[k] - at[k]);
        double cross = cross2(tangent, along);
        if (cross == 0)
            break;
        *t += cross2(away, along) / cross;
        *u += cross2(away, tangent) / cross;
        *t = fmin(fmax(*t, 0), 1);
        *u = fmin(fmax(*u, 0), 1);
    }
    curve_point(a, *t, at);
    curve_point(b, *u, other);
    return distance_between(at, other) <= 0.5 * tolerance;
}

/* Cuts both curves where the chords cross. */
static void cut_at_crossing(Cutter *cutter, const Span2 *a, const Span2 *b)
{
    Making      *making = cutter->making;
    const Curve *x = &making->edges.items[a->edge].curve, *y = &making->edges.items[b->edge].curve;
    double       t = 0.5 * (a->t[0] + a->t[1]), u = 0.5 * (b->t[0] + b->t[1]), point[2];
    if (!refine(x, y, &t, &u, cutter->tolerance))
        return;
    curve_point(x, t, point);
    uint32_t knot = knot_at(&making->knots, point);
    add_cut(cutter, a->edge, t, knot);
    add_cut(cutter, b->edge, u, knot);
}

static double longest_side(const Span2 *span)
{
    return fmax(fabs(span->ends[0][0] - span->ends[1][0]),
                fabs(span->ends[0][1] - span->ends[1][1]));
}

/* Tells how far a part leaves its chord, at most. */
static double bulge(const Cutter *cutter, const Span2 *span)
{
    const Curve *curve = &cutter->making->edges.items[span->edge].curve;
    if (curve->radius > 0) {
        double half = fmin(0.5 * distance_between(span->ends[0], span->ends[1]), curve->radius);
        return half * half / (curve->radius + sqrt(curve->radius * curve->radius - half * half));
    }
    double bend = real_hypot(curve->from[0] - 2 * curve->via[0] + curve->to[0],
                             curve->from[1] - 2 * curve->via[1] + curve->to[1]);
    double part = span->t[1] - span->t[0];
    return curve->straight ? 0 : 0.25 * bend * part * part;
}

static void halve(const Cutter *cutter, const Span2 *span, Span2 halves[2])
{
    const Curve *curve  = &cutter->making->edges.items[span->edge].curve;
    double       middle = 0.5 * (span->t[0] + span->t[1]);
    halves[0] = halves[1] = *span;
    halves[0].t[1] = halves[1].t[0] = middle;
    curve_point(curve, middle, halves[0].ends[1]);
    memcpy(halves[1].ends[0], halves[0].ends[1], sizeof halves[1].ends[0]);
}

/* Tells whether both are so near to the lines through the other's chord that they may cross. */
static bool may_cross(const Span2 *a, const Span2 *b, double slack)
{
    const Span2 *pair[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        const Span2 *line = pair[i], *other = pair[1 - i];
        double       chord[2], side[2];
        for (int k = 0; k < 2; k++)
            chord[k] = line->ends[1][k] - line->ends[0][k];
        for (int end = 0; end < 2; end++) {
            double to[2] = {other->ends[end][0] - line->ends[0][0],
                            other->ends[end][1] - line->ends[0][1]};
            side[end]    = cross2(chord, to) / fmax(real_hypot(chord[0], chord[1]), 1e-300);
        }
        if (fmin(side[0], side[1]) > slack || fmax(side[0], side[1]) < -slack)
            return false;
    }
    return true;
}

static void find_crossings(Cutter *cutter, const Span2 *a, const Span2 *b, int depth)
{
    double bulge_a = bulge(cutter, a), bulge_b = bulge(cutter, b), least = 0.1 * cutter->tolerance;
    if (cutter->leaves > MAX_LEAVES || !boxes_meet(a, b) ||
        !may_cross(a, b, cutter->tolerance + bulge_a + bulge_b))
        return;
    if ((bulge_a <= least && bulge_b <= least) || depth == MAX_HALVINGS) {
        cutter->leaves++;
        cut_at_crossing(cutter, a, b);
        return;
    }
    Span2 halves[2];
    bool  first = bulge_b <= least || (bulge_a > least && longest_side(a) >= longest_side(b));
    halve(cutter, first ? a : b, halves);
    for (int i = 0; i < 2; i++)
        find_crossings(cutter, first ? &halves[i] : a, first ? b : &halves[i], depth + 1);
}

/* ---- pairs ---- */

/* Tells whether curves are equal, in either direction: they will be merged. */
static bool is_double(const Edge *a, const Edge *b, double tolerance)
{
    bool same = (a->from == b->from && a->to == b->to) || (a->from == b->to && a->to == b->from);
    return same && distance_between(a->curve.via, b->curve.via) <= 4 * tolerance;
}

/* Arcs of one circle share more than points, or only ends. */
static bool is_one_circle(const Curve *a, const Curve *b, double tolerance)
{
    return a->radius > 0 && b->radius > 0 && fabs(a->radius - b->radius) <= tolerance &&
           distance_between(a->centre, b->centre) <= tolerance;
}

static bool cut_pair(Cutter *cutter, uint32_t a, uint32_t b)
{
    Making *making = cutter->making;
    if (is_double(&making->edges.items[a], &making->edges.items[b], cutter->tolerance))
        return true;
    Span2 x = whole_edge(making, a), y = whole_edge(making, b);
    cut_at_ends(cutter, a, b);
    if (is_one_circle(&making->edges.items[a].curve, &making->edges.items[b].curve,
                      cutter->tolerance))
        return true;
    cutter->leaves = 0;
    find_crossings(cutter, &x, &y, 0);
    if (cutter->leaves <= MAX_LEAVES)
        return true;
    memcpy(making->fault_at, x.ends[0], sizeof making->fault_at);
    return false;
}

/* The box of an edge, for the sweep. */
typedef struct EdgeBox {
    double   low[2], high[2];
    uint32_t edge;
} EdgeBox;

static int compare_boxes(const void *a, const void *b)
{
    const EdgeBox *x = a, *y = b;
    if (x->low[0] != y->low[0])
        return x->low[0] < y->low[0] ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

/* Sorts boxes along the axis, which counts as the first one, along which the edges reach farther. */
static EdgeBox *sorted_boxes(const Making *making, double margin)
{
    size_t   count  = making->edges.count;
    EdgeBox *boxes  = arena_new_array(making->arena, EdgeBox, count + 1);
    double   low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < count; i++) {
        const Curve *curve = &making->edges.items[i].curve;
        boxes[i].edge      = (uint32_t)i;
        for (int k = 0; k < 2; k++) {
            boxes[i].low[k]  = fmin(curve->from[k], curve->to[k]) - margin;
            boxes[i].high[k] = fmax(curve->from[k], curve->to[k]) + margin;
            low[k]           = fmin(low[k], boxes[i].low[k]);
            high[k]          = fmax(high[k], boxes[i].high[k]);
        }
    }
    for (size_t i = 0; i < count && high[1] - low[1] > high[0] - low[0]; i++) {
        EdgeBox box = boxes[i];
        boxes[i]    = (EdgeBox){{box.low[1], box.low[0]}, {box.high[1], box.high[0]}, box.edge};
    }
    qsort(boxes, count, sizeof *boxes, compare_boxes);
    return boxes;
}

static OutlineFault find_cuts(Cutter *cutter)
{
    Making        *making = cutter->making;
    const size_t   count  = making->edges.count;
    const EdgeBox *boxes  = sorted_boxes(making, cutter->tolerance);
    for (size_t i = 0; i < count; i++)
        for (size_t k = i + 1; k < count && boxes[k].low[0] <= boxes[i].high[0]; k++) {
            if (boxes[k].low[1] > boxes[i].high[1] || boxes[i].low[1] > boxes[k].high[1])
                continue;
            if (!cut_pair(cutter, boxes[i].edge, boxes[k].edge))
                return OUTLINE_UNRESOLVED;
            if (cutter->cuts.count > MAX_EDGES)
                return OUTLINE_TOO_MANY;
        }
    return OUTLINE_GOOD;
}

/* ---- cutting ---- */

static int compare_cuts(const void *a, const void *b)
{
    const Cut *x = a, *y = b;
    if (x->edge != y->edge)
        return (x->edge > y->edge) - (x->edge < y->edge);
    if (x->t != y->t)
        return x->t < y->t ? -1 : 1;
    return (x->knot > y->knot) - (x->knot < y->knot);
}

/* Adds the part of an edge from t to u, between two knots. */
static void add_part(Making *making, const Edge *edge, double t, double u, uint32_t from,
                     uint32_t to)
{
    if (from == to)
        return;
    Curve part = curve_part(&edge->curve, t, u);
    memcpy(part.from, making->knots.items[from].at, sizeof part.from);
    memcpy(part.to, making->knots.items[to].at, sizeof part.to);
    if (part.straight || u <= t)
        part = line_between(part.from, part.to);
    array_push_large(making->arena, &making->edges, ((Edge){part, from, to, edge->weight}));
}

static void cut_edge(Making *making, const Edge *edge, const Cut *cuts, size_t count)
{
    double   t    = 0;
    uint32_t from = edge->from;
    for (size_t i = 0; i < count; i++) {
        add_part(making, edge, t, cuts[i].t, from, cuts[i].knot);
        t    = cuts[i].t;
        from = cuts[i].knot;
    }
    add_part(making, edge, t, 1, from, edge->to);
}

OutlineFault cut_edges(Making *making)
{
    Cutter       cutter = {.making = making, .tolerance = making->knots.tolerance};
    OutlineFault fault  = find_cuts(&cutter);
    if (fault != OUTLINE_GOOD)
        return fault;
    const Cut *cuts = cutter.cuts.items;
    Edges      old  = making->edges;
    size_t     next = 0;
    if (cutter.cuts.count)
        qsort(cutter.cuts.items, cutter.cuts.count, sizeof *cuts, compare_cuts);
    making->edges = (Edges){0};
    for (size_t i = 0; i < old.count; i++) {
        size_t first = next;
        while (next < cutter.cuts.count && cuts[next].edge == i)
            next++;
        cut_edge(making, &old.items[i], cuts ? cuts + first : cuts, next - first);
    }
    return making->edges.count > MAX_EDGES ? OUTLINE_TOO_MANY : OUTLINE_GOOD;
}
