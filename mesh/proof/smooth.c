/* smooth.c: bounds how far inside and outside of the mesh are from those of the surface, in one
   tetrahedron. */
#include "mesh/proof/smooth.h"

#include <string.h>

#include "compiler/base/vec.h"

static const double ROUNDING = 1 + 1e-9;
static const int    ROW[6] = {0, 1, 2, 1, 0, 0}, COLUMN[6] = {0, 1, 2, 2, 2, 1};
static const int    PLACE[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; /* of rows and columns */

/* ---- cells ---- */

/* Takes the middles of the ranges, and adds the rest to the diagonal, since |u_j u_k| is at most
   (u_j^2 + u_k^2) / 2.  The forms hold for all points of the box, though second derivatives
   differ. */
void smooth_forms(const LaneHessian *hessian, double above[6], double below[6])
{
    double more[3] = {0, 0, 0}, size = 0;
    for (int i = 0; i < 6; i++) {
        double middle = 0.5 * (hessian->by[i].low + hessian->by[i].high);
        double rest   = ROUNDING * max2(hessian->by[i].high - middle, middle - hessian->by[i].low);
        above[i]      = middle;
        below[i]      = -middle;
        size          = max2(size, fabs(middle));
        more[ROW[i]] += rest;
        if (i >= 3)
            more[COLUMN[i]] += rest;
    }
    for (int k = 0; k < 3; k++) {
        more[k] += 1e-12 * size;
        above[k] += more[k];
        below[k] += more[k];
    }
}

/* Finds the gradient in the middle of the box by differences; returns its largest error, which
   second derivatives tell. */
static double find_middle_gradient(const MeshField *field, Box box, double step,
                                   const LaneHessian *hessian, double gradient[3])
{
    double points[6][3], values[6], size = 0;
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 3; k++)
            points[i][k] = 0.5 * (box.axis[k].low + box.axis[k].high);
        points[i][i / 2] += i % 2 ? step : -step;
        size = max2(size, range_largest(hessian->by[i]));
    }
    field_distances(field, (const double(*)[3])points, 6, values);
    for (int k = 0; k < 3; k++)
        gradient[k] = (values[2 * k + 1] - values[2 * k]) / (2 * step);
    return step * size;
}

/* Returns the least slope along a normal: that in the middle of the box, less what second
   derivatives may change it by (the mean value theorem). */
static double slope_along(const double normal[3], const double gradient[3], double wrong, Box box,
                          const LaneHessian *hessian)
{
    double slope = dot3(gradient, normal) - wrong;
    for (int j = 0; j < 3; j++) {
        Range change = range_of(0);
        for (int k = 0; k < 3; k++)
            change = range_add(change, range_mul(hessian->by[PLACE[j][k]], range_of(normal[k])));
        slope -= range_largest(change) * 0.5 * (box.axis[j].high - box.axis[j].low);
    }
    return slope / (1 + 1e-6);
}

/* Finds how the value grows, by the narrower bounds of its derivatives: their ranges, or those in
   the middle and what they change by (the mean value theorem). */
static void find_growth(const LaneSlope *slope, const double gradient[3], double wrong, Box box,
                        const LaneHessian *hessian, Growth *growth)
{
    Range by[3];
    for (int j = 0; j < 3; j++) {
        double change = wrong;
        for (int k = 0; k < 3; k++)
            change += range_largest(hessian->by[PLACE[j][k]]) * 0.5 * ROUNDING *
                      (box.axis[k].high - box.axis[k].low);
        by[j] = (Range){max2(slope->by[j].low, gradient[j] - change),
                        min2(slope->by[j].high, gradient[j] + change)};
    }
    growth_add(growth, by, 1);
}

static double find_slope(const MeshField *field, Box box, double step, const LaneSlope *slope,
                         const LaneHessian *hessian, Growth *growth)
{
    double gradient[3], normal[3];
    double wrong = find_middle_gradient(field, box, step, hessian, gradient);
    memcpy(normal, gradient, sizeof normal);
    if (!normalize3(normal))
        return 0;
    for (int k = 0; k < 3; k++)
        growth->direction[k] = (float)normal[k];
    find_growth(slope, gradient, wrong, box, hessian, growth);
    return slope_along(normal, gradient, wrong, box, hessian);
}

void smooth_bound(const MeshField *field, Box box, double error, SmoothCell *cell)
{
    LaneSlope   slope;
    LaneHessian hessian;
    Gradient    gradient;
    Range       range;
    *cell       = (SmoothCell){.box = box};
    cell->known = field_hessian(field, box, &range, &slope, &hessian);
    cell->empty = range.low > 0 || range.high < 0;
    if (!cell->known || cell->empty)
        return;
    smooth_forms(&hessian, cell->above, cell->below);
    cell->slope  = find_slope(field, box, 1e-2 * error, &slope, &hessian, &cell->growth);
    cell->origin = field_origin(field, box);
    if (find_gradient(&slope, &gradient))
        cell->slope = max2(cell->slope, gradient.least / ROUNDING);
}

