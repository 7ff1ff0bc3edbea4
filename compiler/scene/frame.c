/*
 * frame.c: frames: the values of parameters, time and zones, and the view that depends on them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/scene/points.h"
#include "compiler/scene/program.h"
#include "compiler/shape/slope.h"

/* Zeroed memory from the scene's allocator, or NULL. */
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

static size_t slope_workspace(const KrsScene *scene)
{
    size_t most = 0;
    for (size_t i = 0; i < scene->slope_count; i++) {
        size_t workspace = slope_task_size(&scene->slopes[i].task);
        most             = workspace > most ? workspace : most;
    }
    return most;
}

/* Computes the slopes and the floor that depend on a slot.  False, and `unbounded` is set, if one has no
   bound. */
static bool find_slopes(KrsState *frame, uint32_t changed)
{
    const double(*parameters)[4] = (const double(*)[4])frame->parameters;
    frame->unbounded             = NULL;
    for (size_t i = 0; i < frame->scene->slope_count; i++) {
        const RetainedSlope *slope = &frame->scene->slopes[i];
        if (!tape_depends_on(&slope->task.tape, changed))
            continue;
        double found = slope_task_run(&slope->task, parameters, frame->workspace, NULL);
        found        = frame_slope_upward(found);
        frame->parameters[slope->slot].v[0] = found;
        if (!isfinite(found) && !frame->unbounded)
            frame->unbounded = slope->place;
    }
    frame_find_floor(frame, changed);
    return !frame->unbounded;
}

KrsStatus frame_new(const KrsScene *scene, KrsState **result)
{
    *result         = NULL;
    KrsState *frame = frame_alloc(scene, 1, sizeof *frame);
    if (!frame)
        return KRS_OUT_OF_MEMORY;
    frame->scene      = scene;
    frame->parameters = frame_alloc(scene, scene->program.parameter_slots,
                                    sizeof *frame->parameters);
    frame->values     = frame_alloc(scene, scene->graph->count, sizeof *frame->values);
    frame->lights     = frame_alloc(scene, scene->light_count, sizeof *frame->lights);
    frame->lit        = frame_alloc(scene, scene->emissive_count, sizeof *frame->lit);
    frame->workspace  = frame_alloc(scene, slope_workspace(scene), 1);
    frame->boxes      = frame_alloc(scene, scene->boxes.shapes.count, sizeof *frame->boxes);
    frame->sky        = frame_alloc(scene, scene->daylight ? DAYLIGHT_WIDTH * DAYLIGHT_HEIGHT : 0,
                                    sizeof *frame->sky);
    if (!frame->parameters || !frame->values || !frame->lights || !frame->workspace ||
        !frame->boxes || !frame->sky || !frame->lit || !frame_tables_new(frame)) {
        frame_free(frame);
        return KRS_OUT_OF_MEMORY;
    }
    memcpy(frame->framed_eye, scene->framed_eye, sizeof frame->framed_eye);
    memcpy(frame->framed_target, scene->framed_target, sizeof frame->framed_target);
    for (size_t i = 0; i < scene->parameter_count; i++)
        memcpy(frame->parameters[scene->parameters[i].slot].v, scene->parameters[i].value,
               sizeof scene->parameters[i].value);
    if (!find_slopes(frame, ANY_SLOT)) { /* a bug: the compiler refuses such scenes */
        frame_free(frame);
        return KRS_INTERNAL;
    }
    *result = frame;
    return KRS_OK;
}

void frame_free(KrsState *frame)
{
    if (!frame)
        return;
    const KrsScene *scene = frame->scene;
    frame_lanes_free(frame);
    frame_tables_free(frame);
    frame_release(scene, frame->parameters);
    frame_release(scene, frame->values);
    frame_release(scene, frame->lights);
    frame_release(scene, frame->sky);
    frame_release(scene, frame->lit);
    frame_release(scene, frame->workspace);
    frame_release(scene, frame->boxes);
    frame_release(scene, frame);
}

KrsStatus frame_copy_of(const KrsState *frame, KrsState **copy)
{
    KrsStatus status = frame_new(frame->scene, copy);
    if (status != KRS_OK)
        return status;
    memcpy((*copy)->parameters, frame->parameters,
           frame->scene->program.parameter_slots * sizeof *frame->parameters);
    memcpy((*copy)->framed_eye, frame->framed_eye, sizeof frame->framed_eye);
    memcpy((*copy)->framed_target, frame->framed_target, sizeof frame->framed_target);
    memcpy((*copy)->zones, frame->zones, sizeof frame->zones);
    (*copy)->zone_count = frame->zone_count;
    return KRS_OK;
}

