/* snap.c: moves vertices of faces and tetrahedra to the surface by Newton's steps. */
#include "mesh/contour/snap.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "mesh/contour/weights.h"

static void snapping_weights(const Snapping *snapping, const double point[3], double weights[4])
{
    if (snapping->across)
        face_weights(snapping->corners, snapping->across, point, weights);
    else
        tet_weights(snapping->corners, point, weights);
}

static void keep_snapping(const Snapping *snapping, double point[3])
{
    double weights[4], inner[4];
    snapping_weights(snapping, point, weights);
    snapping_weights(snapping, snapping->middle, inner);
    keep_inside(weights, inner, snapping->count, point, snapping->middle);
}

/* Goes along the gradient, or its part in the face, to where the value is 0; *value is that at
   `at`.  Where planes meet beyond a rounded edge this is a point of the edge. */
static void snap(const MeshField *field, const Snapping *snapping, double at[3], double *value)
{
    enum { TRIES = 2 };
    static const double NEAR_ENOUGH = 0.02; /* parts of the error */
    const double        step        = 1e-3 * snapping->error;
    for (int i = 0; i < TRIES && fabs(*value) > NEAR_ENOUGH * snapping->error; i++) {
        double points[4][3], values[4], gradient[3], next[3];
        for (int k = 0; k < 3; k++) {
            memcpy(points[k], at, sizeof points[k]);
            points[k][k] += step;
        }
        field_distances(field, (const double(*)[3])points, 3, values);
        for (int k = 0; k < 3; k++)
            gradient[k] = (values[k] - *value) / step;
        if (snapping->across)
            add_scaled3(gradient, gradient, -dot3(gradient, snapping->across), snapping->across);
        double square = dot3(gradient, gradient);
        if (square < 1e-2)
            return;
        add_scaled3(next, at, -*value / square, gradient);
        keep_snapping(snapping, next);
        double there = field_distance(field, next);
        if (!(fabs(there) < fabs(*value))) /* also where it is NaN */
            return;
        memcpy(at, next, sizeof next);
        *value = there;
    }
}

bool snap_nearby(const MeshField *field, const Snapping *snapping, bool guess, double at[3],
                 double *value)
{
    const double enough = 0.5 * fabs(snapping->missed);
    if (guess) {
        keep_snapping(snapping, at);
        *value = field_distance(field, at);
        snap(field, snapping, at, value);
        if (fabs(*value) < enough)
            return true;
    }
    memcpy(at, snapping->middle, 3 * sizeof *at);
    *value = snapping->missed;
    snap(field, snapping, at, value);
    return fabs(*value) < enough;
}

double max_off(const MeshField *field, const double at[3], const double *const *others,
               size_t count)
{
    double middles[MAX_FIELD_POINTS][3], values[MAX_FIELD_POINTS], most = 0;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            middles[i][k] = 0.5 * (at[k] + others[i][k]);
    field_distances(field, (const double(*)[3])middles, count, values);
    for (size_t i = 0; i < count; i++)
        most = max2(most, fabs(values[i]));
    return most;
}
