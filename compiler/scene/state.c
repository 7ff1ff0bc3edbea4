/*
 * state.c: states: the values of parameters, time and zones, and the view that depends on them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/scene/points.h"
#include "compiler/scene/program.h"
#include "compiler/shape/slope.h"

/* Returns zeroed memory from the scene's allocator, or NULL. */
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
static bool find_slopes(KrsState *state, uint32_t changed)
{
    const double(*parameters)[4] = (const double(*)[4])state->parameters;
    state->unbounded             = NULL;
    for (size_t i = 0; i < state->scene->slope_count; i++) {
        const RetainedSlope *slope = &state->scene->slopes[i];
        if (!tape_depends_on(&slope->task.tape, changed))
            continue;
        double found = slope_task_run(&slope->task, parameters, state->workspace, NULL);
        found        = state_slope_upward(found);
        state->parameters[slope->slot].v[0] = found;
        if (!isfinite(found) && !state->unbounded)
            state->unbounded = slope->place;
    }
    state_find_floor(state, changed);
    return !state->unbounded;
}

KrsStatus state_new(const KrsScene *scene, KrsState **result)
{
    *result         = NULL;
    KrsState *state = frame_alloc(scene, 1, sizeof *state);
    if (!state)
        return KRS_OUT_OF_MEMORY;
    state->scene      = scene;
    state->parameters = frame_alloc(scene, scene->program.parameter_slots,
                                    sizeof *state->parameters);
    state->values     = frame_alloc(scene, scene->graph->count, sizeof *state->values);
    state->lights     = frame_alloc(scene, scene->light_count, sizeof *state->lights);
    state->lit        = frame_alloc(scene, scene->emissive_count, sizeof *state->lit);
    state->workspace  = frame_alloc(scene, slope_workspace(scene), 1);
    state->boxes      = frame_alloc(scene, scene->boxes.shapes.count, sizeof *state->boxes);
    state->sky        = frame_alloc(scene, scene->daylight ? DAYLIGHT_WIDTH * DAYLIGHT_HEIGHT : 0,
                                    sizeof *state->sky);
    if (!state->parameters || !state->values || !state->lights || !state->workspace ||
        !state->boxes || !state->sky || !state->lit || !state_tables_new(state)) {
        state_free(state);
        return KRS_OUT_OF_MEMORY;
    }
    memcpy(state->framed_eye, scene->framed_eye, sizeof state->framed_eye);
    memcpy(state->framed_target, scene->framed_target, sizeof state->framed_target);
    for (size_t i = 0; i < scene->parameter_count; i++)
        memcpy(state->parameters[scene->parameters[i].slot].v, scene->parameters[i].value,
               sizeof scene->parameters[i].value);
    if (!find_slopes(state, ANY_SLOT)) { /* a bug: the compiler refuses such scenes */
        state_free(state);
        return KRS_INTERNAL;
    }
    *result = state;
    return KRS_OK;
}

void state_free(KrsState *state)
{
    if (!state)
        return;
    const KrsScene *scene = state->scene;
    state_lanes_free(state);
    state_tables_free(state);
    frame_release(scene, state->parameters);
    frame_release(scene, state->values);
    frame_release(scene, state->lights);
    frame_release(scene, state->sky);
    frame_release(scene, state->lit);
    frame_release(scene, state->workspace);
    frame_release(scene, state->boxes);
    frame_release(scene, state);
}

KrsStatus state_copy_of(const KrsState *state, KrsState **copy)
{
    KrsStatus status = state_new(state->scene, copy);
    if (status != KRS_OK)
        return status;
    memcpy((*copy)->parameters, state->parameters,
           state->scene->program.parameter_slots * sizeof *state->parameters);
    memcpy((*copy)->framed_eye, state->framed_eye, sizeof state->framed_eye);
    memcpy((*copy)->framed_target, state->framed_target, sizeof state->framed_target);
    memcpy((*copy)->zones, state->zones, sizeof state->zones);
    (*copy)->zone_count = state->zone_count;
    return KRS_OK;
}

