/* extent.c: finds where a solid ends, by branch and bound. */
#include "slice/extent.h"

#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

enum { MAX_BOXES = 1500, MAX_OPEN = 256, SAMPLES = 12 };

/* A search along an axis, downwards or upwards: heights are coordinates times the sign. */
typedef struct Extent {
    const MeshField *field;
    int              axis;
    double           sign, best; /* the least height of a point that is known to be solid */
    double           at[3];      /* that point */
    double           gap;        /* what is above best - gap does not matter */
    size_t           visited;
} Extent;

static double bottom_of(const Extent *e, const Box *box)
{
    return e->sign > 0 ? box->axis[e->axis].low : -box->axis[e->axis].high;
}

static void set_top(const Extent *e, Box *box, double height)
{
    if (e->sign > 0)
        box->axis[e->axis].high = min2(box->axis[e->axis].high, height);
    else
        box->axis[e->axis].low = max2(box->axis[e->axis].low, -height);
}

/* Goes down from a solid point to where the solid ends, or to a height: by division into parts,
   since steps by the distance would be many. */
static void descend(Extent *e, const double from[3], double bottom)
{
    enum { ROUNDS = 10, PARTS = MAX_FIELD_POINTS }; /* to a part of 2^-50 */
    double points[PARTS][3], distances[PARTS], inside = e->sign * from[e->axis], outside = bottom;
    for (int round = 0; round < ROUNDS && outside < inside; round++) {
        double side = (inside - outside) / PARTS, below = outside;
        int    lowest = 0;
        for (int i = 0; i < PARTS; i++) {
            memcpy(points[i], from, sizeof points[i]);
            points[i][e->axis] = e->sign * (below + i * side);
        }
        field_distances(e->field, (const double(*)[3])points, PARTS, distances);
        while (lowest < PARTS && distances[lowest] > 0)
            lowest++;
        if (lowest < PARTS)
            inside = below + lowest * side;
        outside = lowest > 0 ? below + (lowest - 1) * side : inside;
    }
    if (inside >= e->best)
        return;
    memcpy(e->at, from, sizeof e->at);
    e->at[e->axis] = e->sign * inside;
    e->best        = inside;
}

/* Tests the middle of a box; returns false if nothing is solid in the box, since distances change
   no faster than points move. */
static bool probe_box(Extent *e, const Box *box)
{
    double point[3], half[3];
    for (int k = 0; k < 3; k++) {
        point[k] = 0.5 * (box->axis[k].low + box->axis[k].high);
        half[k]  = 0.5 * (box->axis[k].high - box->axis[k].low);
    }
    double distance = field_distance(e->field, point);
    if (distance > 0)
        return distance <= 1.0001 * length3(half);
    descend(e, point, bottom_of(e, box));
    return true;
}

/* Goes from the lowest known point sideways, and down from there, by steps that become shorter.
   What is lower by less than a small part of the height does not count. */
static void slide_down(Extent *e, const Box *box)
{
    enum { STEPS = 40, MAX_SLIDES = 400, DIRECTIONS = 8 };
    static const double LEAST  = 1e-8;
    const double        bottom = bottom_of(e, box);
    const double height = -bottom_of(&(Extent){.axis = e->axis, .sign = -e->sign}, box) - bottom;
    double       step   = 0.1 * height;
    for (int i = 0, slides = 0; i < STEPS && slides < MAX_SLIDES; slides++) {
        double points[DIRECTIONS][3], distances[DIRECTIONS], before = e->best;
        for (int k = 0; k < DIRECTIONS; k++) {
            memcpy(points[k], e->at, sizeof points[k]);
            points[k][e->axis] -= e->sign * LEAST * height;
            points[k][(e->axis + 1) % 3] += step * real_cos(2 * M_PI / DIRECTIONS * k);
            points[k][(e->axis + 2) % 3] += step * real_sin(2 * M_PI / DIRECTIONS * k);
        }
        field_distances(e->field, (const double(*)[3])points, DIRECTIONS, distances);
        for (int k = 0; k < DIRECTIONS && e->best == before; k++)
            if (distances[k] <= 0)
                descend(e, points[k], bottom);
        if (e->best == before) {
            step *= 0.5;
            i++;
        }
    }
}

