/*
 * plate.c: what is known of the plate of another renderer: the plane through each pixel, from the
 * depths, and how much light the scene leaves on it.
 *
 * A plate shows light that has been reflected, so its colours are in proportion to the light that
 * falls on it.  The picture of it with shadows is the plate times the ratio of light on a dull surface
 * with the scene and without it (Debevec 1998, as a ratio).  What a glossy plate mirrors is known by
 * its radiance.  So it is taken from the plate before, and what is mirrored with the scene is added.
 */
#include "runtime/film/plate.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "runtime/film/picture.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

bool plate_catches(const KrsFilm *film) { return film->options.catcher != KRS_CATCHER_NONE; }

static bool is_glossy(const KrsFilm *film) { return film->options.catcher == KRS_CATCHER_GLOSSY; }

uint32_t plate_rows(const KrsFilm *film)
{
    return !plate_catches(film) ? 0 : is_glossy(film) ? 2 * CAUGHT_ROWS : CAUGHT_ROWS;
}

void plate_tell(const KrsFilm *film, ControlBlock *control)
{
    if (!plate_catches(film))
        return;
    control->caught            = ROW_OF_LIGHTS + film->light_count - plate_rows(film);
    control->plate_roughness   = (float)film->options.catcher_roughness;
    control->plate_reflectance = is_glossy(film) ? (float)film->options.catcher_reflectance : 0;
}

/* ---- planes ---- */

/* A point that a pixel of the plate shows. */
typedef struct PlatePoint {
    bool   exists; /* the depth is finite */
    double depth;
    double position[3], toward[3]; /* relative to the rebase origin; along the ray */
} PlatePoint;

/* Finds the ray through the middle of a pixel of a camera, as in frame.glsl.  Its direction has
   such a length that depths count along it. */
static void find_ray(const Job *job, uint32_t x, uint32_t y, double origin[3], double direction[3])
{
    const FrameBlock *f         = &job->frame;
    const double      right     = (2 * x + 1.0) / job->options.width - 1 + (double)f->shift[0];
    const double      up        = 1 - (2 * y + 1.0) / job->options.height + (double)f->shift[1];
    const double      longitude = M_PI * right, latitude = 0.5 * M_PI * up;
    for (int i = 0; i < 3; i++) {
        const double eye = (double)f->eye[i], r = (double)f->right[i], u = (double)f->up[i],
                     forward = (double)f->forward[i], lateral = right * r + up * u;
        origin[i]    = eye;
        direction[i] = forward + lateral;
        if (job->view.camera.projection == KRS_ORTHOGRAPHIC) {
            origin[i]    = eye + lateral;
            direction[i] = forward;
        } else if (job->view.camera.projection == KRS_PANORAMA) {
            direction[i] = cos(latitude) * (cos(longitude) * forward + sin(longitude) * r) +
                           sin(latitude) * u;
        }
    }
}

static void find_listed_ray(const Job *job, size_t pixel, double origin[3], double direction[3])
{
    memcpy(direction, job->rays->directions[pixel], 3 * sizeof *direction);
    normalize3(direction);
    for (int i = 0; i < 3; i++)
        origin[i] = job->rays->origins[pixel][i] - job->rebase_origin[i];
}

/* Finds the point of a pixel.  Pixels outside of the picture do not exist: their numbers wrap
   round. */
static PlatePoint find_point(const Job *job, uint32_t x, uint32_t y)
{
    const size_t pixel = (size_t)y * job->options.width + x;
    PlatePoint   point = {0};
    double       origin[3];
    if (x >= job->options.width || y >= job->options.height)
        return point;
    point.depth  = (double)job->options.depth[pixel];
    point.exists = isfinite(point.depth);
    if (!point.exists)
        return point;
    if (job->rays)
        find_listed_ray(job, pixel, origin, point.toward);
    else
        find_ray(job, x, y, origin, point.toward);
    for (int i = 0; i < 3; i++)
        point.position[i] = origin[i] + point.depth * point.toward[i];
    return point;
}

/* Finds the change of the position from pixel to pixel, by the two neighbours.  Where one of them
   lies at another depth, there is an edge, and the other tells it alone. */
