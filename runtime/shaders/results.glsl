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
    uint  component;
    uint  level, instance;
    uint  evaluations; // summed over the rays
    uint  most;        // of any ray
};

layout(std430, set = 1, binding = 3) buffer Pixels { Pixel pixels[]; };

// Adds what one ray has seen; what is not a number or infinite counts as black.
void add_color(uint index, vec3 radiance, float alpha)
{
    bvec3 sound = bvec3(radiance.x < INFINITE, radiance.y < INFINITE, radiance.z < INFINITE);
    vec4  color = vec4(mix(vec3(0.0), max(radiance, 0.0), sound), alpha);
    vec4  before = vec4(0.0);
    if (control.first_ray == 0u)
        before = pixels[index].color;
    pixels[index].color = before + color;
}
