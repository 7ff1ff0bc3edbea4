/*
 * deprecated_vulkan.h: names of before 0.3 in vulkan.h, which stay for this version; it includes this.
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
typedef KrsAov KrsPlane KRS_DEPRECATED("KrsAov");

#ifdef __cplusplus
}
#endif
#endif