static bool find_change(const PlatePoint *before, const PlatePoint *at, const PlatePoint *after,
                        double change[3])
{
    const double  back  = before->exists ? fabs(at->depth - before->depth) : HUGE_VAL;
    const double  ahead = after->exists ? fabs(after->depth - at->depth) : HUGE_VAL;
    const bool    even = back < 2 * ahead + 1e-6 * at->depth && ahead < 2 * back + 1e-6 * at->depth;
    const double *from = even || back <= ahead ? before->position : at->position;
    const double *to   = even || ahead < back ? after->position : at->position;
    for (int i = 0; i < 3; i++)
        change[i] = to[i] - from[i];
    return before->exists || after->exists;
}

/* Finds the normal towards the eye; where neighbours tell none, the surface faces the eye. */
static void find_normal(const Job *job, uint32_t x, uint32_t y, const PlatePoint *at,
                        double normal[3])
{
    const PlatePoint left = find_point(job, x - 1, y), right = find_point(job, x + 1, y),
                     above = find_point(job, x, y - 1), below = find_point(job, x, y + 1);
    double across[3], down[3];
    bool   known = find_change(&left, at, &right, across);
    known        = find_change(&above, at, &below, down) && known;
    if (known)
        cross3(across, down, normal);
    if (!known || !normalize3(normal)) {
        memcpy(normal, at->toward, sizeof at->toward);
        normalize3(normal);
    }
    const double side = dot3(normal, at->toward) > 0 ? -1 : 1;
    for (int i = 0; i < 3; i++)
        normal[i] *= side;
}

void plate_find_planes(const Job *job, const KrsWindow *traced, float (*planes)[4])
{
    for (uint32_t y = traced->y; y < traced->y + traced->height; y++)
        for (uint32_t x = traced->x; x < traced->x + traced->width; x++, planes++) {
            const PlatePoint at        = find_point(job, x, y);
            double           normal[3] = {0}, product = 0;
            if (at.exists)
                find_normal(job, x, y, &at, normal);
            for (int i = 0; i < 3; i++) {
                (*planes)[i] = (float)normal[i];
                product += normal[i] * at.position[i];
            }
            (*planes)[3] = (float)product;
        }
}

/* ---- what is caught ---- */

/* Returns the ratio of light on the plate.  Without light from elsewhere the plate is black:
   nothing is darker than that. */
static float ratio_of(float caught, float without) { return without > 0 ? caught / without : 1; }

/* Makes an AOV of a picture; false with the failure noted. */
static bool make_aov(const KrsFilm *film, KrsPicture *picture, float (**aov)[3])
{
    const size_t pixels = picture_pixels(picture);
    *aov = gpu_alloc(&film->rendering->renderer->gpu, pixels, sizeof **aov, "make a picture");
    picture->stats.peak_memory_bytes += *aov ? pixels * sizeof **aov : 0;
    return *aov != NULL;
}

/* Puts a pixel.  What a glossy plate mirrors counts for the part of the pixel that shows the plate,
   as its sums do. */
static void put_pixel(const KrsFilm *film, KrsPicture *picture, const float (*sums)[4],
                      size_t pixels, size_t k)
{
    const uint32_t *ended   = film->sums->pixel_samples;
    const float     samples = (float)(ended && ended[k] > 0 ? ended[k] : film->samples);
    for (int i = 0; i < 3; i++) {
        const float caught    = ratio_of(sums[k][i], sums[pixels + k][i]);
        picture->caught[k][i] = caught;
        if (picture->mirrored)
            picture->mirrored[k][i] = (sums[2 * pixels + k][i] - caught * sums[3 * pixels + k][i]) /
                                      samples;
    }
}

bool plate_finish(const KrsFilm *film, KrsPicture *picture)
{
    const size_t pixels = picture_pixels(picture);
    const size_t before = film->light_count - plate_rows(film);
    if (!plate_catches(film))
        return true;
    if (!make_aov(film, picture, &picture->caught) ||
        (is_glossy(film) && !make_aov(film, picture, &picture->mirrored)))
        return false;
    for (size_t k = 0; k < pixels; k++)
        put_pixel(film, picture, (const float(*)[4])film->lights + before * pixels, pixels, k);
    return true;
}
