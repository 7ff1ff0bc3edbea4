/*
 * camera_moves.c: moves a camera as a mouse and keys do.
 */
#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "krs/camera.h"

#include <math.h>
#include <string.h>

/* The cosine up to which the line of sight may come near to the upright direction. */
#define MAX_UPRIGHT 0.9995
/* No zoom goes nearer to its point, in parts of its distance. */
#define MIN_FACTOR 1e-3

/* Scales a vector to length 1, unless it is 0. */
static void normalize(double v[3])
{
    const double size = length3(v);
    for (int i = 0; size > 0 && i < 3; i++)
        v[i] /= size;
}

/* Rotates a vector around a unit axis (Rodrigues). */
static void rotate(double v[3], const double axis[3], double angle)
{
    double       side[3];
    const double along = dot3(axis, v) * (1 - real_cos(angle));
    cross3(axis, v, side);
    for (int i = 0; i < 3; i++)
        v[i] = v[i] * real_cos(angle) + side[i] * real_sin(angle) + axis[i] * along;
}

static double distance(const KrsCamera *camera)
{
    double sight[3];
    for (int i = 0; i < 3; i++)
        sight[i] = camera->target[i] - camera->eye[i];
    return length3(sight);
}

/* Returns the height of the picture at the target, in world units. */
static double height_at_target(const KrsCamera *camera)
{
    return camera->projection == KRS_ORTHOGRAPHIC
               ? camera->height
               : 2 * distance(camera) * real_tan(camera->fov / 2);
}

void krs_camera_axes(const KrsCamera *camera, double forward[3], double right[3], double up[3])
{
    for (int i = 0; i < 3; i++)
        forward[i] = camera->target[i] - camera->eye[i];
    normalize(forward);
    cross3(forward, camera->up, right);
    normalize(right);
    cross3(right, forward, up);
}

/* Returns the angle upwards that leaves the line of sight off the upright direction. */
static double limit_up(const double forward[3], const double upright[3], double angle)
{
    const double most  = real_acos(MAX_UPRIGHT);
    const double above = real_acos(
        fmin(fmax(dot3(forward, upright), -1), 1)); /* angle from the top */
    return fmin(fmax(angle, above - (M_PI - most)), above - most);
}

/* Rotates a line of sight to the right, around the upright direction, and upwards. */
static void rotate_sight(const KrsCamera *camera, double sight[3], double right, double up)
{
    double upright[3], forward[3], side[3], top[3];
    memcpy(upright, camera->up, sizeof upright);
    normalize(upright);
    krs_camera_axes(camera, forward, side, top);
    rotate(sight, side, limit_up(forward, upright, up));
    rotate(sight, upright, -right);
}

void krs_camera_orbit(KrsCamera *camera, double right, double up)
{
    double sight[3];
    for (int i = 0; i < 3; i++)
        sight[i] = camera->target[i] - camera->eye[i];
    rotate_sight(camera, sight, right, up);
    for (int i = 0; i < 3; i++)
        camera->eye[i] = camera->target[i] - sight[i];
}

void krs_camera_look(KrsCamera *camera, double right, double up)
{
    double sight[3];
    for (int i = 0; i < 3; i++)
        sight[i] = camera->target[i] - camera->eye[i];
    rotate_sight(camera, sight, right, up);
    for (int i = 0; i < 3; i++)
        camera->target[i] = camera->eye[i] + sight[i];
}

static void shift(KrsCamera *camera, double factor, const double direction[3])
{
    add_scaled3(camera->eye, camera->eye, factor, direction);
    add_scaled3(camera->target, camera->target, factor, direction);
}

void krs_camera_pan(KrsCamera *camera, double right, double up)
{
    double       forward[3], side[3], top[3];
    const double height = height_at_target(camera);
    krs_camera_axes(camera, forward, side, top);
    shift(camera, -right * height, side);
    shift(camera, -up * height, top);
}

void krs_camera_dolly(KrsCamera *camera, const double *point, double factor)
{
    double target[3];
    factor = fmax(factor, MIN_FACTOR);
    memcpy(target, point ? point : camera->target, sizeof target);
    for (int i = 0; i < 3; i++) {
        camera->eye[i]    = target[i] + factor * (camera->eye[i] - target[i]);
        camera->target[i] = target[i] + factor * (camera->target[i] - target[i]);
    }
    camera->height *= factor;
    camera->focus *= factor;
}

