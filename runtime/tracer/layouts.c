/*
 * layouts.c: layouts of sets and of shaders, and sets of zeros.
 */
#include "runtime/tracer/layouts.h"

#include <string.h>

/* ---- Layouts ---- */

/* The kind of texels at each binding. */
static const TexelKind texels_of_scene[SCENE_BINDINGS] = {
    [ROWS_BINDING]      = FOUR_FLOATS,
    [CELLS_BINDING]     = TWO_NUMBERS,
    [SKY_TABLE_BINDING] = FOUR_FLOATS,
};
static const TexelKind texels_of[FRAME_BINDINGS] = {
    [INPUT_TEXELS_BINDING] = FOUR_NUMBERS,   [END_TEXELS_BINDING] = TWO_NUMBERS,
    [HIT_TEXELS_BINDING] = FOUR_NUMBERS,     [PIXEL_LIST_TEXELS_BINDING] = ONE_NUMBER,
    [RESULT_TEXELS_BINDING] = FOUR_NUMBERS,  [TILE_TEXELS_BINDING] = FOUR_NUMBERS,
    [FRAME_TEXELS_BINDING] = FOUR_NUMBERS,   [CONTROL_TEXELS_BINDING] = FOUR_NUMBERS,
    [SURFACE_TEXELS_BINDING] = FOUR_NUMBERS,
};

static_assert((int)BUFFER_BINDINGS <= (int)STORAGE_BUFFERS, "devices are asked for so many");
static_assert((int)SKY_TABLE_BINDING == (int)SKY_BINDING, "as shaders have it");
static_assert((int)TABLE_BINDINGS <= (int)STORAGE_BUFFERS_FOR_TEXELS, "and for so many more");

static BindingKind kind_of(const Gpu *gpu, uint32_t binding)
{
    return binding == FRAME_BINDING  ? BINDS_UNIFORM
           : binding == WORK_BINDING ? BINDS_WORK
           : !texels_of[binding]     ? BINDS_STORAGE
           : gpu->texels             ? BINDS_TEXELS
                                     : BINDS_NOTHING;
}

static BindingKind kind_of_scene(const Gpu *gpu, uint32_t binding)
{
    return !texels_of_scene[binding] ? BINDS_UNIFORM : gpu->texels ? BINDS_TEXELS : BINDS_STORAGE;
}

static bool shader_layouts_create(KrsRenderer *renderer)
{
    Gpu                   *gpu     = &renderer->gpu;
    const SetLayout *const sets[2] = {&renderer->scene_layout, &renderer->frame_layout};
    BindingKind            scene[SCENE_BINDINGS], frame[FRAME_BINDINGS];
    for (uint32_t i = 0; i < SCENE_BINDINGS; i++)
        scene[i] = kind_of_scene(gpu, i);
    for (uint32_t i = 0; i < FRAME_BINDINGS; i++)
        frame[i] = kind_of(gpu, i);
    return set_layout_create(gpu, &renderer->scene_layout, scene, SCENE_BINDINGS) &&
           set_layout_create(gpu, &renderer->frame_layout, frame, FRAME_BINDINGS) &&
           run_layout_create(gpu, sets, &renderer->layout);
}

/* ---- Work ---- */

/* The blocks of a submission have a slot each; no submission has more dispatches.  The first slot is
   that of shaders which are prewarmed. */
enum { WORK_SLOTS = 128 };
static_assert(2 * MAX_CHAINED < WORK_SLOTS, "each dispatch follows one of next_dispatch.comp");
static_assert(sizeof(WorkBlock) <= WORK_BYTES && sizeof(NextDispatchBlock) <= WORK_BYTES &&
                  sizeof(PointWorkBlock) <= WORK_BYTES,
              "what shaders read of a slot");

static uint32_t slot_bytes(const Gpu *gpu)
{
    return gpu->limits.uniform_step > WORK_BYTES ? gpu->limits.uniform_step : WORK_BYTES;
}

static bool work_create(KrsRenderer *renderer)
{
    const WorkBlock idle = {.groups = 1, .stride = 1};
    Gpu            *gpu  = &renderer->gpu;
    if (!buffer_create(gpu, &renderer->work, (uint64_t)WORK_SLOTS * slot_bytes(gpu), UPLOADED,
                       "work of dispatches"))
        return false;
    memcpy(renderer->work.bytes, &idle, sizeof idle);
    return true;
}

