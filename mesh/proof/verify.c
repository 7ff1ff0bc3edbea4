/*
 * verify.c: proofs by balls and by slopes: where the distance at a point is d, the ball of radius
 * |d| around it has no surface in it; and where all derivatives in a box are about the same, the
 * surface there is about a plane.
 *
 * A part of space is near enough to the mesh if it is within the error of it.  That takes as many
 * parts as there are squares of the error on the surface, so flat places have a shorter proof: the
 * surface is in a thin lens.  Derivatives tell that; where they have no bounds, a large ball
 * outside and one inside that nearly touch leave a lens between them.
 */
#include "mesh/proof/verify.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/field/gradient.h"
#include "mesh/proof/lens.h"
#include "mesh/proof/marks.h"

enum { MAX_UNRESOLVED = 16, MAX_HALVINGS = 80 };
/* Parts of a cell's radius at which a lens is tried again: if the last was too thick; or if the
   surface had an edge, or derivatives no bounds, which parts share with the whole more often. */
static const double LESS_FLAT = 0.7, LESS_STEEP = 0.35;
/* Parts of the error: smaller cells and triangles are not divided. */
static const double TINY_CELL = 0.25, TINY_TRIANGLE = 0.125;
/* The depth, in errors, of a side that is not thinner than the error: a right angle leaves about as
   much. */
static const double DEEP = 0.2;

bool verify_is_far(const Tets *tets, const Tet *tet)
{
    double corners[4][3];
    tets_corners(tets, tet, corners);
    for (int i = 0; i < 4; i++) {
        double radius = 0;
        for (int j = 0; j < 4; j++)
            radius = max2(radius, distance3(corners[i], corners[j]));
        if (fabs(tets->points.items[tet->points[i]].distance) > ROUNDING * radius)
            return true;
    }
    return false;
}

bool verify_is_empty(const Verifier *verifier, const Tet *tet)
{
    double corners[4][3], center[3];
    if (verify_is_far(verifier->tets, tet))
        return true;
    tets_corners(verifier->tets, tet, corners);
    double radius = corners_ball((const double(*)[3])corners, center);
    return fabs(field_distance(verifier->field, center)) > ROUNDING * radius;
}

/* ---- from the surface to the mesh ---- */

/* Notes that the proof uses the mesh so far around a point. */
static void note_need(Verifier *verifier, const double point[3], double around)
{
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k]  = point[k] - around;
        high[k] = point[k] + around;
    }
    mark_box_add(verifier->tets, low, high, &verifier->tet->needs);
}

/* Tells whether the mesh is within a radius.  The tetrahedron's own triangles exist as long as it
   does; another triangle is noted. */
static bool is_near_mesh(Verifier *verifier, const double point[3], double radius)
{
    const Tet *tet = verifier->tet;
    double     nearest[3];
    for (uint32_t i = 0; i < tet->triangle_count; i++)
        if (bvh_triangle_is_near(verifier->mesh, tet->first_triangle + i, point, radius, nearest))
            return true;
    if (!bvh_is_near(verifier->mesh, point, radius, &verifier->last))
        return false;
    bvh_triangle_is_near(verifier->mesh, verifier->last, point, radius, nearest);
    note_need(verifier, nearest, 0);
    return true;
}

/* Tells whether the mesh fills a lens, and notes what that uses. */
static bool fills_lens(Verifier *verifier, const Lens *lens)
{
    note_need(verifier, lens->center, ROUNDING * lens_reach(verifier, lens));
    return mesh_fills_lens(verifier, lens);
}

static bool is_flat_by_balls(Verifier *verifier, const double corners[4][3], const double center[3],
                             double radius, double distance, const double direction[3])
{
    Lens lens = {.radius = radius};
    memcpy(lens.normal, direction, sizeof lens.normal);
    add_scaled3(lens.center, center, -distance, lens.normal);
    return find_lens_by_balls(verifier, &lens) &&
           (is_beside_lens(&lens, corners) || fills_lens(verifier, &lens));
}

