/*
 * lane_surfaces.c: surfaces of hits by lanes of the host.
 *
 * Points that follow each other are to be near each other.  So hits of the camera's rays are taken in squares of pixels,
 * whose quarters of quarters follow each other, and those of paths are sorted.  Squares are dealt to all processors.
 */
#include "runtime/tracer/lane_surfaces.h"

#include <math.h>
#include <string.h>

#include "runtime/tracer/lane_cameras.h"
#include "runtime/tracer/lane_deal.h"
#include "runtime/tracer/lane_fields.h"
#include "runtime/tracer/rendering.h"

enum {
    SIDE              = 128,
    OCCLUDERS_AT_ONCE = 4096,
    BYTES_OF_PART     = SURFACES_AT_ONCE * sizeof(SurfacePoint)
};
static_assert(SIDE * SIDE == SURFACES_AT_ONCE, "surfaces.h");
static_assert((int)PLAIN_SURFACE_NUMBERS == 4 * (int)PLAIN_SURFACE_ROWS &&
                  (int)SURFACE_NUMBERS <= 4 * (int)SURFACE_ROWS &&
                  (int)SURFACE_NUMBERS > 4 * ((int)SURFACE_ROWS - 1),
              "rows of surfaces");

static bool has_layers(const KrsProgram *program) { return program->layers || program->subsurface; }

uint32_t lane_surfaces_rows(const KrsRendering *rendering)
{
    return has_layers(rendering->program) ? SURFACE_ROWS : PLAIN_SURFACE_ROWS;
}

SurfaceField *lane_surfaces_field(Job *job)
{
    return lane_fields_surfaces(job->rendering, job->state, has_layers(job->rendering->program));
}

/* ---- what is dealt ---- */

/* Squares, or runs of a list, that are dealt out in one slice. */
typedef struct Slice {
    const Job          *job;
    const SurfaceField *field;
    const WorkBlock    *work;
    CameraRays          rays;
    const LanePaths    *paths;       /* that have hit; NULL: hits are the camera's */
    uint32_t            across;      /* squares in a row */
    uint32_t            list, count; /* where the list of occluders begins, and how many they are */
    LaneDeal            deal;
} Slice;

/* ---- hits ---- */

/* Finds where the ray of a pixel hits, and how wide the pixel is there, as hit_point_of_slot of
   hit_lists.glsl does. */
static float find_hit(const Slice *slice, const uint32_t pixel[2], float t, float position[3],
                      float direction[3])
{
    const uint32_t  in_picture[2] = {slice->work->corner[0] + pixel[0],
                                     slice->work->corner[1] + pixel[1]};
    const CameraRay ray           = camera_ray(&slice->rays, in_picture);
    for (int k = 0; k < 3; k++) {
        direction[k] = ray.direction[k];
        position[k]  = ray.origin[k] + t * ray.direction[k];
    }
    return fmaxf(ray.width + ray.spread * t, 1e-30f);
}

/* Returns the same for the ray of a path. */
static float find_hit_of_path(const Slice *slice, const uint32_t pixel[2], float t,
                              float position[3], float direction[3])
{
    const float(*path)[4] = lane_rays_path(slice->job, slice->work, pixel);
    for (int k = 0; k < 3; k++) {
        direction[k] = path[PATH_DIRECTION][k];
        position[k]  = path[PATH_ORIGIN][k] + t * direction[k];
    }
    return fmaxf(path[PATH_ORIGIN][3] + path[PATH_DIRECTION][3] * t, 1e-30f);
}

/* Returns the end of the ray of a pixel (frame.glsl). */
static const uint32_t *end_of(const Slice *slice, const uint32_t pixel[2])
{
    const uint32_t(*ends)[2] = slice->job->rendering->band.ends.bytes;
    return ends[(size_t)pixel[1] * slice->work->extent[0] + pixel[0]];
}

/* Tells whether the ray of the camera has hit what has a surface. */
static bool is_hit(const uint32_t *end)
{
    return (end[1] & 3) == STATE_HIT && (end[1] >> 4 & 15) != MARCH_GROUP_OF_PLATE;
}

