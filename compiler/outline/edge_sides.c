/*
 * edge_sides.c: on which sides of edges the inside is, by winding numbers.
 *
 * From the middle of each edge a ray goes in the direction, x or y, that the edge is steeper to.  What
 * contours go around there is counted by the edges that it crosses.  Rays look for these in strips.
 */
#include <math.h>
#include <string.h>

#include "compiler/outline/edges.h"

/* Edges by the strips of the plane that they reach into; rays of the strips go along `axis`. */
typedef struct Strips {
    const Making *making;
    int           axis;
    double        low, width;
    uint32_t      count;
    uint32_t     *first, *edges; /* of each strip, where its edges begin; one more */
} Strips;

static uint32_t strip_of(const Strips *strips, double coordinate)
{
    double strip = (coordinate - strips->low) / strips->width;
    return strip <= 0 ? 0 : strip < strips->count ? (uint32_t)strip : strips->count - 1;
}

/* Counts the edges of each strip in first[], or fills them in and moves first[] on. */
static void visit_strips(Strips *strips)
{
    const Edges *edges = &strips->making->edges;
    int          k     = 1 - strips->axis;
    for (size_t i = 0; i < edges->count; i++) {
        const Curve *curve = &edges->items[i].curve;
        uint32_t     strip = strip_of(strips, fmin(curve->from[k], curve->to[k]));
        uint32_t     last  = strip_of(strips, fmax(curve->from[k], curve->to[k]));
        for (; strip <= last; strip++)
            if (strips->edges)
                strips->edges[strips->first[strip]++] = (uint32_t)i;
            else
                strips->first[strip]++;
    }
}

/* Makes as many strips as give edges about four entries each. */
static void size_strips(Strips *strips)
{
    const Edges *edges = &strips->making->edges;
    int          k     = 1 - strips->axis;
    double       low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
    for (size_t i = 0; i < edges->count; i++) {
        const Curve *curve = &edges->items[i].curve;
        low                = fmin(low, fmin(curve->from[k], curve->to[k]));
        high               = fmax(high, fmax(curve->from[k], curve->to[k]));
        sum += fabs(curve->to[k] - curve->from[k]);
    }
    double count  = 3 * (double)edges->count * (high - low) / fmax(sum, 1e-300);
    strips->low   = low;
    strips->count = (uint32_t)fmin(fmax(count, 1), (double)edges->count);
    strips->width = fmax((high - low) / strips->count, 1e-300);
}

static Strips strips_make(const Making *making, int axis)
{
    Strips strips = {.making = making, .axis = axis};
    size_strips(&strips);
    strips.first = arena_new_array(making->arena, uint32_t, strips.count + 1);
    visit_strips(&strips);
    uint32_t entries = 0;
    for (uint32_t i = 0; i <= strips.count; i++) {
        uint32_t length = i < strips.count ? strips.first[i] : 0;
        strips.first[i] = entries;
        entries += length;
    }
    strips.edges = arena_new_array(making->arena, uint32_t, entries + 1);
    visit_strips(&strips);
    for (uint32_t i = strips.count; i > 0; i--)
        strips.first[i] = strips.first[i - 1];
    strips.first[0] = 0;
    return strips;
}

double edge_crossing(const Curve *curve, int axis, double level)
{
    int    k   = 1 - axis;
    double low = 0, high = 1, point[2], t = 0.5;
    bool   rises = curve->to[k] > curve->from[k];
    if (curve->straight)
        t = (level - curve->from[k]) / (curve->to[k] - curve->from[k]);
    for (int i = 0; i < 50 && !curve->straight; i++) {
        t = 0.5 * (low + high);
        curve_point(curve, t, point);
        *((point[k] < level) == rises ? &low : &high) = t;
    }
    curve_point(curve, t, point);
    return point[axis];
}

/* Tells how many times what the ray from a point on edge `own` crosses goes around, without that edge. */
static int count_crossings(const Strips *strips, const double point[2], uint32_t own)
{
    int      axis = strips->axis, k = 1 - axis, winding = 0;
    uint32_t strip = strip_of(strips, point[k]);
    for (uint32_t i = strips->first[strip]; i < strips->first[strip + 1]; i++) {
        const Edge  *edge  = &strips->making->edges.items[strips->edges[i]];
        const Curve *curve = &edge->curve;
        bool         from = curve->from[k] > point[k], to = curve->to[k] > point[k];
        if (from == to || strips->edges[i] == own ||
            fmax(fmax(curve->from[axis], curve->to[axis]), curve->via[axis]) < point[axis])
            continue;
        if (fmin(fmin(curve->from[axis], curve->to[axis]), curve->via[axis]) < point[axis] &&
            edge_crossing(curve, axis, point[k]) < point[axis])
            continue;
        winding += to ? edge->weight : -edge->weight;
    }
    return axis == 0 ? winding : -winding;
}

static bool is_inside(int winding, FillRule rule)
{
    switch (rule) {
    case FILL_EVEN_ODD: return winding % 2 != 0;
    case FILL_NONZERO: return winding != 0;
    case FILL_POSITIVE: return winding > 0;
    case FILL_TWICE: return winding > 1;
    }
    return false;
}

/* Contours go around what is on the left of them. */
Sides *edge_sides(const Making *making, FillRule rule)
{
    size_t count = making->edges.count;
    Sides *sides = arena_new_array(making->arena, Sides, count + 1);
    if (count == 0)
        return sides;
    const Strips along[2] = {strips_make(making, 0), strips_make(making, 1)};
    for (uint32_t i = 0; i < count; i++) {
        const Edge *edge = &making->edges.items[i];
        double      middle[2], tangent[2];
        curve_point(&edge->curve, 0.5, middle);
        curve_tangent(&edge->curve, 0.5, tangent);
        int  axis    = fabs(tangent[0]) > fabs(tangent[1]);
        int  beyond  = count_crossings(&along[axis], middle, i);
        bool forward = axis == 0 ? tangent[1] > 0 : tangent[0] < 0; /* the ray goes to its right */
        int  here    = beyond + (forward ? edge->weight : -edge->weight);
        sides[i]     = forward ? (Sides){is_inside(here, rule), is_inside(beyond, rule)}
                               : (Sides){is_inside(beyond, rule), is_inside(here, rule)};
    }
    return sides;
}
