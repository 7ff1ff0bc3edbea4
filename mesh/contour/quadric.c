/* quadric.c: solves least squares in three unknowns by the eigenvectors of the normal equations. */
#include "mesh/contour/quadric.h"

#include <string.h>

#include "compiler/base/vec.h"

/* Makes m[p][q] 0 by a Jacobi rotation of a symmetric matrix; the columns of v become its
   eigenvectors. */
static void rotate_to_diagonal(double m[3][3], double v[3][3], int p, int q)
{
    if (m[p][q] == 0)
        return;
    double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    double t     = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; k++) {
        double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b;
        m[k][q] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b;
        m[q][k] = s * a + c * b;
        a       = v[k][p];
        b       = v[k][q];
        v[k][p] = c * a - s * b;
        v[k][q] = s * a + c * b;
    }
}

static void find_eigenvectors(double m[3][3], double v[3][3])
{
    enum { SWEEPS = 10 };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            v[i][j] = i == j;
    for (int i = 0; i < SWEEPS; i++) {
        rotate_to_diagonal(m, v, 0, 1);
        rotate_to_diagonal(m, v, 0, 2);
        rotate_to_diagonal(m, v, 1, 2);
    }
}

void quadric_point(const double (*points)[3], const double (*normals)[3], size_t count,
                   double point[3])
{
    static const double FREE = 0.01; /* part of the largest eigenvalue below which none counts */
    double middle[3] = {0, 0, 0}, m[3][3] = {{0}}, v[3][3], right[3] = {0, 0, 0}, largest = 0;
    for (size_t i = 0; i < count; i++)
        add_scaled3(middle, middle, 1 / (double)count, points[i]);
    for (size_t i = 0; i < count; i++) {
        double offset[3];
        add_scaled3(offset, points[i], -1, middle);
        add_scaled3(right, right, dot3(normals[i], offset), normals[i]);
        for (int j = 0; j < 3; j++)
            add_scaled3(m[j], m[j], normals[i][j], normals[i]);
    }
    find_eigenvectors(m, v);
    for (int k = 0; k < 3; k++)
        largest = max2(largest, m[k][k]);
    memcpy(point, middle, sizeof middle);
    for (int k = 0; k < 3; k++) {
        double axis[3] = {v[0][k], v[1][k], v[2][k]};
        if (m[k][k] > FREE * largest)
            add_scaled3(point, point, dot3(axis, right) / m[k][k], axis);
    }
}
