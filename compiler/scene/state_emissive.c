/*
 * state_emissive.c: balls around what emits light in a state, by which paths find it.
 *
 * Boxes of parts hold for all values of the parameters.  They are cut as long as balls are left, the
 * largest first.  A distance changes no faster than the point moves.  So where it is larger, in the
 * middle of a box, than the ball around that, the box has no surface and is dropped.  Where there are
 * few parts, each box is made tight first: it becomes the one around what is left after many cuts.
 *
 * Light that paths find is the same whatever the balls are (runtime/shaders/emissive.glsl).  So what
 * they send may be estimated from a few points.
 */
#include "compiler/scene/emissive.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/scene/program.h"

enum {
    MAX_CUTS       = 8 * KRS_MAX_EMISSIVE,
    CUTS_FOR_TIGHT = 512, /* of all parts together */
    MAX_TIGHT      = 32,  /* parts whose boxes are made tight */
    RIM_POINTS     = 128,
    MAX_WITH_RIMS  = 4, /* balls that are made smaller by points on their rims */
    MAX_ASKED      = 64
};
/* The part of all light that balls send together in which no light was found. */
#define SENT_BY_DARK 0.05
#define USUAL_IOR    1.5
/* The size at which finer cells must look smaller to be worth it. */
#define WORTH_IT 0.7
/* The urgency of cutting a box in which no light was found, relative to others. */
#define DARK 0.2

/* A box with some of the parts, or with a piece of one. */
typedef struct Cell {
    Box    box;
    size_t first, count; /* of parts */
    double middle[3], radius;
    double radiance; /* of a piece: the mean of some points */
} Cell;

typedef struct Cells {
    KrsState *state;
    Box       region;
    Box       tight[MAX_TIGHT]; /* around the first parts, in this state */
    size_t    tight_count;
    Cell      items[KRS_MAX_EMISSIVE];
    size_t    count;
} Cells;

static const EmissivePart *part_of(const Cells *cells, size_t number)
{
    return &cells->state->scene->emissive[cells->state->lit[number]];
}

static Box box_of(const Cells *cells, size_t number)
{
    return number < cells->tight_count ? cells->tight[number]
                                       : box_common(part_of(cells, number)->box, cells->region);
}

static Box hull_of(const Cells *cells, size_t first, size_t count)
{
    Box hull = box_empty;
    for (size_t i = 0; i < count; i++)
        hull = box_hull(hull, box_of(cells, first + i));
    return hull;
}

/* ---- what is known of a part at a point ---- */

static double find_distance(const Cells *cells, const EmissivePart *part, const double point[3])
{
    NodeValue *values = cells->state->values;
    tape_run_point(part->tape, point, values);
    return values[part->distance].v[0];
}

static bool differs_by_place(const Cells *cells, const EmissivePart *part)
{
    return cells->state->scene->graph->items[part->emission].time == TIME_POINT;
}

/* Returns the light that is emitted at a point. */
static double find_light(const Cells *cells, const EmissivePart *part, const double point[3])
{
    static const double up[3]  = {0, 1, 0};
    NodeValue          *values = cells->state->values;
    if (differs_by_place(cells, part))
        tape_run_surface(part->tape, point, up, 0, values);
    const double *light = values[part->emission].v;
    const double  found = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    return found > 0 && isfinite(found) ? found : 0;
}

/* Lists the parts that may emit light in this state.  Returns how many. */
static size_t list_lit(const Cells *cells)
{
    const double nowhere[3] = {0};
    size_t       count      = 0;
    for (size_t i = 0; i < cells->state->scene->emissive_count; i++) {
        const EmissivePart *part = &cells->state->scene->emissive[i];
        if (differs_by_place(cells, part) || find_light(cells, part, nowhere) > 0)
            cells->state->lit[count++] = i;
    }
    return count;
}