void krs_camera_fly(KrsCamera *camera, double forward, double right, double up)
{
    double       ahead[3], side[3], top[3];
    const double size = distance(camera);
    krs_camera_axes(camera, ahead, side, top);
    shift(camera, forward * size, ahead);
    shift(camera, right * size, side);
    shift(camera, up * size, top);
}

void krs_camera_roll(KrsCamera *camera, double angle)
{
    double forward[3], side[3], top[3];
    krs_camera_axes(camera, forward, side, top);
    rotate(top, forward, angle);
    memcpy(camera->up, top, sizeof top);
}

/* Tells how far the eye must be from the center of a box, for each of its corners to be in the picture. */
static double distance_for(const KrsCamera *camera, const double half[3], double aspect)
{
    double       forward[3], side[3], top[3], farthest = 0;
    const double tall = real_tan(camera->fov / 2), wide = tall * aspect;
    krs_camera_axes(camera, forward, side, top);
    for (int corner = 0; corner < 8; corner++) {
        const double at[3] = {corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1],
                              corner & 4 ? half[2] : -half[2]};
        const double needed = fmax(fabs(dot3(at, side)) / wide, fabs(dot3(at, top)) / tall);
        farthest            = fmax(farthest, needed - dot3(at, forward));
    }
    return farthest;
}

/* Returns the height of an orthographic picture that has each corner of the box. */
static double height_for(const KrsCamera *camera, const double half[3], double aspect)
{
    double forward[3], side[3], top[3], tall = 0, wide = 0;
    krs_camera_axes(camera, forward, side, top);
    for (int i = 0; i < 3; i++) {
        tall += 2 * half[i] * fabs(top[i]);
        wide += 2 * half[i] * fabs(side[i]);
    }
    return fmax(tall, wide / aspect);
}

void krs_camera_fit(KrsCamera *camera, const double low[3], const double high[3], double aspect)
{
    const double margin = 1.08;
    double       forward[3], side[3], top[3], half[3];
    krs_camera_axes(camera, forward, side, top);
    for (int i = 0; i < 3; i++)
        half[i] = fmax((high[i] - low[i]) / 2, 1e-9);
    const double away = camera->projection == KRS_PERSPECTIVE ? distance_for(camera, half, aspect)
                                                              : 2 * length3(half);
    for (int i = 0; i < 3; i++) {
        camera->target[i] = (low[i] + high[i]) / 2;
        camera->eye[i]    = camera->target[i] - margin * away * forward[i];
    }
    if (camera->projection == KRS_ORTHOGRAPHIC)
        camera->height = margin * height_for(camera, half, aspect);
    camera->focus = 0;
}

static void make_orthographic(KrsCamera *camera)
{
    if (camera->projection == KRS_PERSPECTIVE)
        camera->height = height_at_target(camera);
    camera->projection = KRS_ORTHOGRAPHIC;
}

void krs_camera_toggle_perspective(KrsCamera *camera)
{
    if (camera->projection == KRS_PERSPECTIVE) {
        make_orthographic(camera);
        return;
    }
    double forward[3], side[3], top[3];
    krs_camera_axes(camera, forward, side, top);
    if (!(camera->fov > 0))
        camera->fov = 40 * M_PI / 180;
    const double away = camera->projection == KRS_ORTHOGRAPHIC
                            ? camera->height / (2 * real_tan(camera->fov / 2))
                            : distance(camera);
    for (int i = 0; i < 3; i++)
        camera->eye[i] = camera->target[i] - away * forward[i];
    camera->projection = KRS_PERSPECTIVE;
}

void krs_camera_axis(KrsCamera *camera, const double from[3])
{
    /* Above or below the target the eye is a little to the front: the picture needs to know what is
       up. */
    const double aside = fabs(from[1]) > 0.5 ? 1e-4 : 0, up[3] = {0, 1, 0};
    const double away = distance(camera);
    make_orthographic(camera);
    for (int i = 0; i < 3; i++)
        camera->eye[i] = camera->target[i] + away * from[i];
    camera->eye[2] += away * aside;
    memcpy(camera->up, up, sizeof up);
}

void krs_camera_aim(KrsCamera *camera, const double point[3])
{
    memcpy(camera->target, point, sizeof camera->target);
    camera->focus = 0;
}
