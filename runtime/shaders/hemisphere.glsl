/*
 * hemisphere.glsl: rays over the hemisphere of a hit, and what they meet.
 */
#include "sines.glsl"
#include "samples.glsl"

// The least cosine between such a ray and the normal: others would creep along the surface.  It is
// that of 1 in 2,500 of them.
const float MIN_RISE = 0.02;
// The pixels above the surface at which such a ray starts at least.
const float LIFT_OF_OCCLUSION = 1.0;

// Returns the ray of a point of the disc, with a density in proportion to the cosine, as light from
// there counts.
vec3 find_hemisphere_ray(vec3 normal, vec2 disc)
{
    vec3 right, up;
    find_frame(normal, right, up);
    disc *= sqrt(1.0 - MIN_RISE * MIN_RISE);
    return disc.x * right + disc.y * up + sqrt(1.0 - dot(disc, disc)) * normal;
}
