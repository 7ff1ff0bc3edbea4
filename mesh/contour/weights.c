/* weights.c: barycentric coordinates by areas and volumes. */
#include "mesh/contour/weights.h"

#include "compiler/base/vec.h"

/* Part of a face or a tetrahedron along its border where no vertex is, so that no vertices
   coincide. */
static const double END_OF_BODY = 0.02;

void keep_inside(const double *weights, const double *inner, int count, double point[3],
                 const double center[3])
{
    double share = 1;
    for (int i = 0; i < count; i++)
        if (weights[i] < END_OF_BODY)
            share = min2(share, max2(0, (inner[i] - END_OF_BODY) / (inner[i] - weights[i])));
    for (int k = 0; k < 3; k++)
        point[k] = center[k] + share * (point[k] - center[k]);
}

bool solve3(const double rows[3][3], const double right[3], double point[3])
{
    double cross[3][3];
    for (int i = 0; i < 3; i++)
        cross3(rows[(i + 1) % 3], rows[(i + 2) % 3], cross[i]);
    double volume = dot3(rows[0], cross[0]);
    if (fabs(volume) < 1e-3)
        return false;
    for (int k = 0; k < 3; k++)
        point[k] = (right[0] * cross[0][k] + right[1] * cross[1][k] + right[2] * cross[2][k]) /
                   volume;
    return true;
}

void face_weights(const double corners[3][3], const double normal[3], const double point[3],
                  double weights[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double edge[3], to_point[3], product[3];
        add_scaled3(edge, corners[(i + 2) % 3], -1, corners[(i + 1) % 3]);
        add_scaled3(to_point, point, -1, corners[(i + 1) % 3]);
        cross3(edge, to_point, product);
        weights[i] = dot3(product, normal);
        sum += weights[i];
    }
    for (int i = 0; i < 3; i++)
        weights[i] /= sum;
}

void tet_weights(const double corners[4][3], const double point[3], double weights[4])
{
    double edges[3][3], offset[3], cross[3];
    for (int i = 0; i < 3; i++)
        add_scaled3(edges[i], corners[i + 1], -1, corners[0]);
    add_scaled3(offset, point, -1, corners[0]);
    weights[0] = 1;
    for (int i = 0; i < 3; i++) {
        cross3(edges[(i + 1) % 3], edges[(i + 2) % 3], cross);
        weights[i + 1] = dot3(offset, cross) / dot3(edges[i], cross);
        weights[0] -= weights[i + 1];
    }
}
