/*
 * query.c: points and rays that a program asks about, answered by the device.
 *
 * Rays are marched by query.comp; then point_query.comp says what is where they hit, as it does at
 * points.  Both work on a batch at a time.  What can be done in double precision before and
 * after is: rays are brought to the box around the scene, t is counted from the origin, and rays
 * that begin on a surface, as far as the device can tell, are followed by the host if the device
 * took the wrong side.
 */
#include "runtime/tracer/query.h"

#include <math.h>
#include <string.h>

#include "runtime/shared/answers.h"
#include "runtime/tracer/job.h"
#include "runtime/tracer/shaders.h"
#include "runtime/tracer/layouts.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"
#include "runtime/tracer/slots.h"

enum { MAX_STEPS = 8192 };

/* Tells whether single precision can square the vectors. */
static bool is_in_reach(const double (*vectors)[3], size_t count)
{
    if (!vectors)
        return count == 0;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(vectors[i][k]) <= KRS_MAX_COORDINATE))
                return false;
    return true;
}

static KrsStatus refuse(KrsRendering *rendering, const char *words)
{
    gpu_refuse(&rendering->renderer->gpu, KRS_BAD_ARGUMENT, "%s", words);
    return KRS_BAD_ARGUMENT;
}

static void widen(const float *numbers, size_t count, double *to)
{
    for (size_t k = 0; k < count; k++)
        to[k] = numbers[k];
}

static void describe(const AnswerBlock *answer, KrsHit *hit)
{
    hit->distance = answer->distance;
    widen(answer->gradient, 3, hit->normal);
    widen(answer->normal, 3, hit->shading);
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) hit->name = answer->name[0];
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    widen(answer->name, sizeof hit->name / sizeof(double), (double *)&hit->name);
#include "krs/surface.def"
}

/* ---- bases ---- */

/* Points may be so many times as far from the base as from the middle between them: normals are differences
   over a thousandth of the coordinates, which may be a hundredth of what is seen then. */
static const double MAX_REACH = 10;
/* The size of the surroundings of a single point, in parts of the scene. */
static const double PART_OF_SCENE = 0.1;

/* The asking program, and the base that points on the device are relative to. */
typedef struct Asker {
    KrsRendering *rendering;
    KrsState     *state;
    double        base[3];
    double        step; /* the least one to a tap for a normal */
} Asker;

static bool move_base(Asker *asker, const double base[3])
{
    memcpy(asker->base, base, sizeof asker->base);
    return rendering_set_parameters(asker->rendering, asker->state, base) &&
           rendering_rebase(asker->rendering, asker->state, base);
}

/* Finds the base that answers want, if the present one is too far away, and the least step to a tap: a
   ten thousandth of the scene, or less where less of it is seen. */
static bool wants_base(Asker *asker, const KrsHit *hits, uint32_t count, double base[3])
{
    const double size = point_query_size(asker->rendering), least = 1e-5 * fmin(1, size);
    double       low[3], high[3], reach = 0, half = 0;
    uint32_t     found = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3 && hits[i].hit; k++) {
            const double at = hits[i].point[k];
            low[k]          = found ? fmin(low[k], at) : at;
            high[k]         = found ? fmax(high[k], at) : at;
            reach           = fmax(reach, fabs(at - asker->base[k]));
            found += k == 2;
        }
    for (int k = 0; k < 3 && found > 0; k++) {
        base[k] = 0.5 * (low[k] + high[k]);
        half    = fmax(half, 0.5 * (high[k] - low[k]));
    }
    if (found <= 1)
        half = PART_OF_SCENE * size;
    asker->step = fmax(least, fmin(10 * least, 1e-3 * half));
    return rendering_rebases(asker->rendering) && reach > MAX_REACH * half;
}

/* ---- points ---- */

static bool probe_batch(Asker *asker, const double (*points)[3], uint32_t count, KrsHit *hits)
{
    KrsRendering *rendering = asker->rendering;
    PointBlock   *to        = rendering->points.bytes;
    double        base[3];
    for (uint32_t i = 0; i < count; i++) {
        hits[i] = (KrsHit){.hit = true};
        memcpy(hits[i].point, points[i], sizeof hits[i].point);
    }
    if (wants_base(asker, hits, count, base) && !move_base(asker, base))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        to[i] = (PointBlock){0};
        for (int k = 0; k < 3; k++)
            to[i].point[k] = (float)(points[i][k] - asker->base[k]);
    }
    if (!point_query_run(rendering, count, asker->step))
        return false;
    const AnswerBlock *answers = rendering->answers.bytes;
    for (uint32_t i = 0; i < count; i++)
        describe(&answers[i], &hits[i]);
    return true;
}

static uint32_t batch_of(size_t left)
{
    return left < POINTS_AT_ONCE ? (uint32_t)left : POINTS_AT_ONCE;
}

