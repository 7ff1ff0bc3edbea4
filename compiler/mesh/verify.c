/*
 * verify.c: proofs by balls: where the distance at a point is d, the ball of radius |d| around it has no
 * surface in it.
 *
 * A part of space is near enough to the mesh if it is within the error of it.  That takes as many
 * parts as there are squares of the error on the surface, so flat places have a shorter proof: a
 * large ball outside and one inside that nearly touch leave a thin lens between them, and the
 * surface is in it.  Both ask for bounds only; that distances are exact makes them quick, not true.
 */
#include "compiler/mesh/verify.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { MOST_UNRESOLVED = 16, MOST_HALVINGS = 80 };
/* Parts of the error: what is smaller is not divided further. */
static const double TINY_CELL = 0.25, TINY_TRIANGLE = 0.125;
static const double ROUNDING = 1 + 1e-9;

bool verify_is_empty(const Verifier *verifier, const Tet *tet)
{
    double corners[4][3], center[3];
    tets_corners(verifier->tets, tet, corners);
    for (int i = 0; i < 4; i++) {
        double radius = 0;
        for (int j = 0; j < 4; j++)
            radius = fmax(radius, distance3(corners[i], corners[j]));
        if (fabs(verifier->tets->points.items[tet->points[i]].distance) > ROUNDING * radius)
            return true;
    }
    double radius = corners_ball((const double(*)[3])corners, center);
    return fabs(field_distance(verifier->field, center)) > ROUNDING * radius;
}

/* ---- lenses ---- */

/* A disc of some radius; within that of its axis, and as far from its plane as the balls reach, all is
   outside above `above` and inside below -`below`. */
typedef struct Lens {
    double center[3], normal[3], radius, above, below;
} Lens;

/* How high above the disc the surface may be, if the ball around a point above it has no surface. */
static double height_under_ball(double height, double ball, double radius)
{
    return ball > ROUNDING * radius ? height - sqrt(ball * ball - ROUNDING * radius * radius)
                                    : INFINITY;
}

/* Finds heights by balls whose centres are so far from the disc. */
static bool find_lens(const Verifier *verifier, double far, Lens *lens)
{
    double point[3];
    add_scaled3(point, lens->center, far, lens->normal);
    lens->above = height_under_ball(far, field_distance(verifier->field, point), lens->radius);
    if (!(lens->above < verifier->error))
        return false;
    add_scaled3(point, lens->center, -far, lens->normal);
    lens->below = height_under_ball(far, -field_distance(verifier->field, point), lens->radius);
    return lens->below < verifier->error;
}

/* So far that a lens under flat surfaces has half of the error. */
static double lens_distance(const Verifier *verifier, double radius)
{
    return fmax(radius * radius / verifier->error, 2 * radius);
}

/* The triangles that are near to a lens. */
typedef struct LensMesh {
    const Lens *lens;
    double      error;
    bool        pierced; /* its axis meets one */
} LensMesh;

static bool axis_meets(const Lens *lens, const double corners[3][3])
{
    double turns[3];
    for (int i = 0; i < 3; i++) {
        double from[3], to[3], cross[3];
        add_scaled3(from, corners[i], -1, lens->center);
        add_scaled3(to, corners[(i + 1) % 3], -1, lens->center);
        cross3(from, to, cross);
        turns[i] = dot3(cross, lens->normal);
    }
    return turns[0] >= 0 && turns[1] >= 0 && turns[2] >= 0;
}

/* A triangle must face as the lens does and be within the error of all that is in the lens, or be
   farther away than that. */
