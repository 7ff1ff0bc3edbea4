/*
 * rendering.c: a scene on a device: its buffers and parameters, and the commands that run its
 * shaders.
 */
#include "runtime/tracer/rendering.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "runtime/tracer/lane_fields.h"
#include "runtime/tracer/prewarm_thread.h"
#include "runtime/tracer/shaders.h"
#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/scene_tables.h"
#include "runtime/tracer/sky_table.h"
#include "runtime/tracer/slots.h"

/* The radius of an unused zone, in which no point is. */
#define NO_ZONE (-1e30f)

void rendering_bind(KrsRendering *rendering, Handle set, uint32_t binding, const Buffer *buffer)
{
    layouts_bind(&rendering->renderer->gpu, set, binding, buffer);
}

static bool rendering_sets_create(KrsRendering *rendering)
{
    const KrsRenderer     *renderer   = rendering->renderer;
    const SetLayout *const layouts[3] = {&renderer->scene_layout, &renderer->frame_layout,
                                         &renderer->frame_layout};
    Handle                 sets[3];
    if (!sets_create(&rendering->renderer->gpu, layouts, 3, sets, &rendering->pool))
        return false;
    rendering->scene_set  = sets[0];
    rendering->band_set   = sets[1];
    rendering->points_set = sets[2];
    return true;
}

void rendering_bind_frame(KrsRendering *rendering, Handle set)
{
    const Buffer *control = rendering_control(rendering);
    rendering_bind(rendering, set, FRAME_BINDING, &rendering->frame);
    rendering_bind(rendering, set, WORK_BINDING, &rendering->renderer->work);
    rendering_bind(rendering, set, FRAME_TEXELS_BINDING, &rendering->frame);
    rendering_bind(rendering, set, CONTROL_BINDING, control);
    rendering_bind(rendering, set, CONTROL_TEXELS_BINDING, control);
}

static void bind_scene(KrsRendering *rendering)
{
    layouts_bind_scene(&rendering->renderer->gpu, rendering->scene_set, PARAMETERS_BINDING,
                       &rendering->parameters);
    scene_tables_bind(rendering);
    sky_table_bind(rendering);
}

/* Makes the parameter block and the tables of the rendering's scene. */
static bool scene_buffers_create(KrsRendering *rendering)
{
    Gpu     *gpu   = &rendering->renderer->gpu;
    uint32_t slots = rendering_slots(rendering);
    if (slots == 0 ||
        !buffer_create(gpu, &rendering->parameters, (uint64_t)slots * 4 * sizeof(float), UPLOADED,
                       "scene's parameters") ||
        !scene_tables_create(rendering))
        return false;
    bind_scene(rendering);
    return true;
}

static bool buffers_create(KrsRendering *rendering)
{
    Gpu *gpu = &rendering->renderer->gpu;
    if (!scene_buffers_create(rendering) ||
        !buffer_create(gpu, &rendering->frame, sizeof(FrameBlock), UPLOADED, "camera") ||
        !buffer_create(gpu, &rendering->control, sizeof(ControlBlock), SHARED, "control block") ||
        (!gpu_is_cpu(gpu) && !buffer_create(gpu, &rendering->device_control, sizeof(ControlBlock),
                                            ON_DEVICE, "control block")))
        return false;
    Buffer *control = gpu_is_cpu(gpu) ? &rendering->control : &rendering->device_control;
    if (!layouts_view_texels(gpu, FRAME_TEXELS_BINDING, &rendering->frame, "camera") ||
        !layouts_view_texels(gpu, CONTROL_TEXELS_BINDING, control, "control block"))
        return false;
    rendering_bind_frame(rendering, rendering->band_set);
    return true;
}

/* The work on an item before a shader may be interrupted, in evaluations of the distance, about.
   For shaders without the scene it is as much as some operations. */
static const double distances_of_item[KRS_PHASE_COUNT] = {
    [KRS_PHASE_BEAMS] = 64,   [KRS_PHASE_PRIMARY] = 16,  [KRS_PHASE_NORMALS] = 7,
    [KRS_PHASE_SHADOWS] = 64, [KRS_PHASE_OCCLUSION] = 5, [KRS_PHASE_SHADING] = 4,
    [KRS_PHASE_RESOLVE] = 1,
};
#define FLOPS_WITHOUT_SCENE 1000

/* Returns the items of the first slice: 50 ms on a slow device of its kind, until times are known.
   Waiting for a processor costs little, so its first slice may be short. */
