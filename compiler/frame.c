/*
 * frame.c: what varies from frame to frame: parameters, time, zones; and what a picture needs of
 * them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/program.h"

/* Zeroed memory of the scene's allocator; NULL: there is none. */
static void *frame_alloc(const KrsScene *scene, size_t count, size_t size)
{
    const Memory *memory = &scene->memory;
    size_t        bytes  = (count ? count : 1) * size;
    void         *block  = memory->allocate ? memory->allocate(memory->user, bytes) : malloc(bytes);
    if (block)
        memset(block, 0, bytes);
    return block;
}

static void frame_release(const KrsScene *scene, void *block)
{
    const Memory *memory = &scene->memory;
    if (block && memory->allocate)
        memory->release(memory->user, block);
    else
        free(block);
}

#define ANY_SLOT UINT32_MAX

static size_t slope_workspace(const KrsScene *scene)
{
    size_t most = 0;
    for (size_t i = 0; i < scene->slope_count; i++) {
        size_t workspace = slope_task_size(&scene->slopes[i].task);
        most             = workspace > most ? workspace : most;
    }
    return most;
}

static bool depends_on(const Tape *tape, uint32_t slot)
{
    for (size_t i = 0; i < tape->frame_count; i++) {
        const Expr *e = &tape->graph->items[tape->nodes[i]];
        if (e->op == OP_PARAMETER && (e->index == slot || slot == ANY_SLOT))
            return true;
    }
    return false;
}

/* Finds the slopes that depend on a slot; false, with `unbounded` set: one has no bound. */
static bool find_slopes(KrsFrame *frame, uint32_t changed)
{
    const double(*parameters)[4] = (const double(*)[4])frame->parameters;
    frame->unbounded             = NULL;
    for (size_t i = 0; i < frame->scene->slope_count; i++) {
        const RetainedSlope *slope = &frame->scene->slopes[i];
        if (!depends_on(&slope->task.tape, changed))
            continue;
        double found = slope_task_run(&slope->task, parameters, frame->workspace, NULL);
        found        = frame_slope_upward(found);
        frame->parameters[slope->slot].v[0] = found;
        if (!isfinite(found) && !frame->unbounded)
            frame->unbounded = slope->place;
    }
    return !frame->unbounded;
}

KrsStatus krs_frame_new(const KrsScene *scene, KrsFrame **result)
{
    *result         = NULL;
    KrsFrame *frame = frame_alloc(scene, 1, sizeof *frame);
    if (!frame)
        return KRS_OUT_OF_MEMORY;
    frame->scene      = scene;
    frame->parameters = frame_alloc(scene, scene->program.parameter_slots,
                                    sizeof *frame->parameters);
    frame->values     = frame_alloc(scene, scene->graph->count, sizeof *frame->values);
    frame->lights     = frame_alloc(scene, scene->light_count, sizeof *frame->lights);
    frame->workspace  = frame_alloc(scene, slope_workspace(scene), 1);
    if (!frame->parameters || !frame->values || !frame->lights || !frame->workspace) {
        krs_frame_free(frame);
        return KRS_OUT_OF_MEMORY;
    }
    for (size_t i = 0; i < scene->parameter_count; i++)
        memcpy(frame->parameters[scene->parameters[i].slot].v, scene->parameters[i].value,
               sizeof scene->parameters[i].value);
    if (!find_slopes(frame, ANY_SLOT)) { /* such a scene should not have compiled */
        krs_frame_free(frame);
        return KRS_INTERNAL;
    }
    *result = frame;
    return KRS_OK;
}

void krs_frame_free(KrsFrame *frame)
{
    if (!frame)
        return;
    const KrsScene *scene = frame->scene;
    frame_release(scene, frame->parameters);
    frame_release(scene, frame->values);
    frame_release(scene, frame->lights);
    frame_release(scene, frame->workspace);
    frame_release(scene, frame);
}

void frame_refresh(KrsFrame *frame)
{
    if (frame->fresh)
        return;
    tape_run_frame(&frame->scene->surface, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->distance, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->guarded, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->ahead, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->turned, frame->parameters, frame->values);
    tape_run_frame(&frame->scene->view, frame->parameters, frame->values);
    frame->fresh = true;
}

Node frame_infinite(KrsFrame *frame)
{
    const KrsScene *scene = frame->scene;
    const Node     *end   = scene->roots.sky + SKY_ROOTS;
    frame_refresh(frame);
    for (const Node *root = scene->roots.cameras; root < end; root++)
        if (!node_value_is_finite(scene->graph, *root, frame->values))
            return *root;
    Node found = tape_frame_infinite(&scene->surface, frame->values);
    return found != NODE_NONE ? found : tape_frame_infinite(&scene->distance, frame->values);
}

