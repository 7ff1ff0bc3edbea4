/*
 * query.c: frames and questions: the scene at given parameters and time, in double precision.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/program.h"

struct KrsFrame {
    const KrsScene *scene;
    NodeValue      *parameters; /* the parameter block: slot 0 is the time */
    NodeValue      *values;     /* of every node */
    KrsLight       *lights;
    bool            fresh;      /* frame values are of these parameters */
};

/* ---- frames ---- */

/* Zeroed memory of the scene's allocator; NULL: there is none. */
static void *take(const KrsScene *scene, size_t count, size_t size)
{
    const Memory *memory = &scene->memory;
    size_t        bytes  = (count ? count : 1) * size;
    void         *block  = memory->allocate ? memory->allocate(memory->user, bytes) : malloc(bytes);
    if (block)
        memset(block, 0, bytes);
    return block;
}

static void give(const KrsScene *scene, void *block)
{
    const Memory *memory = &scene->memory;
    if (block && memory->allocate)
        memory->release(memory->user, block);
    else
        free(block);
}

KrsStatus krs_frame_new(const KrsScene *scene, KrsFrame **result)
{
    *result         = NULL;
    KrsFrame *frame = take(scene, 1, sizeof *frame);
    if (!frame)
        return KRS_OUT_OF_MEMORY;
    frame->scene      = scene;
    frame->parameters = take(scene, scene->program.parameter_slots, sizeof *frame->parameters);
    frame->values     = take(scene, scene->graph->count, sizeof *frame->values);
    frame->lights     = take(scene, scene->light_count, sizeof *frame->lights);
    if (!frame->parameters || !frame->values || !frame->lights) {
        krs_frame_free(frame);
        return KRS_OUT_OF_MEMORY;
    }
    for (size_t i = 0; i < scene->parameter_count; i++)
        memcpy(frame->parameters[scene->parameters[i].slot].v, scene->parameters[i].value,
               sizeof scene->parameters[i].value);
    *result = frame;
    return KRS_OK;
}

void krs_frame_free(KrsFrame *frame)
{
    if (!frame)
        return;
    const KrsScene *scene = frame->scene;
    give(scene, frame->parameters);
    give(scene, frame->values);
    give(scene, frame->lights);
    give(scene, frame);
}

/* Values that depend on parameters only, once after each change. */
static void refresh(KrsFrame *frame)
{
    if (frame->fresh)
        return;
    tape_run_frame(&frame->scene->surface, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->distance, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->view, frame->parameters, frame->values);
    frame->fresh = true;
}

static bool node_is_finite(const KrsFrame *frame, Node node)
{
    const Expr *e = &frame->scene->graph->items[node];
    for (uint32_t k = 0; e->time != TIME_POINT && e->type <= TYPE_VEC4 && k < (uint32_t)e->type; k++)
        if (!isfinite(frame->values[node].v[k]))
            return false;
    return true;
}

/* Whether all that points and the view get from the frame are numbers.  A value that is chosen
   against, as in `if a == 0 then 1 else 1 / a`, is not used and does not count. */
