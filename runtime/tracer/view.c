/*
 * view.c: the camera's axes, the length of rays, and the size of the scene.
 */
#include "runtime/tracer/view.h"

#include <math.h>

#include "compiler/base/vec.h"

/* The depth at which z is 0 in the NDC of a perspective picture; z is 1 at infinity. */
static const double NDC_NEAR = 1e-3;

/* Stands for infinity in the boxes of shaders: divided by 1e-18 it is still a float (clip_to in
   frame.glsl). */
#define UNBOUNDED KRS_MAX_COORDINATE
/* Rays in a scene without bounds end this many times its size from the camera: far beyond where its
   horizon is a pixel high. */
#define HORIZON 1e4

typedef struct Basis {
    double right[3], up[3], forward[3]; /* orthonormal */
    double distance;                    /* from the eye to the target */
} Basis;

static bool camera_basis(const KrsCamera *camera, Basis *basis)
{
    for (int i = 0; i < 3; i++)
        basis->forward[i] = camera->target[i] - camera->eye[i];
    basis->distance = sqrt(dot3(basis->forward, basis->forward));
    if (!normalize3(basis->forward))
        return false;

    /* Another axis defines what is right when the camera looks along `up`, or `up` is 0. */
    cross3(basis->forward, camera->up, basis->right);
    if (!(dot3(basis->right, basis->right) > 1e-18 * dot3(camera->up, camera->up)) ||
        !normalize3(basis->right)) {
        double other[3]                              = {0};
        other[fabs(basis->forward[2]) < 0.9 ? 2 : 0] = -1;
        cross3(basis->forward, other, basis->right);
        if (!normalize3(basis->right))
            return false;
    }
    cross3(basis->right, basis->forward, basis->up);
    return true;
}

/* Computes half the extent of the picture to the right and upwards: at distance 1 for a perspective
   picture. */
static void half_extent(const KrsCamera *camera, uint32_t width, uint32_t height, double extent[2])
{
    double half = camera->projection == KRS_PERSPECTIVE    ? tan(camera->fov / 2)
                  : camera->projection == KRS_ORTHOGRAPHIC ? camera->height / 2
                                                           : 1;
    extent[1]   = half;
    extent[0]   = camera->projection == KRS_PANORAMA ? 1 : half * width / height;
}

static bool camera_is_valid(const KrsCamera *camera)
{
    for (int i = 0; i < 3; i++)
        if (!isfinite(camera->eye[i]) || !isfinite(camera->target[i]) || !isfinite(camera->up[i]))
            return false;
    if (!(camera->aperture >= 0) || !isfinite(camera->aperture) || !(camera->focus >= 0) ||
        !isfinite(camera->shift[0]) || !isfinite(camera->shift[1]) || !isfinite(camera->eyes))
        return false;
    if (camera->projection == KRS_PERSPECTIVE)
        return camera->fov > 0 && camera->fov < M_PI;
    if (camera->projection == KRS_ORTHOGRAPHIC)
        return camera->height > 0 && isfinite(camera->height);
    return true;
}

static void to_floats(const double from[3], float to[4])
{
    for (int i = 0; i < 3; i++)
        to[i] = (float)from[i];
    to[3] = 0;
}

static void scaled(const double from[3], double by, float to[4])
{
    const double product[3] = {from[0] * by, from[1] * by, from[2] * by};
    to_floats(product, to);
}

