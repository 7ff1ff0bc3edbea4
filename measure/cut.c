/* cut.c: divides a box into six tetrahedra, and cuts each by the planes one after the other. */
#include "measure/cut.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"

enum { MAX_TETRAHEDRA = 160 };

typedef struct Tetrahedron {
    double corners[4][3];
} Tetrahedron;

typedef struct Parts {
    Tetrahedron items[MAX_TETRAHEDRA];
    size_t      count;
} Parts;

typedef struct Cutter {
    const HalfSpaces *spaces;
    int  begin[MAX_PIECE_STEPS]; /* step at which the expression that ends here begins */
    bool full;
} Cutter;

static double volume_of(const Tetrahedron *t)
{
    double edges[3][3], normal[3];
    for (int i = 0; i < 3; i++)
        add_scaled3(edges[i], t->corners[i + 1], -1, t->corners[0]);
    cross3(edges[0], edges[1], normal);
    return fabs(dot3(normal, edges[2])) / 6;
}

static void add_tetrahedron(Cutter *cutter, Parts *parts, const double a[3], const double b[3],
                            const double c[3], const double d[3])
{
    const double *const corners[4] = {a, b, c, d};
    if (!parts)
        return;
    if (parts->count == MAX_TETRAHEDRA) {
        cutter->full = true;
        return;
    }
    for (int i = 0; i < 4; i++)
        memcpy(parts->items[parts->count].corners[i], corners[i], sizeof(double[3]));
    parts->count++;
}

/* Finds the point between two corners where the value is 0. */
static void cross_edge(const double a[3], const double b[3], double at_a, double at_b,
                       double point[3])
{
    double t = at_a / (at_a - at_b);
    for (int k = 0; k < 3; k++)
        point[k] = a[k] + t * (b[k] - a[k]);
}

/* Adds the wedge of six corners: a triangle and the one that it was moved to. */
static void add_wedge(Cutter *cutter, Parts *parts, const double first[3][3],
                      const double second[3][3])
{
    add_tetrahedron(cutter, parts, first[0], first[1], first[2], second[2]);
    add_tetrahedron(cutter, parts, first[0], first[1], second[1], second[2]);
    add_tetrahedron(cutter, parts, first[0], second[0], second[1], second[2]);
}

/* Cuts off one corner: a tetrahedron, which leaves a wedge. */
static void cut_corner(Cutter *cutter, const double *const corners[4], const double values[4],
                       Parts *alone, Parts *others)
{
    double cuts[3][3], rest[3][3];
    for (int i = 0; i < 3; i++) {
        cross_edge(corners[0], corners[i + 1], values[0], values[i + 1], cuts[i]);
        memcpy(rest[i], corners[i + 1], sizeof rest[i]);
    }
    add_tetrahedron(cutter, alone, corners[0], cuts[0], cuts[1], cuts[2]);
    add_wedge(cutter, others, (const double(*)[3])cuts, (const double(*)[3])rest);
}

/* Separates two corners from two others, by two wedges. */
static void cut_edge(Cutter *cutter, const double *const corners[4], const double values[4],
                     Parts *inside, Parts *outside)
{
    double first[2][3][3], second[2][3][3];
    for (int i = 0; i < 2; i++) {
        memcpy(first[i][0], corners[i], sizeof first[i][0]);
        memcpy(second[i][0], corners[2 + i], sizeof second[i][0]);
        for (int k = 0; k < 2; k++) {
            cross_edge(corners[i], corners[2 + k], values[i], values[2 + k], first[i][1 + k]);
            memcpy(second[k][1 + i], first[i][1 + k], sizeof second[k][1 + i]);
        }
    }
    add_wedge(cutter, inside, (const double(*)[3])first[0], (const double(*)[3])first[1]);
    add_wedge(cutter, outside, (const double(*)[3])second[0], (const double(*)[3])second[1]);
}

static void cut_by_plane(Cutter *cutter, const HalfSpace *space, const Tetrahedron *t,
                         Parts *inside, Parts *outside)
{
    const double *corners[4], *reversed[4];
    double        values[4], back[4];
    int           within = 0, beyond = 4;
    for (int i = 0; i < 4; i++) {
        double value  = space->at + dot3(space->slope, t->corners[i]);
        int    slot   = value < 0 ? within++ : --beyond;
        corners[slot] = t->corners[i];
        values[slot]  = value;
    }
    for (int i = 0; i < 4; i++) {
        reversed[i] = corners[3 - i];
        back[i]     = values[3 - i];
    }
    if (within == 1)
        cut_corner(cutter, corners, values, inside, outside);
    else if (within == 2)
        cut_edge(cutter, corners, values, inside, outside);
    else if (within == 3)
        cut_corner(cutter, reversed, back, outside, inside);
    else
        add_tetrahedron(cutter, within ? inside : outside, t->corners[0], t->corners[1],
                        t->corners[2], t->corners[3]);
}

/* Cuts by the expression that ends with a step.  The second operand of a union cuts what is outside
   of the first, that of an intersection what is inside. */
static void cut(Cutter *cutter, int step, const Tetrahedron *t, Parts *inside, Parts *outside)
{
    int what = cutter->spaces->steps[step];
    if (what >= 0) {
        cut_by_plane(cutter, &cutter->spaces->items[what], t, inside, outside);
        return;
    }
    Parts parts;
    int   second = step - 1, first = cutter->begin[second] - 1;
    parts.count = 0;
    if (what == PIECE_MIN)
        cut(cutter, first, t, inside, &parts);
    else
        cut(cutter, first, t, &parts, outside);
    for (size_t i = 0; i < parts.count; i++)
        cut(cutter, second, &parts.items[i], inside, outside);
}

static void find_beginnings(Cutter *cutter)
{
    for (int i = 0; i < (int)cutter->spaces->step_count; i++)
        cutter->begin[i] = cutter->spaces->steps[i] >= 0 ? i
                                                         : cutter->begin[cutter->begin[i - 1] - 1];
}

bool cut_box(const double half[3], const HalfSpaces *spaces, double *volume, double moment[3])
{
    /* Kuhn's tetrahedra: from corner 0 to 7 along the axes, in each order of these. */
    static const int orders[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
    Cutter           cutter       = {.spaces = spaces};
    Parts            inside;
    inside.count = 0;
    find_beginnings(&cutter);
    for (int i = 0; i < 6; i++) {
        const int   all[4] = {0, orders[i][0], orders[i][1], 7};
        Tetrahedron t;
        for (int c = 0; c < 4; c++)
            for (int k = 0; k < 3; k++)
                t.corners[c][k] = all[c] >> k & 1 ? half[k] : -half[k];
        cut(&cutter, (int)spaces->step_count - 1, &t, &inside, NULL);
    }
    *volume = 0;
    memset(moment, 0, 3 * sizeof *moment);
    for (size_t i = 0; i < inside.count; i++) {
        double part = volume_of(&inside.items[i]);
        *volume += part;
        for (int c = 0; c < 4; c++)
            add_scaled3(moment, moment, 0.25 * part, inside.items[i].corners[c]);
    }
    return !cutter.full;
}