double smooth_gradient_change(const SmoothCell *cell)
{
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = max2(most, (cell->above[k] + cell->below[k]) *
                              (cell->box.axis[k].high - cell->box.axis[k].low));
    return most;
}

/* ---- parts of cells ---- */

enum { MAX_CELL_PARTS = 1 << SMOOTH_HALVINGS };

/* The parts of a box where the value may be as small as the error, and the hull of all second
   derivatives. */
typedef struct CellParts {
    double      error;
    LaneHessian hull, hessians[MAX_CELL_PARTS];
    Box         boxes[MAX_CELL_PARTS];
    int         count;
} CellParts;

static bool bound_parts(const MeshField *field, Box box, int halvings, CellParts *parts)
{
    Range       range;
    LaneSlope   slope;
    LaneHessian own;
    if (halvings > 0) {
        Box    halves[2]          = {box, box};
        int    axis               = halvings % 3;
        double middle             = 0.5 * (box.axis[axis].low + box.axis[axis].high);
        halves[0].axis[axis].high = halves[1].axis[axis].low = middle;
        return bound_parts(field, halves[0], halvings - 1, parts) &&
               bound_parts(field, halves[1], halvings - 1, parts);
    }
    if (!field_hessian(field, box, &range, &slope, &own))
        return false;
    for (int i = 0; i < 6; i++)
        parts->hull.by[i] = parts->hull.known ? range_hull(parts->hull.by[i], own.by[i])
                                              : own.by[i];
    parts->hull.known = true;
    if (range.low <= parts->error && range.high >= -parts->error) {
        parts->hessians[parts->count] = own;
        parts->boxes[parts->count++]  = box;
    }
    return true;
}

/* Returns the least slope of paths that begin in one of the parts and are no longer than the error:
   along them it changes by what is known of the whole box. */
static double slope_of_paths(const MeshField *field, const CellParts *parts, const SmoothCell *cell,
                             const double normal[3])
{
    double gradient[3], zero[3] = {0, 0, 0}, least = 1;
    for (int i = 0; i < parts->count; i++) {
        double wrong = find_middle_gradient(field, parts->boxes[i], 1e-2 * parts->error,
                                            &parts->hessians[i], gradient);
        least        = min2(least,
                            slope_along(normal, gradient, wrong, parts->boxes[i], &parts->hessians[i]));
    }
    return least - parts->error * max2(smooth_bend(cell->above, normal, zero),
                                       smooth_bend(cell->below, normal, zero));
}

void smooth_narrow(const MeshField *field, double error, SmoothCell *cell)
{
    CellParts parts = {.error = error};
    Box       box   = cell->box;
    double    middle[3], normal[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (box.axis[k].low + box.axis[k].high);
        box.axis[k].low += error;
        box.axis[k].high -= error;
    }
    if (!bound_parts(field, box, SMOOTH_HALVINGS, &parts) ||
        !field_normal(field, middle, 1e-2 * error, normal))
        return;
    cell->slope = max2(cell->slope, slope_of_paths(field, &parts, cell, normal));
    smooth_forms(&parts.hull, cell->above, cell->below);
}

bool smooth_bound_at_middle(const MeshField *field, const SmoothCell *cell, SmoothCell *middle)
{
    Range       range;
    LaneSlope   slope;
    LaneHessian hessian;
    *middle = *cell;
    for (int k = 0; k < 3; k++) {
        Range *axis = &middle->box.axis[k];
        axis->low = axis->high = 0.5 * (axis->low + axis->high);
    }
    if (!field_hessian(field, middle->box, &range, &slope, &hessian))
        return false;
    smooth_forms(&hessian, middle->above, middle->below);
    double square = 0;
    for (int k = 0; k < 3; k++)
        square += slope.by[k].low * slope.by[k].low;
    middle->slope = sqrt(square);
    return true;
}

/* ---- points ---- */

/* Points whose convex hull has one side of the tetrahedron: vertices of the mesh first. */
enum { MAX_MESH_POINTS = 9, MAX_POINTS = 12 };

typedef struct Side {
    const double *at[MAX_POINTS];
    int           count, on_mesh;
    const double *form;      /* of a cell */
    double        depths[4]; /* of its corners */
} Side;

