/*
 * volume.c: finds volume and center by cells.
 *
 * In a cell let the derivatives be in the ranges g +- r, and f be the value in its middle c. Then
 * the value at p is f + g . (p - c) up to R = sum r_k h_k, where h are the half sides.  So the
 * solid in the cell contains the part where f + g . (p - c) < -R, and is in the part where it is
 * below R; both are boxes cut by planes.  The same is true of each piece where the distance is a
 * minimum or a maximum of some, as at edges.  Cells are halved until the difference is small.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "measure/cut.h"
#include "measure/measure.h"

enum {
    ROOT_SIDE = 8,
    ROOTS     = ROOT_SIDE * ROOT_SIDE * ROOT_SIDE,
    MAX_CELLS = 200000, /* about as many are measured in the last round */
    DEEPEST   = 24,
    MAX_ROUND = 12
};
static const double WANTED   = 1e-4;  /* error of the volume, relative */
static const double NEAR     = 1e-6;  /* of the sides of a cell: of a box around its middle */
static const double ROUNDING = 1e-12; /* of the volume of the box */

/* ---- cells ---- */

typedef struct Sum {
    double volume, error;
    double moment[3], moment_error; /* about the middle of the box */
    size_t cells;
} Sum;

typedef struct Round {
    Measurer *m;
    double    middle[3], volume; /* of the box */
    double    enough;            /* error of a cell */
    Sum       sums[ROOTS];
} Round;

/* Adds a part of a cell; its moment is about the middle of the cell. */
static void add_part(Round *round, Sum *sum, const double middle[3], const double half[3],
                     double volume, double error, const double moment[3])
{
    double offset[3];
    add_scaled3(offset, middle, -1, round->middle);
    sum->volume += volume;
    sum->error += error;
    for (int k = 0; k < 3; k++)
        sum->moment[k] += volume * offset[k] + moment[k];
    sum->moment_error += error * (length3(offset) + length3(half));
}

/* The half-spaces of the pieces of a cell, and how far values may be from their linear ones. */
typedef struct Model {
    HalfSpaces spaces;
    double     room[MAX_PIECES];
    bool       by_pieces;
} Model;

static void set_space(Model *model, size_t piece, double at, double sign, const LaneSlope *slope,
                      const double half[3])
{
    HalfSpace *space   = &model->spaces.items[piece];
    space->at          = at;
    model->room[piece] = 0;
    for (int k = 0; k < 3; k++) {
        Range by        = slope->by[k];
        space->slope[k] = 0.5 * sign * (by.low + by.high);
        model->room[piece] += 0.5 * (by.high - by.low) * half[k];
    }
}

/* Narrows the room of a single piece by Taylor's theorem: with the slope in the middle, values
   differ from the linear ones by half of p . H p only. */
static void narrow_space(MeshField *field, const double middle[3], const double half[3],
                         const FieldPieces *pieces, Model *model)
{
    const LaneHessian *hessian = &pieces->hessians[0];
    LaneSlope          slope;
    Model              narrow = *model;
    Box                near_middle;
    for (int k = 0; k < 3; k++)
        near_middle.axis[k] = (Range){middle[k] - NEAR * half[k], middle[k] + NEAR * half[k]};
    if (!hessian->known || !field_piece_slope(field, pieces, near_middle, &slope))
        return;
    set_space(&narrow, 0, model->spaces.items[0].at, pieces->signs[0], &slope, half);
    for (int k = 0; k < 3; k++)
        narrow.room[0] += 0.5 * range_largest(hessian->by[k]) * half[k] * half[k] +
                          range_largest(hessian->by[3 + k]) * half[(k + 1) % 3] * half[(k + 2) % 3];
    if (narrow.room[0] < model->room[0])
        *model = narrow;
}

/* Makes a model of a cell by its pieces, or else by the distance itself; returns false if nothing
   is known. */