KrsStatus krs_device_probe(KrsRendering *rendering, KrsState *state, const double (*points)[3],
                           size_t count, KrsHit *hits)
{
    Asker asker = {rendering, state, {0}, POINT_QUERY_STEP};
    if (!rendering_ready(rendering->renderer))
        return rendering->renderer->gpu.status;
    if (!is_in_reach(points, count))
        return refuse(rendering, "a coordinate is not a number below 1e18");
    if (!point_query_prepare(rendering) || !rendering_set_parameters(rendering, state, NULL))
        return rendering->renderer->gpu.status;
    for (size_t first = 0; first < count; first += POINTS_AT_ONCE)
        if (!probe_batch(&asker, points + first, batch_of(count - first), hits + first))
            return rendering->renderer->gpu.status;
    return KRS_OK;
}

/* ---- rays ---- */

static bool prepare(KrsRendering *rendering)
{
    Gpu *gpu = &rendering->renderer->gpu;
    const struct {
        Buffer     *buffer;
        uint32_t    binding;
        size_t      size; /* for one ray */
        const char *name;
    } wanted[] = {
        {&rendering->query_rays, QUERY_RAYS_BINDING, sizeof(QueryRayBlock), "questions"},
        {&rendering->ray_hits, RAY_HITS_BINDING, sizeof(RayHitBlock), "rays"},
        {&rendering->taken, TAKEN_BINDING, sizeof(uint32_t), "shares of lanes"},
    };
    if (!point_query_prepare(rendering))
        return false;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        if (!wanted[i].buffer->buffer &&
            !buffer_create(gpu, wanted[i].buffer, POINTS_AT_ONCE * wanted[i].size, SHARED,
                           wanted[i].name))
            return false;
        rendering_bind(rendering, rendering->points_set, wanted[i].binding, wanted[i].buffer);
    }
    return true;
}

static void set_frame(KrsRendering *rendering, double tolerance)
{
    const FrameBlock frame = {.error = (float)tolerance, .max_steps = MAX_STEPS};
    memcpy(rendering->frame.bytes, &frame, sizeof frame);
}

/* A ray of the device begins where the box around the scene does. */
static QueryRayBlock query_ray_block(const KrsRay *ray, const double base[3])
{
    QueryRayBlock query_ray = {.end  = (float)fmin(ray->end - ray->start, KRS_MAX_COORDINATE),
                               .kind = ray->start > 0 ? BEGINS_OUTSIDE
                                       : ray->walls   ? ENDS_AT_WALLS
                                                      : ENDS_ANYWHERE};
    for (int k = 0; k < 3; k++) {
        query_ray.origin[k]    = (float)(ray->origin[k] + ray->start * ray->direction[k] - base[k]);
        query_ray.direction[k] = (float)ray->direction[k];
    }
    if (!(ray->start <= ray->end))
        query_ray = (QueryRayBlock){.end = -1};
    return query_ray;
}

/* Marches the rays.  As in run_rays of plan.c a lane has a few items, and those for which a
   dispatch had no steps left are for the next one. */
static bool march_rays(KrsRendering *rendering, uint32_t count)
{
    Gpu        *gpu      = &rendering->renderer->gpu;
    KrsTrace    trace    = KRS_TRACE_DEFAULT;
    KrsSchedule schedule = KRS_SCHEDULE_DEFAULT;
    rendering_choose(rendering, &trace, &schedule);
    bool          refill = schedule == KRS_SCHEDULE_REFILL;
    uint32_t      lanes = refill ? gpu->refill_lanes : 64, items_per_lane = refill ? 128 : 1;
    const Shader *shader = rendering_query(rendering, schedule);
    while (lanes * items_per_lane > 64 && count / (lanes * items_per_lane) < 64)
        items_per_lane /= 2; /* groups enough for every core of the device */
    uint32_t  groups = (count + lanes * items_per_lane - 1) / (lanes * items_per_lane);
    WorkBlock work   = {
          .steps  = rendering_steps_within(rendering, refill ? MAX_LANE_STEPS : MAX_STEPS),
          .groups = groups,
          .stride = rendering_spread(rendering, groups)};
    ControlBlock *control = rendering->control.bytes;
    *control              = (ControlBlock){
                     .source = ITEMS_FRESH, .items = count, .items_per_lane = items_per_lane};
    for (bool more = shader != NULL; more; control->source = ITEMS_UNTAKEN) {
        double ms        = 0;
        control->untaken = 0;
        if (!rendering_begin(rendering))
            return false;
        rendering_dispatch(rendering, shader, rendering->points_set, &work, sizeof work, groups);
        if (!rendering_finish(rendering, &ms))
            return false;
        more = control->untaken > 0;
    }
    return shader != NULL;
}

bool ray_hits_are_valid(const RayHitBlock *ray_hits, uint32_t count, uint32_t ends)
{
    bool sound = ends <= count;
    for (uint32_t i = 0; i < count && sound; i++)
        sound = ray_hits[i].state == STATE_MISS ||
                (ray_hits[i].state < STATE_MISS && ray_hits[i].point < ends);
    return sound;
}