double smooth_form(const double form[6], const double a[3], const double b[3])
{
    double d[3];
    add_scaled3(d, a, -1, b);
    return form[0] * d[0] * d[0] + form[1] * d[1] * d[1] + form[2] * d[2] * d[2] +
           2 * (form[3] * d[1] * d[2] + form[4] * d[0] * d[2] + form[5] * d[0] * d[1]);
}

double smooth_bend(const double form[6], const double a[3], const double b[3])
{
    return max2(smooth_form(form, a, b), 0) * ROUNDING;
}

/* Returns the largest sum of w_i w_j q_ij over all pairs, for weights w >= 0 whose sum is 1.  With
   q the squares of lengths it is the squared radius of the smallest ball around the points. */
static double max_of_pair(double q) { return 0.25 * q; }

double smooth_max_of_three(double a, double b, double c)
{
    double longest = max2(a, max2(b, c)),
           square  = 2 * (a * b + b * c + c * a) - a * a - b * b - c * c;
    if (2 * longest >= a + b + c || square <= 0)
        return max_of_pair(longest);
    return ROUNDING * a * b * c / square;
}

/* Bounds that sum for four points in a ring, whose opposite pairs have `a` and `b`, and all others
   at most c: with the share s of the first pair it is at most the sum of s^2 a / 4, (1 - s)^2 b / 4
   and s (1 - s) c. */
static double max_of_ring(double a, double b, double c)
{
    double curve = 0.25 * (a + b) - c, best = max2(0.25 * a, 0.25 * b);
    double s = curve < 0 ? 0.5 * (0.5 * b - c) / curve : 0;
    if (s > 0 && s < 1)
        best = max2(best,
                    ROUNDING * (0.25 * (s * s * a + (1 - s) * (1 - s) * b) + s * (1 - s) * c));
    return best;
}

/* ---- the mesh in a tetrahedron ---- */

/* The vertices of the mesh in a tetrahedron: crossings, vertices of lines, apex. */
typedef struct MeshPart {
    const Patch  *patch;
    const double *crossings[4], *bends[4]; /* bends[i] follows crossings[i]; NULL: none */
    double        value;                   /* the largest absolute value at its vertices */
} MeshPart;

static MeshPart mesh_part(const Contour *contour, const Tet *tet)
{
    MeshPart part = {.patch = NULL};
    if (tet->triangle_count == 0)
        return part;
    part.patch = &contour->patches.items[tet->patch];
    for (uint32_t i = 0; i < part.patch->corner_count; i++) {
        const Crossing *crossing = &contour->crossings.items[part.patch->crossings[i]];
        const FaceLine *line     = &contour->lines.items[part.patch->lines[i]];
        part.crossings[i]        = crossing->at;
        part.value               = max2(part.value, fabs(crossing->value));
        if (line->bent) {
            part.bends[i] = line->at;
            part.value    = max2(part.value, fabs(line->value));
        }
    }
    if (part.patch->fan)
        part.value = max2(part.value, fabs(part.patch->value));
    return part;
}

/* Returns the largest that the form permits on the mesh.  Each cone of a fan has at most the
   vertices of one line and the apex.  Two triangles are bounded by the hull of all four
   vertices. */
static double max_on_mesh(const MeshPart *part, const double form[6])
{
    const Patch *patch = part->patch;
    uint32_t     count = patch->corner_count;
    double       most  = 0;
    for (uint32_t i = 0; patch->fan && i < count; i++) {
        const double *a = part->crossings[i], *b = part->crossings[(i + 1) % count];
        const double *m = part->bends[i], *apex = patch->apex;
        double        ab = smooth_bend(form, a, b), pa = smooth_bend(form, apex, a),
               pb = smooth_bend(form, apex, b);
        most      = max2(most, m ? max_of_ring(ab, smooth_bend(form, apex, m),
                                               max2(max2(pa, pb), max2(smooth_bend(form, a, m),
                                                                       smooth_bend(form, b, m))))
                                 : smooth_max_of_three(ab, pa, pb));
    }
    if (patch->fan)
        return most;
    const double *const *c = part->crossings;
    if (count == 3)
        return smooth_max_of_three(smooth_bend(form, c[0], c[1]), smooth_bend(form, c[1], c[2]),
                                   smooth_bend(form, c[2], c[0]));
    double sides = 0;
    for (int i = 0; i < 4; i++)
        sides = max2(sides, smooth_bend(form, c[i], c[(i + 1) % 4]));
    return max_of_ring(smooth_bend(form, c[0], c[2]), smooth_bend(form, c[1], c[3]), sides);
}

/* ---- one side ---- */

static void add_point(Side *side, const double at[3]) { side->at[side->count++] = at; }