static bool fits_lens(void *user, uint32_t triangle, const double corners[3][3])
{
    static const double STEEPEST = 0.3; /* least cosine between the normals */
    LensMesh           *mesh     = user;
    const Lens         *lens     = mesh->lens;
    double              edges[2][3], normal[3], offset[3], low = INFINITY, high = -INFINITY;
    (void)triangle;
    for (int i = 0; i < 3; i++) {
        add_scaled3(offset, corners[i], -1, lens->center);
        low  = fmin(low, dot3(offset, lens->normal));
        high = fmax(high, dot3(offset, lens->normal));
    }
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    double cosine = normalize3(normal) ? dot3(normal, lens->normal) : 0;
    if (cosine > 0) {
        double middle = dot3(normal, offset) / cosine;
        double rise   = lens->radius * sqrt(fmax(0, 1 - cosine * cosine)) / cosine;
        low           = fmax(low, middle - rise);
        high          = fmin(high, middle + rise);
    }
    double farthest = 2 * mesh->error;
    if (low > farthest || high < -farthest)
        return true;
    mesh->pierced = mesh->pierced || axis_meets(lens, corners);
    return cosine >= STEEPEST && high + lens->below <= mesh->error &&
           lens->above - low <= mesh->error;
}

/* Whether the mesh goes through the lens: then it is a graph over all of its disc, since it is closed
   and its triangles all face to one side.  So it is as near as it is at any point. */
static bool mesh_fills_lens(const Verifier *verifier, const Lens *lens)
{
    LensMesh mesh  = {.lens = lens, .error = verifier->error};
    double   reach = hypot(lens->radius, 2 * verifier->error);
    return bvh_visit(verifier->mesh, lens->center, reach, fits_lens, &mesh) && mesh.pierced;
}

/* ---- from the surface to the mesh ---- */

/* Whether all corners are above the lens, or all below. */
static bool is_beside_lens(const Lens *lens, const double corners[4][3])
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 4; i++) {
        double offset[3];
        add_scaled3(offset, corners[i], -1, lens->center);
        low  = fmin(low, dot3(offset, lens->normal));
        high = fmax(high, dot3(offset, lens->normal));
    }
    return low > lens->above || high < -lens->below;
}

/* A direction in which the distance grows; it need not be exact. */
static bool find_slope(const Verifier *verifier, const double center[3], double distance,
                       double direction[3])
{
    for (int k = 0; k < 3; k++) {
        double aside[3] = {center[0], center[1], center[2]};
        aside[k] += 1e-3 * verifier->error;
        direction[k] = field_distance(verifier->field, aside) - distance;
    }
    return normalize3(direction);
}

static bool is_flat(const Verifier *verifier, const double corners[4][3], const double center[3],
                    double radius, double distance)
{
    Lens lens = {.radius = radius};
    if (!find_slope(verifier, center, distance, lens.normal))
        return false;
    add_scaled3(lens.center, center, -distance, lens.normal);
    return find_lens(verifier, lens_distance(verifier, radius), &lens) &&
           (is_beside_lens(&lens, corners) || mesh_fills_lens(verifier, &lens));
}

/* At a place that is farther from the mesh than permitted, and nearer to the surface: goes on through
   the surface.  False: there is another side, so the mesh is wrong. */
static bool leave_unresolved(Verifier *verifier, const double center[3], double distance)
{
    double normal[3], beyond[3];
    double step = fabs(distance) + 0.5 * verifier->error;
    if (field_normal(verifier->field, center, 1e-3 * verifier->error, normal)) {
        add_scaled3(beyond, center, distance < 0 ? step : -step, normal);
        if ((field_distance(verifier->field, beyond) < 0) != (distance < 0))
            return false;
    }
    verifier->unresolved++;
    return true;
}

/* A part of a tetrahedron. */
typedef struct Cell {
    double corners[4][3];
    int    tag, halvings;
    double lens; /* largest radius for which a lens is worth a try */
} Cell;

