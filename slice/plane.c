/* plane.c: evaluates the distance in a plane, by lanes. */
#include "slice/plane.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/field/gradient.h"
#include "compiler/field/roots.h"

void krs_plane_axes(const KrsSectionPlane *plane, double right[3], double up[3])
{
    static const double upright[3] = {0, 1, 0}, across[3] = {1, 0, 0};
    double              normal[3];
    memcpy(normal, plane->normal, sizeof normal);
    normalize3(normal);
    cross3(upright, normal, right);
    if (length3(right) < 1e-9 || !normalize3(right)) {
        add_scaled3(right, across, -dot3(across, normal), normal);
        normalize3(right);
    }
    cross3(normal, right, up);
    for (int k = 0; k < 3; k++) { /* no -0 */
        right[k] += 0.0;
        up[k] += 0.0;
    }
}

SlicePlane slice_plane(const KrsSectionPlane *plane)
{
    static const double nowhere[3] = {0, 0, 0};
    SlicePlane          result;
    double              normal[3];
    memcpy(normal, plane->normal, sizeof normal);
    normalize3(normal);
    krs_plane_axes(plane, result.right, result.up);
    add_scaled3(result.origin, nowhere, dot3(plane->point, normal), normal);
    return result;
}

Box slice_box(const SlicePlane *plane, const double low[2], const double high[2], double margin)
{
    double corners[4][3];
    for (int i = 0; i < 4; i++)
        slice_point(plane, (double[2]){i % 2 ? high[0] : low[0], i / 2 ? high[1] : low[1]},
                    corners[i]);
    return corners_box((const double(*)[3])corners, 4, margin);
}

void slice_distances(const MeshField *field, const SlicePlane *plane, const double (*points)[2],
                     size_t count, double *distances)
{
    double in_space[MAX_FIELD_POINTS][3];
    for (size_t i = 0; i < count; i++)
        slice_point(plane, points[i], in_space[i]);
    field_distances(field, (const double(*)[3])in_space, count, distances);
}

/* Returns where the line through both ends of the bracket is 0: the first step on a flat face finds
   the root but for rounding, and may leave the other end far away. */
static double root_of(const RootSearch *search)
{
    double at_low = search->at_low, at_high = search->at_high;
    bool   known = isfinite(at_low) && isfinite(at_high) && at_low != at_high;
    double part  = known ? at_low / (at_low - at_high) : 0.5;
    return search->low + (search->high - search->low) * part;
}

void slice_roots(const MeshField *field, const SlicePlane *plane, PlaneRoot *roots, size_t count,
                 double enough)
{
    RootSearch searches[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++) {
        RootSearch *search = &searches[i];
        double      to[3];
        *search = (RootSearch){.at_low = roots[i].at_inside, .at_high = roots[i].at_outside};
        slice_point(plane, roots[i].inside, search->from);
        slice_point(plane, roots[i].outside, to);
        add_scaled3(search->along, to, -1, search->from);
        search->high   = 1;
        search->length = length3(search->along);
    }
    find_roots(field, searches, count, enough);
    for (size_t i = 0; i < count; i++) {
        double part = root_of(&searches[i]);
        for (int k = 0; k < 2; k++)
            roots[i].at[k] = roots[i].inside[k] + part * (roots[i].outside[k] - roots[i].inside[k]);
    }
}

void slice_gradients(const MeshField *field, const SlicePlane *plane, const double (*points)[2],
                     double step, double (*gradients)[2])
{
    double beside[8][2], distances[8];
    for (int i = 0; i < 8; i++) {
        memcpy(beside[i], points[i / 4], sizeof beside[i]);
        beside[i][i / 2 % 2] += i % 2 ? step : -step;
    }
    slice_distances(field, plane, (const double(*)[2])beside, 8, distances);
    for (int i = 0; i < 4; i++)
        gradients[i / 2][i % 2] = (distances[2 * i + 1] - distances[2 * i]) / (2 * step);
}
