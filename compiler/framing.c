/*
 * framing.c: places a camera in a scene that has none.
 *
 * Boxes of sequences hold for all values of the parameters, so they are often much too large.  In a
 * picture of the whole box the scene would be tiny.  So a few hundred rays are cast from a sphere
 * around the box to points inside of it, and the camera frames what they hit.
 *
 * The picture does not depend on whether parts are a crowd: rays and their number are as without.
 */
#include <math.h>
#include <string.h>

#include "compiler/compilation.h"

enum { RAYS = 512, FEWEST_RAYS = 64, ROUNDS = 3, BATCH = 8, MOST_UNRESOLVED = 4 };

/* If the distance has more flops, fewer rays are cast, so that placing a camera takes little
   time. */
static const double FLOPS_OF_ALL_RAYS = 2500;

typedef struct Sphere {
    double centre[3], radius;
} Sphere;

static bool is_bounded(const KrsComponent *component)
{
    for (int k = 0; k < 3; k++)
        if (!isfinite(component->low[k]) || !isfinite(component->high[k]))
            return false;
    return true;
}

/* The ball around the boxes of the bounded components; false when there is none. */
static bool outer_ball(const KrsScene *scene, Sphere *ball)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < scene->shown_count; i++) {
        const KrsComponent *component = &scene->components[i];
        for (int k = 0; is_bounded(component) && k < 3; k++) {
            low[k]  = fmin(low[k], component->low[k]);
            high[k] = fmax(high[k], component->high[k]);
        }
    }
    ball->radius = 0;
    for (int k = 0; k < 3; k++) {
        ball->centre[k] = 0.5 * (low[k] + high[k]);
        ball->radius    = hypot(ball->radius, 0.5 * (high[k] - low[k]));
    }
    return isfinite(ball->radius) && ball->radius > 0;
}

/* The number of rays: a power of two, so that it has no factor in common with the strides of
   make_rays, which are odd. */
static int count_rays(const KrsScene *scene)
{
    int    count = RAYS;
    double flops = tape_flops_apart(&scene->distance);
    while (count > FEWEST_RAYS && count * flops > RAYS * FLOPS_OF_ALL_RAYS)
        count /= 2;
    return count;
}

/* Makes rays from points that are spread evenly on a sphere (a Fibonacci lattice) to the points of
   a second lattice inside of the ball. */
static void make_rays(const Sphere *ball, int count, double (*origins)[3], double (*directions)[3])
{
    const double golden = 2.399963229728653; /* pi (3 - sqrt 5) */
    for (int i = 0; i < count; i++) {
        double y = 1 - (2 * i + 1.0) / count, ring = sqrt(1 - y * y), angle = golden * i;
        double from[3] = {ring * cos(angle), y, ring * sin(angle)};
        double depth = 0.9 * cbrt((i * 89 % count + 0.5) / count), turn = golden * (i * 37 % count);
        double up = 1 - (2 * (i * 53 % count) + 1.0) / count, side = sqrt(1 - up * up);
        double to[3] = {depth * side * cos(turn), depth * up, depth * side * sin(turn)};
        for (int k = 0; k < 3; k++) {
            origins[i][k]    = ball->centre[k] + 1.01 * ball->radius * from[k];
            directions[i][k] = to[k] - 1.01 * from[k];
        }
    }
}

/* The box around all hits of bounded components so far. */
typedef struct Extent {
    double low[3], high[3];
} Extent;

/* Casts rays; false after a few unresolved ones.  Distances that are much too short need many
   steps, and then the camera is placed by the ball so far, to save time. */
static bool cast_rays(KrsFrame *frame, const double (*origins)[3], const double (*directions)[3],
                      int count, double radius, KrsHit *hits)
{
    int unresolved = 0;
    for (int i = 0; i < count && unresolved <= MOST_UNRESOLVED; i++) {
        if (i % BATCH == 0)
            frame_raycast(frame, origins + i, directions + i,
                          (size_t)(count - i < BATCH ? count - i : BATCH), 4 * radius,
                          1e-3 * radius, hits + i);
        unresolved += hits[i].unresolved;
    }
    return unresolved <= MOST_UNRESOLVED;
}

