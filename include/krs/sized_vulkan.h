/*
 * sized_vulkan.h: what programs link with of vulkan.h, for structs of any size; it is included there.
 *
 * Each function hands on how large its struct is for the program that calls it.
 */
#ifndef KRS_SIZED_VULKAN_H
#define KRS_SIZED_VULKAN_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

KrsStatus krs_devices_sized(KrsDevice *devices, size_t size, size_t capacity, size_t *count);
KrsStatus krs_renderer_new_sized(const KrsRendererOptions *options, size_t size,
                                 KrsRenderer **renderer);
void      krs_renderer_device_sized(const KrsRenderer *renderer, KrsDevice *device, size_t size);
size_t    krs_rendering_shaders_sized(const KrsRendering *rendering, KrsShaderStats *shaders,
                                      size_t size, size_t capacity);
KrsStatus krs_render_sized(KrsRendering *rendering, KrsState *state,
                           const KrsRenderOptions *options, size_t size, KrsPicture **picture);
KrsStatus krs_film_new_sized(KrsRendering *rendering, const KrsRenderOptions *options, size_t size,
                             KrsFilm **film);
KrsStatus krs_film_add_sized(KrsFilm *film, KrsState *state, const KrsCamera *camera, size_t size,
                             uint32_t samples);
KrsStatus krs_film_try_lanes_sized(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                                   size_t size, double *lanes_ms, double *compiler_ms);
KrsStatus krs_film_add_rays_sized(KrsFilm *film, KrsState *state, const KrsRays *rays, size_t size);
KrsStatus krs_device_probe_sized(KrsRendering *rendering, KrsState *state,
                                 const double (*points)[3], size_t count, KrsHit *hits,
                                 size_t size);
KrsStatus krs_device_raycast_sized(KrsRendering *rendering, KrsState *state,
                                   const double (*origins)[3], const double (*directions)[3],
                                   size_t count, double farthest, double tolerance, KrsHit *hits,
                                   size_t size);

#ifndef KRS_LIBRARY
KRS_SIZED KrsStatus krs_devices(KrsDevice *devices, size_t capacity, size_t *count)
{
    return krs_devices_sized(devices, sizeof *devices, capacity, count);
}
KRS_SIZED KrsStatus krs_renderer_new(const KrsRendererOptions *options, KrsRenderer **renderer)
{
    return krs_renderer_new_sized(options, sizeof *options, renderer);
}
KRS_SIZED KrsDevice krs_renderer_device(const KrsRenderer *renderer)
{
    KrsDevice device;
    krs_renderer_device_sized(renderer, &device, sizeof device);
    return device;
}
KRS_SIZED size_t krs_rendering_shaders(const KrsRendering *rendering, KrsShaderStats *shaders,
                                       size_t capacity)
{
    return krs_rendering_shaders_sized(rendering, shaders, sizeof *shaders, capacity);
}
KRS_SIZED KrsStatus krs_render(KrsRendering *rendering, KrsState *state,
                               const KrsRenderOptions *options, KrsPicture **picture)
{
    return krs_render_sized(rendering, state, options, sizeof *options, picture);
}
KRS_SIZED KrsStatus krs_film_new(KrsRendering *rendering, const KrsRenderOptions *options,
                                 KrsFilm **film)
{
    return krs_film_new_sized(rendering, options, sizeof *options, film);
}
KRS_SIZED KrsStatus krs_film_add(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                                 uint32_t samples)
{
    return krs_film_add_sized(film, state, camera, sizeof *camera, samples);
}
KRS_SIZED KrsStatus krs_film_try_lanes(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                                       double *lanes_ms, double *compiler_ms)
{
    return krs_film_try_lanes_sized(film, state, camera, sizeof *camera, lanes_ms, compiler_ms);
}
KRS_SIZED KrsStatus krs_film_add_rays(KrsFilm *film, KrsState *state, const KrsRays *rays)
{
    return krs_film_add_rays_sized(film, state, rays, sizeof *rays);
}
KRS_SIZED KrsStatus krs_device_probe(KrsRendering *rendering, KrsState *state,
                                     const double (*points)[3], size_t count, KrsHit *hits)
{
    return krs_device_probe_sized(rendering, state, points, count, hits, sizeof *hits);
}
KRS_SIZED KrsStatus krs_device_raycast(KrsRendering *rendering, KrsState *state,
                                       const double (*origins)[3], const double (*directions)[3],
                                       size_t count, double farthest, double tolerance,
                                       KrsHit *hits)
{
    return krs_device_raycast_sized(rendering, state, origins, directions, count, farthest,
                                    tolerance, hits, sizeof *hits);
}
#endif

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