/* Gives slot `slot` of the parameter block new values, unless the scene cannot have them. */
static KrsStatus change_slot(KrsFrame *frame, uint32_t slot, const double *values, size_t count)
{
    NodeValue before = frame->parameters[slot];
    memcpy(frame->parameters[slot].v, values, count * sizeof *values);
    frame->fresh = false;
    if (find_slopes(frame, slot) && frame_infinite(frame) == NODE_NONE)
        return KRS_OK;
    const char *unbounded   = frame->unbounded;
    frame->parameters[slot] = before;
    frame->fresh            = false;
    find_slopes(frame, slot);
    frame->unbounded = unbounded;
    return KRS_BAD_ARGUMENT;
}

KrsStatus krs_frame_set(KrsFrame *frame, const char *name, const double *values, size_t count)
{
    const KrsScene *scene = frame->scene;
    frame->unbounded      = NULL;
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

const char *krs_frame_unbounded(const KrsFrame *frame) { return frame->unbounded; }

KrsStatus krs_frame_set_time(KrsFrame *frame, double time)
{
    frame->unbounded = NULL;
    return isfinite(time) ? change_slot(frame, 0, &time, 1) : KRS_BAD_ARGUMENT;
}

/* Single precision can square them. */
static bool zone_is_valid(const double zone[4])
{
    const double most = 1e18;
    for (int k = 0; k < 4; k++)
        if (!(fabs(zone[k]) <= most))
            return false;
    return zone[3] >= 0;
}

KrsStatus krs_frame_set_zones(KrsFrame *frame, const double (*zones)[4], size_t count)
{
    if (count > KRS_MOST_ZONES)
        return KRS_BAD_ARGUMENT;
    for (size_t i = 0; i < count; i++)
        if (!zone_is_valid(zones[i]))
            return KRS_BAD_ARGUMENT;
    if (count > 0)
        memmove(frame->zones, zones, count * sizeof *zones);
    frame->zone_count = count;
    return KRS_OK;
}

size_t krs_frame_zones(const KrsFrame *frame, float (*zones)[4])
{
    for (size_t i = 0; i < frame->zone_count; i++)
        for (int k = 0; k < 4; k++)
            zones[i][k] = (float)frame->zones[i][k];
    return frame->zone_count;
}

/* The origin has the last slot. */
void krs_frame_rebase(KrsFrame *frame, const double rebase_origin[3], float (*block)[4])
{
    const KrsScene *scene = frame->scene;
    if (!scene->program.camera_relative)
        return;
    memcpy(frame->parameters[scene->program.parameter_slots - 1].v, rebase_origin,
           3 * sizeof *rebase_origin);
    frame_values_find(&scene->module.slots.camera_relative, frame->parameters, frame->values,
                      block);
}

void krs_frame_values(const KrsFrame *frame, float (*block)[4])
{
    frame_values_find(&frame->scene->module.slots.plain, frame->parameters, frame->values, block);
}

void krs_frame_parameters(const KrsFrame *frame, float (*block)[4])
{
    for (uint32_t i = 0; i < frame->scene->program.parameter_slots; i++)
        for (int k = 0; k < 4; k++)
            block[i][k] = (float)frame->parameters[i].v[k];
}

void frame_copy(const KrsFrame *frame, Node node, double to[3])
{
    memcpy(to, frame->values[node].v, 3 * sizeof *to);
}

void vector_normalize(double v[3])
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
    frame_refresh(frame);
    const Node *root = scene->roots.cameras + camera * CAMERA_ROOTS, *sky = scene->roots.sky;
    *view                   = (KrsView){.light_count = scene->light_count, .lights = frame->lights};
    view->camera.projection = scene->cameras[camera].projection;
    frame_copy(frame, root[0], view->camera.eye);
    frame_copy(frame, root[1], view->camera.target);
    frame_copy(frame, root[2], view->camera.up);
    if (scene->framed && camera == 0) {
        memcpy(view->camera.eye, scene->framed_eye, sizeof view->camera.eye);
        memcpy(view->camera.target, scene->framed_target, sizeof view->camera.target);
    }
    view->camera.fov    = frame->values[root[3]].v[0];
    view->camera.height = frame->values[root[4]].v[0];
    frame_copy(frame, sky[0], view->sky.zenith);
    frame_copy(frame, sky[1], view->sky.horizon);
    frame_copy(frame, sky[2], view->sky.ground);
    for (size_t i = 0; i < scene->light_count; i++) {
        const Node *light = scene->roots.lights + i * LIGHT_ROOTS;
        KrsLight   *to    = &frame->lights[i];
        *to               = (KrsLight){.positional = scene->lights[i].positional,
                                       .shadow     = scene->lights[i].shadow,
                                       .softness   = frame->values[light[2]].v[0]};
        frame_copy(frame, light[0], to->vector);
        frame_copy(frame, light[1], to->color);
        if (!to->positional)
            vector_normalize(to->vector);
    }
    const SceneImage *image = &scene->image;
    view->image = (KrsImage){image->width,    image->height,   image->samples, image->integrator,
                             image->exposure, image->tone_map, image->error};
    return KRS_OK;
}
