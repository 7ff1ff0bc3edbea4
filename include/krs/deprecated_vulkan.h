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

typedef KrsAov KrsPlane KRS_DEPRECATED("KrsAov");

#ifdef __cplusplus
}
#endif
#endif
