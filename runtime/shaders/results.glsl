/*
 * results.glsl: what becomes of each pixel.  The first ray of a pixel goes through its centre and
 * gives everything but the colour.
 */
struct Pixel {
    vec4  color; // summed over the rays
    vec3  position;
    float depth;
    vec3  normal;
    uint  steps;
    vec3  albedo;
    uint  component; // 0: nothing, and all else but colour and steps is meaningless
    uint  level, instance;
    uint  evaluations; // by the rays after the first, summed;
    uint  most;        // of any of them
};

layout(std430, set = 1, binding = 3) buffer Pixels { Pixel pixels[]; };

// What is not a number or infinite counts as black.
vec3 sound(vec3 radiance)
{
    bvec3 finite = bvec3(radiance.x < INFINITE, radiance.y < INFINITE, radiance.z < INFINITE);
    return mix(vec3(0.0), max(radiance, 0.0), finite);
}
