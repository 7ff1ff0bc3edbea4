/*
 * deprecated_vulkan.h: names of version 0.2 in vulkan.h that are others now, which stay for one more; it includes this.
 */
#ifndef KRS_DEPRECATED_VULKAN_H
#define KRS_DEPRECATED_VULKAN_H

#ifdef __cplusplus
extern "C" {
#endif

#define KRS_LEAST_NOISY_SAMPLES KRS_MIN_NOISY_SAMPLES
#define KRS_MOST_SIDE           KRS_MAX_SIDE
#define KRS_MOST_SAMPLES        KRS_MAX_SAMPLES
#define KRS_MOST_ERROR          KRS_MAX_ERROR
#define KRS_MOST_BOUNCES        KRS_MAX_BOUNCES
#define KRS_MOST_EVEN_HITS      KRS_MAX_EVEN_HITS
#define KRS_MOST_REFLECTANCE    KRS_MAX_REFLECTANCE
#define KRS_MOST_LIGHT_GROUPS   KRS_MAX_LIGHT_GROUPS

typedef KrsProgressCallback KrsCompilingCallback KRS_DEPRECATED("KrsProgressCallback");
typedef KrsShaderStats KrsKernelStats            KRS_DEPRECATED("KrsShaderStats");
KRS_RENAMED(size_t, krs_rendering_kernels, krs_rendering_shaders,
            (const KrsRendering *rendering, KrsShaderStats *shaders, size_t capacity),
            (rendering, shaders, capacity))
KRS_RENAMED(uint64_t, krs_renderer_complaints, krs_renderer_validation_messages,
            (const KrsRenderer *renderer), (renderer))
/* krs_rendering_new without a purpose is for pictures. */
KRS_DEPRECATED("krs_rendering_new with KRS_FOR_PICTURES")
static inline KrsStatus krs_rendering_new_for_pictures(KrsRenderer *renderer, const KrsScene *scene,
                                                       KrsRendering **rendering);
static inline KrsStatus krs_rendering_new_for_pictures(KrsRenderer *renderer, const KrsScene *scene,
                                                       KrsRendering **rendering)
{
    return krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, rendering);
}
KRS_RENAMED(KrsStatus, krs_rendering_new_for, krs_rendering_new,
            (KrsRenderer * renderer, const KrsScene *scene, KrsPurpose purpose,
             KrsRendering **rendering),
            (renderer, scene, purpose, rendering))
#define KRS_FIFTH(a, b, c, d, function, ...) function
#define krs_rendering_new(...) \
    KRS_FIFTH(__VA_ARGS__, krs_rendering_new, krs_rendering_new_for_pictures, 0)(__VA_ARGS__)

/* Points had a struct of their own, and distances came with them. */
typedef struct KrsSurfacePoint {
    float distance;
    float normal[3]; /* for lighting */
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) uint32_t name;
#include "krs/surface.def"
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    float name KRS_NUMBERS_##type;
#include "krs/surface.def"
} KrsSurfacePoint;
static inline void krs_take_numbers(float *to, const double *from, size_t size)
{
    for (size_t i = 0; i < size / sizeof *to; i++)
        to[i] = (float)from[i];
}
static inline void krs_take_surface(KrsSurfacePoint *surface, const KrsHit *hit)
{
    surface->distance = (float)hit->distance;
    krs_take_numbers(surface->normal, hit->shading, sizeof surface->normal);
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) surface->name = hit->name;
#include "krs/surface.def"
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    krs_take_numbers((float *)&surface->name, (const double *)&hit->name, sizeof surface->name);
#include "krs/surface.def"
}
KRS_DEPRECATED("krs_device_distance, or krs_device_probe")
static inline KrsStatus krs_sample(KrsRendering *rendering, KrsState *state,
                                   const float (*points)[3], size_t count, float *distances,
                                   KrsSurfacePoint *surfaces);
static inline KrsStatus krs_sample(KrsRendering *rendering, KrsState *state,
                                   const float (*points)[3], size_t count, float *distances,
                                   KrsSurfacePoint *surfaces)
{
    KrsStatus status = KRS_OK;
    if (distances)
        status = krs_device_distance(rendering, state, points, count, distances);
    for (size_t first = 0; surfaces && first < count && status == KRS_OK; first += 64) {
        const size_t some = count - first < 64 ? count - first : 64;
        double       at[64][3];
        KrsHit       hits[64];
        for (size_t i = 0; i < 3 * some; i++)
            at[i / 3][i % 3] = points[first + i / 3][i % 3];
        status = krs_device_probe(rendering, state, (const double(*)[3])at, some, hits);
        for (size_t i = 0; i < some && status == KRS_OK; i++)
            krs_take_surface(&surfaces[first + i], &hits[i]);
    }
    return status;
}

typedef KrsAov KrsPlane KRS_DEPRECATED("KrsAov");

#ifdef __cplusplus
}
#endif
#endif