/* Returns the diagonal of the scene's box over the axes along which it is bounded; 0 when none is. */
static double finite_size(const double low[3], const double high[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        if (isfinite(low[i]) && isfinite(high[i]) && high[i] > low[i])
            sum += (high[i] - low[i]) * (high[i] - low[i]);
    return sqrt(sum);
}

static bool is_bounded(const double low[3], const double high[3])
{
    bool bounded = true;
    for (int i = 0; i < 3; i++)
        bounded = bounded && isfinite(low[i]) && isfinite(high[i]);
    return bounded;
}

void view_place_box(const KrsView *view, const double low[3], const double high[3],
                    FrameBlock *block)
{
    double size = finite_size(low, high), reach = 0;
    for (int i = 0; i < 3; i++) {
        reach = fmax(reach, fabs(view->camera.eye[i]));
        reach = isfinite(low[i]) ? fmax(reach, fabs(low[i])) : reach;
        reach = isfinite(high[i]) ? fmax(reach, fabs(high[i])) : reach;
    }
    double margin = 1e-4 * size + 1e-6 * reach;
    for (int i = 0; i < 3; i++) {
        block->low[i]  = (float)fmin(fmax(low[i] - margin, -UNBOUNDED), UNBOUNDED);
        block->high[i] = (float)fmin(fmax(high[i] + margin, -UNBOUNDED), UNBOUNDED);
    }
}

static double dot_floats(const double a[3], const float b[3])
{
    return a[0] * (double)b[0] + a[1] * (double)b[1] + a[2] * (double)b[2];
}

/* Projects a point to the picture: right and up from the middle, in half widths and half heights.
   False for a point that is not in front of the eye. */
static bool project(const FrameBlock *block, const double point[3], bool perspective,
                    double image_point[2])
{
    const float *axes[2] = {block->right, block->up};
    double       offset[3], length = 0;
    for (int i = 0; i < 3; i++) {
        offset[i] = point[i] - (double)block->eye[i];
        length    = hypot(length, offset[i]);
    }
    double ahead = perspective ? dot_floats(offset, block->forward) : 1;
    for (int i = 0; i < 2; i++) {
        const double axis[3] = {axes[i][0], axes[i][1], axes[i][2]};
        image_point[i]       = dot_floats(offset, axes[i]) / (dot_floats(axis, axes[i]) * ahead);
    }
    return !perspective || ahead > 1e-3 * length;
}

KrsWindow view_window(const FrameBlock *block, const KrsCamera *camera, double reach)
{
    const double size[2] = {block->size[0], block->size[1]};
    double       low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    bool         known = camera->projection != KRS_PANORAMA && camera->aperture == 0 &&
                 camera->shift[0] == 0 && camera->shift[1] == 0;
    bool widens = camera->projection == KRS_PERSPECTIVE;
    for (int corner = 0; corner < 8; corner++) {
        double point[3], image_point[2];
        for (int i = 0; i < 3; i++)
            point[i] = (double)(corner >> i & 1 ? block->high[i] : block->low[i]);
        known = project(block, point, widens, image_point) && known;
        for (int i = 0; i < 2; i++) {
            low[i]  = fmin(low[i], image_point[i]);
            high[i] = fmax(high[i], image_point[i]);
        }
    }
    double       from[2] = {0.5 * (1 + low[0]), 0.5 * (1 - high[1])};
    double       to[2]   = {0.5 * (1 + high[0]), 0.5 * (1 - low[1])};
    const double margin  = 1 + ceil(reach - 0.5); /* a pixel for rounding, and what is beside it */
    for (int i = 0; i < 2; i++) {
        from[i] = known ? fmin(fmax(floor(from[i] * size[i]) - margin, 0), size[i]) : 0;
        to[i]   = known ? fmin(fmax(ceil(to[i] * size[i]) + margin, from[i]), size[i]) : size[i];
    }
    return (KrsWindow){(uint32_t)from[0], (uint32_t)from[1], (uint32_t)(to[0] - from[0]),
                       (uint32_t)(to[1] - from[1])};
}

/* Sets the end of rays and the reach of occlusion.  The reach depends on the scene alone where
   possible, not on the camera, so that it does not change while the camera moves. */
static void place_ends(const KrsView *view, const double low[3], const double high[3],
                       double distance, FrameBlock *block)
{
    double size = finite_size(low, high);
    if (is_bounded(low, high)) {
        double farthest = 0;
        for (int i = 0; i < 3; i++) {
            double eye  = view->camera.eye[i];
            double side = fmax(fabs(low[i] - eye), fabs(high[i] - eye));
            farthest += side * side;
        }
        /* An orthographic ray starts beside the eye, no farther from it than the box is. */
        block->farthest        = (float)(2.1 * sqrt(farthest) + 2 * view->camera.height);
        block->occlusion_reach = (float)(0.15 * size);
    } else {
        double scale           = fmax(size, distance);
        block->farthest        = (float)(HORIZON * scale);
        block->occlusion_reach = (float)(0.15 * (size > 0 ? fmin(size, distance) : distance));
    }
    if (!(block->occlusion_reach > 0))
        block->occlusion_reach = (float)(0.15 * distance);
}

bool view_ray(const KrsCamera *camera, uint32_t width, uint32_t height, const double place[2],
              double origin[3], double direction[3])
{
    Basis        basis;
    double       extent[2];
    const double fans = camera->projection == KRS_PERSPECTIVE;
    if (camera->projection == KRS_PANORAMA || !camera_is_valid(camera) ||
        !camera_basis(camera, &basis))
        return false;
    half_extent(camera, width, height, extent);
    for (int i = 0; i < 3; i++) {
        double beside = extent[0] * place[0] * basis.right[i] + extent[1] * place[1] * basis.up[i];
        origin[i]     = camera->eye[i] + (1 - fans) * beside;
        direction[i]  = basis.forward[i] + fans * beside;
    }
    return true;
}

double view_pixel(const KrsCamera *camera, uint32_t height, double distance)
{
    double extent[2];
    half_extent(camera, 1, 1, extent);
    switch (camera->projection) {
    case KRS_ORTHOGRAPHIC: return 2 * extent[1] / height;
    case KRS_PANORAMA: return M_PI / height * distance;
    case KRS_PERSPECTIVE: break;
    }
    return 2 * extent[1] / height * distance;
}

double view_width(const KrsCamera *camera, const KrsRays *rays, uint32_t height, double distance)
{
    return rays ? rays->width + rays->spread * distance : view_pixel(camera, height, distance);
}

static double focus_of(const KrsCamera *camera, const Basis *basis)
{
    return camera->focus > 0 ? camera->focus : basis->distance;
}

double view_eyes(const KrsCamera *camera)
{
    Basis basis;
    if (camera->eyes != 0 || !camera_basis(camera, &basis))
        return camera->eyes;
    return focus_of(camera, &basis) / 30;
}

void view_choose_eye(KrsCamera *camera, KrsEye eye, uint32_t width, uint32_t height)
{
    const double half = eye == KRS_EYE_OF_BOTH   ? 0
                        : eye == KRS_EYE_ON_LEFT ? -0.5 * view_eyes(camera)
                                                 : 0.5 * view_eyes(camera);
    Basis        basis;
    double       extent[2];
    camera->eyes = half;
    if (half == 0 || camera->projection == KRS_PANORAMA || !camera_basis(camera, &basis))
        return;
    const double focus = camera->focus = focus_of(camera, &basis);
    half_extent(camera, width, height, extent);
    for (int i = 0; i < 3; i++) {
        camera->eye[i] += half * basis.right[i];
        camera->target[i] += half * basis.right[i];
    }
    camera->shift[0] -= 0.5 * half /
                        (extent[0] * (camera->projection == KRS_PERSPECTIVE ? focus : 1));
}

/* Sets what shaders with a lens need. */
static void place_lens(const KrsCamera *camera, const Basis *basis, const double extent[2],
                       FrameBlock *block)
{
    for (int i = 0; i < 2; i++) {
        block->lens[i]  = (float)(camera->aperture / extent[i]);
        block->shift[i] = (float)(2 * camera->shift[i]);
    }
    block->lens[2]  = (float)(1 / focus_of(camera, basis));
    block->lens[3]  = camera->blades >= 3 ? (float)camera->blades : 0;
    block->shift[2] = (float)camera->eyes;
}

bool view_prepare(const KrsView *view, const double low[3], const double high[3], uint32_t width,
                  uint32_t height, FrameBlock *block)
{
    const KrsCamera *camera = &view->camera;
    Basis            basis;
    double           extent[2];
    if (!camera_is_valid(camera) || !camera_basis(camera, &basis))
        return false;
    half_extent(camera, width, height, extent);

    *block = (FrameBlock){
        .size = {(float)width, (float)height},
    };
    for (int i = 0; i < 3; i++)
        block->eye[i] = (float)camera->eye[i];
    scaled(basis.right, extent[0], block->right);
    scaled(basis.up, extent[1], block->up);
    to_floats(basis.forward, block->forward);
    to_floats(view->sky.zenith, block->zenith);
    to_floats(view->sky.horizon, block->horizon);
    to_floats(view->sky.ground, block->ground);
    if (view->sky.map) {
        block->sky_map[0] = (float)view->sky.map->width;
        block->sky_map[1] = (float)view->sky.map->height;
        block->sky_map[2] = (float)fmod(view->sky.rotation, 2 * M_PI);
        block->sky_map[3] = (float)view->sky.intensity;
    }
    to_floats(view->fog.color, block->fog);
    block->fog[3]       = (float)view->fog.density;
    block->fog_level[0] = (float)view->fog.fall;
    block->fog_level[1] = (float)view->fog.base;

    block->pixel_base  = (float)view_pixel(camera, height, 0);
    block->pixel_slope = (float)(view_pixel(camera, height, 1) - view_pixel(camera, height, 0));
    place_lens(camera, &basis, extent, block);
    view_place_box(view, low, high, block);
    place_ends(view, low, high, basis.distance, block);
    return isfinite(block->farthest);
}

static bool ray_is_valid(const double origin[3], const double direction[3])
{
    bool valid = direction[0] != 0 || direction[1] != 0 || direction[2] != 0;
    for (int i = 0; i < 3; i++)
        valid = valid && isfinite(origin[i]) && isfinite(direction[i]);
    return valid;
}

bool view_of_rays(const KrsRays *rays, size_t count, KrsCamera *camera)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    bool   good = isfinite(rays->width) && isfinite(rays->spread) && rays->width >= 0 &&
                rays->spread >= 0 && rays->width + rays->spread > 0 && rays->farthest >= 0;
    for (size_t k = 0; k < count && good; k++) {
        good = ray_is_valid(rays->origins[k], rays->directions[k]);
        for (int i = 0; i < 3; i++) {
            low[i]  = fmin(low[i], rays->origins[k][i]);
            high[i] = fmax(high[i], rays->origins[k][i]);
        }
    }
    *camera = (KrsCamera){.projection = KRS_PERSPECTIVE, .fov = 1, .up = {0, 1, 0}};
    for (int i = 0; i < 3; i++)
        camera->eye[i] = camera->target[i] = low[i] + 0.5 * (high[i] - low[i]);
    camera->height = finite_size(low, high);
    camera->target[2] += fmax(camera->height, 1);
    return good && isfinite(camera->height);
}