static double guess_slice(const KrsRendering *rendering, int phase, bool has_scene)
{
    static const double slow[] = {
        /* Operations in 50 ms at a tenth of the promised speed. */
        [KRS_DEVICE_OTHER] = 5e8,      [KRS_DEVICE_CPU] = 5e8,       [KRS_DEVICE_VIRTUAL] = 5e8,
        [KRS_DEVICE_INTEGRATED] = 1e9, [KRS_DEVICE_DISCRETE] = 1e10,
    };
    const Gpu *gpu   = &rendering->renderer->gpu;
    double     flops = has_scene ? rendering->program->flops * distances_of_item[phase]
                                 : FLOPS_WITHOUT_SCENE;
    double     items = slow[gpu_describe(gpu).kind] / fmax(flops, 1);
    items            = gpu_is_cpu(gpu) ? 8192 : items;
    return fmax(ldexp(items, -(int)renderer_halvings(rendering->renderer)), 1);
}

static void set_scene(KrsRendering *rendering, const KrsScene *scene)
{
    rendering->scene      = scene;
    rendering->program    = krs_scene_program(scene);
    rendering->scene_rays = krs_scene_has_lens(scene)       ? RAYS_OF_LENSES
                            : krs_scene_is_panoramic(scene) ? RAYS_OF_PANORAMAS
                                                            : RAYS_OF_CAMERAS;
    rendering->rays       = rendering->scene_rays;
}

/* Makes what the rendering's scene has on the device; false with the failure noted. */
static bool prepare(KrsRendering *rendering)
{
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        for (int has_scene = 0; has_scene < 2; has_scene++)
            rendering->items_at_once[phase][has_scene] = guess_slice(rendering, phase, has_scene);
    return rendering_sets_create(rendering) && buffers_create(rendering) &&
           shaders_create(rendering, rendering->purpose);
}

/* Destroys that, and what pictures have made. */
static void release(KrsRendering *rendering)
{
    Gpu    *gpu       = &rendering->renderer->gpu;
    Band   *band      = &rendering->band;
    Buffer *buffers[] = {&rendering->parameters,
                         &rendering->table_rows,
                         &rendering->table_cells,
                         &rendering->sky_table,
                         &rendering->frame,
                         &rendering->control,
                         &rendering->device_control,
                         &rendering->inputs,
                         &rendering->points,
                         &rendering->answers,
                         &rendering->query_rays,
                         &rendering->ray_hits,
                         &rendering->taken,
                         &rendering->photons,
                         &band->ends,
                         &band->hits,
                         &band->results,
                         &band->fetched,
                         &band->queue,
                         &band->taken,
                         &band->tiles,
                         &band->surfaces};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        buffer_destroy(gpu, buffers[i]);
    shaders_destroy(gpu, &rendering->shaders);
    if (gpu_is_open(gpu) && !gpu->stuck)
        sets_destroy(gpu, rendering->pool);
    gpu_release(gpu, rendering->table_inputs);
    rendering->table_inputs = NULL;
    rendering->pool         = 0;
    rendering->band         = (Band){0};
    rendering->resident     = (ResidentBand){0};
    rendering->zone_slots = rendering->max_zone_slots = 0;
}

/* Opens a lost device anew, and makes all anew that it had; false with the failure noted. */
static bool reopen(KrsRenderer *renderer)
{
    Gpu *gpu = &renderer->gpu;
    prewarm_end(renderer);
    gpu_wait(gpu); /* what was prewarmed may still run, unless the device is gone */
    for (KrsRendering *r = renderer->first; r; r = r->next)
        release(r);
    renderer_release(renderer);
    renderer->losses++;
    renderer_clear(renderer);
    bool ready = gpu_reopen(gpu) && renderer_prepare(renderer);
    for (KrsRendering *r = renderer->first; r && ready; r = r->next)
        ready = prepare(r);
    gpu->lost = !ready;
    return ready;
}

bool rendering_ready(KrsRenderer *renderer)
{
    renderer_clear(renderer);
    return !renderer->gpu.lost || reopen(renderer);
}

/* A renderer keeps a list of its renderings: all are made anew with its device. */
static void add_to_list(KrsRendering *rendering)
{
    rendering->next            = rendering->renderer->first;
    rendering->renderer->first = rendering;
}

static void remove_from_list(const KrsRendering *rendering)
{
    KrsRendering **link = &rendering->renderer->first;
    while (*link && *link != rendering)
        link = &(*link)->next;
    if (*link)
        *link = rendering->next;
}

