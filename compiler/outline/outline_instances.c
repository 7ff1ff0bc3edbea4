/*
 * outline_instances.c: cuts the pieces of an outline until each is fit for a row.
 */
#include "compiler/outline/outline_instances.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/outline/edges.h"

typedef struct Pieces {
    Piece *items;
    size_t count, capacity;
} Pieces;

/* ---- cutting ---- */

/* Finds of a curve, from its tangent at t on, half of the derivative there, and the second
   difference. */
static void tangent_and_bend(const Curve *curve, double tangent[2], double bend[2])
{
    for (int k = 0; k < 2; k++) {
        tangent[k] = curve->straight ? 0.5 * (curve->to[k] - curve->from[k])
                                     : curve->via[k] - curve->from[k];
        bend[k]    = curve->straight ? 0 : curve->from[k] - 2 * curve->via[k] + curve->to[k];
    }
}

/* Finds where a curve is to be cut: at the parabola's apex and where it has turned by 45 degrees
   from there to either side, as far as these are between its ends.  Ascending, with 0 and 1. */
static int find_cuts(const Curve *curve, double cuts[5])
{
    double tangent[2], bend[2];
    int    count = 1;
    cuts[0]      = 0;
    tangent_and_bend(curve, tangent, bend);
    double square = dot2(bend, bend);
    if (square > 0) {
        double apex = -dot2(tangent, bend) / square, beside = fabs(cross2(tangent, bend)) / square;
        for (int i = -1; i <= 1; i++) {
            double t = apex + i * beside;
            if (t > 1e-6 && t < 1 - 1e-6)
                cuts[count++] = t;
        }
    }
    cuts[count] = 1;
    return count;
}

static void cut_piece(const Piece *piece, Pieces *pieces, Arena *arena)
{
    double cuts[5];
    int    count = find_cuts(&piece->curve, cuts);
    for (int i = 0; i < count; i++) {
        Piece part = *piece;
        if (count > 1)
            part.curve = curve_part(&piece->curve, cuts[i], cuts[i + 1]);
        part.corner[0] = i == 0 ? piece->corner[0] : 0;
        part.corner[1] = i + 1 == count ? piece->corner[1] : 0;
        array_push_large(arena, pieces, part);
    }
}

/* ---- rows ---- */

static void fill_line(const Piece *piece, double *row)
{
    for (int k = 0; k < 2; k++) {
        row[COLUMN_START + k]        = piece->curve.from[k];
        row[COLUMN_TANGENT + k]      = piece->curve.to[k] - piece->curve.from[k];
        row[COLUMN_FIRST_CORNER + k] = piece->corner[k];
    }
    row[COLUMN_LEAN] = piece->lean;
    row[COLUMN_SIDE] = 1;
}

/* Backwards where that is bent less and less. */
static void fill_curve(const Piece *piece, double *row)
{
    Curve  curve = piece->curve;
    double tangent[2], bend[2], corner[2] = {piece->corner[0], piece->corner[1]};
    tangent_and_bend(&curve, tangent, bend);
    bool back = 2 * dot2(tangent, bend) + dot2(bend, bend) < 0;
    if (back) {
        memcpy(curve.from, piece->curve.to, sizeof curve.from);
        memcpy(curve.to, piece->curve.from, sizeof curve.to);
        tangent_and_bend(&curve, tangent, bend);
        corner[0] = -piece->corner[1];
        corner[1] = -piece->corner[0];
    }
    for (int k = 0; k < 2; k++) {
        row[COLUMN_START + k]        = curve.from[k];
        row[COLUMN_TANGENT + k]      = tangent[k];
        row[COLUMN_BEND + k]         = bend[k];
        row[COLUMN_FIRST_CORNER + k] = corner[k];
    }
    row[COLUMN_LEAN]         = piece->lean;
    row[COLUMN_SIDE]         = back ? -1 : 1;
    row[COLUMN_BEND_BEND]    = dot2(bend, bend);
    row[COLUMN_TANGENT_BEND] = dot2(tangent, bend);
}

OutlineInstances outline_instances(const Outline *outline, Arena *arena, Arena *scratch)
{
    Pieces pieces   = {0};
    bool   straight = true;
    for (uint32_t i = 0; i < outline->count; i++) {
        cut_piece(&outline->pieces[i], &pieces, scratch);
        straight = straight && outline->pieces[i].curve.straight;
    }
    OutlineInstances instances = {.pieces  = pieces.items,
                                  .count   = (uint32_t)pieces.count,
                                  .columns = straight ? LINE_COLUMNS : CURVE_COLUMNS};
    instances.numbers = arena_new_array(arena, double, pieces.count *instances.columns + 1);
    for (size_t i = 0; i < pieces.count; i++)
        (straight ? fill_line : fill_curve)(&pieces.items[i],
                                            instances.numbers + i * instances.columns);
    return instances;
}

/* ---- what is inside ---- */

typedef struct RowCrossings {
    double *items;
    size_t  count, capacity;
} RowCrossings;

static int compare_crossings(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void fill_row(RowCrossings *row, double low, double step, uint32_t count, bool *inside)
{
    size_t passed = 0;
    if (row->count)
        qsort(row->items, row->count, sizeof *row->items, compare_crossings);
    for (uint32_t i = 0; i < count; i++) {
        while (passed < row->count && row->items[passed] < low + i * step)
            passed++;
        inside[i] = passed % 2 != 0;
    }
}

void outline_fill(const Outline *outline, const double low[2], double step, const uint32_t count[2],
                  bool *inside, Arena *scratch)
{
    RowCrossings *rows = arena_new_array(scratch, RowCrossings, count[1] + 1);
    for (uint32_t i = 0; i < outline->count; i++) {
        const Curve *curve = &outline->pieces[i].curve;
        double       from = curve->from[1], to = curve->to[1];
        double       first = ceil((fmin(from, to) - low[1]) / step - 1);
        for (double k = fmax(first, 0); k < count[1]; k++) {
            double y = low[1] + k * step;
            if (y > fmax(from, to))
                break;
            if ((from > y) != (to > y))
                array_push_large(scratch, &rows[(size_t)k], edge_crossing(curve, 0, y));
        }
    }
    for (uint32_t k = 0; k < count[1]; k++)
        fill_row(&rows[k], low[0], step, count[0], inside + (size_t)k * count[0]);
}
