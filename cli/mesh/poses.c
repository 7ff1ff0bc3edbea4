/* poses.c: where copies are, as nodes of glTF have it. */
#include "cli/mesh/poses.h"

#include <math.h>

#include "compiler/base/vec.h"

bool mesh_is_reflection(const double matrix[3][4])
{
    double cross[3];
    cross3(matrix[0], matrix[1], cross);
    return dot3(cross, matrix[2]) < 0;
}

/* Finds the quaternion of a rotation (Shepperd's method). */
static void find_rotation(const double m[3][3], double q[4])
{
    double trace = m[0][0] + m[1][1] + m[2][2], most = trace;
    int    which = 3;
    for (int k = 0; k < 3; k++)
        if (m[k][k] > most) {
            most  = m[k][k];
            which = k;
        }
    int i = which % 3, j = (i + 1) % 3, k = (i + 2) % 3;
    if (which == 3) {
        q[3] = 1 + trace;
        for (int n = 0; n < 3; n++)
            q[n] = m[(n + 2) % 3][(n + 1) % 3] - m[(n + 1) % 3][(n + 2) % 3];
    } else {
        q[i] = 1 + 2 * m[i][i] - trace;
        q[j] = m[j][i] + m[i][j];
        q[k] = m[k][i] + m[i][k];
        q[3] = m[k][j] - m[j][k];
    }
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int n = 0; n < 4; n++)
        q[n] /= length;
}

void mesh_pose_of(const double matrix[3][4], MeshPose *pose)
{
    double rotation[3][3];
    pose->mirrored = mesh_is_reflection(matrix);
    pose->scale    = length3(matrix[0]);
    for (int i = 0; i < 3; i++) {
        pose->translation[i] = matrix[i][3];
        for (int k = 0; k < 3; k++)
            rotation[i][k] = (pose->mirrored && k == 0 ? -1 : 1) * matrix[i][k] / pose->scale;
    }
    find_rotation((const double(*)[3])rotation, pose->rotation);
}

void mesh_pose_between(const MeshPose *a, const MeshPose *b, double share, MeshPose *between)
{
    static const double PARALLEL = 1 - 1e-9; /* as cosine: sines are 0 there */
    double              cosine = 0, shares[2] = {1 - share, share}, length = 0;
    for (int n = 0; n < 4; n++)
        cosine += a->rotation[n] * b->rotation[n];
    if (fabs(cosine) < PARALLEL) {
        double angle = acos(fabs(cosine));
        shares[0]    = sin((1 - share) * angle) / sin(angle);
        shares[1]    = sin(share * angle) / sin(angle);
    }
    for (int n = 0; n < 4; n++) {
        between->rotation[n] = shares[0] * a->rotation[n] +
                               (cosine < 0 ? -1 : 1) * shares[1] * b->rotation[n];
        length += between->rotation[n] * between->rotation[n];
    }
    for (int n = 0; n < 4; n++)
        between->rotation[n] /= sqrt(length);
    for (int k = 0; k < 3; k++)
        between->translation[k] = (1 - share) * a->translation[k] + share * b->translation[k];
    between->scale    = (1 - share) * a->scale + share * b->scale;
    between->mirrored = a->mirrored;
}

/* Computes v + 2 w (u x v) + 2 u x (u x v) of the quaternion (u, w). */
void mesh_pose_apply(const MeshPose *pose, const double point[3], double image[3])
{
    const double v[3] = {(pose->mirrored ? -1 : 1) * pose->scale * point[0], pose->scale * point[1],
                         pose->scale * point[2]};
    const double *u   = pose->rotation;
    double        once[3], twice[3];
    cross3(u, v, once);
    cross3(u, once, twice);
    for (int k = 0; k < 3; k++)
        image[k] = v[k] + 2 * u[3] * once[k] + 2 * twice[k] + pose->translation[k];
}