static bool is_flat_by_slope(Verifier *verifier, const double corners[4][3], const double center[3],
                             double radius, double distance, bool *has_gradient)
{
    Lens      lens = {.radius = radius};
    Box       box  = corners_box(corners, 4, 0);
    Range     range;
    LaneSlope slope;
    Gradient  gradient;
    bool      bounded = field_slope(verifier->field, box, &range, &slope);
    if (range.low > 0 || range.high < 0)
        return true;
    *has_gradient = bounded && find_gradient(&slope, &gradient);
    if (!*has_gradient)
        return false;
    find_lens_by_slope(&gradient, center, distance, &lens);
    return is_beside_lens(&lens, corners) ||
           (lens.above < verifier->error && fills_lens(verifier, &lens));
}

/* Tells whether the other side is at least `deep` at some point around a centre: at an edge it may
   be in none of the directions of its faces, but between them. */
static bool is_other_side_around(const Verifier *verifier, const double center[3], double distance,
                                 double step, double deep)
{
    enum { AROUND = 27, MIDDLE = 13 };
    double points[AROUND][3], distances[AROUND];
    for (int i = 0; i < AROUND; i++) {
        double direction[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        if (i != MIDDLE)
            normalize3(direction);
        add_scaled3(points[i], center, step, direction);
    }
    field_distances(verifier->field, (const double(*)[3])points, AROUND, distances);
    for (int i = 0; i < AROUND; i++)
        if ((distances[i] < 0) != (distance < 0) && fabs(distances[i]) >= deep)
            return true;
    return false;
}

static bool may_be_sharper(const Verifier *verifier, const Tet *tet)
{
    return verifier->sharp > 0 &&
           tets_longest_edge(verifier->tets, tet) > verifier->sharp * verifier->error;
}

/* Counts a point as unresolved that is near to the surface and too far from the mesh; returns false
   if the other side is behind the surface, so that the mesh is wrong. */
static bool leave_unresolved(Verifier *verifier, const double center[3], double distance)
{
    double normal[3], beyond[3];
    double step = fabs(distance) + 0.5 * verifier->error;
    if (field_normal(verifier->field, center, 1e-3 * verifier->error, normal)) {
        add_scaled3(beyond, center, distance < 0 ? step : -step, normal);
        if ((field_distance(verifier->field, beyond) < 0) != (distance < 0))
            return false;
    }
    if (is_other_side_around(verifier, center, distance, step, DEEP * verifier->error) ||
        may_be_sharper(verifier, verifier->tet))
        return false;
    note_need(verifier, center, verifier->error);
    verifier->unresolved++;
    memcpy(verifier->location, center, sizeof verifier->location);
    return true;
}

enum { CELLS_AT_ONCE = 8, MAX_CELLS = 1024 };

/* A part of a tetrahedron. */
typedef struct Cell {
    double corners[4][3];
    int    tag, halvings;
    double lens; /* largest radius for which a lens is worth a try */
} Cell;

/* The numbers that are found for a cell. */
typedef struct CellView {
    double center[3], radius, distance;
    bool   near_mesh, may_be_flat;
    double direction[3]; /* in which the distance grows, about, if it may be flat */
    bool   has_gradient; /* bounds of derivatives were asked for, and known */
} CellView;

/* Cells that are left, the smallest last. */
typedef struct Cells {
    Cell   items[MAX_CELLS];
    size_t count;
    int    side; /* -1 or 1 if the mesh leaves all of the tetrahedron inside or outside, else 0 */
} Cells;

static CellView cell_view(Verifier *verifier, const Cell *cell)
{
    CellView view  = {0};
    view.radius    = ROUNDING * corners_ball(cell->corners, view.center);
    view.near_mesh = view.radius < verifier->error &&
                     is_near_mesh(verifier, view.center, verifier->error - view.radius);
    view.may_be_flat = view.radius > verifier->error && view.radius <= cell->lens;
    return view;
}

/* Finds distances and directions of some cells at once. */
static void measure_cells(const Verifier *verifier, CellView *views, size_t count)
{
    double points[4 * CELLS_AT_ONCE][3], distances[4 * CELLS_AT_ONCE];
    size_t first[CELLS_AT_ONCE], used = 0;
    for (size_t i = 0; i < count; i++) {
        first[i] = used;
        for (int k = 0; !views[i].near_mesh && k < (views[i].may_be_flat ? 4 : 1); k++) {
            memcpy(points[used], views[i].center, sizeof points[used]);
            if (k > 0)
                points[used][k - 1] += 1e-3 * verifier->error;
            used++;
        }
    }
    field_distances(verifier->field, (const double(*)[3])points, used, distances);
    for (size_t i = 0; i < count; i++) {
        const double *found = &distances[first[i]];
        if (views[i].near_mesh)
            continue;
        views[i].distance = found[0];
        for (int k = 0; views[i].may_be_flat && k < 3; k++)
            views[i].direction[k] = found[k + 1] - found[0];
    }
}

static void halve_cell(Cells *cells, const Cell *cell, double lens)
{
    Cell *first  = &cells->items[cells->count++];
    Cell *second = &cells->items[cells->count++];
    *first = *second = (Cell){.halvings = cell->halvings + 1, .lens = lens};
    first->tag = second->tag = bisect_corners(cell->corners, cell->tag, first->corners,
                                              second->corners);
}

/* Tells whether a lens proves a cell: by balls, which cost less, or else by slopes. */
static bool is_flat(Verifier *verifier, const Cell *cell, CellView *view)
{
    return (normalize3(view->direction) &&
            is_flat_by_balls(verifier, cell->corners, view->center, view->radius, view->distance,
                             view->direction)) ||
           is_flat_by_slope(verifier, cell->corners, view->center, view->radius, view->distance,
                            &view->has_gradient);
}

/* Tells whether a cell has no surface, by its pieces, as where solids overlap by less than cells
   are large.  After many failures pieces are not asked any more. */
static bool is_on_one_side(Verifier *verifier, const Cell *cell, const CellView *view)
{
    enum { MAX_IN_VAIN = 32 };
    static const double SMALL = 0.35; /* errors */
    if (view->radius >= SMALL * verifier->error || verifier->asked_in_vain == MAX_IN_VAIN)
        return false;
    Box  box  = corners_box((const double(*)[3])cell->corners, 4, 0);
    bool told = field_side(verifier->field, box) != 0;
    verifier->asked_in_vain += !told;
    return told;
}

/* Proves a cell, or halves it; returns false if the mesh is refuted. */
static bool cell_is_near_mesh(Verifier *verifier, Cells *cells, const Cell *cell, CellView *view)
{
    double error = verifier->error, lens = cell->lens;
    if (view->near_mesh)
        return true;
    if (cells->side * view->distance < -error)
        return false;
    if (fabs(view->distance) > view->radius || verifier->unresolved >= MAX_UNRESOLVED)
        return true;
    if (view->may_be_flat) {
        if (is_flat(verifier, cell, view))
            return true;
        lens = (view->has_gradient ? LESS_FLAT : LESS_STEEP) * view->radius;
    }
    if (is_on_one_side(verifier, cell, view))
        return true;
    if (view->radius < TINY_CELL * error || cell->halvings == MAX_HALVINGS)
        return leave_unresolved(verifier, view->center, view->distance);
    if (cells->count + 2 > MAX_CELLS)
        return false;
    halve_cell(cells, cell, lens);
    return true;
}

/* Tells whether bounds prove a cell; they use the mesh within the error of it. */
static bool is_sure(Verifier *verifier, const Cell *cell)
{
    if (!verifier->sure.anywhere || !sure_has(&verifier->sure, (const double(*)[3])cell->corners))
        return false;
    for (int i = 0; i < 4; i++)
        note_need(verifier, cell->corners[i], verifier->error);
    return true;
}

static bool surface_is_near_mesh(Verifier *verifier, const Cell *whole, int side)
{
    Cells cells;
    cells.items[0] = *whole;
    cells.count    = 1;
    cells.side     = side;
    while (cells.count > 0) {
        Cell     now[CELLS_AT_ONCE];
        CellView views[CELLS_AT_ONCE];
        size_t   count = 0;
        while (cells.count > 0 && count < CELLS_AT_ONCE) {
            now[count] = cells.items[--cells.count];
            if (is_sure(verifier, &now[count]))
                continue;
            views[count] = cell_view(verifier, &now[count]);
            count++;
        }
        verifier->budget -= (double)count;
        if (verifier->budget < 0)
            return false;
        measure_cells(verifier, views, count);
        for (size_t i = 0; i < count; i++)
            if (!cell_is_near_mesh(verifier, &cells, &now[i], &views[i]))
                return false;
    }
    return true;
}

/* ---- from the mesh to the surface ---- */

/* Tells whether the surface is between two points on both sides of a centre. */
static bool is_crossed(const Verifier *verifier, const double center[3], double far,
                       const double direction[3])
{
    double beside[2][3], distances[2];
    add_scaled3(beside[0], center, far, direction);
    add_scaled3(beside[1], center, -far, direction);
    field_distances(verifier->field, (const double(*)[3])beside, 2, distances);
    return distances[0] >= 0 && distances[1] < 0;
}

static void halve_edges(const double corners[3][3], double middles[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            middles[i][k] = 0.5 * (corners[i][k] + corners[(i + 1) % 3][k]);
}

static bool triangle_is_near_surface(Verifier *verifier, const double corners[3][3],
                                     const double normal[3]);

static bool parts_are_near_surface(Verifier *verifier, const double corners[3][3],
                                   const double normal[3])
{
    double middles[3][3], part[3][3];
    halve_edges(corners, middles);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            part[0][k] = corners[i][k];
            part[1][k] = middles[i][k];
            part[2][k] = middles[(i + 2) % 3][k];
        }
        if (!triangle_is_near_surface(verifier, (const double(*)[3])part, normal))
            return false;
    }
    return triangle_is_near_surface(verifier, (const double(*)[3])middles, normal);
}