static const float *facing_of(const Slice *slice, uint32_t slot)
{
    const float(*hits)[4] = slice->job->rendering->band.hits.bytes;
    return hits[(size_t)HIT_ROWS * slot + FACING];
}

static void place_hit(const Slice *slice, const uint32_t pixel[2], SurfacePoint *to)
{
    const uint32_t *end = end_of(slice, pixel), slot = lane_rays_slot(slice->work, pixel);
    const float    *facing = facing_of(slice, slot), side = end[1] & 4 ? -1.0f : 1.0f;
    float           t;
    memcpy(&t, &end[0], sizeof t);
    to->footprint = 0.5f * (slice->paths ? find_hit_of_path : find_hit)(slice, pixel, t,
                                                                        to->position, to->view);
    for (int k = 0; k < 3; k++)
        to->normal[k] = side * facing[k];
    to->found = (float *)slice->job->rendering->band.surfaces.bytes +
                4 * (size_t)lane_surfaces_rows(slice->job->rendering) * slot;
}

static void find_squares(void *task, size_t part, size_t parts)
{
    Slice        *slice  = task;
    SurfacePoint *points = slice->deal.memory[part];
    (void)parts;
    for (uint32_t square; lane_deal_next(&slice->deal, &square);) {
        size_t count = 0;
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t pixel[2] = {SIDE * (square % slice->across) + lane_rays_column(i),
                                       SIDE * (square / slice->across) + lane_rays_column(i >> 1)};
            if (pixel[0] < slice->work->extent[0] && pixel[1] < slice->work->extent[1] &&
                is_hit(end_of(slice, pixel)))
                place_hit(slice, pixel, &points[count++]);
        }
        surface_field_find(slice->field, part, points, count);
    }
}

static void find_of_paths(void *task, size_t part, size_t parts)
{
    Slice        *slice  = task;
    SurfacePoint *points = slice->deal.memory[part];
    (void)parts;
    for (uint32_t run; lane_deal_next(&slice->deal, &run);) {
        const uint32_t first = run * SURFACES_AT_ONCE, left = slice->paths->count - first;
        const uint32_t count = left < SURFACES_AT_ONCE ? left : SURFACES_AT_ONCE;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t pixel[2];
            lane_rays_pixel(slice->work, slice->paths->slots[first + i], pixel);
            place_hit(slice, pixel, &points[i]);
        }
        surface_points_sort(points, count);
        surface_field_find(slice->field, part, points, count);
    }
}

bool lane_surfaces_find(Job *job, const SurfaceField *field, const WorkBlock *work,
                        const LanePaths *paths)
{
    const uint32_t down  = (work->extent[1] + SIDE - 1) / SIDE;
    Slice          slice = {.job    = job,
                            .field  = field,
                            .work   = work,
                            .rays   = camera_rays(job, work),
                            .paths  = paths,
                            .across = (work->extent[0] + SIDE - 1) / SIDE};
    return paths ? lane_deal(job, &slice.deal, KRS_PHASE_BOUNCES,
                             (paths->count + SURFACES_AT_ONCE - 1) / SURFACES_AT_ONCE,
                             BYTES_OF_PART, find_of_paths, &slice)
                 : lane_deal(job, &slice.deal, KRS_PHASE_SHADING, slice.across * down,
                             BYTES_OF_PART, find_squares, &slice);
}

/* ---- occluders ---- */

/* Finds the direction of a point of the square as find_hemisphere_ray of hemisphere.glsl does. */
static void aim_over_hemisphere(const float normal[3], const float square[2], float direction[3])
{
    const float side = normal[2] < 0 ? -1.0f : 1.0f, a = -1 / (side + normal[2]);
    const float b        = normal[0] * normal[1] * a;
    const float right[3] = {1 + side * normal[0] * normal[0] * a, side * b, -side * normal[0]};
    const float up[3]    = {b, side + normal[1] * normal[1] * a, -normal[1]};
    const float angle = 6.2831853f * square[0], rise = 0.02f; /* MIN_RISE */
    const float radius = sqrtf(square[1]) * sqrtf(1 - rise * rise);
    const float x = radius * cosf(angle), y = radius * sinf(angle);
    for (int k = 0; k < 3; k++)
        direction[k] = x * right[k] + y * up[k] + sqrtf(1 - x * x - y * y) * normal[k];
}

