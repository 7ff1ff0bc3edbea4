#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * resolve.comp: adds the light of the sky to what the lights gave, and a ray to its pixel.  The
 * first ray of a pixel goes through its centre and gives everything but the colour.
 */
#include "frame.glsl"
#include "light.glsl"

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

// The hemisphere of the sky, as far as it is open; what is closed off by a surface of like
// colour gives some light back.
vec3 ambient(Hit hit, vec3 toward_eye)
{
    vec3 bounce = hit.occlusion / max(1.0 - hit.color * (1.0 - hit.occlusion), 0.05);
    vec3 scattered = hit.color * (1.0 - hit.metallic) * sky_light(hit.normal) * bounce;
    vec3 mirrored = sky_reflected(hit.normal, toward_eye, hit.color, hit.roughness, hit.metallic);
    return scattered + mirrored * hit.occlusion;
}

void main()
{
    uvec2 place;
    uint  index;
    if (!find_pixel(place, index))
        return;

    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(place) + work.offset, origin, direction, base, slope);
    Ray  ray = rays[index];
    Hit  hit = hits[index];
    bool solid = ray.fate == HIT;

    vec3 radiance = hit.radiance + (solid ? ambient(hit, -direction) : sky_radiance(direction));
    bvec3 sound = bvec3(radiance.x < INFINITE, radiance.y < INFINITE, radiance.z < INFINITE);
    vec4 color = vec4(mix(vec3(0.0), max(radiance, 0.0), sound), solid ? 1.0 : 0.0);

    if (control.beginning == 0u) {
        pixels[index].color += color;
        pixels[index].evaluations += ray.steps;
        pixels[index].most = max(pixels[index].most, ray.steps);
        return;
    }
    vec3 apart = hit.position - frame.eye.xyz;
    Pixel pixel;
    pixel.color = color;
    pixel.position = solid ? hit.position : vec3(0.0);
    pixel.depth = control.projection == PANORAMA ? ray.t : dot(apart, frame.forward.xyz);
    if (!solid)
        pixel.depth = uintBitsToFloat(0x7f800000u); // infinity
    pixel.normal = solid ? ray.side * hit.normal : vec3(0.0);
    pixel.steps = ray.steps;
    pixel.albedo = solid ? hit.color : vec3(0.0);
    pixel.component = solid ? hit.component : 0u;
    pixel.level = solid ? hit.level : 0u;
    pixel.instance = solid ? hit.instance : 0u;
    pixel.evaluations = ray.steps;
    pixel.most = ray.steps;
    pixels[index] = pixel;
}