static bool find_model(MeshField *field, const Box *box, const double middle[3],
                       const double half[3], double at, Model *model)
{
    enum { FEW = 5 };
    FieldPieces pieces;
    Range       range;
    LaneSlope   slope;
    double      values[MAX_PIECES];
    model->by_pieces = field_pieces(field, *box, &pieces) && pieces.count <= FEW;
    if (model->by_pieces) {
        model->spaces.count      = pieces.count;
        model->spaces.step_count = pieces.step_count;
        memcpy(model->spaces.steps, pieces.steps, sizeof pieces.steps);
        field_piece_values(field, &pieces, (const double(*)[3])middle, 1, values);
        for (size_t i = 0; i < pieces.count; i++)
            set_space(model, i, values[i], pieces.signs[i], &pieces.slopes[i], half);
        if (pieces.count == 1 && model->room[0] > 0)
            narrow_space(field, middle, half, &pieces, model);
    } else {
        model->spaces = (HalfSpaces){.count = 1, .step_count = 1};
        if (!field_slope(field, *box, &range, &slope))
            return false;
        set_space(model, 0, at, 1, &slope, half);
    }
    double all = 0;
    for (size_t i = 0; i < model->spaces.count; i++)
        all += model->room[i] + length3(model->spaces.items[i].slope) +
               fabs(model->spaces.items[i].at);
    return isfinite(all);
}

/* Finds the volume if all values are greater than those of the model by a part of their room. */
static bool cut_model(const double half[3], const Model *model, double part, double *volume,
                      double moment[3])
{
    HalfSpaces moved = model->spaces;
    for (size_t i = 0; i < moved.count; i++)
        moved.items[i].at += part * model->room[i];
    return cut_box(half, &moved, volume, moment);
}

/* The part of a cell that is solid, and its bounds. */
typedef struct Solid {
    double volume, least, most, moment[3];
    bool   by_pieces;
} Solid;

static Solid measure_cell(MeshField *field, const Box *box, const double middle[3],
                          const double half[3], double at)
{
    Model  model;
    Solid  solid;
    double ignored[3], all = 8 * half[0] * half[1] * half[2];
    if (find_model(field, box, middle, half, at, &model) &&
        cut_model(half, &model, 0, &solid.volume, solid.moment) &&
        cut_model(half, &model, 1, &solid.least, ignored) &&
        cut_model(half, &model, -1, &solid.most, ignored)) {
        solid.by_pieces = model.by_pieces;
        return solid;
    }
    return (Solid){.volume = 0.5 * all, .most = all};
}

/* Takes the volume below the tangent plane in the middle, where no pieces are known. */
static void take_tangent(const MeshField *field, const double middle[3], const double half[3],
                         double at, Solid *solid)
{
    HalfSpaces plane = {.count = 1, .step_count = 1, .items = {{.at = at}}};
    double     volume, moment[3];
    if (!field_normal(field, middle, NEAR * length3(half), plane.items[0].slope) ||
        !cut_box(half, &plane, &volume, moment))
        return;
    solid->volume = min2(max2(volume, solid->least), solid->most);
    memcpy(solid->moment, moment, sizeof moment);
}

static double error_of(const Solid *solid)
{
    return max2(solid->most - solid->volume, solid->volume - solid->least);
}

static void halve_cell(Round *round, MeshField *field, Sum *sum, const Box *box, int depth);

static void divide_cell(Round *round, MeshField *field, Sum *sum, const Box *box,
                        const double middle[3], int depth)
{
    bool entered = field->region_count < MAX_REGIONS - 1 && field_enter(field, *box);
    for (int i = 0; i < 8; i++) {
        Box part = *box;
        for (int k = 0; k < 3; k++) {
            if (i >> k & 1)
                part.axis[k].low = middle[k];
            else
                part.axis[k].high = middle[k];
        }
        halve_cell(round, field, sum, &part, depth + 1);
    }
    if (entered)
        field_leave(field);
}

static void halve_cell(Round *round, MeshField *field, Sum *sum, const Box *box, int depth)
{
    static const double none[3] = {0};
    double              middle[3], half[3];
    Range               range = field_range(field, *box);
    sum->cells++;
    if (range.low > 0)
        return;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (box->axis[k].low + box->axis[k].high);
        half[k]   = 0.5 * (box->axis[k].high - box->axis[k].low);
    }
    double volume = 8 * half[0] * half[1] * half[2], at = field_distance(field, middle);
    if (at >= length3(half))
        return;
    if (range.high < 0 || -at >= length3(half)) {
        add_part(round, sum, middle, half, volume, 0, none);
        return;
    }
    Solid solid = measure_cell(field, box, middle, half, at);
    if (error_of(&solid) > round->enough && depth < DEEPEST &&
        !atomic_load_explicit(&round->m->stopped, memory_order_relaxed)) {
        divide_cell(round, field, sum, box, middle, depth);
        return;
    }
    if (!solid.by_pieces)
        take_tangent(field, middle, half, at, &solid);
    add_part(round, sum, middle, half, solid.volume, error_of(&solid), solid.moment);
}

