/*
 * cut.c: what is cut away to look inside.
 */
#include "live/cut.h"

#include <math.h>
#include <string.h>

#include "krs/camera.h"

/* Radius of the ball that stands for a plane, in sizes of the scene.  Over one size it deviates from a
   plane by a thousandth of it; single precision still tells a ten thousandth. */
#define ROUNDNESS 500

void cut_face(Cut *cut, const KrsCamera *camera, const double point[3])
{
    double forward[3], right[3], up[3];
    krs_camera_axes(camera, forward, right, up);
    for (int i = 0; i < 3; i++)
        cut->normal[i] = -forward[i];
    memcpy(cut->point, point, sizeof cut->point);
    cut->plane = true;
}

/* Returns the height of the picture where a point is. */
static double height_at(const KrsCamera *camera, const double forward[3], const double point[3])
{
    double depth = 0;
    if (camera->projection == KRS_ORTHOGRAPHIC)
        return camera->height;
    for (int i = 0; i < 3; i++)
        depth += (point[i] - camera->eye[i]) * forward[i];
    return 2 * fabs(depth) * tan(camera->fov / 2);
}

void cut_drag(Cut *cut, const KrsCamera *camera, double right, double up)
{
    double forward[3], side[3], top[3];
    krs_camera_axes(camera, forward, side, top);
    if (cut->ball) {
        const double height = height_at(camera, forward, cut->center);
        for (int i = 0; i < 3; i++)
            cut->center[i] += height * (right * side[i] + up * top[i]);
    } else if (cut->plane) {
        /* Up is towards the viewer. */
        const double height = height_at(camera, forward, cut->point);
        for (int i = 0; i < 3; i++)
            cut->point[i] += height * up * cut->normal[i];
    }
}

size_t cut_zones(const Cut *cut, double (*zones)[4], size_t count)
{
    const double radius = ROUNDNESS * cut->size;
    if (cut->plane && count < KRS_MAX_ZONES) {
        for (int i = 0; i < 3; i++)
            zones[count][i] = cut->point[i] + radius * cut->normal[i];
        zones[count++][3] = radius;
    }
    if (cut->ball && count < KRS_MAX_ZONES) {
        memcpy(zones[count], cut->center, sizeof cut->center);
        zones[count++][3] = cut->radius;
    }
    return count;
}