/* Returns the mean of some points of a piece. */
static double radiance_of_piece(const Cells *cells, const Cell *cell)
{
    static const double corners[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    double              sum           = 0;
    for (int i = 0; i < 4; i++) {
        double point[3];
        for (int k = 0; k < 3; k++) {
            const Range side = cell->box.axis[k];
            point[k]         = cell->middle[k] + 0.2 * corners[i][k] * (side.high - side.low);
        }
        sum += find_light(cells, part_of(cells, cell->first), point) / 4;
    }
    return sum;
}

/* ---- cells ---- */

/* Adds a cell, unless nothing in it emits light. */
static void add_cell(Cells *cells, Box box, size_t first, size_t count)
{
    Cell cell = {.box = box, .first = first, .count = count};
    if (count == 0 || box_is_empty(box))
        return;
    box_centre(box, cell.middle);
    cell.radius = 0.5 * box_diagonal(box);
    if (count == 1 && fabs(find_distance(cells, part_of(cells, first), cell.middle)) > cell.radius)
        return;
    cell.radiance                = count == 1 ? radiance_of_piece(cells, &cell) : 0;
    cells->items[cells->count++] = cell;
}

/* Puts two cells in place of one. */
static void cut_cell(Cells *cells, size_t number)
{
    const Cell   cell = cells->items[number];
    const size_t half = cell.count / 2, rest = cell.count - half;
    cells->items[number] = cells->items[--cells->count];
    if (cell.count > 1) {
        add_cell(cells, hull_of(cells, cell.first, half), cell.first, half);
        add_cell(cells, hull_of(cells, cell.first + half, rest), cell.first + half, rest);
        return;
    }
    const int axis = box_longest_axis(&cell.box);
    Box       low = cell.box, high = cell.box;
    low.axis[axis].high = cell.middle[axis];
    high.axis[axis].low = cell.middle[axis];
    add_cell(cells, low, cell.first, 1);
    add_cell(cells, high, cell.first, 1);
}

/* Tells how urgent it is to cut a cell.  Where no light was found there may be none. */
static double find_urgency(const Cell *cell, double min_radius)
{
    const bool   may_be_dark = cell->count == 1 && cell->radiance == 0;
    const double urgency     = may_be_dark ? DARK * cell->radius : cell->radius;
    return cell->count == 1 && urgency <= min_radius ? 0 : urgency;
}

/* Returns the cell to cut next; the number of cells if there is none. */
static size_t find_next(const Cells *cells, double min_radius)
{
    size_t found = cells->count;
    double most  = 0;
    for (size_t i = 0; i < cells->count; i++) {
        const double urgency = find_urgency(&cells->items[i], min_radius);
        found                = urgency > most ? i : found;
        most                 = fmax(most, urgency);
    }
    return found;
}

/* Cuts cells, the largest first, until none is left that must be. */
static void cut_cells(Cells *cells, double min_radius, size_t most)
{
    for (size_t cuts = 0; cuts < most && cells->count < KRS_MAX_EMISSIVE; cuts++) {
        const size_t next = find_next(cells, min_radius);
        if (next == cells->count)
            return;
        cut_cell(cells, next);
    }
}

/* Returns the sum of the discs of all balls, which are seen from far away, less those that may be
   dark. */
static double find_discs(const Cells *cells)
{
    double sum = 0;
    for (size_t i = 0; i < cells->count; i++)
        sum += find_urgency(&cells->items[i], 0) * find_urgency(&cells->items[i], 0);
    return sum;
}

/* Cuts cells further where that makes them look much smaller together, as of what is thin. */
static void refine(Cells *cells)
{
    Cells finer = *cells;
    for (int cuts = 0; cuts < MAX_CUTS && finer.count > 0 && finer.count < KRS_MAX_EMISSIVE;
         cuts++) {
        cut_cells(&finer, 0, 1);
        if (find_discs(&finer) < WORTH_IT * find_discs(cells))
            *cells = finer;
    }
}

/* Returns the box around what many cuts leave of a part. */
static Box find_tight(const Cells *cells, size_t number, size_t cuts)
{
    Cells own  = {.state = cells->state, .region = cells->region};
    Box   hull = box_empty;
    add_cell(&own, box_common(part_of(cells, number)->box, cells->region), number, 1);
    cut_cells(&own, 0, cuts);
    for (size_t i = 0; i < own.count; i++)
        hull = box_hull(hull, own.items[i].box);
    return hull;
}

/* ---- balls ---- */

/* Makes a ball smaller, as far as points of its surface have nothing near.  The points are a
   Fibonacci lattice: each direction is at most `angle` from that of one.  The empty balls around them
   cover what is between this ball and the smaller one. */
static void shrink(const Cells *cells, Cell *cell)
{
    const double golden = 2.399963229728653, angle = 2.8 / sqrt(RIM_POINTS); /* pi (3 - sqrt 5) */
    double       least = HUGE_VAL;
    for (int i = 0; i < RIM_POINTS; i++) {
        const double y = 1 - (2 * i + 1.0) / RIM_POINTS, ring = sqrt(1 - y * y),
                     azimuth = golden * i;
        const double way[3]  = {ring * real_cos(azimuth), y, ring * real_sin(azimuth)};
        double       point[3];
        for (int k = 0; k < 3; k++)
            point[k] = cell->middle[k] + cell->radius * way[k];
        least = fmin(least, find_distance(cells, part_of(cells, cell->first), point));
    }
    const double across = cell->radius * real_sin(angle),
                 chord  = 2 * cell->radius * real_sin(0.5 * angle);
    if (least > chord)
        cell->radius = fmax(cell->radius * real_cos(angle) - sqrt(least * least - across * across),
                            0.01 * cell->radius);
}

/* Tells how much larger a ball may look that is within glass: at most by the index of refraction, where the
   glass is a ball around it. */
static double find_magnified(const Cells *cells, const double middle[3])
{
    const KrsScene  *scene  = cells->state->scene;
    const NodeValue *values = cells->state->values;
    double           most   = 1;
    if (!scene->module.is_medium)
        return 1;
    tape_run_point(&cells->state->tapes.distance, middle, cells->state->values);
    for (size_t i = 0; i < scene->component_count; i++) {
        const Node ior = surface_roots(&scene->roots, i)[ROOT_ior];
        if (!scene->module.is_medium[i] || values[distance_root(&scene->roots, i)].v[0] >= 0)
            continue;
        most = fmax(most,
                    scene->graph->items[ior].time != TIME_POINT ? values[ior].v[0] : USUAL_IOR);
    }
    return most;
}

/* Returns what a ball sends, as the radiance of its disc.  Of many parts some are asked. */
static double radiance_of(const Cells *cells, const Cell *cell)
{
    const size_t step = 1 + cell->count / MAX_ASKED;
    double       sum  = 0;
    if (cell->count == 1)
        return cell->radiance;
    for (size_t i = 0; i < cell->count; i += step) {
        const Box box = box_of(cells, cell->first + i);
        double    middle[3];
        if (box_is_empty(box))
            continue;
        box_centre(box, middle);
        const double share = 0.5 * box_diagonal(box) / cell->radius;
        sum += find_light(cells, part_of(cells, cell->first + i), middle) * share * share *
               (double)step;
    }
    return sum;
}

static KrsEmissive ball_of(const Cells *cells, Cell *cell)
{
    KrsEmissive ball;
    if (cells->count <= MAX_WITH_RIMS && cell->count == 1)
        shrink(cells, cell);
    ball.radiance = radiance_of(cells, cell);
    ball.radius   = cell->radius * find_magnified(cells, cell->middle);
    memcpy(ball.middle, cell->middle, sizeof cell->middle);
    return ball;
}

/* Gives balls in which no light was found a small part: there may be some. */
static void light_up(KrsEmissive *balls, size_t count)
{
    double lit = 0, dark = 0;
    for (size_t i = 0; i < count; i++) {
        const double square = balls[i].radius * balls[i].radius;
        lit += square * balls[i].radiance;
        dark += balls[i].radiance > 0 ? 0 : square;
    }
    for (size_t i = 0; i < count; i++)
        if (!(balls[i].radiance > 0))
            balls[i].radiance = lit > 0 ? SENT_BY_DARK * lit / dark : 1;
}

size_t krs_state_emissive(KrsState *state, const double low[3], const double high[3],
                          double min_radius, KrsEmissive balls[KRS_MAX_EMISSIVE])
{
    Cells cells = {.state = state};
    for (int k = 0; k < 3; k++)
        cells.region.axis[k] = (Range){low[k], high[k]};
    state_refresh_points(state);
    const size_t count = list_lit(&cells);
    for (size_t i = 0; i < count && count <= MAX_TIGHT; i++) {
        cells.tight[i]    = find_tight(&cells, i, CUTS_FOR_TIGHT / count);
        cells.tight_count = i + 1;
    }
    add_cell(&cells, hull_of(&cells, 0, count), 0, count);
    cut_cells(&cells, min_radius, MAX_CUTS);
    refine(&cells);
    for (size_t i = 0; i < cells.count; i++)
        balls[i] = ball_of(&cells, &cells.items[i]);
    light_up(balls, cells.count);
    return cells.count;
}