static Side start_side(const MeshPart *part, const double form[6])
{
    Side side = {.form = form};
    for (int i = 0; i < 4; i++) {
        if (part->crossings[i])
            add_point(&side, part->crossings[i]);
        if (part->bends[i])
            add_point(&side, part->bends[i]);
    }
    if (part->patch && part->patch->fan)
        add_point(&side, part->patch->apex);
    side.on_mesh = side.count;
    return side;
}

/* Returns the largest value of the wrong sign on one side of the mesh, where `most` is that on the
   mesh; below 0 there is none.  The signs of corners are right.  A corner so deep that pairs with
   it add nothing leaves what the others permit; other corners count as the mesh does, four points
   at most at once. */
static double deviation_of_side(const Side *side, const MeshPart *part, double most)
{
    double deep = -INFINITY, pairs = 0, least = part->patch ? -part->value : INFINITY;
    bool   shallow[MAX_POINTS] = {false}, any = false;
    for (int i = side->on_mesh; i < side->count; i++) {
        double longest = 0, depth = side->depths[i - side->on_mesh];
        for (int j = 0; j < side->count; j++)
            if (j != i)
                longest = max2(longest, smooth_bend(side->form, side->at[i], side->at[j]));
        double left = 0.5 * longest - depth;
        shallow[i]  = part->patch ? left > most : left >= 0;
        any         = any || shallow[i];
        if (shallow[i])
            least = min2(least, depth);
        else
            deep = max2(deep, left);
    }
    if (!any)
        return max2(most, deep);
    for (int i = 0; i < side->count; i++)
        for (int j = 0; j < i; j++)
            if ((i < side->on_mesh || shallow[i]) && (j < side->on_mesh || shallow[j]))
                pairs = max2(pairs, smooth_bend(side->form, side->at[i], side->at[j]));
    return max2(deep, 0.5 * 0.375 * pairs - least);
}

/* Bounds a form between a corner and any point of the tetrahedron: of a mean of corners it is the
   mean, less the sum of w_i w_j times the form between each pair. */
static double max_from(const double form[6], const double (*corners)[3], int from)
{
    double most = 0, least = 0;
    for (int i = 0; i < 4; i++) {
        most = max2(most, smooth_bend(form, corners[from], corners[i]));
        for (int j = 0; j < i; j++)
            least = min2(least, smooth_form(form, corners[i], corners[j]));
    }
    return most - ROUNDING * 0.375 * least;
}

double smooth_level(const SmoothCell *cell, const double (*corners)[3], const double values[4],
                    bool inside, double most)
{
    double least = INFINITY;
    for (int i = 0; i < 4; i++) {
        double depth = (inside ? values[i] : -values[i]) - most;
        if (!(depth > 0))
            continue;
        double bend = max_from(inside ? cell->above : cell->below, corners, i);
        double rest = max2(ROUNDING * sqrt(0.5 * bend) - sqrt(depth), 0);
        least       = min2(least, most + ROUNDING * rest * rest);
    }
    return least;
}

/* Returns the deviation of both sides, inside first. */
static double deviation_of(const SmoothCell *cell, const MeshPart *part, const Side *sides,
                           const double (*corners)[3], const double values[4])
{
    double worst = -INFINITY;
    for (int k = 0; k < 2; k++) {
        if (sides[k].count == sides[k].on_mesh)
            continue;
        double most      = part->patch ? part->value + 0.5 * max_on_mesh(part, sides[k].form)
                                       : -INFINITY;
        double deviation = deviation_of_side(&sides[k], part, most);
        if (part->patch && deviation > most)
            deviation = min2(deviation, smooth_level(cell, corners, values, k == 0, most));
        worst = max2(worst, deviation);
    }
    return worst;
}

bool smooth_measure(const Contour *contour, const SmoothCell *cell, Tet *tet)
{
    MeshPart part = mesh_part(contour, tet);
    double   corners[4][3], values[4];
    tet->deviation = INFINITY;
    tet->steep     = 0;
    tet->room      = 0;
    tet->origin    = cell->origin;
    tet->slope     = (float)(cell->slope * (1 - 1e-6));
    if (!cell->known)
        return false;
    Side sides[2] = {start_side(&part, cell->below), start_side(&part, cell->above)};
    tets_corners(contour->tets, tet, corners);
    for (int i = 0; i < 4; i++) {
        values[i]  = contour->tets->points.items[tet->points[i]].distance;
        Side *side = &sides[values[i] >= 0];
        side->depths[side->count - side->on_mesh] = fabs(values[i]);
        add_point(side, corners[i]);
    }
    double deviation = deviation_of(cell, &part, sides, (const double(*)[3])corners, values);
    tet->deviation   = (float)(deviation * (1 + copysign(1e-6, deviation)));
    return deviation < 0;
}
