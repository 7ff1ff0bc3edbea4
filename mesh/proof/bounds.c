/* bounds.c: bounds derivatives once for all tetrahedra in a cell of a grid. */
#include "mesh/proof/bounds.h"

#include <stdlib.h>

#include "compiler/base/minmax.h"
#include "mesh/proof/pieces.h"
#include "mesh/proof/smooth.h"

/* The rest of the error is for rounding: files may have single precision. */
static const double PROVEN_ERROR = 0.999;
/* Edges, in errors, above which tetrahedra are bisected if pieces do not fit, and below which cells
   are tried. */
static const double MIN_SHARP = 4;
/* Edges, in errors, of the largest that are tried by cells where nothing else is known: cells are
   as many as squares of the error, and are verified again with each smaller tetrahedron. */
static const double MIN_KNOWN = 6;
/* Edges, in errors, below which what curves too much for second derivatives is left to cells. */
static const double MIN_SMOOTH = 12;
/* Deviations, over the one that fits, up to which parts fit so often that bisection comes before
   cells. */
static const double NEARLY = 2;

double proven_error(const Mesher *m) { return PROVEN_ERROR * m->error; }

void tet_box(const Mesher *m, const Tet *tet, double low[3], double high[3])
{
    double corners[4][3];
    tets_corners(&m->tets, tet, corners);
    for (int k = 0; k < 3; k++) {
        low[k]  = min2(min2(corners[0][k], corners[1][k]), min2(corners[2][k], corners[3][k]));
        high[k] = max2(max2(corners[0][k], corners[1][k]), max2(corners[2][k], corners[3][k]));
    }
}

Box box_and_margin(double margin, const double low[3], const double high[3])
{
    Box box;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){low[k] - margin, high[k] + margin};
    return box;
}

static Tet *tet_of_order(Mesher *m, size_t i)
{
    return &m->tets.list.items[m->groups.order.items[i]];
}

Tet *tet_of_group(Mesher *m, const Group *group, uint32_t i)
{
    return tet_of_order(m, group->first + i);
}

/* A tetrahedron and its cell in the finest grid whose cells are no smaller. */
typedef struct Placed {
    uint64_t cell;
    uint32_t tet;
} Placed;

static uint64_t cell_of(const Tets *tets, const Tet *tet)
{
    uint32_t low[3], most = 0;
    uint64_t cell = 1, size = 1, bits = 20; /* the first bit distinguishes sizes */
    for (int k = 0; k < 3; k++) {
        uint32_t high = 0;
        low[k]        = UINT32_MAX;
        for (int i = 0; i < 4; i++) {
            uint32_t at = tets->points.items[tet->points[i]].at[k];
            low[k]      = at < low[k] ? at : low[k];
            high        = at > high ? at : high;
        }
        most = high - low[k] > most ? high - low[k] : most;
    }
    for (; size < most; size *= 2)
        bits--;
    for (int k = 0; k < 3; k++)
        cell = cell << bits | low[k] / size;
    return cell;
}

static int compare_placed(const void *a, const void *b)
{
    const Placed *first = a, *second = b;
    return first->cell != second->cell ? (first->cell > second->cell) - (first->cell < second->cell)
                                       : (first->tet > second->tet) - (first->tet < second->tet);
}

TetState state_by_bounds(const Mesher *m, const Tet *tet)
{
    if (tet->deviation <= tet->slope * proven_error(m))
        return TET_FITS;
    bool   parts_may = tet->deviation <= NEARLY * tet->slope * m->error;
    double by_cells  = parts_may || tet->deviation == INFINITY ? MIN_KNOWN : MIN_SMOOTH;
    return tets_longest_edge(&m->tets, tet) > by_cells * m->error ? TET_REFUTED : TET_UNPROVEN;
}