static bool frame_is_finite(KrsFrame *frame)
{
    const KrsScene *scene = frame->scene;
    const Node     *roots = camera_roots(scene, 0), *end = sky_roots(scene) + SKY_ROOTS;
    refresh(frame);
    for (const Node *root = roots; root < end; root++)
        if (!node_is_finite(frame, *root))
            return false;
    for (size_t i = scene->surface.frame_count; i < scene->surface.count; i++) {
        const Expr *e = &scene->graph->items[scene->surface.nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            if (!node_is_finite(frame, e->operands[k]))
                return false;
    }
    return true;
}

/* Gives slot `slot` of the parameter block new values, unless the scene cannot have them. */
static KrsStatus change_slot(KrsFrame *frame, uint32_t slot, const double *values, size_t count)
{
    NodeValue before = frame->parameters[slot];
    memcpy(frame->parameters[slot].v, values, count * sizeof *values);
    frame->fresh = false;
    if (frame_is_finite(frame))
        return KRS_OK;
    frame->parameters[slot] = before;
    frame->fresh            = false;
    return KRS_BAD_ARGUMENT;
}

KrsStatus krs_frame_set(KrsFrame *frame, const char *name, const double *values, size_t count)
{
    const KrsScene *scene = frame->scene;
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const Parameter *parameter = &scene->parameters[i];
        if (strcmp(parameter->name, name) != 0)
            continue;
        if (count != parameter->components)
            return KRS_BAD_ARGUMENT;
        for (size_t k = 0; k < count; k++)
            if (!isfinite(values[k]) || values[k] < parameter->low[k] ||
                values[k] > parameter->high[k])
                return KRS_BAD_ARGUMENT;
        return change_slot(frame, parameter->slot, values, count);
    }
    return KRS_BAD_ARGUMENT;
}

KrsStatus krs_frame_set_time(KrsFrame *frame, double time)
{
    return isfinite(time) ? change_slot(frame, 0, &time, 1) : KRS_BAD_ARGUMENT;
}

void krs_frame_parameters(const KrsFrame *frame, float (*block)[4])
{
    for (uint32_t i = 0; i < frame->scene->program.parameter_slots; i++)
        for (int k = 0; k < 4; k++)
            block[i][k] = (float)frame->parameters[i].v[k];
}

static void copy3(double to[3], const KrsFrame *frame, Node node)
{
    memcpy(to, frame->values[node].v, 3 * sizeof *to);
}

/* Any length but 0: squares of what is very long or short would overflow, or vanish. */
static void normalize3(double v[3])
{
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0))
        return;
    for (int i = 0; i < 3; i++)
        v[i] /= largest;
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

KrsStatus krs_frame_view(KrsFrame *frame, size_t camera, KrsView *view)
{
    const KrsScene *scene = frame->scene;
    if (camera >= scene->camera_count)
        return KRS_BAD_ARGUMENT;
    refresh(frame);
    const Node *root = camera_roots(scene, camera), *sky = sky_roots(scene);
    *view = (KrsView){.light_count = scene->light_count, .lights = frame->lights};
    view->camera.projection = scene->cameras[camera].projection;
    copy3(view->camera.eye, frame, root[0]);
    copy3(view->camera.target, frame, root[1]);
    copy3(view->camera.up, frame, root[2]);
    if (scene->framed && camera == 0) {
        memcpy(view->camera.eye, scene->framed_eye, sizeof view->camera.eye);
        memcpy(view->camera.target, scene->framed_target, sizeof view->camera.target);
    }
    view->camera.fov    = frame->values[root[3]].v[0];
    view->camera.height = frame->values[root[4]].v[0];
    copy3(view->sky.zenith, frame, sky[0]);
    copy3(view->sky.horizon, frame, sky[1]);
    copy3(view->sky.ground, frame, sky[2]);
    for (size_t i = 0; i < scene->light_count; i++) {
        const Node *light = light_roots(scene, i);
        KrsLight   *to    = &frame->lights[i];
        *to = (KrsLight){.positional = scene->lights[i].positional,
                         .shadow     = scene->lights[i].shadow,
                         .softness   = frame->values[light[2]].v[0]};
        copy3(to->vector, frame, light[0]);
        copy3(to->color, frame, light[1]);
        if (!to->positional)
            normalize3(to->vector);
    }
    const SceneImage *image = &scene->image;
    view->image = (KrsImage){image->width,    image->height,   image->samples, image->integrator,
                             image->exposure, image->tone_map, image->error};
    return KRS_OK;
}

/* ---- questions ---- */