static Range root_side(const Measurer *m, int axis, int index)
{
    double side = (m->high[axis] - m->low[axis]) / ROOT_SIDE;
    return (Range){m->low[axis] + index * side,
                   index == ROOT_SIDE - 1 ? m->high[axis] : m->low[axis] + (index + 1) * side};
}

static void take_roots(void *task, size_t part, size_t parts)
{
    Round    *round = task;
    Measurer *m     = round->m;
    size_t    i;
    (void)parts;
    while (part < m->parts && (i = atomic_fetch_add(&m->next, 1)) < ROOTS) {
        int index[3] = {(int)i % ROOT_SIDE, (int)i / ROOT_SIDE % ROOT_SIDE,
                        (int)i / ROOT_SIDE / ROOT_SIDE};
        Box box;
        for (int k = 0; k < 3; k++)
            box.axis[k] = root_side(m, k, index[k]);
        field_focus(&m->fields[part], box);
        halve_cell(round, &m->fields[part], &round->sums[i], &box, 0);
        field_leave(&m->fields[part]);
        measurer_progress(m, part, (double)i / ROOTS);
    }
}

/* Adds up all roots in their order, so that sums do not depend on threads. */
static Sum sum_round(const Round *round)
{
    Sum sum = {.error = ROUNDING * round->volume};
    for (size_t i = 0; i < ROOTS; i++) {
        sum.volume += round->sums[i].volume;
        sum.error += round->sums[i].error;
        sum.moment_error += round->sums[i].moment_error;
        sum.cells += round->sums[i].cells;
        add_scaled3(sum.moment, sum.moment, 1, round->sums[i].moment);
    }
    return sum;
}

static void note_volume(Measurer *m, const Round *round, const Sum *sum)
{
    KrsMeasures *measures  = m->measures;
    measures->volume       = sum->volume;
    measures->volume_error = sum->error;
    for (int k = 0; k < 3; k++)
        measures->center[k] = round->middle[k] +
                              (sum->volume > 0 ? sum->moment[k] / sum->volume : 0);
    /* |M / V - M' / V'| <= (|M - M'| + |M / V| |V - V'|) / V' */
    double offset          = sum->volume > 0 ? length3(sum->moment) / sum->volume : 0;
    double least           = sum->volume - sum->error;
    double rounding        = ROUNDING * max2(m->longest, largest3(round->middle));
    measures->center_error = least > 0
                                 ? (sum->moment_error + offset * sum->error) / least + rounding
                                 : 0.5 * m->longest * sqrt(3);
}

/* Measures the volume.  Errors of cells are about the fourth power of their sides, and their sum
   about the square: so the sum is about the root of the error of a cell, and the number of cells
   its inverse. */
void measure_volume(Measurer *m)
{
    Round *round = arena_new(&m->arena, Round);
    double begun = m->begun, goal = m->goal;
    round->m      = m;
    round->volume = 1;
    for (int k = 0; k < 3; k++) {
        round->volume *= m->high[k] - m->low[k];
        round->middle[k] = 0.5 * (m->low[k] + m->high[k]);
    }
    round->enough = 1e-5 * round->volume;
    for (int i = 0; i < MAX_ROUND && !atomic_load(&m->stopped); i++) {
        memset(round->sums, 0, sizeof round->sums);
        atomic_store(&m->next, 0);
        m->goal = m->begun + 0.5 * (goal - m->begun);
        run_in_parallel(take_roots, round);
        m->begun      = m->goal;
        Sum    sum    = sum_round(round);
        double before = i > 0 ? m->measures->volume : INFINITY;
        note_volume(m, round, &sum);
        m->measures->volume_change = min2(fabs(sum.volume - before), sum.error);
        double ratio               = WANTED * sum.volume / sum.error;
        if (!(ratio < 1) || sum.cells > MAX_CELLS / 2)
            break;
        round->enough *= fmax(fmax(1.0 / 64, fmin(0.25, 0.7 * ratio * ratio)),
                              real_pow((double)sum.cells / MAX_CELLS, 1.5));
    }
    m->begun = begun;
    m->goal  = goal;
}