/* Returns where the number of a pixel is in the room of a list (occluders.glsl). */
static uint32_t *occluder_of(const Slice *slice, const uint32_t pixel[2])
{
    const uint32_t *extent = slice->work->extent;
    return (uint32_t *)slice->job->rendering->band.queue.bytes +
           (size_t)LIST_WIDE * extent[0] * extent[1] + (size_t)pixel[1] * extent[0] + pixel[0];
}

/* Adds what the ray of a listed pixel has met; its color is found where its surface would be seen. */
static void add_occluder(const Slice *slice, uint32_t slot, SurfacePoint *to, float *color)
{
    /* As in occluders.comp and hit_point.glsl. */
    static const float  FOOTPRINT = 0.05f, LIFT = 1, MAX_WIDTH = 1 / 64.0f;
    const ControlBlock *control = slice->job->rendering->control.bytes;
    const uint32_t     *end;
    uint32_t            pixel[2], in_picture[2];
    float               square[2], along[3], t, length;
    lane_rays_pixel(slice->work, slot, pixel);
    for (int k = 0; k < 2; k++)
        in_picture[k] = slice->work->corner[k] + pixel[k];
    end = end_of(slice, pixel);
    memcpy(&t, &end[0], sizeof t);
    memcpy(&length, occluder_of(slice, pixel), sizeof length);
    const float *normal = facing_of(slice, slot);
    const float  width  = find_hit(slice, pixel, t, to->position, along);
    const float  lift   = LIFT * fminf(width, MAX_WIDTH * t);
    sample_hemisphere(in_picture, control->ray, control->seed, square);
    aim_over_hemisphere(normal, square, to->view);
    for (int k = 0; k < 3; k++) {
        to->position[k] += lift * normal[k] + length * to->view[k];
        to->normal[k] = -to->view[k];
    }
    to->footprint = FOOTPRINT * length;
    to->found     = color;
}

static float luminance_of(const float color[3])
{
    static const float part[3] = {0.2126f, 0.7152f, 0.0722f};
    float              sum     = 0;
    for (int k = 0; k < 3; k++)
        sum += part[k] * (color[k] > 0 ? fminf(color[k], 1) : 0);
    return sum;
}

static void find_occluders(void *task, size_t part, size_t parts)
{
    Slice          *slice  = task;
    SurfacePoint   *points = slice->deal.memory[part];
    const uint32_t *lists = slice->job->rendering->band.queue.bytes, *list = lists + slice->list;
    float           colors[OCCLUDERS_AT_ONCE][3];
    (void)parts;
    for (uint32_t run; lane_deal_next(&slice->deal, &run);) {
        const uint32_t first = run * OCCLUDERS_AT_ONCE, left = slice->count - first;
        const uint32_t count = left < OCCLUDERS_AT_ONCE ? left : OCCLUDERS_AT_ONCE;
        for (uint32_t i = 0; i < count; i++)
            add_occluder(slice, list[first + i], &points[i], colors[i]);
        surface_field_find_colors(slice->field, part, points, count);
        for (uint32_t i = 0; i < count; i++) {
            const float luminance = luminance_of(colors[i]);
            uint32_t    pixel[2];
            lane_rays_pixel(slice->work, list[first + i], pixel);
            memcpy(occluder_of(slice, pixel), &luminance, sizeof luminance);
        }
    }
}

bool lane_surfaces_find_occluders(Job *job, const SurfaceField *field, uint32_t list,
                                  const WorkBlock *work)
{
    const ControlBlock *control = job->rendering->control.bytes;
    Slice               slice   = {.job   = job,
                                   .field = field,
                                   .work  = work,
                                   .rays  = camera_rays(job, work),
                                   .list  = list,
                                   .count = control->remaining};
    return lane_deal(job, &slice.deal, KRS_PHASE_OCCLUSION,
                     (slice.count + OCCLUDERS_AT_ONCE - 1) / OCCLUDERS_AT_ONCE, BYTES_OF_PART,
                     find_occluders, &slice);
}