/* `side` is -1 or 1 if the mesh leaves all of the tetrahedron inside or outside, else 0. */
static bool surface_is_near_mesh(Verifier *verifier, const Cell *cell, int side)
{
    double center[3], error = verifier->error, lens = cell->lens;
    double radius = ROUNDING * corners_ball(cell->corners, center);
    if (--verifier->budget < 0)
        return false;
    if (radius < error && bvh_is_near(verifier->mesh, center, error - radius))
        return true;
    double distance = field_distance(verifier->field, center);
    if (side * distance < -error)
        return false;
    if (fabs(distance) > radius || verifier->unresolved >= MOST_UNRESOLVED)
        return true;
    if (radius > error && radius <= lens) {
        if (is_flat(verifier, cell->corners, center, radius, distance))
            return true;
        lens = 0.7 * radius;
    }
    if (radius < TINY_CELL * error || cell->halvings == MOST_HALVINGS)
        return leave_unresolved(verifier, center, distance);
    Cell first = {.halvings = cell->halvings + 1, .lens = lens}, second = first;
    first.tag = second.tag = bisect_corners(cell->corners, cell->tag, first.corners,
                                            second.corners);
    return surface_is_near_mesh(verifier, &first, side) &&
           surface_is_near_mesh(verifier, &second, side);
}

/* ---- from the mesh to the surface ---- */

/* Whether the surface is between two points on both sides of a third. */
static bool is_crossed(const Verifier *verifier, const double center[3], double far,
                       const double direction[3])
{
    double above[3], below[3];
    add_scaled3(above, center, far, direction);
    add_scaled3(below, center, -far, direction);
    return field_distance(verifier->field, above) >= 0 &&
           field_distance(verifier->field, below) < 0;
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

static bool triangle_is_near_surface(Verifier *verifier, const double corners[3][3],
                                     const double normal[3])
{
    double error = verifier->error, center[3], radius = 0, gradient[3];
    for (int k = 0; k < 3; k++)
        center[k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3;
    for (int i = 0; i < 3; i++)
        radius = fmax(radius, ROUNDING * distance3(center, corners[i]));
    if (--verifier->budget < 0 || fabs(field_distance(verifier->field, center)) > error)
        return false;
    if (radius <= 0.5 * error && (is_crossed(verifier, center, error - radius, normal) ||
                                  (field_normal(verifier->field, center, 1e-3 * error, gradient) &&
                                   is_crossed(verifier, center, error - radius, gradient))))
        return true;
    Lens lens = {.radius = radius};
    memcpy(lens.center, center, sizeof lens.center);
    memcpy(lens.normal, normal, sizeof lens.normal);
    if (radius > 0.5 * error && find_lens(verifier, lens_distance(verifier, radius), &lens))
        return true;
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

/* 1: the mesh has all corners outside; -1: inside; 0: it goes through. */
static int find_side(const Tets *tets, const Tet *tet)
{
    int inside = 0;
    for (int i = 0; i < 4; i++)
        inside += point_is_inside(tets, tet->points[i]);
    return inside == 0 ? 1 : inside == 4 ? -1 : 0;
}

/* Enough to cover a surface that goes through by cells of the error; who needs more is better off with
   a finer mesh. */
static double proof_budget(const Verifier *verifier, const Tet *tet)
{
    static const double CELLS = 64, CELLS_OF_SQUARE = 32;
    double              squares = tets_longest_edge(verifier->tets, tet) / verifier->error;
    squares *= squares;
    return squares < 4 ? INFINITY : CELLS + CELLS_OF_SQUARE * squares;
}

/* Small ones need no proof where the mesh goes through: so does the surface.  They are not made smaller. */
TetState verify_tet(Verifier *verifier, const Tet *tet)
{
    double length = tets_longest_edge(verifier->tets, tet);
    int    side   = find_side(verifier->tets, tet);
    if (side == 0 && length <= verifier->error)
        return TET_PROVEN;
    if (verify_is_empty(verifier, tet))
        return TET_EMPTY;
    Cell whole = {.tag = tet->tag, .lens = INFINITY};
    tets_corners(verifier->tets, tet, whole.corners);
    verifier->unresolved = 0;
    verifier->budget     = proof_budget(verifier, tet);
    bool near            = triangles_are_near_surface(verifier, tet) &&
                surface_is_near_mesh(verifier, &whole, side);
    if (!near && length > 0.5 * verifier->error)
        return TET_REFUTED;
    return !near || verifier->unresolved > 0 ? TET_UNRESOLVED : TET_PROVEN;
}