KrsStatus krs_rendering_new(KrsRenderer *renderer, const KrsScene *scene, KrsPurpose purpose,
                            KrsRendering **out)
{
    *out = NULL;
    if (!rendering_ready(renderer))
        return renderer->gpu.status;
    KrsRendering *rendering = gpu_alloc(&renderer->gpu, 1, sizeof *rendering, "prepare the scene");
    if (!rendering)
        return renderer->gpu.status;
    rendering->renderer = renderer;
    rendering->purpose  = purpose == KRS_FOR_FIRST_PICTURES ? KRS_FOR_PICTURES : purpose;
    rendering->defers = rendering->deferred = purpose == KRS_FOR_FIRST_PICTURES ||
                                              purpose == KRS_FOR_SMALL_PICTURES;
    rendering->snaps       = purpose == KRS_FOR_PATHS;
    rendering->spirv_ms    = renderer->spirv_ms;
    rendering->pipeline_ms = renderer->pipeline_ms;
    set_scene(rendering, scene);
    bool ready = prepare(rendering);
    for (int i = 0; i < MAX_LOSSES && !ready && renderer->gpu.lost; i++) {
        release(rendering);
        ready = reopen(renderer) && prepare(rendering);
    }
    if (!ready) {
        KrsStatus status = renderer->gpu.status;
        prewarm_end(renderer); /* it may still use the queue */
        krs_rendering_free(rendering);
        return status;
    }
    if (rendering->deferred)
        prewarm_end(renderer); /* pictures use the queue before shaders are made */
    add_to_list(rendering);
    *out = rendering;
    return KRS_OK;
}

/* Frees what is of one scene, but for its shaders. */
static void drop_scene(Gpu *gpu, KrsRendering *dropped)
{
    buffer_destroy(gpu, &dropped->parameters);
    buffer_destroy(gpu, &dropped->table_rows);
    buffer_destroy(gpu, &dropped->table_cells);
    gpu_release(gpu, dropped->table_inputs);
    gpu_release(gpu, dropped->volume_rows);
    lane_fields_free(&dropped->lane_fields);
}

/* Takes the rendering over to a scene; `stays`: its shaders are the same.  What the scene before has stays, for the case that
   this fails. */
static bool change_scene(KrsRendering *rendering, const KrsScene *scene, bool stays)
{
    rendering->parameters = rendering->table_rows = rendering->table_cells = (Buffer){0};
    rendering->table_inputs                                                = NULL;
    rendering->volume_rows                                                 = NULL;
    rendering->volume_count                                                = 0;
    rendering->lane_fields                                                 = (LaneFields){0};
    rendering->zone_slots = rendering->max_zone_slots = 0;
    rendering->camera_relative                        = false;
    set_scene(rendering, scene);
    if (!stays) {
        rendering->deferred   = rendering->defers;
        rendering->lane_times = (LaneTimes){0};
    }
    return scene_buffers_create(rendering) && shaders_create(rendering, rendering->purpose);
}

/* Frees the shaders of one of two scenes that do not share them. */
static void drop_shaders(Gpu *gpu, KrsRendering *dropped)
{
    gpu_wait(gpu);
    shaders_destroy(gpu, &dropped->shaders);
}

KrsStatus krs_rendering_update(KrsRendering *rendering, const KrsScene *scene)
{
    Gpu *gpu = &rendering->renderer->gpu;
    if (!rendering_ready(rendering->renderer) ||
        !gpu_wait(gpu)) /* shaders may still be prewarming */
        return gpu->status;
    KrsRendering before = *rendering;
    const bool   stay   = before.program->shaders == krs_scene_program(scene)->shaders;
    if (stay)
        shaders_adopt(&rendering->shaders, scene);
    else
        rendering->shaders = (ShaderMap){0};
    const bool      ready   = change_scene(rendering, scene, stay);
    const KrsStatus status  = gpu->status;
    KrsRendering    dropped = ready ? before : *rendering;
    if (!stay)
        drop_shaders(gpu, &dropped);
    else if (!ready)
        before.shaders = rendering->shaders; /* with those that were made in vain */
    if (ready) {
        rendering->resident = (ResidentBand){0};
        rendering->updates++;
    } else {
        *rendering = before;
        shaders_adopt(&rendering->shaders, before.scene);
        bind_scene(rendering);
    }
    drop_scene(gpu, &dropped);
    return ready ? KRS_OK : status;
}

void krs_rendering_free(KrsRendering *rendering)
{
    if (!rendering)
        return;
    Gpu *gpu = &rendering->renderer->gpu;
    remove_from_list(rendering);
    gpu_wait(gpu); /* shaders may still be prewarming, unless the device is lost */
    release(rendering);
    gpu_release(gpu, rendering->volume_rows);
    lane_fields_free(&rendering->lane_fields);
    gpu_release(gpu, rendering);
}

/* Chooses shaders with room for `count` zones: 1, 2, 4, 8 or 16.  Shaders that exist and have more
   room serve as well. */
static bool choose_zones(KrsRendering *rendering, size_t count)
{
    uint32_t most              = rendering->max_zone_slots;
    rendering->camera_relative = false;
    rendering->zone_slots      = count > 0 ? most : 0;
    if (count <= most)
        return true;
    for (most = 1; most < count;)
        most *= 2;
    rendering->zone_slots = rendering->max_zone_slots = most;
    return shaders_create(rendering, rendering->purpose);
}