uint32_t layouts_write_work(KrsRenderer *renderer, const void *work, uint32_t bytes)
{
    renderer->work_slot = renderer->work_slot % (WORK_SLOTS - 1) + 1;
    const uint32_t at   = renderer->work_slot * slot_bytes(&renderer->gpu);
    memcpy((char *)renderer->work.bytes + at, work, bytes);
    return at;
}

/* ---- Idle sets ---- */

bool layouts_view_texels(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name)
{
    return !gpu->texels || buffer_view(gpu, buffer, texels_of[binding], name);
}

bool layouts_view_table(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name)
{
    return !gpu->texels || buffer_view(gpu, buffer, texels_of_scene[binding], name);
}

void layouts_bind(Gpu *gpu, Handle set, uint32_t binding, const Buffer *buffer)
{
    set_bind(gpu, set, binding, kind_of(gpu, binding), buffer);
}

void layouts_bind_scene(Gpu *gpu, Handle set, uint32_t binding, const Buffer *buffer)
{
    set_bind(gpu, set, binding, kind_of_scene(gpu, binding), buffer);
}

const Buffer *layouts_idle_table(const KrsRenderer *renderer, uint32_t binding)
{
    return &renderer->idle[texels_of_scene[binding]];
}

/* Returns the size of a buffer of zeros for the parameters of any scene: 64 KB, the limit of most
   devices, or this device's own limit if lower. */
static uint64_t idle_bytes(const Gpu *gpu)
{
    const uint32_t most = 1 << 16, limit = gpu->limits.uniform_bytes;
    return limit < most ? limit : most;
}

/* Makes sets whose buffers hold zeros, so that no shader finds any item in them. */
static bool idle_create(KrsRenderer *renderer)
{
    Gpu                   *gpu        = &renderer->gpu;
    const SetLayout *const layouts[2] = {&renderer->scene_layout, &renderer->frame_layout};
    const char            *name       = "idle frame";
    Handle                 sets[2];
    for (TexelKind kind = NO_TEXELS; kind < TEXEL_KINDS; kind++) {
        Buffer        *idle  = &renderer->idle[kind];
        const uint64_t bytes = kind == NO_TEXELS ? idle_bytes(gpu) : buffer_texel_bytes(1);
        if (!buffer_create(gpu, idle, bytes, SHARED, name) ||
            (kind != NO_TEXELS && !buffer_view(gpu, idle, kind, name)))
            return false;
        memset(idle->bytes, 0, idle->size);
    }
    if (!sets_create(gpu, layouts, 2, sets, &renderer->idle_pool))
        return false;
    renderer->idle_scene = sets[0];
    renderer->idle_frame = sets[1];
    for (uint32_t binding = 0; binding < SCENE_BINDINGS; binding++)
        layouts_bind_scene(gpu, renderer->idle_scene, binding,
                           &renderer->idle[texels_of_scene[binding]]);
    for (uint32_t binding = 0; binding < FRAME_BINDINGS; binding++)
        layouts_bind(gpu, renderer->idle_frame, binding,
                     binding == WORK_BINDING ? &renderer->work
                                             : &renderer->idle[texels_of[binding]]);
    return true;
}

bool layouts_create(KrsRenderer *renderer)
{
    return shader_layouts_create(renderer) && work_create(renderer) && idle_create(renderer);
}

void layouts_destroy(KrsRenderer *renderer)
{
    Gpu *gpu = &renderer->gpu;
    if (!gpu_is_open(gpu) || gpu->stuck)
        return;
    sets_destroy(gpu, renderer->idle_pool);
    renderer->idle_pool = 0;
    for (TexelKind kind = NO_TEXELS; kind < TEXEL_KINDS; kind++)
        buffer_destroy(gpu, &renderer->idle[kind]);
    buffer_destroy(gpu, &renderer->work);
    run_layout_destroy(gpu, renderer->layout);
    renderer->layout = 0;
    set_layout_destroy(gpu, &renderer->frame_layout);
    set_layout_destroy(gpu, &renderer->scene_layout);
}