void frame_refresh(KrsState *frame)
{
    if (frame->fresh)
        return;
    tape_run_frame(&frame->scene->frame, frame->parameters, frame->values);
    frame->fresh = true;
    frame_tables_change(frame);
    frame_lanes_refresh(frame);
}

void frame_refresh_points(KrsState *frame)
{
    frame_refresh(frame);
    frame_tables_refresh(frame);
}

Node frame_infinite(KrsState *frame)
{
    const KrsScene *scene = frame->scene;
    RootRange       view  = roots_from(&scene->roots, ROOTS_CAMERA, ROOTS_SKY);
    frame_refresh(frame);
    for (size_t i = 0; i < view.count; i++)
        if (!node_value_is_finite(scene->graph, view.items[i], frame->values))
            return view.items[i];
    Node found = tape_frame_infinite(&scene->surface, frame->values);
    return found != NODE_NONE ? found : tape_frame_infinite(&scene->distance, frame->values);
}

/* Sets the values of a slot of the parameter block, unless the scene would not be finite. */
static KrsStatus change_slot(KrsState *frame, uint32_t slot, const double *values, size_t count)
{
    NodeValue before = frame->parameters[slot];
    if (memcmp(before.v, values, count * sizeof *values) == 0)
        return KRS_OK; /* viewers set all parameters when one changes */
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

KrsStatus krs_state_set(KrsState *frame, const char *name, const double *values, size_t count)
{
    const KrsScene *scene = frame->scene;
    frame->unbounded      = NULL;
    if (!name || (!values && count > 0))
        return KRS_BAD_ARGUMENT;
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

const char *krs_state_unbounded(const KrsState *frame) { return frame->unbounded; }

KrsStatus krs_state_set_time(KrsState *frame, double time)
{
    frame->unbounded = NULL;
    return isfinite(time) ? change_slot(frame, 0, &time, 1) : KRS_BAD_ARGUMENT;
}

double krs_state_time(const KrsState *frame) { return frame->parameters[0].v[0]; }

/* Tells whether a parameter of a frame has another value than its default. */
static bool is_set(const KrsState *frame, const Parameter *parameter)
{
    return memcmp(frame->parameters[parameter->slot].v, parameter->value,
                  parameter->components * sizeof *parameter->value) != 0;
}

KrsStatus krs_state_update(KrsState *frame, const KrsScene *scene)
{
    const KrsScene *old = frame->scene;
    KrsState       *fresh;
    KrsStatus       status = frame_new(scene, &fresh);
    if (status != KRS_OK)
        return status;
    for (size_t i = 0; i < old->parameter_count; i++) {
        const Parameter *from = &old->parameters[i];
        if (is_set(frame, from))
            krs_state_set(fresh, from->name, frame->parameters[from->slot].v, from->components);
    }
    krs_state_set_time(fresh, frame->parameters[0].v[0]);
    krs_state_set_zones(fresh, (const double(*)[4])frame->zones, frame->zone_count);
    fresh->unbounded = NULL;
    KrsState other   = *frame;
    *frame           = *fresh;
    *fresh           = other;
    frame_count_operations(frame);
    frame_free(fresh);
    return KRS_OK;
}

/* Numbers are limited so that their squares are finite in single precision. */
static bool zone_is_valid(const double zone[4])
{
    for (int k = 0; k < 4; k++)
        if (!(fabs(zone[k]) <= KRS_MAX_COORDINATE))
            return false;
    return zone[3] >= 0;
}

KrsStatus krs_state_set_zones(KrsState *frame, const double (*zones)[4], size_t count)
{
    if (count > KRS_MAX_ZONES || (!zones && count > 0))
        return KRS_BAD_ARGUMENT;
    for (size_t i = 0; i < count; i++)
        if (!zone_is_valid(zones[i]))
            return KRS_BAD_ARGUMENT;
    if (count > 0)
        memmove(frame->zones, zones, count * sizeof *zones);
    frame->zone_count = count;
    return KRS_OK;
}

size_t krs_state_zones(const KrsState *frame, const double *rebase_origin, float (*zones)[4])
{
    static const double nowhere[3] = {0};
    const double       *origin     = rebase_origin ? rebase_origin : nowhere;
    for (size_t i = 0; i < frame->zone_count; i++) {
        const double *zone = frame->zones[i];
        for (int k = 0; k < 3; k++)
            zones[i][k] = (float)(zone[k] - origin[k]);
        zones[i][3] = (float)(zone[3] - (rebase_origin ? distance3(zone, origin) : 0));
    }
    return frame->zone_count;
}

/* The origin is the last slot of the parameter block. */
void krs_state_rebase(KrsState *frame, const double rebase_origin[3], float (*block)[4])
{
    const KrsScene *scene = frame->scene;
    if (!scene->program.camera_relative)
        return;
    memcpy(frame->parameters[scene->program.parameter_slots - 1].v, rebase_origin,
           3 * sizeof *rebase_origin);
    frame_values_find(&scene->module.slots.camera_relative, frame->parameters, frame->values,
                      block);
}

void krs_state_values(const KrsState *frame, float (*block)[4])
{
    frame_values_find(&frame->scene->module.slots.plain, frame->parameters, frame->values, block);
}

void krs_state_parameters(const KrsState *frame, float (*block)[4])
{
    for (uint32_t i = 0; i < frame->scene->program.parameter_slots; i++)
        for (int k = 0; k < 4; k++)
            block[i][k] = (float)frame->parameters[i].v[k];
}

void frame_copy(const KrsState *frame, Node node, double to[3])
{
    memcpy(to, frame->values[node].v, 3 * sizeof *to);
}

void vector_normalize(double v[3])
{
    double largest = largest3(v);
    if (!(largest > 0))
        return;
    for (int i = 0; i < 3; i++)
        v[i] /= largest;
    double length = length3(v);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static void view_camera(const KrsState *frame, size_t index, KrsCamera *camera)
{
    const KrsScene    *scene = frame->scene;
    const CameraNodes *roots = camera_roots(&scene->roots, index);
    *camera                  = (KrsCamera){0};
#define KRS_CAMERA(name, kind, part, positive, counts, ...) \
    memcpy(&camera->name, frame->values[roots->name].v, sizeof camera->name);
#define KRS_CAMERA_FIXED(name, type, part, counts) camera->name = scene->cameras[index].name;
#include "krs/camera.def"
    if (scene->framed && index == 0) {
        memcpy(camera->eye, frame->framed_eye, sizeof camera->eye);
        memcpy(camera->target, frame->framed_target, sizeof camera->target);
    }
}

/* Where a light shines, and what is right of it and above it, with y up. */
static void aim_light(KrsLight *light)
{
    const double upright[3] = {0, 1, 0}, ahead[3] = {0, 0, -1}, down[3] = {0, -1, 0};
    for (int i = 0; i < 3; i++)
        light->axis[i] = light->target[i] - light->vector[i];
    if (!normalize3(light->axis))
        memcpy(light->axis, down, sizeof light->axis);
    cross3(fabs(light->axis[1]) < 0.999 ? upright : ahead, light->axis, light->right);
    normalize3(light->right);
    cross3(light->axis, light->right, light->up);
}

static void view_light(const KrsState *frame, size_t index, KrsLight *light)
{
    const SceneLight *from  = &frame->scene->lights[index];
    const LightNodes *roots = light_roots(&frame->scene->roots, index);
    *light                  = (KrsLight){.positional = from->positional,
                                         .shadow     = from->shadow,
                                         .spot       = from->spot,
                                         .type       = from->type};
#define KRS_LIGHT(member, kind, of_direction, of_position, ...) \
    memcpy(&light->member, frame->values[roots->member].v, sizeof light->member);
#include "krs/lights.def"
    light->angle = fmin(fmax(light->angle, 0), 2 * M_PI);
    light->edge  = fmin(fmax(light->edge, 0), 1);
    if (!light->positional)
        vector_normalize(light->vector);
    else if (light->type != 0 || light->spot)
        aim_light(light);
}

/* ---- daylight ---- */

/* The sun, once lights are known. */
static Daylight find_daylight(const KrsState *frame)
{
    const KrsScene *scene = frame->scene;
    const SkyRoots *sky   = sky_roots(&scene->roots);
    Daylight        light = {.rise      = frame->lights[scene->daylight_by].vector[1],
                             .turbidity = frame->values[sky->turbidity].v[0]};
    frame_copy(frame, sky->ground, light.ground);
    return light;
}

/* Air takes light from the sun, unless its colour is given. */
static void dim_sun(const KrsState *frame)
{
    const size_t   sun   = frame->scene->daylight_by;
    const Daylight light = find_daylight(frame);
    double         part[3];
    if (frame->scene->lights[sun].colored)
        return;
    daylight_sun(&light, part);
    for (int i = 0; i < 3; i++)
        frame->lights[sun].color[i] *= part[i];
}

static bool make_sky(KrsState *frame, const Daylight *light)
{
    if (memcmp(&frame->sky_made, light, sizeof *light) == 0)
        return true;
    frame->sky_made = (Daylight){0};
    if (!daylight_sky(light, frame->sky))
        return false;
    frame->sky_made = *light;
    frame->sky_map = (KrsSkyMap){DAYLIGHT_WIDTH, DAYLIGHT_HEIGHT, 0, (const float(*)[3])frame->sky};
    frame->sky_map.version = sky_map_version(&frame->sky_map);
    return true;
}

/* The sun is in the middle of the map, so that the map does not depend on where it is round about. */
static KrsStatus view_daylight(KrsState *frame, KrsView *view)
{
    const size_t    sun   = frame->scene->daylight_by;
    const Daylight  light = find_daylight(frame);
    const KrsLight *day   = &frame->lights[sun];
    if (!make_sky(frame, &light))
        return KRS_OUT_OF_MEMORY;
    view->sky.map      = &frame->sky_map;
    view->sky.rotation = -atan2(day->vector[0], -day->vector[2]);
    view->sky.intensity *= day->intensity;
    return KRS_OK;
}

KrsImage krs_scene_image(const KrsScene *scene)
{
    const SceneImage *image = &scene->image;
    return (KrsImage){.width         = image->width,
                      .height        = image->height,
                      .samples       = image->samples,
                      .bounces       = image->bounces,
                      .integrator    = image->integrator,
                      .exposure      = image->exposure,
                      .tone_map      = image->tone_map,
                      .error         = image->error,
                      .noise         = image->noise,
                      .pixel_filter  = image->pixel_filter,
                      .white_balance = {image->white_balance[0], image->white_balance[1]}};
}

KrsStatus frame_view(KrsState *frame, size_t camera, KrsView *view)
{
    const KrsScene *scene = frame->scene;
    const SkyRoots *sky   = sky_roots(&scene->roots);
    if (camera >= scene->camera_count)
        return KRS_BAD_ARGUMENT;
    frame_refresh(frame);
    *view = (KrsView){.light_count = scene->light_count, .lights = frame->lights};
    view_camera(frame, camera, &view->camera);
    frame_copy(frame, sky->zenith, view->sky.zenith);
    frame_copy(frame, sky->horizon, view->sky.horizon);
    frame_copy(frame, sky->ground, view->sky.ground);
    view->sky.map       = scene->sky_map;
    view->sky.rotation  = frame->values[sky->rotation].v[0];
    view->sky.intensity = frame->values[sky->intensity].v[0];
    frame_copy(frame, sky->fog_color, view->fog.color);
    view->fog.density = frame->values[sky->fog_density].v[0];
    view->fog.fall    = frame->values[sky->fog_fall].v[0];
    view->fog.base    = frame->values[sky->fog_base].v[0];
    for (size_t i = 0; i < scene->light_count; i++)
        view_light(frame, i, &frame->lights[i]);
    if (scene->daylight)
        dim_sun(frame);
    view->image = krs_scene_image(scene);
    return KRS_OK;
}

/* ---- the functions of krs.h and compiled.h ---- */

KrsStatus krs_state_new(const KrsScene *scene, KrsState **frame) { return frame_new(scene, frame); }

void krs_state_free(KrsState *frame) { frame_free(frame); }

KrsStatus krs_state_view(KrsState *frame, size_t camera, KrsView *view)
{
    KrsStatus status = frame_view(frame, camera, view);
    return status == KRS_OK && frame->scene->daylight ? view_daylight(frame, view) : status;
}

KrsStatus krs_state_light(KrsState *frame, size_t index, KrsLight *light)
{
    KrsView view;
    if (index >= frame->scene->light_count)
        return KRS_BAD_ARGUMENT;
    const KrsStatus status = frame_view(frame, 0, &view);
    if (status == KRS_OK)
        *light = view.lights[index];
    return status;
}

KrsStatus krs_state_sky(KrsState *frame, KrsSky *sky)
{
    KrsView         view;
    const KrsStatus status = krs_state_view(frame, 0, &view);
    if (status == KRS_OK)
        *sky = view.sky;
    return status;
}

KrsStatus krs_state_fog(KrsState *frame, KrsFog *fog)
{
    KrsView         view;
    const KrsStatus status = frame_view(frame, 0, &view);
    if (status == KRS_OK)
        *fog = view.fog;
    return status;
}

KrsStatus krs_state_camera(KrsState *frame, size_t index, KrsCamera *camera)
{
    if (index >= frame->scene->camera_count)
        return KRS_BAD_ARGUMENT;
    frame_refresh(frame);
    view_camera(frame, index, camera);
    return KRS_OK;
}
