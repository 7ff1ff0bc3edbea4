/*
 * results.glsl: what becomes of each pixel.  The first ray of a pixel goes through its centre and
 * gives everything but the colour.
 */
struct Pixel {
    vec4  color;  // summed over the rays
    vec4  place;  // position; depth
    uvec4 normal; // bits of floats; component, 0: nothing, all else but colour and steps is void
    uvec4 albedo; // bits of floats; level
    uvec4 counts; // instance; steps; of the rays after the first: steps, summed, and of any of them
};

layout(std430, set = 1, binding = 3) buffer Pixels { Pixel pixels[]; };

// What is not a number or infinite counts as black.
vec3 sound(vec3 radiance)
{
    bvec3 finite = bvec3(radiance.x < INFINITE, radiance.y < INFINITE, radiance.z < INFINITE);
    return mix(vec3(0.0), max(radiance, 0.0), finite);
}
