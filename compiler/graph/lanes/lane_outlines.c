/*
 * lane_outlines.c: curves of outlines that are near a box.
 *
 * The range of the distance over the box says how far the nearest curve is at most.  Curves that are farther from the
 * middle than that and the box's radius do not count.  Where one curve is left, and the nearest point is never an
 * end of it, the gradient is its normal.  Off a curve by d, the normal turns by the curvature k as k / (1 - k d).
 */
#include "compiler/graph/lanes/lane_outlines.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/graph/instance_walk.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/bounds/numbers.h"

/* Widens what rounding may have changed: a share of all lengths. */
static const double UNCERTAIN = 1e-9;

/* The points of a call in a box of space, and how far the outline is from them. */
typedef struct View {
    const LaneCall      *call;
    const InstanceTable *table;
    double               middle[2], radius;
    double               farthest; /* the nearest curve is not farther, anywhere */
} View;

/* Finds the view of an outline; false: it is none, or one does not know how far it is. */
static bool look(const LaneTape *tape, const LaneRanges *ranges, size_t step, View *view)
{
    const Graph *graph = tape->tape->graph;
    Range        value = ranges->ranges[LANE_INPUTS + step];
    view->call         = &tape->calls[tape->steps[step].operands[0]];
    if (!view->call->body || tape->tape->by_cells || !is_finite(value))
        return false;
    view->table    = &graph->instances->tables.items[view->call->body->table];
    view->radius   = 0;
    view->farthest = range_largest(value);
    double size    = view->farthest;
    for (int k = 0; k < 2; k++) {
        Range at        = lane_range_at(tape, ranges, view->call->operands[1][k]);
        view->middle[k] = 0.5 * (at.low + at.high);
        view->radius    = hypot_upward(view->radius, 0.5 * (at.high - at.low));
        size            = max2(size, range_largest(at));
    }
    view->radius += UNCERTAIN * size;
    view->farthest += UNCERTAIN * size;
    return view->table->arcs && isfinite(view->radius);
}

/* ---- which curves ---- */

static double distance_to_point(const double a[2], const double b[2])
{
    return real_hypot(a[0] - b[0], a[1] - b[1]);
}

static bool may_be_nearest(const View *view, uint32_t instance)
{
    return instance_arc_min_distance(&view->table->arcs[instance], view->middle) <=
           view->farthest + view->radius;
}

static bool find_instances(const View *view, uint32_t *instances, uint32_t *count)
{
    const uint32_t *known = view->call->instances;
    uint32_t        all   = known ? view->call->instance_count : view->table->rows;
    *count                = 0;
    for (uint32_t i = 0; i < all; i++) {
        uint32_t instance = known ? known[i] : i;
        if (!may_be_nearest(view, instance))
            continue;
        if (*count == MAX_LANE_INSTANCES)
            return false;
        instances[(*count)++] = instance;
    }
    return *count > 0;
}

bool lane_outline_instances(const LaneTape *tape, const LaneRanges *ranges, size_t step,
                            uint32_t instances[MAX_LANE_INSTANCES], uint32_t *count)
{
    View view;
    return look(tape, ranges, step, &view) && find_instances(&view, instances, count);
}

/* ---- lines ---- */

static void point_at(const InstanceArc *arc, double t, double point[2])
{
    for (int k = 0; k < 2; k++)
        point[k] = arc->start[k] + t * (2 * arc->tangent[k] + t * arc->bend[k]);
}

/* Finds the distance to the line of a straight curve, below 0 on its left. */
static bool find_line(const InstanceArc *arc, double line[3])
{
    double length = real_hypot(arc->tangent[0], arc->tangent[1]);
    line[0]       = arc->tangent[1] / length;
    line[1]       = -arc->tangent[0] / length;
    line[2]       = -(line[0] * arc->start[0] + line[1] * arc->start[1]);
    return arc->bend[0] == 0 && arc->bend[1] == 0 && length > 0;
}

/* The one that begins where the first ends comes second; false: they do not meet at one point. */
static bool put_in_order(const InstanceArc *arcs[2], double ends[2][2], double size)
{
    bool forth = distance_to_point(ends[0], arcs[1]->start) <= UNCERTAIN * size;
    bool back  = distance_to_point(ends[1], arcs[0]->start) <= UNCERTAIN * size;
    if (back) {
        const InstanceArc *first = arcs[1];
        arcs[1]                  = arcs[0];
        arcs[0]                  = first;
    }
    return forth != back;
}

/* Finds the curves of an outline that decide sides within `reach` of the middle: those that come so
   near; if their other ends are farther, they are as good as rays there.  The nearest curve to the
   middle is one of them, so sides are the same there, and so all over the box. */