void state_refresh(KrsState *state)
{
    static _Atomic uint64_t stamps;
    if (state->fresh)
        return;
    state->stamp = ++stamps;
    tape_run_frame(&state->scene->frame, state->parameters, state->values);
    state->fresh = true;
    state_tables_change(state);
    state_lanes_refresh(state);
}

uint64_t krs_state_stamp(KrsState *state)
{
    state_refresh(state);
    return state->stamp;
}

void state_refresh_points(KrsState *state)
{
    state_refresh(state);
    state_tables_refresh(state);
}

Node state_infinite(KrsState *state)
{
    const KrsScene *scene = state->scene;
    RootRange       view  = roots_from(&scene->roots, ROOTS_CAMERA, ROOTS_SKY);
    state_refresh(state);
    for (size_t i = 0; i < view.count; i++)
        if (!node_value_is_finite(scene->graph, view.items[i], state->values))
            return view.items[i];
    Node found = tape_frame_infinite(&scene->surface, state->values);
    return found != NODE_NONE ? found : tape_frame_infinite(&scene->distance, state->values);
}

/* Sets the values of a slot of the parameter block, unless the scene would not be finite. */
static KrsStatus change_slot(KrsState *state, uint32_t slot, const double *values, size_t count)
{
    NodeValue before = state->parameters[slot];
    if (memcmp(before.v, values, count * sizeof *values) == 0)
        return KRS_OK; /* viewers set all parameters when one changes */
    memcpy(state->parameters[slot].v, values, count * sizeof *values);
    state->fresh = false;
    if (find_slopes(state, slot) && state_infinite(state) == NODE_NONE)
        return KRS_OK;
    const char *unbounded   = state->unbounded;
    state->parameters[slot] = before;
    state->fresh            = false;
    find_slopes(state, slot);
    state->unbounded = unbounded;
    return KRS_BAD_ARGUMENT;
}

KrsStatus krs_state_set(KrsState *state, const char *name, const double *values, size_t count)
{
    const KrsScene *scene = state->scene;
    state->unbounded      = NULL;
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
        return change_slot(state, parameter->slot, values, count);
    }
    return KRS_BAD_ARGUMENT;
}

const char *krs_state_unbounded(const KrsState *state) { return state->unbounded; }

KrsStatus krs_state_set_time(KrsState *state, double time)
{
    state->unbounded = NULL;
    return isfinite(time) ? change_slot(state, 0, &time, 1) : KRS_BAD_ARGUMENT;
}

double krs_state_time(const KrsState *state) { return state->parameters[0].v[0]; }

/* Tells whether a parameter of a state has another value than its default. */
static bool is_set(const KrsState *state, const Parameter *parameter)
{
    return memcmp(state->parameters[parameter->slot].v, parameter->value,
                  parameter->components * sizeof *parameter->value) != 0;
}