static void halve(const Box *box, Box halves[2])
{
    int    longest = box_longest_axis(box);
    double middle  = 0.5 * (box->axis[longest].low + box->axis[longest].high);
    halves[0] = halves[1]        = *box;
    halves[0].axis[longest].high = halves[1].axis[longest].low = middle;
}

/* Tells whether it is proven that nothing is solid below best - gap; may lower `best`. */
static bool prove(Extent *e, Box all)
{
    Box    open[MAX_OPEN];
    size_t count  = 0;
    open[count++] = all;
    while (count > 0) {
        Box box = open[--count];
        set_top(e, &box, e->best - e->gap);
        if (!(box.axis[e->axis].low < box.axis[e->axis].high) ||
            field_range(e->field, box).low > 0 || !probe_box(e, &box))
            continue;
        if (++e->visited > MAX_BOXES || count + 2 > MAX_OPEN)
            return false;
        set_top(e, &box, e->best - e->gap);
        if (!(box.axis[e->axis].low < box.axis[e->axis].high))
            continue;
        halve(&box, &open[count]);
        bool lower_first = bottom_of(e, &open[count]) < bottom_of(e, &open[count + 1]);
        if (lower_first) {
            Box other       = open[count];
            open[count]     = open[count + 1];
            open[count + 1] = other;
        }
        count += 2;
    }
    return true;
}

static void sample(Extent *e, const Box *box)
{
    double points[SAMPLES][3], distances[SAMPLES];
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        for (int k = 0; k < SAMPLES; k++) {
            const double parts[3] = {i / SAMPLES + 0.5, i % SAMPLES + 0.5, k + 0.5};
            for (int a = 0; a < 3; a++)
                points[k][a] = box->axis[a].low +
                               (box->axis[a].high - box->axis[a].low) * parts[a] / SAMPLES;
        }
        field_distances(e->field, (const double(*)[3])points, SAMPLES, distances);
        for (int k = 0; k < SAMPLES; k++)
            if (distances[k] <= 0)
                descend(e, points[k], e->sign * points[k][e->axis]);
    }
}

/* Returns the least height that is known to be solid, if nothing is lower by a 500th of the box;
   else one that nothing is below. */
static double find_bottom(const MeshField *field, const Box *box, int axis, double sign)
{
    static const double gaps[] = {0.05, 0.002};
    Extent              e      = {.field = field, .axis = axis, .sign = sign, .best = INFINITY};
    double bottom = bottom_of(&e, box), height = box->axis[axis].high - box->axis[axis].low;
    sample(&e, box);
    for (size_t i = 0; i < sizeof gaps / sizeof *gaps && e.best < INFINITY; i++) {
        e.gap     = gaps[i] * height;
        e.visited = 0;
        slide_down(&e, box);
        if (!prove(&e, *box))
            return bottom;
        bottom = max2(bottom, e.best - e.gap);
    }
    return e.best < INFINITY ? e.best : bottom;
}

/* Tells whether few boxes prove that nothing is solid in a box. */
static bool is_empty(const MeshField *field, const double low[3], const double high[3])
{
    Extent e = {.field = field, .sign = 1, .best = INFINITY};
    Box    box;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){low[k], high[k]};
    sample(&e, &box);
    return e.best == INFINITY && prove(&e, box) && e.best == INFINITY;
}

bool narrow_box(const MeshField *field, double low[3], double high[3])
{
    if (is_empty(field, low, high))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        Box box;
        for (int k = 0; k < 3; k++)
            box.axis[k] = (Range){low[k], high[k]};
        if (!(low[axis] < high[axis]))
            continue;
        double least = find_bottom(field, &box, axis, 1),
               most  = -find_bottom(field, &box, axis, -1);
        if (least < most) {
            low[axis]  = max2(low[axis], least);
            high[axis] = min2(high[axis], most);
        }
    }
    return true;
}