static void add_hits(const KrsScene *scene, const KrsHit *hits, int count, Extent *seen)
{
    for (int i = 0; i < count; i++) {
        if (!hits[i].hit || !is_bounded(&scene->components[hits[i].component - 1]))
            continue;
        for (int k = 0; k < 3; k++) {
            seen->low[k]  = fmin(seen->low[k], hits[i].point[k]);
            seen->high[k] = fmax(seen->high[k], hits[i].point[k]);
        }
    }
}

/* The ball around all hits, a little larger since rays miss some of the surface. */
static bool inner_ball(const Extent *seen, Sphere *ball)
{
    double radius = 0;
    for (int k = 0; k < 3; k++)
        radius = hypot(radius, 0.5 * (seen->high[k] - seen->low[k]));
    if (!isfinite(radius) || !(radius > 1e-3 * ball->radius))
        return false;
    for (int k = 0; k < 3; k++)
        ball->centre[k] = 0.5 * (seen->low[k] + seen->high[k]);
    ball->radius = fmin(ball->radius, 1.06 * radius);
    return true;
}

/* Sets eye and target of the default camera by casting rays to the bounded components, with the
   defaults of parameters.  Its direction and field of view are fixed.  Without bounded components
   nothing is changed. */
static KrsStatus frame_scene(KrsScene *scene)
{
    static const double towards[3] = {0.53, 0.37, 0.76};
    double              origins[RAYS][3], directions[RAYS][3];
    KrsHit              hits[RAYS];
    KrsFrame           *frame;
    KrsView             view;
    Sphere              ball;
    Extent              seen = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    if (!outer_ball(scene, &ball))
        return KRS_OK;
    KrsStatus status = frame_new(scene, &frame);
    if (status != KRS_OK)
        return status;
    frame->exact = true;
    int rays     = count_rays(scene);
    /* Each round makes the ball smaller, and so the rays of the next round denser. */
    for (int round = 0; round < ROUNDS; round++) {
        make_rays(&ball, rays, origins, directions);
        if (!cast_rays(frame, (const double(*)[3])origins, (const double(*)[3])directions, rays,
                       ball.radius, hits))
            break;
        add_hits(scene, hits, rays, &seen);
        if (!inner_ball(&seen, &ball))
            break;
    }
    frame_view(frame, 0, &view);
    frame_free(frame);
    scene->framed = true;
    memcpy(scene->framed_target, ball.centre, sizeof ball.centre);
    for (int k = 0; k < 3; k++)
        scene->framed_eye[k] = ball.centre[k] +
                               towards[k] * ball.radius / sin(0.5 * view.camera.fov);
    return KRS_OK;
}

KrsStatus pass_frame(Compilation *c)
{
    return c->scene->cameras[0].standing_in ? frame_scene(c->scene) : KRS_OK;
}

static void print_camera(const KrsScene *scene, size_t index, const KrsCamera *camera, Text *out)
{
    static const char *const projections[] = {[KRS_PERSPECTIVE]  = "perspective",
                                              [KRS_ORTHOGRAPHIC] = "orthographic",
                                              [KRS_PANORAMA]     = "panorama"};
    const char              *name          = scene->cameras[index].name;
    text_format(out, "camera %zu%s%s  %s", index + 1, name ? " " : "", name ? name : "",
                projections[camera->projection]);
    text_format(out, "  eye %.6g %.6g %.6g  target %.6g %.6g %.6g", camera->eye[0], camera->eye[1],
                camera->eye[2], camera->target[0], camera->target[1], camera->target[2]);
    text_format(out, "  fov %.6g  height %.6g%s\n", camera->fov, camera->height,
                scene->framed && index == 0 ? "  placed" : "");
}

void print_frame(Compilation *c, Text *out)
{
    KrsFrame *frame;
    KrsView   view;
    if (frame_new(c->scene, &frame) != KRS_OK) {
        text_add(out, "no frame: out of memory\n");
        return;
    }
    for (size_t i = 0; i < c->scene->camera_count; i++)
        if (frame_view(frame, i, &view) == KRS_OK)
            print_camera(c->scene, i, &view.camera, out);
    frame_free(frame);
}