typedef enum Nearness { FAR_FROM_SURFACE, NEAR_SURFACE, NOT_KNOWN } Nearness;

/* Finds by derivatives within the error of a triangle whether the surface is near: along their
   direction it is no farther than the value over the least of them. */
static Nearness find_nearness(const Verifier *verifier, const double corners[3][3],
                              const double center[3], double radius, double distance)
{
    Box       box = corners_box(corners, 3, verifier->error);
    Range     range;
    LaneSlope slope;
    Gradient  gradient;
    double    most    = 0;
    bool      bounded = field_slope(verifier->field, box, &range, &slope);
    if (range.low > 0 || range.high < 0)
        return FAR_FROM_SURFACE;
    if (!bounded || !find_gradient(&slope, &gradient))
        return NOT_KNOWN;
    for (int i = 0; i < 3; i++) {
        double offset[3];
        add_scaled3(offset, corners[i], -1, center);
        most = max2(most, fabs(distance + dot3(gradient.middle, offset)));
    }
    return ROUNDING * (most + gradient.across * radius) <= gradient.least * verifier->error
               ? NEAR_SURFACE
               : NOT_KNOWN;
}

/* Tells whether the surface is near a small triangle; near a sharp edge both directions may leave
   the solid on both sides. */
static bool is_crossed_nearby(const Verifier *verifier, const double center[3], double radius,
                              double distance, const double normal[3])
{
    double far = verifier->error - radius, gradient[3];
    return is_crossed(verifier, center, far, normal) ||
           (field_normal(verifier->field, center, 1e-3 * verifier->error, gradient) &&
            is_crossed(verifier, center, far, gradient)) ||
           is_other_side_around(verifier, center, distance, far, 0);
}