/* The least distance of all components; *nearest is its component, from 1. */
static double distance_at(KrsFrame *frame, const double point[3], uint32_t *nearest)
{
    const KrsScene *scene = frame->scene;
    double          least = INFINITY;
    tape_run_point(&scene->distance, point, frame->values);
    for (size_t i = 0; i < scene->component_count; i++) {
        double distance = frame->values[scene->roots[i * ROOT_COUNT + ROOT_DISTANCE]].v[0];
        if (distance < least || i == 0) {
            least    = distance;
            *nearest = (uint32_t)i + 1;
        }
    }
    return least;
}

void krs_distance(KrsFrame *frame, const double (*points)[3], size_t count, double *distances)
{
    uint32_t nearest = 0;
    refresh(frame);
    for (size_t i = 0; i < count; i++)
        distances[i] = distance_at(frame, points[i], &nearest);
}

/* Central differences: in double precision their error is far below what a normal needs. */
static void normal_at(KrsFrame *frame, const double point[3], double normal[3])
{
    double   size = fmax(fabs(point[0]), fmax(fabs(point[1]), fabs(point[2])));
    double   step = 1e-6 * (1 + size);
    uint32_t nearest;
    for (int i = 0; i < 3; i++) {
        double before[3] = {point[0], point[1], point[2]};
        double after[3]  = {point[0], point[1], point[2]};
        before[i] -= step;
        after[i] += step;
        normal[i] = distance_at(frame, after, &nearest) - distance_at(frame, before, &nearest);
    }
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int i = 0; i < 3; i++)
        normal[i] = length > 1e-3 * step ? normal[i] / length : 0;
}

static void probe(KrsFrame *frame, const double point[3], KrsHit *hit)
{
    const KrsScene *scene = frame->scene;
    *hit                  = (KrsHit){.hit = true};
    memcpy(hit->point, point, sizeof hit->point);
    normal_at(frame, point, hit->normal);
    hit->distance = distance_at(frame, point, &hit->component);
    if (!hit->component)
        return;
    tape_run_point(&scene->surface, point, frame->values);
    const Node *root = &scene->roots[(hit->component - 1) * ROOT_COUNT];
    hit->level       = (uint32_t)frame->values[root[ROOT_LEVEL]].v[0];
    hit->instance    = (uint32_t)frame->values[root[ROOT_INSTANCE]].v[0];
    copy3(hit->color, frame, root[ROOT_COLOR]);
    hit->roughness = frame->values[root[ROOT_ROUGHNESS]].v[0];
    hit->metallic  = frame->values[root[ROOT_METALLIC]].v[0];
}

void krs_probe(KrsFrame *frame, const double (*points)[3], size_t count, KrsHit *hits)
{
    refresh(frame);
    for (size_t i = 0; i < count; i++)
        probe(frame, points[i], &hits[i]);
}

/* Sphere tracing (math.md, section 6) without relaxation.  A ray from inside of a solid sees
   the solid's inner wall. */
static void trace(KrsFrame *frame, const double origin[3], const double direction[3],
                  double farthest, double tolerance, KrsHit *hit)
{
    enum { MOST_STEPS = 100000 };
    double   unit[3] = {direction[0], direction[1], direction[2]}, point[3], t = 0, side = 0;
    uint32_t nearest;
    normalize3(unit);
    *hit = (KrsHit){0};
    for (int i = 0; i < MOST_STEPS && t <= farthest; i++) {
        for (int k = 0; k < 3; k++)
            point[k] = origin[k] + t * unit[k];
        double distance = distance_at(frame, point, &nearest);
        if (side == 0)
            side = distance < 0 ? -1 : 1;
        distance *= side;
        if (distance < (tolerance > 0 ? tolerance : 1e-9 * fmax(1, t))) {
            probe(frame, point, hit);
            hit->t = t;
            return;
        }
        t += distance;
    }
}

void krs_raycast(KrsFrame *frame, const double (*origins)[3], const double (*directions)[3],
                 size_t count, double farthest, double tolerance, KrsHit *hits)
{
    refresh(frame);
    for (size_t i = 0; i < count; i++)
        trace(frame, origins[i], directions[i], farthest, tolerance, &hits[i]);
}