static void take_ray_hit(const KrsRay *ray, const RayHitBlock *ray_hit, const AnswerBlock *answers,
                         KrsHit *hit)
{
    *hit = (KrsHit){0};
    if (ray_hit->state == STATE_MISS)
        return;
    hit->hit        = ray_hit->state == STATE_HIT;
    hit->unresolved = !hit->hit;
    hit->t          = ray->start + (double)ray_hit->t;
    for (int k = 0; k < 3; k++)
        hit->point[k] = ray->origin[k] + hit->t * ray->direction[k];
    describe(&answers[ray_hit->point], hit);
}

/* Tells whether a ray took the wrong side.  Single precision cannot tell on which side of a surface
   a ray begins that is as near to it as rounding: on the wrong one it would go through the solid,
   or past its end.  The host can. */
static bool took_wrong_side(KrsState *state, const RayHitBlock *ray_hit, const double (*origin)[3])
{
    bool   inside = ray_hit->steps & QUERY_BEGINS_INSIDE;
    double distance;
    return (ray_hit->steps & QUERY_SIDE_UNKNOWN) &&
           krs_distance(state, origin, 1, &distance) == KRS_OK && (distance < 0) != inside;
}

/* Rays that are asked about. */
typedef struct Question {
    const double (*origins)[3], (*directions)[3];
    double farthest, tolerance;
} Question;

static bool answer_rays(Asker *asker, const Question *ask, uint32_t count, KrsHit *hits)
{
    KrsRendering   *rendering  = asker->rendering;
    const KrsScene *scene      = rendering->scene;
    QueryRayBlock  *query_rays = rendering->query_rays.bytes;
    for (uint32_t i = 0; i < count; i++) {
        KrsRay ray    = krs_ray(scene, ask->origins[i], ask->directions[i], ask->farthest);
        query_rays[i] = query_ray_block(&ray, asker->base);
    }
    if (!march_rays(rendering, count))
        return false;
    const ControlBlock *control  = rendering->control.bytes;
    const RayHitBlock  *ray_hits = rendering->ray_hits.bytes;
    uint32_t            ends     = control->hit_count;
    if (!ray_hits_are_valid(ray_hits, count, ends)) {
        gpu_refuse(&rendering->renderer->gpu, KRS_INTERNAL,
                   "cannot read where rays end: the device answers with numbers that cannot be");
        return false;
    }
    if (ends > 0 && !point_query_run(rendering, ends, asker->step))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        KrsRay ray = krs_ray(scene, ask->origins[i], ask->directions[i], ask->farthest);
        take_ray_hit(&ray, &ray_hits[i], rendering->answers.bytes, &hits[i]);
        if (took_wrong_side(asker->state, &ray_hits[i], ask->origins + i))
            krs_raycast(asker->state, ask->origins + i, ask->directions + i, 1, ask->farthest,
                        ask->tolerance, hits + i);
    }
    return true;
}

/* Looks at some rays of a batch, which tell what is hit, also where single precision would miss
   it. */
static bool look(Asker *asker, const Question *ask, uint32_t count)
{
    enum { MAX_LOOKS = 16 };
    KrsHit         hits[MAX_LOOKS];
    const uint32_t looks = count < MAX_LOOKS ? count : MAX_LOOKS;
    double         base[3];
    for (uint32_t i = 0; i < looks; i++) {
        const size_t ray = (size_t)i * count / looks;
        if (krs_raycast(asker->state, ask->origins + ray, ask->directions + ray, 1, ask->farthest,
                        ask->tolerance, hits + i) != KRS_OK)
            hits[i].hit = false;
    }
    return !wants_base(asker, hits, looks, base) || move_base(asker, base);
}

/* Casts a batch of rays; all that is hit is known when they have been marched. */
static bool raycast_batch(Asker *asker, const Question *ask, uint32_t count, KrsHit *hits)
{
    double base[3];
    return (!rendering_rebases(asker->rendering) || look(asker, ask, count)) &&
           answer_rays(asker, ask, count, hits) &&
           (!wants_base(asker, hits, count, base) ||
            (move_base(asker, base) && answer_rays(asker, ask, count, hits)));
}

KrsStatus krs_device_raycast(KrsRendering *rendering, KrsState *state, const double (*origins)[3],
                             const double (*directions)[3], size_t count, double farthest,
                             double tolerance, KrsHit *hits)
{
    Asker asker = {rendering, state, {0}, POINT_QUERY_STEP};
    if (!rendering_ready(rendering->renderer))
        return rendering->renderer->gpu.status;
    if (!krs_rays_are_valid(origins, directions, count, farthest, tolerance) ||
        !is_in_reach(origins, count) || tolerance > KRS_MAX_COORDINATE)
        return refuse(rendering, "rays have finite origins below 1e18, directions that are not 0, "
                                 "and neither end nor tolerance below 0");
    if (!prepare(rendering) || !rendering_set_parameters(rendering, state, NULL))
        return rendering->renderer->gpu.status;
    set_frame(rendering, tolerance);
    for (size_t first = 0; first < count; first += POINTS_AT_ONCE) {
        const Question ask = {origins + first, directions + first, farthest, tolerance};
        if (!raycast_batch(&asker, &ask, batch_of(count - first), hits + first))
            return rendering->renderer->gpu.status;
    }
    return KRS_OK;
}
