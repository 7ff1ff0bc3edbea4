/*
 * poses.h: where copies are, as nodes of glTF have it.
 */
#ifndef KRS_MESH_POSES_H
#define KRS_MESH_POSES_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A similarity: what is placed is mirrored in the plane x = 0, if it is, then scaled, rotated and
   moved. */
typedef struct MeshPose {
    double translation[3];
    double rotation[4]; /* a unit quaternion x, y, z, w */
    double scale;
    bool   mirrored;
} MeshPose;

/* Tells whether a transform mirrors what it places. */
bool mesh_is_reflection(const double matrix[3][4]);
/* Finds the pose of a matrix that moves, rotates, mirrors and scales evenly. */
void mesh_pose_of(const double matrix[3][4], MeshPose *pose);
/* Interpolates two keyframes, which mirror both or none: lengths by the share, and the shorter way
   of the rotation at an even speed (glTF 2.0, appendix C). */
void mesh_pose_between(const MeshPose *a, const MeshPose *b, double share, MeshPose *between);
void mesh_pose_apply(const MeshPose *pose, const double point[3], double image[3]);

#ifdef __cplusplus
}
#endif

#endif
