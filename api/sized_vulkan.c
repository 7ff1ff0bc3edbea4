/*
 * sized_vulkan.c: the functions of vulkan.h that programs link with, for structs of any size.
 */
#include "krs/vulkan.h"

#include "api/sized.h"

KrsStatus krs_devices_sized(KrsDevice *devices, size_t size, size_t capacity, size_t *count)
{
    SizedArray array;
    *count = 0;
    if (!sized_open(&array, devices, size, sizeof(KrsDevice), capacity))
        return KRS_OUT_OF_MEMORY;
    const KrsStatus status = krs_devices(array.own, capacity, count);
    sized_close(&array, status == KRS_OK ? *count < capacity ? *count : capacity : 0);
    return status;
}

KrsStatus krs_renderer_new_sized(const KrsRendererOptions *options, size_t size,
                                 KrsRenderer **renderer)
{
    KrsRendererOptions own;
    *renderer = NULL;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_renderer_new(options ? &own : NULL, renderer);
}

void krs_renderer_device_sized(const KrsRenderer *renderer, KrsDevice *device, size_t size)
{
    const KrsDevice own = krs_renderer_device(renderer);
    sized_give(device, size, &own, sizeof own);
}

size_t krs_rendering_shaders_sized(const KrsRendering *rendering, KrsShaderStats *shaders,
                                   size_t size, size_t capacity)
{
    SizedArray array;
    if (!sized_open(&array, shaders, size, sizeof(KrsShaderStats), capacity))
        return 0;
    const size_t found = krs_rendering_shaders(rendering, array.own, capacity);
    sized_close(&array, found < capacity ? found : capacity);
    return found;
}

KrsStatus krs_render_sized(KrsRendering *rendering, KrsState *state,
                           const KrsRenderOptions *options, size_t size, KrsPicture **picture)
{
    KrsRenderOptions own;
    *picture = NULL;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_render(rendering, state, options ? &own : NULL, picture);
}

MADE_BY_OPTIONS(krs_film_new, KrsRendering, KrsRenderOptions, KrsFilm)

KrsStatus krs_film_add_sized(KrsFilm *film, KrsState *state, const KrsCamera *camera, size_t size,
                             uint32_t samples)
{
    KrsCamera own;
    if (!sized_take(&own, sizeof own, camera, size))
        return KRS_BAD_ARGUMENT;
    return krs_film_add(film, state, camera ? &own : NULL, samples);
}

KrsStatus krs_film_try_lanes_sized(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                                   size_t size, double *lanes_ms, double *compiler_ms)
{
    KrsCamera own;
    if (!sized_take(&own, sizeof own, camera, size))
        return KRS_BAD_ARGUMENT;
    return krs_film_try_lanes(film, state, camera ? &own : NULL, lanes_ms, compiler_ms);
}

KrsStatus krs_film_add_rays_sized(KrsFilm *film, KrsState *state, const KrsRays *rays, size_t size)
{
    KrsRays own;
    if (!sized_take(&own, sizeof own, rays, size))
        return KRS_BAD_ARGUMENT;
    return krs_film_add_rays(film, state, rays ? &own : NULL);
}

KrsStatus krs_device_probe_sized(KrsRendering *rendering, KrsState *state,
                                 const double (*points)[3], size_t count, KrsHit *hits, size_t size)
{
    SizedArray array;
    if (!sized_open(&array, hits, size, sizeof(KrsHit), count))
        return KRS_OUT_OF_MEMORY;
    const KrsStatus status = krs_device_probe(rendering, state, points, count, array.own);
    sized_close(&array, status == KRS_OK ? count : 0);
    return status;
}

KrsStatus krs_device_raycast_sized(KrsRendering *rendering, KrsState *state,
                                   const double (*origins)[3], const double (*directions)[3],
                                   size_t count, double farthest, double tolerance, KrsHit *hits,
                                   size_t size)
{
    SizedArray array;
    if (!sized_open(&array, hits, size, sizeof(KrsHit), count))
        return KRS_OUT_OF_MEMORY;
    const KrsStatus status = krs_device_raycast(rendering, state, origins, directions, count,
                                                farthest, tolerance, array.own);
    sized_close(&array, status == KRS_OK ? count : 0);
    return status;
}