bool rendering_set_parameters(KrsRendering *rendering, const KrsState *state,
                              const double *rebase_origin)
{
    if (!scene_tables_upload(rendering, state, rebase_origin))
        return false;
    /* Written to host memory first: the compiler's functions may read back what they write. */
    Gpu   *gpu         = &rendering->renderer->gpu;
    size_t first_value = rendering->program->parameter_slots;
    size_t values = rendering_value_slots(rendering), slots = first_value + values;
    float(*block)[4] = gpu_alloc(gpu, slots + KRS_MAX_ZONES, sizeof *block,
                                 "set the scene's parameters");
    if (!block)
        return false;
    krs_state_parameters(state, block);
    if (values > 0)
        krs_state_values(state, block + first_value);
    size_t zones = krs_state_zones(state, rebase_origin, block + slots);
    for (size_t i = zones; i < KRS_MAX_ZONES; i++)
        block[slots + i][3] = NO_ZONE;
    memcpy(rendering->parameters.bytes, block, (slots + KRS_MAX_ZONES) * sizeof *block);
    gpu_release(gpu, block);
    rendering->rays = rendering->scene_rays;
    return choose_zones(rendering, zones);
}

bool rendering_rebase(KrsRendering *rendering, KrsState *state, const double rebase_origin[3])
{
    Gpu   *gpu   = &rendering->renderer->gpu;
    size_t first = rendering->program->parameter_slots + rendering->program->value_slots +
                   KRS_MAX_ZONES;
    size_t slots     = rendering->program->camera_relative_slots;
    float(*block)[4] = gpu_alloc(gpu, slots + 1, sizeof *block,
                                 "move the scene's origin to the camera");
    if (!block)
        return false;
    krs_state_rebase(state, rebase_origin, block);
    memcpy((char *)rendering->parameters.bytes + first * sizeof *block, block,
           slots * sizeof *block);
    gpu_release(gpu, block);
    rendering->camera_relative = true;
    return true;
}

bool rendering_set_rays(KrsRendering *rendering, RayKind kind)
{
    if (kind <= rendering->rays)
        return true;
    rendering->rays = kind;
    return shaders_create(rendering, rendering->purpose);
}

uint32_t rendering_spread(const KrsRendering *rendering, uint32_t count)
{
    if (!gpu_is_cpu(&rendering->renderer->gpu) || count < 3)
        return 1;
    for (uint32_t step = (uint32_t)(0.618 * count);; step++) {
        uint32_t a = count, b = step;
        while (b != 0) {
            uint32_t rest = a % b;
            a             = b;
            b             = rest;
        }
        if (a == 1)
            return step;
    }
}

const Buffer *rendering_control(const KrsRendering *rendering)
{
    return rendering->device_control.buffer ? &rendering->device_control : &rendering->control;
}

bool rendering_begin(KrsRendering *rendering)
{
    Gpu *gpu = &rendering->renderer->gpu;
    if (!gpu_begin(gpu))
        return false;
    if (rendering->device_control.buffer) {
        gpu_copy(gpu, &rendering->control, 0, &rendering->device_control, 0, sizeof(ControlBlock));
        gpu_barrier(gpu);
    }
    return true;
}

bool rendering_finish(KrsRendering *rendering, double *ms)
{
    Gpu           *gpu      = &rendering->renderer->gpu;
    const uint64_t counters = offsetof(ControlBlock, queued);
    if (rendering->device_control.buffer) {
        gpu_barrier(gpu);
        gpu_copy(gpu, &rendering->device_control, counters, &rendering->control, counters,
                 sizeof(ControlBlock) - counters);
    }
    return gpu_finish(gpu, ms);
}

static Run run_of(KrsRendering *rendering, const Shader *shader, Handle set, const void *work,
                  uint32_t work_bytes)
{
    return (Run){.pipeline = shader->pipeline,
                 .layout   = rendering->renderer->layout,
                 .sets     = {rendering->scene_set, set},
                 .work_at  = layouts_write_work(rendering->renderer, work, work_bytes)};
}

void rendering_dispatch(KrsRendering *rendering, const Shader *shader, Handle set, const void *work,
                        uint32_t work_bytes, uint32_t groups)
{
    const Run run = run_of(rendering, shader, set, work, work_bytes);
    gpu_dispatch(&rendering->renderer->gpu, &run, groups);
}

void rendering_dispatch_counted(KrsRendering *rendering, const Shader *shader, Handle set,
                                const void *work, uint32_t work_bytes)
{
    const Run run = run_of(rendering, shader, set, work, work_bytes);
    gpu_dispatch_counted(&rendering->renderer->gpu, &run, rendering_control(rendering),
                         offsetof(ControlBlock, groups));
}