KrsStatus krs_state_update(KrsState *state, const KrsScene *scene)
{
    const KrsScene *old = state->scene;
    KrsState       *fresh;
    KrsStatus       status = state_new(scene, &fresh);
    if (status != KRS_OK)
        return status;
    for (size_t i = 0; i < old->parameter_count; i++) {
        const Parameter *from = &old->parameters[i];
        if (is_set(state, from))
            krs_state_set(fresh, from->name, state->parameters[from->slot].v, from->components);
    }
    krs_state_set_time(fresh, state->parameters[0].v[0]);
    krs_state_set_zones(fresh, (const double(*)[4])state->zones, state->zone_count);
    fresh->unbounded = NULL;
    KrsState other   = *state;
    *state           = *fresh;
    *fresh           = other;
    state_count_operations(state);
    state_free(fresh);
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

KrsStatus krs_state_set_zones(KrsState *state, const double (*zones)[4], size_t count)
{
    if (count > KRS_MAX_ZONES || (!zones && count > 0))
        return KRS_BAD_ARGUMENT;
    for (size_t i = 0; i < count; i++)
        if (!zone_is_valid(zones[i]))
            return KRS_BAD_ARGUMENT;
    if (count > 0)
        memmove(state->zones, zones, count * sizeof *zones);
    state->zone_count = count;
    return KRS_OK;
}

size_t krs_state_zones(const KrsState *state, const double *rebase_origin, float (*zones)[4])
{
    static const double nowhere[3] = {0};
    const double       *origin     = rebase_origin ? rebase_origin : nowhere;
    for (size_t i = 0; i < state->zone_count; i++) {
        const double *zone = state->zones[i];
        for (int k = 0; k < 3; k++)
            zones[i][k] = (float)(zone[k] - origin[k]);
        zones[i][3] = (float)(zone[3] - (rebase_origin ? distance3(zone, origin) : 0));
    }
    return state->zone_count;
}

/* Sets the origin, which is the last slot of the parameter block, and finds the values. */
void krs_state_rebase(KrsState *state, const double rebase_origin[3], float (*block)[4])
{
    const KrsScene *scene = state->scene;
    if (!scene->program.camera_relative)
        return;
    memcpy(state->parameters[scene->program.parameter_slots - 1].v, rebase_origin,
           3 * sizeof *rebase_origin);
    state_values_find(&scene->module.slots.camera_relative, state->parameters, state->values,
                      block);
}

void krs_state_values(const KrsState *state, float (*block)[4])
{
    state_values_find(&state->scene->module.slots.plain, state->parameters, state->values, block);
}

void krs_state_parameters(const KrsState *state, float (*block)[4])
{
    for (uint32_t i = 0; i < state->scene->program.parameter_slots; i++)
        for (int k = 0; k < 4; k++)
            block[i][k] = (float)state->parameters[i].v[k];
}

void state_copy(const KrsState *state, Node node, double to[3])
{
    memcpy(to, state->values[node].v, 3 * sizeof *to);
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

static void view_camera(const KrsState *state, size_t index, KrsCamera *camera)
{
    const KrsScene    *scene = state->scene;
    const CameraNodes *roots = camera_roots(&scene->roots, index);
    *camera                  = (KrsCamera){0};
#define KRS_CAMERA(name, kind, part, positive, counts, ...) \
    memcpy(&camera->name, state->values[roots->name].v, sizeof camera->name);
#define KRS_CAMERA_FIXED(name, type, part, counts) camera->name = scene->cameras[index].name;
#include "krs/camera.def"
    if (scene->framed && index == 0) {
        memcpy(camera->eye, state->framed_eye, sizeof camera->eye);
        memcpy(camera->target, state->framed_target, sizeof camera->target);
    }
}

/* Finds where a light shines, and what is right of it and above it, with y up. */
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

static void view_light(const KrsState *state, size_t index, KrsLight *light)
{
    const SceneLight *from  = &state->scene->lights[index];
    const LightNodes *roots = light_roots(&state->scene->roots, index);
    *light                  = (KrsLight){.positional = from->positional,
                                         .shadow     = from->shadow,
                                         .spot       = from->spot,
                                         .type       = from->type};
#define KRS_LIGHT(member, kind, of_direction, of_position, ...) \
    memcpy(&light->member, state->values[roots->member].v, sizeof light->member);
#include "krs/lights.def"
    light->angle = fmin(fmax(light->angle, 0), 2 * M_PI);
    light->edge  = fmin(fmax(light->edge, 0), 1);
    if (!light->positional)
        vector_normalize(light->vector);
    else if (light->type != 0 || light->spot)
        aim_light(light);
}

/* ---- daylight ---- */

/* Returns what the sky of a state is made of, once its lights are known. */
static Daylight find_daylight(const KrsState *state)
{
    const KrsScene *scene = state->scene;
    const SkyRoots *sky   = sky_roots(&scene->roots);
    Daylight        light = {.rise      = state->lights[scene->daylight_by].vector[1],
                             .turbidity = state->values[sky->turbidity].v[0]};
    state_copy(state, sky->ground, light.ground);
    return light;
}

/* Dims the sun by the air, unless its colour is given. */
static void dim_sun(const KrsState *state)
{
    const size_t   sun   = state->scene->daylight_by;
    const Daylight light = find_daylight(state);
    double         part[3];
    if (state->scene->lights[sun].colored)
        return;
    daylight_sun(&light, part);
    for (int i = 0; i < 3; i++)
        state->lights[sun].color[i] *= part[i];
}

static bool make_sky(KrsState *state, const Daylight *light)
{
    if (memcmp(&state->sky_made, light, sizeof *light) == 0)
        return true;
    state->sky_made = (Daylight){0};
    if (!daylight_sky(light, state->sky))
        return false;
    state->sky_made = *light;
    state->sky_map = (KrsSkyMap){DAYLIGHT_WIDTH, DAYLIGHT_HEIGHT, 0, (const float(*)[3])state->sky};
    state->sky_map.version = sky_map_version(&state->sky_map);
    return true;
}

/* The sun is in the middle of the map, so that the map does not depend on where it is round about. */
static KrsStatus view_daylight(KrsState *state, KrsView *view)
{
    const size_t    sun   = state->scene->daylight_by;
    const Daylight  light = find_daylight(state);
    const KrsLight *day   = &state->lights[sun];
    if (!make_sky(state, &light))
        return KRS_OUT_OF_MEMORY;
    view->sky.map      = &state->sky_map;
    view->sky.rotation = -real_atan2(day->vector[0], -day->vector[2]);
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

KrsStatus state_view(KrsState *state, size_t camera, KrsView *view)
{
    const KrsScene *scene = state->scene;
    const SkyRoots *sky   = sky_roots(&scene->roots);
    if (camera >= scene->camera_count)
        return KRS_BAD_ARGUMENT;
    state_refresh(state);
    *view = (KrsView){.light_count = scene->light_count, .lights = state->lights};
    view_camera(state, camera, &view->camera);
    state_copy(state, sky->zenith, view->sky.zenith);
    state_copy(state, sky->horizon, view->sky.horizon);
    state_copy(state, sky->ground, view->sky.ground);
    view->sky.map       = scene->sky_map;
    view->sky.rotation  = state->values[sky->rotation].v[0];
    view->sky.intensity = state->values[sky->intensity].v[0];
    state_copy(state, sky->fog_color, view->fog.color);
    view->fog.density = state->values[sky->fog_density].v[0];
    view->fog.fall    = state->values[sky->fog_fall].v[0];
    view->fog.base    = state->values[sky->fog_base].v[0];
    for (size_t i = 0; i < scene->light_count; i++)
        view_light(state, i, &state->lights[i]);
    if (scene->daylight)
        dim_sun(state);
    view->image = krs_scene_image(scene);
    return KRS_OK;
}

/* ---- the functions of krs.h and compiled.h ---- */

KrsStatus krs_state_new(const KrsScene *scene, KrsState **state) { return state_new(scene, state); }

void krs_state_free(KrsState *state) { state_free(state); }

KrsStatus krs_state_view(KrsState *state, size_t camera, KrsView *view)
{
    KrsStatus status = state_view(state, camera, view);
    return status == KRS_OK && state->scene->daylight ? view_daylight(state, view) : status;
}

KrsStatus krs_state_light(KrsState *state, size_t index, KrsLight *light)
{
    KrsView view;
    if (index >= state->scene->light_count)
        return KRS_BAD_ARGUMENT;
    const KrsStatus status = state_view(state, 0, &view);
    if (status == KRS_OK)
        *light = view.lights[index];
    return status;
}

KrsStatus krs_state_sky(KrsState *state, KrsSky *sky)
{
    KrsView         view;
    const KrsStatus status = krs_state_view(state, 0, &view);
    if (status == KRS_OK)
        *sky = view.sky;
    return status;
}

KrsStatus krs_state_fog(KrsState *state, KrsFog *fog)
{
    KrsView         view;
    const KrsStatus status = state_view(state, 0, &view);
    if (status == KRS_OK)
        *fog = view.fog;
    return status;
}

KrsStatus krs_state_camera(KrsState *state, size_t index, KrsCamera *camera)
{
    if (index >= state->scene->camera_count)
        return KRS_BAD_ARGUMENT;
    state_refresh(state);
    view_camera(state, index, camera);
    return KRS_OK;
}