static void measure_in_cell(Mesher *m, const Verifier *verifier, const SmoothCell *cell,
                            const Placed *placed, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        Tet *tet = &m->tets.list.items[placed[i].tet];
        if (cell->empty || smooth_measure(&m->contour, cell, tet) ||
            (!cell->known && verify_is_empty(verifier, tet)))
            tet->state = TET_EMPTY;
        else
            tet->state = (uint8_t)state_by_bounds(m, tet);
    }
}

/* Tells whether a tetrahedron that does not fit would, by a share of the error, with the best
   bounds possible. */
static bool one_may_fit(Mesher *m, const SmoothCell *middle, double share, const Placed *placed,
                        size_t count)
{
    for (size_t i = 0; i < count; i++) {
        Tet tet = m->tets.list.items[placed[i].tet];
        if ((tet.state == TET_REFUTED || tet.state == TET_UNPROVEN) && tet.deviation < INFINITY) {
            smooth_measure(&m->contour, middle, &tet);
            if (tet.deviation <= share * tet.slope * proven_error(m))
                return true;
        }
    }
    return false;
}

/* Finds narrower bounds, which cost more, where they may decide. */
static void narrow_bounds(Mesher *m, Verifier *verifier, SmoothCell *cell, const Placed *placed,
                          size_t count)
{
    static const double AT_BEST = 0.85, MAX_CHANGE = 3.5;
    SmoothCell          middle;
    if (!cell->empty && smooth_gradient_change(cell) < MAX_CHANGE &&
        smooth_bound_at_middle(verifier->field, cell, &middle) &&
        one_may_fit(m, &middle, AT_BEST, placed, count)) {
        smooth_narrow(verifier->field, m->error, cell);
        measure_in_cell(m, verifier, cell, placed, count);
    }
}

/* Marks large tetrahedra whose bounds are far too wide: their parts need no bounds until they lie
   in cells half as large. */
static void mark_hopeless(Mesher *m, const Placed *placed, size_t count)
{
    static const double FAR_TOO_WIDE = 6;
    for (size_t i = 0; i < count; i++) {
        Tet *tet      = &m->tets.list.items[placed[i].tet];
        tet->hopeless = tet->state == TET_REFUTED &&
                        tet->deviation > FAR_TOO_WIDE * tet->slope * m->error &&
                        tets_longest_edge(&m->tets, tet) > MIN_SMOOTH * m->error;
    }
}

/* Tells how functions grow that bound tetrahedra. */
static void note_growth(Mesher *m, const Placed *placed, size_t count, size_t room,
                        const Growth *growth)
{
    m->new_growths.items[room] = *growth;
    for (size_t i = 0; i < count; i++)
        m->tets.list.items[placed[i].tet].growth = (uint32_t)room + 1;
}

/* Measures tetrahedra where the surface has edges, by its smooth pieces; returns false where no
   pieces are known. */
static bool measure_pieces(Mesher *m, Verifier *verifier, Box box, const Placed *placed,
                           size_t count, size_t room)
{
    PieceCell cell;
    pieces_bound(verifier->field, box, &cell);
    if (cell.known && cell.pieces.side == 0 && cell.facing.operand_count == 0)
        note_growth(m, placed, count, room, &cell.growth);
    for (size_t i = 0; i < count && cell.known; i++) {
        Tet *tet = &m->tets.list.items[placed[i].tet];
        if (tet->state == TET_EMPTY)
            continue;
        if (cell.pieces.side != 0 && tet->triangle_count == 0)
            tet->state = TET_EMPTY;
        else if (cell.pieces.side == 0 &&
                 pieces_measure(&m->contour, verifier->field, &cell, proven_error(m), tet))
            tet->state = TET_EMPTY;
        else if (cell.pieces.side == 0 && tet->deviation <= tet->slope * proven_error(m))
            tet->state = TET_FITS;
        else {
            tet->deviation = INFINITY;
            if (tets_longest_edge(&m->tets, tet) > MIN_SHARP * m->error)
                tet->state = TET_REFUTED;
        }
    }
    return cell.known;
}

