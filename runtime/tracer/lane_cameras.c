/*
 * lane_cameras.c: rays of a camera by the host, and random points of pixels.
 */
#include "runtime/tracer/lane_cameras.h"

#include <math.h>

static const float PI = 3.14159265f;

/* ---- samples.glsl ---- */

static const uint32_t USE_OF_LENS = 0x6c656e73u;

static uint32_t spread_bits(uint32_t bits)
{
    bits = (bits | bits << 8) & 0x00ff00ffu;
    bits = (bits | bits << 4) & 0x0f0f0f0fu;
    bits = (bits | bits << 2) & 0x33333333u;
    return (bits | bits << 1) & 0x55555555u;
}

static uint32_t reverse_bits(uint32_t bits)
{
    bits = (bits >> 1 & 0x55555555u) | (bits & 0x55555555u) << 1;
    bits = (bits >> 2 & 0x33333333u) | (bits & 0x33333333u) << 2;
    bits = (bits >> 4 & 0x0f0f0f0fu) | (bits & 0x0f0f0f0fu) << 4;
    bits = (bits >> 8 & 0x00ff00ffu) | (bits & 0x00ff00ffu) << 8;
    return bits >> 16 | bits << 16;
}

static uint32_t scramble_bits(uint32_t bits, uint32_t seed)
{
    bits ^= bits * 0x3d20adeau;
    bits += seed;
    bits *= seed >> 16 | 1u;
    bits ^= bits * 0x05526c56u;
    return bits ^ bits * 0x53a22864u;
}

static uint32_t hash_bits(uint32_t bits)
{
    bits = bits * 747796405u + 2891336453u;
    bits = (bits >> ((bits >> 28) + 4) ^ bits) * 277803737u;
    return bits >> 22 ^ bits;
}

static void sample_bits(const uint32_t pixel[2], uint32_t use, uint32_t seed, uint32_t bits[2])
{
    const uint32_t number = spread_bits(pixel[0]) | spread_bits(pixel[1]) << 1;
    const uint32_t own    = hash_bits(use + 977u * seed);
    const uint32_t x      = scramble_bits(reverse_bits(number), own);
    uint32_t       y      = x ^ (x & 0x55555555u) << 1;
    y ^= (y & 0x33333333u) << 2;
    y ^= (y & 0x0f0f0f0fu) << 4;
    y ^= (y & 0x00ff00ffu) << 8;
    y ^= (y & 0x0000ffffu) << 16;
    bits[0] = x;
    bits[1] = y ^ hash_bits(own);
}

static float fraction_of(uint32_t bits) { return (float)(bits >> 8) / 16777216.0f; }

void sample_hemisphere(const uint32_t pixel[2], uint32_t ray, uint32_t seed, float square[2])
{
    static const float step[2] = {0.6287067f, 0.5385973f};
    uint32_t           bits[2];
    sample_bits(pixel, 0, seed, bits);
    for (int k = 0; k < 2; k++) {
        const float place = fraction_of(bits[k]) + step[k] * (float)ray;
        square[k]         = place - floorf(place);
    }
}

static void sample_lens(const uint32_t pixel[2], uint32_t ray, uint32_t seed, float square[2])
{
    static const uint32_t step[2] = {3679390609u, 3152041523u};
    uint32_t              bits[2];
    sample_bits(pixel, USE_OF_LENS, seed, bits);
    for (int k = 0; k < 2; k++)
        square[k] = fraction_of(bits[k] + step[k] * ray);
}

/* ---- rays.glsl ---- */

static void disc_of_square(const float square[2], float point[2])
{
    const float angle = 2 * PI * square[0], radius = sqrtf(square[1]);
    point[0] = radius * cosf(angle);
    point[1] = radius * sinf(angle);
}

static void polygon_of_square(const float square[2], float corners, float point[2])
{
    const float place = corners * square[0], corner = floorf(place), along = place - corner;
    const float first = 2 * PI * corner / corners, next = 2 * PI * (corner + 1) / corners;
    const float radius = sqrtf(square[1]);
    point[0]           = radius * ((1 - along) * sinf(first) + along * sinf(next));
    point[1]           = radius * ((1 - along) * cosf(first) + along * cosf(next));
}

/* Moves a ray to a point of the lens; `ahead` is that of a ray through the middle, before. */
static void pass_lens(const CameraRays *rays, const uint32_t pixel[2], float origin[3],
                      float ahead[3])
{
    const FrameBlock *frame = rays->frame;
    float             square[2], point[2];
    if (rays->through_middle || !(frame->lens[0] > 0))
        return;
    sample_lens(pixel, rays->number, rays->seed, square);
    if (frame->lens[3] > 0)
        polygon_of_square(square, frame->lens[3], point);
    else
        disc_of_square(square, point);
    for (int k = 0; k < 3; k++) {
        const float beside = point[0] * frame->lens[0] * frame->right[k] +
                             point[1] * frame->lens[1] * frame->up[k];
        origin[k] += beside;
        ahead[k] -= frame->lens[2] * beside;
    }
}

static CameraRay ray_of_panorama(const FrameBlock *frame, float across, float up)
{
    const float longitude = PI * across, latitude = 0.5f * PI * up;
    const float ahead = cosf(longitude), aside = sinf(longitude), level = cosf(latitude);
    CameraRay   ray = {.width = frame->pixel_base, .spread = frame->pixel_slope};
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = frame->eye[k] +
                        frame->shift[2] * (ahead * frame->right[k] - aside * frame->forward[k]);
        ray.direction[k] = level * (ahead * frame->forward[k] + aside * frame->right[k]) +
                           sinf(latitude) * frame->up[k];
    }
    return ray;
}

CameraRays camera_rays(const Job *job, const WorkBlock *work)
{
    const ControlBlock *control = job->rendering->control.bytes;
    return (CameraRays){.frame          = &job->frame,
                        .projection     = job->view.camera.projection,
                        .offset         = {work->offset[0], work->offset[1]},
                        .number         = control->ray,
                        .seed           = control->seed,
                        .through_middle = control->first_ray != 0};
}

CameraRay camera_ray(const CameraRays *rays, const uint32_t pixel[2])
{
    const FrameBlock *frame       = rays->frame;
    const bool        perspective = rays->projection == KRS_PERSPECTIVE;
    const float       x = (float)pixel[0] + rays->offset[0], y = (float)pixel[1] + rays->offset[1];
    const float       across = 2 * x / frame->size[0] - 1 + frame->shift[0],
                up           = 1 - 2 * y / frame->size[1] + frame->shift[1];
    CameraRay ray            = {.width = frame->pixel_base};
    float     square         = 0;
    if (rays->projection == KRS_PANORAMA)
        return ray_of_panorama(frame, across, up);
    for (int k = 0; k < 3; k++) {
        const float aside = across * frame->right[k] + up * frame->up[k];
        ray.origin[k]     = frame->eye[k] + (perspective ? 0 : aside);
        ray.direction[k]  = frame->forward[k] + (perspective ? aside : 0);
    }
    pass_lens(rays, pixel, ray.origin, ray.direction);
    for (int k = 0; k < 3; k++)
        square += ray.direction[k] * ray.direction[k];
    const float length = perspective || frame->lens[0] > 0 ? sqrtf(square) : 1;
    for (int k = 0; k < 3; k++)
        ray.direction[k] /= length;
    ray.spread = frame->pixel_slope / (perspective ? length : 1);
    return ray;
}