void view_matrices(const KrsCamera *camera, uint32_t width, uint32_t height, KrsPicture *picture)
{
    Basis  basis = {0};
    double extent[2];
    for (int i = 0; i < 4; i++)
        picture->world_to_camera[i][i] = picture->world_to_ndc[i][i] = 1;
    if (!camera)
        return;
    camera_basis(camera, &basis);
    half_extent(camera, width, height, extent);

    const double *axes[3]            = {basis.right, basis.up, basis.forward};
    double        camera_space[4][4] = {{0}};
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++)
            camera_space[row][column] = axes[column][row];
        camera_space[3][column] = -dot3(axes[column], camera->eye);
    }
    camera_space[3][3] = 1;

    for (int row = 0; row < 4; row++) {
        const double *from        = camera_space[row];
        const bool    perspective = camera->projection == KRS_PERSPECTIVE;
        for (int column = 0; column < 4; column++)
            picture->world_to_camera[row][column] = (float)from[column];
        for (int i = 0; i < 2; i++)
            picture->world_to_ndc[row][i] =
                (float)(from[i] / extent[i] - 2 * camera->shift[i] * from[perspective ? 2 : 3]);
        picture->world_to_ndc[row][2] = (float)(perspective ? from[2] - NDC_NEAR * from[3]
                                                            : from[2]);
        picture->world_to_ndc[row][3] = (float)(perspective ? from[2] : from[3]);
    }
}
