#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * background.comp: what a ray sees that hits nothing: the sky, and the lights that have a disc in
 * it.
 */
#include "frame.glsl"
#include "solid.glsl"
#include "light.glsl"
#include "results.glsl"

void begin_group() {}

void do_item(uint index)
{
    Ray ray = find_end(index);
    set_result(COUNTS, index, uvec4(0u, ray.steps, 0u, 0u));
    if (ray.lost)
        atomicAdd(counts.unresolved, 1u);

    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + find_cell(index, work.extent.x)) + work.offset, origin, direction,
             base, slope);
    vec3 radiance = sky_radiance(direction);
    uint i = 0u;
    do { // as in pixels.glsl
        Light light = find_light(i);
        if (i < control.lights && (light.kind & POSITIONAL) == 0u)
            radiance += sun_radiance(direction, light.vector, light.color, light.softness);
        i++;
    } while (i < control.lights);
    if (ray.fate != HIT)
        add_color(index, vec4(sound(radiance), 0.0));
}

#include "pixels.glsl"
