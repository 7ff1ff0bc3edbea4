/*
 * sky_means.glsl: the sky as previews see it: as a whole around a normal, and in surfaces of some
 * roughness.
 */
#ifdef SKY_MAP
#include "sky_map.glsl"
#endif

// Returns the mean around a normal, which may be shorter than 1.
vec3 find_sky_around(vec3 normal)
{
#ifdef SKY_MAP
    return sky_map_around(normal / max(length(normal), 1e-6));
#else
    return sky_light(normal);
#endif
}

// Returns what a mirror of some roughness shows.
vec3 find_sky_mirrored(vec3 normal, vec3 toward_eye, float roughness)
{
    vec3 bounced = reflect(-toward_eye, normal);
#ifdef SKY_MAP
    return sky_map_mirrored(bounced, roughness);
#else
    return sky_mirrored(bounced, normal, roughness);
#endif
}