/* Tells whether tetrahedra without bounds are so large that it pays to bound them one by one. */
static bool is_worth_bounding_singly(const Mesher *m, const Placed *placed, size_t count)
{
    const Tet *tet = &m->tets.list.items[placed[0].tet];
    return count > 1 && tets_longest_edge(&m->tets, tet) > MIN_SMOOTH * m->error;
}

static void bound_cell(Mesher *m, Verifier *verifier, const Placed *placed, size_t count,
                       size_t room)
{
    double     low[3], high[3], least[3], most[3];
    SmoothCell cell = {0};
    tet_box(m, &m->tets.list.items[placed[0].tet], low, high);
    for (size_t i = 1; i < count; i++) {
        tet_box(m, &m->tets.list.items[placed[i].tet], least, most);
        for (int k = 0; k < 3; k++) {
            low[k]  = min2(low[k], least[k]);
            high[k] = max2(high[k], most[k]);
        }
    }
    Box  box = box_and_margin(m->error, low, high), wide = box_and_margin(2 * m->error, low, high);
    bool entered = field_enter(verifier->field, wide), known = true;
    if (!entered) {
        for (size_t i = 0; i < count; i++)
            m->tets.list.items[placed[i].tet].state = TET_EMPTY;
        return;
    }
    smooth_bound(verifier->field, box, m->error, &cell);
    if (!cell.known && !cell.empty) {
        field_leave(verifier->field);
        field_focus(verifier->field, wide);
        smooth_bound(verifier->field, box, m->error, &cell);
    }
    measure_in_cell(m, verifier, &cell, placed, count);
    if (cell.known) {
        note_growth(m, placed, count, room, &cell.growth);
        narrow_bounds(m, verifier, &cell, placed, count);
        mark_hopeless(m, placed, count);
    } else if (!cell.empty)
        known = measure_pieces(m, verifier, wide, placed, count, room);
    field_leave(verifier->field);
    if (!known && is_worth_bounding_singly(m, placed, count))
        for (size_t i = 0; i < count; i++)
            if (m->tets.list.items[placed[i].tet].state != TET_EMPTY)
                bound_cell(m, verifier, &placed[i], 1, room + i);
}

void bounds_begin(Mesher *m)
{
    static const Growth none = {.count = 0};
    while (m->new_growths.count < m->groups.order.count)
        array_push_large(&m->arena, &m->new_growths, none);
    for (size_t i = 0; i < m->groups.order.count; i++)
        tet_of_order(m, i)->growth = 0;
}

void bounds_end(Mesher *m)
{
    Growths *kept = &m->around.growths;
    for (size_t i = 0; i < m->groups.order.count; i++) {
        Tet *tet = tet_of_order(m, i);
        if (tet->growth == 0)
            continue;
        Growth *growth = &m->new_growths.items[tet->growth - 1];
        if (growth->number == 0) {
            array_push_large(&m->arena, kept, *growth);
            growth->number = (uint32_t)kept->count;
        }
        tet->growth = growth->number;
    }
}

void bound_group(Mesher *m, Verifier *verifier, const Group *group)
{
    Placed placed[LARGEST_GROUP];
    size_t count = 0, end;
    for (uint32_t i = 0; i < group->count; i++) {
        Tet *tet = tet_of_group(m, group, i);
        if (tets_is_moved(&m->tets, tet)) {
            tet->state     = TET_UNPROVEN;
            tet->deviation = INFINITY;
        } else if (verify_is_far(&m->tets, tet))
            tet->state = TET_EMPTY;
        else
            placed[count++] = (Placed){cell_of(&m->tets, tet),
                                       m->groups.order.items[group->first + i]};
    }
    qsort(placed, count, sizeof *placed, compare_placed);
    for (size_t i = 0; i < count; i = end) {
        for (end = i + 1; end < count && placed[end].cell == placed[i].cell;)
            end++;
        bound_cell(m, verifier, &placed[i], end - i, group->first + i);
    }
}