bool lane_outline_lines(const LaneTape *tape, const LaneRanges *ranges, size_t step, double level,
                        OutlineLines *lines)
{
    View               view;
    const InstanceArc *arcs[2];
    double             ends[2][2];
    if (!look(tape, ranges, step, &view) || !view.call->instances)
        return false;
    double reach = view.radius + fabs(level) * (1 + UNCERTAIN);
    lines->count = 0;
    for (uint32_t i = 0; i < view.call->instance_count; i++) {
        const InstanceArc *arc = &view.table->arcs[view.call->instances[i]];
        if (instance_arc_min_distance(arc, view.middle) > reach)
            continue;
        if (lines->count == 2)
            return false;
        point_at(arc, 1, ends[lines->count]);
        arcs[lines->count++] = arc;
    }
    if (lines->count == 0 || (lines->count == 2 && !put_in_order(arcs, ends, view.radius)))
        return false;
    point_at(arcs[lines->count - 1], 1, ends[0]);
    lines->convex = lines->count == 1 || arcs[0]->tangent[0] * arcs[1]->tangent[1] -
                                                 arcs[0]->tangent[1] * arcs[1]->tangent[0] >=
                                             0;
    for (uint32_t i = 0; i < lines->count; i++)
        if (!find_line(arcs[i], lines->lines[i]))
            return false;
    return distance_to_point(view.middle, arcs[0]->start) > reach &&
           distance_to_point(view.middle, ends[0]) > reach &&
           (lines->count == 1 || (lines->convex ? level <= 0 : level >= 0));
}

/* ---- one curve ---- */

/* Finds the unit tangent where the curve is nearest to the middle; false: that is not found. */
static bool nearest_tangent(const View *view, const InstanceArc *arc, double tangent[2])
{
    enum { STEPS = 12 };
    double t = 0.5, at[2], change = 1;
    for (int i = 0; i < STEPS && fabs(change) > 1e-12; i++) {
        double value = 0, slope = 0;
        point_at(arc, t, at);
        for (int k = 0; k < 2; k++) {
            double half = arc->tangent[k] + t * arc->bend[k], from = at[k] - view->middle[k];
            value += from * half;
            slope += 2 * half * half + from * arc->bend[k];
        }
        change = slope > 0 ? min2(max2(t - value / slope, 0), 1) - t : INFINITY;
        t += change;
    }
    for (int k = 0; k < 2; k++)
        tangent[k] = arc->tangent[k] + t * arc->bend[k];
    double length = real_hypot(tangent[0], tangent[1]);
    tangent[0] /= length;
    tangent[1] /= length;
    return fabs(change) <= 1e-12 && length > 0;
}

/* Tells whether the nearest point is never an end. */
static bool is_within_ends(const View *view, const InstanceArc *arc)
{
    double end[2];
    point_at(arc, 1, end);
    return min2(distance_to_point(view->middle, arc->start), distance_to_point(view->middle, end)) -
               view->radius >
           view->farthest;
}

/* Returns the most that it is curved: at an end, since it turns only one way and is not cut at an
   apex. */
static double largest_curvature(const InstanceArc *arc)
{
    double cross = arc->tangent[0] * arc->bend[1] - arc->tangent[1] * arc->bend[0];
    double speed = min2(real_hypot(arc->tangent[0], arc->tangent[1]),
                        real_hypot(arc->tangent[0] + arc->bend[0], arc->tangent[1] + arc->bend[1]));
    return cross == 0 ? 0 : fabs(cross) / (2 * speed * speed * speed);
}

static Range about(double middle, double radius)
{
    return (Range){middle - radius, middle + radius};
}

OutlinePartials lane_outline_partials(const LaneTape *tape, const LaneRanges *ranges, size_t step)
{
    View            view;
    uint32_t        instances[MAX_LANE_INSTANCES], count;
    double          tangent[2];
    OutlinePartials p = {.known = false};
    if (!look(tape, ranges, step, &view) || !view.call->instances ||
        !find_instances(&view, instances, &count) || count != 1)
        return p;
    const InstanceArc *arc       = &view.table->arcs[instances[0]];
    double             curvature = largest_curvature(arc);
    if (!(2 * curvature * view.farthest < 1) || !is_within_ends(&view, arc) ||
        !nearest_tangent(&view, arc, tangent))
        return p;
    double bend  = curvature / (1 - curvature * view.farthest);
    double turn  = bend * view.radius + UNCERTAIN;
    Range  along = about(tangent[0], turn), up = about(tangent[1], turn);
    Range  bends   = (Range){-bend, bend};
    p.known        = true;
    p.first[0]     = up; /* the inside is on the left of the tangent */
    p.first[1]     = minus(along);
    p.second[0][0] = range_mul(bends, range_square(along));
    p.second[0][1] = range_mul(bends, range_mul(along, up));
    p.second[1][1] = range_mul(bends, range_square(up));
    return p;
}