static bool triangle_is_near_surface(Verifier *verifier, const double corners[3][3],
                                     const double normal[3])
{
    double error = verifier->error, center[3], radius = 0;
    for (int k = 0; k < 3; k++)
        center[k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3;
    for (int i = 0; i < 3; i++)
        radius = max2(radius, ROUNDING * distance3(center, corners[i]));
    double distance = field_distance(verifier->field, center);
    if (--verifier->budget < 0 || fabs(distance) > error)
        return false;
    if (radius <= 0.5 * error && is_crossed_nearby(verifier, center, radius, distance, normal))
        return true;
    if (radius > 0.5 * error) {
        Lens lens = {.radius = radius};
        memcpy(lens.center, center, sizeof lens.center);
        memcpy(lens.normal, normal, sizeof lens.normal);
        if (find_lens_by_balls(verifier, &lens))
            return true;
        Nearness nearness = find_nearness(verifier, corners, center, radius, distance);
        if (nearness != NOT_KNOWN)
            return nearness == NEAR_SURFACE;
    }
    return radius > TINY_TRIANGLE * error && parts_are_near_surface(verifier, corners, normal);
}

static bool triangles_are_near_surface(Verifier *verifier, const Tet *tet)
{
    const Bvh *mesh = verifier->mesh;
    for (uint32_t i = tet->first_triangle; i < tet->first_triangle + tet->triangle_count; i++) {
        double corners[3][3], edges[2][3], normal[3];
        for (int c = 0; c < 3; c++)
            memcpy(corners[c], mesh->vertices[mesh->triangles[i][c]], sizeof corners[c]);
        add_scaled3(edges[0], corners[1], -1, corners[0]);
        add_scaled3(edges[1], corners[2], -1, corners[0]);
        cross3(edges[0], edges[1], normal);
        normalize3(normal);
        if (!triangle_is_near_surface(verifier, (const double(*)[3])corners, normal))
            return false;
    }
    return true;
}

/* Returns 1 if the mesh has all corners outside, -1 if inside, 0 if it goes through. */
static int find_side(const Tets *tets, const Tet *tet)
{
    int inside = 0;
    for (int i = 0; i < 4; i++)
        inside += point_is_inside(tets, tet->points[i]);
    return inside == 0 ? 1 : inside == 4 ? -1 : 0;
}

/* Returns how many cells a proof may try: enough to cover a surface by cells of the error.  What
   needs more is better bisected. */
static double proof_budget(const Verifier *verifier, const Tet *tet)
{
    static const double CELLS = 64, CELLS_OF_SQUARE = 32;
    double              squares = tets_longest_edge(verifier->tets, tet) / verifier->error;
    squares *= squares;
    return squares < 4 ? INFINITY : CELLS + CELLS_OF_SQUARE * squares;
}

/* Verifies a tetrahedron whose box has surface, which the field has entered. */
static TetState verify_parts(Verifier *verifier, const Tet *tet, const Cell *whole, int side)
{
    verifier->asked_in_vain = 0;
    verifier->unresolved    = 0;
    verifier->budget        = proof_budget(verifier, tet);
    bool near = (tet->state == TET_FITS || triangles_are_near_surface(verifier, tet)) &&
                surface_is_near_mesh(verifier, whole, side);
    if (!near && (tets_longest_edge(verifier->tets, tet) > 0.5 * verifier->error ||
                  may_be_sharper(verifier, tet)))
        return TET_REFUTED;
    return !near || verifier->unresolved > 0 ? TET_UNRESOLVED : TET_PROVEN;
}

/* Verifies a tetrahedron.  Small ones need no proof where the mesh goes through, for so does the
   surface. */
TetState verify_tet(Verifier *verifier, Tet *tet)
{
    int  side  = find_side(verifier->tets, tet);
    Cell whole = {.tag = tet->tag, .lens = INFINITY};
    bool moved = tets_is_moved(verifier->tets, tet);
    if (side == 0 && !moved && tets_longest_edge(verifier->tets, tet) <= verifier->error)
        return TET_PROVEN;
    tets_corners(verifier->tets, tet, whole.corners);
    Box box = corners_box((const double(*)[3])whole.corners, 4, verifier->error);
    if (!field_enter(verifier->field, box))
        return side == 0 && moved ? TET_UNRESOLVED : TET_EMPTY;
    tet->needs    = mark_box_none();
    verifier->tet = tet;
    corners_ball((const double(*)[3])whole.corners, verifier->center);
    memcpy(verifier->location, verifier->center, sizeof verifier->location);
    TetState state = verify_parts(verifier, tet, &whole, side);
    field_leave(verifier->field);
    return state;
}
