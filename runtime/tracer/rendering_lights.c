/*
 * rendering_lights.c: the buffer of a rendering that has tables of albedos, the lights, and listed rays.
 */
#include <math.h>
#include <string.h>

#include "runtime/tracer/albedos.h"
#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

static char *row_of_inputs(const KrsRendering *rendering, uint32_t row)
{
    return (char *)rendering->inputs.bytes + (size_t)row * RESULT_BYTES;
}

static LightBlock *lights_of(const KrsRendering *rendering)
{
    return (LightBlock *)row_of_inputs(rendering, LIGHTS_AT);
}

/* Copies the tables of albedos, which are before the lights.  The second is in parts of 65535. */
static void set_albedos(const KrsRendering *rendering)
{
    memcpy(rendering->inputs.bytes, albedos, sizeof albedos);
    char *to = row_of_inputs(rendering, WIDE_ALBEDOS_AT);
    for (size_t i = 0; i < WIDE_ALBEDO_ROWS; i++) {
        uint16_t parts[2 * WIDE_AZIMUTHS];
        for (size_t k = 0; k < 2 * WIDE_AZIMUTHS; k++)
            parts[k] = (uint16_t)((wide_albedos[i][k] * UINT16_MAX + 500) / 1000);
        memcpy(to + i * sizeof parts, parts, sizeof parts);
    }
}

/* Makes room for lights, and for listed rays behind them.  Shaders load several lights at a time,
   also beyond the last one. */
static bool make_room(KrsRendering *rendering, size_t lights, size_t rays)
{
    Gpu     *gpu    = &rendering->renderer->gpu;
    Buffer  *buffer = &rendering->inputs;
    uint64_t bytes  = buffer_texel_bytes(LIGHTS_AT * RESULT_BYTES +
                                         (lights + LIGHTS_AT_ONCE) * sizeof(LightBlock) +
                                         rays * sizeof(ListedRayBlock));
    if (buffer->size >= bytes)
        return true;
    buffer_destroy(gpu, buffer);
    if (!buffer_create(gpu, buffer, bytes, UPLOADED, "lights and rays") ||
        !layouts_view_texels(gpu, INPUT_TEXELS_BINDING, buffer, "lights and rays"))
        return false;
    set_albedos(rendering);
    rendering_bind(rendering, rendering->band_set,
                   gpu->texels ? INPUT_TEXELS_BINDING : INPUT_ROWS_BINDING, buffer);
    return true;
}

/* Sets what a block has by the type of its light. */
static void shape_light(const KrsLight *light, LightBlock *block)
{
    double right = 1, up = 1, radius = light->softness;
    switch (light->type) {
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc) \
    case number:                                                     \
        right = across, up = along, radius = disc;                   \
        break;
#include "krs/light_types.def"
    default: break;
    }
    for (int k = 0; k < 3; k++) {
        block->right[k] = (float)(light->right[k] * right);
        block->up[k]    = (float)(light->up[k] * up);
    }
    block->softness = (float)radius;
    block->outer    = (float)cos(0.5 * light->angle);
    block->inner    = (float)cos(0.5 * light->angle * (1 - light->edge));
}

bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count,
                          uint32_t only, const double rebase_origin[3], size_t rays)
{
    if (!make_room(rendering, count, rays))
        return false;
    LightBlock *blocks = lights_of(rendering);
    for (size_t i = 0; i < count; i++) {
        const KrsLight *light  = &lights[i];
        const bool      shines = only == 0 || only == i + 1;
        shape_light(light, &blocks[i]);
        blocks[i].kind = (light->positional ? LIGHT_POSITIONAL : 0) |
                         (light->shadow ? LIGHT_CASTS_SHADOWS : 0) |
                         (light->spot ? LIGHT_SPOT : 0) | LIGHT_FIRST_TYPE * light->type;
        for (int k = 0; k < 3; k++) {
            blocks[i].vector[k] = (float)(light->vector[k] -
                                          (light->positional ? rebase_origin[k] : 0));
            blocks[i].color[k]  = shines ? (float)light->color[k] : 0;
        }
    }
    return true;
}

void rendering_set_emissive(KrsRendering *rendering, const EmissiveBlock *balls, size_t count)
{
    memcpy(row_of_inputs(rendering, ALBEDO_ROWS), balls, count * sizeof *balls);
}

ListedRayBlock *rendering_listed_rays(KrsRendering *rendering, size_t lights)
{
    return (ListedRayBlock *)(lights_of(rendering) + lights + LIGHTS_AT_ONCE);
}
